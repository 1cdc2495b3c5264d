// Boolean operations of regions: an arrangement of arcs, winding numbers beside each edge, loops of the edges
// that have the result on one side only.
//
// Idea. The boundary of the result is made of edges: parts of the given segments between the places where
// those meet. An edge belongs to it if the result lies on exactly one of its sides, and both sides are known
// exactly (sides.cpp). Nothing is decided by the result of another decision, so nothing can contradict.
//
// Method. meetings.cpp finds all places, none missed. arrangement.cpp unites what rounding does not tell
// apart and cuts arcs into edges. sides.cpp decides. loops.cpp puts together.
//
// Accuracy. Let moved be the largest distance from a place to what was drawn together there, and the width of
// bundles. Take the sum of edges that bounds the exact result, leave out those inside of places, and move the
// ends of the others to the points of their places: no edge is moved by more than `moved`, parts are rounded
// by kPartError, and what was left out lies around a place in a disc of radius `moved`. A point in that disc
// is at most 2 moved away from an arc. So with bound = 2 moved + 2 kPartError * scale the loops wind around
// every point that is farther than the bound from all segments as often as the exact ones: once or not.
//   First only what rounding does not tell is called the same. If that is ill-conditioned, parts of arcs that
// are smaller than 2^-10 of the tolerance are drawn together: lenses between arcs that are
// tangent but for the last bits. If that does not help, because paths run along each other nearer than
// numbers tell (a copy that was turned and turned back), control points are rounded to a grid of a sixteenth
// of the tolerance, so that most of what is nearly the same is the same. That moves control points by 0.71 of
// the grid, and the weight by at most grid / scale, which moves the arc by at most 2.83 grid: |dC / dw| <= 2
// t (1 - t) |P1 - C| / W with W >= 1/2. Together below 4 grid. Last, what is within an eighth of the
// tolerance along each other, or smaller than a part of it, is called the same.
//
// Cost. n segments with k crossings: n log n for the hierarchy of runs, about 1 us for each pair that
// crosses, two winding numbers for each chain of edges.
//
// References. [Bentley Ottmann 1979], [Vatti 1992] for polygons.
//
// Why not a sweep? It decides each event by those before, and an order of curves at touching points that is
// wrong by rounding contradicts itself later. Why not polylines? The result would be another curve.
#include "arrangement_detail.hpp"

#include <cmath>

namespace freiform {

std::string_view name_of(RegionOperation operation) {
    constexpr std::string_view kNames[] = {"union", "intersection", "difference", "exclusion"};
    return kNames[int(operation)];
}

namespace {

using namespace detail;

struct InResult {
    std::array<FillRule, 2> rule;
    RegionOperation operation;

    bool operator()(const std::array<int, 2>& winding) const {
        std::array<bool, 2> in{};
        for (std::size_t k = 0; k < 2; ++k)
            in[k] = rule[k] == FillRule::nonzero ? winding[k] != 0 : winding[k] % 2 != 0;
        switch (operation) {
            case RegionOperation::union_of:
                return in[0] || in[1];
            case RegionOperation::intersection:
                return in[0] && in[1];
            case RegionOperation::difference:
                return in[0] && !in[1];
            case RegionOperation::exclusion:
                return in[0] != in[1];
        }
        return false;
    }
};

Result<Region> attempt(const std::vector<RegionArc>& arcs, const InResult& in, const Nearness& near,
                       const RegionOptions& options) {
    const auto a = arrange(arcs, near, options);
    if (!a) return std::unexpected(a.error());
    const auto sides = sides_of(*a);
    if (!sides) return std::unexpected(sides.error());
    std::vector<int> keep(a->edges.size(), 0);
    for (std::size_t e = 0; e < keep.size(); ++e)
        if (const EdgeSides& s = (*sides)[e]; s.known) keep[e] = int(in(s.left)) - int(in(s.right));
    auto path = loops_of(*a, keep);
    if (!path) return std::unexpected(path.error());
    return Region{*std::move(path), 2 * a->moved + 2 * kPartError * a->scale};
}

Result<Region> made(std::vector<RegionArc> arcs, const InResult& in, const RegionOptions& options) {
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not a length > 0"));
    cancel_opposite(arcs);
    if (arcs.empty()) return Region{};
    auto out = attempt(arcs, in, {}, options);
    if (out || out.error().kind != RefusalKind::ill_conditioned || out.error().where == "tolerance")
        return out;
    if (auto again = attempt(arcs, in, {0x1p-10 * options.tolerance, 0}, options)) return again;
    const double grid = std::exp2(std::floor(std::log2(options.tolerance / 16)));
    std::vector<RegionArc> coarse;
    double scale = 0;
    for (const RegionArc& a : arcs) scale = std::max(scale, a.box.scale());
    for (const RegionArc& a : arcs) add_arc(on_grid(a.s, grid, scale), a.operand, a.place, coarse);
    cancel_opposite(coarse);
    for (const Nearness& near : {Nearness{}, Nearness{0, options.tolerance / 8},
                                 Nearness{options.tolerance / 32, options.tolerance / 32}})
        if (auto again = attempt(coarse, in, near, options)) {
            again->bound += 4 * grid;  // of on_grid
            if (again->bound <= options.tolerance) return again;
        }
    return out;
}

}  // namespace

Result<Region> combine(const Filled& a, const Filled& b, RegionOperation operation,
                       const RegionOptions& options) {
    std::vector<RegionArc> arcs;
    for (const int k : {0, 1})
        if (const auto ok = add_arcs(k == 0 ? a.path : b.path, k, arcs); !ok)
            return refuse_within(k == 0 ? "a" : "b", ok.error());
    return made(std::move(arcs), {{a.rule, b.rule}, operation}, options);
}

Result<Region> region_of(const Filled& a, const RegionOptions& options) {
    std::vector<RegionArc> arcs;
    if (const auto ok = add_arcs(a.path, 0, arcs); !ok) return refuse_within("a", ok.error());
    return made(std::move(arcs), {{a.rule, FillRule::nonzero}, RegionOperation::union_of}, options);
}

}  // namespace freiform
