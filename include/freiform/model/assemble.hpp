// Models from loose surfaces: patches of a teapot, surfaces of a document.
#pragma once
#include <freiform/model/model.hpp>

#include <map>

namespace freiform {

// Collects surfaces as faces of one shell. Boundaries that are the same curve (equal control points in the
// same or the opposite order, equal knots after scaling to [0, 1]) become one edge, so that patches which
// share their boundary points are joined without a gap. Nothing is moved: almost equal boundaries stay apart.
class ModelBuilder {
public:
    using SplineSurface = std::variant<Surface<Vec<3>>, Surface<Hom<3>>>;

    explicit ModelBuilder(std::string unit = {}) { model_.unit = std::move(unit); }

    // The whole surface, bounded by its four sides. A side whose control points are all equal is a pole; a
    // closed basis is cut at its seam, which becomes one edge with two coedges. Returns the index of the
    // face.
    Result<int> add(SplineSurface surface, std::string name = {}, std::optional<Colour> colour = {});

    // A flat triangle.
    Result<int> add(const std::array<Vec<3>, 3>& corners, std::string name = {},
                    std::optional<Colour> colour = {});

    // The part of the surface inside `loops` (odd-even rule): closed chains of curves in its parameter plane,
    // each over its whole domain. Their edges belong to this face alone.
    Result<int> add_trimmed(SplineSurface surface, std::span<const std::vector<CurveGeometry<2>>> loops,
                            std::string name = {}, std::optional<Colour> colour = {});

    // One body; a solid if every edge is used twice.
    Result<Model> finish(std::string name = {}) &&;

private:
    using BoundaryCurve = std::variant<Curve<Vec<3>>, Curve<Hom<3>>>;
    int vertex_at(const Vec<3>& p);
    Coedge coedge_for(const BoundaryCurve& curve, const Vec<2>& from, const Vec<2>& to);

    Model model_;
    std::map<std::array<double, 3>, int> vertices_;
    std::map<std::pair<int, int>, std::vector<int>> edges_;  // by their vertices, the smaller first
};

}  // namespace freiform
