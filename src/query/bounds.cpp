// Tight boxes by branch and bound.
//
// Idea. A Bezier block lies in the convex hull of its control points, and its corners are points of the
// object. So in a direction d the largest d . b_i of all blocks is not less than the maximum, and the largest
// corner not more. Halve the block with the largest d . b_i until the two agree: blocks away from the maximum
// are never looked at again, and near it the gap shrinks by 4 with every halving.
//
// Notation. e bounds the error of every number of a block (numerators and weights), u = 2^-53, w the smallest
// weight of the block, x the largest |coordinate| of its control points.
//
// Method. A heap of blocks by upper bound. A block whose gap is within the accuracy, or within its own
// rounding, ends the search: all others are lower. Blocks are halved along the axis where the control points
// bend most (the largest second difference of d . b).
//
// Accuracy. Extraction: e = (sum_d 12 p_d + 8) u max |number| unless the patch is a single Bezier block
// (derivative_bounds.cpp). A halving takes p rows of means: 1.01 p u max |number| each. Then d . b_i of
// projected control points is off by at most |d|_1 (e (1 + x) / (w - e) + 2 u x) plus (2 D + 2) u |d|_1 x for
// the sum; upper ends are raised by that and corners lowered. If w <= e, nothing is known of the block but
// what the control points of the whole object say; then their hull is the answer, and the slack is what it
// is.
//
// Cost. log4(1 / accuracy) halvings for an isolated maximum.
//
// References. [Lane Riesenfeld 1981] (hulls converge quadratically).
//
// Why not roots of the derivative? They work for curves only, and cost as much; this is one function for
// curves, surfaces, volumes and triangles. On surfaces with a maximum along a line both approaches need many
// pieces; max_pieces ends that, and the slack says so.
#include <freiform/query/bounds.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freiform {

namespace {

constexpr double kU = 0x1p-53;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class P>
double largest_number(std::span<const P> all) {
    double m = 0;
    for (const P& p : all) m = std::max(m, max_abs(p));
    return m;
}

struct Reach {
    double upper = -kInfinity, lower = -kInfinity;  // of the maximum of d . x over a block
    double rounding = 0;                            // in either of them
};

// Of control points with error e; corners are those that `is_corner` names.
template <class P, class F>
Reach reach(std::span<const P> all, const PointOf<P>& d, double e, F&& is_corner) {
    constexpr int D = Space<P>::kDim;
    double top = -kInfinity, corner = -kInfinity, x = 0, w = kInfinity, size = 0;
    for (int k = 0; k < D; ++k) size += std::abs(d[k]);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto p = project(all[i]);
        const double v = dot(d, p);
        top = std::max(top, v);
        if (is_corner(i)) corner = std::max(corner, v);
        x = std::max(x, max_abs(p));
        w = std::min(w, Space<P>::weight(all[i]));
    }
    double slack = e;
    if constexpr (Space<P>::kRational) {
        if (!(w > 2 * e)) return {kInfinity, -kInfinity, 0};
        slack = e * (1 + x) / (w - e) + 2 * kU * x;
    }
    int terms = 0;  // an axis direction adds nothing up
    for (int k = 0; k < D; ++k) terms += d[k] != 0;
    const double sum = terms > 1 || std::abs(size) != 1 ? (2 * D + 2) * kU * x : 0;
    slack = size * (1.01 * slack + sum);
    return {top + slack, corner - slack, slack};
}

// --- blocks of a tensor product ----------------------------------------------------------------------------

template <std::size_t N, class P>
struct Block {
    Net<N, P> net;
    double error = 0;

    Reach reach_along(const PointOf<P>& d) const {
        const Index<N> extent = net.extent();
        return reach(net.flat(), d, error, [&](std::size_t i) {
            bool corner = true;
            for (std::size_t k = N; k-- > 0;) {
                const std::size_t n = std::size_t(extent[k]);
                corner = corner && (i % n == 0 || i % n + 1 == n);
                i /= n;
            }
            return corner;
        });
    }
    // The axis with the largest second difference (or, of degree 1, first difference) of d . b.
    int axis_to_halve(const PointOf<P>& d) const {
        int best = 0;
        double most = -1;
        for (int axis = 0; axis < int(N); ++axis) {
            const int n = net.extent()[std::size_t(axis)];
            if (n < 2) continue;
            double bend = 0;
            each_fibre(axis, net.extent(), [&](const Index<N>& at) {
                const auto f = net.view().fibre(axis, at);
                const auto value = [&](int i) { return dot(d, project(f[i])); };
                if (n == 2) bend = std::max(bend, std::abs(value(1) - value(0)) * 0.25);
                for (int i = 0; i + 2 < n; ++i)
                    bend = std::max(bend, std::abs(value(i + 2) - 2 * value(i + 1) + value(i)) * (n - 1));
            });
            if (bend > most) most = bend, best = axis;
        }
        return best;
    }
    std::array<Block, 2> halves(const PointOf<P>& d) const {
        const int axis = axis_to_halve(d);
        const double e =
            error + 1.01 * net.extent()[std::size_t(axis)] * kU * largest_number<P>(net.flat()) + 0x1p-1060;
        std::array<Block, 2> two{Block{net, e}, Block{net, e}};
        each_fibre(axis, net.extent(), [&](const Index<N>& at) {
            keep_left(two[0].net.view().fibre(axis, at), 0.5);
            keep_right(two[1].net.view().fibre(axis, at), 0.5);
        });
        return two;
    }
};

template <std::size_t N, class P>
std::vector<Block<N, P>> blocks_of(const Patch<N, P>& patch) {
    const BezierPieces<N, P> pieces(patch);
    const double most = largest_number<P>(patch.net().flat());
    double roundings = 8;
    bool single = true;
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) {
        const BSplineBasis& b = patch.basis(int(d));
        roundings += 12 * b.degree();
        extent[d] = b.degree() + 1;
        single = single && b.size() == b.degree() + 1 && b.knot(0) == b.domain().lo &&
                 b.knot(2 * b.degree() + 1) == b.domain().hi;
    }
    std::vector<Block<N, P>> all;
    each_index(pieces.extent(), [&](const Index<N>& at) {
        Block<N, P> block{Net<N, P>(extent), single ? 0 : roundings * kU * most + 0x1p-1060};
        const auto from = pieces.net(at);
        const auto to = block.net.view();
        each_index(extent, [&](const Index<N>& i) { to(i) = from(i); });
        all.push_back(std::move(block));
    });
    return all;
}

// --- triangles ---------------------------------------------------------------------------------------------

template <class P>
struct TriangleBlock {
    SimplexPatch<2, P> patch;
    double error = 0;

    Reach reach_along(const PointOf<P>& d) const {
        const std::size_t n = std::size_t(patch.degree()), last = patch.coefficients().size() - 1;
        // The corners are the first, the last, and the first of the last row.
        return reach(patch.coefficients(), d, error,
                     [&](std::size_t i) { return i == 0 || i == last || i == last - n; });
    }
    std::vector<TriangleBlock> halves(const PointOf<P>&) const {
        // restrict_to takes 3 n rows of sums of three products with exact weights.
        const double e =
            error + 12.2 * patch.degree() * kU * largest_number<P>(patch.coefficients()) + 0x1p-1060;
        std::vector<TriangleBlock> four;
        for (auto& part : split_in_four(patch)) four.push_back({part, e});
        return four;
    }
};

// --- branch and bound --------------------------------------------------------------------------------------

// The maximum of d . x lies between lower and upper.
template <class Blocks, class D>
Reach maximum(const Blocks& blocks, const D& d, double accuracy, int max_pieces) {
    struct Entry {
        Reach reach;
        typename Blocks::value_type block;
    };
    const auto below = [](const Entry& a, const Entry& b) { return a.reach.upper < b.reach.upper; };
    std::vector<Entry> heap;
    double lower = -kInfinity;
    const auto push = [&](typename Blocks::value_type block, double limit) {
        Reach r = block.reach_along(d);
        r.upper = std::min(r.upper, limit);
        lower = std::max(lower, r.lower);
        if (r.upper <= lower) return;
        heap.push_back({r, std::move(block)});
        std::push_heap(heap.begin(), heap.end(), below);
    };
    for (const auto& b : blocks) push(b, kInfinity);
    for (int pieces = 0; !heap.empty() && pieces < max_pieces; ++pieces) {
        const Reach top = heap.front().reach;
        if (top.upper - lower <= std::max(accuracy, 2.5 * top.rounding)) break;
        std::pop_heap(heap.begin(), heap.end(), below);
        const Entry entry = std::move(heap.back());
        heap.pop_back();
        for (auto& half : entry.block.halves(d)) push(std::move(half), top.upper);
    }
    double upper = lower;
    if (!heap.empty()) upper = std::max(upper, heap.front().reach.upper);
    return {upper, lower, 0};
}

template <class P>
std::vector<PointOf<P>> control_points(std::span<const P> all) {
    std::vector<PointOf<P>> out;
    for (const P& p : all) out.push_back(project(p));
    return out;
}

// The range of d . x; `control` contains the object, up to 2 u of each coordinate.
template <class Blocks, int D>
Extent extent_of(const Blocks& blocks, const Vec<D>& d, std::span<const Vec<D>> control, double accuracy,
                 int max_pieces) {
    Extent out;
    double side[2];
    for (const int s : {0, 1}) {
        const Vec<D> towards = s == 0 ? -d : d;
        Reach r = maximum(blocks, towards, accuracy, max_pieces);
        const Reach hull = reach<Vec<D>>(control, towards, 0, [](std::size_t) { return false; });
        double scale = 0, size = 0;
        for (const Vec<D>& p : control) scale = std::max(scale, max_abs(p));
        for (int k = 0; k < D; ++k) size += std::abs(d[k]);
        r.upper = std::min(r.upper, hull.upper + 2.1 * kU * scale * size);
        side[s] = r.upper;
        // A lower end that is not known leaves the whole hull open.
        out.slack = std::max(out.slack, r.upper - r.lower);
    }
    out.range = {0.0 - side[0], side[1]};
    out.slack = std::max(0.0, out.slack) * (1 + 4 * kU);
    return out;
}

template <int D, class Blocks>
TightBox<D> box_of(const Blocks& blocks, std::span<const Vec<D>> control, double accuracy, int max_pieces) {
    TightBox<D> out;
    for (int k = 0; k < D; ++k) {
        Vec<D> d{};
        d[k] = 1;
        const Extent e = extent_of(blocks, d, control, accuracy, max_pieces);
        out.box.lo[k] = e.range.lo;
        out.box.hi[k] = e.range.hi;
        out.slack = std::max(out.slack, e.slack);
    }
    return out;
}

Result<void> check_accuracy(double accuracy) {
    if (accuracy >= 0) return {};
    return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length >= 0"));
}

}  // namespace

template <std::size_t N, class P>
Result<TightBox<Space<P>::kDim>> tight_box(const Patch<N, P>& patch, double accuracy, int max_pieces) {
    if (auto ok = check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    const auto control = control_points<P>(patch.net().flat());
    return box_of<Space<P>::kDim>(blocks_of(patch), std::span(control), accuracy, max_pieces);
}

template <class P>
Result<TightBox<Space<P>::kDim>> tight_box(const SimplexPatch<2, P>& patch, double accuracy, int max_pieces) {
    if (auto ok = check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    const auto control = control_points<P>(patch.coefficients());
    const std::vector<TriangleBlock<P>> blocks{{patch, 0}};
    return box_of<Space<P>::kDim>(blocks, std::span(control), accuracy, max_pieces);
}

template <std::size_t N, class P>
Result<Extent> extent_along(const Patch<N, P>& patch, const PointOf<P>& direction, double accuracy,
                            int max_pieces) {
    if (auto ok = check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    if (!is_finite(direction))
        return refuse(RefusalKind::nonfinite, "direction", "has a coordinate that is not finite");
    const auto control = control_points<P>(patch.net().flat());
    return extent_of(blocks_of(patch), direction, std::span(control), accuracy, max_pieces);
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

}  // namespace freiform
