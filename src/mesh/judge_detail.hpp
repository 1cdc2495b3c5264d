// What is proven of one triangle, from bounds of second derivatives.
#pragma once
#include "curvature_tree_detail.hpp"

namespace freiform {

struct Judgement {
    bool shifted = false;         // a foot exists for each of its points
    double bound = 0, whole = 0;  // of the distance; of the whole interpolation error
    Curvature curvature;          // that matters
};

class Judge {
public:
    // `face`: the box of the boundary.
    Judge(const CurvatureTree& tree, const DerivativeQuery<2, 3>& surface, const Box<2>& face,
          double tolerance);
    // A triangle within `box`, of which `at` is known; `plain` of its corners need no foot. `near_place`: of
    // the box, in the tree.
    Judgement operator()(const Bending& at, const Box<2>& box, const std::array<Vec<2>, 3>& corner, int plain,
                         int near_place) const;

private:
    Curvature over_clamped(const Box<2>& box) const;

    const CurvatureTree& tree_;
    const DerivativeQuery<2, 3>& surface_;
    double tolerance_ = 0;
    std::array<Interval, 2> limits_;
    Box<2> whole_;           // somewhat more than the face, within the limits
    Curvature whole_bends_;  // over it
};

}  // namespace freiform
