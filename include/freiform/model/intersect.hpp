// Where the faces of two models, or two trimmed faces, meet: every branch, cut off at the loops of both.
#pragma once
#include <freiform/intersect/surface_surface.hpp>
#include <freiform/model/model.hpp>
#include <freiform/path/path.hpp>

namespace freiform {

inline constexpr int kAtTrim = -3;  // what a branch ends at: a loop of one of the faces

// Where on the boundary of a face.
struct TrimPlace {
    int side = 0;  // 0: of the first model, 1: of the second one
    int loop = -1, coedge = -1;
    int edge = -1;  // of the model; -1: a segment that joins the ends of two coedges
};

// In the parameters of both faces; ends: kAtTrim, or as SurfaceBranch has them, nodes of the whole answer.
struct FaceBranch : SurfaceBranch {
    std::array<int, 2> faces{};        // of the first model, of the second one
    std::array<TrimPlace, 2> trims{};  // of ends that are kAtTrim
    std::array<bool, 2> along_trim{};  // some of it runs along a loop of this face within the tolerance
};
// The part of an overlap that is in both faces, as a region: outer loops counter-clockwise in the parameters
// of the first face, holes clockwise; the same segments in those of the second one.
struct FaceOverlap {
    Path at_a, at_b;
    double gap = 0;    // bound: no point of either region is farther from the other one
    double bound = 0;  // bound: of how far the outline may be off in space, on the first face
};
struct FaceNode : SurfaceNode {
    std::array<int, 2> faces{};
    // Of `overlaps`, what the loops of both faces leave; not of maps between parameters that are not affine.
    std::vector<FaceOverlap> regions;
};
struct ChainLink {
    int branch = -1;
    bool reversed = false;  // it is run through from its end
};
// Branches one after the other, over the edges of faces.
struct BranchChain {
    std::vector<ChainLink> links;
    bool closed = false;
    double gap = 0;  // bound: from where a branch ends to where the next one begins
};
// Two faces of which nothing is known: over boxes of both parameters, or all of them, with the reason.
struct OpenFaces {
    std::array<int, 2> faces{};  // -1: with none of the other model
    std::vector<std::array<Interval, 4>> boxes;
    std::optional<Refusal> reason;
};

struct ModelIntersection {
    std::vector<FaceBranch> branches;  // ordered by faces
    // Every branch is in one of them. Ends at loops are joined where they are the only two at a place: within
    // the tolerance of the edges there and 64 times the tolerance asked for.
    std::vector<BranchChain> chains;
    std::vector<FaceNode> nodes;  // those whose boxes are not proven to be outside of one of the faces
    std::vector<OpenFaces> open;
    double search_bound = 0;  // PartIntersection::search_bound, the largest sum of both
};

// All pairs of faces. What is in and out of a face is decided by the odd-even rule of its loops, exactly, in
// the middle between two crossings of the branch with them; where the branch runs along a loop within the
// tolerance it belongs to the face. Crossings of branches with loops are proven (curve_curve.hpp) for the
// curves as they are, so ends are off by what the branch may be off, divided by the sine of the angle at
// which it meets the loop. Faces that a closed branch leaves nowhere have it whole.
//
// Outside of branches, cells of nodes and what is open the faces do not come together, but for
// `search_bound`.
//
// Refuses tolerances that are not positive.
//   const auto found = intersect(a, b, SurfaceIntersectOptions{.tolerance = 1e-6});
Result<ModelIntersection> intersect(const Model& a, const Model& b, const SurfaceIntersectOptions& options);

}  // namespace freiform
