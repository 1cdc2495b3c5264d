// The zeros of a piecewise polynomial function f of two parameters, all branches, by subdivision.
//
// Idea. Bernstein coefficients of one sign: f has no zero there. Differences of coefficients of one sign: f
// is monotone along that axis, its zeros are a graph over the other one, and there is no closed branch
// inside. Halve until every cell is one or the other; then only signs at the corners of cells are left to
// know.
//
// Method. A cell is settled where f is monotone along one axis, and on both sides across that axis either has
// one sign or is monotone. Its zeros are then one arc or none, which ends at those two sides of cells
// (between neighbouring vertices of the grid) at whose ends f has opposite signs. So branches are chains of
// cells, linked by their sides; nothing is traced. The signs at vertices have to be certain: lines of the
// grid are placed so that they are, and not on knots, so that a branch along a knot line, as planes of
// symmetry have it, is inside of cells like any other.
//
// Sides of the domain with zero coefficients (the pole of a sphere, a rim in the plane) are branches of their
// own, and f is divided by the distance from them. The same where f is zero along a whole knot line: the
// domain is cut there.
//
// What stays open, because f and its slopes are 0 up to rounding, are cells of about the square root of the
// rounding error in size: nodes, where those that touch are one. If second derivatives over a neighbourhood
// are those of a definite form, a node is an isolated point, nothing, or one loop within the node; of an
// indefinite one, two branches that cross or pass by.
//
// Cost. A few cells for each turn of a branch; about a hundred for a node.
//
// References. [Lane Riesenfeld 1981] for the signs of coefficients.
//
// Why not steps along the branch from points found? They may jump to a neighbouring branch, and finding a
// point on every small loop is the same subdivision. Why not the criterion of normal cones alone? It leaves
// excursions over the sides of a cell open, which matter at the boundary of the domain.
#include "level_links_detail.hpp"

#include <deque>
#include <set>

namespace freiform::detail {

namespace {

// Where a cell is cut, as a fraction: near the middle, and nothing that a file would have.
constexpr double kCuts[] = {0.4875, 0.5309, 0.4427, 0.5681, 0.4023, 0.6117};
constexpr double kSeam = 0.4140625;  // exact, also with a few pieces added

class LevelSearch {
public:
    LevelSearch(const ArcPieces<2, Vec<1>>& f, const LevelOptions& options) : f_(f), options_(options) {}

    LevelSet run() {
        for (std::size_t k = 0; k < 2; ++k) ranges_[k] = ranges(int(k));
        for (const Interval& u : ranges_[0])
            for (const Interval& v : ranges_[1]) search({u, v});
        return std::move(out_);
    }

private:
    LevelBlock piece(int i, int j) const {
        const int block = f_.block(), k = i * f_.count[1] + j;
        LevelBlock b{
            {Interval{double(i), i + 1.0}, {double(j), j + 1.0}}, f_.degree, {}, f_.error[std::size_t(k)]};
        for (int n = 0; n < block; ++n) b.c.push_back(f_.points[std::size_t(k * block + n)][0]);
        b.error += kUnitRoundoff * 2 * b.most();  // of the coefficients that are given
        return b;
    }
    bool is_zero_line(int axis, int line) const {
        const int n = f_.count[std::size_t(axis)], other = f_.count[std::size_t(1 - axis)];
        for (int k = 0; k < other; ++k) {
            const int low = line == 0 ? n - 1 : line - 1, high = line == n ? 0 : line;
            if (!is_zero_side(axis == 0 ? piece(low, k) : piece(k, low), axis, 1) ||
                !is_zero_side(axis == 0 ? piece(high, k) : piece(k, high), axis, 0))
                return false;
        }
        return true;
    }
    // The domain along an axis, cut where f tears or is zero along a whole line.
    std::vector<Interval> ranges(int axis) const {
        const std::size_t a = std::size_t(axis);
        const int n = f_.count[a];
        const bool cyclic = options_.cyclic[a];
        std::vector<double> cuts;
        for (int k = cyclic ? 0 : 1; k < n; ++k)
            if (std::ranges::find(options_.tears[a], k) != options_.tears[a].end() || is_zero_line(axis, k))
                cuts.push_back(k);
        if (cyclic && cuts.empty()) return {{kSeam, n + kSeam}};
        if (cyclic)
            cuts.push_back(cuts[0] + n);
        else
            cuts.insert(cuts.begin(), 0), cuts.push_back(n);
        std::vector<Interval> out;
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) out.push_back({cuts[k], cuts[k + 1]});
        return out;
    }

    // All pieces in a rectangle, along cyclic axes moved by periods.
    LevelCell root(const std::array<Interval, 2>& on) const {
        LevelCell cell{on, {}};
        for (double i = std::floor(on[0].lo); i < on[0].hi; ++i)
            for (double j = std::floor(on[1].lo); j < on[1].hi; ++j) {
                LevelBlock b = piece(int(i) % f_.count[0], int(j) % f_.count[1]);
                b.on = {Interval{i, i + 1}, {j, j + 1}};
                cell.blocks.push_back(part_of(std::move(b), on));
            }
        return cell;
    }
    bool is_whole(int axis, const std::array<Interval, 2>& on) const {
        return options_.cyclic[std::size_t(axis)] && on[std::size_t(axis)].lo == kSeam;
    }
    void divide_by_sides(LevelCell& cell) {
        for (int axis = 0; axis < 2; ++axis)
            for (int side = 0; side < 2 && !is_whole(axis, cell.on); ++side) {
                const std::size_t k = std::size_t(axis);
                const double line = side ? cell.on[k].hi : cell.on[k].lo;
                const auto touches = [&](const LevelBlock& b) {
                    return (side ? b.on[k].hi : b.on[k].lo) == line;
                };
                const auto zero = [&] {
                    return std::ranges::all_of(cell.blocks, [&](const LevelBlock& b) {
                        return !touches(b) ||
                               (is_zero_side(b, axis, side) && b.degree[k] > 0 && b.most() > 0);
                    });
                };
                bool seen = false;
                for (; zero(); seen = true)
                    for (LevelBlock& b : cell.blocks)
                        if (touches(b)) deflate(b, axis, side);
                if (seen) add_side(axis, int(line), cell.on[1 - k]);
            }
    }
    void add_side(int axis, int line, Interval along) {
        const std::size_t a = std::size_t(axis);
        if (options_.cyclic[a]) line %= f_.count[a];
        for (const LevelSide& s : out_.sides)
            if (s.axis == axis && s.line == line && s.along == along) return;
        out_.sides.push_back({axis, line, along});
    }

    void search(const std::array<Interval, 2>& on) {
        LevelCell whole = root(on);
        divide_by_sides(whole);
        LevelLinks links(f_.count, {is_whole(0, on), is_whole(1, on)});
        std::deque<LevelCell> left{std::move(whole)};
        for (; !left.empty(); left.pop_front()) {
            LevelCell& cell = left.front();
            if (cell.sign() != 0) {
                links.add(std::move(cell), LevelState::clear);
                continue;
            }
            if (!goes_round(cell) && cell.simple_axis() >= 0 && all_corners_known(cell)) {
                links.add(std::move(cell), LevelState::simple);
                continue;
            }
            const bool flat =
                std::ranges::any_of(cell.blocks, [](const LevelBlock& b) { return b.most() == 0; });
            if (flat && cell.blocks.size() == 1) {
                out_.flat.push_back(cell.on);
                links.add(std::move(cell), LevelState::flat);
            } else if (cells_ >= options_.max_cells || (flat && is_short(cell, 0x1p-5))) {
                links.add(std::move(cell), LevelState::undecided);
            } else if (is_short(cell, 0x1p-44) || is_rounding(cell)) {
                links.add(std::move(cell), LevelState::open);
            } else {
                ++cells_;
                halve(cell, left);
            }
        }
        const std::size_t before = out_.nodes.size();
        links.finish(out_);
        for (std::size_t i = before; i < out_.nodes.size(); ++i) {
            out_.nodes[i].value = most_over(out_.nodes[i].box);
            out_.nodes[i].bending = bending(out_.nodes[i].box);
        }
    }
    double most_over(const std::array<Interval, 2>& box) const {
        double most = 0;
        const int n = f_.count[0], m = f_.count[1];
        for (int i = int(std::floor(box[0].lo)); i < box[0].hi; ++i)
            for (int j = int(std::floor(box[1].lo)); j < box[1].hi; ++j) {
                LevelBlock b = piece((i % n + n) % n, (j % m + m) % m);
                b.on = {Interval{double(i), i + 1.0}, {double(j), j + 1.0}};
                const LevelBlock part = part_of(std::move(b), box);
                most = std::max(most, 1.01 * (part.most() + part.error));
            }
        return most;
    }
    // The sign of the determinant of second derivatives over a neighbourhood within one piece; 0: not known.
    // Where it is that of all matrices within the bounds, the gradient takes no value twice.
    int bending(std::array<Interval, 2> box) const {
        Index<2> at{};
        for (std::size_t k = 0; k < 2; ++k) {
            const double n = f_.count[k], by = box[k].lo >= n ? -n : box[k].lo < 0 ? n : 0;
            box[k] = {box[k].lo + by, box[k].hi + by};
            at[k] = int(std::floor(box[k].lo));
            if (box[k].hi > at[k] + 1 || box[k].lo < 0) return 0;
        }
        const LevelBlock whole = piece(at[0], at[1]);
        for (double more = 0.25; more > 0x1p-24; more /= 4) {
            auto around = box;
            for (std::size_t k = 0; k < 2; ++k)
                around[k] = {std::max(box[k].lo - more, double(at[k])),
                             std::min(box[k].hi + more, at[k] + 1.0)};
            const LevelBlock b = part_of(whole, around);
            const Interval uu = second(b, 2, 0), uv = second(b, 1, 1), vv = second(b, 0, 2);
            const double products[] = {uu.lo * vv.lo, uu.lo * vv.hi, uu.hi * vv.lo, uu.hi * vv.hi};
            const Interval p{*std::ranges::min_element(products), *std::ranges::max_element(products)};
            const double most = std::max(uv.lo * uv.lo, uv.hi * uv.hi);
            const double least = uv.contains(0) ? 0 : std::min(uv.lo * uv.lo, uv.hi * uv.hi);
            if (p.lo > 1.0001 * most && most >= 0 && p.lo > 0) return 1;
            if (1.0001 * p.hi < least) return -1;
        }
        return 0;
    }
    // Contains the second derivative in the parameters of the block.
    static Interval second(const LevelBlock& b, int u, int v) {
        if (b.degree[0] < u || b.degree[1] < v) return {0, 0};
        Interval range{kInfinity, -kInfinity};
        double factor = 1;
        for (int k = 0; k < u; ++k) factor *= b.degree[0] - k;
        for (int k = 0; k < v; ++k) factor *= b.degree[1] - k;
        each_index(Index<2>{b.degree[0] + 1 - u, b.degree[1] + 1 - v}, [&](const Index<2>& i) {
            const auto c = [&](int x, int y) { return b.coefficient(i[0] + x, i[1] + y); };
            const double d = u == 2   ? c(0, 0) - 2 * c(1, 0) + c(2, 0)
                             : v == 2 ? c(0, 0) - 2 * c(0, 1) + c(0, 2)
                                      : c(0, 0) - c(0, 1) - c(1, 0) + c(1, 1);
            range = hull(range, {d, d});
        });
        const double error = 4.1 * b.error + 16 * kUnitRoundoff * b.most();
        return {factor * (range.lo - error), factor * (range.hi + error)};
    }
    bool goes_round(const LevelCell& cell) const {
        const auto does = [&](std::size_t k) {
            return options_.cyclic[k] && cell.on[k].length() == f_.count[k];
        };
        return does(0) || does(1);
    }
    static bool all_corners_known(const LevelCell& cell) {
        return cell.corner_sign(0, 0) && cell.corner_sign(0, 1) && cell.corner_sign(1, 0) &&
               cell.corner_sign(1, 1);
    }
    static bool is_short(const LevelCell& cell, double width) {
        const auto is = [&](const Interval& on) { return on.length() <= width * std::max(1.0, on.hi); };
        return is(cell.on[0]) && is(cell.on[1]);
    }
    static bool is_rounding(const LevelCell& cell) {
        return std::ranges::all_of(cell.blocks, [](const LevelBlock& b) { return b.most() <= 4 * b.error; });
    }

    // Across the axis along which f bends more; as long as there are knots between, the one with knots.
    static int axis_to_cut(const LevelCell& cell) {
        std::array<double, 2> bend{};
        std::array<std::set<double>, 2> begins;
        for (const LevelBlock& b : cell.blocks)
            for (std::size_t k = 0; k < 2; ++k) {
                begins[k].insert(b.on[k].lo);
                Index<2> extent{b.degree[0] + 1, b.degree[1] + 1};
                extent[k] -= 2;
                each_index(extent, [&](const Index<2>& at) {
                    Index<2> next = at, last = at;
                    next[k] += 1, last[k] += 2;
                    const double d = b.coefficient(at[0], at[1]) - 2 * b.coefficient(next[0], next[1]) +
                                     b.coefficient(last[0], last[1]);
                    bend[k] = std::max(bend[k], b.degree[k] * (b.degree[k] - 1) * std::abs(d));
                });
            }
        const auto size = [&](std::size_t k) { return cell.on[k].length(); };
        if (begins[0].size() > 2 || begins[1].size() > 2) return begins[1].size() > begins[0].size();
        if (begins[0].size() > 1 || begins[1].size() > 1) return size(1) > size(0);
        if (size(0) > 8 * size(1) || size(1) > 8 * size(0)) return size(1) > size(0);
        return bend[1] > bend[0];
    }
    static void halve(const LevelCell& cell, std::deque<LevelCell>& left) {
        int axis = axis_to_cut(cell);
        if (cell.on[std::size_t(axis)].length() <= 0x1p-44 * std::max(1.0, cell.on[std::size_t(axis)].hi))
            axis = 1 - axis;
        const std::size_t k = std::size_t(axis);
        // Inside of the widest piece; of several, the middle one.
        std::set<std::pair<double, double>> parts;
        for (const LevelBlock& b : cell.blocks) parts.insert({b.on[k].lo, b.on[k].hi});
        Interval in{};
        std::size_t at = 0;
        for (const auto& [lo, hi] : parts) {
            if (hi - lo > in.length() || (hi - lo == in.length() && at <= parts.size() / 2)) in = {lo, hi};
            ++at;
        }
        for (const double fraction : kCuts) {
            const double x = in.lo + fraction * in.length();
            std::array<LevelCell, 2> half{LevelCell{cell.on, {}}, LevelCell{cell.on, {}}};
            half[0].on[k].hi = half[1].on[k].lo = x;
            for (const LevelBlock& b : cell.blocks) {
                if (b.on[k].hi <= x) {
                    half[0].blocks.push_back(b);
                } else if (b.on[k].lo >= x) {
                    half[1].blocks.push_back(b);
                } else {
                    auto both = cut(b, axis, x);
                    half[0].blocks.push_back(std::move(both[0]));
                    half[1].blocks.push_back(std::move(both[1]));
                }
            }
            const bool known = axis == 0 ? half[0].corner_sign(1, 0) && half[0].corner_sign(1, 1)
                                         : half[0].corner_sign(0, 1) && half[0].corner_sign(1, 1);
            if (!known && fraction != kCuts[std::size(kCuts) - 1]) continue;
            left.push_back(std::move(half[0]));
            left.push_back(std::move(half[1]));
            return;
        }
    }

    const ArcPieces<2, Vec<1>>& f_;
    const LevelOptions& options_;
    std::array<std::vector<Interval>, 2> ranges_;
    LevelSet out_;
    int cells_ = 0;
};

}  // namespace

LevelSet level_set(const ArcPieces<2, Vec<1>>& f, const LevelOptions& options) {
    return LevelSearch(f, options).run();
}

}  // namespace freiform::detail
