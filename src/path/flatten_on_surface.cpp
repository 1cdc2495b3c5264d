// Curves on surfaces as polylines.
//
// Chord error: on [s, t] of length h a curve with |C''| <= M is within M h^2 / 8 of its chord [deBoor01,
// linear interpolation], and one with |C'| <= L within L h / 2, kinks or not: every point is within that of
// the nearer end. The curve is C(t) = S(c(t)); with |c'| <= l and |c''| <= m on [s, t] and the bounds of S on
// a box around c:
//     |C'|  <= (|S_u| + |S_v|) l,
//     |C''| <= (|S_uu| + 2 |S_uv| + |S_vv|) l^2 + (|S_u| + |S_v|) m.
// Every point of the chord is as near to the curve: linear interpolation compares points at equal parameters,
// and the other bound is that of a curve which runs from one end of the chord to the other
// (flatten_detail.hpp).
//
// Rounding: a point is off by the error of a value of S, and by that of c times |S_u| + |S_v|.
//
// Why not the Bezier form of S(c): its degree is the product of degrees, 36 for a cubic on a bicubic patch.
#include "path/flatten_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>

namespace freiform {

namespace {

bool has_jump(std::span<const Kink> kinks) {
    return std::ranges::any_of(kinks, [](const Kink& k) { return !std::isfinite(k.jump); });
}
bool has_kink(std::span<const Kink> kinks, const Interval& on) {
    return std::ranges::any_of(kinks, [&](const Kink& k) { return on.contains(k.at); });
}

class OnSurface {
public:
    OnSurface(const SurfaceGeometry& surface, const CurveGeometry<2>& curve, Interval on)
        : surface_(surface), curve_(curve), inner_(curve), outer_(surface), all_(domain(surface)) {
        curve_error_ = value_error_bound(curve, {on});
        const auto box = around(on.lo, on.hi, inner_({on})(1));
        const auto b = outer_(box);
        // Two coordinates of c, three of S.
        error_ = 1.8 * value_error_bound(surface, box) + 1.5 * curve_error_ * (b(1, 0) + b(0, 1));
    }

    bool jumps() const {
        return has_jump(inner_.kinks(0)) || has_jump(outer_.kinks(0)) || has_jump(outer_.kinks(1));
    }
    Vec<3> value(double t) const {
        const Vec<2> uv = jet<0>(curve_, t).value();
        return jet<0>(surface_, {uv[0], uv[1]}).value();
    }
    double error() const { return error_; }  // of a value
    double chord_error(double s, double t) const {
        const auto c = inner_({Interval{s, t}});
        const double h = t - s, l = c(1), m = c(2);
        const auto box = around(s, t, l);
        bool kink = has_kink(inner_.kinks(0), {s, t});
        for (int d = 0; d < 2; ++d) kink = kink || has_kink(outer_.kinks(d), box[std::size_t(d)]);
        const auto b = outer_(box);
        const double first = (b(1, 0) + b(0, 1)) * l;
        const double second = (b(2, 0) + 2 * b(1, 1) + b(0, 2)) * l * l + (b(1, 0) + b(0, 1)) * m;
        const double straight = first * h / 2, bent = kink ? straight : second * h * h / 8;
        return (std::isnan(bent) || straight < bent ? straight : bent) * (1 + 32 * kUnitRoundoff);
    }

private:
    // A box around c on [s, t], where |c'| <= l.
    std::array<Interval, 2> around(double s, double t, double l) const {
        const Vec<2> uv = jet<0>(curve_, s + (t - s) / 2).value();
        const double reach = (l * (t - s) / 2 + curve_error_) * (1 + 8 * kUnitRoundoff);
        std::array<Interval, 2> box;
        for (std::size_t d = 0; d < 2; ++d) {
            box[d] = {uv[int(d)] - reach, uv[int(d)] + reach};
            // Beyond its domain a closed surface goes on at the other end.
            if (box[d].lo < all_[d].lo || box[d].hi > all_[d].hi) box[d] = hull(box[d], all_[d]);
        }
        return box;
    }

    const SurfaceGeometry& surface_;
    const CurveGeometry<2>& curve_;
    DerivativeQuery<1, 2> inner_;
    DerivativeQuery<2, 3> outer_;
    std::array<Interval, 2> all_;
    double curve_error_ = 0, error_ = 0;
};

}  // namespace

Result<Polyline<3>> flatten_on(const SurfaceGeometry& surface, const CurveGeometry<2>& curve, Interval on,
                               double tolerance, std::size_t max_segments) {
    constexpr std::size_t kDeepest = 200;
    FlattenOptions options;
    options.tolerance = tolerance;
    if (auto ok = detail::check_options(options); !ok) return std::unexpected(ok.error());
    if (!(on.lo < on.hi) || !std::isfinite(on.lo) || !std::isfinite(on.hi))
        return refuse(RefusalKind::invalid, "on", text("[", on.lo, ", ", on.hi, "] is no interval"));
    const OnSurface drawn(surface, curve, on);
    if (drawn.jumps()) return refuse(RefusalKind::no_answer, "curve", "it or the surface jumps");
    Polyline<3> line{{drawn.value(on.lo)}, {on.lo}, {0}, 0, false};
    if (!is_finite(line.points[0]))
        return refuse(RefusalKind::no_answer, "curve", text("has no point at ", on.lo));
    std::vector<double> ends{on.hi};
    for (double a = on.lo; !ends.empty();) {
        const double b = ends.back(), middle = a + (b - a) / 2, off = drawn.chord_error(a, b) + drawn.error();
        if (!(off <= tolerance)) {
            if (!(a < middle && middle < b) || ends.size() > kDeepest)
                return refuse(RefusalKind::ill_conditioned, "tolerance",
                              text(tolerance, " cannot be proven near ", a,
                                   "; values alone are off by up to ", drawn.error()));
            ends.push_back(middle);
            continue;
        }
        const Vec<3> p = drawn.value(b);
        if (!is_finite(p)) return refuse(RefusalKind::no_answer, "curve", text("has no point at ", b));
        if (line.segments() >= max_segments)
            return refuse(RefusalKind::limit, "max_segments",
                          text("more than ", max_segments, " segments are needed"));
        line.points.push_back(p);
        line.parameters.push_back(b);
        line.bound = std::max(line.bound, off);
        a = b;
        ends.pop_back();
    }
    return line;
}

}  // namespace freiform
