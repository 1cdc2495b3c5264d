// Flattening of what models call curves: lines, conics and splines over an interval.
//
// Conics. Ellipse, parabola and hyperbola in their usual parameters have the property that the chord over
// [s, t] is parallel to the tangent at the middle m (for the circle by symmetry, for every ellipse as an
// affine image of it; for the hyperbola c(m + h) - c(m - h) = 2 sinh(h) c'(m)). So the distance across the
// chord is largest at m, and known: that of c(m) from the chord's line. The arc lies in the triangle of its
// ends and the apex where the tangents there meet (ellipses: t - s < pi), which is the middle of the chord
// plus (c(m) - that) (1 + 1 / cos h), (1 + 1 / cosh h), or 2 for the parabola, h = (t - s) / 2: for the
// ellipse c(m)
// - chord = (1 - cos h) v and apex - chord = (1 / cos h - cos h) v with v = c(m) - centre. What the arc
// sticks out beyond the ends of the chord is at most what the apex does.
//
// The longest step is found by doubling and bisection; the distance grows with the step. All other methods
// take equal steps, as many as the longest arc needs: conics have no Bezier pieces.
//
// Rounding: points as spline/geometry.hpp bounds them, three of them in the distance.
#include "path/flatten_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <numbers>

namespace freiform {

namespace {

template <int D>
class ConicArc {
public:
    ConicArc(const Conic<D>& conic, Interval on)
        : conic_(conic),
          geometry_(conic),
          slip_(8 * std::sqrt(double(D)) * value_error_bound(geometry_, {on})) {}

    Vec<D> value(double t) const { return jet<0>(geometry_, t).value(); }
    // Bound of the distance between the arc and the segment from a = value(s) to b = value(t).
    double distance_bound(double s, double t, const Vec<D>& a, const Vec<D>& b) const {
        const double h = (t - s) / 2;
        if (conic_.kind == ConicKind::ellipse && !(h < 1.5)) return std::numeric_limits<double>::infinity();
        const double c = conic_.kind == ConicKind::ellipse ? std::cos(h) : std::cosh(h);
        const double apex = conic_.kind == ConicKind::parabola ? 2 : 1 + 1 / c;
        const Vec<D> middle = 0.5 * a + 0.5 * b, sag = value(s + h) - middle;
        const detail::Segment<D> segment(a, b);
        const double across = norm(sag - dot(sag, segment.direction) * segment.direction);
        const double along = dot(middle + apex * sag - a, segment.direction);
        const double over = std::max({0.0, -along, along - segment.length});
        return (detail::root_of_squares(across, over) + 2 * slip_) * (1 + 32 * kUnitRoundoff);
    }
    double slip() const { return slip_; }

private:
    Conic<D> conic_;
    CurveGeometry<D> geometry_;
    double slip_;
};

template <int D>
Result<Polyline<D>> flatten_conic(const Conic<D>& conic, Interval on, const FlattenOptions& options) {
    const ConicArc<D> arc(conic, on);
    const double tolerance = options.tolerance;
    Polyline<D> out;
    out.points.push_back(arc.value(on.lo));
    out.parameters.push_back(on.lo);
    const auto add = [&](double t) {
        const Vec<D> b = arc.value(t);
        out.bound = std::max(out.bound, arc.distance_bound(out.parameters.back(), t, out.points.back(), b));
        out.points.push_back(b);
        out.parameters.push_back(t);
    };
    if (options.segments > 0 || options.method != FlattenMethod::adaptive) {
        for (double n = std::max(options.segments, 1);; n = std::ceil(n * 1.1)) {
            if (n > double(options.max_segments))
                return refuse(RefusalKind::limit, "max_segments",
                              text("more than ", options.max_segments, " segments are needed"));
            out.points.resize(1), out.parameters.resize(1);
            out.bound = 0;
            for (int k = 1; k <= int(n); ++k) add(k < int(n) ? on.lo + on.length() * (k / n) : on.hi);
            if (options.segments > 0 || out.bound <= tolerance) return out;
            if (!(tolerance > 4 * arc.slip())) break;
        }
    }
    double step = on.length();
    for (double s = on.lo; s < on.hi;) {
        if (out.points.size() > options.max_segments)
            return refuse(RefusalKind::limit, "max_segments",
                          text("more than ", options.max_segments, " segments are needed; about ",
                               double(out.points.size()) * (on.length() / (s - on.lo)), " suffice"));
        const auto fits = [&](double t) {
            return arc.distance_bound(s, t, out.points.back(), arc.value(t)) <= tolerance;
        };
        double good = s, bad = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 200 && !(bad - s <= (good - s) * 1.002); ++k) {
            const bool enclosed = good > s && std::isfinite(bad);
            const double t = std::min(on.hi, enclosed ? good + (bad - good) / 2 : s + step);
            if (!(t > good && t < bad)) break;
            if (fits(t)) {
                good = t;
                if (t == on.hi) break;
                if (!enclosed) step *= 2;
            } else {
                bad = t;
                if (good == s) step = (t - s) / 2;
            }
        }
        if (!(good > s))
            return refuse(RefusalKind::ill_conditioned, "tolerance",
                          text(tolerance,
                               " is below the rounding of the conic's points; the smallest that can be "
                               "proven is about ",
                               4 * arc.slip()));
        step = good - s;
        add(s = good);
    }
    return out;
}

}  // namespace

template <int D>
Result<Polyline<D>> flatten(const CurveGeometry<D>& curve, Interval on, const FlattenOptions& options) {
    if (auto ok = check(curve); !ok) return std::unexpected(ok.error());
    if (!(on.lo < on.hi) || !std::isfinite(on.lo) || !std::isfinite(on.hi))
        return refuse(RefusalKind::invalid, "on", text("[", on.lo, ", ", on.hi, "] is no interval"));
    if (auto ok = detail::check_options(options); !ok) return std::unexpected(ok.error());
    return visit_one(
        [&](const auto& c) -> Result<Polyline<D>> {
            if constexpr (requires { c.net(); }) {
                if (on == c.domain()[0]) return flatten(c, options);
                const auto part = restrict_to(c, 0, on);
                if (!part) return std::unexpected(part.error());
                auto line = flatten(*part, options);
                // Restriction rounds the coefficients.
                if (line) line->bound += 2 * std::sqrt(double(D)) * c.value_error_bound();
                return line;
            } else if constexpr (requires { c.kind; }) {
                return flatten_conic(c, on, options);
            } else {
                Polyline<D> line;
                for (const double t : {on.lo, on.hi}) {
                    line.points.push_back(jet<0>(curve, t).value());
                    line.parameters.push_back(t);
                }
                line.bound = std::sqrt(double(D)) * value_error_bound(curve, {on});
                return line;
            }
        },
        curve);
}

template Result<Polyline<2>> flatten(const CurveGeometry<2>&, Interval, const FlattenOptions&);
template Result<Polyline<3>> flatten(const CurveGeometry<3>&, Interval, const FlattenOptions&);

}  // namespace freiform
