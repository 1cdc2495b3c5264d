// Jumps of derivatives across the knots of one axis of a net: how many derivatives really are continuous,
// whatever the multiplicities say.
//
// Idea: across a knot the derivative of order k by this parameter jumps by a linear function of the
// coefficients of a fibre: the difference of two rows of weights, one from either span. Done for all fibres
// it is the net of a patch with one parameter less, whose largest coefficient bounds the jump along the whole
// line, and which is 0 if and only if there is no jump. One function for curves, surfaces and volumes.
//
// Notation: A numerator, w weight, X = A / w, o a point of the net, A^ = A - o w, r >= |X - o|. If A^ and w
// jump by a and v, X - o jumps by (a - (X - o) v) / w': at most (|a| + r |v|) / min w.
//
// Accuracy: `Bounded` arithmetic; every coordinate of a coefficient is granted `roundings` of the largest
// such coordinate of the net, counted once for both sides. Cost: (degree + 1)(degree + 2) products per fibre
// and knot.
//
// Why not the numbers of the knot vector alone: knots stay after an insertion though nothing is broken there,
// and files write splines as Bezier pieces with full knots.
//
// References: [PT97, 2.5], [Lyche & Morken 2018, ch. 3].
#include "knot_window_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/query/continuity.hpp>
#include <freiform/spline/wide.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// Weights of the jump of the derivative of order k over the coefficients first, first + 1, ..
struct JumpRow {
    int first = 0;
    std::vector<Bounded> weight;
};

// A knot, with the spans on its two sides; of the seam of a closed basis they are a period apart.
struct Place {
    double at = 0, before_at = 0;
    int before = 0, after = 0, shift = 0;  // spans; what index `after` has, counted on from `before`
    bool seam = false;
};
Place place_at(const BSplineBasis& basis, double at, bool seam) {
    Place k{at, seam ? basis.domain().hi : at, 0, basis.span(at), seam ? basis.size() : 0, seam};
    k.before = basis.span(k.before_at);
    while (k.before > basis.degree() && basis.knot(k.before) >= k.before_at) --k.before;
    return k;
}

// After less before.
JumpRow jump_row(const BSplineBasis& basis, const Place& k, int order) {
    const int p = basis.degree(), right = k.after + k.shift - k.before;
    const detail::KnotWindow before(basis, k.before, k.before_at, k.seam),
        after(basis, k.after, k.at, k.seam);
    std::vector<Bounded> b(std::size_t(p) + 1), a(std::size_t(p) + 1);
    weights_in_span(before, k.before, before.at(), order, b.data());
    weights_in_span(after, k.after, after.at(), order, a.data());
    JumpRow row{k.before - p, std::vector<Bounded>(std::size_t(right + p + 1))};
    for (int i = 0; i <= p; ++i) {
        row.weight[std::size_t(i)] -= b[std::size_t(i)];
        row.weight[std::size_t(right + i)] += a[std::size_t(i)];
    }
    return row;
}

// What coefficients of a net are measured by.
template <class P>
struct KnotFrame {
    PointOf<P> origin{};
    double radius = 0, least_weight = 1;
    P grant{};
};

template <std::size_t N, class P>
KnotFrame<P> frame_of(const Patch<N, P>& patch, double roundings) {
    KnotFrame<P> f;
    f.origin = project(patch.net().flat()[0]);
    f.least_weight = std::numeric_limits<double>::infinity();
    for (const P& q : patch.net().flat()) {
        f.radius = std::max(f.radius, norm(project(q) - f.origin));
        f.least_weight = std::min(f.least_weight, Space<P>::weight(q));
        for (int c = 0; c < P::kCoords; ++c) f.grant[c] = std::max(f.grant[c], std::abs(q[c]));
    }
    f.grant *= roundings * kUnitRoundoff;
    return f;
}

template <class P>
Jump jump_of(const KnotFrame<P>& frame, const JumpRow& row, Fibre<const P> fibre) {
    constexpr int D = Space<P>::kDim;
    std::array<Bounded, std::size_t(D) + 1> sum{};
    for (std::size_t i = 0; i < row.weight.size(); ++i) {
        if (row.weight[i].is_zero()) continue;
        const P& q = fibre[(row.first + int(i)) % fibre.size];
        const Bounded w =
            Space<P>::kRational ? Bounded(q[P::kCoords - 1], frame.grant[P::kCoords - 1]) : Bounded(1);
        for (int c = 0; c < D; ++c)
            sum[std::size_t(c)] +=
                row.weight[i] * (Bounded(q[c], frame.grant[c]) - w * Bounded(frame.origin[c]));
        if (Space<P>::kRational) sum[std::size_t(D)] += row.weight[i] * w;
    }
    Vec<D> size, slack;
    for (int c = 0; c < D; ++c) size[c] = sum[std::size_t(c)].value, slack[c] = sum[std::size_t(c)].bound;
    const double s = norm(size) + frame.radius * std::abs(sum[std::size_t(D)].value);
    const double e = norm(slack) + frame.radius * sum[std::size_t(D)].bound + (D + 4) * kUnitRoundoff * s;
    return {s / frame.least_weight, detail::above(e / frame.least_weight)};
}

template <std::size_t N, class P>
KnotLine line_at(const Patch<N, P>& patch, int axis, const KnotFrame<P>& frame, double at, bool seam,
                 double tolerance) {
    const BSplineBasis& basis = patch.basis(axis);
    const Place place = place_at(basis, at, seam);
    const double h = std::min(basis.knot(place.before + 1) - basis.knot(place.before),
                              basis.knot(place.after + 1) - basis.knot(place.after));

    KnotLine line{at, basis.multiplicity(at), seam, {}, -1};
    double allowed = tolerance;
    for (int k = 0; k <= basis.degree(); ++k) {
        const JumpRow row = jump_row(basis, place, k);
        Jump most;
        each_fibre(axis, patch.net().extent(), [&](const Index<N>& start) {
            const Jump j = jump_of(frame, row, patch.net().view().fibre(axis, start));
            most.size = std::max(most.size, j.size);
            most.bound = std::max(most.bound, j.bound);
        });
        line.c.push_back(most);
        if (k > 0 && allowed != 0) allowed = allowed * k / h;
        if (line.c_order == k - 1 && most.size <= most.bound + allowed) line.c_order = k;
    }
    return line;
}

}  // namespace

template <std::size_t N, class P>
static Result<std::vector<KnotLine>> lines_across(const Patch<N, P>& patch, int axis,
                                                  const ContinuityOptions& options) {
    FF_REQUIRE(axis >= 0 && axis < int(N));
    const std::pair<const char*, double> numbers[] = {{"tolerance", options.tolerance},
                                                      {"roundings", options.roundings}};
    for (const auto& [name, x] : numbers)
        if (!(x >= 0) || !std::isfinite(x))
            return refuse(std::isfinite(x) ? RefusalKind::invalid : RefusalKind::nonfinite, name,
                          text(x, " is not a finite number >= 0"));
    const BSplineBasis& basis = patch.basis(axis);
    const KnotFrame<P> frame = frame_of(patch, options.roundings);
    const auto breaks = basis.breaks();
    std::vector<KnotLine> all;
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i)
        all.push_back(line_at(patch, axis, frame, breaks[i], false, options.tolerance));
    if (basis.is_closed()) all.push_back(line_at(patch, axis, frame, breaks[0], true, options.tolerance));
    for (const KnotLine& line : all)
        for (std::size_t k = 0; k < line.c.size(); ++k)
            if (!std::isfinite(line.c[k].size) || !std::isfinite(line.c[k].bound))
                return refuse(
                    RefusalKind::ill_conditioned, text("knot ", line.at),
                    text("the derivative of order ", k, " or its error leaves the range of double"));
    return all;
}

template <std::size_t N, class P>
Result<std::vector<KnotLine>> knot_lines(const Patch<N, P>& patch, int axis,
                                         const ContinuityOptions& options) {
    if constexpr (detail::kIsWidened<P>)
        return lines_across(detail::widened(patch), axis, options);
    else
        return lines_across(patch, axis, options);
}

#define FF_INSTANTIATE_LINES(N, P) \
    template Result<std::vector<KnotLine>> knot_lines(const Patch<N, P>&, int, const ContinuityOptions&);
#define FF_INSTANTIATE_ALL_LINES(D) \
    FF_INSTANTIATE_LINES(1, Vec<D>) \
    FF_INSTANTIATE_LINES(1, Hom<D>) \
    FF_INSTANTIATE_LINES(2, Vec<D>) \
    FF_INSTANTIATE_LINES(2, Hom<D>) \
    FF_INSTANTIATE_LINES(3, Vec<D>) \
    FF_INSTANTIATE_LINES(3, Hom<D>)
FF_INSTANTIATE_ALL_LINES(1)
FF_INSTANTIATE_ALL_LINES(2)
FF_INSTANTIATE_ALL_LINES(3)
FF_INSTANTIATE_ALL_LINES(4)
#undef FF_INSTANTIATE_LINES
#undef FF_INSTANTIATE_ALL_LINES

}  // namespace freiform
