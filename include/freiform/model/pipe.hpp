// Pipes along lines and arcs of circles, exact: cylinders and tori between circles.
#pragma once
#include <freiform/model/model.hpp>

#include <span>

namespace freiform {

// A part of a line or of a circle, run through from on.lo to on.hi, or back.
struct RailPart {
    CurveGeometry<3> curve;
    Interval on;
    bool reversed = false;
};

bool is_line_or_circle(const CurveGeometry<3>& curve);

// The solid that a disc sweeps whose centre moves along the parts, one after the other, and which stays
// across them; with a `hole`, the radius of another disc, what lies between the two. Watertight by its
// construction: walls share the circles at joints. A rail that ends where it begins makes a ring, the hole of
// which is a void. At joints ends may be apart, and directions turn, by so much that circles there are no
// more than `joint` apart, or by roundings; tolerances of edges say by how much they are.
//   auto bend = pipe(*bent_polyline(corners, 2), 0.5, 0.4);
// Refuses radii that are not positive or hardly differ from that of the hole, parts of other curves and arcs
// of no more than `radius` (unsupported), corners and gaps (invalid, where: rail[i]), and rings on which the
// disc comes back turned, as along rails that twist in space (unsupported). Whether far parts of the pipe
// meet is not asked.
Result<Model> pipe(std::span<const RailPart> rail, double radius, double hole = 0, double joint = 0);

// The polyline with every corner rounded by an arc of the radius `bend`; closed: the last corner is joined to
// the first. Corners between parts of one line need none. Refuses fewer than two corners (closed: three),
// those that follow at the same place or turn back (invalid, where: corners[i]), and arcs that are longer
// than the sides beside them (no_answer).
Result<std::vector<RailPart>> bent_polyline(std::span<const Vec<3>> corners, double bend,
                                            bool closed = false);

}  // namespace freiform
