// The part of the parameter plane that a face is: its boundary as chords, each with a proven bound of how far
// the parameter curve leaves it. For measuring; meshes are made from polygons of their own (edge_mesh.cpp).
#pragma once
#include <freiform/mesh/segment_box.hpp>
#include <freiform/model/model.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>
#include <functional>
#include <vector>

namespace freiform {

class FaceRegion {
public:
    // How many times too much it is that a parameter curve leaves its chord by `sag` (in u and in v); both
    // are in the box.
    using TooMuch = std::function<double(const Box<2>& box, const Vec<2>& sag)>;
    // Each parameter curve is halved where that is the most, until it is at most 1 everywhere or there are
    // `max_chords`. Without loops: the rectangle of the surface's domain. Refuses (invalid) domains that are
    // not bounded, (ill_conditioned) curves without a finite bound.
    static Result<FaceRegion> make(const Face& face, const std::vector<Edge>& edges, const TooMuch& too_much,
                                   std::size_t max_chords);
    // Of one chord for each smooth piece of each curve.
    static Result<FaceRegion> rough(const Face& face, const std::vector<Edge>& edges);

    // Contains the face.
    const Box<2>& box() const { return box_; }
    std::size_t size() const { return segments_.size(); }
    // Does the box meet chord i or what its curve may reach? Conservative.
    bool meets(const Box<2>& box, std::size_t i) const;
    std::array<Vec<2>, 2> chord(std::size_t i) const {
        return {points_[std::size_t(segments_[i][0])], points_[std::size_t(segments_[i][1])]};
    }
    // Bound: how far the curve leaves chord i, in u and in v.
    const Vec<2>& sag(std::size_t i) const { return sags_[i]; }
    // Odd-even rule. REQUIRES a point in a box that meets nothing.
    bool is_inside(const Vec<2>& x) const { return rows_.is_inside(x); }
    // Points of the face's boundary.
    const std::vector<Vec<2>>& points() const { return points_; }

private:
    FaceRegion ready();  // all are there
    void add(const Vec<2>& from, const Vec<2>& to, const Vec<2>& sag);

    std::vector<Vec<2>> points_;
    std::vector<std::array<int, 2>> segments_;
    std::vector<Vec<2>> sags_;
    PolygonRows rows_;
    Box<2> box_;
};

}  // namespace freiform
