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
#include <freiform/spline/transform.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kUnit = 0x1p-53;

template <std::size_t Rows, std::size_t Columns>
Result<void> check_matrix(const std::array<std::array<double, Columns>, Rows>& m, std::string_view name) {
    for (std::size_t i = 0; i < Rows; ++i)
        for (std::size_t j = 0; j < Columns; ++j)
            if (!std::isfinite(m[i][j]))
                return refuse(RefusalKind::nonfinite, text(name, "[", i, "][", j, "]"),
                              text(m[i][j], " is not a finite number"));
    return {};
}

// The error bounds of the coefficients of an image, as far as they matter.
struct Errors {
    double numerator = 0, weight = 0;  // the largest
};

// |row . p|, exact up to the bound.
template <std::size_t Columns, class P>
Bounded product(const std::array<double, Columns>& row, const P& p) {
    Bounded s;
    for (std::size_t j = 0; j < Columns; ++j)
        if (row[j] != 0 && p[int(j)] != 0) s = s + Bounded(row[j]) * Bounded(p[int(j)]);
    return s;
}

template <std::size_t N, class P>
double reach_of(const Net<N, P>& net) {
    double r = 0;
    for (const P& p : net.flat()) r = std::max(r, norm(project(p)));
    return r * (1 + 8 * kUnit);
}

// (moved + reach rho) / (1 - rho); infinite where nothing is proven.
double distance(double moved, double reach, double rho) {
    if (!(rho < 0.5)) return std::numeric_limits<double>::infinity();
    return (moved + reach * rho) / (1 - rho) * (1 + 32 * kUnit);
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
    if (!(size > 16 * kUnit * norm(a) * norm(b)))
        return refuse(RefusalKind::ill_conditioned, "up", "is parallel to `across`");
    if (!(std::abs(depth) > 16 * kUnit * norm(a) * norm(b) * (norm(origin) + norm(eye))))
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
    if (auto ok = check_matrix(p.m, "perspective"); !ok) return std::unexpected(ok.error());
    return p;
}

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Vec<To>>>> transform(const Patch<N, Vec<From>>& patch,
                                                 const Affinity<To, From>& map) {
    if (auto ok = check_matrix(map.linear, "linear"); !ok) return std::unexpected(ok.error());
    double bound = 0;
    std::vector<Vec<To>> out;
    for (const Vec<From>& p : patch.net().flat()) {
        Vec<To> x, e;
        for (int i = 0; i < To; ++i) {
            const Bounded s = product(map.linear[std::size_t(i)], p) + Bounded(map.offset[i]);
            x[i] = s.value, e[i] = s.bound;
        }
        bound = std::max(bound, norm(e));
        out.push_back(x);
    }
    return finished(Patch<N, Vec<To>>::make(patch.bases(), Net<N, Vec<To>>(patch.net().extent(), out)),
                    bound * (1 + 8 * kUnit));
}

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Affinity<To, From>& map) {
    if (auto ok = check_matrix(map.linear, "linear"); !ok) return std::unexpected(ok.error());
    double bound = 0;
    std::vector<Hom<To>> out;
    for (const Hom<From>& p : patch.net().flat()) {
        Hom<To> x;
        Vec<To> e;
        for (int i = 0; i < To; ++i) {
            const Bounded s =
                product(map.linear[std::size_t(i)], p) + Bounded(map.offset[i]) * Bounded(p.weight());
            x[i] = s.value, e[i] = s.bound / p.weight();
        }
        x[To] = p.weight();
        bound = std::max(bound, norm(e));
        out.push_back(x);
    }
    return finished(Patch<N, Hom<To>>::make(patch.bases(), Net<N, Hom<To>>(patch.net().extent(), out)),
                    bound * (1 + 8 * kUnit));
}

template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Projectivity<To, From>& map) {
    if (auto ok = check_matrix(map.m, "m"); !ok) return std::unexpected(ok.error());
    std::vector<Hom<To>> out;
    std::vector<Errors> errors;
    Errors most;
    for (const Hom<From>& p : patch.net().flat()) {
        Hom<To> x;
        Vec<To> e;
        for (int i = 0; i < To; ++i) {
            const Bounded s = product(map.m[std::size_t(i)], p);
            x[i] = s.value, e[i] = s.bound;
        }
        const Bounded w = product(map.m[To], p);
        x[To] = w.value;
        out.push_back(x);
        errors.push_back({norm(e), w.bound});
        most.numerator = std::max(most.numerator, errors.back().numerator);
        most.weight = std::max(most.weight, w.bound);
    }
    auto form = positive_weights<N, To>(patch.bases(), Net<N, Hom<To>>(patch.net().extent(), std::move(out)));
    if (!form) return std::unexpected(form.error());
    const auto& net = form->patch.net();
    double moved = 0, rho = 0;
    for (std::size_t i = 0; i < net.flat().size(); ++i) {
        const Errors& e = form->bound == 0 ? errors[i] : most;
        moved = std::max(moved, e.numerator / net.flat()[i].weight());
        rho = std::max(rho, e.weight / net.flat()[i].weight());
    }
    const double bound = distance(moved, reach_of(net) + form->bound, rho) + form->bound;
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

}  // namespace freiform
