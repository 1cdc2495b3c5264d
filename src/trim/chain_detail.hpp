// Loops as chains of Bezier pieces: what the inside test and the check of loops begin with.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <variant>
#include <vector>

namespace freiform::detail {

struct ChainPiece {
    std::variant<std::vector<Vec<2>>, std::vector<Hom<2>>> net;
    std::size_t curve = 0;  // of the loop

    Hom<2> start() const;
    Hom<2> end() const;
    std::vector<Hom<2>> lifted() const;  // weights 1 where there are none
};

// The chain of a loop, or none if the loop is one ellipse. Refuses, as "[i]", loops without curves, curves
// without ends, and gaps between neighbours of more than `gap` and what rounding accounts for, where curves
// are rational or not clamped; smaller ones are left open.
Result<std::vector<ChainPiece>> chain_of(const std::vector<CurveGeometry<2>>& loop, double gap);

// An ellipse that is a whole loop.
const Conic<2>* ellipse_of(const std::vector<CurveGeometry<2>>& loop);

}  // namespace freiform::detail
