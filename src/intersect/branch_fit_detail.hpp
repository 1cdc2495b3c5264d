// From a traced branch to splines: as few cubic pieces as a greedy search finds.
//
// Pieces interpolate points and tangents in space and in both pairs of parameters, with derivatives as if the
// parameter were the length of the curve; so neighbours join with C^1.
#pragma once
#include "branch_proof_detail.hpp"
#include "trace_detail.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform::detail {

class TraceFit {
public:
    TraceFit(const Charts& charts, const std::array<const BranchProof*, 2>& proofs, double tolerance)
        : charts_(charts), proofs_(proofs), tolerance_(tolerance) {}

    SurfaceBranch operator()(Trace trace);

private:
    struct Frame {
        Vec<3> point{}, tangent{};
        std::array<Vec<2>, 2> at{}, slope{};
    };
    struct Piece {
        CubicArc<Vec<3>> space{};
        std::array<CubicArc<Vec<2>>, 2> at{};
        std::array<Vec<3>, 2> tangent{};
        std::array<std::array<Vec<2>, 2>, 2> slope{};  // of which surface, at which end
        double length = 0;
    };
    using Bound = std::array<double, 2>;

    Frame frame(const Place4& x) const;
    Piece piece(const Frame& a, const Frame& b, double t) const;
    bool looks_good(const Piece& p, std::size_t i, std::size_t j) const;
    std::optional<Bound> prove(const Piece& p) const;
    Bound by_size(const Piece& p) const;
    bool refine(std::size_t i);
    SurfaceBranch spline(const std::vector<Piece>& pieces) const;

    const Charts& charts_;
    std::array<const BranchProof*, 2> proofs_;
    double tolerance_;
    std::vector<TracePoint> points_;
    std::vector<Frame> frames_;
};

}  // namespace freiform::detail
