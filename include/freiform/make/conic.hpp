// Conics as rational splines: arcs of circles, ellipses, parabolas and hyperbolas, of any angle, in the plane
// and in space, and whole ellipses. All from the analytic Conic of geometry.hpp or from points and tangents.
//
// A curve here differs from the conic only by the rounding of its coefficients, and says by how much.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <numbers>
#include <span>

namespace freiform {

template <int D>
struct ConicArc {
    Curve<Hom<D>> curve;  // on [0, 1]
    double bound = 0;     // distance of every point from the point of the exact conic at the same parameter
};

// A conic that was computed: `conic` with bounds of the errors of its three vectors.
template <int D>
struct FoundConic {
    Conic<D> conic;
    double centre_bound = 0, x_bound = 0, y_bound = 0;
};

// Pieces of an ellipse cover at most this angle of its parameter, unless asked otherwise.
inline constexpr double kWidestPiece = std::numbers::pi / 2;

// The part of a conic over parameters `on` (ellipse: an angle in radians, at most 2 pi long but for 2^-32 of
// it, the digits that files have; 2 pi as a double is the whole ellipse). Parabolas and hyperbolas are one
// quadratic piece, ellipses the fewest of equal angle that is at most `widest`, which is below pi; they join
// at on.lo + k (on.hi - on.lo) / n, rounded. Refuses axes x and y that are parallel, empty intervals, and
// numbers that leave the range of double.
//   auto arc = conic_arc(Conic<2>{ConicKind::ellipse, {{0, 0}}, {{2, 0}}, {{0, 1}}}, {0, 3});
template <int D>
Result<ConicArc<D>> conic_arc(const FoundConic<D>& conic, Interval on, double widest = kWidestPiece);
template <int D>
Result<ConicArc<D>> conic_arc(const Conic<D>& conic, Interval on, double widest = kWidestPiece) {
    return conic_arc(FoundConic<D>{conic}, on, widest);
}

enum class EllipseForm {
    open,     // four quadratic pieces, clamped: nine control points
    closed,   // the same on a closed basis: eight control points, double knots
    quintic,  // one Bezier piece of degree 5 with the weights 5 1 1 1 1 5: nothing is irrational
};
// A whole ellipse, from its parameter 0 on. In the quintic form a circle whose numbers are dyadic is exact.
template <int D>
Result<ConicArc<D>> full_ellipse(const Conic<D>& conic, EllipseForm form);

// The circle about `centre`, counter-clockwise; of the plane, from (radius, 0) on.
Result<Conic<2>> circle(const Vec<2>& centre, double radius);
// Counter-clockwise seen from the tip of `normal`, which may have any length. Refuses radii that are not
// positive, and a zero normal.
Result<FoundConic<3>> circle(const Vec<3>& centre, const Vec<3>& normal, double radius);

// The circular arc from a through b to c. Refuses three points on one line (in each coordinate plane,
// exactly).
template <int D>
Result<ConicArc<D>> arc_through(const Vec<D>& a, const Vec<D>& b, const Vec<D>& c,
                                double widest = kWidestPiece);

// The conic with weights 1, `weight`, 1 at a, corner, c: ellipse below 1, parabola at 1, hyperbola above.
// Weights in (-1, 0) are the rest of the ellipse, beyond a and c; the arc is cut in halves until weights are
// positive. Refuses points on one line and weights that are 0 (the chord) or at most -1 (a pole).
template <int D>
Result<ConicArc<D>> weighted_arc(const Vec<D>& a, const Vec<D>& corner, const Vec<D>& c, double weight);

// The conic arc from a, leaving in the direction `at_a`, to c, arriving in the direction `at_c`, through a
// point, of which the shoulder is an example. Directions may be opposite (half an ellipse) and have any
// length. Refuses (no_answer) what no arc of one conic does: an inflection, a point on the wrong side of the
// tangents or of the chord.
Result<ConicArc<2>> tangent_arc(const Vec<2>& a, const Vec<2>& at_a, const Vec<2>& c, const Vec<2>& at_c,
                                const Vec<2>& through);

}  // namespace freiform
