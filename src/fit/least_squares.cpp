// The method is in least_squares_system.cpp; here the input is checked and the answer measured.
//
// A value that is kept at a clamped end of the domain is a coefficient; it is set to the bit afterwards,
// which moves the curve by no more than the rounding of the solution.
#include "fit/checks_detail.hpp"
#include "fit_report_detail.hpp"
#include "least_squares_detail.hpp"

#include <freiform/fit/least_squares.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::KeptRow;
using detail::LeastSquaresSystem;

Result<void> check_sites(const BSplineBasis& basis, std::span<const double> at, std::size_t points,
                         const std::string& name) {
    if (at.size() != points)
        return refuse(RefusalKind::invalid, name, text(at.size(), " parameters for ", points, " points"));
    const Interval on = basis.domain();
    for (std::size_t i = 0; i < at.size(); ++i) {
        const auto where = text(name, "[", i, "]");
        if (!std::isfinite(at[i]))
            return refuse(RefusalKind::nonfinite, where, text(at[i], " is not a finite number"));
        if (!on.contains(at[i]))
            return refuse(RefusalKind::out_of_domain, where,
                          text(at[i], " is outside the domain [", on.lo, ", ", on.hi, "]"));
        if (i > 0 && at[i] < at[i - 1])
            return refuse(RefusalKind::invalid, where, text("decreases: ", at[i - 1], " -> ", at[i]));
    }
    return {};
}

template <int D>
Result<std::vector<KeptRow>> check_kept(const BSplineBasis& basis, std::span<const Datum<D>> kept) {
    std::vector<KeptRow> rows;
    const Interval on = basis.domain();
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto where = text("kept[", i, "]");
        if (!std::isfinite(kept[i].at) || !is_finite(kept[i].value))
            return refuse(RefusalKind::nonfinite, where, "has a number that is not finite");
        if (!on.contains(kept[i].at))
            return refuse(RefusalKind::out_of_domain, where,
                          text(kept[i].at, " is outside the domain [", on.lo, ", ", on.hi, "]"));
        if (kept[i].order < 0 || kept[i].order > basis.degree())
            return refuse(RefusalKind::invalid, where,
                          text("order ", kept[i].order, " is outside 0..", basis.degree()));
        for (std::size_t j = 0; j < i; ++j)
            if (kept[j].at == kept[i].at && kept[j].order == kept[i].order)
                return refuse(RefusalKind::invalid, where,
                              text("is about the same derivative as kept[", j, "]"));
        rows.push_back({kept[i].at, kept[i].order});
    }
    if (kept.size() > std::size_t(basis.size()))
        return refuse(RefusalKind::invalid, "kept",
                      text(kept.size(), " conditions, the basis has ", basis.size(), " functions"));
    return rows;
}

Result<void> check_options(std::size_t points, const LeastSquaresOptions& o) {
    if (!o.weights.empty() && o.weights.size() != points)
        return refuse(RefusalKind::invalid, "weights",
                      text(o.weights.size(), " weights for ", points, " points"));
    for (std::size_t i = 0; i < o.weights.size(); ++i)
        if (!(o.weights[i] > 0) || !std::isfinite(o.weights[i]))
            return refuse(RefusalKind::invalid, text("weights[", i, "]"),
                          text(o.weights[i], " is not positive"));
    if (!(o.smoothing >= 0) || !std::isfinite(o.smoothing))
        return refuse(RefusalKind::invalid, "smoothing", text(o.smoothing, " is not a number >= 0"));
    if (o.smoothing_order < 1 || o.smoothing_order > kMaxDegree)
        return refuse(RefusalKind::invalid, "smoothing_order",
                      text(o.smoothing_order, " is outside 1..", kMaxDegree));
    return {};
}

}  // namespace

template <int D>
Result<Fitted<D>> least_squares(const BSplineBasis& basis, std::span<const Vec<D>> points,
                                std::span<const double> at, std::span<const Datum<D>> kept,
                                const LeastSquaresOptions& options) {
    if (points.empty()) return refuse(RefusalKind::invalid, "points", "there are none");
    if (auto ok = detail::check_points(points, "points"); !ok) return std::unexpected(ok.error());
    if (auto ok = check_sites(basis, at, points.size(), "at"); !ok) return std::unexpected(ok.error());
    if (auto ok = check_options(points.size(), options); !ok) return std::unexpected(ok.error());
    const auto rows = check_kept(basis, kept);
    if (!rows) return std::unexpected(rows.error());
    if (options.smoothing == 0)
        if (auto ok = detail::check_determined(basis, at, *rows); !ok) return std::unexpected(ok.error());
    LeastSquaresSystem system(basis, detail::values_at(basis, at), options.weights, *rows,
                              {options.smoothing, options.smoothing_order});
    if (system.factor())
        return refuse(RefusalKind::ill_conditioned, "points",
                      "do not determine a curve on these knots, or the conditions contradict each other");
    std::vector<Vec<D>> values;
    for (const auto& k : kept) values.push_back(k.value);
    Net<1, Vec<D>> net({basis.size()});
    const Vec<D> none{};
    system.solve(&points[0].c[0], kept.empty() ? &none.c[0] : &values[0].c[0], &net.flat()[0].c[0], D, true);
    const Interval on = basis.domain();
    if (!basis.is_closed())
        for (const auto& k : kept) {
            if (k.order == 0 && k.at == on.lo && basis.knot(0) == on.lo) net.flat().front() = k.value;
            if (k.order == 0 && k.at == on.hi && basis.knot(basis.size() + basis.degree()) == on.hi)
                net.flat().back() = k.value;
        }
    auto curve = Curve<Vec<D>>::make({basis}, std::move(net));
    if (!curve) return refuse(RefusalKind::ill_conditioned, "points", "the curve leaves the range of double");
    return detail::reported<D>(std::move(*curve), points, {at.begin(), at.end()}, kept, 1);
}

template <int D>
Result<FittedSurface<D>> least_squares(const std::array<BSplineBasis, 2>& bases, const Net<2, Vec<D>>& points,
                                       const std::array<std::span<const double>, 2>& at) {
    if (points.flat().empty()) return refuse(RefusalKind::invalid, "points", "there are none");
    if (auto ok = detail::check_points<D>(points.flat(), "points"); !ok) return std::unexpected(ok.error());
    std::array<BandMap, 2> values;
    Net<2, Vec<D>> net = points;
    for (std::size_t d = 0; d < 2; ++d) {
        const auto name = text("at[", d, "]");
        const std::size_t m = std::size_t(points.extent()[d]);
        if (auto ok = check_sites(bases[d], at[d], m, name); !ok) return std::unexpected(ok.error());
        if (auto ok = detail::check_determined(bases[d], at[d], {}); !ok)
            return refuse_within(text("axes[", d, "]"), ok.error());
        values[d] = detail::values_at(bases[d], at[d]);
        LeastSquaresSystem system(bases[d], values[d], {}, {}, {});
        if (system.factor())
            return refuse(RefusalKind::ill_conditioned, name, "the points do not determine a surface");
        Index<2> extent = net.extent();
        const std::size_t n = std::size_t(bases[d].size()), outer = d == 0 ? 1 : std::size_t(extent[0]);
        const std::size_t width = (d == 0 ? std::size_t(extent[1]) : 1) * D;
        extent[d] = bases[d].size();
        Net<2, Vec<D>> next(extent);
        for (std::size_t o = 0; o < outer; ++o)
            system.solve(&net.flat()[0].c[0] + o * m * width, nullptr, &next.flat()[0].c[0] + o * n * width,
                         width, true);
        net = std::move(next);
    }
    auto surface = Surface<Vec<D>>::make(bases, std::move(net));
    if (!surface)
        return refuse(RefusalKind::ill_conditioned, "points", "the surface leaves the range of double");
    const Net<2, Vec<D>> value = along(1, values[1], along(0, values[0], surface->net()));
    detail::LargestResidual<D> largest;
    double sum = 0;
    const auto error = [&](std::size_t i) { return value.flat()[i] - points.flat()[i]; };
    for (std::size_t i = 0; i < points.flat().size(); ++i) largest.add(error(i));
    for (std::size_t i = 0; i < points.flat().size(); ++i) {
        const double r = largest.norm_ > 0 ? norm(error(i)) / largest.norm_ : 0;
        sum += r * r;
    }
    return FittedSurface<D>{*surface, detail::with_rounding(largest.norm_, *surface),
                            largest.norm_ * std::sqrt(sum / double(points.flat().size()))};
}

#define FF_LEAST_SQUARES(D)                                                                      \
    template Result<Fitted<D>> least_squares(const BSplineBasis&, std::span<const Vec<D>>,       \
                                             std::span<const double>, std::span<const Datum<D>>, \
                                             const LeastSquaresOptions&);                        \
    template Result<FittedSurface<D>> least_squares(const std::array<BSplineBasis, 2>&,          \
                                                    const Net<2, Vec<D>>&,                       \
                                                    const std::array<std::span<const double>, 2>&);
FF_LEAST_SQUARES(1)
FF_LEAST_SQUARES(2)
FF_LEAST_SQUARES(3)
FF_LEAST_SQUARES(4)
#undef FF_LEAST_SQUARES

}  // namespace freiform
