// Method. The sides of blocks and of leaves come from halving intervals, and each interval has one place
// where it is cut, so of the points that two neighbours have on their common side those of the coarser are
// among those of the finer. A side gets all points that anybody has there, found by halving its steps as long
// as the middle is one. Cells become halves, by the better diagonal, and with more points than corners fans
// from their corner inside. Every triangle is within its cell, whose bound it keeps: half the squared radius
// of the smallest circle around it is no more than that of half the cell (curvature_tree.cpp). Where a bound
// is one of halves alone, cells with more points are cut from their centre (block_triangles.cpp). What two
// blocks have on both sides is no outline.
//
// Blocks of one cell, the leaves, get the best shaped triangles among the points of their sides
// (leaf_triangles.cpp). Where feet cannot be proven (bending.cpp), all points of a leaf are plain, if all of
// its error is small enough. Their neighbours have plain points then; those that can do without these feet,
// do, others become plain in turn or are left to the triangulation. So are blocks near places to avoid: where
// triangles around them turned out to need plain points that a block counts on.
#include "block_triangles_detail.hpp"
#include "blocks_detail.hpp"
#include "outer_sides_detail.hpp"
#include "parameter_table_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kBlocksAtOnce = 64;  // that a thread judges
constexpr double kMarginOfAvoided = 2;     // times the box
constexpr int kPlainRounds = 8;            // then leaves that disagree are left to the triangulation

class BlockMesher {
public:
    BlockMesher(const CurvatureTree& tree, const Judge& judge, double tolerance, bool is_shared,
                std::span<const Vec<2>> avoid)
        : tree_(tree),
          judge_(judge),
          tolerance_(tolerance),
          is_shared_(is_shared),
          avoid_(avoid),
          table_(tree.corners().size() + tree.block_count()) {}

    BlockMesh run(const BesideBlocks& beside) {
        outline_.corners.assign(tree_.corners().begin(), tree_.corners().end());
        parallel_for(2, is_shared_ ? 1 : 2, [&](std::size_t k) {
            if (k == 1) return beside.before();
            judge_all();
            take_all();
            if (!blocks_.empty() || !leaves_.empty()) find_outline();
        });
        parallel_for(2, is_shared_ ? 1 : 2,
                     [&](std::size_t k) { k == 0 ? fill() : beside.around(outline_); });
        out_.outline = std::move(outline_);
        return std::move(out_);
    }

private:
    void find_outline() {
        for (const auto& c : outline_.corners) table_.number(c.at);
        for (const Block& b : blocks_) b.grid.each_border_point([&](const Vec<2>& p) { table_.number(p); });
        find_sides();
        plain_.assign(table_.size(), 0);
        if (!tree_.is_all_plain()) settle_feet();
        number_outline();
    }

    void fill() {
        for (const Leaf& l : leaves_) out_.bound = std::max(out_.bound, bound_of(l));
        number_others();
        for (const Block& b : blocks_) mesh(b);
        mesh_leaves();
    }

    using Block = MeshedBlock;
    using Leaf = MeshedLeaf;
    const JudgedBlock& judged(const Leaf& l) const { return judged_[l.block]; }
    Box<2> box_of(const Leaf& l) const { return tree_.block(l.block).box; }
    bool needs_foot(const Leaf& l) const { return !l.is_plain && !std::isfinite(judged(l).footless); }
    double bound_of(const Leaf& l) const {
        const double footless = judged(l).footless;
        return l.is_plain ? l.flat : std::max(l.bound, std::isfinite(footless) ? footless : 0);
    }

    static Vec<2> corner_of(const Box<2>& b, std::size_t k) {
        return {{k == 1 || k == 2 ? b.hi[0] : b.lo[0], k >= 2 ? b.hi[1] : b.lo[1]}};
    }

    bool is_near_avoided(const Box<2>& box) const {
        const Vec<2> margin = kMarginOfAvoided * (box.hi - box.lo);
        const Box<2> around{box.lo - margin, box.hi + margin};
        return std::any_of(avoid_.begin(), avoid_.end(), [&](const Vec<2>& p) { return around.contains(p); });
    }

    // While one thread numbers the corners of leaves.
    void judge_all() {
        const std::size_t all = tree_.block_count(), parts = (all + kBlocksAtOnce - 1) / kBlocksAtOnce;
        judged_.resize(all);
        parallel_for(1 + parts, is_shared_ ? 1 : 1 + parts, [&](std::size_t part) {
            if (part == 0) return list_leaves();
            for (std::size_t i = (part - 1) * kBlocksAtOnce, end = std::min(all, part * kBlocksAtOnce);
                 i < end; ++i) {
                const auto block = tree_.block(i);
                if (!is_near_avoided(block.box)) judged_[i] = judged_block(tree_, judge_, tolerance_, block);
            }
        });
    }

    void list_leaves() {
        for (const auto& c : tree_.corners()) table_.number(c.at);
        leaves_.reserve(tree_.block_count());
        for (std::size_t i = tree_.many_cells_count(); i < tree_.block_count(); ++i) {
            const auto block = tree_.block(i);
            Leaf& l = leaves_.emplace_back(Leaf{std::uint32_t(i)});
            for (std::size_t k = 0; k < 4; ++k) l.corner[k] = table_.number(corner_of(block.box, k));
        }
    }

    void take_all() {
        for (std::size_t i = 0; i < tree_.many_cells_count(); ++i) take(tree_.block(i), judged_[i]);
        std::erase_if(leaves_, [&](Leaf& l) {
            const JudgedBlock& j = judged(l);
            l.is_plain = !std::isfinite(j.halves);
            const bool bad = l.is_plain && !std::isfinite(std::min(j.flat, j.flat_halves));
            if (bad) dissolve(box_of(l));
            return bad;
        });
    }

    void dissolve(const Box<2>& leaf) {
        for (std::size_t k = 0; k < 4; ++k)
            outline_.corners.push_back({corner_of(leaf, k), leaf.hi - leaf.lo});
    }

    void take(const CurvatureTree::Block& b, const JudgedBlock& j) {
        const BlockGrid grid(b.box, b.halves);
        const Vec<2> cell = kCellRounding * grid.largest_cell();
        const bool may_be_any = std::isfinite(j.usual), needs_foot = !std::isfinite(j.footless);
        if (!may_be_any && !std::isfinite(j.halves)) return dissolve(grid, cell);
        out_.bound = std::max({out_.bound, may_be_any ? j.usual : j.halves, needs_foot ? 0 : j.footless});
        CellWays ways;
        for (const Bending& part : tree_.part_bendings(b)) ways.rising.push_back(part.prefers_rising(cell));
        for (std::size_t d = 0; d < 2; ++d) ways.part[d] = std::uint8_t(b.halves[d] - b.parts[d]);
        ways.parts_in_row = 1 << b.parts[1];
        ways.from_centre = !may_be_any;
        blocks_.push_back({grid, b, std::move(ways), needs_foot});
    }

    void dissolve(const BlockGrid& grid, const Vec<2>& cell) {
        for (int i = 0; i <= grid.cells(0); ++i)
            for (int j = 0; j <= grid.cells(1); ++j) outline_.corners.push_back({grid.at(i, j), cell});
    }

    // Points of anybody between two that are neighbours on a line along the axis, in order.
    void add_between(const Vec<2>& a, const Vec<2>& b, int axis, std::vector<int>& out) const {
        Vec<2> m = a;
        m[axis] = Interval{std::min(a[axis], b[axis]), std::max(a[axis], b[axis])}.middle();
        const int number = table_.find(m);
        if (number < 0 || m == a || m == b) return;
        add_between(a, m, axis, out);
        out.push_back(number);
        add_between(m, b, axis, out);
    }

    BlockTriangles triangles_of() const { return {tree_, judge_, tolerance_, table_.points()}; }

    void find_sides() {
        const BlockTriangles triangles = triangles_of();
        for (Block& block : blocks_) {
            std::vector<Vec<2>> own;
            block.grid.each_border_point([&](const Vec<2>& p) { own.push_back(p); });
            for (std::size_t k = 0; k < own.size(); ++k) {
                const Vec<2>&a = own[k], &b = own[(k + 1) % own.size()];
                block.step.push_back(int(block.border.size()));
                block.border.push_back(table_.find(a));
                add_between(a, b, a[0] == b[0] ? 1 : 0, block.border);
            }
            block.step.push_back(int(block.border.size()));
        }
        std::erase_if(blocks_, [&](const Block& b) {
            const double bound = b.ways.from_centre ? triangles.bound_from_centres(b) : 0;
            const bool bad = !std::isfinite(bound);
            if (bad) dissolve(b.grid, b.grid.largest_cell());
            if (!bad) out_.bound = std::max(out_.bound, bound);
            return bad;
        });
        find_borders();
        // What is found of sides meanwhile holds but for leaves that have to go.
        const std::size_t parts = borders_.size();
        parallel_for(1 + parts, is_shared_ ? 1 : 1 + parts, [&](std::size_t part) {
            if (part == 0) return add_sides();
            BlockTriangles::Work work;
            for (std::size_t i = (part - 1) * kBlocksAtOnce,
                             end = std::min(leaves_.size(), part * kBlocksAtOnce);
                 i < end; ++i)
                triangles.settle(leaves_[i], judged(leaves_[i]), work);
        });
        std::erase_if(leaves_, [&](const Leaf& l) {
            const bool bad = !std::isfinite(bound_of(l));
            if (bad) dissolve(box_of(l)), sides_.remove(border_of(l));
            return bad;
        });
    }

    // Of leaves. Those with too many points are left out.
    void find_borders() {
        borders_.resize((leaves_.size() + kBlocksAtOnce - 1) / kBlocksAtOnce);  // of some leaves at a time
        parallel_for(borders_.size(), is_shared_ ? 1 : borders_.size(), [&](std::size_t part) {
            std::vector<int>& border = borders_[part];
            border.reserve(6 * kBlocksAtOnce);
            const std::size_t first = part * kBlocksAtOnce,
                              end = std::min(leaves_.size(), first + kBlocksAtOnce);
            std::array<std::size_t, kBlocksAtOnce + 1> begins{};
            for (std::size_t i = first; i < end; ++i) {
                const Box<2> box = box_of(leaves_[i]);
                for (std::size_t k = 0; k < 4; ++k) {
                    border.push_back(leaves_[i].corner[k]);
                    add_between(corner_of(box, k), corner_of(box, (k + 1) % 4), k % 2 ? 1 : 0, border);
                }
                begins[i - first + 1] = border.size();
            }
            for (std::size_t i = first; i < end; ++i) {
                leaves_[i].border = border.data() + begins[i - first];
                const std::size_t count = begins[i - first + 1] - begins[i - first];
                leaves_[i].count = std::uint16_t(std::min(count, kMostAround + 1));
            }
        });
        std::erase_if(leaves_, [&](const Leaf& l) {
            const bool bad = l.count > kMostAround;
            if (bad) dissolve(box_of(l));
            return bad;
        });
    }

    // Leaves without feet have plain points, and what these do to others.
    void settle_feet() {
        const auto make_plain = [&](Leaf& l) {
            l.is_plain = true;
            for (const int at : border_of(l)) plain_[std::size_t(at)] = 1;
        };
        const auto meets_plain = [&](std::span<const int> border) {
            return std::any_of(border.begin(), border.end(),
                               [&](int at) { return plain_[std::size_t(at)] != 0; });
        };
        for (Leaf& l : leaves_)
            if (l.is_plain) make_plain(l);
        // Beyond the outline anything may be, so what can do without feet there, does.
        std::vector<char> outer(table_.size());
        sides_.each([&](int a, int b) { outer[std::size_t(a)] = outer[std::size_t(b)] = 1; });
        for (Leaf& l : leaves_) {
            const auto border = border_of(l);
            if (needs_foot(l) && std::isfinite(judged(l).flat) &&
                std::any_of(border.begin(), border.end(),
                            [&](int at) { return outer[std::size_t(at)] != 0; }))
                make_plain(l);
        }
        bool changed = true;
        for (int round = 0; changed && round < kPlainRounds; ++round) {
            changed = false;
            for (Leaf& l : leaves_)
                if (needs_foot(l) && std::isfinite(l.flat) && meets_plain(border_of(l))) {
                    make_plain(l);
                    changed = true;
                }
        }
        std::erase_if(leaves_, [&](const Leaf& l) {
            const bool bad = needs_foot(l) && meets_plain(border_of(l));
            if (bad) dissolve(box_of(l)), sides_.remove(border_of(l));
            return bad;
        });
        std::erase_if(blocks_, [&](const Block& b) {
            const bool bad = b.needs_foot && meets_plain(b.border);
            if (bad) dissolve(b.grid, b.grid.largest_cell()), sides_.remove(b.border);
            return bad;
        });
    }

    void add_sides() {
        sides_ = OuterSides(table_.size(), 4 * leaves_.size());  // most are of two
        for (const Block& b : blocks_) sides_.add(b.border);
        for (const Leaf& l : leaves_) sides_.add(border_of(l));
    }

    void number_outline() {
        number_.assign(table_.size(), -1);
        sides_.each([&](int a, int b) {
            const int first = number(a, 0, outline_.points);
            outline_.sides.push_back({first, number(b, 0, outline_.points)});
        });
        outline_.needs_foot.assign(outline_.points.size(), 0);
        const auto mark = [&](std::span<const int> border, bool needs_foot) {
            if (!needs_foot) return;
            for (const int at : border)
                if (const int p = number_[std::size_t(at)]; p >= 0) outline_.needs_foot[std::size_t(p)] = 1;
        };
        for (const Block& b : blocks_) mark(b.border, b.needs_foot);
        for (const Leaf& l : leaves_) mark(border_of(l), needs_foot(l));
        outline_.plain.resize(outline_.needs_foot.size());
        for (std::size_t at = 0; at < number_.size(); ++at)
            if (const int p = number_[at]; plain_[at] && p >= 0) outline_.plain[std::size_t(p)] = 1;
    }

    // Points inside of the outline.
    void number_others() {
        first_other_ = int(outline_.points.size());
        for (const Block& b : blocks_)
            for (const int at : b.border) number(at, first_other_, out_.points);
        for (Leaf& l : leaves_) {
            for (const int at : border_of(l)) number(at, first_other_, out_.points);
            if (!l.has_centre) continue;
            l.centre = first_other_ + int(out_.points.size());
            out_.points.push_back(middle_of(box_of(l)));
        }
    }

    // Each leaf knows how many triangles it has, so that it is known where they begin.
    void mesh_leaves() {
        std::vector<std::size_t> first(leaves_.size() + 1, out_.triangles.size());
        for (std::size_t i = 0; i < leaves_.size(); ++i) first[i + 1] = first[i] + leaves_[i].triangles();
        out_.triangles.resize(first.back());
        const BlockTriangles triangles = triangles_of();
        const std::size_t parts = (leaves_.size() + kBlocksAtOnce - 1) / kBlocksAtOnce;
        parallel_for(parts, is_shared_ ? 1 : parts, [&](std::size_t part) {
            BlockTriangles::Work work;
            const auto& found = work.found;
            const std::size_t end = std::min(leaves_.size(), (part + 1) * kBlocksAtOnce);
            for (std::size_t i = part * kBlocksAtOnce; i < end; ++i) {
                const Leaf& l = leaves_[i];
                const auto border = border_of(l);
                triangles.find(l, work);
                FF_REQUIRE(found.size() == l.triangles());
                for (std::size_t k = 0; k < found.size(); ++k)
                    for (std::size_t c = 0; c < 3; ++c) {
                        const int at = found[k][c];
                        out_.triangles[first[i] + k][c] =
                            at == l.count ? l.centre : point(border[std::size_t(at)]);
                    }
            }
        });
    }

    // The point of the mesh with this number of table_.
    int point(int at) const { return number_[std::size_t(at)]; }
    // The same, which becomes the next of `points`, whose numbers begin with `first`, if it has been none.
    int number(int at, int first, std::vector<Vec<2>>& points) {
        int& p = number_[std::size_t(at)];
        if (p < 0) {
            p = first + int(points.size());
            points.push_back(table_.points()[std::size_t(at)]);
        }
        return p;
    }

    void mesh(const Block& block) {
        const BlockGrid& g = block.grid;
        const int first_inner = first_other_ + int(out_.points.size());
        for (int i = 1; i < g.cells(0); ++i)
            for (int j = 1; j < g.cells(1); ++j) out_.points.push_back(g.at(i, j));
        std::vector<int> border;
        for (const int at : block.border) border.push_back(point(at));
        const auto add_centre = [&](int i, int j) {
            out_.points.push_back(g.centre(i, j));
            return first_other_ + int(out_.points.size()) - 1;
        };
        add_cells(g, border, block.step, first_inner, block.ways, add_centre, out_.triangles);
    }

    const CurvatureTree& tree_;
    const Judge& judge_;
    double tolerance_;
    bool is_shared_;
    std::span<const Vec<2>> avoid_;
    ParameterTable table_;
    std::vector<Block> blocks_;
    std::vector<JudgedBlock> judged_;  // blocks of the tree
    std::vector<Leaf> leaves_;
    std::vector<std::vector<int>> borders_;  // of leaves, one after the other
    std::vector<char> plain_;                // of points of table_
    std::vector<int> number_;                // of points of table_ in the mesh
    int first_other_ = 0;                    // of the points inside of the outline
    OuterSides sides_{0, 0};                 // of blocks and leaves, by numbers of table_
    BlockOutline outline_;
    BlockMesh out_;
};

}  // namespace

BlockMesh mesh_blocks(const CurvatureTree& tree, const Judge& judge, double tolerance, bool is_shared,
                      std::span<const Vec<2>> avoid, const BesideBlocks& beside) {
    return BlockMesher(tree, judge, tolerance, is_shared, avoid).run(beside);
}

}  // namespace freiform
