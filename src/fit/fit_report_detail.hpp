// The distances that a fit reports, and why they are bounds.
//
// Points to curve: the distance of a point from the place of its own parameter is no smaller than that from
// the curve. It is measured with the rows of values_at() and rounding is added, as in interpolate.cpp.
//
// Curve to polygon: between two successive parameters the curve less the linear function through the two
// points is a spline; on every Bezier piece of it the difference of the coefficients bounds it (convex hull),
// and a place of the linear function is a place of the polygon. Two maps, insertion of the parameters as
// knots and extraction of pieces, leave each coefficient within 2 (12 p + 8) u max |P_i| (see
// derivative_bounds.cpp), the linear function adds 8 roundings of its ends.
#pragma once
#include "residual_detail.hpp"
#include "spline_system_detail.hpp"

#include <freiform/fit/least_squares.hpp>
#include <freiform/spline/bezier.hpp>

namespace freiform::detail {

// f(at_i) - Q_i, from the rows of values at the parameters.
template <int D>
void errors_at(const BandMap& values, std::span<const Vec<D>> net, std::span<const Vec<D>> points,
               std::vector<Vec<D>>& out) {
    out.resize(points.size());
    for (int i = 0; i < values.rows(); ++i) {
        Vec<D> sum{};
        int column = values.first[std::size_t(i)] % values.cols;
        for (const double w : values.row(i)) {
            sum += w * net[std::size_t(column)];
            if (++column == values.cols) column = 0;
        }
        out[std::size_t(i)] = sum - points[std::size_t(i)];
    }
}

template <int D>
Result<double> polyline_bound(const Curve<Vec<D>>& curve, std::span<const Vec<D>> points,
                              std::span<const double> at) {
    const BSplineBasis& basis = curve.basis();
    const Interval on = basis.domain();
    const bool closed = basis.is_closed();
    const auto breaks = basis.breaks();
    std::vector<double> more;
    for (const double t : at)
        if (on.lo < t && t < on.hi && (more.empty() || t != more.back()) &&
            !std::binary_search(breaks.begin(), breaks.end(), t))
            more.push_back(t);
    auto refined = insert_knots(curve, 0, more);
    if (!refined) return std::unexpected(refined.error());
    const BezierPieces<1, Vec<D>> pieces(*refined);
    const int p = pieces.degree(0);
    const std::size_t m = points.size();
    double most = 0, scale = 0;
    for (const Vec<D>& c : curve.net().flat()) scale = std::max(scale, max_abs(c));
    for (const Vec<D>& q : points) scale = std::max(scale, max_abs(q));
    std::size_t i = 0;  // the piece lies between the parameters of points i and i + 1
    for (int k = 0; k < pieces.extent()[0]; ++k) {
        const Interval box = pieces.box({k})[0];
        while (i + 1 < m && at[i + 1] <= box.lo) ++i;
        if (at[i] > box.lo || (i + 1 == m && !closed)) continue;  // before the first point, behind the last
        const double lo = at[i], hi = i + 1 < m ? at[i + 1] : at[0] + on.length();
        const Vec<D>&a = points[i], &b = points[(i + 1) % m];
        const auto net = pieces.net({k});
        for (int j = 0; j <= p; ++j) {
            const double t = p == 0 ? box.lo : box.lo + box.length() * (double(j) / p);
            const double s = std::clamp((t - lo) / (hi - lo), 0.0, 1.0);
            Vec<D> r;
            for (int c = 0; c < D; ++c) r[c] = net({j})[c] - ((1 - s) * a[c] + s * b[c]);
            most = std::max(most, norm(r));
        }
    }
    const double rounding = (2 * (12 * p + 8) + 8) * (std::numeric_limits<double>::epsilon() / 2) * scale;
    return (most + std::sqrt(double(D)) * rounding) * (1 + std::numeric_limits<double>::epsilon() * 8);
}

template <int D>
Result<Fitted<D>> reported(Curve<Vec<D>> curve, std::span<const Vec<D>> points, std::vector<double> at,
                           std::span<const Datum<D>> kept, int iterations) {
    Fitted<D> f{std::move(curve), std::move(at), {}};
    const BandMap values = values_at(f.curve.basis(), f.at);
    std::vector<Vec<D>> error;
    errors_at<D>(values, f.curve.net().flat(), points, error);
    LargestResidual<D> largest, missed;
    double sum = 0;
    for (const Vec<D>& e : error) largest.add(e);
    for (const Vec<D>& e : error) {  // relative to the largest, so that nothing underflows
        const double r = largest.norm_ > 0 ? norm(e) / largest.norm_ : 0;
        sum += r * r;
    }
    for (const Datum<D>& k : kept)
        if (k.order == 0) missed.add(f.curve(k.at) - k.value);
    f.report.bound = with_rounding(largest.norm_, f.curve);
    f.report.kept_bound = kept.empty() ? 0 : with_rounding(missed.norm_, f.curve);
    f.report.rms_error = largest.norm_ * std::sqrt(sum / double(points.size()));
    f.report.iterations = iterations;
    auto bound = polyline_bound<D>(f.curve, points, f.at);
    if (!bound) return std::unexpected(bound.error());
    f.report.polyline_bound = *bound;
    return f;
}

}  // namespace freiform::detail
