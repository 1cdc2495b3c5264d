// The state of a tessellation: how it is made is in tessellate.cpp, what comes out of it in
// tessellate_collect.cpp.
#pragma once
#include "face_boundary_detail.hpp"
#include "stand_ins_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>
#include <freiform/model/tessellate.hpp>

#include <span>

namespace freiform {

// What triangles beside the boundary add to the bound of an edge at most: see bending.cpp.
constexpr double kBesideBoundary = 1 + 1.0 / 64;

// What does not depend on the options: bounds of the derivatives of all surfaces and curves, ready to be
// asked.
struct SharedWork {
    explicit SharedWork(const Model& model);
    std::vector<std::unique_ptr<DerivativeQuery<2, 3>>> queries;
    std::vector<std::optional<Apex>> apexes;  // of faces that are taken as cones
    EdgeMesher edges;
};

// For each face the colour of its body; null where there is none.
std::vector<const Colour*> body_colours(const Model& model);
// Turns shells of solids whose triangles look the wrong way (outward_mesh.cpp).
void turn_outwards(const Model& model, Tessellation& t);

class Tessellator {
public:
    // `sizes`: estimates of the triangles of faces; `stand_ins`: what stands for faces in the model, null if
    // nothing does.
    Tessellator(const Model& model, SharedWork& shared, const TessellateOptions& options,
                std::vector<double> sizes, const StandIns* stand_ins)
        : model_(model),
          options_(options),
          stand_ins_(stand_ins),
          sizes_(std::move(sizes)),
          queries_(shared.queries),
          apexes_(shared.apexes),
          edges_(&shared.edges),
          boundaries_(model.faces.size()),
          meshes_(model.faces.size()),
          extra_(model.faces.size()),
          refusals_(model.faces.size()) {}

    Result<Tessellation> run();

private:
    std::size_t faces() const { return model_.faces.size(); }
    bool is_large(std::size_t f) const;
    bool is_refused(std::size_t f) const { return refusals_[f].has_value(); }
    EdgeDemands edge_demands() const {
        return {tolerance_ / kBesideBoundary, options_.max_edge, options_.max_angle};
    }
    FaceDemands face_demands(std::size_t face) const;
    Result<void> discretise_edges();
    Result<void> match_grids();
    void number_points();
    void assemble(std::size_t face);
    void refuse_boundary(std::size_t face, const BoundaryConflict& conflict);
    struct Cut {
        int edge, segment;
        double part;
    };
    void add_cut(std::size_t face, int segment, double part, std::vector<Cut>& cuts) const;
    std::vector<Cut> cuts_for(std::size_t face, const BoundaryConflict& conflict) const;
    // A face whose boundary touches itself, and the edges that do; or one that is open.
    struct Clash {
        std::size_t face;
        bool open;
        std::vector<int> edges;
    };
    bool is_straight(int edge) const;
    bool is_turned_over(std::size_t face) const;
    std::vector<Clash> cut_conflicts(std::vector<std::vector<double>>& before);
    void edges_of(std::size_t face, const BoundaryConflict& conflict, std::vector<int>& out) const;
    // Points of a boundary at one place: vertices, and the edges that have the others.
    struct Doubled {
        std::vector<std::pair<int, int>> vertices;
        std::vector<int> edges;
    };
    Doubled doubled(std::size_t face) const;
    double accuracy_at(int edge, int vertex, double of_face) const;
    bool collapse(int edge, double of_face);
    bool shorten(int edge, double of_face);
    void undo_cuts(const std::vector<std::vector<double>>& before);
    void resolve_conflicts();
    static std::vector<int> corners_between(const FaceBoundary& polygon, int s, int t);
    bool add_strip(std::size_t face, int s, int t, const std::vector<int>& lens, std::vector<Cut>& cuts);
    static void leave_out(BoundaryOfFace& boundary, int s, int t, const std::vector<int>& lens);
    void cut_at_crossing(std::size_t face, int s, int t, std::vector<Cut>& cuts) const;
    bool close_lenses(std::size_t face, std::vector<Cut>& cuts);
    void close_all_lenses(std::vector<char> crossing);
    std::vector<char> cut_lenses(std::vector<char> looked_at);
    void add_strips();
    Result<void> fill(std::span<const std::size_t> which);
    Result<void> fill_all();
    std::optional<Refusal> far_parameter(std::size_t face) const;
    bool add_extra(std::size_t face, const Vec<2>& uv);
    bool halve(std::size_t face, int u, int v);
    bool look_across(std::size_t face, int u, int v);
    std::array<int, 2> flat_side(const FaceMesh& mesh, const std::array<int, 3>& triangle) const;
    std::vector<std::size_t> faces_to_mend();
    // The triangles of a face with vertices for both sides of kinks: where each is looked at, a little beside
    // the kink if need be, and of which of the mesh those behind these are copies.
    struct Sides {
        std::vector<std::array<int, 3>> triangles;
        std::vector<Vec<2>> place;
        std::vector<int> copy_of;
    };
    Sides sides_of(std::size_t face) const;
    struct FaceLook {
        std::vector<MeshVertex> vertices;
        std::vector<Vec<3>> inner;
        std::vector<std::array<int, 3>> triangles;  // none: those of the mesh
    };
    FaceLook look_of(std::size_t face, bool flip) const;
    Tessellation collect();
    void measure_angles(Tessellation& out) const;
    const StandIn* stand_in(std::size_t face) const {
        return stand_ins_ && stand_ins_->faces[face] ? &*stand_ins_->faces[face] : nullptr;
    }
    // The surface at the parameters of the mesh, as it is given if it has them.
    const SurfaceGeometry& shape(std::size_t face) const {
        const StandIn* of = stand_in(face);
        return of && !of->is_plane ? of->given->surface : model_.faces[face].surface;
    }
    std::vector<Vec<2>> given_places(std::size_t face) const;
    Vec<3> normal_at(std::size_t face, const Vec<2>& uv, const Vec<2>& inwards, const Vec<2>& usual) const;
    double rounding_of(std::size_t face) const;

    const Model& model_;
    const TessellateOptions& options_;
    const StandIns* stand_ins_;
    std::vector<double> sizes_;
    double tolerance_ = 0, rounding_ = 0;
    const std::vector<std::unique_ptr<DerivativeQuery<2, 3>>>& queries_;
    const std::vector<std::optional<Apex>>& apexes_;
    EdgeMesher* edges_;
    std::vector<Vec<3>> points_;                 // on vertices and edges
    std::vector<std::pair<int, int>> together_;  // vertices that are one point
    std::vector<BoundaryOfFace> boundaries_;
    std::vector<std::optional<GridLines>> grids_;  // of faces that are rectangles, where quads are asked for
    std::vector<FaceMesh> meshes_;
    std::vector<std::vector<Vec<2>>> extra_;
    std::vector<std::optional<Refusal>> refusals_;
};

}  // namespace freiform
