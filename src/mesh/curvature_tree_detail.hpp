// Where a surface curves how much: a binary tree of parameter boxes, each with proven bounds of the second
// derivatives, fine where the surface needs fine triangles.
#pragma once
#include "bounds_grid_detail.hpp"
#include "chunks_detail.hpp"
#include "cone_face_detail.hpp"
#include "curvature_detail.hpp"
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
