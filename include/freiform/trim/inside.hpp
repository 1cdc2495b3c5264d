// Is a point inside a region bounded by closed loops of curves? Answered right, not almost always right:
// points on vertices, on edges, at touching tangents and beside them by the last bit included.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/spline/geometry.hpp>

#include <span>
#include <vector>

namespace freiform {

enum class Place { outside, inside, boundary };

struct Inside {
    Place place = Place::outside;  // by the odd-even rule
    int winding = 0;  // times that the loops go round the point, counter-clockwise; 0 on the boundary
    friend bool operator==(const Inside&, const Inside&) = default;
};

// Prepared once from loops, asked for many points; const and safe to share between threads.
//
// A loop is a chain of splines, the end of each at the start of the next, the last at the first; or one
// ellipse. Gaps of at most `gap` (a distance), and such as rounding alone leaves between ends with weights or
// without clamped knots, are closed by segments, which belong to the boundary. The
// splines are taken as their Bezier pieces: exact where inner knots have the multiplicity of the degree (as
// polygons and Bezier chains do); elsewhere their pieces are the spline up to the rounding of knot insertion,
// and the answer is exact for them.
//   auto query = InsideQuery::make(loops, 0);   // query->at({0.3, 0.4}).place == Place::inside
class InsideQuery {
public:
    // Refuses, with loops[i][j]: loops without curves, curves without ends (lines, parabolas, hyperbolas, and
    // an ellipse among others), gaps above `gap` (the message says how large), numbers that are not finite.
    static Result<InsideQuery> make(std::span<const std::vector<CurveGeometry<2>>> loops, double gap);

    // A point that is not finite is outside. Cost: two comparisons for each Bezier piece whose box it is not
    // in, see arc_index.hpp for the others.
    Inside at(const Vec<2>& q) const;
    // Of many, on several threads. REQUIRES out.size() == points.size().
    void at(std::span<const Vec<2>> points, std::span<Inside> out) const;

private:
    struct Arc {
        Box<2> box;
        int first = 0, size = 0;  // coefficients in x_, y_, w_
        bool rational = false;
    };
    struct Ellipse {
        Vec<2> centre, x, y;
    };
    void add_arc(std::span<const Vec<2>> net);
    void add_arc(std::span<const Hom<2>> net);

    std::vector<double> x_, y_, w_;
    std::vector<Arc> arcs_;
    std::vector<Ellipse> ellipses_;
};

}  // namespace freiform
