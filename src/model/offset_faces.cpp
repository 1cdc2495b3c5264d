// Faces on offsets of splines, and of what splines sweep along a line, as faces on splines.
//
// Idea. Of an offset only second derivatives are bounded, by those of the base and its normals; of a spline
// it is known how far it is from a quadratic function. So a spline that is near the offset, at the same
// parameters (make/offset_spline.hpp), is meshed with a third of the triangles and in less time, and loops
// and edges need not know. Points inside and normals are those of the offset all the same.
//
// Bounds. With E the distance of the two, proven: the offset is E from the spline, a point inside that is put
// back on the offset moves its triangles by E, and the gaps at parameter curves are known of the spline: they
// may be 2 E larger than those of the offset, at a seam. So 2 E less are told as gap, and 4 E more as bound.
#include "stand_ins_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/offset_spline.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kApart = 1.0 / 32;  // of the tolerance, in all
constexpr double kMore = 0x1p-6;     // of the parameters that loops reach, on each side
constexpr std::size_t kFacesAtOnce = 8;

// Edges without a curve in space are where their first face has them: not for another one to be moved.
bool has_shared_images(const Model& model, const Face& face) {
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges) {
            const Edge& e = model.edges[std::size_t(c.edge)];
            if (e.curve || e.degenerate) continue;
            for (const Face& other : model.faces)
                for (const Loop& m : other.loops)
                    for (const Coedge& d : m.coedges)
                        if (&other != &face && d.edge == c.edge) return true;
        }
    return false;
}

// What a spline sweeps along a line is a spline of the same parameters.
std::optional<SurfaceGeometry> spline_of(const SurfaceGeometry& base, const Interval& along) {
    const auto* swept = std::get_if<Extrusion>(&base);
    if (swept == nullptr) return base;
    const auto across = BSplineBasis::bezier(1, along);
    return visit_one(
        [&](const auto& c) -> std::optional<SurfaceGeometry> {
            if constexpr (requires { c.net(); }) {
                using P = std::remove_cvref_t<decltype(c.net().flat()[0])>;
                std::vector<P> net;
                for (const P& p : c.net().flat())
                    for (const double v : {along.lo, along.hi})
                        net.push_back(Space<P>::lift(project(p) + v * swept->direction, Space<P>::weight(p)));
                const int rows = int(c.net().flat().size());
                return Surface<P>::trusted({c.basis(), *across}, Net<2, P>({rows, 2}, std::move(net)));
            }
            return std::nullopt;
        },
        swept->profile);
}

}  // namespace

std::optional<StandIn> spline_for(const Model& model, const Face& face, double tolerance, Face& standing) {
    const auto* offset = std::get_if<OffsetSurface>(&face.surface);
    if (offset == nullptr || face.loops.empty() || has_shared_images(model, face)) return std::nullopt;
    const Box<2> loops = box_of_curves(model, face);
    const auto domain = limits(face.surface);
    std::array<Interval, 2> on;
    for (std::size_t d = 0; d < 2; ++d) {
        const Interval side = loops.side(int(d));
        const double more = kMore * side.length();
        on[d] = {std::max(side.lo - more, domain[d].lo), std::min(side.hi + more, domain[d].hi)};
        if (!std::isfinite(on[d].length()) || !(on[d].lo < on[d].hi)) return std::nullopt;
    }
    auto base = spline_of(*offset->base, on[1]);
    if (!base) return std::nullopt;
    auto made = offset_spline({std::make_shared<const SurfaceGeometry>(*std::move(base)), offset->distance},
                              on, kApart / 4 * tolerance);
    if (!made) return std::nullopt;
    standing = face;
    standing.surface = std::move(made->surface);
    return StandIn{&face, false, 4 * made->bound, -2 * made->bound};
}

StandIns stand_ins_for(const Model& model, const TessellateOptions& how, bool with_splines) {
    StandIns out;
    // What else is asked for is about triangles inside, or about normals, which are not those of a plane.
    const bool planes = how.as_planes && !how.quads && !std::isfinite(how.max_edge) &&
                        !std::isfinite(how.max_angle) && !std::isfinite(how.max_aspect);
    const bool splines =
        with_splines && !std::isfinite(how.max_angle) &&
        std::ranges::any_of(model.faces,
                            [](const Face& f) { return std::holds_alternative<OffsetSurface>(f.surface); }) &&
        check_budget(model, how, face_sizes(model, how));
    if (!planes && !splines) return out;
    out.faces.resize(model.faces.size());
    std::vector<Face> standing(model.faces.size());
    parallel_for(model.faces.size(), kFacesAtOnce, [&](std::size_t f) {
        const Face& face = model.faces[f];
        if (planes) out.faces[f] = plane_for(model, face, how.tolerance, standing[f]);
        if (splines && !out.faces[f]) out.faces[f] = spline_for(model, face, how.tolerance, standing[f]);
    });
    if (std::ranges::none_of(out.faces, [](const auto& f) { return f.has_value(); })) return out;
    out.standing = model;
    for (std::size_t f = 0; f < out.faces.size(); ++f)
        if (out.faces[f]) out.standing->faces[f] = std::move(standing[f]);
    return out;
}

}  // namespace freiform
