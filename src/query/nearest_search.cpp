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
#include "query/nearest_form_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/chain.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace freiform::detail {

using Tree = NearestTree;
using Parameters = Tree::Parameters;
using Coords = Tree::Coords;

template <int D>
struct NearestSearch {
    const NearestTree& tree;
    NearestTree::Scratch& scratch;
    Coords q{};
    double size_of_q = 0;
    double accuracy;
    int parts_left;

    // The best so far: squared distance, piece and parameters in it.
    double best = std::numeric_limits<double>::infinity();
    int best_piece = 0;
    Parameters best_at{};
    double proven = std::numeric_limits<double>::infinity();  // least of what ended parts have proven

    // Of the piece at hand.
    SeenPiece<D> seen{};
    const Tree::Piece* piece = nullptr;  // seen.piece
    int index = 0;

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

    // --- Blocks: parts of the piece, and F on them, on a stack.
    struct Head {
        Parameters lo{}, hi{};
        std::array<int, kMostParams> degree{};  // 0 along axes where lo == hi
        int count = 1;                          // of coefficients
        double roundings = 0;                   // of halving, in units of u M
    };
    std::vector<Head> heads{};

    double* block(std::size_t i) { return scratch.blocks.data() + i * std::size_t(piece->products); }

    // F on all of the piece.
    void push_whole(double t) {
        const std::size_t m = std::size_t(piece->products);
        if (scratch.blocks.size() < m) scratch.blocks.resize(m);
        double* f = block(0);
        const double* form = tree.numbers_.data() + piece->forms;
        double square_of_q = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) square_of_q += seen.local[k] * seen.local[k];
        const double by_weight = square_of_q - t;
        const double* w = form + m * std::size_t(D + 1);
        for (std::size_t i = 0; i < m; ++i) {
            double sum = form[i] + by_weight * w[i];
            for (std::size_t k = 0; k < std::size_t(D); ++k) sum += seen.local[k] * form[m * (k + 1) + i];
            f[i] = sum;
        }
        Head whole;
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) whole.hi[d] = 1;
        whole.degree = piece->degree;
        whole.count = piece->products;
        heads.assign(1, whole);
    }

    // The axis in the middle of [outer][size][inner].
    struct Sides {
        std::size_t outer = 1, size = 1, inner = 1;
    };
    Sides sides(const Head& h, std::size_t axis) const {
        Sides s;
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
            (d < axis ? s.outer : d == axis ? s.size : s.inner) *= std::size_t(2 * h.degree[d] + 1);
        return s;
    }

    // Halves the block at the top along `axis`.
    void halve(std::size_t axis) {
        const std::size_t top = heads.size() - 1;
        scratch.blocks.resize(std::max(scratch.blocks.size(), (top + 2) * std::size_t(piece->products)));
        double *left = block(top), *right = block(top + 1);
        const Sides s = sides(heads[top], axis);
        const std::size_t degree = s.size - 1, run = s.size * s.inner;
        for (std::size_t o = 0; o < s.outer; ++o, left += run, right += run)
            for (std::size_t k = 0; k <= degree; ++k) {
                double *r = right + (degree - k) * s.inner, *l = left + degree * s.inner;
                for (std::size_t at = 0; at < s.inner; ++at) r[at] = l[at];
                // The last coefficient first: the one before is still that of the last step.
                for (std::size_t i = (degree + 1) * s.inner; i-- > (k + 1) * s.inner;)
                    left[i] = 0.5 * (left[i] + left[i - s.inner]);
            }
        Head& h = heads.back();
        h.roundings += double(degree);
        Head other = h;
        h.hi[axis] = other.lo[axis] = h.lo[axis] + (h.hi[axis] - h.lo[axis]) / 2;
        heads.push_back(other);
    }

    // Keeps of the block at the top the face at the low or the high end of the axis.
    void keep_face(std::size_t axis, bool high) {
        Head& h = heads.back();
        double* f = block(heads.size() - 1);
        const Sides s = sides(h, axis);
        for (std::size_t o = 0; o < s.outer; ++o)
            for (std::size_t i = 0; i < s.inner; ++i)
                f[o * s.inner + i] = f[(o * s.size + (high ? s.size - 1 : 0)) * s.inner + i];
        h.degree[axis] = 0;
        h.count = int(s.outer * s.inner);
        (high ? h.lo : h.hi)[axis] = high ? h.hi[axis] : h.lo[axis];
    }

    Parameters in_block(const Parameters& t, const Head& h) const {
        Parameters x{};
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
            if (h.hi[d] > h.lo[d]) x[d] = std::clamp((t[d] - h.lo[d]) / (h.hi[d] - h.lo[d]), 0.0, 1.0);
        return x;
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
        index = i;
        piece = &tree.pieces_[std::size_t(i)];
        seen.piece = piece;
        seen.coefficients = tree.numbers_.data() + piece->coefficients;
        double length = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            seen.local[k] = q[k] - piece->centre[k];
            length += seen.local[k] * seen.local[k];
        }
        length = std::sqrt(length) * (1 + 8 * kUnitRoundoff);
        const double reach = piece->radius + length * piece->heaviest;
        double terms = 8 * piece->params + 4 * D + 24, product = 1, most = 0;
        for (int d = 0; d < piece->params; ++d) {
            product *= piece->degree[std::size_t(d)] + 1;
            most = std::max(most, 2.0 * piece->degree[std::size_t(d)]);
        }
        const double rounding = 2 * 1.01 * (terms + product + 3);  // of both forms, and their difference
        if (best == std::numeric_limits<double>::infinity()) descend_from_control_point();
        for (int again = 0; again < 64; ++again) {  // as often as a nearer point is found
            const double t = threshold();
            const double magnitude = std::max(reach * reach, t * piece->heaviest * piece->heaviest);
            if (search_with(t, rounding, magnitude, most, again == 63)) break;
        }
    }

    // Whether all of the piece was decided for F of this t; `last`: then it is, for better or worse.
    bool search_with(double t, double rounding, double magnitude, double most, bool last) {
        const double squared_weight = piece->lightest * piece->lightest;
        push_whole(t);
        bool first = true;
        while (!heads.empty()) {
            const Head h = heads.back();
            const double eps = (rounding + 2 * h.roundings) * kUnitRoundoff * magnitude;
            const NearestForm form{piece->params, h.degree, h.count, block(heads.size() - 1)};
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
            const double room = 32 * (1 + most) * eps;
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

    // A lower bound of the squared distance between q and the box.
    double box_distance(const Tree::Node& n) const {
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const double x = std::max({n.lo[k] - q[k], q[k] - n.hi[k], 0.0});
            s += x * x;
        }
        return s * (1 - 8 * kUnitRoundoff);
    }

    void run() {
        auto& stack = scratch.nodes;
        stack.assign(1, {box_distance(tree.nodes_[0]), 0});
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
            const double l = box_distance(tree.nodes_[std::size_t(at) + 1]),
                         r = box_distance(tree.nodes_[std::size_t(node.right)]);
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
    // Powers of two, which a product does not round, where they are doubles.
    const bool moderate = std::abs(exponent_) < 1000;
    const double down = moderate ? std::scalbn(1.0, -exponent_) : 0,
                 up = moderate ? std::scalbn(1.0, exponent_) : 0;
    const auto divided = [&](double x) { return moderate ? x * down : std::scalbn(x, -exponent_); };
    const auto multiplied = [&](double x) { return moderate ? x * up : std::scalbn(x, exponent_); };
    NearestSearch<D> s{*this, scratch, {}, 0, divided(accuracy), max_parts};
    double far = 0;
    for (int k = 0; k < coords_; ++k) {
        s.q[std::size_t(k)] = divided(point[k]);
        far = std::max(far, std::abs(s.q[std::size_t(k)]));
    }
    // So far away that squares would overflow: seen from there the objects are a point, and the lower bound
    // says how wrong that is.
    constexpr double kFar = 0x1p400;
    if (far > kFar)
        for (int k = 0; k < coords_; ++k) s.q[std::size_t(k)] = std::clamp(s.q[std::size_t(k)], -kFar, kFar);
    s.size_of_q = std::min(far, kFar);
    s.run();

    NearestFound out;
    const Piece& p = pieces_[std::size_t(s.best_piece)];
    const LocalJet j = SeenPiece<D>{&p, numbers_.data() + p.coefficients, {}}.jet(s.best_at);
    out.object = p.object;
    for (std::size_t d = 0; d < std::size_t(p.params); ++d) {
        const Interval on = p.domain[d];
        const double t = s.best_at[d];
        out.at[d] = t >= 1 ? on.hi : std::clamp(on.lo + t * (on.hi - on.lo), on.lo, on.hi);
    }
    if (p.triangle) {
        const double u = out.at[0], v = out.at[1];
        out.at = {u * (1 - v), u * v, 0};
    }
    Coords off{};
    double scale = 0;
    for (std::size_t k = 0; k < std::size_t(coords_); ++k) {
        const double x = p.centre[k] + j.value[k];
        out.point[k] = multiplied(x);
        off[k] = out.point[k] / 2 - point[k] / 2;  // halves do not overflow
        scale = std::max(scale, std::abs(off[k]));
    }
    double sum = 0;
    if (scale > 0)
        for (std::size_t k = 0; k < std::size_t(coords_); ++k) sum += (off[k] / scale) * (off[k] / scale);
    out.distance = 2 * (scale * std::sqrt(sum));
    // The point: 3 p + 3 roundings along each axis in N and in W, the quotient, the sum with the centre.
    double steps = 4;
    for (int d = 0; d < p.params; ++d) steps += 3 * p.degree[std::size_t(d)] + 3;
    out.point_error = multiplied(slip_ + std::sqrt(double(coords_)) * 1.03 * (2 * steps + 2) * kUnitRoundoff *
                                             largest_ * 2);
    const double root = std::sqrt(std::max(s.proven, 0.0)) * (1 - 4 * kUnitRoundoff);
    const double lost = slip_ + 2 * std::sqrt(double(coords_)) * kUnitRoundoff * (s.size_of_q + largest_);
    const double lower = far > kFar ? std::max(0.0, far / 2 - largest_) : std::max(0.0, root - lost);
    out.lower_bound = std::min(multiplied(lower), out.distance);
    return out;
}

NearestFound NearestTree::find(const double* point, double accuracy, int max_parts, Scratch& scratch) const {
    switch (coords_) {
        case 1:
            return find_in<1>(point, accuracy, max_parts, scratch);
        case 2:
            return find_in<2>(point, accuracy, max_parts, scratch);
        case 3:
            return find_in<3>(point, accuracy, max_parts, scratch);
        default:
            return find_in<4>(point, accuracy, max_parts, scratch);
    }
}

}  // namespace freiform::detail
