// Solids along a rail.
//
// Idea. All walls have to share one frame, or they would not meet. The surface that sweep() makes of the
// polyline (X, 0), (0, 0), (0, Y) has three rows of coefficients: with a, b, c those of its middle, first and
// last row, a profile coefficient (x, y) of weight 1 sweeps
//     a + x / X (b - a) + y / Y (c - a),
// in homogeneous coordinates times its weight. X and Y are the largest |x| and |y| of the region.
//
// Accuracy. Each row is a curve that is off by at most B, the bound of sweep(). With |x| <= X and |y| <= Y
// the sum is off by (|1 - x / X - y / Y| + |x / X| + |y / Y|) B <= 5 B, and by the rounding of the
// combination, which is counted (bounded.hpp). So sweep() gets a sixth of the tolerance. The flat faces are
// spanned by the rows' first and last coefficients; they are off from the ends of walls by rounding alone,
// which is the tolerance of edges.
//
// Folds. The wall of (x, y) stands still where x r . k + y s . k = 1, k the vector of curvature of the rail.
// That is looked for at four places in each piece of the frame: what is found is a fold of the hull of the
// region, what is not found is not proven to be none.
//
// References: [Bishop 1975], [Wang et al. 2008].
#include "region_sweep_detail.hpp"

#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace freiform {

namespace {

// The rows of the swept polyline, polynomial ones with weights 1.
class RailFrame {
public:
    RailFrame(Surface<Hom<3>> rows, double x, double y) : rows_(std::move(rows)), x_(x), y_(y) {}

    const BSplineBasis& basis() const { return rows_.basis(1); }
    // Where the wall of (x, y) is at the first or last coefficient, and what x and y are in space there.
    Vec<3> origin(bool at_far) const { return project(at(1, end(at_far))); }
    Vec<3> axis(int d, bool at_far) const {
        const Vec<3> tip = project(at(d == 0 ? 0 : 2, end(at_far)));
        return (1 / (d == 0 ? x_ : y_)) * (tip - origin(at_far));
    }
    double reach() const {
        double most = 0;
        for (const bool far : {false, true}) most = std::max(most, max_abs(origin(far)));
        return most + x_ + y_;
    }
    // Where the frame bends around the point, v.
    std::array<Vec<3>, 3> directions(double v) const {
        const Vec<3> a = rows_(1.0, v);
        return {a, (1 / x_) * (rows_(0.0, v) - a), (1 / y_) * (rows_(2.0, v) - a)};
    }

    // What the wall of a profile has in place of the profile's coefficients.
    struct Wall {
        std::vector<Hom<3>> net;
        double rounding = 0;  // what that of coefficients moves
    };
    Wall wall(std::span<const Hom<2>> profile) const {
        Wall out;
        double moved = 0, off = 0, far = 0;
        for (const Hom<2>& p : profile) {
            const Bounded w(p.weight()), x = Bounded(p[0]) / Bounded(x_), y = Bounded(p[1]) / Bounded(y_);
            for (int j = 0; j < basis().size(); ++j) {
                const Hom<3>&a = at(1, j), &b = at(0, j), &c = at(2, j);
                Hom<3> q;
                Vec<3> lost;
                for (int k = 0; k < 3; ++k) {
                    const Bounded m(a[k]), sum = w * m + x * (Bounded(b[k]) - m) + y * (Bounded(c[k]) - m);
                    q[k] = sum.value, lost[k] = sum.bound;
                }
                const Bounded weight = w * Bounded(a.weight());
                q[3] = weight.value;
                moved = std::max(moved, norm(lost) / weight.value),
                off = std::max(off, weight.bound / weight.value);
                far = std::max(far, norm(project(q)));
                out.net.push_back(q);
            }
        }
        // The difference of two maps whose numerators differ by e and weights by d: (|e| + |point| d) / w.
        const double bound = (moved + far * off) / (1 - off) * (1 + 0x1p-48);
        out.rounding = off < 0.5 ? bound : kInfinity;
        return out;
    }

private:
    const Hom<3>& at(int row, int j) const { return rows_.net().view()({row, j}); }
    int end(bool at_far) const { return at_far ? basis().size() - 1 : 0; }

    Surface<Hom<3>> rows_;
    double x_, y_;
};

Result<void> check_folds(const CurveGeometry<3>& rail, const RailFrame& frame,
                         const std::vector<Vec<2>>& points) {
    const auto breaks = frame.basis().breaks();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const double v = breaks[i] + part * (breaks[i + 1] - breaks[i]);
            const auto j = jet<2>(rail, v);
            const Vec<3> d = j.d[1], dd = j.d[2];
            const double speed = dot(d, d);
            const Vec<3> k = (1 / speed) * (dd - (dot(dd, d) / speed) * d);
            const auto [a, r, s] = frame.directions(v);
            const double x = dot(r, k), y = dot(s, k);
            for (const Vec<2>& p : points)
                if (!(p[0] * x + p[1] * y < 1))
                    return refuse(RefusalKind::no_answer, "rail",
                                  text("at the parameter ", v, " it bends around the point (", p[0], ", ",
                                       p[1], ") of the region, where walls fold"));
        }
    return {};
}

Surface<Hom<3>> rational(const Surface<Vec<3>>& s) { return to_rational(s); }
Surface<Hom<3>> rational(const Surface<Hom<3>>& s) { return s; }

std::vector<Vec<3>> numerators(std::span<const Hom<3>> net) {
    std::vector<Vec<3>> out;
    for (const Hom<3>& q : net) out.push_back({{q[0], q[1], q[2]}});
    return out;
}

template <class W>
Result<detail::SweptCurve> swept_curve(const BSplineBasis& along, const BSplineBasis& rail,
                                       std::vector<W> net) {
    const auto wall = Surface<W>::make({along, rail}, Net<2, W>({along.size(), rail.size()}, std::move(net)));
    if (!wall) return std::unexpected(wall.error());
    const Interval t = along.domain(), v = rail.domain();
    const auto way = iso(*wall, 0, t.lo);
    return detail::SweptCurve{*wall, iso(*wall, 1, v.lo), iso(*wall, 1, v.hi), way, way(v.lo), way(v.hi)};
}

using Rows = Result<FrameSweep<Hom<3>>>;

// `rows`: what the polyline sweeps.
Result<SolidAlong> solid_in_frame(
    const RegionLoops& region, const CurveGeometry<3>& rail, bool rail_is_rational,
    const FrameSweepOptions& options,
    const std::function<Rows(const Curve<Vec<2>>&, double tolerance)>& sweep_rows) {
    std::vector<Vec<2>> points;
    Vec<2> most;
    if (auto ok = detail::each_point(region,
                                     [&](const Vec<2>& p) {
                                         points.push_back(p);
                                         for (int d = 0; d < 2; ++d)
                                             most[d] = std::max(most[d], std::abs(p[d]));
                                     });
        !ok)
        return std::unexpected(ok.error());
    if (points.empty() || !(most[0] > 0 && most[1] > 0))
        return refuse(RefusalKind::no_answer, "loops", "there is no region");
    const auto polyline =
        Curve<Vec<2>>::make({*BSplineBasis::make(1, std::vector<double>{0, 0, 1, 2, 2})},
                            Net<1, Vec<2>>({3}, {Vec<2>{{most[0], 0}}, Vec<2>{}, Vec<2>{{0, most[1]}}}));
    if (!polyline) return refuse_within("loops", polyline.error());
    auto rows = sweep_rows(*polyline, options.tolerance / 6);
    if (!rows) return std::unexpected(rows.error());
    const RailFrame frame(std::move(rows->surface), most[0], most[1]);
    constexpr std::size_t kMost = std::size_t(1) << 24;
    if (points.size() > kMost / std::size_t(frame.basis().size()))
        return refuse(RefusalKind::limit, "tolerance",
                      text("walls of ", points.size(), " x ", frame.basis().size(),
                           " coefficients; the limit is ", kMost));
    if (auto ok = check_folds(rail, frame, points); !ok) return std::unexpected(ok.error());

    double rounding = 0;
    const double at_caps = 0x1p-48 * frame.reach();
    detail::RegionSweep how;
    how.range = frame.basis().domain();
    how.cap = [&](bool at_far) -> SurfaceGeometry {
        return Extrusion{Line<3>{frame.origin(at_far), frame.axis(0, at_far)}, frame.axis(1, at_far),
                         SurfaceKind::plane};
    };
    const auto sweep_spline = [&](const Curve<Hom<2>>& c, bool is_rational) {
        auto [net, moved] = frame.wall(c.net().flat());
        rounding = std::max(rounding, moved);
        auto out = is_rational ? swept_curve(c.basis(), frame.basis(), std::move(net))
                               : swept_curve(c.basis(), frame.basis(), numerators(net));
        if (out) out->tolerance = 2 * moved + at_caps;
        return out;
    };
    how.curve = [&](const CurveGeometry<2>& curve) -> Result<detail::SweptCurve> {
        if (const auto* c = std::get_if<Curve<Vec<2>>>(&curve))
            return sweep_spline(to_rational(*c), rail_is_rational);
        if (const auto* c = std::get_if<Curve<Hom<2>>>(&curve)) return sweep_spline(*c, true);
        return refuse(RefusalKind::unsupported, "loops", "is no spline");
    };
    auto model = detail::sweep_region(region, how);
    if (!model) return std::unexpected(model.error());
    SolidAlong out{*std::move(model), (5 * rows->bound + rounding) * (1 + 0x1p-48), rows->pieces};
    if (!(out.bound <= options.tolerance))
        return refuse(
            RefusalKind::ill_conditioned, "tolerance",
            text(options.tolerance, " is too small beside rounding, which may move points by ", rounding));
    out.model.approximations.push_back({"walls", "a frame of cubics along the rail", out.bound, 0});
    return out;
}

}  // namespace

template <class R>
Result<SolidAlong> solid_along(const RegionLoops& region, const Curve<R>& rail,
                               const FrameSweepOptions& options) {
    const Interval on = rail.basis().domain();
    if (rail.basis().is_closed() || rail(on.lo) == rail(on.hi))
        return refuse(RefusalKind::unsupported, "rail",
                      "it ends where it begins: solids along closed rails are not made, surfaces are");
    return solid_in_frame(region, rail, Space<R>::kRational, options,
                          [&](const Curve<Vec<2>>& polyline, double tolerance) -> Rows {
                              auto rows = sweep(polyline, rail, {tolerance, options.x_at_start});
                              if (!rows) return std::unexpected(rows.error());
                              return FrameSweep<Hom<3>>{rational(rows->surface), rows->bound, rows->pieces};
                          });
}

template Result<SolidAlong> solid_along(const RegionLoops&, const Curve<Vec<3>>&, const FrameSweepOptions&);
template Result<SolidAlong> solid_along(const RegionLoops&, const Curve<Hom<3>>&, const FrameSweepOptions&);

}  // namespace freiform
