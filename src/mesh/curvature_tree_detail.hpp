// Where a surface curves how much: a binary tree of parameter boxes, each with proven bounds of the second
// derivatives, fine where the surface needs fine triangles.
#pragma once
#include "bounds_grid_detail.hpp"
#include "chunks_detail.hpp"
#include "cone_face_detail.hpp"
#include "segments_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/face_mesh.hpp>
#include <freiform/mesh/segment_box.hpp>
#include <freiform/spline/repeated_jets.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace freiform {

// Bounds of the second derivatives (of |S_uu|, |S_uv|, |S_vv|, or of a coordinate).
struct Curvature {
    double uu = 0, uv = 0, vv = 0;
    // Of a coordinate: what S_uu and S_vv are at least, if positive; at most, if negative. 0: signs are not
    // known.
    double sure_uu = 0, sure_vv = 0;

    void include(const Curvature& o) {
        uu = std::max(uu, o.uu);
        uv = std::max(uv, o.uv);
        vv = std::max(vv, o.vv);
        sure_uu = nearer(sure_uu, o.sure_uu), sure_vv = nearer(sure_vv, o.sure_vv);
    }
    void restrict_to(const Curvature& o) {
        uu = std::min(uu, o.uu);
        uv = std::min(uv, o.uv);
        vv = std::min(vv, o.vv);
    }
    Curvature plus(double factor, const Curvature& o) const {
        return {uu + factor * o.uu, uv + factor * o.uv, vv + factor * o.vv, less(sure_uu, factor * o.uu),
                less(sure_vv, factor * o.vv)};
    }
    // Nearer to 0 by so much.
    static double less(double sure, double by) {
        return sure > 0 ? std::max(0.0, sure - by) : std::min(0.0, sure + by);
    }
    bool is_saddle() const { return (sure_uu > 0 && sure_vv < 0) || (sure_uu < 0 && sure_vv > 0); }
    // Of a saddle: the interpolation error is at most the larger of uu du^2 / 8 and vv dv^2 / 8 of these
    // (curvature_tree.cpp).
    Curvature apart() const {
        return {uu + uv * (uv / std::abs(sure_vv)), 0, vv + uv * (uv / std::abs(sure_uu))};
    }
    // Bound of the interpolation error in the halves of a box with these sides.
    double error(const Vec<2>& size) const {
        const double together = along(size[0], size[1]) / 8;
        if (!is_saddle()) return together;
        const Curvature a = apart();
        return std::min(together, std::max(a.uu * size[0] * size[0], a.vv * size[1] * size[1]) / 8);
    }
    bool is_finite() const { return std::isfinite(uu + uv + vv); }
    // Bound of |D^2 S (d, d)| for d = (du, dv).
    double along(double du, double dv) const {
        return uu * du * du + 2 * uv * std::abs(du * dv) + vv * dv * dv;
    }
    // Of two that are sure: what is sure of both.
    static double nearer(double a, double b) {
        return a > 0 && b > 0 ? std::min(a, b) : a < 0 && b < 0 ? std::max(a, b) : 0;
    }
};

// The second derivatives at one place, along the normal if there is one and it is asked for.
Curvature seen_at(const Jet<2, 2, Vec<3>>& j, bool along_normal);

// Bound of the distance between S and its linear interpolant at the corners of the triangle, on the triangle,
// from second derivatives that `c` bounds there. See the essay in curvature_tree.cpp.
double linear_interpolation_bound(const Curvature& c, const Vec<2>& a, const Vec<2>& b, const Vec<2>& d);

// A quadratic function: its second derivatives, with their signs.
struct Quadratic {
    double uu = 0, uv = 0, vv = 0;
    // Bound of the distance from its linear interpolant on the triangle, sharp but for rounding.
    double error(const std::array<Vec<2>, 3>& corner) const;
    // Of the diagonals of a box of this size the one on which it differs less from its interpolant: whether
    // that is the one from the lower corner to the upper one.
    bool prefers_rising(const Vec<2>& size) const {
        return (uu * size[0] * size[0] + vv * size[1] * size[1]) * uv <= 0;
    }
    double halves_error(const Vec<2>& size) const;  // with that diagonal
    double fan_error(const Vec<2>& size) const;     // of triangles of its sides and its centre
};
// What sum l_i l_j s_ij / 2, for barycentric coordinates l, is at most, for s_ij of the sides. `slip`: what
// they are off by.
double largest_of_sides(std::array<double, 3> s, double slip);
// Of the quadratic function with these second derivatives uu, uv, vv in space: bound of the distance from its
// linear interpolant on the triangle. `slip`: what squares of sides are off by.
double quadratic_error(const std::array<Vec<3>, 3>& second, const std::array<Vec<2>, 3>& corner, double slip);
// Hardly more than its longest side.
bool is_thin(const std::array<Vec<2>, 3>& corner);
// A half of the box.
inline std::array<Vec<2>, 3> half_of(const Box<2>& box, bool rising) {
    const Vec<2> right{{box.hi[0], box.lo[1]}};
    return rising ? std::array{box.lo, right, box.hi}
                  : std::array{right, box.hi, Vec<2>{{box.lo[0], box.hi[1]}}};
}

inline constexpr double kMostTurn = 0.5;  // sine of what normals may turn by within a box
inline constexpr double kChord = 1.06;    // chord over sine of angles with such sines

// What is known of S over a part of the plane: essay in bending.cpp, with its notation.
struct Bending {
    Curvature full;       // of S
    Curvature across;     // of n . S
    Curvature beside;     // of S less its part along n
    Vec<3> n{};           // of length 1
    double tilt = 0;      // |N - n| is at most this
    double a = 0, b = 0;  // what makes parameters lengths
    double least = 0;     // |DS d| is at least this times |(a du, b dv)|; 0: nothing is known
    // Of a box: the second derivatives of n . S in its middle, infinite if they are not known, what they are
    // off by at most, and bounds of the third ones in all of the box: uuu, uuv, uvv, vvv.
    struct Middle {
        Vec<2> at{};
        Quadratic second{kInfinity, 0, 0};
        std::array<double, 3> off{};
        std::array<double, 4> third{};
        // The same of S.
        std::array<Vec<3>, 3> whole_second{};
        std::array<double, 3> whole_off{};
        std::array<double, 4> whole_third{};
        std::array<double, 3> whole_size{};  // lengths of whole_second
    } middle = {};
    // Of a box with the function that has these second derivatives and is S at its corners, or at those of
    // the triangle that this is asked of: bounds of the rest, |S - it| and |n . (S - it)|, in all of the box.
    // Infinite where they are not known.
    struct Fit {
        Box<2> box{};
        double whole = kInfinity, along = kInfinity;
        bool of_triangle = false;
        bool exists() const { return whole < kInfinity; }
    } fit = {};

    void include(const Bending& o);
    // Of what is seen along normals that are within `turn` of some here.
    Curvature seen(double turn) const { return seen_along(tilt + turn); }
    // The same along vectors of length 1 that are within `apart` of n.
    Curvature seen_along(double apart) const;
    // Bound of the interpolation error of what is seen along normals that are within `turn` of the one below,
    // in the halves of a cell of the box that this is of.
    double seen_error(const Box<2>& cell, double turn) const;
    // The same of the halves of the cell on both sides of the better diagonal, and of one triangle in it.
    // REQUIRES knows_middle().
    // No effort is made for less than `enough`, nor where that is out of reach; 0: as small as it can be
    // said.
    double halves_error(const Box<2>& cell, double turn, double enough) const;
    double triangle_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn,
                          double enough) const;
    // Of all of the interpolation error in the triangle. REQUIRES knows_middle().
    double whole_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner) const;
    double whole_halves_error(const Box<2>& cell) const;
    // About what triangles beside a cell of this size will be said to be off by, where they are hardly more
    // than one of its sides: of all of the error or along n. REQUIRES knows_middle().
    double sides_error(const Vec<2>& cell, bool along_normal) const {
        const auto& q = middle.whole_second;
        const double u = along_normal ? std::abs(dot(n, q[0])) : norm(q[0]),
                     v = along_normal ? std::abs(dot(n, q[2])) : norm(q[2]);
        const double rest = !fit.exists() ? 0 : along_normal ? fit.along + tilt * fit.whole : fit.whole;
        return std::max(u * cell[0] * cell[0], v * cell[1] * cell[1]) / 8 + 2 * rest;
    }
    bool prefers_rising(const Vec<2>& cell) const {
        return !knows_middle() || middle.second.prefers_rising(cell);
    }
    // Of halves of cells of this size anywhere in the box, which has the size `box`, and of triangles of
    // their sides and centres. REQUIRES knows_middle().
    double cells_error(const Vec<2>& box, const Vec<2>& cell, double turn) const;
    bool knows_middle() const { return middle.second.uu < kInfinity; }

private:
    struct Rest;
    double turned(double du, double dv) const;
    Rest rest_in(const Box<2>& cell, double turn) const;
    double fit_error(const std::array<Vec<2>, 3>& corner, double turn, double most, double times,
                     double enough) const;
    double of_part(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn, double most,
                   double u, double v, double times, double enough) const;
    double steady_error(const Rest& rest, const Curvature& seen) const;
};

// Of S over the box, with bounds of |S_u| and |S_v|. `knows_normals`: false leaves all else unknown.
// `middle`: derivatives in the middle of the box.
struct BoxBending : Bending {
    double first[2] = {};
};
// What second derivatives vary by within a box where they are continuous: bounds of |S_uuu|, |S_uuv|,
// |S_uvv|, |S_vvv| and of those of n . S.
struct Variation {
    Vec<3> n{};
    std::array<double, 4> all{}, along{};
};
// Finds `variation`, too, if it is asked for. REQUIRES surface.is_twice_smooth(box) then.
BoxBending bending_of(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                      const Jet<2, 2, Vec<3>>& middle, Variation* variation = nullptr);
// The same of a spline by a quadratic function, which is S at its corners, or at those of a triangle.
struct TriangleOn {
    std::array<Vec<2>, 3> uv;
    std::array<Vec<3>, 3> at;
};
// Worth it where the box has few pieces, and is not so small that all would be rounding.
bool is_fitted(const DerivativeQuery<2, 3>& surface, const Box<2>& box);
// A box around that is not too small, if the spline goes on there.
Box<2> room_for_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box);
BoxBending bending_by_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                          const Jet<2, 2, Vec<3>>& middle, const TriangleOn* triangle = nullptr);
// The same from what is seen in the middle, by the variation over some box around.
BoxBending bending_from_middle(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                               const Jet<2, 2, Vec<3>>& middle, const Variation& variation);
inline BoxBending bending_of(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals) {
    return bending_of(surface, box, knows_normals,
                      jet<2>(surface.geometry(), {box.side(0).middle(), box.side(1).middle()}));
}

// What bends make of lengths, but for a factor of `at` alone: all that shift_of asks of those around.
inline double bend_of_lengths(const Bending& at, const Curvature& around) {
    return around.uv * (at.a * at.b) + std::max(around.uu * (at.b * at.b), around.vv * (at.a * at.a));
}
// How points of the mesh find their feet on S.
struct Shift {
    bool exists = false;
    double q = 0, far = 1, turn = 0;  // the normal turns by at most so much on the way
    // Bounds of the distance from the foot, where `seen` bounds the interpolation error along normals, and of
    // the distance from places on the way there.
    double across(double seen, double e) const;
    double left_of(double tolerance, double e) const;  // for `seen`, about
    double way(double e) const;
};
// e: bound of the whole interpolation error. `near`: bounds as far around as reach_of says; `reflected`: 3 if
// the surface ends there, else 1. `is_deep`: no side is on the boundary of the face.
Vec<2> reach_of(const Bending& at, double e);
Shift shift_of(const Bending& at, double e, const Curvature& near, double reflected, bool is_deep);

// Whether a kink adds less to the error of linear interpolation over a box with such a side than anybody
// sees: arcs written with double knots, say, which are smooth but for the digits of the file. What it adds is
// in every bound all the same (CurvatureTree::kink_bound), and triangles at it are judged by all of their
// error (bending.cpp).
bool is_rounding(const Kink& kink, double side, double tolerance);
bool kinks_are_rounding(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double tolerance);

// More than a part of the edge.
inline bool has_common_part(const Box<2>& a, const Box<2>& b) {
    return a.lo[0] < b.hi[0] && b.lo[0] < a.hi[0] && a.lo[1] < b.hi[1] && b.lo[1] < a.hi[1];
}

// The ends of the parts of an interval that is halved so many times.
std::vector<double> halved(const Interval& on, int times);

inline constexpr double kBeyond = 1.5;  // what surfaces may bend beside a leaf, times what they do within

inline constexpr int kMaxTreeDepth = 100;  // backstop: 2^-50 of the box in both directions

class CurvatureTree {
public:
    // How a tree is made: without normals triangles are judged by all of their error; blocks are leaves that
    // stand for many.
    struct Ways {
        bool knows_normals = true, blocks = false;
        std::optional<ConeFace> cone = {};  // then without normals
    };
    // Splits the box of `polygon` (closed by `segments`, pairs of indices) until a leaf inside it can be cut
    // into two triangles whose interpolation bound is at most demands.tolerance, with sides along the axes of
    // at most demands.max_edge. Boxes wholly outside by the odd-even rule are left. Refuses (limit) when more
    // than `max_leaves` are needed, (ill_conditioned) where no bound is finite.
    static Result<CurvatureTree> make(const DerivativeQuery<2, 3>& surface, std::span<const Vec<2>> polygon,
                                      std::span<const std::array<int, 2>> segments,
                                      const FaceDemands& demands, std::size_t max_leaves, Ways ways);
    static Result<CurvatureTree> make(const DerivativeQuery<2, 3>& surface, std::span<const Vec<2>> polygon,
                                      std::span<const std::array<int, 2>> segments,
                                      const FaceDemands& demands, std::size_t max_leaves) {
        return make(surface, polygon, segments, demands, max_leaves, {});
    }

    // What has been found of a leaf while it was made: bounds, for its halves by the better diagonal, of all
    // of the interpolation error, and of the distance where feet exist and all around bends at most kBeyond
    // times as much as `Bending::full` says.
    struct Proof {
        double whole = kInfinity, bound = kInfinity;
    };
    const Proof& proof_of(int leaf) const {
        static constexpr Proof kNone{};
        const int p = nodes_[std::size_t(leaf)].proof;
        return p < 0 ? kNone : proofs_[std::size_t(p)];
    }

    bool is_outside(const Box<2>& box) const;  // wholly, and known to be
    // Over the part of the tree at `place`, or nothing.
    const Variation* variation_in(int place) const {
        const int v = nodes_[std::size_t(place)].variation;
        return v < 0 ? nullptr : &variations_[std::size_t(v)];
    }
    bool knows_normals() const { return knows_normals_; }
    const std::optional<ConeFace>& cone() const { return cone_; }
    // Of the box as the tree takes it: of a cone as at its far end, all lines of which are alike.
    BoxBending bending_in(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                          const Jet<2, 2, Vec<3>>& middle, Variation* variation = nullptr) const;
    // Where the tree holds the box: the smallest part of it that contains the box, or all of it. Boxes near
    // the one that was asked for before are found from there, others from 0.
    int place_of(const Box<2>& box, int near = 0) const;
    // Of all of the part of the tree at `place`; nothing if the box is not in it, or some of it is not known.
    const Curvature* all_in(int place, const Box<2>& box) const;
    // Of the whole box and some places beside it; nothing if that is not known without a walk.
    std::optional<Curvature> about(const Box<2>& box) const {
        const auto found = grid_.over(box);
        if (!found || !((*found)[0] < kInfinity)) return std::nullopt;
        return Curvature{(*found)[0], (*found)[1], (*found)[2]};
    }
    // Over the part of the box that is not wholly outside the polygon. `place`: of the box.
    Bending over(const Box<2>& box, int place) const;
    // Of the whole box; nothing if some of it is not in the tree.
    std::optional<Curvature> all_over(const Box<2>& box, int place) const;
    // Whether shifts are not wanted, or save nothing.
    bool is_all_plain() const { return !knows_normals_; }
    bool meets_kink(const Box<2>& box) const;  // its edge included
    // What kinks of the surface inside the box add to the interpolation bound.
    double kink_bound(const Box<2>& box) const;
    // The kink that adds most, if any: its axis and parameter.
    std::optional<std::pair<int, double>> worst_kink(const Box<2>& box) const;

    struct Corner {
        Vec<2> at{}, leaf{};  // leaf: side lengths of a leaf that has it
    };
    using Halves = std::array<std::uint8_t, 2>;  // how often each side is halved
    // A leaf that is to be cut into cells, which by the bounds of their part are as fine as leaves. Nothing
    // of it or of its border is outside the polygon or on its segments.
    struct Block {
        Box<2> box;
        Halves halves{}, parts{};  // into cells, and into parts of some cells
        int first_part = 0;        // -1: a leaf that is one cell
        int node = 0;
    };
    // First those of more than one cell.
    std::size_t block_count() const { return blocks_.size() + block_leaves_.size(); }
    std::size_t many_cells_count() const { return blocks_.size(); }
    Block block(std::size_t i) const {
        if (i < blocks_.size()) return blocks_[i];
        const int leaf = block_leaves_[i - blocks_.size()];
        return {nodes_[std::size_t(leaf)].box, {}, {}, -1, leaf};
    }
    // Of its parts, row by row.
    std::span<const Bending> part_bendings(const Block& b) const {
        if (b.first_part < 0) return {&bending(nodes_[std::size_t(b.node)]), 1};
        return std::span(part_bendings_)
            .subspan(std::size_t(b.first_part), std::size_t(1) << (b.parts[0] + b.parts[1]));
    }

    // Corners of the leaves that are not outside and not blocks, each once, neighbours near each other in the
    // list.
    std::span<const Corner> corners() const { return corners_; }
    // Mean side lengths of all leaves that are not outside, and of the cells of blocks.
    Vec<2> mean_leaf() const;

private:
    class Grower;
    struct Node {  // small: walks pass many of them
        Box<2> box;
        int parent = 0;
        int child = -1;      // the first of two neighbours in nodes_; -1: a leaf
        int variation = -1;  // over it, in variations_
        int block = -1;      // in blocks_; kOneCell: in block_leaves_
        int slot = -1;       // of a leaf in bendings_, of others in sums_
        int proof = -1;      // of a leaf, in proofs_
        bool outside = false;
        bool inside = false;  // known to be so while it was made, with its border
        bool whole = false;   // nothing of it is outside
        bool flat = false;    // fine without a shift
        // Along each axis the first of the columns of all that it has, and the one after the last.
        std::array<std::array<std::uint8_t, 2>, 2> columns{{{0, 1}, {0, 1}}};
        bool is_block() const { return block != -1; }
        bool has_columns() const {
            return columns[0][1] - columns[0][0] > 1 || columns[1][1] - columns[1][0] > 1;
        }
    };
    struct Cut {
        int axis;
        double at;
        int column = 0;  // that begins there, if it is not 0
    };
    // Whether the two triangles of a box of this size, or of this box, keep the tolerance, without a shift or
    // with one, which kinks do not allow.
    bool keeps(const Bending& b, const Vec<2>& size, bool kinks, double error, double tolerance) const;
    bool keeps(const Bending& b, const Box<2>& cell, bool kinks, double error, double tolerance,
               Proof& proof) const;
    bool keeps_in_cells(const Bending& b, const Vec<2>& box, const Vec<2>& cell, double tolerance) const;
    bool accept(Node& node, const Bending& known, double error, double tolerance, Proof& proof) const;
    std::optional<Refusal> torn_place(const DerivativeQuery<2, 3>& surface, std::span<const Vec<2>> polygon,
                                      std::span<const std::array<int, 2>> segments, double tolerance) const;
    // curvature_tree_blocks.cpp
    Curvature matters_of(const Bending& part) const;
    double cells_seen(RepeatedJets& jets, const Box<2>& box, const Jet<2, 2, Vec<3>>& middle,
                      double tolerance) const;
    bool make_block(const DerivativeQuery<2, 3>& surface, int node, const Jet<2, 2, Vec<3>>& middle,
                    double cells, double tolerance, BoxBending& known);
    bool add_parts(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const Halves& halves,
                   const BoxBending& all, const Variation* varies, double most, double tolerance,
                   Curvature& together);
    const Bending& bending(const Node& leaf) const { return bendings_[std::size_t(leaf.slot)]; }
    const Curvature& full(const Node& n) const {
        return n.child < 0 ? bending(n).full : sums_[std::size_t(n.slot)];
    }
    std::optional<Cut> cut(const Node& node, int axis) const;
    void plan_columns(const DerivativeQuery<2, 3>& surface, double tolerance);  // curvature_tree_columns.cpp
    // Those away from the boundary, as blocks; fills the grid. `is_shared`: all threads may be used.
    void take_leaves(std::span<const Vec<2>> polygon, std::span<const std::array<int, 2>> segments,
                     bool is_shared);
    class Border;
    bool is_deep(int leaf, const Border* border) const;
    void reserve(std::size_t nodes);  // before there are any
    // Of the first `end` nodes, whose children are there: what holds for both children. Whether all of these
    // leaves are flat, so that the tree can do without normals.
    bool sum_up(std::size_t end);
    void find_corners();
    void plan_grid();
    void fill_grid(int group, int groups);  // of its cells
    bool varies(const DerivativeQuery<2, 3>& surface, const Box<2>& box) const;
    Curvature seen_in(const Jet<2, 2, Vec<3>>& middle) const;
    bool is_sharp() const { return !sharp_[0].empty() || !sharp_[1].empty(); }
    bool is_sharp_inside(const Box<2>& box) const;
    const PolygonRows* rows_ = nullptr;  // of the polygon, while it is made
    static constexpr int kOneCell = -2;
    Segments<Node> nodes_;
    Chunks<Bending> bendings_;  // of leaves that are not outside; neighbours may share one
    Chunks<Proof, 512> proofs_;
    Segments<Curvature> sums_;  // of S over other nodes
    std::vector<Variation> variations_;
    std::vector<Corner> corners_;
    std::vector<Block> blocks_;
    std::vector<int> block_leaves_;
    std::vector<Bending> part_bendings_;
    bool knows_normals_ = true;
    BoundsGrid grid_;  // of S, infinite where some is outside; and 1 where some is not known to be inside
    std::optional<ConeFace> cone_;
    std::array<std::vector<Kink>, 2> kinks_;
    std::array<std::vector<double>, 2> sharp_;    // where kinks are that are more than rounding
    std::array<std::vector<double>, 2> columns_;  // where they begin and end; none where there is one
};

}  // namespace freiform
