// How far a polynomial is from an offset.
//
// Idea. Not from derivatives of the normal n, but from what an offset O = S + d n is: with D = H - S,
//     a = D . S_u = 0,   b = D . S_v = 0,   c = |D|^2 - d^2 = 0
// would say that D = d n, up to its side. These are polynomials, or quotients of such by powers of the weight
// w; they are nowhere larger than the largest of their Bernstein coefficients.
//
// Argument. The part t of D that is tangent has
//     |t| <= (|a| |S_v| + |b| |S_u|) / |S_u x S_v|,
// and the other one, g n, has |g^2 - d^2| = |c - t^2|, so |g - d| <= (|c| + t^2) / |d| on the right side,
// which it cannot leave where |c| + t^2 < d^2. Together |H - O| <= hypot(|t|, (|c| + t^2) / |d|); where d is
// small against that, |D| + |d| is as good. With S = N / w, E = w H - N, A = N_u w - N w_u, B likewise:
//     D = E / w,   a = E . A / w^3,   b = E . B / w^3,   S_u x S_v = A x B / w^4,
//     |t| <= (|E . A| |B| + |E . B| |A|) / (w |A x B|).
// |A x B| is at least what it is along the normal in the middle. Coordinates count from the middle.
//
// Rounding. Coefficients of S and H may be off by kOffsetRounding of their size, and products by what that
// does to them; besides by kOffsetRounding of the product of the largest factors, as Bernstein coefficients
// of a product are averages.
//
// Cost. Of a bicubic base and h of degree 5 x 5 some 20 microseconds; of a rational one 40.
#include "offset_bound_detail.hpp"

#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace freiform {

namespace {

constexpr int kMostOfProducts = 4 * detail::kMostOffsetDegree;

// Rows of Pascal's triangle.
const double* binomials(int n) {
    static const auto all = [] {
        std::array<std::array<double, kMostOfProducts + 1>, kMostOfProducts + 1> out{};
        for (int m = 0; m <= kMostOfProducts; ++m)
            for (int k = 0; k <= m; ++k) out[std::size_t(m)][std::size_t(k)] = binomial(m, k);
        return out;
    }();
    return all[std::size_t(n)].data();
}

// Bernstein coefficients times their binomials, (p + 1) x (q + 1): products are convolutions.
struct Form {
    int p = 0, q = 0;
    std::vector<double> c;

    Form(int p_, int q_) : p(p_), q(q_), c(std::size_t((p_ + 1) * (q_ + 1)), 0) {}
    double& at(int i, int j) { return c[std::size_t(i * (q + 1) + j)]; }
    double at(int i, int j) const { return c[std::size_t(i * (q + 1) + j)]; }
    const double* row(int i) const { return c.data() + i * (q + 1); }
    double* row(int i) { return c.data() + i * (q + 1); }
    double scale(int i, int j) const { return binomials(p)[i] * binomials(q)[j]; }
    double middle() const {
        double sum = 0;
        for (const double x : c) sum += x;
        return std::ldexp(sum, -p - q);
    }
    double least() const {
        double out = kInfinity;
        const double* of = binomials(q);
        for (int i = 0; i <= p; ++i) {
            const double* row_i = row(i);
            double least_of_row = kInfinity;
            for (int j = 0; j <= q; ++j) least_of_row = std::min(least_of_row, row_i[j] / of[j]);
            out = std::min(out, least_of_row / binomials(p)[i]);
        }
        return out;
    }
    double largest() const {
        double out = 0;
        const double* of = binomials(q);
        for (int i = 0; i <= p; ++i) {
            const double* row_i = row(i);
            double most = 0;
            for (int j = 0; j <= q; ++j) most = std::max(most, std::abs(row_i[j]) / of[j]);
            out = std::max(out, most / binomials(p)[i]);
        }
        return out;
    }
};
using Form3 = std::array<Form, 3>;

// Rows of known length are multiplied more than twice as fast.
template <int n>
void add_rows(Form& to, const Form& a, const Form& b, double sign) {
    for (int i = 0; i <= a.p; ++i)
        for (int k = 0; k <= b.p; ++k) {
            const double *x = a.row(i), *y = b.row(k);
            double* z = to.row(i + k);
            for (int j = 0; j <= a.q; ++j) {
                const double f = sign * x[j];
                for (int l = 0; l < (n > 0 ? n : b.q + 1); ++l) z[j + l] += f * y[l];
            }
        }
}
void add_product(Form& to, const Form& a, const Form& b, double sign = 1) {
    switch (b.q + 1) {
        case 3:
            return add_rows<3>(to, a, b, sign);
        case 4:
            return add_rows<4>(to, a, b, sign);
        case 6:
            return add_rows<6>(to, a, b, sign);
        case 7:
            return add_rows<7>(to, a, b, sign);
        case 9:
            return add_rows<9>(to, a, b, sign);
        default:
            return add_rows<0>(to, a, b, sign);
    }
}
Form product(const Form& a, const Form& b) {
    Form out(a.p + b.p, a.q + b.q);
    add_product(out, a, b);
    return out;
}
Form scalar_product(const Form3& a, const Form3& b) {
    Form out(a[0].p + b[0].p, a[0].q + b[0].q);
    for (std::size_t k = 0; k < 3; ++k) add_product(out, a[k], b[k]);
    return out;
}
// Of each row the products with those behind it count twice.
Form square(const Form3& a) {
    Form out(2 * a[0].p, 2 * a[0].q);
    for (const Form& f : a)
        for (int i = 0; i <= f.p; ++i) {
            Form row(0, f.q), rest(f.p - i, f.q), sum(f.p - i, 2 * f.q);
            std::copy(f.row(i), f.row(i) + f.q + 1, row.c.begin());
            std::copy(f.row(i), f.row(f.p) + f.q + 1, rest.c.begin());
            add_product(sum, row, rest, 2);
            add_product(sum, row, row, -1);
            for (int k = i; k <= f.p; ++k)
                for (int j = 0; j <= 2 * f.q; ++j) out.at(i + k, j) += sum.at(k - i, j);
        }
    return out;
}
Form ones(int p, int q) {
    Form out(p, q);
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) out.at(i, j) = out.scale(i, j);
    return out;
}
// Along an axis, for a parameter in [0, 1].
Form derivative(const Form& f, int axis) {
    Form out(f.p - (axis == 0), f.q - (axis == 1));
    for (int i = 0; i <= out.p; ++i)
        for (int j = 0; j <= out.q; ++j) {
            const double hi = f.at(i + (axis == 0), j + (axis == 1)) /
                              f.scale(i + (axis == 0), j + (axis == 1)),
                         lo = f.at(i, j) / f.scale(i, j);
            out.at(i, j) = (axis == 0 ? f.p : f.q) * (hi - lo) * out.scale(i, j);
        }
    return out;
}
double largest(const Form3& f) {
    double out = 0;
    for (int i = 0; i <= f[0].p; ++i)
        for (int j = 0; j <= f[0].q; ++j)
            out =
                std::max(out, norm(Vec<3>{{f[0].at(i, j), f[1].at(i, j), f[2].at(i, j)}}) / f[0].scale(i, j));
    return out;
}
Vec<3> middle(const Form3& f) { return {{f[0].middle(), f[1].middle(), f[2].middle()}}; }
Form along(const Form3& f, const Vec<3>& d) {
    Form out(f[0].p, f[0].q);
    for (std::size_t i = 0; i < out.c.size(); ++i)
        out.c[i] = d[0] * f[0].c[i] + d[1] * f[1].c[i] + d[2] * f[2].c[i];
    return out;
}

// A net as forms, its coordinates counted from a place; weights, too.
template <class P>
std::pair<Form3, Form> forms_of(const NetView<2, const P>& net, const Vec<3>& from) {
    const int p = net.extent[0] - 1, q = net.extent[1] - 1;
    std::pair<Form3, Form> out{{Form(p, q), Form(p, q), Form(p, q)}, Form(p, q)};
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
            const P& x = net({i, j});
            const double w = Space<P>::weight(x), scale = out.second.scale(i, j);
            for (std::size_t k = 0; k < 3; ++k)
                out.first[k].at(i, j) = (x[int(k)] - w * from[int(k)]) * scale;
            out.second.at(i, j) = w * scale;
        }
    return out;
}

}  // namespace

template <class P>
double detail::offset_bound(const NetView<2, const Vec<3>>& h, const NetView<2, const P>& s, double distance,
                            double size) {
    const Vec<3> from = h({h.extent[0] / 2, h.extent[1] / 2});
    const auto [H, unused] = forms_of(h, from);
    const auto [N, w] = forms_of(s, from);
    const int p = w.p, q = w.q, hp = H[0].p, hq = H[0].q;
    double least_weight = 1, largest_weight = 1;
    Form3 E = N, A = N, B = N;
    Form ww = ones(0, 0);
    if constexpr (Space<P>::kRational) {
        least_weight = w.least(), largest_weight = w.largest();
        if (!(least_weight > 0)) return kInfinity;
        const Form w_u = derivative(w, 0), w_v = derivative(w, 1), raise = ones(hp, hq);
        for (std::size_t k = 0; k < 3; ++k) {
            E[k] = product(w, H[k]);
            add_product(E[k], N[k], raise, -1);
            A[k] = product(derivative(N[k], 0), w);
            add_product(A[k], N[k], w_u, -1);
            B[k] = product(derivative(N[k], 1), w);
            add_product(B[k], N[k], w_v, -1);
        }
        ww = product(product(product(w, w), ones(0, 2 * hq)), ones(2 * hp, 0));
    } else {
        const int P_ = std::max(hp, p), Q_ = std::max(hq, q);
        for (std::size_t k = 0; k < 3; ++k) {
            E[k] = product(H[k], ones(P_ - hp, Q_ - hq));
            add_product(E[k], N[k], ones(P_ - p, Q_ - q), -1);
            A[k] = derivative(N[k], 0), B[k] = derivative(N[k], 1);
        }
        ww = ones(2 * P_, 2 * Q_);
    }
    const double far = largest(E), u = largest(A), v = largest(B), degree = p + q + hp + hq;
    const double off = detail::kOffsetRounding * degree * size * largest_weight;
    const double off_u = 4 * p * off * largest_weight, off_v = 4 * q * off * largest_weight;
    const Vec<3> a = middle(A), b = middle(B), across = cross(a, b);
    const double beside = far / least_weight + std::abs(distance) + off / least_weight;
    if (!(norm(across) > 0)) return beside;
    const Vec<3> z = unit(across), x = unit(a), y = cross(z, x);
    Form flat = product(along(A, x), along(B, y));
    add_product(flat, along(A, y), along(B, x), -1);
    const double rounding = detail::kOffsetRounding * degree;
    const double least = flat.least() - (u * off_v + v * off_u + rounding * u * v);
    if (!(least > 0)) return beside;
    const double along_u = scalar_product(E, A).largest() + off * u + far * off_u + rounding * far * u,
                 along_v = scalar_product(E, B).largest() + off * v + far * off_v + rounding * far * v;
    const double t = (along_u * v + along_v * u) / (least_weight * least);
    Form c = square(E);
    const double square = distance * distance;
    for (std::size_t i = 0; i < c.c.size(); ++i) c.c[i] -= square * ww.c[i];
    const double apart =
        (c.largest() + 2 * far * off + rounding * (far * far + square * largest_weight * largest_weight)) /
        (least_weight * least_weight);
    const bool same_side = dot(middle(E), z) * distance > 0;
    if (!same_side || !(apart + t * t < square)) return beside;
    return (std::hypot(t, (apart + t * t) / std::abs(distance)) + off / least_weight) * (1 + 1e-9);
}

template double detail::offset_bound(const NetView<2, const Vec<3>>&, const NetView<2, const Vec<3>>&, double,
                                     double);
template double detail::offset_bound(const NetView<2, const Vec<3>>&, const NetView<2, const Hom<3>>&, double,
                                     double);

}  // namespace freiform
