// Conics by equation: which kind it is (never wrong), its centre and axes, its arcs inside a box, and back.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/make/conic.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace freiform {

// c[0] x^2 + c[1] x y + c[2] y^2 + c[3] x + c[4] y + c[5] = 0, with (x, y) counted from `origin`.
struct ConicEquation {
    std::array<double, 6> c{};
    Vec<2> origin{};
    friend bool operator==(const ConicEquation&, const ConicEquation&) = default;
};

enum class ConicType {
    circle,
    ellipse,
    parabola,
    hyperbola,
    crossing_lines,
    parallel_lines,
    double_line,  // a line, counted twice
    line,         // no quadratic terms
    point,
    empty,  // no real point
    plane,  // all coefficients are 0
};
std::string_view name_of(ConicType type);  // "crossing lines"

// The kind, exactly, of these doubles. Refuses coefficients that are not finite.
Result<ConicType> classify(const ConicEquation& equation);

// What the equation describes. Every vector has a bound of the error of its coordinates.
struct ConicForm {
    ConicType type = ConicType::empty;
    std::optional<FoundConic<2>> conic;  // circle, ellipse, parabola, hyperbola (the other branch: -x for x)
    std::vector<Line<2>> lines;          // one or two
    std::optional<Vec<2>> point;
    double bound = 0;  // of the coordinates of points, and of origins and directions of lines
};
// Centre and axes of an ellipse or a hyperbola, vertex and axes of a parabola, lines, a point. Refuses
// (ill_conditioned) numbers that leave the range of double.
//   auto form = solve(ConicEquation{{1, 0, 4, 0, 0, -4}});   // x^2 + 4 y^2 = 4: form->conic->conic.x is (2,
//   0)
Result<ConicForm> solve(const ConicEquation& equation);

// The parts of a circle, ellipse, parabola or hyperbola (both branches) inside the box, as rational quadratic
// splines; a whole ellipse if it is inside. Arcs that rounding cannot tell from a point of contact are left
// out.
Result<std::vector<ConicArc<2>>> arcs_inside(const ConicForm& form, const Box<2>& box);

struct FoundEquation {
    ConicEquation equation;
    std::array<double, 6> bound{};  // of each coefficient
    ConicType type = ConicType::ellipse;
};
// The equation of an analytic conic, from its centre as origin, largest coefficient about 1. Refuses axes
// that are parallel.
Result<FoundEquation> equation_of(const Conic<2>& conic);

// The conic through five points, from points[0] as origin. `type` is that of the exact conic through these
// doubles. Refuses points that are not finite, points that more than one conic passes (four on a line, or
// equal ones), and degenerate conics: no_answer, the message says which.
Result<FoundEquation> equation_through(const std::array<Vec<2>, 5>& points);

struct FivePointArc {
    Curve<Hom<2>> curve;                  // on [0, 1]
    ConicType type = ConicType::ellipse;  // of the exact conic
    std::array<double, 5> at{};           // parameters of the points
    double bound = 0;                     // curve(at[i]) is no farther than this from points[i]
};
// The arc from points[0] through the others, in their order, to points[4]; of an ellipse possibly more than
// half. Refuses (no_answer) points whose conic passes them in another order, on both branches, or only
// through infinity.
//   auto arc = arc_through({{{{5, 0}}, {{4, 3}}, {{3, 4}}, {{0, 5}}, {{-5, 0}}}});   // half a circle
Result<FivePointArc> arc_through(const std::array<Vec<2>, 5>& points);

}  // namespace freiform
