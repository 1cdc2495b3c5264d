// Idea. Trimmed surfaces that were read by themselves have edges of one face, which are nothing but parameter
// curves. Their images in space (make/image_curve.hpp) are exact up to the rounding of control points, and
// only with these can edges be compared. What has no image stays as it is. An image whose control points are
// one point is a pole: the edge is degenerate from here on, and its two vertices are one.
#include "sewer_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/image_curve.hpp>

#include <algorithm>

namespace freiform {

namespace {

// The largest distance of control points from the first, and of the first from the origin.
std::array<double, 2> spread_of_image(const CurveGeometry<3>& curve) {
    return std::visit(
        [](const auto& c) -> std::array<double, 2> {
            if constexpr (requires { c.net(); }) {
                const Vec<3> first = project(c.net().flat().front());
                double most = 0;
                for (const auto& p : c.net().flat()) most = std::max(most, max_abs(project(p) - first));
                return {most, max_abs(first)};
            }
            return {kInfinity, 0};
        },
        curve);
}

void give_image(Model& m, const SurfaceGeometry& surface, Coedge& c) {
    Edge& e = m.edges[std::size_t(c.edge)];
    const auto flat = parameter_spline(c.curve, e.range);
    if (!flat) return;
    auto image = image_curve(surface, *flat);
    if (!image) return;
    const auto [size, from] = spread_of_image(*image);
    if (size <= 64 * kUnitRoundoff * from) {
        const int gone = e.end, stays = e.start;
        for (Edge& other : m.edges)
            for (int* v : {&other.start, &other.end})
                if (*v == gone) *v = stays;
        e.degenerate = true;
        return;
    }
    c.curve = *flat, e.range = domain(*flat)[0], e.curve = *std::move(image);
}

}  // namespace

void give_images(Model& m) {
    const auto owners = owners_of(m);
    for (Face& f : m.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) {
                const Edge& e = m.edges[std::size_t(c.edge)];
                if (!e.curve && !e.degenerate && owners[std::size_t(c.edge)].uses == 1)
                    give_image(m, f.surface, c);
            }
}

}  // namespace freiform
