// The search: branch and bound whose pruning is a proof.
//
// Idea. Let r be the distance of the best point so far and T = r^2 - sigma, sigma = 2 r accuracy -
// accuracy^2. On a part of a piece F = |x - q|^2 W^2 - T W^2 is a polynomial in Bernstein form, linear in
// what nearest_tree.cpp prepared. If all its coefficients are positive the part has no point nearer than
// sqrt(T). So boxes and coefficients throw out what is far, Newton's iteration finds the foot on what is
// left, and halving goes on until every part is
//   - positive: all coefficients of F are above the bound of their rounding; or
//   - convex: the second differences of the coefficients make the Hessian of F positive definite over the
//     part; then F >= F(t) + grad F(t) . (s - t) for all s of it, with t the foot that Newton's iteration
//     found: at a foot the gradient vanishes, or points out of the part; or
//   - so near to the foot that rounding is all that is left: what the coefficients prove is then taken as the
//     lower bound.
// Every part that ends is added to the proof with what it proved: the answer's lower bound is the least of
// them, whatever ended the search. Points from which a whole arc or patch is equally far (centres) make F
// constant, which the first test decides at once.
//
// Notation: u = 2^-53, q' = q - c, m_d = 2 p_d the degrees of F.
//
// Accuracy. |coefficients of |x - q|^2 W^2| <= M = (|N| + |q'| W)^2. A coefficient is a sum of products(n) =
// prod (p_d + 1) terms with relative weights of 8 params + 2 roundings, then of coords + 2 terms: at most
//     K u M,   K = 1.01 (prod (p_d + 1) + 8 params + 4 coords + 24).
// Halving along d averages m_d times: m_d u M more. The subtraction of T W^2 <= M adds 3 u M and the same K
// for the form W^2. Second differences along d quadruple the error and multiply it by m_d (m_d - 1); mixed
// ones by 4 m_d m_e. From the pieces to the object: slip_ (nearest_tree.cpp); from q to q' + c: u |q'| in
// each coordinate. References: convexity by control nets [Farin 2002, ch. 17]; the pruning is [Johnson Cohen
// 1998]'s with F in place of boxes.
#include "query/nearest_form_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/chain.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

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
    double magnitude = 0, rounding = 0;

    double threshold() const {
        if (best == std::numeric_limits<double>::infinity()) return best;
        const double r = std::sqrt(best);
        return best - accuracy * (accuracy < r ? 2 * r - accuracy : r);
    }

    void descend(const Parameters& lo, const Parameters& hi, Parameters& t) {
        const double s = seen.descend(lo, hi, t);
        if (s < best) best = s, best_piece = index, best_at = t;
    }

    // --- Blocks: parts of the piece with the forms |x - q|^2 W^2 and W^2 on them, on a stack.
    struct Head {
        Parameters lo{}, hi{};
        double roundings = 0;  // of halving, in units of u M
    };
    std::vector<Head> heads{};

    std::size_t block_size() const { return std::size_t(piece->products) * (piece->rational ? 2 : 1); }
    double* block(std::size_t i) { return scratch.blocks.data() + i * block_size(); }

    void push_whole() {
        const std::size_t m = std::size_t(piece->products);
        if (scratch.blocks.size() < block_size()) scratch.blocks.resize(block_size());
        double* f = block(0);
        const double* form = tree.numbers_.data() + piece->forms;
        double square_of_q = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) square_of_q += seen.local[k] * seen.local[k];
        const double* w = form + m * std::size_t(D + 1);
        for (std::size_t i = 0; i < m; ++i) f[i] = form[i] + square_of_q * w[i];
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const double* g = form + m * (k + 1);
            const double x = seen.local[k];
            for (std::size_t i = 0; i < m; ++i) f[i] += x * g[i];
        }
        if (piece->rational) std::copy_n(w, m, f + m);
        Head whole;
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d) whole.hi[d] = 1;
        heads.assign(1, whole);
    }

    // Halves the block at the top along `axis`; the half with the smaller coefficient comes to the top.
    void halve(int axis) {
        const std::size_t top = heads.size() - 1, m = std::size_t(piece->products);
        scratch.blocks.resize(std::max(scratch.blocks.size(), (top + 2) * block_size()));
        double *left = block(top), *right = block(top + 1);
        std::size_t stride = 1;
        const int degree = 2 * piece->degree[std::size_t(axis)];
        for (int d = piece->params - 1; d > axis; --d)
            stride *= std::size_t(2 * piece->degree[std::size_t(d)] + 1);
        const std::size_t run = stride * std::size_t(degree + 1);
        for (std::size_t from = 0; from < block_size(); from += run)
            for (std::size_t at = 0; at < stride; ++at) {
                double *l = left + from + at, *r = right + from + at;
                for (int k = 0; k <= degree; ++k) {
                    r[std::size_t(degree - k) * stride] = l[std::size_t(degree) * stride];
                    for (int i = degree; i > k; --i)
                        l[std::size_t(i) * stride] =
                            0.5 * (l[std::size_t(i) * stride] + l[std::size_t(i - 1) * stride]);
                }
            }
        Head& h = heads.back();
        h.roundings += degree;
        Head other = h;
        const double middle =
            h.lo[std::size_t(axis)] + (h.hi[std::size_t(axis)] - h.lo[std::size_t(axis)]) / 2;
        h.hi[std::size_t(axis)] = other.lo[std::size_t(axis)] = middle;
        heads.push_back(other);
        if (*std::min_element(left, left + m) < *std::min_element(right, right + m)) {
            std::swap_ranges(left, left + block_size(), right);
            std::swap(heads[top], heads[top + 1]);
        }
    }

    // F = f - t w of the block, its least coefficient and where.
    struct Least {
        double value;
        std::size_t at;
    };
    Least shift(double t, const double* f) {
        const std::size_t m = std::size_t(piece->products);
        if (scratch.shifted.size() < m) scratch.shifted.resize(m);
        double* s = scratch.shifted.data();
        if (piece->rational)
            for (std::size_t i = 0; i < m; ++i) s[i] = f[i] - t * f[m + i];
        else
            for (std::size_t i = 0; i < m; ++i) s[i] = f[i] - t;
        const auto least = std::min_element(s, s + m);
        return {*least, std::size_t(least - s)};
    }

    Parameters in_block(const Parameters& t, const Head& h) const {
        Parameters x{};
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
            x[d] = std::clamp((t[d] - h.lo[d]) / (h.hi[d] - h.lo[d]), 0.0, 1.0);
        return x;
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
        const double squared_weight = piece->lightest * piece->lightest;
        const double reach = piece->radius + length * piece->heaviest;
        magnitude = reach * reach;
        double terms = 8 * piece->params + 4 * D + 24, most = 0;
        double product = 1;
        for (int d = 0; d < piece->params; ++d) {
            product *= piece->degree[std::size_t(d)] + 1;
            most = std::max(most, 2.0 * piece->degree[std::size_t(d)]);
        }
        rounding = 2 * 1.01 * (terms + product + 3);  // of both forms, and their difference
        push_whole();
        bool first = true;
        while (!heads.empty()) {
            const Head h = heads.back();
            const double t = threshold();
            const double* f = block(heads.size() - 1);
            const bool open = t == std::numeric_limits<double>::infinity();
            const double eps = (rounding + 2 * h.roundings) * kUnitRoundoff * magnitude;
            const Least least = shift(open ? 0 : t, f);
            const NearestForm form{piece->params, piece->degree, piece->products, scratch.shifted.data()};
            if (!open && least.value > eps) {
                proven = std::min(proven, t);
                heads.pop_back();
                continue;
            }
            if (first) {
                first = false;
                Parameters at = form.place(least.at, h.lo, h.hi);
                descend(h.lo, h.hi, at);
                continue;  // again, with what was found
            }
            // What this part has proven even if nothing more is done: F0 / W^2 >= T + F / W^2.
            const double lowest = least.value - eps;
            const double by_coefficients =
                t + std::min(lowest, 0.0) / squared_weight * (1 + 8 * kUnitRoundoff);
            const double room = 32 * (1 + most) * eps;
            if (lowest > -room || parts_left <= 0) {
                proven = std::min(proven, by_coefficients);
                heads.pop_back();
                continue;
            }
            --parts_left;
            // A corner inside the sphere: there is a nearer point.
            if (const auto corner = form.inner_corner(eps)) {
                Parameters at{};
                for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
                    at[d] = (*corner)[d] == 0 ? h.lo[d] : h.hi[d];
                const double before = best;
                descend(h.lo, h.hi, at);
                if (best < before * (1 - 1e-14)) continue;
            }
            if (form.convex(eps)) {
                Parameters at = best_at;
                bool here = best_piece == index;
                for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
                    here = here && at[d] >= h.lo[d] && at[d] <= h.hi[d];
                const double before = best;
                if (!here) {
                    at = form.place(least.at, h.lo, h.hi);
                    descend(h.lo, h.hi, at);
                    if (best < before * (1 - 1e-14)) continue;  // again, with the new threshold
                }
                double low = form.below_tangent(in_block(at, h), eps);
                if (here && !(low > -room)) {  // the best point so far was no foot of this part
                    at = form.place(least.at, h.lo, h.hi);
                    descend(h.lo, h.hi, at);
                    if (best < before * (1 - 1e-14)) continue;
                    low = form.below_tangent(in_block(at, h), eps);
                }
                if (low > -room) {
                    proven =
                        std::min(proven, t + std::min(low, 0.0) / squared_weight * (1 + 8 * kUnitRoundoff));
                    heads.pop_back();
                    continue;
                }
            }
            const int axis = form.longest_axis();
            const std::size_t k = std::size_t(axis);
            const double middle = h.lo[k] + (h.hi[k] - h.lo[k]) / 2;
            if (!(middle > h.lo[k] && middle < h.hi[k])) {  // as small as doubles can say
                proven = std::min(proven, by_coefficients);
                heads.pop_back();
                continue;
            }
            halve(axis);
        }
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
    NearestSearch<D> s{*this, scratch, {}, 0, std::scalbn(accuracy, -exponent_), max_parts};
    double far = 0;
    for (int k = 0; k < coords_; ++k) {
        s.q[std::size_t(k)] = std::scalbn(point[k], -exponent_);
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
        out.point[k] = std::scalbn(x, exponent_);
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
    out.point_error = std::scalbn(
        slip_ + std::sqrt(double(coords_)) * 1.03 * (2 * steps + 2) * kUnitRoundoff * largest_ * 2,
        exponent_);
    const double root = std::sqrt(std::max(s.proven, 0.0)) * (1 - 4 * kUnitRoundoff);
    const double lost = slip_ + 2 * std::sqrt(double(coords_)) * kUnitRoundoff * (s.size_of_q + largest_);
    const double lower = far > kFar ? std::max(0.0, far / 2 - largest_) : std::max(0.0, root - lost);
    out.lower_bound = std::min(std::scalbn(lower, exponent_), out.distance);
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
