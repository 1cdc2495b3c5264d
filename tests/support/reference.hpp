// Reference twins: the slow, obvious forms of what the library computes, in any arithmetic. With Rational
// they are exact and judge its rounding errors.
#pragma once
#include <freiform/spline/patch.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

namespace freiform::test {

using Rational = boost::multiprecision::cpp_rational;

// |a - b|, rounded to double only at the end.
inline double gap(double a, const Rational& b) {
    const Rational d = Rational(a) - b;
    return (d < 0 ? Rational(-d) : d).convert_to<double>();
}

// The textbook recursion of Cox and de Boor over the whole knot vector, with 0/0 := 0. Spans are half-open,
// the last one is closed. `order` derivatives are taken by the textbook difference formula. Returns all
// N_{i,p}^(order).
template <class T>
std::vector<T> cox_de_boor(const std::vector<T>& t, int p, const T& u, int order = 0) {
    const int m = int(t.size()) - 1;  // spans
    const int end = m - p;            // t[end] is the upper end of the domain
    std::vector<T> n(std::size_t(m), T(0));
    if (order > p) return std::vector<T>(std::size_t(m - p), T(0));
    int s = end - 1;
    while (t[std::size_t(s)] == t[std::size_t(end)]) --s;  // the last non-empty span of the domain
    if (u < t[std::size_t(end)])
        for (s = p; !(t[std::size_t(s)] <= u && u < t[std::size_t(s) + 1]);) ++s;
    n[std::size_t(s)] = T(1);
    for (int k = 1; k <= p; ++k)
        for (int i = 0; i < m - k; ++i) {
            const std::size_t at = std::size_t(i), up = at + std::size_t(k);
            const T a = n[at], b = n[at + 1], left = t[up] - t[at], right = t[up + 1] - t[at + 1];
            const bool derive = k > p - order;
            T sum(0);
            if (a != 0) sum += a * (derive ? T(k) : u - t[at]) / left;
            if (b != 0) sum += b * (derive ? T(-k) : t[up + 1] - u) / right;
            n[at] = sum;
        }
    n.resize(std::size_t(m - p));
    return n;
}

template <class T>
std::vector<T> knots_as(const BSplineBasis& b) {
    return {b.knots().begin(), b.knots().end()};
}
template <class T>
std::vector<T> knots_as(const Bernstein& b) {
    std::vector<T> t;
    for (int i = 0; i < 2 * (b.degree() + 1); ++i) t.push_back(T(b.knot(i)));
    return t;
}

// The partial derivative of order a of the homogeneous map, coordinate by coordinate: the sum over the whole
// net.
template <class T, std::size_t N, class P, class B>
std::vector<T> homogeneous(const Patch<N, P, B>& s, const Param<N>& u, const Index<N>& a) {
    std::array<std::vector<T>, N> w;
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) {
        w[d] =
            cox_de_boor(knots_as<T>(s.basis(int(d))), s.basis(int(d)).degree(), T(component<N>(u, d)), a[d]);
        extent[d] = int(w[d].size());
    }
    std::vector<T> sum(std::size_t(P::kCoords), T(0));
    each_index(extent, [&](const Index<N>& i) {
        T product(1);
        Index<N> at{};
        for (std::size_t d = 0; d < N; ++d) {
            const T& factor = w[d][std::size_t(i[d])];
            if (factor == 0) return;
            product *= factor;
            at[d] = i[d] % s.net().extent()[d];
        }
        const P& p = s.net().view()(at);
        for (int c = 0; c < P::kCoords; ++c) sum[std::size_t(c)] += product * T(p[c]);
    });
    return sum;
}

// All partial derivatives of the point, by solving A = w S, differentiated, for one derivative after the
// other.
template <class T, std::size_t N, class P, class B>
std::vector<std::vector<T>> jet_of(const Patch<N, P, B>& s, const Param<N>& u, int order) {
    const auto orders = jet_orders<N>(order);
    std::vector<std::vector<T>> h, out;
    for (const auto& a : orders) h.push_back(homogeneous<T>(s, u, a));
    constexpr int D = Space<P>::kDim;
    for (std::size_t i = 0; i < orders.size(); ++i) {
        std::vector<T> v(h[i].begin(), h[i].begin() + D);
        if constexpr (Space<P>::kRational) {
            for (std::size_t j = 1; j < orders.size(); ++j) {  // j: the derivative that falls on the weight
                T c(1);
                Index<N> rest{};
                bool below = true;
                for (std::size_t d = 0; d < N; ++d) {
                    rest[d] = orders[i][d] - orders[j][d];
                    below = below && rest[d] >= 0;
                    for (int k = 1; k <= orders[j][d]; ++k) c = c * (orders[i][d] - k + 1) / k;
                }
                if (!below) continue;
                const auto& known = out[jet_slot(rest)];
                for (int k = 0; k < D; ++k) v[std::size_t(k)] -= c * h[j].back() * known[std::size_t(k)];
            }
            for (T& x : v) x /= h[0].back();
        }
        out.push_back(std::move(v));
    }
    return out;
}

template <class T, std::size_t N, class P, class B>
std::vector<T> value_of(const Patch<N, P, B>& s, const Param<N>& u) {
    return jet_of<T>(s, u, 0)[0];
}

// de Casteljau's triangle, not in place.
template <class P>
P de_casteljau(std::vector<P> b, double t) {
    while (b.size() > 1) {
        std::vector<P> next;
        for (std::size_t i = 0; i + 1 < b.size(); ++i) next.push_back((1 - t) * b[i] + t * b[i + 1]);
        b = std::move(next);
    }
    return b[0];
}

}  // namespace freiform::test
