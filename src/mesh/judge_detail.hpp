// What is proven of one triangle, from bounds of second derivatives.
#pragma once
#include "curvature_tree_detail.hpp"

#include <functional>

namespace freiform {

struct Judgement {
    bool shifted = false;         // a foot exists for each of its points
    double bound = 0, whole = 0;  // of the distance; of the whole interpolation error
    Curvature curvature;          // that matters, where the bound is above the tolerance
};

class Judge {
public:
    // `face`: the box of the boundary.
    Judge(const CurvatureTree& tree, const DerivativeQuery<2, 3>& surface, const Box<2>& face,
          double tolerance);
    // A triangle within `box`, of which `at` is known; `plain` of its corners need no foot. `near_place`: of
    // the box, in the tree. `is_deep`: no side is on the boundary of the face.
    Judgement operator()(const Bending& at, const Box<2>& box, const std::array<Vec<2>, 3>& corner, int plain,
                         int near_place, bool is_deep) const;
    // The same of halves of a cell, none of which is at the boundary, with these sides, whose interpolation
    // error is at most `error`.
    Judgement cell(const Bending& at, const Box<2>& box, const Vec<2>& sides, double error, int plain,
                   int near_place) const;
    double cell_error(const Bending& at, const Box<2>& box, const Vec<2>& sides) const;
    // The same of halves of the box itself, or of triangles of points on its sides.
    Judgement leaf(const Bending& at, const Box<2>& box, double error, int plain, int near_place) const;
    // Of halves of all cells in the box by the better diagonal, and triangles of their sides and centres, all
    // of whose corners have feet. REQUIRES at.knows_middle().
    Judgement cells(const Bending& at, const Box<2>& box, const Vec<2>& sides, double error,
                    int near_place) const;
    // Of halves of the box by the better diagonal, all of whose corners have feet: the bound; `error` may be
    // that of halves alone. `proven`: as CurvatureTree::Proof says. REQUIRES at.knows_middle().
    double halves(const Bending& at, const Box<2>& box, double error, double proven, int near_place) const;
    double whole_halves_error(const Bending& at, const Box<2>& box) const;  // where they are plain; likewise

private:
    // Of what is seen along normals that turn by so much; less is not looked for than what is enough.
    using SeenError = std::function<double(double, double)>;
    // `is_likely`: it is known already that a foot straight below would do, or nearly so.
    Judgement judged(const Bending& at, const Box<2>& box, const SeenError& seen_error, double error,
                     int plain, int near_place, bool is_deep, bool is_likely = false) const;
    bool is_within_limits(const Box<2>& box) const;
    // Whether what a CurvatureTree::Proof asks of what is around a box with this error is so.
    bool bends_evenly_around(const Bending& at, const Box<2>& box, double error) const;
    Curvature over_clamped(const Box<2>& box) const;
    bool is_turned_over(const std::array<Vec<2>, 3>& corner) const;  // of a cone

    const CurvatureTree& tree_;
    const DerivativeQuery<2, 3>& surface_;
    double tolerance_ = 0;
    std::array<Interval, 2> limits_;
    Box<2> whole_;           // somewhat more than the face, within the limits
    Curvature whole_bends_;  // over it
};

}  // namespace freiform
