// What triangles hide from an eye that is infinitely far away, exactly along segments and not at samples.
#pragma once
#include <freiform/core/interval.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

// Coordinates are those of the picture: x to the right, y up, z towards the eye.
class Occluders {
public:
    // A point is hidden if, in the picture, it lies in a triangle, and behind that triangle's plane by more
    // than `tolerance`: a distance in space, so that a curve on one of the triangles, or within the tolerance
    // of them, is not hidden by those it runs on, however obliquely they are seen. Triangles that are seen
    // edge on, and those without area, hide nothing. O(n log n).
    Occluders(std::vector<std::array<Vec<3>, 3>> triangles, double tolerance);

    // The t in [0, 1] for which from + t (to - from) is hidden, disjoint and in order; about O(log n + k) for
    // k triangles nearby. What rounding moves the ends by is of the size of the rounding of coordinates.
    std::vector<Interval> hidden(const Vec<3>& from, const Vec<3>& to) const;

    double tolerance() const { return tolerance_; }

private:
    struct Node {
        Box<3> box;
        int begin = 0, end = 0;  // of a leaf: triangles
        int left = -1;           // else the children `left` and `left` + 1
    };
    void build();

    std::vector<std::array<Vec<3>, 3>> triangles_;  // counter-clockwise in the picture
    std::vector<Node> nodes_;
    double tolerance_ = 0;
};

// A part of a polyline that is all hidden or all visible.
struct SeenPart {
    bool hidden = false;
    std::vector<Vec<3>> points;
};

// The polyline cut where it becomes hidden or visible. Parts that are shorter in the picture than the
// tolerance count to their neighbours: rounding leaves such where triangles meet.
std::vector<SeenPart> seen_parts(const Occluders& occluders, std::span<const Vec<3>> polyline);

}  // namespace freiform
