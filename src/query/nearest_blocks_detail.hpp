// Parts of a Bezier piece and F = |x - q|^2 W^2 - T W^2 on them, halved and kept on a stack: what the
// searches for nearest and farthest points share. See nearest_search.cpp for the notation and for the bound
// of the rounding.
#pragma once
#include "query/nearest_form_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace freiform::detail {

template <class F>
auto NearestTree::with_coords(F&& f) const {
    switch (coords_) {
        case 1:
            return f(std::integral_constant<int, 1>{});
        case 2:
            return f(std::integral_constant<int, 2>{});
        case 3:
            return f(std::integral_constant<int, 3>{});
        default:
            return f(std::integral_constant<int, 4>{});
    }
}

template <int D>
struct NearestBlocks {
    using Parameters = NearestTree::Parameters;

    // Farther away squares would overflow: seen from there the objects are a point.
    static constexpr double kFar = 0x1p400;

    const NearestTree& tree;
    NearestTree::Scratch& scratch;
    NearestTree::Coords q{};
    double far = 0;  // the largest coordinate of the point; of q it is at most kFar

    // Of the piece at hand.
    SeenPiece<D> seen{};
    const NearestTree::Piece* piece = nullptr;  // seen.piece
    int index = 0;
    double reach = 0, rounding = 0, magnitude = 0;

    // Parts of the piece, and F on them, on a stack.
    struct Head {
        Parameters lo{}, hi{};
        std::array<int, kMostParams> degree{};  // 0 along axes where lo == hi
        int count = 1;                          // of coefficients
        double roundings = 0;                   // of halving, in units of u M
        // Of a part whose F was made anew (nearest_local_detail.hpp), else 0 and that of the piece: M, more
        // error of F, and bounds of W on all of the part that this is, or is a face of.
        double magnitude = 0, offset = 0, lightest = 0, heaviest = 0;
        bool anew = false;  // and that not for a larger part
    };
    std::vector<Head> heads{};

    double* block(std::size_t i) { return scratch.blocks.data() + i * std::size_t(piece->products); }

    // F on all of the piece.
    void push_whole(double t) {
        magnitude = std::max(reach * reach, t * piece->heaviest * piece->heaviest);
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
        begin_with_whole();
    }
    // W^2 on all of the piece, instead of F.
    void push_weights() {
        const std::size_t m = std::size_t(piece->products);
        if (scratch.blocks.size() < m) scratch.blocks.resize(m);
        std::copy_n(tree.numbers_.data() + piece->forms + m * std::size_t(D + 1), m, block(0));
        begin_with_whole();
    }
    void begin_with_whole() {
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
        h.anew = false;
        Head other = h;
        h.hi[axis] = other.lo[axis] = h.lo[axis] + (h.hi[axis] - h.lo[axis]) / 2;
        heads.push_back(other);
    }

    // The block at the top, once more.
    void copy_top() {
        const std::size_t top = heads.size() - 1, n = std::size_t(piece->products);
        scratch.blocks.resize(std::max(scratch.blocks.size(), (top + 2) * n));
        std::copy_n(block(top), std::size_t(heads[top].count), block(top + 1));
        heads.push_back(Head(heads[top]));
    }
    // Keeps of the block at the top the face at the low or the high end of the axis.
    void keep_face(std::size_t axis, bool high) { keep_face(axis, high, heads.size() - 1); }
    void keep_face(std::size_t axis, bool high, std::size_t which) {
        Head& h = heads[which];
        double* f = block(which);
        const Sides s = sides(h, axis);
        for (std::size_t o = 0; o < s.outer; ++o)
            for (std::size_t i = 0; i < s.inner; ++i)
                f[o * s.inner + i] = f[(o * s.size + (high ? s.size - 1 : 0)) * s.inner + i];
        h.degree[axis] = 0;
        h.anew = false;
        h.count = int(s.outer * s.inner);
        (high ? h.lo : h.hi)[axis] = high ? h.hi[axis] : h.lo[axis];
    }

    Parameters in_block(const Parameters& t, const Head& h) const {
        Parameters x{};
        for (std::size_t d = 0; d < std::size_t(piece->params); ++d)
            if (h.hi[d] > h.lo[d]) x[d] = std::clamp((t[d] - h.lo[d]) / (h.hi[d] - h.lo[d]), 0.0, 1.0);
        return x;
    }

    void look_from(const double* point) {
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            q[k] = tree.divided(point[k]);
            far = std::max(far, std::abs(q[k]));
        }
        if (far > kFar)
            for (std::size_t k = 0; k < std::size_t(D); ++k) q[k] = std::clamp(q[k], -kFar, kFar);
    }
    // Between distances of pieces from q' + c and of objects from q.
    double lost() const {
        return tree.slip_ + 2 * std::sqrt(double(D)) * kUnitRoundoff * (std::min(far, kFar) + tree.largest_);
    }

    void look_at(int i) {
        index = i;
        piece = &tree.pieces_[std::size_t(i)];
        seen.piece = piece;
        seen.coefficients = tree.numbers_.data() + piece->coefficients;
        double length = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            seen.local[k] = q[k] - piece->centre[k];
            length += seen.local[k] * seen.local[k];
        }
        reach = piece->radius + std::sqrt(length) * (1 + 8 * kUnitRoundoff) * piece->heaviest;
        const double terms = 8 * piece->params + 4 * D + 24;
        // Of both forms, and their difference.
        rounding = 2 * 1.01 * (terms + double(piece->control_points()) + 3);
    }
    double error_of(const Head& h) const {
        const double size = h.magnitude > 0 ? h.magnitude : magnitude;
        return (rounding + 2 * h.roundings) * kUnitRoundoff * size + h.offset;
    }
    NearestForm top_form() {
        return {piece->params, heads.back().degree, heads.back().count, block(heads.size() - 1)};
    }
    double largest_degree() const {
        return 2.0 * *std::max_element(piece->degree.begin(), piece->degree.begin() + piece->params);
    }

    // A lower bound of the squared distance between q and the box.
    double box_distance(const NearestTree::Node& n) const {
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const double x = std::max({n.lo[k] - q[k], q[k] - n.hi[k], 0.0});
            s += x * x;
        }
        return s * (1 - 8 * kUnitRoundoff);
    }
    // An upper bound of that between q and any point of the box.
    double box_reach(const NearestTree::Node& n) const {
        double s = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            const double x = std::max(n.hi[k] - q[k], q[k] - n.lo[k]);
            s += x * x;
        }
        return s * (1 + 8 * kUnitRoundoff);
    }
};

// The answer for a point of a piece, but for its bound.
template <int D>
NearestFound NearestTree::found_at(int piece, const Parameters& at, const double* point) const {
    NearestFound out;
    const Piece& p = pieces_[std::size_t(piece)];
    const LocalJet j = SeenPiece<D>{&p, numbers_.data() + p.coefficients, {}}.jet(at);
    out.object = p.object;
    for (std::size_t d = 0; d < std::size_t(p.params); ++d) out.at[d] = in_domain(p.domain[d], at[d]);
    if (p.triangle) {
        const double u = out.at[0], v = out.at[1];
        out.at = {u * (1 - v), u * v, 0};
    }
    Coords off{};
    double scale = 0;
    for (std::size_t k = 0; k < std::size_t(D); ++k) {
        const double x = p.centre[k] + j.value[k];
        out.point[k] = multiplied(x);
        off[k] = out.point[k] / 2 - point[k] / 2;  // halves do not overflow
        scale = std::max(scale, std::abs(off[k]));
    }
    double sum = 0;
    if (scale > 0)
        for (std::size_t k = 0; k < std::size_t(D); ++k) sum += (off[k] / scale) * (off[k] / scale);
    out.distance = 2 * (scale * std::sqrt(sum));
    // Below the normal range halves of coordinates and the distance are rounded as well.
    out.point_error = multiplied(slip_ + evaluation_error(p)) + 8 * underflow();
    return out;
}

}  // namespace freiform::detail
