// The search: branch and bound whose pruning is a proof.
//
// Idea. Let r be the distance of the best point so far and T = r^2 - sigma, sigma = 2 r accuracy -
// accuracy^2. On a part of a piece F = |x - q|^2 W^2 - T W^2 is a polynomial in Bernstein form, linear in
// what nearest_tree.cpp prepared. If all its coefficients are positive the part has no point nearer than
// sqrt(T). So boxes and coefficients throw out what is far, Newton's iteration finds the foot on what is
// left, and halving goes on until every part is
//   - positive: all coefficients of F are above the bound of their rounding; or
//   - monotone: all first differences along an axis have one sign, clear of rounding. Then F is nowhere below
//     its least value on the face at the lower end, and that face, with one parameter less, is what is left;
//     or
//   - convex: the second differences of the coefficients make the Hessian of F positive definite over the
//     part; then F >= F(t) + grad F(t) . (s - t) for all s of it, with t the foot that Newton's iteration
//     found: at a foot the gradient vanishes, or points out of the part; or
//   - so near to the foot that rounding is all that is left: what the coefficients prove is then taken as the
//     lower bound. Where that is more than points are rounded, F is made anew from the coefficients of the
//     part (nearest_local_detail.hpp), whose rounding is as small as the part: near folds, for points close
//     to the object, and where weights are uneven.
// Where a whole curve of parameters is as near, on a piece that is flattened to a line or onto a plane, all
// of that would take parts without end. So when they become many, the piece is judged at once: no point of it
// is nearer than the least n . (P_i - q) of its control points, |n| = 1, and n from q to the foot is nearly
// the best there is; steps of [Gilbert 1966] make it better. Every part that ends is added to the proof with
// what it proved: the answer's lower bound is the least of them, whatever ended the search. Where a nearer
// point is found, T changes, and the piece at hand begins anew: what was proven of F holds for one T. Points
// from which a whole arc or patch is equally far (centres) make F constant, which the first test decides at
// once. Most parts beside that of the foot are monotone, so that what is left there are curves and corners.
// A point nearer than rounding of points ends the search with the lower bound 0. Parts with uneven weights
// are not left for a face, where F would say little of F / W^2 beside it. A descent that ends on a side of
// its part goes on over the piece: at a fold, where the Jacobian is singular, it would be walked part by
// part.
//
// Notation: u = 2^-53, q' = q - c, m_d = 2 p_d the degrees of F.
//
// Accuracy. |coefficients of |x - q|^2 W^2| <= M = (|N| + |q'| W)^2. A coefficient is a sum of products(n) =
// prod (p_d + 1) terms with relative weights of 8 params + 2 roundings, then of coords + 2 terms: at most
//     K u M,   K = 1.01 (prod (p_d + 1) + 8 params + 4 coords + 24).
// Halving along d averages m_d times: m_d u M more. The subtraction of T W^2, with M no less than that, adds
// 3 u M and the same K for the form W^2. Along n, |n| <= 1 + 4 u: N_i / W_i - q' has three roundings of |N_i|
// / W_i
// + |q'|, n one, their products and sums at most D more. First differences double the error. Second
// differences along d quadruple the error and multiply it by m_d (m_d - 1); mixed ones by 4 m_d m_e. From the
// pieces to the object: slip_ (nearest_tree.cpp); from q to q' + c: u |q'| in each coordinate. References:
// convexity by control nets [Farin 2002, ch. 17]; the pruning is [Johnson Cohen 1998]'s with F in place of
// boxes.
#include "query/nearest_blocks_detail.hpp"
#include "query/nearest_local_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace freiform::detail {

using Tree = NearestTree;
using Parameters = Tree::Parameters;
using Coords = Tree::Coords;

constexpr double kUneven = 0x1p10;     // weights
constexpr double kLevelGap = 0x1p-30;  // of a square: not worth another look
constexpr int kMany = 96;              // parts of a piece: few feet need so many

template <int D>
struct NearestSearch : NearestBlocks<D> {
    using Base = NearestBlocks<D>;
    using Head = typename Base::Head;
    using Base::block, Base::halve, Base::heads, Base::in_block, Base::index, Base::keep_face, Base::piece,
        Base::push_whole, Base::q, Base::scratch, Base::seen, Base::tree;
    double accuracy;
    int parts_left;
    double noise = 0;  // bound: of the error of points of the piece at hand

    // The best so far: squared distance, piece and parameters in it.
    double best = std::numeric_limits<double>::infinity();
    int best_piece = 0;
    Parameters best_at{};
    double proven = std::numeric_limits<double>::infinity();  // least of what ended parts have proven

    double threshold() const {
        if (best == std::numeric_limits<double>::infinity()) return best;
        const double r = std::sqrt(best);
        return best - accuracy * (accuracy < r ? 2 * r - accuracy : r);
    }

    // Nearer than rounding of points can tell: there is nothing left to prove but that distances are not
    // negative.
    bool touches() const { return best <= noise * noise / 4; }

    // Newton's iteration; whether there is a point clearly nearer than sqrt(t).
    bool descend(const Parameters& lo, const Parameters& hi, Parameters& at, double t) {
        double s = seen.descend(lo, hi, at);
        if (s < best) {
            // On a side of the part the way down leads on: along folds it would be walked part by part.
            bool inside = true;
            Parameters least{}, most{}, on = at;
            for (std::size_t d = 0; d < std::size_t(piece->params); ++d) {
                inside = inside && (at[d] > lo[d] || lo[d] == 0) && (at[d] < hi[d] || hi[d] == 1);
                most[d] = 1;
            }
            best = s, best_piece = index, best_at = at;
            if (!inside && (s = seen.descend(least, most, on)) < best) best = s, best_at = on;
        }
        return best < t * (1 - 1e-14);
    }

    // From the control point that is nearest to q.
    void descend_from_control_point() {
        double least = std::numeric_limits<double>::infinity();
        std::size_t at = 0, i = 0;
        const double* c = seen.coefficients;
        for (std::size_t n = piece->control_points(); i < n; ++i, c += D + 1) {
            double s = 0;
            for (std::size_t k = 0; k < std::size_t(D); ++k) {
                const double x = c[k] / c[D] - seen.local[k];
                s += x * x;
            }
            if (s < least) least = s, at = i;
        }
        Parameters t{}, lo{}, hi{};
        for (std::size_t d = std::size_t(piece->params); d-- > 0;) {
            const std::size_t n = std::size_t(piece->degree[d] + 1);
            t[d] = n > 1 ? double(at % n) / double(n - 1) : 0.5;
            hi[d] = 1;
            at /= n;
        }
        descend(lo, hi, t, 0);
    }

    void search_piece(int i) {
        Base::look_at(i);
        noise = tree.evaluation_error(*piece);
        if (best == std::numeric_limits<double>::infinity()) descend_from_control_point();
        // As often as a nearer point is found.
        while (!touches() && !search_with(threshold(), parts_left <= 0)) --parts_left;
        if (touches()) proven = std::min(proven, 0.0);
    }

    // What a face proves is worth little where the part is much lighter than the face.
    bool is_even(const Head& h) const {
        const bool own = h.lightest > 0;
        return (own ? h.heaviest : piece->heaviest) <= kUneven * (own ? h.lightest : piece->lightest);
    }

    // F on the part at the top, with the rounding of that part alone.
    void make_anew(double t) {
        Head& h = heads.back();
        const LocalForm local = local_form<D>(seen, h.lo, h.hi, h.degree, t, block(heads.size() - 1));
        h.magnitude = local.magnitude, h.offset = local.offset;
        // What is proven on a face is for the part that it stands for, with the weights there.
        bool face = false;
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
            face = face || h.degree[d] != piece->degree[d];
        if (!face) h.lightest = std::max(local.lightest, piece->lightest), h.heaviest = local.heaviest;
        h.roundings = 0;
        h.anew = true;
    }

    // A lower bound of the distance to all of the piece: that to a plane which has its control points beyond.
    // Its normal is from q to the foot on the piece near `at`, and turned a few times to the control point
    // that is least far, until the bound is `enough`.
    double lower_along(Parameters at, double enough) {
        Parameters least{}, most{};
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) most[d] = 1;
        seen.descend(least, most, at);
        const LocalJet foot = seen.jet(at);
        Coords n{};  // from q
        double away = 0, low = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            n[k] = foot.value[k] - seen.local[k];
            away += seen.local[k] * seen.local[k];
        }
        for (int turn = 0; turn < 8 && low < enough; ++turn) {
            double length = 0, nearest = std::numeric_limits<double>::infinity(), spread = 0;
            for (std::size_t k = 0; k < std::size_t(D); ++k) length += n[k] * n[k];
            if (!((length = std::sqrt(length)) > 0)) break;
            Coords toward{};
            const double* c = seen.coefficients;
            for (std::size_t i = piece->control_points(); i-- > 0; c += D + 1) {
                Coords x{};
                double along = 0, size = 0;
                for (std::size_t k = 0; k < std::size_t(D); ++k) {
                    x[k] = (c[k] - seen.local[k] * c[D]) / c[D];
                    along += n[k] / length * x[k];
                    size += c[k] * c[k];
                }
                if (along < nearest) nearest = along, toward = x;
                spread = std::max(spread, std::sqrt(size) / c[D]);
            }
            low = std::max(low, nearest * (1 - 8 * kUnitRoundoff) -
                                    1.01 * (D + 8) * kUnitRoundoff * (spread + std::sqrt(away)));
            // To the point of the segment to the nearest control point that is least far.
            double fall = 0, square = 0;
            for (std::size_t k = 0; k < std::size_t(D); ++k) {
                toward[k] -= n[k];
                fall -= n[k] * toward[k];
                square += toward[k] * toward[k];
            }
            if (!(fall > 0)) break;
            for (std::size_t k = 0; k < std::size_t(D); ++k) n[k] += std::min(fall / square, 1.0) * toward[k];
        }
        return low;
    }

    // Whether all of the piece was decided for F of this t; `last`: then it is, for better or worse.
    bool search_with(double t, bool last) {
        push_whole(t);
        // Of squares: what rounding of points and of their distance leaves anyway.
        const double gap = std::sqrt(t) * (std::sqrt(t) * kLevelGap + 2 * noise);
        bool first = true;
        int looked_at = 0;
        while (!heads.empty()) {
            const Head h = heads.back();
            if (++looked_at == kMany) {
                const double enough = std::sqrt(std::max(t - gap, 0.0)) * (1 + 4 * kUnitRoundoff);
                const double low = lower_along(best_piece == index ? best_at : h.lo, enough);
                if (low >= enough) {
                    proven = std::min(proven, low * low * (1 - 4 * kUnitRoundoff));
                    heads.clear();
                    return true;
                }
            }
            const double eps = Base::error_of(h);
            const NearestForm form = Base::top_form();
            const auto least = form.least();
            if (least.value > eps) {
                proven = std::min(proven, t);
                heads.pop_back();
                continue;
            }
            const auto from_least = [&] {
                Parameters at = form.place(least.at, h.lo, h.hi);
                return descend(h.lo, h.hi, at, t) && !last;
            };
            if (std::exchange(first, false)) {
                const Parameters at = form.place(least.at, h.lo, h.hi);
                if (seen.square_at(at) < best && from_least()) return false;
            }
            const double lightest = h.lightest > 0 ? h.lightest : piece->lightest;
            const double squared_weight = lightest * lightest;
            // What this part has proven even if nothing more is done: F0 / W^2 >= T + F / W^2.
            const double lowest = least.value - eps;
            const auto prove = [&](double low) {
                proven = std::min(proven, t + std::min(low, 0.0) / squared_weight * (1 + 8 * kUnitRoundoff));
                heads.pop_back();
            };
            const double room = 32 * (1 + Base::largest_degree()) * eps;
            const bool rounded = lowest > -room, even = is_even(h);
            if (parts_left <= 0 || (rounded && -lowest <= squared_weight * gap)) {
                prove(lowest);
                continue;
            }
            --parts_left;
            if (!h.anew && (rounded || !even)) {
                make_anew(t);
                continue;
            }
            // A corner inside the sphere: there is a nearer point.
            if (const auto corner = form.inner_corner(eps)) {
                Parameters at{};
                for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
                    at[d] = (*corner)[d] == 0 ? h.lo[d] : h.hi[d];
                if (descend(h.lo, h.hi, at, t) && !last) return false;
            }
            std::size_t longest = kMostParams;
            double change = 0;
            bool monotone = false;
            for (std::size_t d = 0; d < std::size_t(piece->params) && !monotone; ++d) {
                if (h.degree[d] == 0) continue;
                const Interval slope = form.slope(int(d));
                if ((slope.lo > 4 * eps || slope.hi < -4 * eps) && even) {
                    keep_face(d, slope.hi < 0);
                    monotone = true;
                }
                const double own = std::max(-slope.lo, slope.hi) * h.degree[d];
                if (!(own <= change) || longest == kMostParams) longest = d, change = own;
            }
            if (monotone) continue;
            if (form.convex(eps)) {
                Parameters at = best_at;
                bool here = best_piece == index;
                for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
                    here = here && at[d] >= h.lo[d] && at[d] <= h.hi[d];
                if (!here) {
                    at = form.place(least.at, h.lo, h.hi);
                    if (descend(h.lo, h.hi, at, t) && !last) return false;
                }
                double low = form.below_tangent(in_block(at, h), eps);
                if (here && !(low > -room)) {  // the best point so far was no foot of this part
                    at = form.place(least.at, h.lo, h.hi);
                    if (descend(h.lo, h.hi, at, t) && !last) return false;
                    low = form.below_tangent(in_block(at, h), eps);
                }
                if (low > -room && -low <= squared_weight * gap) {
                    prove(low);
                    continue;
                }
                if (low > -room && !h.anew) {
                    make_anew(t);
                    continue;
                }
            }
            const double middle =
                longest == kMostParams ? 0 : h.lo[longest] + (h.hi[longest] - h.lo[longest]) / 2;
            // A corner, or as small as doubles can say.
            if (longest == kMostParams || !(middle > h.lo[longest] && middle < h.hi[longest])) {
                prove(lowest);
                continue;
            }
            halve(longest);
        }
        return true;
    }

    void run() {
        auto& stack = scratch.nodes;
        stack.assign(1, {Base::box_distance(tree.nodes_[0]), 0});
        while (!stack.empty()) {
            const auto [distance, at] = stack.back();
            stack.pop_back();
            const double t = threshold();
            if (distance > t || (distance == t && t == std::numeric_limits<double>::infinity())) {
                proven = std::min(proven, std::max(t, 0.0));
                continue;
            }
            const Tree::Node& node = tree.nodes_[std::size_t(at)];
            if (node.count > 0) {
                search_piece(node.first);
                continue;
            }
            const double l = Base::box_distance(tree.nodes_[std::size_t(at) + 1]),
                         r = Base::box_distance(tree.nodes_[std::size_t(node.right)]);
            if (l < r) {
                stack.push_back({r, node.right});
                stack.push_back({l, at + 1});
            } else {
                stack.push_back({l, at + 1});
                stack.push_back({r, node.right});
            }
        }
    }
};

template <int D>
NearestFound NearestTree::find_in(const double* point, double accuracy, int max_parts,
                                  Scratch& scratch) const {
    NearestSearch<D> s{{*this, scratch}, divided(accuracy), max_parts};
    s.look_from(point);
    s.run();
    NearestFound out = found_at<D>(s.best_piece, s.best_at, point);
    const double root = std::sqrt(std::max(s.proven, 0.0)) * (1 - 4 * kUnitRoundoff);
    const double lower =
        s.far > s.kFar ? std::max(0.0, s.far / 2 - largest_) : std::max(0.0, root - s.lost());
    out.bound = std::min(multiplied_down(lower), out.distance);
    return out;
}

NearestFound NearestTree::find(const double* point, double accuracy, int max_parts, Scratch& scratch) const {
    return with_coords([&](auto d) { return find_in<d>(point, accuracy, max_parts, scratch); });
}

}  // namespace freiform::detail
