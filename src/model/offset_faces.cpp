// Faces on offsets of splines, and of what splines sweep along a line, as faces on splines.
//
// Idea. Of an offset only second derivatives are bounded, by those of the base and its normals; of a spline
// it is known how far it is from a quadratic function. So a spline that is near the offset, at the same
// parameters (make/offset_spline.hpp), is meshed with a half to a fifth of the triangles, and loops
// and edges need not know. Points inside and normals are those of the offset all the same.
//
// Bounds. With E the distance of the two, proven: the offset is E from the spline, a point inside that is put
// back on the offset moves its triangles by E, and the gaps at parameter curves are known of the spline: they
// may be 2 E larger than those of the offset, at a seam. So 2 E less are told as gap, and 4 E more as bound.
#include "stand_ins_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/make/offset_spline.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace freiform {

namespace {

constexpr double kApart = 1.0 / 32;  // of the tolerance, in all
constexpr double kMore = 0x1p-6;     // of the parameters that loops reach, on each side
constexpr std::size_t kFacesAtOnce = 8;

// Edges without a curve in space are where their first face has them: not for another one to be moved.
std::vector<char> shared_images(const Model& model) {
    std::vector<int> face(model.edges.size(), -1);
    std::vector<char> out(model.edges.size(), 0);
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& l : model.faces[f].loops)
            for (const Coedge& c : l.coedges) {
                const auto e = std::size_t(c.edge);
                out[e] = out[e] || (!model.edges[e].curve && !model.edges[e].degenerate && face[e] >= 0 &&
                                    face[e] != int(f));
                face[e] = int(f);
            }
    return out;
}
bool has_any(const Face& face, std::span<const char> of_edges) {
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges)
            if (of_edges[std::size_t(c.edge)]) return true;
    return false;
}

}  // namespace

std::optional<StandIn> spline_for(const Model& model, const Face& face, double tolerance, Face& standing) {
    const auto* offset = std::get_if<OffsetSurface>(&face.surface);
    if (offset == nullptr || face.loops.empty()) return std::nullopt;
    const Box<2> loops = box_of_curves(model, face);
    const auto domain = limits(face.surface);
    std::array<Interval, 2> on;
    for (std::size_t d = 0; d < 2; ++d) {
        const Interval side = loops.side(int(d));
        const double more = kMore * side.length();
        on[d] = {std::max(side.lo - more, domain[d].lo), std::min(side.hi + more, domain[d].hi)};
        if (!std::isfinite(on[d].length()) || !(on[d].lo < on[d].hi)) return std::nullopt;
    }
    auto made = offset_spline(*offset, on, kApart / 4 * tolerance);
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
    const std::vector<char> kept = splines ? shared_images(model) : std::vector<char>();
    parallel_for(model.faces.size(), kFacesAtOnce, [&](std::size_t f) {
        const Face& face = model.faces[f];
        if (planes) out.faces[f] = plane_for(model, face, how.tolerance, standing[f]);
        if (splines && !out.faces[f] && !has_any(face, kept))
            out.faces[f] = spline_for(model, face, how.tolerance, standing[f]);
    });
    if (std::ranges::none_of(out.faces, [](const auto& f) { return f.has_value(); })) return out;
    out.standing = model;
    for (std::size_t f = 0; f < out.faces.size(); ++f)
        if (out.faces[f]) out.standing->faces[f] = std::move(standing[f]);
    return out;
}

}  // namespace freiform
