// Chord error: on [a, b] of length h a curve with |C''| <= M is within M h^2 / 8 of its chord [deBoor01,
// linear interpolation], and one with |C'| <= L within L h / 2, kinks or not: every point is within that of
// the nearer end. The projection to the plane shortens vectors, so bounds in space hold in the plane.
#include "io/drawing_detail.hpp"

#include <algorithm>
#include <numbers>

namespace freiform::drawing {

Plane plane_of(const std::optional<View>& view, bool all_plane, double size) {
    Plane plane;
    // Squares and cubes of coordinates stay far from the ends of the doubles.
    if (size > 0 && std::isfinite(size) && std::abs(std::ilogb(size)) > 200)
        plane.exponent = std::ilogb(size);
    if (all_plane && !view) return plane;
    const View from = view.value_or(View{});
    const double ca = std::cos(from.azimuth), sa = std::sin(from.azimuth);
    const double ce = std::cos(from.elevation), se = std::sin(from.elevation);
    plane.right = {{-sa, ca, 0}};
    plane.up = cross(Vec<3>{{ce * ca, ce * sa, se}}, plane.right);
    return plane;
}

namespace {

template <class P>
bool flatten_piece(DrawnPath& path, std::span<const P> b, double tolerance, std::size_t most) {
    auto basis = BSplineBasis::bezier(int(b.size()) - 1);
    if (!basis) return false;
    auto curve = Curve<P>::make({std::move(*basis)}, Net<1, P>({int(b.size())}, {b.begin(), b.end()}));
    if (!curve) return false;
    const CurveGeometry<2> geometry = *curve;
    const DerivativeQuery<1, 2> query(geometry);
    return flatten(
        {0, 1}, tolerance, most, [&](double t) { return (*curve)(t); },
        [&](double s, double t) {
            return (t - s) * (t - s) / 8 * query({Interval{s, t}})(2);
        },
        path);
}

template <int D>
bool has_jump(const DerivativeQuery<1, D>& query) {
    return std::ranges::any_of(query.kinks(0), [](const Kink& k) { return !std::isfinite(k.jump); });
}

bool has_kink(std::span<const Kink> kinks, const Interval& on) {
    return std::ranges::any_of(kinks, [&](const Kink& k) { return on.contains(k.at); });
}

}  // namespace

bool add_piece(DrawnPath& path, std::span<const Vec<2>> b, double tolerance, std::size_t most) {
    const std::size_t degree = b.size() - 1;
    if (degree > 3) return flatten_piece(path, b, tolerance, most);
    if (path.segments.size() >= most) return false;
    DrawnSegment s{std::max(1, int(degree)), {}};
    if (degree == 0) s.points[0] = b[0];  // a piece that stays where it is: a dot
    for (std::size_t i = 1; i <= degree; ++i) s.points[i - 1] = b[i];
    path.segments.push_back(s);
    return std::ranges::all_of(b, [](const Vec<2>& p) { return is_finite(p); });
}

bool add_piece(DrawnPath& path, std::span<const Hom<2>> b, double tolerance, std::size_t most) {
    // Equal weights: a polynomial piece after all.
    if (std::ranges::all_of(b, [&](const Hom<2>& p) { return p.weight() == b[0].weight(); })) {
        std::vector<Vec<2>> points;
        for (const Hom<2>& p : b) points.push_back(project(p));
        return add_piece(path, std::span<const Vec<2>>(points), tolerance, most);
    }
    return flatten_piece(path, b, tolerance, most);
}

std::optional<DrawnPath> path_of(const CurveGeometry<3>& curve, const Interval& on, const Plane& plane,
                                 double tolerance, std::size_t most) {
    const auto value = [&](double t) { return plane(jet<0>(curve, t).value()); };
    DrawnPath path{value(on.lo), {}, false};
    if (!is_finite(path.start)) return std::nullopt;
    if (std::holds_alternative<Line<3>>(curve)) {
        path.segments.push_back({1, {value(on.hi)}});
        return path;
    }
    // Splines: kinks must be ends of parts, which their Bezier pieces see to.
    const auto spline = [&](const auto& c) -> std::optional<DrawnPath> {
        const auto part = restrict_to(c, 0, on);
        if (!part) return std::nullopt;
        auto paths = paths_of(*part, plane, tolerance, most);
        if (!paths || paths->size() != 1) return std::nullopt;
        return std::move((*paths)[0]);
    };
    if (const auto* c = std::get_if<Curve<Vec<3>>>(&curve)) return spline(*c);
    if (const auto* c = std::get_if<Curve<Hom<3>>>(&curve)) return spline(*c);
    const DerivativeQuery<1, 3> query(curve);
    const auto error = [&](double s, double t) {
        return (t - s) * (t - s) / 8 * std::scalbn(query({Interval{s, t}})(2), -plane.exponent);
    };
    if (!flatten(on, tolerance, most, value, error, path)) return std::nullopt;
    return path;
}

// The curve C(t) = S(c(t)). With |c'| <= l and |c''| <= m on [s, t] and the bounds of S on a box around c:
//     |C'|  <= (|S_u| + |S_v|) l,
//     |C''| <= (|S_uu| + 2 |S_uv| + |S_vv|) l^2 + (|S_u| + |S_v|) m.
std::optional<DrawnPath> path_of(const CurveGeometry<2>& curve, const Interval& on,
                                 const SurfaceGeometry& surface, const Plane& plane, double tolerance,
                                 std::size_t most) {
    const DerivativeQuery<1, 2> inner(curve);
    const DerivativeQuery<2, 3> outer(surface);
    if (has_jump(inner)) return std::nullopt;
    for (int axis = 0; axis < 2; ++axis)
        for (const Kink& k : outer.kinks(axis))
            if (!std::isfinite(k.jump)) return std::nullopt;
    const auto all = domain(surface);
    const auto value = [&](double t) {
        const Vec<2> uv = jet<0>(curve, t).value();
        return plane(jet<0>(surface, {uv[0], uv[1]}).value());
    };
    const auto error = [&](double s, double t) {
        const auto c = inner({Interval{s, t}});
        const double h = t - s, l = c(1), m = c(2);
        const Vec<2> uv = jet<0>(curve, s + h / 2).value();
        std::array<Interval, 2> box;
        bool kink = has_kink(inner.kinks(0), {s, t});
        for (std::size_t d = 0; d < 2; ++d) {
            box[d] = {uv[int(d)] - l * h / 2, uv[int(d)] + l * h / 2};
            // Beyond its domain a closed surface goes on at the other end.
            if (box[d].lo < all[d].lo || box[d].hi > all[d].hi) box[d] = hull(box[d], all[d]);
            kink = kink || has_kink(outer.kinks(int(d)), box[d]);
        }
        const auto b = outer(box);
        const double first = (b(1, 0) + b(0, 1)) * l;
        const double second = (b(2, 0) + 2 * b(1, 1) + b(0, 2)) * l * l + (b(1, 0) + b(0, 1)) * m;
        const double straight = first * h / 2, bent = kink ? straight : second * h * h / 8;
        return std::scalbn(std::isnan(bent) || straight < bent ? straight : bent, -plane.exponent);
    };
    DrawnPath path{value(on.lo), {}, false};
    if (!is_finite(path.start) || !flatten(on, tolerance, most, value, error, path)) return std::nullopt;
    return path;
}

}  // namespace freiform::drawing
