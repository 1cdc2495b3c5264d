// Faces as flat parts within proven distances, cut finer where a caller wants it.
#pragma once
#include "face_region_detail.hpp"

#include <freiform/mesh/triangle_tree.hpp>

#include <algorithm>
#include <memory>

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
    double key = 0;         // for the caller

    // Bound: of how far it leaves the hull of the corners.
    double beside_corners() const { return std::min(hull_error, size + rounding); }
    // Whether it had better be cut where it bends than where it is long. Of what the boundary runs through,
    // by turns: however flat, it may have its nearest place outside of the face until it is short.
    bool may_be_long() const { return !crossing || halvings % 2 == 0; }

    std::array<Triangle3, 2> triangles() const {
        return {{{corner[0], corner[1], corner[3]}, {corner[0], corner[3], corner[2]}}};
    }
};

class FaceParts {
public:
    static Result<FaceParts> make(const Face& face, const std::vector<Edge>& edges, double accuracy);

    // All of the face as one part; nothing if the face is empty.
    std::optional<FacePart> whole() const;
    // The parts of its two halves that are not outside; none where the box cannot be halved. Across the
    // longer side in space, or (`by_bend`) the side along which the surface bends more.
    std::vector<FacePart> halves(const FacePart& part, bool by_bend = false) const;
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
    std::optional<FacePart> part_over(const Box<2>& box, const std::vector<int>& near,
                                      bool known_inside) const;

    const Face* face_;
    std::unique_ptr<DerivativeQuery<2, 3>> surface_;
    FaceRegion region_;
};

}  // namespace freiform
