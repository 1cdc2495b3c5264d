// Faces as flat parts within proven distances, cut finer where a caller wants it.
#pragma once
#include "face_region_detail.hpp"

#include <freiform/mesh/triangle_tree.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

namespace freiform {

// A box of the parameter plane and the surface over it: within `error` of the two triangles (0, 1, 3) and
// (0, 3, 2) through its corners.
//
//     2 --- 3
//     |   / |    u to the right, v up
//     0 --- 1
struct FacePart {
    Box<2> box;
    std::array<Vec<3>, 4> corner;
    double error = 0;       // bound, rounding included; may be infinite
    double hull_error = 0;  // likewise, of how far it leaves the hull of the corners
    double rounding = 0;    // bound: of the corners
    double size = 0;        // bound: of the longest side in space, and how far a place is from some corner
    bool crossing = false;  // the boundary may run through it; else it is wholly inside the face
    std::vector<int> near;  // chords of the region that meet it
    int halvings = 0;       // that made it of the whole
    // On which sides of the strip of these chords there is face, 1 (left) + 2 (right); -1: nobody has asked
    // yet.
    int sides = -1;
    double key = 0;  // for the caller

    // Bound: of how far it leaves the hull of the corners.
    double beside_corners() const { return std::min(hull_error, size + rounding); }
    // Whether it had better be cut where it bends than where it is long. Of what the boundary runs through,
    // by turns: however flat, it may have its nearest place outside of the face until it is short.
    bool may_be_long() const { return !crossing || halvings % 2 == 0; }

    std::array<Triangle3, 2> triangles() const {
        return {{{corner[0], corner[1], corner[3]}, {corner[0], corner[3], corner[2]}}};
    }
};

// A triangle of a part without what is beyond the boundary: convex, with these corners. Two cuts leave 5 of
// them, 6 where roundings disagree.
struct ClippedTriangle {
    std::array<Vec<3>, 6> corner;
    int size = 0;
    void add(const Vec<3>& p) { corner[std::size_t(size++)] = p; }
    std::span<const Vec<3>> corners() const { return {corner.data(), std::size_t(size)}; }
};

class FaceParts {
public:
    static Result<FaceParts> make(const Face& face, const std::vector<Edge>& edges, double accuracy);

    // All of the face as one part; nothing if the face is empty.
    std::optional<FacePart> whole() const;
    // The parts of its two halves that are not outside; none where the box cannot be halved. Across the
    // longer side in space, or (`by_bend`) the side along which the surface bends more.
    std::vector<FacePart> halves(const FacePart& part, bool by_bend = false) const;
    // What the face may be near, within part.error, of the two triangles of a part; all of them where many
    // chords run through it. Sets part.sides.
    std::array<ClippedTriangle, 2> clipped(FacePart& part) const;
    // About how far these go beyond the face.
    double overhang(FacePart& part) const;
    // False: the distance from q has no critical point on the part, proven, so that its least value over the
    // face is on the boundary of the face or elsewhere.
    bool may_have_foot(const FacePart& part, const Vec<3>& q) const;
    // False: n . x has no critical point on the part, proven; n of length 1.
    bool may_be_level(const FacePart& part, const Vec<3>& n) const;
    // True: the point of the part's box is on the face, proven.
    bool holds(const FacePart& part, const Vec<2>& uv) const;
    Vec<3> value(const Vec<2>& uv) const { return jet<0>(face_->surface, uv.c).value(); }
    const FaceRegion& region() const { return region_; }
    const DerivativeQuery<2, 3>& surface() const { return *surface_; }

private:
    FaceParts(const Face& face, FaceRegion region)
        : face_(&face),
          surface_(std::make_unique<DerivativeQuery<2, 3>>(face.surface)),
          region_(std::move(region)) {}
    // `of`: the part that it is a part of.
    std::optional<FacePart> part_over(const Box<2>& box, const std::vector<int>& near,
                                      const FacePart* of) const;
    bool is_inside(const FacePart& part, const FacePart* of) const;
    // Chords as a strip that their curves are in: left of it is where cross(along, x - from) > width. The
    // same for all parts that they run through.
    struct Strip {
        Vec<2> from, along;
        double width;
    };
    Strip strip_of(const std::vector<int>& chords) const;
    // The strip of the part's chords, if they are not many; sets part.sides.
    std::optional<Strip> cut_by(FacePart& part) const;

    const Face* face_;
    std::unique_ptr<DerivativeQuery<2, 3>> surface_;
    FaceRegion region_;
};

}  // namespace freiform
