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
//     lower bound.
// Every part that ends is added to the proof with what it proved: the answer's lower bound is the least of
// them, whatever ended the search. Where a nearer point is found, T changes, and the piece at hand begins
// anew: what was proven of F holds for one T. Points from which a whole arc or patch is equally far (centres)
// make F constant, which the first test decides at once. Most parts beside that of the foot are monotone, so
// that what is left there are curves and corners.
//
// Notation: u = 2^-53, q' = q - c, m_d = 2 p_d the degrees of F.
//
// Accuracy. |coefficients of |x - q|^2 W^2| <= M = (|N| + |q'| W)^2. A coefficient is a sum of products(n) =
// prod (p_d + 1) terms with relative weights of 8 params + 2 roundings, then of coords + 2 terms: at most
//     K u M,   K = 1.01 (prod (p_d + 1) + 8 params + 4 coords + 24).
// Halving along d averages m_d times: m_d u M more. The subtraction of T W^2, with M no less than that, adds
// 3 u M and the same K for the form W^2. First differences double the error. Second differences along d
// quadruple the error and multiply it by m_d (m_d - 1); mixed ones by 4 m_d m_e. From the pieces to the
// object: slip_ (nearest_tree.cpp); from q to q' + c: u |q'| in each coordinate. References: convexity by
// control nets [Farin 2002, ch. 17]; the pruning is [Johnson Cohen 1998]'s with F in place of boxes.
#include "query/nearest_blocks_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace freiform::detail {

using Tree = NearestTree;
using Parameters = Tree::Parameters;
using Coords = Tree::Coords;

template <int D>
struct NearestSearch : NearestBlocks<D> {
    using Base = NearestBlocks<D>;
    using Head = typename Base::Head;
    using Base::block, Base::halve, Base::heads, Base::in_block, Base::index, Base::keep_face, Base::piece,
        Base::push_whole, Base::q, Base::scratch, Base::seen, Base::tree;
    double accuracy;
    int parts_left;

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

    // Newton's iteration; whether there is a point clearly nearer than sqrt(t).
    bool descend(const Parameters& lo, const Parameters& hi, Parameters& at, double t) {
        const double s = seen.descend(lo, hi, at);
        if (s < best) best = s, best_piece = index, best_at = at;
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
        if (best == std::numeric_limits<double>::infinity()) descend_from_control_point();
        for (int again = 0; again < 64; ++again)  // as often as a nearer point is found
            if (search_with(threshold(), again == 63)) break;
    }

    // Whether all of the piece was decided for F of this t; `last`: then it is, for better or worse.
    bool search_with(double t, bool last) {
        const double squared_weight = piece->lightest * piece->lightest;
        push_whole(t);
        bool first = true;
        while (!heads.empty()) {
            const Head h = heads.back();
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
            // What this part has proven even if nothing more is done: F0 / W^2 >= T + F / W^2.
            const double lowest = least.value - eps;
            const auto prove = [&](double low) {
                proven = std::min(proven, t + std::min(low, 0.0) / squared_weight * (1 + 8 * kUnitRoundoff));
                heads.pop_back();
            };
            const double room = 32 * (1 + Base::largest_degree()) * eps;
            if (lowest > -room || parts_left <= 0) {
                prove(lowest);
                continue;
            }
            --parts_left;
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
                if (slope.lo > 4 * eps || slope.hi < -4 * eps) {
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
                if (low > -room) {
                    prove(low);
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
    out.bound = std::min(multiplied(lower), out.distance);
    return out;
}

NearestFound NearestTree::find(const double* point, double accuracy, int max_parts, Scratch& scratch) const {
    return with_coords([&](auto d) { return find_in<d>(point, accuracy, max_parts, scratch); });
}

}  // namespace freiform::detail
