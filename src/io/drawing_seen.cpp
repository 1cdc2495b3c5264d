// Curves beside surfaces: what of them the surfaces hide.
//
// Method. The curve as a polyline in space within the tolerance of the drawing, cut by the triangles of the
// surfaces (mesh/visibility.hpp). A curve that nothing hides is drawn as what it is, not as the polyline.
//
// Accuracy. Triangles are within two tolerances of their surface, the polyline within one of its curve: where
// the curve lies on the surface, it is at most 3 x 2 + 1 tolerances behind a plane of them (the first three
// as for outlines, see visibility.cpp). Eight are allowed, so a curve on a surface is not hidden by it.
#include "io/drawing_detail.hpp"

#include <freiform/path/flatten.hpp>

namespace freiform::drawing {

namespace {

DrawnPath path_of(const SeenPart& part) {
    std::vector<Vec<2>> points;
    for (const Vec<3>& p : part.points) points.push_back({{p[0], p[1]}});
    return line_through(points);
}

bool all_seen(std::span<const SeenPart> parts) {
    return std::ranges::none_of(parts, [](const SeenPart& p) { return p.hidden; });
}

}  // namespace

template <class P>
bool Sketch::add_seen(DrawnGroup& to, const Curve<P>& curve) {
    const auto line = flatten(
        curve, FlattenOptions{.tolerance = std::scalbn(tolerance, plane.exponent), .max_segments = rest()});
    if (!line) return false;
    std::vector<std::vector<SeenPart>> all;
    for (std::size_t k = 0; k < line->parts.size(); ++k) {
        const std::size_t end = k + 1 < line->parts.size() ? line->parts[k + 1] : line->points.size();
        std::vector<Vec<3>> points;
        for (std::size_t i = line->parts[k]; i < end; ++i) points.push_back(plane.deep(line->points[i]));
        all.push_back(seen_parts(*occluders, points));
    }
    if (std::ranges::all_of(all, all_seen)) return false;
    for (const auto& parts : all)
        for (const SeenPart& part : parts)
            if (part.hidden)
                behind.paths.push_back(path_of(part));
            else
                take(to, path_of(part));
    return true;
}

void Sketch::add_polygon(DrawnGroup& to, std::span<const Vec<3>> points, bool closed) {
    std::vector<Vec<2>> flat;
    std::vector<Vec<3>> deep;
    for (const Vec<3>& p : points) flat.push_back(plane(p)), deep.push_back(plane.deep(p));
    if (closed && !deep.empty()) deep.push_back(deep.front());
    const auto parts = occluders ? seen_parts(*occluders, deep) : std::vector<SeenPart>{};
    if (all_seen(parts)) return take(to, line_through(flat, closed));
    for (const SeenPart& part : parts)
        if (part.hidden)
            behind.net.push_back(path_of(part));
        else
            take(to, path_of(part));
}

template bool Sketch::add_seen(DrawnGroup&, const Curve<Vec<3>>&);
template bool Sketch::add_seen(DrawnGroup&, const Curve<Hom<3>>&);

}  // namespace freiform::drawing
