// What the page says of each figure.
#include "gallery/gallery.hpp"

namespace freiform::cli::gallery {

std::span<const Entry> entries() {
    static constexpr std::array<Entry, 35> kEntries{{
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
        {"R21", "Bicubic patches",
         "Sixteen points are the geometry of a curve whose control points move on curves. As with curves, "
         "the "
         "same points make another patch with another matrix, and each direction may have its own.",
         "--control --isolines 7", bicubic_patches},
        {"R22", "Tensor products",
         "Any degree and any scheme of curves along one parameter goes with any along the other. The corners "
         "are interpolated where both curves do so, and three control points span the tangent plane there.",
         "--object degrees --control --isolines 7", tensor_products},
        {"R23", "De Casteljau on surfaces",
         "Bilinear interpolation of all small quadrangles, again and again, ends at the point of the "
         "surface; "
         "so do the rows first and their points as a column. The outer points of each row's scheme are the "
         "nets "
         "of the two parts.",
         "--control --isolines 3", surface_steps},
        {"R24", "Patches through points",
         "Points and tangents leave one vector free at each point: the twist. Zero is the simplest choice "
         "and "
         "makes flat spots; better ones look at the neighbours. All join with one continuous derivative.",
         "--control", interpolating_patches},
        {"R25", "Bodies of revolution and sweeps",
         "Turning a curve is exact with weights, and within a proven distance without. A frame that does not "
         "turn about its rail carries a curve along it without twisting the pipe.",
         "--object rail --control --view -62,30", revolution},
        {"R26", "Curved walls of games",
         "Quake 3 builds curved walls of patches of degree 2 by 2, whose grids share their boundary points. "
         "Read as one spline they are the same walls, and neighbours are tessellated without cracks.",
         "--control --isolines 3 --view -50,30", curved_walls},
        {"R27", "Trimming",
         "Loops of curves in the plane of the parameters say what is kept: where a half-line crosses them an "
         "odd number of times. Vertices and edges on the half-line and tangents that it touches are decided "
         "exactly.",
         "--object surface --isolines 9 --view -60,38", trimming},
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
        {"R31", "Smooth joints",
         "Reflections show how surfaces meet: stripes that break have an edge below them, stripes with kinks "
         "a jump of curvature. The first rows of the neighbour decide.",
         "--isolines 5 --control", surface_joints},
        {"R32", "Regions and strokes",
         "What is inside of one outline, of both or of exactly one is bounded by parts of their segments, "
         "and nothing is "
         "made of lines. A stroke is a region, too.",
         "--control", regions},
        {"R33", "Letters",
         "Outlines of fonts are made of lines and quadratic or cubic Bézier curves; the inner ones run the "
         "other way round. "
         "Control points of two weights are mixed for those between, and a letter is a region like any "
         "other.",
         "--control", letters},
        {"R34", "Bodies for other programs",
         "A plane profile becomes a body by turning, by lifting or by being carried along a rail. Edges are "
         "stored once "
         "and used by both of their faces, so the body is closed in every file that is written of it.",
         "--control", bodies},
        {"R35", "Gradients",
         "Colours are points, so splines mix them; what lies between depends on the space. A surface with a "
         "colour at "
         "every control point is a gradient in two directions.",
         "--control --isolines 3", gradients},
        {"R36", "Key frames and motions",
         "Between keys a value steps, runs on a line or on a cubic; an easing says how the time is spent. "
         "Along a "
         "curve a body moves by the arc length, as fast as limits allow.",
         "--control", motions},
    }};
    return kEntries;
}

}  // namespace freiform::cli::gallery
