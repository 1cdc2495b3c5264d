// What the page says of each figure.
#include "gallery/gallery.hpp"

namespace freiform::cli::gallery {

std::span<const Entry> entries() {
    static constexpr std::array<Entry, 22> kEntries{{
        {"R01", "Three descriptions",
         "An explicit curve is the graph of a function, an implicit one the zeros of a function of the "
         "plane, a parametric "
         "one the path of a point. Only the last says where it is at each time.",
         "--names P1 --axes", descriptions},
        {"R02", "Polynomial curves",
         "Each coordinate is a polynomial of the parameter, and the columns of the coefficient matrix belong "
         "to its "
         "powers. The tangent comes from the same matrix and is a curve of one degree less.",
         "--names P1 --hodograph --tangent 0.5", coefficients},
        {"R03", "Q = G M T",
         "Geometry, basis and parameter are three factors: with the same four points another matrix gives "
         "another curve. "
         "Below each curve are the four functions that the points are multiplied by.",
         "--names P1 --basis", one_product},
        {"R04", "Hermite curves",
         "A cubic is given by its two ends and the tangents there. Longer tangents keep the direction and "
         "push the curve "
         "further before it turns.",
         "--axes", hermite},
        {"R05", "Cubic Bézier curves",
         "The curve begins and ends at the outer control points, in the direction of the inner ones, and "
         "lies in the "
         "convex hull of all four. The polygon already shows inflections and loops.",
         "--names P1 --hull", bezier_cubics},
        {"R06", "Bernstein polynomials",
         "The weights of the control points are positive, add up to 1 and are mirror images of each other. "
         "Each has one "
         "maximum, where its control point pulls most; a curve of degree n has n + 1 of them.",
         "--names b0 --basis", bernstein},
        {"R07", "Change of basis",
         "The same cubic has control points, end tangents, power coefficients, interpolated points, divided "
         "differences or "
         "de Boor points. Matrices lead from each to each other.",
         "--names b0", changes},
        {"R08", "Joints",
         "Where two pieces meet, the first two or three control points of the next one are bound by those of "
         "the last. "
         "A parallel tangent is enough for the eye, an equal one for motion, the A-frame for equal second "
         "derivatives.",
         "", joints},
        {"R09", "Geometric continuity",
         "Needles as long as the curvature show what the eye does not: curvature that jumps although the "
         "tangent is "
         "continuous. G2 asks for curvature alone, so that the speed may jump, which C2 forbids.",
         "", curvature_joints},
        {"R10", "Interpolation with one continuous derivative",
         "Each point becomes the joint of two cubic Bézier pieces, with a tangent parallel to the chord of "
         "its neighbours. "
         "All is local: a point that moves changes four pieces.",
         "", interpolation},
        {"R11", "Uniform B-splines",
         "With three more control points than pieces the cubic spline has two continuous derivatives at "
         "every "
         "knot. A "
         "control point used three times is interpolated, at the price of a straight piece on each side.",
         "--control --knots", uniform_splines},
        {"R12", "Non-uniform B-splines",
         "A knot of multiplicity m leaves p \u2212 m continuous derivatives, and a triple knot of a cubic "
         "interpolates a "
         "control point without straight pieces. The basis functions show it: one of them reaches 1 there.",
         "--names b0 --knots --basis", nonuniform_splines},
        {"R13", "A-frames",
         "At a joint with two continuous derivatives the prolonged legs of both polygons meet in one point. "
         "These points "
         "are the de Boor points of the spline, and lead back to all Bézier points.",
         "--names b0 --knots --a-frames", a_frames},
        {"R14", "Rational curves",
         "With weights, polynomial curves in space are projected from the origin, and conics become exact. "
         "One weight "
         "decides between ellipse, parabola and hyperbola.",
         "--control --knots", conics},
        {"R15", "De Casteljau",
         "Dividing each leg in the same ratio, again and again, leaves one point: the point of the curve. "
         "For rational "
         "curves the same is done with weighted points.",
         "--names b0 --construction 0.4", de_casteljau},
        {"R16", "Subdivision",
         "The intermediate points of de Casteljau are the control points of both halves, and their polygons "
         "soon cannot be "
         "told from the curve. For B-splines inserting a knot into every span does the same.",
         "--control --knots", subdivision},
        {"R17", "What control points tell",
         "A curve lies in the convex hull of its control points, each piece of a spline in that of its own "
         "few. No line "
         "crosses it more often than it crosses the polygon.",
         "--control --hull --box", properties},
        {"R18", "Drawing with equal steps",
         "At equal steps of the parameter a cubic costs three additions per coordinate, because third "
         "differences "
         "are constant. The roundings of these additions add up, here in proportion to the number of steps, "
         "and stay "
         "below a bound that is known beforehand.",
         "--control", forward_differences},
        {"R19", "Drawing by halving",
         "Halving until a piece is flat puts its points where the curve bends, equal steps put them "
         "everywhere. At the same "
         "number of segments the table says what each is worth.",
         "--control", halving},
        {"R20", "Arc length",
         "Equal steps of the parameter are not equal distances: the point runs faster and slower. The "
         "inverse of the arc "
         "length puts points at equal distances along the curve.",
         "--control", equal_distances},
        {"R28", "Rational surfaces",
         "Spheres, cylinders, cones and tori are rational splines, exactly; a sphere needs no irrational "
         "number, "
         "and six patches have no pole. All lines are curves of constant parameter.",
         "--control", rational_surfaces},
        {"R29", "Triangles",
         "A triangular patch of degree 3 has ten control points. Each step of de Casteljau replaces every "
         "small "
         "triangle by one point in it; the last triangle spans the tangent plane.",
         "--control", triangles},
    }};
    return kEntries;
}

}  // namespace freiform::cli::gallery
