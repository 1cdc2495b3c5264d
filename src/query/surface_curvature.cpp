// Idea. Curvatures are short formulas in the derivatives; their errors are dominated by cancellation in the
// derivatives of near-degenerate surfaces, which no fixed number of ulps describes. So all of it is computed
// with numbers that carry their error bounds (core/bounded.hpp), beginning with the derivatives.
//
// Notation. h(u, v) = sum_ab N_a(u) N_b(v) c_ab: the homogeneous surface. W_a: the computed derivatives of
// one order of the basis functions. |W|_a: the same recurrence with every difference replaced by a sum.
//
// Method.
// Derivatives: sum_ab W_a W_b c_ab, and the quotient rule in bounded numbers.
// Curvatures: in the orthonormal tangent frame e1 = S_u / |S_u|, e2 = n x e1 the second fundamental form is a
// symmetric matrix (h11 h12; h12 h22); k = mean +- hypot((h11 - h22) / 2, h12), which, unlike
// mean +- sqrt(mean^2 - gauss), keeps full accuracy at umbilic points.
// Limit normals: along uv + s d, S_u x S_v is a power series in s with the coefficients
// c_m = sum_{i+j=m} (d^i S_u) x (d^j S_v) / (i! j!); the first that is not 0 is the direction of the limit.
//
// Accuracy. A step of the recurrence of the basis (blossom.hpp) makes at most 8 roundings: two differences of
// knots and parameter, their widths, two divisions, two products, a sum. Value steps add numbers that are not
// negative, so their error is relative; derivative steps subtract, and there the error is relative to |W|.
// With the factor of each order that makes |W computed - W| <= 9 p 2^-53 |W| up to higher powers, and the
// sums over a and b add a rounding per term. Hence the radius (10 (p + q) + 16) 2^-53 sum |W_a||W_b||c_ab|;
// the factor 1.01 covers the higher powers and the rounding of the radius itself, which are below 1e-12 of
// it.
#include <freiform/query/surface_curvature.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

namespace {

// One order of derivatives of the basis functions that are not 0 near u: computed, and with sums for
// differences.
struct BasisRow {
    int first = 0;
    std::vector<double> value, size;
};

// b := |b| * |dR_k/dx|: derivative_step with its subtraction an addition.
template <class B>
void derivative_step_size(const B& basis, int span, int k, double* b) {
    double carry = 0;
    for (int r = 0; r < k; ++r) {
        const double q = b[r] / (basis.knot(span + 1 + r) - basis.knot(span + 1 - k + r));
        b[r] = carry + q;
        carry = q;
    }
    b[k] = carry;
}

// In the span that ends in u where `left`, else in the one that begins there.
template <class B>
BasisRow basis_row(const B& basis, double u, int order, bool left) {
    const auto p = std::size_t(basis.degree());
    double inside = basis.wrap(u);
    if (left && inside == basis.domain().lo && inside != u) inside = basis.domain().hi;
    int span = basis.span(inside);
    while (left && span > basis.degree() && !(basis.knot(span) < inside)) --span;
    BasisRow row{span - int(p), std::vector<double>(p + 1), std::vector<double>(p + 1)};
    weights_in_span(basis, span, inside, order, row.value.data());
    if (order > int(p)) return row;
    row.size[0] = 1;
    for (int k = 1; k <= int(p) - order; ++k) blossom_step(basis, span, k, inside, row.size.data());
    for (int k = int(p) - order + 1; k <= int(p); ++k) {
        derivative_step_size(basis, span, k, row.size.data());
        for (int i = 0; i <= k; ++i) row.size[std::size_t(i)] *= k;
    }
    return row;
}

template <class P>
using Homogeneous = std::array<Bounded, std::size_t(P::kCoords)>;

// Partial derivatives of the coefficients' own space, before projection.
template <class P, class B>
std::vector<Homogeneous<P>> raw_derivatives(const Surface<P, B>& s, const Param<2>& uv, int order,
                                            std::array<bool, 2> left = {}) {
    std::array<std::vector<BasisRow>, 2> rows;
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (int i = 0; i <= order; ++i)
            rows[axis].push_back(basis_row(s.basis(int(axis)), uv[axis], i, left[axis]));
    const int p = s.basis(0).degree(), q = s.basis(1).degree();
    const double relative = 1.01 * (10.0 * (p + q) + 16) * 0x1p-53;
    const auto net = s.net().view();
    std::vector<Homogeneous<P>> out(jet_size(2, order));
    for (const Index<2>& o : jet_orders<2>(order)) {
        const BasisRow &a = rows[0][std::size_t(o[0])], &b = rows[1][std::size_t(o[1])];
        P sum{}, size{};
        for (int i = 0; i <= p; ++i)
            for (int j = 0; j <= q; ++j) {
                const P& c = net({(a.first + i) % net.extent[0], (b.first + j) % net.extent[1]});
                const double w = a.value[std::size_t(i)] * b.value[std::size_t(j)];
                const double m = a.size[std::size_t(i)] * b.size[std::size_t(j)];
                for (int d = 0; d < P::kCoords; ++d) sum[d] += w * c[d], size[d] += m * std::abs(c[d]);
            }
        for (int d = 0; d < P::kCoords; ++d) out[jet_slot(o)][std::size_t(d)] = {sum[d], relative * size[d]};
    }
    return out;
}

BoundedVec<3> scaled(const BoundedVec<3>& a, const Bounded& by) { return {a[0] * by, a[1] * by, a[2] * by}; }
BoundedVec<3> sum_of(const BoundedVec<3>& a, const BoundedVec<3>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec<3> values(const BoundedVec<3>& a) { return {{a[0].value, a[1].value, a[2].value}}; }

// The quotient rule of project_jet (jet.hpp) with bounded numbers.
template <class P>
std::vector<BoundedVec<3>> projected(const std::vector<Homogeneous<P>>& h, int order) {
    std::vector<BoundedVec<3>> out(h.size());
    for (int total = 0; total <= order; ++total)
        for (int j = 0; j <= total; ++j) {
            const Index<2> a{total - j, j};
            BoundedVec<3>& to = out[jet_slot(a)];
            for (std::size_t d = 0; d < 3; ++d) to[d] = h[jet_slot(a)][d];
            if constexpr (Space<P>::kRational) {
                for (int k = 0; k <= a[0]; ++k)
                    for (int l = 0; l <= a[1]; ++l) {
                        if (k + l == 0) continue;
                        const Bounded w =
                            Bounded(-binomial(a[0], k) * binomial(a[1], l)) * h[jet_slot(Index<2>{k, l})][3];
                        to = sum_of(to, scaled(out[jet_slot(Index<2>{a[0] - k, a[1] - l})], w));
                    }
                for (Bounded& x : to) x = x / h[0][3];
            }
        }
    return out;
}

template <class P, class B>
Result<void> check(const Surface<P, B>& s, const Param<2>& uv) {
    for (int axis = 0; axis < 2; ++axis) {
        const double x = uv[std::size_t(axis)];
        const Interval on = s.basis(axis).domain();
        if (!std::isfinite(x)) return refuse(RefusalKind::nonfinite, text("uv[", axis, "]"), text("is ", x));
        if (!on.contains(s.basis(axis).wrap(x)))
            return refuse(RefusalKind::out_of_domain, text("uv[", axis, "]"),
                          text(x, " is outside the domain [", on.lo, ", ", on.hi, "]"));
    }
    return {};
}

// The exact vector is certainly not zero.
bool excludes_zero(const BoundedVec<3>& a) {
    return a[0].excludes_zero() || a[1].excludes_zero() || a[2].excludes_zero();
}

// a / |a|; scaled by a power of two first, so that squares neither overflow nor underflow.
BoundedVec<3> bounded_unit(BoundedVec<3> a) {
    const double m = max_abs(values(a));
    if (m > 0 && std::isfinite(m)) {
        const int e = -std::ilogb(m);
        for (Bounded& x : a) x = {std::scalbn(x.value, e), std::scalbn(x.bound, e)};
    }
    const Bounded length = sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

template <class B>
bool is_closed(const B& basis) {
    if constexpr (requires { basis.is_closed(); })
        return basis.is_closed();
    else
        return false;
}

// c_m of the essay, from derivatives `s` of order m + 1 or more.
BoundedVec<3> series_of_normal(const std::vector<BoundedVec<3>>& s, const Vec<2>& d, int m) {
    // (d grad)^i of S_u (axis 0) or S_v (axis 1), over i!.
    const auto along = [&](int i, int axis) {
        BoundedVec<3> sum{};
        Bounded factorial(1);
        for (int k = 2; k <= i; ++k) factorial = factorial * Bounded(k);
        for (int k = 0; k <= i; ++k) {
            Bounded c(binomial(i, k));
            for (int r = 0; r < i; ++r) c = c * Bounded(r < k ? d[1] : d[0]);
            sum = sum_of(sum, scaled(s[jet_slot(Index<2>{i - k + (axis == 0), k + (axis == 1)})], c));
        }
        return scaled(sum, Bounded(1) / factorial);
    };
    BoundedVec<3> c{};
    for (int i = 0; i <= m; ++i) c = sum_of(c, cross(along(i, 0), along(m - i, 1)));
    return c;
}

}  // namespace

template <class P, class B>
requires(Space<P>::kDim == 3) std::vector<BoundedVec<3>> bounded_derivatives(const Surface<P, B>& s,
                                                                             const Param<2>& uv, int order) {
    return projected<P>(raw_derivatives(s, uv, order), order);
}

Result<SurfaceCurvature> surface_curvature(const std::array<BoundedVec<3>, 6>& jet) {
    const auto &su = jet[1], &sv = jet[2], &suu = jet[3], &suv = jet[4], &svv = jet[5];
    const BoundedVec<3> across = cross(su, sv);
    if (!excludes_zero(across))
        return refuse(
            RefusalKind::ill_conditioned, "uv",
            "S_u and S_v are parallel there as far as rounding tells: there is no normal and no curvature");
    SurfaceCurvature c;
    c.normal = bounded_unit(across);
    c.E = dot(su, su), c.F = dot(su, sv), c.G = dot(sv, sv);
    c.L = dot(suu, c.normal), c.M = dot(suv, c.normal), c.N = dot(svv, c.normal);
    // The longer of the two derivatives is the first axis of the frame: first = length e1,
    // second = x e1 + y e2.
    const bool swap = c.G.value > c.E.value;
    const auto& first = swap ? sv : su;
    const auto& second = swap ? su : sv;
    const Bounded length = sqrt(dot(first, first));
    const BoundedVec<3> e1 = scaled(first, Bounded(1) / length), e2 = cross(c.normal, e1);
    const Bounded x = dot(second, e1), y = dot(second, e2);
    const Bounded l = swap ? c.N : c.L, n = swap ? c.L : c.N;
    const Bounded h11 = l / (length * length);
    const Bounded h12 = (c.M / length - x * h11) / y;
    const Bounded h22 = ((n - x * (c.M / length)) / y - x * h12) / y;
    c.mean = Bounded(0.5) * (h11 + h22);
    c.gauss = h11 * h22 - h12 * h12;
    // hypot moves by no more than its arguments do, and is rounded to less than 2^-51 of itself.
    const Bounded apart = Bounded(0.5) * (h11 - h22);
    const double r = std::hypot(apart.value, h12.value);
    const Bounded spread{r, (apart.bound + h12.bound + r * 0x1p-51) * (1 + 0x1p-40)};
    c.greatest = c.mean + spread, c.least = c.mean - spread;
    c.umbilic = !spread.excludes_zero();
    for (const Bounded* k : {&c.mean, &c.gauss, &c.greatest, &c.least})
        if (!std::isfinite(k->value) || !std::isfinite(k->bound))
            return refuse(RefusalKind::ill_conditioned, "uv",
                          "the parameter lines are so skew or so short there that rounding leaves nothing of "
                          "the curvature");
    const double angle = 0.5 * std::atan2(2 * h12.value, h11.value - h22.value);
    const Vec<3> a = values(e1), b = values(e2);
    c.along_greatest = std::cos(angle) * a + std::sin(angle) * b;
    c.along_least = std::cos(angle) * b - std::sin(angle) * a;
    return c;
}

template <class P, class B>
requires(Space<P>::kDim == 3) Result<SurfaceCurvature> surface_curvature(const Surface<P, B>& s,
                                                                         const Param<2>& uv) {
    if (auto ok = check(s, uv); !ok) return std::unexpected(ok.error());
    const auto d = bounded_derivatives(s, uv, 2);
    return surface_curvature(std::array<BoundedVec<3>, 6>{d[0], d[1], d[2], d[3], d[4], d[5]});
}

// Derivatives of order r of a triangle of degree n are those of nets of differences: exact up to
// 2^r n! / (n - r)! times the largest coefficient times the roundings of r differences, n - r steps of de
// Casteljau (three products and two sums of barycentric coordinates of which one is rounded) and the factors.
template <class P>
requires(Space<P>::kDim == 3) Result<SurfaceCurvature> surface_curvature(const SimplexPatch<2, P>& s,
                                                                         const Param<2>& uv) {
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1]))
        return refuse(RefusalKind::nonfinite, "uv", text("is (", uv[0], ", ", uv[1], ")"));
    if (!SimplexPatch<2, P>::contains(uv))
        return refuse(RefusalKind::out_of_domain, "uv",
                      text("(", uv[0], ", ", uv[1], ") is outside the triangle"));
    std::vector<Vec<P::kCoords>> raised;
    P largest{};
    for (const P& p : s.coefficients()) {
        raised.push_back({p.c});
        for (int d = 0; d < P::kCoords; ++d) largest[d] = std::max(largest[d], std::abs(p[d]));
    }
    const int n = s.degree();
    const auto d = SimplexPatch<2, Vec<P::kCoords>>::trusted(n, std::move(raised)).derivatives(uv, 2);
    std::vector<Homogeneous<P>> h(6);
    for (const Index<2>& o : jet_orders<2>(2)) {
        const int r = o[0] + o[1];
        const double factor = r == 0 ? 1 : r == 1 ? 2.0 * n : 4.0 * n * std::max(n - 1, 0);
        const double relative = 1.01 * (8.0 * n + 16) * 0x1p-53 * factor;
        for (int k = 0; k < P::kCoords; ++k)
            h[jet_slot(o)][std::size_t(k)] = {d[jet_slot(o)][k], relative * largest[k]};
    }
    const auto e = projected<P>(h, 2);
    return surface_curvature(std::array<BoundedVec<3>, 6>{e[0], e[1], e[2], e[3], e[4], e[5]});
}

template <class P, class B>
requires(Space<P>::kDim == 3) Result<LimitNormal> limit_normal(const Surface<P, B>& s, const Param<2>& uv,
                                                               const Vec<2>& direction) {
    if (auto ok = check(s, uv); !ok) return std::unexpected(ok.error());
    if (!is_finite(direction) || max_abs(direction) == 0)
        return refuse(RefusalKind::invalid, "direction", "is not a finite vector other than zero");
    std::array<bool, 2> left{};
    for (int axis = 0; axis < 2; ++axis) {
        const Interval on = s.basis(axis).domain();
        const double x = uv[std::size_t(axis)];
        if (!is_closed(s.basis(axis)) &&
            ((x == on.lo && direction[axis] < 0) || (x == on.hi && direction[axis] > 0)))
            return refuse(RefusalKind::out_of_domain, text("direction[", axis, "]"),
                          "leaves the domain at once");
        left[std::size_t(axis)] = direction[axis] < 0;
    }
    const Vec<2> d = (1 / max_abs(direction)) * direction;
    const int most = 2 * (s.basis(0).degree() + s.basis(1).degree());
    for (int m = 0; m <= most; ++m) {
        const auto c = series_of_normal(projected<P>(raw_derivatives(s, uv, m + 1, left), m + 1), d, m);
        if (!excludes_zero(c)) continue;
        const BoundedVec<3> n = bounded_unit(c);
        const Vec<3> error{{n[0].bound, n[1].bound, n[2].bound}};
        return LimitNormal{values(n), norm(error) * (1 + 0x1p-40), m};
    }
    return refuse(RefusalKind::ill_conditioned, "uv",
                  text("S_u x S_v and its derivatives along the direction up to order ", most,
                       " are 0 as far as rounding tells"));
}

template <class P, class B>
requires(Space<P>::kDim == 3) Result<LimitNormal> limit_normal(const Surface<P, B>& s, const Param<2>& uv) {
    Vec<2> direction{};
    for (int axis = 0; axis < 2; ++axis) {
        const Interval on = s.basis(axis).domain();
        const double x = uv[std::size_t(axis)];
        if (!is_closed(s.basis(axis)) && (x == on.lo || x == on.hi))
            direction[axis] = x == on.lo ? on.length() : -on.length();
    }
    if (max_abs(direction) == 0) direction = {{s.basis(0).domain().length(), s.basis(1).domain().length()}};
    return limit_normal(s, uv, direction);
}

#define FF_INSTANTIATE(P, B)                                                                             \
    template std::vector<BoundedVec<3>> bounded_derivatives(const Surface<P, B>&, const Param<2>&, int); \
    template Result<SurfaceCurvature> surface_curvature(const Surface<P, B>&, const Param<2>&);          \
    template Result<LimitNormal> limit_normal(const Surface<P, B>&, const Param<2>&, const Vec<2>&);     \
    template Result<LimitNormal> limit_normal(const Surface<P, B>&, const Param<2>&);
FF_INSTANTIATE(Vec<3>, BSplineBasis)
FF_INSTANTIATE(Hom<3>, BSplineBasis)
FF_INSTANTIATE(Vec<3>, Bernstein)
FF_INSTANTIATE(Hom<3>, Bernstein)
#undef FF_INSTANTIATE
template Result<SurfaceCurvature> surface_curvature(const SimplexPatch<2, Vec<3>>&, const Param<2>&);
template Result<SurfaceCurvature> surface_curvature(const SimplexPatch<2, Hom<3>>&, const Param<2>&);

}  // namespace freiform
