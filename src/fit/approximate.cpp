// Points to parameters, the search (approximate_search.cpp) among some of them and among all, and the report.
#include "approximate_search_detail.hpp"
#include "fit_report_detail.hpp"

#include <freiform/fit/approximate.hpp>
#include <freiform/spline/wide.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

namespace {

using detail::ApproximationSearch;

// Of many points every k-th says where the knots have to be; all of them decide.
template <int D>
std::vector<double> knots_from_some(std::span<const Vec<D>> points, const std::vector<double>& at, double end,
                                    int degree, const ApproximateOptions& options, int& solves) {
    constexpr std::size_t kEnough = 3000;
    const std::size_t step = points.size() / kEnough;
    if (step < 2) return {};
    std::vector<Vec<D>> some;
    std::vector<double> some_at;
    for (std::size_t i = 0; i < points.size();
         i = i + 1 < points.size() ? std::min(i + step, points.size() - 1) : points.size())
        some.push_back(points[i]), some_at.push_back(at[i]);
    ApproximationSearch<D> search(some, some_at, end, degree, options, {});
    bool done = false;
    const auto best = search.run(done);
    solves += search.solves();
    return done ? ApproximationSearch<D>::inner_of(*best) : std::vector<double>();
}

// Parameters of the points; equal neighbours share one.
template <int D>
Result<std::vector<double>> shared_parameters(std::span<const Vec<D>> points, const ApproximateOptions& o,
                                              double& end) {
    std::vector<Vec<D>> distinct;
    std::vector<std::size_t> which;
    for (const Vec<D>& q : points) {
        if (distinct.empty() || distinct.back() != q) distinct.push_back(q);
        which.push_back(distinct.size() - 1);
    }
    const bool returns = o.closed && distinct.size() > 1 && distinct.back() == distinct.front();
    if (returns) distinct.pop_back();
    const std::size_t least = o.closed ? 3 : 2;
    if (distinct.size() < least)
        return refuse(RefusalKind::invalid, "points",
                      distinct.size() == 1 && points.size() > 1
                          ? text("all ", points.size(), " points are equal")
                          : text(distinct.size(), distinct.size() == 1 ? " point; " : " different points; ",
                                 o.closed ? "a closed curve" : "a curve", " needs ", least));
    auto at = parameters<D>(distinct, o.spacing, o.closed);
    if (!at) return at;
    end = at->back();
    std::vector<double> out;
    for (const std::size_t k : which) out.push_back(k < distinct.size() ? (*at)[k] : end);
    return out;
}

template <int D>
Result<void> check(std::span<const Vec<D>> points, const ApproximateOptions& o,
                   std::span<const KeptPoint<D>> kept) {
    if (!(o.tolerance > 0) || !std::isfinite(o.tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(o.tolerance, " is not a positive distance"));
    if (o.degree < 1 || o.degree > kMaxDegree)
        return refuse(o.degree < 1 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", o.degree, " is outside 1..", kMaxDegree));
    if (!(o.smoothing >= 0) || !std::isfinite(o.smoothing))
        return refuse(RefusalKind::invalid, "smoothing", text(o.smoothing, " is not a number >= 0"));
    if (o.smoothing_order < 1 || o.smoothing_order > kMaxDegree)
        return refuse(RefusalKind::invalid, "smoothing_order",
                      text(o.smoothing_order, " is outside 1..", kMaxDegree));
    if (points.size() < 2)
        return refuse(RefusalKind::invalid, "points",
                      text(points.size(), points.size() == 1 ? " point; " : " points; ", "a curve needs 2"));
    if (points.size() > 0x08000000) return refuse(RefusalKind::limit, "points", "more than 2^27 points");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto where = text("kept[", i, "]");
        if (kept[i].point < 0 || std::size_t(kept[i].point) >= points.size())
            return refuse(RefusalKind::invalid, where, text("point ", kept[i].point, " does not exist"));
        if (kept[i].order < 0 || kept[i].order > o.degree)
            return refuse(RefusalKind::invalid, where,
                          text("order ", kept[i].order, " is outside 0..", o.degree));
        if (!is_finite(kept[i].value))
            return refuse(RefusalKind::nonfinite, where, "has a coordinate that is not finite");
        for (std::size_t j = 0; j < i; ++j)
            if (kept[j].point == kept[i].point && kept[j].order == kept[i].order)
                return refuse(RefusalKind::invalid, where,
                              text("is about the same derivative as kept[", j, "]"));
        if (kept[i].order == 0 && norm(kept[i].value - points[std::size_t(kept[i].point)]) > o.tolerance)
            return refuse(RefusalKind::invalid, where,
                          text("is farther than the tolerance from point ", kept[i].point));
    }
    return {};
}

}  // namespace

template <int D>
static Result<Fitted<D>> fitted_to(std::span<const Vec<D>> points, const ApproximateOptions& options,
                                   std::span<const KeptPoint<D>> kept) {
    if (auto ok = check(points, options, kept); !ok) return std::unexpected(ok.error());
    double end = 0;
    auto at = shared_parameters(points, options, end);
    if (!at) return std::unexpected(at.error());
    // Few points determine a curve of lower degree, which is raised in the end.
    std::size_t conditions = 1;
    for (std::size_t i = 1; i < at->size(); ++i) conditions += (*at)[i] != (*at)[i - 1];
    for (const auto& k : kept) conditions += k.order > 0;
    const int degree = options.closed || options.smoothing > 0
                           ? options.degree
                           : int(std::min<std::size_t>(std::size_t(options.degree), conditions - 1));
    ApproximationSearch<D> search(points, *at, end, degree, options, kept);
    bool done = false;
    int solves = 0;
    std::optional<typename ApproximationSearch<D>::Candidate> best;
    if (const auto inner =
            kept.empty() ? knots_from_some(points, *at, end, degree, options, solves) : std::vector<double>();
        !inner.empty())
        best = search.run_from(inner, done);
    if (!done) best = search.run(done);
    if (!best)
        return refuse(RefusalKind::no_answer, "points",
                      "do not determine a curve: too few of them are different, or the conditions contradict "
                      "each other");
    if (!done)
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("the closest curve found, with ", best->curve.basis().size(),
                           " coefficients, is at a distance of ", best->error));
    auto curve = elevate(best->curve, 0, options.degree - degree);
    if (!curve) return std::unexpected(curve.error());
    std::vector<Datum<D>> values;
    for (const auto& k : kept) values.push_back({best->at[std::size_t(k.point)], k.order, k.value});
    auto fitted =
        detail::reported<D>(std::move(*curve), points, std::move(best->at), values, solves + search.solves());
    if (fitted && !(fitted->report.bound <= options.tolerance))
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("rounding leaves the curve at a distance of up to ", fitted->report.bound));
    return fitted;
}

template <int D>
Result<Fitted<D>> approximate(std::span<const Vec<D>> points, const ApproximateOptions& options,
                              std::span<const KeptPoint<D>> kept) {
    if constexpr (detail::kIsWidened<Vec<D>>) {
        std::vector<KeptPoint<detail::kWidest>> wide_kept;
        for (const KeptPoint<D>& k : kept) wide_kept.push_back({k.point, k.order, detail::widened(k.value)});
        auto made = fitted_to<detail::kWidest>(detail::widened(points), options, wide_kept);
        if (!made) return std::unexpected(made.error());
        return Fitted<D>{detail::narrowed<D>(made->curve), std::move(made->at), made->report};
    } else {
        return fitted_to(points, options, kept);
    }
}

#define FF_APPROXIMATE(D)                                                                      \
    template Result<Fitted<D>> approximate(std::span<const Vec<D>>, const ApproximateOptions&, \
                                           std::span<const KeptPoint<D>>);
FF_APPROXIMATE(1)
FF_APPROXIMATE(2)
FF_APPROXIMATE(3)
FF_APPROXIMATE(4)
#undef FF_APPROXIMATE

}  // namespace freiform
