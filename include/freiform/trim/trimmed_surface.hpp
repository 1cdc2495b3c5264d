// A surface of which loops in its parameter domain keep a part.
//
//        v +-----------------+        The part kept is where the odd-even rule says inside: an outer loop and
//          |   +---------+   |        holes, in any order and any orientation. No loops: all of the domain.
//          |   |///+-+///|   |
//          |   |///+-+///|   |
//          |   +---------+   |
//          +-----------------+ u
#pragma once
#include <freiform/spline/geometry.hpp>

#include <variant>
#include <vector>

namespace freiform {

struct TrimmedSurface {
    std::variant<Surface<Vec<3>>, Surface<Hom<3>>> surface;
    // Curves in the parameter domain, the end of each at the start of the next, the last at the first.
    std::vector<std::vector<CurveGeometry<2>>> loops;

    // Gaps between curves, and what a curve leaves the domain by, are at most this fraction of the domain's
    // side: what numbers of nine digits need. Nothing is moved.
    static constexpr double kSlack = 0x1p-30;

    // Refuses loops that are empty, open (the message says the gap), leave the domain, or cross themselves or
    // each other (check_loops: what only touches is kept), across the seams of closed axes too, there by more
    // than the slack; loops that go round those some hundred times (limit); and curves without ends (lines,
    // parabolas, hyperbolas: a segment is a spline of degree 1). An ellipse is a whole loop.
    static Result<TrimmedSurface> make(std::variant<Surface<Vec<3>>, Surface<Hom<3>>> surface,
                                       std::vector<std::vector<CurveGeometry<2>>> loops);
};

}  // namespace freiform
