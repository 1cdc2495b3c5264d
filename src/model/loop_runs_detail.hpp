// Where a curve of the parameter plane runs along the loops of a face.
#pragma once
#include <freiform/spline/patch.hpp>

#include <vector>

namespace freiform {

// A curve of a loop, with points to begin at when a foot is looked for.
class LoopRail {
public:
    explicit LoopRail(const Curve<Hom<2>>& curve);

    const Curve<Hom<2>>& curve() const { return curve_; }
    // A local foot of p: the parameter; nothing where it is farther than `within`.
    std::optional<double> foot(const Vec<2>& p, double within) const;
    // Is all of the arc with these control points within a distance of the rail? Proven where true.
    bool carries(const std::vector<Vec<2>>& arc, double within) const;

private:
    Curve<Hom<2>> curve_;
    std::vector<std::pair<double, Vec<2>>> samples_;
};

// Parts of a cubic spline, in order: along a rail (its number), or free of all, as far as is known (-1).
struct RailRun {
    Interval on;
    int rail = -1;
};
// `rails`: those that are near it. Parts that are shorter than some times `within` and begin and end next to
// a rail are along it.
std::vector<RailRun> rail_runs(const Curve<Vec<2>>& curve, const std::vector<const LoopRail*>& rails,
                               double within);

}  // namespace freiform
