// Lofts: splines through the control points of sections.
//
// Idea: curves on one basis are rows of control points. A spline through the rows is a surface whose curve at
// the parameter of a row has these control points, hence is that curve.
//
// Method: one basis (compatible.hpp); parameters of the rows as the mean over all lines of control points
// (parameters.hpp); each line of control points interpolated along v (interpolate.hpp), homogeneous
// coordinates as they are.
//
// Accuracy: interpolation tells how far coefficient i of the curve at v = at[l] is from that of section l:
// r_i, and compatibility moved it by c. Basis functions are >= 0 with sum 1, so the curves differ by max r_i
// + c at most. Of rational curves numerators and weights differ by e and d, and
//     |n / w - N / W| = |(n - N) - N / W (w - W)| / w <= (e + |section| d) / min w.
//
// References: [PT97, 10.3].
//
// Why not knots and parameters for each line of control points of its own? Then it were no tensor product.
#include <freiform/fit/loft.hpp>
#include <freiform/spline/compatible.hpp>
#include <freiform/spline/weights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace freiform {

namespace {

template <class P>
Vec<P::kCoords> as_vector(const P& p) {
    Vec<P::kCoords> v;
    for (int i = 0; i < P::kCoords; ++i) v[i] = p[i];
    return v;
}

// Rational curves divided by the power of two of the largest weight.
template <class Q>
Curve<Q> normalised(const Curve<Q>& c) {
    if constexpr (!Space<Q>::kRational) return c;
    double heaviest = 0;
    for (const Q& p : c.net().flat()) heaviest = std::max(heaviest, Space<Q>::weight(p));
    auto net = c.net();
    for (Q& p : net.flat())
        for (double& x : p.c) x = std::scalbn(x, -std::ilogb(heaviest));
    return Curve<Q>::trusted(c.bases(), std::move(net));
}

Result<AxisSpline> axis_of(const LoftOptions& options, std::size_t sections) {
    if (options.degree < 1 || options.degree > kMaxDegree)
        return refuse(RefusalKind::invalid, "degree",
                      text(options.degree, " is not between 1 and ", kMaxDegree));
    if (!options.closed && options.ends != SplineEnds::natural && options.ends != SplineEnds::not_a_knot)
        return refuse(RefusalKind::unsupported, "ends",
                      text(name_of(options.ends), " ends; lofts have natural or not-a-knot ones"));
    const std::size_t least = options.closed ? 3 : 2;
    if (sections < least)
        return refuse(RefusalKind::invalid, "sections",
                      text(sections, sections == 1 ? " section" : " sections", ", a loft needs ", least));
    return AxisSpline{std::min(options.degree, int(sections) - 1),
                      options.closed ? SplineEnds::periodic : options.ends,
                      {}};
}

// How far the curve at at[l] may be from section l; the maximum.
template <class Q>
double distance(const Compatible<Q>& same, const Net<2, Q>& rows, double residual) {
    double most = 0;
    for (std::size_t l = 0; l < same.curves.size(); ++l) {
        double largest = 0, heaviest = 0, reach = 0, lightest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < rows.extent()[0]; ++i) {
            const Q& p = rows.view()({i, int(l)});
            const double w = Space<Q>::weight(p);
            double x = 0;
            for (int c = 0; c < 3; ++c) x = std::max(x, std::abs(p[c]));
            largest = std::max(largest, x);
            reach = std::max(reach, norm(project(p)));
            heaviest = std::max(heaviest, w), lightest = std::min(lightest, w);
        }
        const double moved = residual + std::sqrt(3) * same.relative[l] * largest;
        if constexpr (Space<Q>::kRational) {
            const double d = residual + same.relative[l] * heaviest, rho = d / lightest;
            // |section| <= reach + what its coefficients were moved by.
            const double from = (moved + reach * d) / lightest;
            most =
                rho < 0.25 ? std::max(most, from / (1 - 2 * rho)) : std::numeric_limits<double>::infinity();
        } else {
            most = std::max(most, moved);
        }
    }
    return most * (1 + 0x1p-40);
}

template <class Q>
Result<std::pair<Surface<Q>, double>> with_positive_weights(std::array<BSplineBasis, 2> bases,
                                                            Net<2, Q> net) {
    if constexpr (Space<Q>::kRational) {
        auto positive = positive_weights<2, 3>(bases, net);
        if (!positive) return refuse_within("sections", positive.error());
        return std::pair(std::move(positive->patch), positive->bound);
    } else {
        auto surface = Surface<Q>::make(std::move(bases), std::move(net));
        if (!surface) return refuse_within("sections", surface.error());
        return std::pair(std::move(*surface), 0.0);
    }
}

int continuity_of(const BSplineBasis& b) {
    int most = 0;
    for (const double t : b.breaks())
        if (b.is_closed() || (t != b.domain().lo && t != b.domain().hi))
            most = std::max(most, b.multiplicity(t));
    return b.degree() - most;
}

}  // namespace

template <class P>
Result<Loft<P>> loft(std::span<const Curve<P>> sections, const LoftOptions& options) {
    using Q = InSpace<P>;
    auto axis = axis_of(options, sections.size());
    if (!axis) return std::unexpected(axis.error());
    std::vector<Curve<Q>> curves;
    for (const Curve<P>& c : sections) curves.push_back(normalised(in_space(c)));
    const auto same = compatible(std::span<const Curve<Q>>(curves));
    if (!same) return refuse_within("sections", same.error());
    const BSplineBasis& along_u = same->curves[0].basis();
    const int n = along_u.size(), m = int(sections.size());
    Net<2, Q> rows({n, m});
    Net<2, Vec<3>> places({n, m});
    for (int l = 0; l < m; ++l)
        for (int i = 0; i < n; ++i) {
            rows.view()({i, l}) = same->curves[std::size_t(l)].net().flat()[std::size_t(i)];
            places.view()({i, l}) = project(rows.view()({i, l}));
        }
    auto at = parameters(places, 1, options.spacing, options.closed);
    if (!at) return refuse_within("sections", at.error());
    axis->at = *at;
    std::vector<Q> coefficients;
    std::optional<BSplineBasis> along_v;
    double residual = 0;
    for (int i = 0; i < n; ++i) {
        std::vector<Vec<Q::kCoords>> line;
        for (int l = 0; l < m; ++l) line.push_back(as_vector(rows.view()({i, l})));
        const auto spline = interpolate<Q::kCoords>(std::span<const Vec<Q::kCoords>>(line), *axis);
        if (!spline) return refuse_within("sections", spline.error());
        residual = std::max(residual, spline->bound);
        along_v = spline->patch.basis();
        for (const auto& c : spline->patch.net().flat()) {
            coefficients.emplace_back();
            std::copy(c.c.begin(), c.c.end(), coefficients.back().c.begin());
        }
    }
    const int k = along_v->size(), continuity = continuity_of(*along_v);
    auto surface =
        with_positive_weights<Q>({along_u, std::move(*along_v)}, Net<2, Q>({n, k}, std::move(coefficients)));
    if (!surface) return std::unexpected(surface.error());
    const double off = (distance(*same, rows, residual) + surface->second) * (1 + 0x1p-48);
    if (!std::isfinite(off))
        return refuse(RefusalKind::ill_conditioned, "sections", "rounding leaves nothing of their weights");
    if (options.closed) at->pop_back();
    return Loft<P>{std::move(surface->first), std::move(*at), off, continuity};
}

template Result<Loft<Vec<2>>> loft(std::span<const Curve<Vec<2>>>, const LoftOptions&);
template Result<Loft<Vec<3>>> loft(std::span<const Curve<Vec<3>>>, const LoftOptions&);
template Result<Loft<Hom<2>>> loft(std::span<const Curve<Hom<2>>>, const LoftOptions&);
template Result<Loft<Hom<3>>> loft(std::span<const Curve<Hom<3>>>, const LoftOptions&);

}  // namespace freiform
