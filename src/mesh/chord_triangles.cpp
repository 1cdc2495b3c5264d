// A triangle with a side of the boundary as longest side has error at most Q(d) / 6 for that side d
// (curvature_tree.cpp: R^2 <= longest^2 / 3), or Q(d) / 8 where the surface is curved in one parameter
// direction only (all such triangles are obtuse or right, in the metric of their error). That is no part of a
// bound: the face is meshed by bounds of its own.
//
// Why not by what is seen along normals, as inside faces? Where points next to the side have no foot, at
// poles and where boxes are so small that normals are rounding, triangles at the side are judged by all of
// the error, and no point inside the face makes that of the side smaller.
#include "curvature_tree_detail.hpp"

#include <freiform/mesh/chord_triangles.hpp>

namespace freiform {

double BoundarySide::error_beside() const {
    const double kinks =
        kink_bound_of(surface.kinks(0), box.side(0)) + kink_bound_of(surface.kinks(1), box.side(1));
    const auto cone = apex ? ConeFace::make(*apex, surface, box) : std::nullopt;
    if (cone) return cone->error(cone->bends(surface, box), {from, to, to}) + kinks;
    const Curvature second{over(2, 0), over(1, 1), over(0, 2)};
    const Vec<2> chord = to - from;
    const bool one_way = second.uv == 0 && (second.uu == 0 || second.vv == 0);
    return second.along(chord[0], chord[1]) / (one_way ? 8 : 6) + kinks;
}

std::optional<Vec<2>> BoundarySide::bow() const {
    const auto cone = apex && !(apex->radius > 0) ? ConeFace::make(*apex, surface, box) : std::nullopt;
    if (!cone) return std::nullopt;
    Vec<2> off{};
    off[cone->across()] = cone->bow(from, to);
    return off[cone->across()] > 0 ? std::optional(off) : std::nullopt;
}

std::optional<Apex> apex_for(const SurfaceGeometry& surface, const Box<2>& face) {
    const auto apex = apex_of(surface, face);
    return apex && !face.is_empty() && is_worth_a_cone(*apex, surface, face) ? apex : std::nullopt;
}

}  // namespace freiform
