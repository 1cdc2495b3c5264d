// The farthest point, and all that is nearer than a radius.
//
// Farthest. As nearest_search.cpp with signs turned: with T the square of the largest distance found so far,
// a part on which no coefficient of F = |x - q|^2 W^2 - T W^2 is above the bound of its rounding has no point
// farther than sqrt(T). Where a coefficient is large Newton's iteration looks for a farther point, with which
// the piece begins anew; halving does the rest, since the largest coefficient and the largest value of F
// approach each other with the square of the length of the part.
//
// Within a radius. T is the square of the radius, made larger by what separates pieces and objects. A part
// with positive coefficients is outside, one with negative coefficients inside; others are halved until they
// are short. So the cells that are kept hold all that is within the radius, and cells of `whole` nothing
// else. What touches is one region: cells are put in order along the first parameter, and those whose closed
// boxes meet are joined.
//
// Cost. Parts for the farthest point: some for each halving of the distance to it; for a region about the
// number of cells that its boundary meets.
#include "query/nearest_blocks_detail.hpp"

#include <freiform/core/sort.hpp>

#include <optional>
#include <tuple>
#include <utility>

namespace freiform::detail {

namespace {

constexpr double kLongCell = 1.0 / 16;  // of a piece

}  // namespace

template <int D>
struct NearestExtent : NearestBlocks<D> {
    using Base = NearestBlocks<D>;
    using Head = typename Base::Head;
    using Parameters = NearestTree::Parameters;
    using Base::halve, Base::heads, Base::piece, Base::seen, Base::tree;
    int parts_left = 0;

    // The axis along which F changes most and that can be halved.
    static std::optional<std::size_t> axis_to_halve(const NearestForm& form, const Head& h, double finest) {
        std::optional<std::size_t> axis;
        double most = -1;
        for (std::size_t d = 0; d < std::size_t(form.params); ++d) {
            const double middle = h.lo[d] + (h.hi[d] - h.lo[d]) / 2;
            if (h.degree[d] == 0 || !(h.hi[d] - h.lo[d] > finest) || !(middle > h.lo[d] && middle < h.hi[d]))
                continue;
            const Interval slope = form.slope(int(d));
            const double change = std::max(-slope.lo, slope.hi) * h.degree[d];
            if (change > most) most = change, axis = d;
        }
        return axis;
    }

    // --- The farthest point.
    double accuracy = 0, best = -1, proven = 0;
    int best_piece = 0;
    Parameters best_at{};

    void take(const Parameters& at) {
        const double s = seen.square_at(at);
        if (s > best) best = s, best_piece = Base::index, best_at = at;
    }
    // Parts that reach no farther than this are done.
    double goal() const {
        const double r = std::sqrt(std::max(best, 0.0)) + accuracy;
        return std::max(best, r * r * (1 - 4 * kUnitRoundoff));
    }

    // Newton's iteration for the largest distance on the box; where the distance is not concave, steps along
    // the gradient.
    void ascend(const Parameters& lo, const Parameters& hi, Parameters at) {
        const std::size_t n = std::size_t(piece->params);
        for (int step = 0; step < 24; ++step) {
            const LocalJet j = seen.jet(at);
            const double s = seen.square(j);
            double h[kMostParams][kMostParams];
            Parameters g{}, move{};
            std::array<bool, kMostParams> held{};
            for (std::size_t d = 0; d < n; ++d) {
                for (std::size_t k = 0; k < std::size_t(D); ++k)
                    g[d] += (j.value[k] - seen.local[k]) * j.first[d][k];
                held[d] = (at[d] <= lo[d] && g[d] <= 0) || (at[d] >= hi[d] && g[d] >= 0);
                move[d] = held[d] ? 0 : g[d];
            }
            for (std::size_t d = 0; d < n; ++d)
                for (std::size_t e = 0; e <= d; ++e) {
                    h[d][e] = 0;
                    for (std::size_t k = 0; k < std::size_t(D); ++k)
                        h[d][e] -=
                            j.first[d][k] * j.first[e][k] + (j.value[k] - seen.local[k]) * j.second[d][e][k];
                    if (held[d] || held[e]) h[d][e] = d == e ? 1 : 0;
                }
            if (!seen.solve(h, n, move))
                for (std::size_t d = 0; d < n; ++d)
                    move[d] = held[d] || g[d] == 0 ? 0 : (g[d] > 0 ? 0.25 : -0.25) * (hi[d] - lo[d]);
            bool better = false;
            double factor = 1;
            for (int part = 0; part < 8 && !better; ++part, factor *= 0.25) {
                Parameters next = at;
                for (std::size_t d = 0; d < n; ++d)
                    next[d] = std::clamp(at[d] + factor * move[d], lo[d], hi[d]);
                better = seen.square_at(next) > s * (1 + 1e-15);
                if (better) at = next;
            }
            if (!better) break;
        }
        take(at);
    }

    void farthest_of_piece(int i) {
        Base::look_at(i);
        Parameters corner{};
        for (unsigned bits = 0; bits < (1u << piece->params); ++bits) {
            for (std::size_t d = 0; d < std::size_t(piece->params); ++d) corner[d] = bits >> d & 1;
            take(corner);
        }
        for (int again = 0; again < 64; ++again)  // as often as a farther point is found
            if (farthest_with(std::max(best, 0.0), again == 63)) break;
    }

    // Whether all of the piece was decided for F of this t; `last`: then it is, for better or worse.
    bool farthest_with(double t, bool last) {
        const double squared_weight = piece->lightest * piece->lightest, degree = Base::largest_degree();
        Base::push_whole(t);
        while (!heads.empty()) {
            const Head h = heads.back();
            const double eps = Base::error_of(h);
            const NearestForm form = Base::top_form();
            const auto [highest, where] = form.most();
            const auto prove = [&] {
                const double over = (highest + eps) / squared_weight * (1 + 8 * kUnitRoundoff);
                proven = std::max(proven, t + std::max(over, 0.0) * (1 + 8 * kUnitRoundoff));
                heads.pop_back();
            };
            const double enough = (goal() - t) * squared_weight * (1 - 8 * kUnitRoundoff);
            if (highest <= std::max(enough, 32 * (1 + degree) * eps) || --parts_left < 0) {
                prove();
                continue;
            }
            const Parameters at = form.place(where, h.lo, h.hi);
            if (seen.square_at(at) > best) ascend(h.lo, h.hi, at);
            if (best > t * (1 + 1e-14) && !last) return false;
            if (const auto axis = axis_to_halve(form, h, 0))
                halve(*axis);
            else
                prove();
        }
        return true;
    }

    void run_farthest() {
        auto& stack = Base::scratch.nodes;
        stack.assign(1, {Base::box_reach(tree.nodes_[0]), 0});
        while (!stack.empty()) {
            const auto [farthest, at] = stack.back();
            stack.pop_back();
            if (best >= 0 && farthest <= goal()) {
                proven = std::max(proven, farthest);
                continue;
            }
            const NearestTree::Node& node = tree.nodes_[std::size_t(at)];
            if (node.count > 0) {
                farthest_of_piece(node.first);
                continue;
            }
            const double l = Base::box_reach(tree.nodes_[std::size_t(at) + 1]),
                         r = Base::box_reach(tree.nodes_[std::size_t(node.right)]);
            stack.push_back(l > r ? std::pair{r, node.right} : std::pair{l, at + 1});
            stack.push_back(l > r ? std::pair{l, at + 1} : std::pair{r, node.right});
        }
    }

    // --- All that is nearer than sqrt(t).
    void cells_of_piece(int i, double t, double finest, std::vector<NearestCell>& out) {
        Base::look_at(i);
        Base::push_whole(t);
        while (!heads.empty()) {
            const Head h = heads.back();
            const double eps = Base::error_of(h);
            const NearestForm form = Base::top_form();
            const auto least = form.least();
            if (least.value > eps) {
                heads.pop_back();
                continue;
            }
            const double highest = form.most().value;
            const bool flat = highest - least.value <= 64 * (1 + Base::largest_degree()) * eps;
            const bool whole = highest < -eps || flat;
            std::optional<std::size_t> axis;
            if (!whole && --parts_left >= 0) axis = axis_to_halve(form, h, finest);
            if (axis) {
                halve(*axis);
                continue;
            }
            NearestCell c;
            c.object = piece->object;
            c.piece = i;
            c.whole = whole;
            c.at = form.place(least.at, h.lo, h.hi);
            c.square = seen.descend(h.lo, h.hi, c.at);
            for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
                c.stretch = c.stretch || (whole && h.hi[d] - h.lo[d] >= kLongCell);
            c.box = tree.box_of(i, h.lo, h.hi);
            out.push_back(c);
            heads.pop_back();
        }
    }

    void run_cells(double t, double finest, std::vector<NearestCell>& out) {
        auto& stack = Base::scratch.nodes;
        stack.assign(1, {0, 0});
        while (!stack.empty()) {
            const int at = stack.back().second;
            stack.pop_back();
            const NearestTree::Node& node = tree.nodes_[std::size_t(at)];
            if (Base::box_distance(node) > t) continue;
            if (node.count > 0) {
                cells_of_piece(node.first, t, finest, out);
                continue;
            }
            stack.push_back({0, node.right});
            stack.push_back({0, at + 1});
        }
    }
};

std::vector<NearestCell> regions_of(std::vector<NearestCell> cells) {
    sort(cells, {}, [](const NearestCell& c) {
        return std::tuple(c.object, c.box[0].lo, c.box[1].lo, c.box[2].lo, c.piece);
    });
    std::vector<std::size_t> root(cells.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    std::vector<std::size_t> open;  // cells that may reach to the next along the first parameter
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const NearestCell& c = cells[i];
        std::erase_if(open, [&](std::size_t k) {
            return cells[k].object != c.object || cells[k].box[0].hi < c.box[0].lo;
        });
        for (const std::size_t k : open) {
            bool touch = true;
            for (std::size_t d = 1; d < kMostParams; ++d) touch = touch && cells[k].box[d].overlaps(c.box[d]);
            if (touch) root[find(i)] = find(k);
        }
        open.push_back(i);
    }
    std::vector<NearestCell> out;
    std::vector<std::size_t> place(cells.size(), cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::size_t& at = place[find(i)];
        if (at == cells.size()) {
            at = out.size();
            out.push_back(cells[i]);
            continue;
        }
        NearestCell& r = out[at];
        const auto box = r.box;
        const bool stretch = r.stretch || cells[i].stretch;
        if (cells[i].square < r.square) r = cells[i];
        for (std::size_t d = 0; d < kMostParams; ++d) r.box[d] = hull(box[d], cells[i].box[d]);
        r.stretch = stretch;
    }
    return out;
}

std::array<Interval, kMostParams> NearestTree::box_of(int piece, const Parameters& lo,
                                                      const Parameters& hi) const {
    const Piece& p = pieces_[std::size_t(piece)];
    std::array<Interval, kMostParams> box{};
    for (std::size_t d = 0; d < std::size_t(p.params); ++d)
        box[d] = {in_domain(p.domain[d], lo[d]), in_domain(p.domain[d], hi[d])};
    if (p.triangle) {
        const Interval u = box[0], v = box[1];
        box[0] = {u.lo * (1 - v.hi), u.hi * (1 - v.lo)};
        box[1] = {u.lo * v.lo, u.hi * v.hi};
    }
    return box;
}

NearestFound NearestTree::found(const NearestCell& cell, const double* point) const {
    return with_coords([&](auto d) { return found_at<d>(cell.piece, cell.at, point); });
}

NearestFound NearestTree::find_farthest(const double* point, double accuracy, int max_parts,
                                        Scratch& scratch) const {
    return with_coords([&](auto d) {
        NearestExtent<d> s{{*this, scratch}, max_parts};
        s.accuracy = divided(accuracy);
        s.look_from(point);
        s.run_farthest();
        NearestFound out = found_at<d>(s.best_piece, s.best_at, point);
        // From q as it is if it was brought nearer: the triangle inequality.
        double moved = 0;
        if (s.far > s.kFar) moved = std::sqrt(double(int(d))) * s.far * (1 + 8 * kUnitRoundoff);
        const double upper = std::sqrt(s.proven) * (1 + 4 * kUnitRoundoff) + s.lost() + moved;
        out.bound = std::max(multiplied(upper) + underflow(), out.distance);
        return out;
    });
}

std::vector<NearestCell> NearestTree::cells(const double* point, double radius, double finest, int max_parts,
                                            Scratch& scratch, bool& complete) const {
    std::vector<NearestCell> out;
    with_coords([&](auto d) {
        NearestExtent<d> s{{*this, scratch}, max_parts};
        s.look_from(point);
        // Beyond kFar nothing can be told apart: all that there is, or nothing.
        const double r = (divided(radius) + s.lost()) * (1 + 4 * kUnitRoundoff);
        if (s.far > s.kFar && r < s.far / 2 - largest_) return;
        const double bounded = s.far > s.kFar ? 4 * s.kFar : std::min(r, 4 * s.kFar);
        s.run_cells(bounded * bounded * (1 + 4 * kUnitRoundoff), finest, out);
        if (s.far > s.kFar)
            for (NearestCell& c : out) c.whole = c.stretch = false;
        complete = s.parts_left >= 0;
    });
    return out;
}

}  // namespace freiform::detail
