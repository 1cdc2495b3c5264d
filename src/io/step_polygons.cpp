// Faces within polygons. The corners of a polygon are all that says where its face is: the faces beside it
// have the same corners. Some programs name any plane for such faces, the same one for all. A plane that
// polygons of a shell miss is therefore not what bounds its faces: each gets the plane through its corners,
// with the normal about which they run counter-clockwise, and it is told.
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/quadric.hpp>

#include <algorithm>

namespace freiform::step {

Result<std::vector<std::uint32_t>> ShapeReader::corners_of(std::uint32_t polygon) const {
    const auto f = Fields::of(f_, polygon, Type::POLY_LOOP, 2);
    if (!f) return std::unexpected(f.error());
    return f->references(1, "points");
}

Result<std::vector<ShapeReader::EdgeMade>> ShapeReader::polygon_edges(std::uint32_t polygon, bool forward) {
    const auto ids = corners_of(polygon);
    if (!ids) return std::unexpected(ids.error());
    std::vector<int> corners;
    for (const std::uint32_t id : *ids) {
        const auto p = geometry_.point(id);
        if (!p) return std::unexpected(p.error());
        corners.push_back(vertex_at(id, *p));
    }
    if (corners.size() < 3)
        return refuse(RefusalKind::invalid, f_.label(polygon), "has fewer than three points");
    if (!forward) std::reverse(corners.begin(), corners.end());
    std::vector<EdgeMade> made;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto edge = straight_edge(corners[k], corners[(k + 1) % corners.size()]);
        if (!edge) return std::unexpected(edge.error());
        made.push_back(*edge);
    }
    return made;
}

// Nothing if one of the loops is no polygon, or if they name points more often than there are words in the
// file.
std::vector<std::vector<Vec<3>>> ShapeReader::polygons_of(std::uint32_t face) const {
    std::vector<std::vector<Vec<3>>> polygons;
    std::size_t left = f_.tokens.size();
    const auto bounds = Fields(f_, face, f_.instances[face].first + 1).references(1, "bounds");
    if (!bounds) return {};
    for (const std::uint32_t b : *bounds) {
        const Fields bound(f_, b, f_.instances[b].first + 1);
        const auto loop = bound.reference(1, "loop");
        if (!loop || f_.type(*loop) != Type::POLY_LOOP) return {};
        const auto ids = corners_of(*loop);
        if (!ids || ids->size() < 3 || ids->size() > left) return {};
        left -= ids->size();
        std::vector<Vec<3>>& corners = polygons.emplace_back();
        for (const std::uint32_t id : *ids) {
            const auto p = geometry_.point(id);
            if (!p) return {};
            corners.push_back(*p);
        }
        if (!bound.flag(2)) std::reverse(corners.begin(), corners.end());
    }
    return polygons;
}

// How far corners are from the plane.
double ShapeReader::off_plane(const std::vector<std::vector<Vec<3>>>& polygons, const Vec<3>& origin,
                              const Vec<3>& normal) {
    double off = 0;
    for (const auto& corners : polygons)
        for (const Vec<3>& p : corners) off = std::max(off, std::abs(dot(p - origin, normal)));
    return off;
}

// Before the faces of a shell are made: those of their planes that their polygons miss.
void ShapeReader::note_missed_plane(std::uint32_t face) {
    if (f_.is(face, Type::ORIENTED_FACE)) {
        const auto of = Fields(f_, face, f_.part(face, Type::ORIENTED_FACE)).reference(2, "face");
        if (!of) return;
        face = *of;
    }
    if (!noted_faces_.insert(face).second) return;
    const Type type = f_.type(face);
    if (type != Type::FACE_SURFACE && type != Type::ADVANCED_FACE) return;
    const auto on = Fields(f_, face, f_.instances[face].first + 1).reference(2, "surface");
    if (!on || f_.type(*on) != Type::PLANE || missed_planes_.contains(*on)) return;
    const auto polygons = polygons_of(face);
    if (polygons.empty()) return;
    const auto at = Fields(f_, *on, f_.instances[*on].first + 1).reference(1, "position");
    const auto p = at ? geometry_.placement(*at) : std::unexpected(at.error());
    if (p && off_plane(polygons, p->o, p->z) > tolerance_) missed_planes_.insert(*on);
}

std::optional<SurfaceGeometry> ShapeReader::own_plane(std::uint32_t face, std::uint32_t surface) {
    if (!missed_planes_.contains(surface)) return std::nullopt;
    const auto polygons = polygons_of(face);
    Vec<3> normal{}, origin{}, along{};
    for (const auto& corners : polygons) {
        Vec<3> area{};
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
            area = area + cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
        if (norm(area) > norm(normal)) normal = area, origin = corners[0], along = corners[1] - corners[0];
    }
    const auto frame = frame_about(origin, normal, along);
    if (!frame || !(off_plane(polygons, origin, frame->z) <= tolerance_)) return std::nullopt;
    return Extrusion{Line<3>{origin, frame->x}, frame->y, SurfaceKind::plane};
}

}  // namespace freiform::step
