// Inner points of a face: placed where a proof asks for them.
#pragma once
#include "judge_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>
#include <freiform/mesh/triangulate.hpp>

#include <functional>
#include <limits>
#include <optional>

namespace freiform {

class Filler {
public:
    Filler(Triangulation& t, const CurvatureTree& tree, const Judge& judge,
           const DerivativeQuery<2, 3>& surface, Vec<2> scale, const FaceDemands& demands);

    // Vertices [first, first + so many) have triangles beyond the region: those marked count on their foot,
    // those that are `plain` have none.
    void keep_feet(int first, std::span<const char> marked, std::span<const char> plain);
    // A vertex would have to do without a foot that other triangles count on: nothing more was tried.
    bool is_stuck() const { return !stuck_at_.empty(); }
    // Those vertices.
    std::span<const Vec<2>> stuck_at() const { return stuck_at_; }

    void insert_corners(std::span<const CurvatureTree::Corner> corners);
    // False when more than `max_points` are needed, or it is stuck.
    bool refine(std::size_t max_points);
    // Of the interpolation error of the triangle; computed once for each.
    double bound(int triangle);
    // Inserts the middles of inner edges that more than two triangles have once corners with the same `place`
    // are one, and of the longest sides of triangles without area there. The number of points inserted.
    int separate(std::span<const int> place);
    Vec<2> uv(int vertex) const { return unscaled(t_.points()[std::size_t(vertex)]); }

private:
    Vec<2> unscaled(const Vec<2>& x) const { return {{x[0] / scale_[0], x[1] / scale_[1]}}; }
    Vec<2> scaled(const Vec<2>& x) const { return {{x[0] * scale_[0], x[1] * scale_[1]}}; }
    bool is_near_boundary(int triangle, const Vec<2>& x, const Vec<2>& leaf) const;
    bool improve(int triangle);
    bool has_no_width(const Vec<2> (&corner)[3]) const;
    bool halve(int v, int w);
    std::vector<std::array<int, 2>> flat_sides(std::span<const int> place,
                                               std::span<const int> corners_at) const;
    bool is_fine(int triangle);
    Vec<3> position(int vertex);  // is kept
    Vec<3> looked_up(int vertex) const;
    struct LongestSide {
        double longest = 0;
        int edge = -1;  // the longest but for the boundary; -1 if a side of that is clearly longer
    };
    LongestSide longest_of_all(int triangle);
    bool is_narrow_or_at_pole(const std::array<Vec<2>, 3>& corner, double longest) const;
    // The side to cut where normals turn too much.
    int turning_side(int triangle);
    // The longest side that is not part of the boundary, in space; its edge is -1 if there is none.
    std::pair<double, int> longest_side(int triangle);

    // What was found about the triangle with this index when it had this stamp.
    struct Known : Judgement {
        std::uint32_t stamp = 0;
        bool any = false;
    };
    struct Entry {
        int triangle;
        std::uint32_t stamp;
    };
    bool is_known(int triangle) const {
        const std::size_t i = std::size_t(triangle);
        return i < known_.size() && known_[i].any && known_[i].stamp == t_.stamp(triangle);
    }
    void judge(std::span<const Entry> entries);
    const Known& known(int triangle);
    using Positions = std::function<Vec<3>(int vertex)>;
    // `place`: in the tree, where to begin, and where it is.
    Known found(int triangle, int& place, const Positions& position_of) const;

    Triangulation& t_;
    std::vector<Known> known_;
    bool is_plain(int vertex) const;
    bool note_kept(int triangle);
    bool note_sliver(int triangle, std::vector<Vec<2>>& at) const;
    // Makes all corners plain; false if they are.
    bool make_plain(int triangle, std::vector<int>& judge_again);
    bool has_kept_foot(int vertex) const {
        return vertex >= first_kept_ && vertex - first_kept_ < int(kept_.size()) &&
               kept_[std::size_t(vertex - first_kept_)];
    }
    const CurvatureTree& tree_;
    const Judge& judge_;
    const DerivativeQuery<2, 3>& surface_;
    Vec<2> scale_, least_{};  // least_: what counts as a length at all
    FaceDemands demands_;
    double angle_floor_ = 0;
    int place_ = 0;  // in the tree, of the triangle that was last judged
    std::size_t most_for_angles_ = 0;
    int first_kept_ = std::numeric_limits<int>::max();
    std::vector<char> kept_;
    std::vector<Vec<2>> stuck_at_;
    std::vector<char> plain_;                       // of vertices, as far as one is
    std::vector<std::optional<Vec<3>>> positions_;  // of vertices, as far as they have been asked for
};

}  // namespace freiform
