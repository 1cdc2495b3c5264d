// What sewing is made of: looking along edges, proving that two are the same, and telling faces their
// outside.
#pragma once
#include <freiform/core/visit.hpp>
#include <freiform/model/edge_gap.hpp>
#include <freiform/model/sew.hpp>

#include <array>
#include <optional>
#include <span>

namespace freiform {

inline constexpr int kPlacesPerSpan = 4;    // of a trace, at least
inline constexpr double kFewRoundings = 4;  // of EdgeGapOptions: what is bounded closely

// Part of an edge, with places along it. Places are for finding; nothing is proven by them.
struct EdgeTrace {
    const CurveGeometry<3>* curve = nullptr;
    Interval on;
    std::vector<double> t;  // increasing, the ends of `on` included
    std::vector<Vec<3>> at;
    double extent = 0;  // the largest distance of a place from the first

    const Vec<3>& end(bool last) const { return last ? at.back() : at.front(); }
};
EdgeTrace trace_of(const CurveGeometry<3>& curve, Interval on);

// Of a spline, inside the interval; `kinks_only`: those where it may have corners.
template <int D>
std::vector<double> breaks_inside(const CurveGeometry<D>& curve, Interval on, bool kinks_only) {
    std::vector<double> inside;
    visit_one(
        [&](const auto& c) {
            if constexpr (requires { c.net(); })
                for (const double b : c.basis().breaks())
                    if (on.lo < b && b < on.hi &&
                        (!kinks_only || c.basis().multiplicity(b) >= c.basis().degree()))
                        inside.push_back(b);
        },
        curve);
    return inside;
}

struct EdgeFoot {
    double t = 0, distance = 0;
    Vec<3> point{};
};
// The nearest point, from the nearest places and a guess by Newton's method. An estimate.
EdgeFoot foot_on(const EdgeTrace& edge, const Vec<3>& p, std::optional<double> guess = std::nullopt);

// A monotone map from the parameters of one edge to those of another: cubic between nodes.
struct EdgeMap {
    struct Node {
        double t = 0, s = 0;
        double before = 0, after = 0;  // ds/dt on both sides; they differ at kinks
    };
    std::vector<Node> nodes;  // t increasing
    bool is_affine = false;

    double operator()(double t) const;
    double slope(double t) const;  // from the right
};

struct EdgeMatch {
    EdgeMap map;       // from parameters of the one that stays to those of the other
    double bound = 0;  // of |stays(t) - other(map(t))|, proven
};
// Are the two the same within the tolerance, `other` run through backwards if `reversed`? The refusal says
// by how much not (no_answer: measured), or that it could not be proven (not_converged).
Result<EdgeMatch> match(const EdgeTrace& stays, const EdgeTrace& other, bool reversed, double tolerance);

struct FollowedCurve {
    CurveGeometry<2> curve;  // over the range of the edge that stays
    double bound = 0;        // of the gap between it, on its surface, and that edge
};
// The parameter curve `on_surface` of the edge `other`, reparametrised so that it belongs to `stays`. Refuses
// (not_converged) if it cannot be brought within `allowed` of it.
Result<FollowedCurve> followed(const DerivativeQuery<2, 3>& surface, const CurveGeometry<2>& on_surface,
                               const EdgeTrace& stays, const EdgeMatch& match, double allowed);

// Sides of a polygon along a parameter curve, in the direction of its parameter.
using Side2 = std::array<Vec<2>, 2>;
std::vector<Side2> sides_along(const CurveGeometry<2>& curve, Interval on);

// `sum`: its sign tells whether the normals of a closed part, turned over where `inward`, point out of what
// it encloses; 0 where samples cannot tell. An estimate. `box`: of the samples.
struct PartFacing {
    double sum = 0;
    Box<3> box;
};
PartFacing facing(const Model& model, std::span<const int> part, std::span<const char> inward);

// Turns faces over until neighbours along edges with two faces agree, in every part of the model that has an
// edge of `joined`: where that closes it outward, unless it agrees already and may be a hollow in another;
// else as few as possible.
void orient(Model& model, std::span<const SewnEdge> joined, std::vector<int>& flipped,
            std::vector<int>& twisted);
// Shells that are connected by edges of `joined` become one.
void unite_shells(Model& model, std::span<const SewnEdge> joined);

// Edges with one face, each with its distance from the others; without a reason of their own.
std::vector<RemainingGap> remaining_gaps(const Model& model, double tolerance);

// Points, asked for those in a box.
class PointTree {
public:
    explicit PointTree(std::vector<Vec<3>> points);
    // Indices in increasing order.
    std::vector<int> in(const Box<3>& box) const;

private:
    std::vector<Vec<3>> points_;
    std::vector<int> order_;  // a balanced tree: the middle of a range splits it along `axis_` of its place
    std::vector<int> axis_;
};

// The openings that the gaps go round; each gap gets the number of its own.
std::vector<Opening> openings_of(const Model& model, std::vector<RemainingGap>& gaps);

}  // namespace freiform
