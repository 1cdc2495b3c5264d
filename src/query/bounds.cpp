// Tight boxes by branch and bound.
//
// Idea. In a direction d the object is a function d . x of its parameters. The largest value of a Bezier
// block of it is at most its largest control value, and its corners are values of the object. So the largest
// control value of all blocks is not less than the maximum, and the largest corner not more. Halve the block
// with the largest control value until the two agree: blocks away from the maximum are never looked at again,
// and near it the gap shrinks by 4 with every halving.
//
// Notation. a_i = d . (numerators), w_i weights (1 of polynomials), q_i = a_i / w_i control values; e, f
// bound the errors of every a_i and w_i of a block; u = 2^-53, w the smallest weight of the block, x the
// largest |q_i|.
//
// Method. A heap of blocks by upper bound. A block whose gap is within the accuracy, or within its own
// rounding, ends the search: all others are lower. Blocks are halved along the axis where the control values
// bend most (the largest second difference of q). A curve is a volume that is constant along two axes.
//
// Accuracy. Extraction: unless the patch is a single Bezier block, a number is off by at most (sum_d 12 p_d +
// 8) u times the largest of its kind (derivative_bounds.cpp). a_i: |d_k| times that for every coordinate, and
// (2 D + 2) u |d|_1 max |number| for the sum, which the direction of an axis does not need. A halving takes p
// rows of means: 1.01 p u max |a_i| and 1.01 p u max |w_i| each. Then, with A, W the exact numbers,
//     |A/W - a/w| = |(A - a) + (a/w) (w - W)| / W <= (e + x f) / (w - f),
// and 2 u x for the rounding of the quotient; upper ends are raised by that and corners lowered. If w <= 2 f,
// nothing is known of the block but what the control points of the whole object say; then their hull is the
// answer, and the slack is what it is.
//
// Cost. log4(1 / accuracy) halvings for an isolated maximum.
//
// References. [Lane Riesenfeld 1981] (hulls converge quadratically).
//
// Why not roots of the derivative? They work for curves only, and cost as much; this is one function for
// curves, surfaces, volumes and triangles. On surfaces with a maximum along a line both approaches need many
// pieces; max_pieces ends that, and the slack says so. Why not blocks of whole points? All but one or two of
// their numbers are halved for nothing, and a program for every number of coordinates is needed.

#include <freiform/core/constants.hpp>
#include <freiform/core/tuples.hpp>
#include <freiform/query/bounds.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freiform {

namespace {

constexpr double kLost = 0x1p-1060;

// --- blocks of one coordinate: P is Vec<1> or Hom<1> -------------------------------------------------------

// Bounds of errors of numerators and weights.
struct Errors {
    double numerator = 0, weight = 0;

    // What `roundings` of the largest numbers add.
    template <class P>
    Errors grown(double roundings, std::span<const P> all) const {
        double a = 0, w = 0;
        for (const P& p : all) a = std::max(a, std::abs(p[0])), w = std::max(w, Space<P>::weight(p));
        return {numerator + roundings * kUnitRoundoff * a + kLost,
                weight + roundings * kUnitRoundoff * w + kLost};
    }
};

struct Reach {
    double upper = -kInfinity, lower = -kInfinity;  // of the maximum of d . x over a block
    double rounding = 0;                            // in either of them
};

// Corners are those that `is_corner` names.
template <class P, class F>
Reach reach(std::span<const P> all, const Errors& error, F&& is_corner) {
    double top = -kInfinity, corner = -kInfinity, x = 0, w = kInfinity;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double v = project(all[i])[0];
        top = std::max(top, v);
        if (is_corner(i)) corner = std::max(corner, v);
        x = std::max(x, std::abs(v));
        w = std::min(w, Space<P>::weight(all[i]));
    }
    double slack = error.numerator;
    if constexpr (Space<P>::kRational) {
        if (!(w > 2 * error.weight)) return {kInfinity, -kInfinity, 0};
        slack = (error.numerator + x * error.weight) / (w - error.weight) + 2 * kUnitRoundoff * x;
    }
    slack *= 1.01;
    return {top + slack, corner - slack, slack};
}

template <class P>
struct Block {
    Net<3, P> net;
    Errors error;

    Reach reach() const {
        const Index<3> extent = net.extent();
        return freiform::reach(net.flat(), error, [&](std::size_t i) {
            bool corner = true;
            for (std::size_t k = 3; k-- > 0;) {
                const std::size_t n = std::size_t(extent[k]);
                corner = corner && (i % n == 0 || i % n + 1 == n);
                i /= n;
            }
            return corner;
        });
    }
    // The axis with the largest second difference (or, of degree 1, first difference) of control values.
    int axis_to_halve() const {
        int best = 0;
        double most = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const int n = net.extent()[std::size_t(axis)];
            if (n < 2) continue;
            double bend = 0;
            each_fibre(axis, net.extent(), [&](const Index<3>& at) {
                const auto f = net.view().fibre(axis, at);
                const auto value = [&](int i) { return project(f[i])[0]; };
                if (n == 2) bend = std::max(bend, std::abs(value(1) - value(0)) * 0.25);
                for (int i = 0; i + 2 < n; ++i)
                    bend = std::max(bend, std::abs(value(i + 2) - 2 * value(i + 1) + value(i)) * (n - 1));
            });
            if (bend > most) most = bend, best = axis;
        }
        return best;
    }
    std::array<Block, 2> halves() const {
        const int axis = axis_to_halve();
        const Errors e = error.grown(1.01 * net.extent()[std::size_t(axis)], net.flat());
        std::array<Block, 2> two{Block{net, e}, Block{net, e}};
        each_fibre(axis, net.extent(), [&](const Index<3>& at) {
            keep_left(two[0].net.view().fibre(axis, at), 0.5);
            keep_right(two[1].net.view().fibre(axis, at), 0.5);
        });
        return two;
    }
};

template <class P>
struct TriangleBlock {
    SimplexPatch<2, P> patch;
    Errors error;

    Reach reach() const {
        const std::size_t n = std::size_t(patch.degree()), last = patch.coefficients().size() - 1;
        // The corners are the first, the last, and the first of the last row.
        return freiform::reach(patch.coefficients(), error,
                               [&](std::size_t i) { return i == 0 || i == last || i == last - n; });
    }
    std::vector<TriangleBlock> halves() const {
        // restrict_to takes 3 n rows of sums of three products with exact weights.
        const Errors e = error.grown(12.2 * patch.degree(), patch.coefficients());
        std::vector<TriangleBlock> four;
        for (auto& part : split_in_four(patch)) four.push_back({part, e});
        return four;
    }
};

// --- branch and bound --------------------------------------------------------------------------------------

// The maximum lies between lower and upper.
template <class B>
Reach maximum(std::vector<B> blocks, double accuracy, int max_pieces) {
    struct Entry {
        Reach reach;
        B block;
    };
    const auto below = [](const Entry& a, const Entry& b) { return a.reach.upper < b.reach.upper; };
    std::vector<Entry> heap;
    double lower = -kInfinity;
    const auto push = [&](B block, double limit) {
        Reach r = block.reach();
        r.upper = std::min(r.upper, limit);
        lower = std::max(lower, r.lower);
        if (r.upper <= lower) return;
        heap.push_back({r, std::move(block)});
        std::push_heap(heap.begin(), heap.end(), below);
    };
    for (B& b : blocks) push(std::move(b), kInfinity);
    for (int pieces = 0; !heap.empty() && pieces < max_pieces; ++pieces) {
        const Reach top = heap.front().reach;
        if (top.upper - lower <= std::max(accuracy, 2.5 * top.rounding)) break;
        std::pop_heap(heap.begin(), heap.end(), below);
        const Entry entry = std::move(heap.back());
        heap.pop_back();
        for (auto& half : entry.block.halves()) push(std::move(half), top.upper);
    }
    double upper = lower;
    if (!heap.empty()) upper = std::max(upper, heap.front().reach.upper);
    return {upper, lower, 0};
}

// --- objects -----------------------------------------------------------------------------------------------

// The Bezier blocks of an object, one after the other.
struct Pieces {
    Tuples control;            // the coefficients of the object itself
    std::vector<double> all;   // as many numbers in a tuple as `control` has
    Index<3> extent{1, 1, 1};  // of a block; of triangles the number of coefficients
    int triangle_degree = -1;
    double roundings = 0;  // of the largest number of its kind, in every number

    std::size_t per_block() const { return std::size_t(count_of(extent)); }
};

Pieces pieces_of(std::span<const BSplineBasis> bases, const Tuples& control) {
    Pieces out{control, {control.all.begin(), control.all.end()}};
    Index<3> size{1, 1, 1}, count{1, 1, 1};
    bool single = true;
    double roundings = 8;
    for (std::size_t d = 0; d < bases.size(); ++d) size[d] = bases[d].size();
    for (std::size_t d = 0; d < bases.size(); ++d) {
        const BSplineBasis& b = bases[d];
        const BandMap map = to_bezier(b).map;
        std::size_t blocks = 1, run = std::size_t(control.size);
        for (std::size_t k = 0; k < 3; ++k)
            if (k != d) (k < d ? blocks : run) *= std::size_t(size[k]);
        std::vector<double> next(blocks * std::size_t(map.rows()) * run);
        map.apply(out.all.data(), next.data(), run, blocks);
        out.all = std::move(next);
        size[d] = map.rows();
        out.extent[d] = b.degree() + 1;
        count[d] = size[d] / out.extent[d];
        roundings += 12 * b.degree();
        single = single && b.size() == b.degree() + 1 && b.knot(0) == b.domain().lo &&
                 b.knot(2 * b.degree() + 1) == b.domain().hi;
    }
    out.roundings = single ? 0 : roundings;
    const Tuples whole{out.all, control.size, control.rational};
    std::vector<double> sorted;
    sorted.reserve(out.all.size());
    each_index(count, [&](const Index<3>& block) {
        each_index(out.extent, [&](const Index<3>& i) {
            std::size_t at = 0;
            for (std::size_t d = 0; d < 3; ++d)
                at = at * std::size_t(size[d]) + std::size_t(block[d] * out.extent[d] + i[d]);
            sorted.insert(sorted.end(), whole[at], whole[at] + control.size);
        });
    });
    out.all = std::move(sorted);
    return out;
}

template <class P>
P coefficient(double numerator, double weight) {
    if constexpr (Space<P>::kRational)
        return {{numerator, weight}};
    else
        return {{numerator}};
}

// The maximum of d . x.
template <class P>
Reach maximum_along(const Pieces& pieces, const Vec<4>& d, double accuracy, int max_pieces) {
    const Tuples all{pieces.all, pieces.control.size, pieces.control.rational};
    // Errors of the numbers, from the largest of each kind.
    Vec<4> most;
    double heaviest = 0, size = 0, largest = 0;
    for (std::size_t i = 0; i < pieces.control.count(); ++i) {
        const Vec<4> p = pieces.control.numerator(i);
        for (int k = 0; k < 4; ++k) most[k] = std::max(most[k], std::abs(p[k]));
        heaviest = std::max(heaviest, pieces.control.weight(i));
    }
    int terms = 0, only = 0;
    Errors error;
    for (int k = 0; k < all.dim(); ++k) {
        if (d[k] == 0) continue;
        ++terms, only = k;
        size += std::abs(d[k]);
        largest = std::max(largest, most[k]);
        error.numerator += std::abs(d[k]) * (1.01 * pieces.roundings * kUnitRoundoff * most[k]);
    }
    error.weight = pieces.roundings * kUnitRoundoff * heaviest;
    if (pieces.roundings > 0) error.numerator += (1 + size) * kLost, error.weight += kLost;
    const bool axis = terms == 1 && size == 1;
    if (!axis && terms > 0)
        error.numerator += (2 * all.dim() + 2) * kUnitRoundoff * size * largest * 1.01 + kLost;

    std::vector<P> values;
    values.reserve(all.count());
    for (std::size_t i = 0; i < all.count(); ++i)
        values.push_back(
            coefficient<P>(axis ? d[only] * all[i][only] : dot(d, all.numerator(i)), all.weight(i)));
    if (pieces.triangle_degree >= 0) {
        std::vector<TriangleBlock<P>> one;
        one.push_back({SimplexPatch<2, P>::trusted(pieces.triangle_degree, std::move(values)), error});
        return maximum(std::move(one), accuracy, max_pieces);
    }
    std::vector<Block<P>> blocks;
    const std::ptrdiff_t n = std::ptrdiff_t(pieces.per_block());
    for (auto at = values.begin(); at != values.end(); at += n)
        blocks.push_back({Net<3, P>(pieces.extent, std::vector<P>(at, at + n)), error});
    return maximum(std::move(blocks), accuracy, max_pieces);
}

// The largest d . x of the control points, which are off by 2 u of each coordinate.
double hull_along(const Tuples& control, const Vec<4>& d) {
    double top = -kInfinity, scale = 0, size = 0;
    int terms = 0;
    for (std::size_t i = 0; i < control.count(); ++i) {
        const Vec<4> p = control.point(i);
        top = std::max(top, dot(d, p));
        scale = std::max(scale, max_abs(p));
    }
    for (int k = 0; k < 4; ++k) size += std::abs(d[k]), terms += d[k] != 0;
    const double sum = terms > 1 || size != 1 ? (2 * control.dim() + 2) * kUnitRoundoff * scale : 0;
    return top + size * sum + 2.1 * kUnitRoundoff * scale * size;
}

// The range of d . x.
Extent extent_of(const Pieces& pieces, const Vec<4>& d, double accuracy, int max_pieces) {
    Extent out;
    double side[2];
    for (const int s : {0, 1}) {
        const Vec<4> towards = s == 0 ? -d : d;
        Reach r = pieces.control.rational ? maximum_along<Hom<1>>(pieces, towards, accuracy, max_pieces)
                                          : maximum_along<Vec<1>>(pieces, towards, accuracy, max_pieces);
        r.upper = std::min(r.upper, hull_along(pieces.control, towards));
        side[s] = r.upper;
        // A lower end that is not known leaves the whole hull open.
        out.slack = std::max(out.slack, r.upper - r.lower);
    }
    out.range = {0.0 - side[0], side[1]};
    out.slack = std::max(0.0, out.slack) * (1 + 4 * kUnitRoundoff);
    return out;
}

// Coordinates that the object does not have stay 0.
TightBox<4> box_of(const Pieces& pieces, double accuracy, int max_pieces) {
    TightBox<4> out;
    for (int k = 0; k < pieces.control.dim(); ++k) {
        Vec<4> d;
        d[k] = 1;
        const Extent e = extent_of(pieces, d, accuracy, max_pieces);
        out.box.lo[k] = e.range.lo;
        out.box.hi[k] = e.range.hi;
        out.slack = std::max(out.slack, e.slack);
    }
    return out;
}

template <int D>
TightBox<D> in_space(const TightBox<4>& box) {
    TightBox<D> out;
    for (int k = 0; k < D; ++k) out.box.lo[k] = box.box.lo[k], out.box.hi[k] = box.box.hi[k];
    out.slack = box.slack;
    return out;
}

}  // namespace

template <std::size_t N, class P>
Result<TightBox<Space<P>::kDim>> tight_box(const Patch<N, P>& patch, double accuracy, int max_pieces) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    return in_space<Space<P>::kDim>(
        box_of(pieces_of(patch.bases(), tuples(patch.net().flat())), accuracy, max_pieces));
}

template <class P>
Result<TightBox<Space<P>::kDim>> tight_box(const SimplexPatch<2, P>& patch, double accuracy, int max_pieces) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    const Tuples all = tuples(patch.coefficients());
    const Pieces one{all, {all.all.begin(), all.all.end()}, {int(all.count()), 1, 1}, patch.degree(), 0};
    return in_space<Space<P>::kDim>(box_of(one, accuracy, max_pieces));
}

template <std::size_t N, class P>
Result<Extent> extent_along(const Patch<N, P>& patch, const PointOf<P>& direction, double accuracy,
                            int max_pieces) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    if (!is_finite(direction))
        return refuse(RefusalKind::nonfinite, "direction", "has a coordinate that is not finite");
    Vec<4> d;
    for (int k = 0; k < Space<P>::kDim; ++k) d[k] = direction[k];
    return extent_of(pieces_of(patch.bases(), tuples(patch.net().flat())), d, accuracy, max_pieces);
}

#define FF_INSTANTIATE_BOUNDS(N, P)                                                       \
    template Result<TightBox<Space<P>::kDim>> tight_box(const Patch<N, P>&, double, int); \
    template Result<Extent> extent_along(const Patch<N, P>&, const PointOf<P>&, double, int);
#define FF_INSTANTIATE_DIMENSION(D)                                                      \
    FF_INSTANTIATE_BOUNDS(1, Vec<D>)                                                     \
    FF_INSTANTIATE_BOUNDS(1, Hom<D>)                                                     \
    FF_INSTANTIATE_BOUNDS(2, Vec<D>)                                                     \
    FF_INSTANTIATE_BOUNDS(2, Hom<D>)                                                     \
    FF_INSTANTIATE_BOUNDS(3, Vec<D>)                                                     \
    FF_INSTANTIATE_BOUNDS(3, Hom<D>)                                                     \
    template Result<TightBox<D>> tight_box(const SimplexPatch<2, Vec<D>>&, double, int); \
    template Result<TightBox<D>> tight_box(const SimplexPatch<2, Hom<D>>&, double, int);
FF_INSTANTIATE_DIMENSION(1)
FF_INSTANTIATE_DIMENSION(2)
FF_INSTANTIATE_DIMENSION(3)
FF_INSTANTIATE_DIMENSION(4)
#undef FF_INSTANTIATE_BOUNDS
#undef FF_INSTANTIATE_DIMENSION

}  // namespace freiform
