// One-sided expansions of curves, and the knots of a spline.
//
// Idea: a spline is one polynomial on either side of a knot; which one is the choice of a span, and the
// recurrence of the basis takes any span with any parameter. So both sides of a knot, of the seam of a closed
// spline and of the end of a curve are the same function with different spans.
//
// Method: derivatives of the numerator and the weight by the blossom, in `Bounded`; the point by division of
// power series. The coefficients are measured from a point nearby, A - o w, so that a curve far from the
// origin does not lose its derivatives in the rounding of large numbers (that loss stays in the grant of
// `roundings`, where it belongs: the numbers given were rounded there). Jumps along knot lines of a net are
// linear in the coefficients: the difference of the two rows of weights is taken first, so coefficients that
// both sides share are granted their roundings once.
//
// Accuracy: proven by the arithmetic. A jump of coefficients bounds the jump of the function, by the convex
// hull of B-splines. Cost: O(degree^3) per knot and side.
//
// Why not Bezier pieces: their coefficients have been computed, so their rounding would look like jumps.
//
// References: [Ramshaw 1989], [PT97, 2.5, 4.3].
#include "expansion_detail.hpp"
#include "knot_window_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/wide.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::span_before;

constexpr int kMostOrders = 100;  // 170! is the largest factorial that a double holds

template <class P>
CurveSide expansion_of(const Curve<P>& curve, double at, int span, bool after,
                       const ContinuityOptions& options) {
    constexpr int D = Space<P>::kDim;
    const BSplineBasis& basis = curve.basis();
    const int p = basis.degree();
    const Interval piece{basis.knot(span), basis.knot(span + 1)};
    CurveSide side;
    side.dimension = D;
    side.degree = p;
    side.parameter = at;
    side.other_end = basis.domain().lo + (basis.domain().hi - at);
    side.span = piece.length();
    // Points inside the piece only: at its ends the neighbour may be what is evaluated.
    const auto inside = [&](int i) { return curve(piece.lo + piece.length() * (2 * i + 1) / 16); };
    for (int i = 1; i < 8; ++i) side.reach += norm(inside(i) - inside(i - 1)) * 8 / 7;

    std::vector<P> b;
    P grant{};
    for (int i = 0; i <= p; ++i) {
        b.push_back(curve.net().flat()[std::size_t((span - p + i) % basis.size())]);
        for (int c = 0; c < P::kCoords; ++c) grant[c] = std::max(grant[c], std::abs(b.back()[c]));
    }
    grant *= options.roundings * kUnitRoundoff;
    const PointOf<P> origin = project(after ? b.front() : b.back());
    side.origin.assign(origin.c.begin(), origin.c.end());

    // Derivatives of A - o w and of w.
    std::vector<Series<Bounded>> h(P::kCoords, Series<Bounded>(std::size_t(p) + 1));
    std::vector<Bounded> w(std::size_t(p) + 1);
    const Interval on = basis.domain();
    const detail::KnotWindow window(basis, span, at, basis.is_closed() && at == (after ? on.lo : on.hi));
    for (int k = 0; k <= p; ++k) {
        weights_in_span(window, span, window.at(), k, w.data());
        for (int i = 0; i <= p; ++i) {
            const P& q = b[std::size_t(i)];
            const Bounded weight =
                Space<P>::kRational ? Bounded(q[P::kCoords - 1], grant[P::kCoords - 1]) : 1.0;
            for (int c = 0; c < D; ++c)
                h[std::size_t(c)][std::size_t(k)] +=
                    w[std::size_t(i)] * (Bounded(q[c], grant[c]) - weight * Bounded(origin[c]));
            if (Space<P>::kRational) h.back()[std::size_t(k)] += w[std::size_t(i)] * weight;
        }
    }
    const auto expand_to = [&](int orders) {
        std::vector<Series<Bounded>> x = h;
        for (auto& one : x) one.resize(std::size_t(orders) + 1);
        if (Space<P>::kRational) {
            const Series<Bounded> weight = series_of(std::span<const Bounded>(x.back()));
            for (int c = 0; c < D; ++c) {
                auto& one = x[std::size_t(c)];
                one = derivatives_of(divide(series_of(std::span<const Bounded>(one)), weight));
            }
        }
        side.derivatives.clear();
        for (int k = 0; k <= orders; ++k)
            for (int c = 0; c < D; ++c) side.derivatives.push_back(x[std::size_t(c)][std::size_t(k)]);
    };
    side.orders = std::clamp(options.orders, p, kMaxDegree);
    expand_to(side.orders);
    // Where the first r - 1 derivatives are 0, the derivative of order k by arc length needs k r of them.
    if (const int r = detail::first_order(side); r > 1)
        expand_to(std::max(side.orders, std::min(r * options.orders, kMostOrders)));
    return side;
}

template <class P>
CurveSide expansion(const Curve<P>& curve, double at, int span, bool after,
                    const ContinuityOptions& options) {
    if constexpr (detail::kIsWidened<P>) {
        CurveSide side = expansion_of(detail::widened(curve), at, span, after, options);
        const auto dimension = std::size_t(Space<P>::kDim), wide = std::size_t(side.dimension);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < side.derivatives.size(); ++i)
            if (i % wide < dimension) side.derivatives[kept++] = side.derivatives[i];
        side.derivatives.resize(kept);
        side.origin.resize(dimension);
        side.dimension = Space<P>::kDim;
        return side;
    } else {
        return expansion_of(curve, at, span, after, options);
    }
}

std::unexpected<Refusal> no_end() {
    return refuse(RefusalKind::no_answer, "curve", "is closed and has no end where another could join");
}

}  // namespace

CurveSide reversed(CurveSide side) {
    std::swap(side.parameter, side.other_end);
    for (std::size_t i = 0; i < side.derivatives.size(); ++i)
        if (i / std::size_t(side.dimension) % 2 == 1) side.derivatives[i] = -side.derivatives[i];
    return side;
}

template <class P>
CurveSide side_before(const Curve<P>& curve, double at, const ContinuityOptions& options) {
    FF_REQUIRE(curve.basis().domain().lo < at && at <= curve.basis().domain().hi);
    return expansion(curve, at, span_before(curve.basis(), at), false, options);
}

template <class P>
CurveSide side_after(const Curve<P>& curve, double at, const ContinuityOptions& options) {
    FF_REQUIRE(curve.basis().domain().lo <= at && at < curve.basis().domain().hi);
    return expansion(curve, at, curve.basis().span(at), true, options);
}

template <class P>
Result<CurveSide> leaving(const Curve<P>& curve, End end, const ContinuityOptions& options) {
    const auto [lo, hi] = curve.basis().domain();
    if (curve.basis().is_closed()) return no_end();
    return end == End::start ? side_after(curve, lo, options) : reversed(side_before(curve, hi, options));
}

template <class P>
Result<CurveSide> arriving(const Curve<P>& curve, End end, const ContinuityOptions& options) {
    const auto [lo, hi] = curve.basis().domain();
    if (curve.basis().is_closed()) return no_end();
    return end == End::end ? side_before(curve, hi, options) : reversed(side_after(curve, lo, options));
}

template <class P>
CurveEnds ends_of(const Curve<P>& curve, const ContinuityOptions& options) {
    if (curve.basis().is_closed()) return {};
    const auto [lo, hi] = curve.basis().domain();
    return {side_after(curve, lo, options), side_before(curve, hi, options)};
}

template <class P>
Result<std::vector<KnotContinuity>> continuity(const Curve<P>& curve, const ContinuityOptions& options) {
    const BSplineBasis& basis = curve.basis();
    const auto lines = knot_lines(curve, 0, options);
    if (!lines) return std::unexpected(lines.error());
    const auto [lo, hi] = basis.domain();
    std::vector<KnotContinuity> all;
    for (const KnotLine& line : *lines) {
        const auto j = continuity(side_before(curve, line.seam ? hi : line.at, options),
                                  side_after(curve, line.at, options), options);
        if (!j) return refuse_within(text("knot ", line.at), j.error());
        all.push_back({line.at, line.multiplicity, line.seam, line.c_order >= basis.degree(), *j});
    }
    if (!basis.is_closed()) {
        const auto j = continuity(side_before(curve, hi, options), side_after(curve, lo, options), options);
        if (!j) return refuse_within("seam", j.error());
        if (j->c_order >= 0) all.push_back({lo, basis.degree() + 1, true, false, *j});
    }
    return all;
}

#define FF_INSTANTIATE_SIDES(P)                                                          \
    template CurveSide side_before(const Curve<P>&, double, const ContinuityOptions&);   \
    template CurveSide side_after(const Curve<P>&, double, const ContinuityOptions&);    \
    template CurveEnds ends_of(const Curve<P>&, const ContinuityOptions&);               \
    template Result<CurveSide> leaving(const Curve<P>&, End, const ContinuityOptions&);  \
    template Result<CurveSide> arriving(const Curve<P>&, End, const ContinuityOptions&); \
    template Result<std::vector<KnotContinuity>> continuity(const Curve<P>&, const ContinuityOptions&);
FF_INSTANTIATE_SIDES(Vec<1>)
FF_INSTANTIATE_SIDES(Vec<2>)
FF_INSTANTIATE_SIDES(Vec<3>)
FF_INSTANTIATE_SIDES(Vec<4>)
FF_INSTANTIATE_SIDES(Hom<1>)
FF_INSTANTIATE_SIDES(Hom<2>)
FF_INSTANTIATE_SIDES(Hom<3>)
FF_INSTANTIATE_SIDES(Hom<4>)
#undef FF_INSTANTIATE_SIDES

}  // namespace freiform
