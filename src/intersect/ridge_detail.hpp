// Curves along which two surfaces touch.
//
// Idea. Beside such a curve the distance h of A from B, along the normals of B, has a valley: it and its
// slope vanish at the bottom. Charts do not exist there, and the surfaces are near to each other in a strip
// of the width of the root of the tolerance: a cluster. The bottom of the valley is found across it by
// Newton's method for h_d = 0, d the direction in which h bends most, and followed in the other direction.
//
// Notation. (u, v) of A, (s, t) of B, the foot of A(u, v). j = J d: how (s, t) changes with (u, v) along d.
//     h_d = N . A_d,    h_dd = N . (A_dd - B_jj)  where h = 0,    N the unit normal of B.
//
// Method. A step is as long as a cubic piece with the tangents at both ends is proven to be within the
// tolerance of both surfaces (branch_proof_detail.hpp); so the pieces are the branch. At borders it ends,
// over seams it goes on; where the proof fails for short steps, too, the valley leaves the surfaces and the
// branch ends in its node.
//
// Accuracy. That both surfaces are within the bounds of the curve is proven. Whether they touch, meet in two
// curves next to each other, or are a little apart is not: rounding does not tell.
//
// Why not Newton's method for A - B = 0 and parallel normals? These are five equations for a curve in four
// parameters, and have no zeros once the surfaces are moved by a rounding.
#pragma once
#include "branch_proof_detail.hpp"
#include "charts_detail.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform::detail {

class RidgeTracer {
public:
    RidgeTracer(const Charts& charts, const std::array<const SurfaceGeometry*, 2>& shapes,
                const std::array<const BranchProof*, 2>& proofs, double tolerance)
        : charts_(charts), shapes_(shapes), proofs_(proofs), tolerance_(tolerance) {}

    // Every one in the cells of a cluster; `node`: what they end at inside.
    std::vector<SurfaceBranch> all(const Cluster& cluster, int node);
    // Do these go round or to borders, and is every cell beside one of them?
    bool are_all_of(const Cluster& cluster, const std::vector<SurfaceBranch>& branches) const;

private:
    struct Valley {
        Place4 x{}, along{};  // with the length of the curve
        Vec<3> point{}, tangent{};
        double height = 0;
        Vec<2> across{};  // d, |A_d| = 1
    };
    struct Piece {
        CubicArc<Vec<3>> space{};
        std::array<CubicArc<Vec<2>>, 2> at{};
        double length = 0;
    };
    struct Run {
        std::vector<Piece> pieces;
        int end = kAtBorder;
        bool closed = false;
    };

    bool foot(Place4& x) const;
    std::optional<Valley> look(Place4 x, const Vec<3>& heading) const;
    std::optional<Valley> bottom(Place4 x, const Vec<3>& heading) const;
    bool step_over_seams(Valley& from) const;
    bool is_at_border(const Valley& from) const;
    std::optional<Valley> ahead(const Valley& from, double& by, bool& at_border) const;
    std::optional<std::array<double, 2>> prove(const Valley& from, const Valley& to, Piece& out) const;
    Run follow(Valley from, double first, const Valley& start, int node);
    SurfaceBranch branch(const Run& back, const Run& forth) const;

    const Charts& charts_;
    std::array<const SurfaceGeometry*, 2> shapes_;
    std::array<const BranchProof*, 2> proofs_;
    double tolerance_, longest_ = 0;
    std::array<double, 2> bound_{};
};

}  // namespace freiform::detail
