// Method. The sides of blocks and of leaves come from halving intervals, and each interval has one place
// where it is cut, so of the points that two neighbours have on their common side those of the coarser are
// among those of the finer. A side gets all points that anybody has there, found by halving its steps as long
// as the middle is one. Cells at the border of a block become fans from their corner inside it, other cells
// two triangles. Every triangle is within its cell, whose bound it keeps: half the squared radius of the
// smallest circle around it is no more than that of half the cell (curvature_tree.cpp). What two blocks have
// on both sides is no outline.
#include "blocks_detail.hpp"
#include "parameter_table_detail.hpp"

#include <algorithm>

namespace freiform {

namespace {

constexpr double kCellRounding = 1 + 1e-12;  // of what judges cells

struct Grid {
    std::array<std::vector<double>, 2> lines;

    int cells(int axis) const { return int(lines[std::size_t(axis)].size()) - 1; }
    Vec<2> at(int i, int j) const { return {{lines[0][std::size_t(i)], lines[1][std::size_t(j)]}}; }
    Vec<2> largest_cell() const {
        Vec<2> out{};
        for (int d = 0; d < 2; ++d)
            for (std::size_t k = 0; k + 1 < lines[std::size_t(d)].size(); ++k)
                out[d] = std::max(out[d], lines[std::size_t(d)][k + 1] - lines[std::size_t(d)][k]);
        return out;
    }
    bool is_inner(int i, int j) const { return i > 0 && j > 0 && i < cells(0) && j < cells(1); }
};

class BlockMesher {
public:
    BlockMesher(const CurvatureTree& tree, const Judge& judge, double tolerance)
        : tree_(tree), judge_(judge), tolerance_(tolerance), table_(tree.corners().size()) {}

    BlockMesh run() {
        out_.corners.assign(tree_.corners().begin(), tree_.corners().end());
        for (const auto& b : tree_.blocks()) take(b);
        if (blocks_.empty()) return std::move(out_);
        for (const auto& c : out_.corners) table_.number(c.at);
        for (const Block& b : blocks_) each_border_point(b.grid, [&](const Vec<2>& p) { table_.number(p); });
        find_sides();
        find_outline();
        for (const Block& b : blocks_) mesh(b);
        return std::move(out_);
    }

private:
    // Numbers of table_ along the border, counter-clockwise from the lower corner of the box. `step`: where
    // each cell along it begins; sides follow each other.
    struct Block {
        Grid grid;
        bool needs_foot = false;
        std::vector<int> border = {}, step = {};
    };

    void take(const CurvatureTree::Block& b) {
        const Grid grid{{halved(b.box.side(0), b.halves[0]), halved(b.box.side(1), b.halves[1])}};
        const Vec<2> cell = kCellRounding * grid.largest_cell();
        // Of the first cell of each part, as if corners were plain where a foot is not needed.
        double usual = 0, footless = 0;
        const bool all_plain = tree_.is_all_plain();
        const Grid parts{{halved(b.box.side(0), b.parts[0]), halved(b.box.side(1), b.parts[1])}};
        const Bending* at = tree_.part_bendings(b).data();
        for (int i = 0; i < parts.cells(0); ++i)
            for (int j = 0; j < parts.cells(1); ++j, ++at) {
                const Box<2> box{parts.at(i, j), parts.at(i + 1, j + 1)};
                const std::array<Vec<2>, 3> corner{box.lo, box.lo + Vec<2>{{cell[0], 0}},
                                                   box.lo + Vec<2>{{0, cell[1]}}};
                usual = std::max(usual, judge_(*at, box, corner, all_plain ? 3 : 0, b.node).bound);
                if (!(usual <= tolerance_)) return dissolve(grid, cell);
                if (!all_plain && footless <= tolerance_)
                    footless = std::max(footless, judge_(*at, box, corner, 1, b.node).bound);
            }
        const bool needs_foot = !(footless <= tolerance_);
        out_.bound = std::max({out_.bound, usual, needs_foot ? 0 : footless});
        blocks_.push_back({grid, needs_foot});
    }

    void dissolve(const Grid& grid, const Vec<2>& cell) {
        for (int i = 0; i <= grid.cells(0); ++i)
            for (int j = 0; j <= grid.cells(1); ++j) out_.corners.push_back({grid.at(i, j), cell});
    }

    template <class Visit>
    static void each_border_point(const Grid& g, Visit&& visit) {
        const int nu = g.cells(0), nv = g.cells(1);
        for (int i = 0; i < nu; ++i) visit(g.at(i, 0));
        for (int j = 0; j < nv; ++j) visit(g.at(nu, j));
        for (int i = nu; i > 0; --i) visit(g.at(i, nv));
        for (int j = nv; j > 0; --j) visit(g.at(0, j));
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

    void find_sides() {
        for (Block& block : blocks_) {
            std::vector<Vec<2>> own;
            each_border_point(block.grid, [&](const Vec<2>& p) { own.push_back(p); });
            for (std::size_t k = 0; k < own.size(); ++k) {
                const Vec<2>&a = own[k], &b = own[(k + 1) % own.size()];
                block.step.push_back(int(block.border.size()));
                block.border.push_back(table_.find(a));
                add_between(a, b, a[0] == b[0] ? 1 : 0, block.border);
            }
            block.step.push_back(int(block.border.size()));
        }
    }

    void find_outline() {
        std::vector<std::array<int, 2>> sides;  // sorted ends
        for (const Block& b : blocks_)
            for (std::size_t k = 0; k < b.border.size(); ++k) {
                const auto [lo, hi] = std::minmax(b.border[k], b.border[(k + 1) % b.border.size()]);
                sides.push_back({lo, hi});
            }
        std::sort(sides.begin(), sides.end());
        number_.assign(table_.size(), -1);
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const bool twice =
                (i > 0 && sides[i] == sides[i - 1]) || (i + 1 < sides.size() && sides[i] == sides[i + 1]);
            if (!twice) out_.outline.push_back({point(sides[i][0]), point(sides[i][1])});
        }
        out_.on_outline = int(out_.points.size());
        out_.needs_foot.assign(out_.points.size(), 0);
        for (const Block& b : blocks_)
            for (const int at : b.border)
                if (const int p = point(at); b.needs_foot && p < out_.on_outline)
                    out_.needs_foot[std::size_t(p)] = 1;
    }

    // The point of the mesh with this number of table_.
    int point(int at) {
        int& p = number_[std::size_t(at)];
        if (p < 0) {
            p = int(out_.points.size());
            out_.points.push_back(table_.points()[std::size_t(at)]);
        }
        return p;
    }

    // The place of a corner of the border among the steps.
    static std::size_t along(const Grid& g, int i, int j) {
        const int nu = g.cells(0), nv = g.cells(1);
        const int k = j == 0 ? i : i == nu ? nu + j : j == nv ? 2 * nu + nv - i : 2 * (nu + nv) - j;
        return std::size_t(k);
    }

    void mesh(const Block& block) {
        const Grid& g = block.grid;
        const int nu = g.cells(0), nv = g.cells(1);
        first_inner_ = int(out_.points.size());
        for (int i = 1; i < nu; ++i)
            for (int j = 1; j < nv; ++j) out_.points.push_back(g.at(i, j));
        for (int i = 0; i < nu; ++i)
            for (int j = 0; j < nv; ++j)
                if (i > 0 && j > 0 && i + 1 < nu && j + 1 < nv) {
                    const int a = inner(g, i, j), b = inner(g, i + 1, j), c = inner(g, i + 1, j + 1),
                              d = inner(g, i, j + 1);
                    out_.triangles.push_back({a, b, c});
                    out_.triangles.push_back({a, c, d});
                } else {
                    mesh_border_cell(block, i, j);
                }
    }

    int inner(const Grid& g, int i, int j) const { return first_inner_ + (i - 1) * (g.cells(1) - 1) + j - 1; }

    // From a corner inside the block, counter-clockwise; if two are, the other one comes last.
    void mesh_border_cell(const Block& block, int i, int j) {
        const Grid& g = block.grid;
        const std::array<std::array<int, 2>, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
        const bool on_border[4] = {j == 0, i + 1 == g.cells(0), j + 1 == g.cells(1), i == 0};
        const auto is_inner = [&](std::size_t k) { return g.is_inner(corner[k % 4][0], corner[k % 4][1]); };
        std::size_t first = 0, many = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (is_inner(k)) {
                ++many;
                if (many == 1 || is_inner(k + 3)) first = k;
            }
        around_.clear();
        for (std::size_t n = 0; n < 4; ++n) {
            const std::size_t k = (first + n) % 4;
            const auto [a, b] = corner[k];
            if (g.is_inner(a, b)) {
                around_.push_back(inner(g, a, b));
                continue;
            }
            const std::size_t at = along(g, a, b);
            const int from = block.step[at], to = on_border[k] ? block.step[at + 1] : from + 1;
            for (int p = from; p < to; ++p) around_.push_back(point(block.border[std::size_t(p)]));
        }
        const std::size_t last = around_.size() - 1, turn = many == 2 ? last / 2 : last;
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            out_.triangles.push_back({around_[a], around_[b], around_[c]});
        };
        for (std::size_t k = 1; k < turn; ++k) add(0, k, k + 1);
        if (many == 2) add(0, turn, last);
        for (std::size_t k = turn; k + 1 < last; ++k) add(k, k + 1, last);
    }

    const CurvatureTree& tree_;
    const Judge& judge_;
    double tolerance_;
    ParameterTable table_;
    std::vector<Block> blocks_;
    std::vector<int> number_;  // of points of table_ in the mesh
    int first_inner_ = 0;      // of the block that is being meshed
    std::vector<int> around_;  // work space
    BlockMesh out_;
};

}  // namespace

BlockMesh mesh_blocks(const CurvatureTree& tree, const Judge& judge, double tolerance) {
    return BlockMesher(tree, judge, tolerance).run();
}

}  // namespace freiform
