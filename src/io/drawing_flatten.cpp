// Curves in the plane of the picture: Bezier pieces as they are where SVG has them, else polylines by
// path/flatten.hpp. The projection to the plane shortens vectors, so bounds in space hold in the plane.
#include "io/drawing_detail.hpp"

#include <freiform/path/flatten.hpp>

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
    const auto curve = Curve<P>::make({std::move(*basis)}, Net<1, P>({int(b.size())}, {b.begin(), b.end()}));
    if (!curve) return false;
    FlattenOptions options;
    options.tolerance = tolerance;
    options.max_segments = most - std::min(most, path.segments.size());
    const auto line = flatten(*curve, options);
    if (!line) return false;
    for (std::size_t i = 1; i < line->points.size(); ++i) path.segments.push_back({1, {line->points[i]}});
    return true;
}

// The path of a polyline in space.
std::optional<DrawnPath> projected(const Result<Polyline<3>>& line, const Plane& plane) {
    if (!line) return std::nullopt;
    DrawnPath path{plane(line->points[0]), {}, false};
    for (std::size_t i = 1; i < line->points.size(); ++i)
        path.segments.push_back({1, {plane(line->points[i])}});
    return path;
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
    const auto spline = [&](const auto& c) -> std::optional<DrawnPath> {
        const auto part = restrict_to(c, 0, on);
        if (!part) return std::nullopt;
        auto paths = paths_of(*part, plane, tolerance, most);
        if (!paths || paths->size() != 1) return std::nullopt;
        return std::move((*paths)[0]);
    };
    if (const auto* c = std::get_if<Curve<Vec<3>>>(&curve)) return spline(*c);
    if (const auto* c = std::get_if<Curve<Hom<3>>>(&curve)) return spline(*c);
    FlattenOptions options;
    options.tolerance = std::scalbn(tolerance, plane.exponent);
    options.max_segments = most;
    return projected(flatten(curve, on, options), plane);
}

std::optional<DrawnPath> path_of(const CurveGeometry<2>& curve, const Interval& on,
                                 const SurfaceGeometry& surface, const Plane& plane, double tolerance,
                                 std::size_t most) {
    return projected(flatten_on(surface, curve, on, std::scalbn(tolerance, plane.exponent), most), plane);
}

}  // namespace freiform::drawing
