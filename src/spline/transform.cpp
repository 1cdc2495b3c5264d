// Affine and projective maps.
//
// Idea: both are linear in homogeneous coordinates, so the image of sum B_i P_i is sum B_i m P_i.
//
// Accuracy: every coefficient of the image is computed with a bound of its error (bounded.hpp). With the
// errors e_a of numerators and e_w of weights, g the exact and f the computed image,
//     f - g = sum B_i (e_a - g e_w)_i / sum B_i w_i,    |f - g| <= max_i (|e_a| + |g| |e_w|)_i / w_i,
// and |g| <= reach + |f - g| with reach = max |project(P_i)| by the convex hull property. If knots were
// inserted to make weights positive, errors are those of convex combinations, so that the largest of all
// e_a, e_w over the least weight take the place of the single quotients, and the bound of the insertion is
// added.
//
// Perspective: with n = across x up and x from the eye, the ray e + s (x - e) meets the plane at
// s = n.(o - e) / n.(x - e); so times n.(x - e), the coordinates (p - o).(up x n) and (p - o).(n x across),
// over n.n, are linear in x.
//
// References: [Farin 2002, ch. 12], [PT97, ch. 1.4].
#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/spline/transform.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// Rows of `columns` numbers.
struct Matrix {
    std::span<const double> all;
    std::size_t columns;

    std::size_t rows() const { return all.size() / columns; }
    const double* operator[](std::size_t i) const { return all.data() + i * columns; }
};
template <std::size_t Rows, std::size_t Columns>
Matrix matrix(const std::array<std::array<double, Columns>, Rows>& m) {
    static_assert(sizeof m == Rows * Columns * sizeof(double));
    return {{m[0].data(), Rows * Columns}, Columns};
}

Result<void> check_matrix(const Matrix& m, std::string_view name) {
    for (std::size_t i = 0; i < m.rows(); ++i)
        for (std::size_t j = 0; j < m.columns; ++j)
            if (!std::isfinite(m[i][j]))
                return refuse(RefusalKind::nonfinite, text(name, "[", i, "][", j, "]"),
                              text(m[i][j], " is not a finite number"));
    return {};
}

// The error bounds of the coefficients of an image, as far as they matter.
struct Errors {
    double numerator = 0, weight = 0;  // the largest
};

// The images of tuples, one after the other.
struct Image {
    std::vector<double> all;
    std::vector<Errors> errors;  // of every tuple; of affine images numerators relative to the weight
    Errors most;

    void add(const Vec<4>& numerator_error, double weight_error) {
        errors.push_back({norm(numerator_error), weight_error});
        most.numerator = std::max(most.numerator, errors.back().numerator);
        most.weight = std::max(most.weight, weight_error);
    }
};

// row . p, exact up to the bound.
Bounded product(const double* row, std::size_t columns, const double* p) {
    Bounded s;
    for (std::size_t j = 0; j < columns; ++j)
        if (row[j] != 0 && p[j] != 0) s = s + Bounded(row[j]) * Bounded(p[j]);
    return s;
}

Image affine_image(const Tuples& from, const Matrix& linear, std::span<const double> offset) {
    Image out;
    for (std::size_t i = 0; i < from.count(); ++i) {
        const double w = from.weight(i);
        Vec<4> e;
        for (std::size_t k = 0; k < linear.rows(); ++k) {
            const Bounded shift = from.rational ? Bounded(offset[k]) * Bounded(w) : Bounded(offset[k]);
            const Bounded s = product(linear[k], linear.columns, from[i]) + shift;
            out.all.push_back(s.value);
            e[int(k)] = s.bound / w;
        }
        if (from.rational) out.all.push_back(w);
        out.add(e, 0);
    }
    return out;
}

Image projective_image(const Tuples& from, const Matrix& m) {
    Image out;
    const std::size_t to = m.rows() - 1;
    for (std::size_t i = 0; i < from.count(); ++i) {
        Vec<4> e;
        double of_weight = 0;
        for (std::size_t k = 0; k <= to; ++k) {
            const Bounded s = product(m[k], m.columns, from[i]);
            out.all.push_back(s.value);
            (k < to ? e[int(k)] : of_weight) = s.bound;
        }
        out.add(e, of_weight);
    }
    return out;
}

template <class P>
std::vector<P> coefficients(const std::vector<double>& all) {
    std::vector<P> out(all.size() / std::size_t(P::kCoords));
    std::ranges::copy(all, numbers(std::span(out)).begin());
    return out;
}

double farthest(const Tuples& net) {
    double r = 0;
    for (std::size_t i = 0; i < net.count(); ++i) r = std::max(r, norm(net.point(i)));
    return r * (1 + 8 * kUnitRoundoff);
}

// (moved + reach rho) / (1 - rho); infinite where nothing is proven.
double distance(double moved, double reach, double rho) {
    if (!(rho < 0.5)) return std::numeric_limits<double>::infinity();
    return (moved + reach * rho) / (1 - rho) * (1 + 32 * kUnitRoundoff);
}

// `net` came from `image` by an insertion of knots with the bound `inserted`.
double projective_bound(const Tuples& net, const Image& image, double inserted) {
    double moved = 0, rho = 0;
    for (std::size_t i = 0; i < net.count(); ++i) {
        const Errors& e = inserted == 0 ? image.errors[i] : image.most;
        moved = std::max(moved, e.numerator / net.weight(i));
        rho = std::max(rho, e.weight / net.weight(i));
    }
    return distance(moved, farthest(net) + inserted, rho) + inserted;
}

template <class S>
Result<Transformed<S>> finished(Result<S> patch, double bound) {
    if (!patch) return std::unexpected(patch.error());
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "transform",
                      "rounding is as large as the weights of the image");
    return Transformed<S>{std::move(*patch), bound};
}

}  // namespace

Result<Projectivity<2, 3>> perspective(const Vec<3>& eye, const Vec<3>& origin, const Vec<3>& across,
                                       const Vec<3>& up) {
    for (const auto& [name, v] : {std::pair{"eye", eye}, {"origin", origin}, {"across", across}, {"up", up}})
        if (!is_finite(v)) return refuse(RefusalKind::nonfinite, name, "has a coordinate that is not finite");
    if (max_abs(across) == 0 || max_abs(up) == 0)
        return refuse(RefusalKind::invalid, max_abs(up) == 0 ? "up" : "across", "is zero");
    // Powers of two in front, so that products stay in range; they go back into the rows.
    const int ea = std::ilogb(max_abs(across)), eu = std::ilogb(max_abs(up));
    const Vec<3> a = std::scalbn(1.0, -ea) * across, b = std::scalbn(1.0, -eu) * up;
    const Vec<3> n = cross(a, b), to_plane = origin - eye;
    const double size = norm(n), depth = dot(n, to_plane);
    if (!(size > 16 * kUnitRoundoff * norm(a) * norm(b)))
        return refuse(RefusalKind::ill_conditioned, "up", "is parallel to `across`");
    if (!(std::abs(depth) > 16 * kUnitRoundoff * norm(a) * norm(b) * (norm(origin) + norm(eye))))
        return refuse(RefusalKind::ill_conditioned, "eye", "is in the plane");
    const double front = depth > 0 ? 1 : -1, nn = dot(n, n);
    const Vec<3> dual[2] = {(1 / nn) * cross(b, n), (1 / nn) * cross(n, a)};
    const int scale[2] = {-ea, -eu};
    Projectivity<2, 3> p;
    for (std::size_t i = 0; i < 2; ++i) {
        // coordinate * n.(x - e) = dual.(e - o) n.(x - e) + depth dual.(x - e)
        const double shift = -dot(dual[i], to_plane);
        const Vec<3> row = front * (shift * n + depth * dual[i]);
        for (int k = 0; k < 3; ++k) p.m[i][std::size_t(k)] = std::scalbn(row[k], scale[i]);
        p.m[i][3] = -std::scalbn(dot(row, eye), scale[i]);
    }
    for (int k = 0; k < 3; ++k) p.m[2][std::size_t(k)] = front * n[k];
    p.m[2][3] = -front * dot(n, eye);
    if (auto ok = check_matrix(matrix(p.m), "perspective"); !ok) return std::unexpected(ok.error());
    return p;
}

namespace {

template <class To, std::size_t N, class From>
Result<Transformed<Patch<N, To>>> affine(const Patch<N, From>& patch, const Matrix& linear,
                                         std::span<const double> offset) {
    if (auto ok = check_matrix(linear, "linear"); !ok) return std::unexpected(ok.error());
    const Image image = affine_image(tuples(patch.net().flat()), linear, offset);
    return finished(
        Patch<N, To>::make(patch.bases(), Net<N, To>(patch.net().extent(), coefficients<To>(image.all))),
        image.most.numerator * (1 + 8 * kUnitRoundoff));
}

}  // namespace

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Vec<To>>>> transform(const Patch<N, Vec<From>>& patch,
                                                 const Affinity<To, From>& map) {
    return affine<Vec<To>>(patch, matrix(map.linear), map.offset.c);
}

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Affinity<To, From>& map) {
    return affine<Hom<To>>(patch, matrix(map.linear), map.offset.c);
}

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Projectivity<To, From>& map) {
    if (auto ok = check_matrix(matrix(map.m), "m"); !ok) return std::unexpected(ok.error());
    const Image image = projective_image(tuples(patch.net().flat()), matrix(map.m));
    auto form = positive_weights<N, To>(
        patch.bases(), Net<N, Hom<To>>(patch.net().extent(), coefficients<Hom<To>>(image.all)));
    if (!form) return std::unexpected(form.error());
    const double bound = projective_bound(tuples(form->patch.net().flat()), image, form->bound);
    return finished(Result<Patch<N, Hom<To>>>(std::move(form->patch)), bound);
}

#define FF_TRANSFORM(N, To, From)                                                         \
    template Result<Transformed<Patch<N, Vec<To>>>> transform(const Patch<N, Vec<From>>&, \
                                                              const Affinity<To, From>&); \
    template Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>&, \
                                                              const Affinity<To, From>&); \
    template Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>&, \
                                                              const Projectivity<To, From>&);
#define FF_TRANSFORM_ALL(N) \
    FF_TRANSFORM(N, 1, 1)   \
    FF_TRANSFORM(N, 2, 2)   \
    FF_TRANSFORM(N, 3, 3)   \
    FF_TRANSFORM(N, 4, 4) FF_TRANSFORM(N, 2, 3) FF_TRANSFORM(N, 3, 2) FF_TRANSFORM(N, 3, 4)
FF_TRANSFORM_ALL(1)
FF_TRANSFORM_ALL(2)
FF_TRANSFORM_ALL(3)
#undef FF_TRANSFORM
#undef FF_TRANSFORM_ALL

}  // namespace freiform
