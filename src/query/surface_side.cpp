// One side of a line of a surface.
//
// Idea: along an iso-line the derivative of order k across is a spline curve whose control points are linear
// in those of the surface: one row of weights along the axis across. Its Bezier pieces are blossoms, rows of
// weights as well. Both steps in `Bounded`, so what comes out are polynomials with known errors.
//
// Method: weights as for curves (curve_side.cpp), at the seam of a closed axis with knots measured from the
// seam. Points are measured from a point of the line, A - o w. Cost: O(degree^2) per coefficient of the
// strip.
//
// Parts: de Casteljau's algorithm in `Bounded`, at parameters that are off by a grant.
//
// References: [Ramshaw 1989], [PT97, 3.3, 4.4].
#include "knot_window_detail.hpp"
#include "surface_strip_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/query/surface_continuity.hpp>
#include <freiform/spline/wide.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::span_before;

// The control points of the derivatives across: [order * (D + 1) + coordinate][j].
using Rows = std::vector<std::vector<Bounded>>;

template <class P>
Rows rows_across(const Surface<P>& s, int axis, double at, int span, bool after, double roundings,
                 SurfaceSide& side) {
    constexpr int D = Space<P>::kDim;
    const BSplineBasis& basis = s.basis(axis);
    const int p = basis.degree(), n = s.basis(1 - axis).size();
    const auto q = [&](int i, int j) -> const P& {
        const int k = (span - p + i) % basis.size();
        return s.net().view()(axis == 0 ? Index<2>{k, j} : Index<2>{j, k});
    };
    P grant{};
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j < n; ++j)
            for (int c = 0; c < P::kCoords; ++c) grant[c] = std::max(grant[c], std::abs(q(i, j)[c]));
    grant *= roundings * kUnitRoundoff;
    const PointOf<P> origin = project(q(after ? 0 : p, 0));
    side.origin.assign(origin.c.begin(), origin.c.end());

    Rows rows(std::size_t((side.orders + 1) * (D + 1)), std::vector<Bounded>(std::size_t(n)));
    const Interval on = basis.domain();
    const detail::KnotWindow window(basis, span, at, basis.is_closed() && at == (after ? on.lo : on.hi));
    std::vector<Bounded> w(std::size_t(p) + 1);
    for (int k = 0; k <= std::min(p, side.orders); ++k) {
        weights_in_span(window, span, window.at(), k, w.data());
        for (int j = 0; j < n; ++j)
            for (int i = 0; i <= p; ++i) {
                if (w[std::size_t(i)].is_zero()) continue;
                const P& b = q(i, j);
                const Bounded weight =
                    Space<P>::kRational ? Bounded(b[P::kCoords - 1], grant[P::kCoords - 1]) : 1.0;
                const auto row = [&](int c) -> Bounded& {
                    return rows[std::size_t(k * (D + 1) + c)][std::size_t(j)];
                };
                for (int c = 0; c < D; ++c)
                    row(c) += w[std::size_t(i)] * (Bounded(b[c], grant[c]) - weight * Bounded(origin[c]));
                if (Space<P>::kRational) row(D) += w[std::size_t(i)] * weight;
            }
    }
    return rows;
}

void add_pieces(const BSplineBasis& basis, const Rows& rows, SurfaceSide& side) {
    const int q = basis.degree();
    const auto breaks = basis.breaks();
    const Bounded lo = breaks.front(), whole = Bounded(breaks.back()) - lo;
    std::vector<Bounded> args(static_cast<std::size_t>(q)), w(std::size_t(q) + 1);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        SurfaceSide::Piece piece{(Bounded(breaks[i]) - lo) / whole,
                                 (Bounded(breaks[i + 1]) - lo) / whole,
                                 {breaks[i], breaks[i + 1]},
                                 Rows(rows.size(), std::vector<Bounded>(std::size_t(q) + 1))};
        const int span = basis.span(breaks[i]);
        for (int b = 0; b <= q; ++b) {
            for (int k = 0; k < q; ++k) args[std::size_t(k)] = k < q - b ? breaks[i] : breaks[i + 1];
            blossom(basis, span, args.data(), w.data());
            for (std::size_t r = 0; r < rows.size(); ++r)
                for (int k = 0; k <= q; ++k)
                    piece.derivative[r][std::size_t(b)] +=
                        w[std::size_t(k)] * rows[r][std::size_t((span - q + k) % basis.size())];
        }
        side.pieces.push_back(std::move(piece));
    }
    side.uncertainty =
        std::max(std::abs(breaks.front()), std::abs(breaks.back())) * kUnitRoundoff / whole.value;
}

template <class P>
SurfaceSide whole_side_of(const Surface<P>& s, int axis, double at, int span, bool after,
                          const ContinuityOptions& options) {
    FF_REQUIRE(axis == 0 || axis == 1);
    constexpr int D = Space<P>::kDim;
    const BSplineBasis &across = s.basis(axis), &along = s.basis(1 - axis);
    const Interval piece{across.knot(span), across.knot(span + 1)}, line = along.domain();
    SurfaceSide side;
    side.dimension = D;
    side.orders = std::clamp(options.orders, 2, kMaxDegree);
    side.is_rational = Space<P>::kRational;
    side.parameter = at;
    side.span = piece.length();
    // The longest of three parameter lines across, by eight points inside the piece.
    for (const double x : {0.25, 0.5, 0.75}) {
        const double t = line.lo + x * line.length();
        const auto point = [&](int i) {
            const double u = piece.lo + piece.length() * (2 * i + 1) / 16;
            return axis == 0 ? s(u, t) : s(t, u);
        };
        double length = 0;
        for (int i = 1; i < 8; ++i) length += norm(point(i) - point(i - 1)) * 8 / 7;
        side.reach = std::max(side.reach, length);
    }
    const Rows rows = rows_across(s, axis, at, span, after, options.roundings, side);
    for (int j = 1; j < along.size(); ++j) {
        Vec<D> step;
        for (int c = 0; c < D; ++c) {
            const auto x = [&](int k) {
                const double w = Space<P>::kRational ? rows[std::size_t(D)][std::size_t(k)].value : 1;
                return rows[std::size_t(c)][std::size_t(k)].value / w;
            };
            step[c] = x(j) - x(j - 1);
        }
        side.length += norm(step);
    }
    add_pieces(along, rows, side);
    if (!Space<P>::kRational)
        for (SurfaceSide::Piece& x : side.pieces) x.derivative[std::size_t(D)] = {Bounded(1)};
    if (!Space<P>::kRational)
        for (SurfaceSide::Piece& x : side.pieces)
            for (int k = 1; k <= side.orders; ++k) x.derivative[std::size_t(k * (D + 1) + D)].clear();
    return side;
}

template <class P>
SurfaceSide side_of(const Surface<P>& s, int axis, double at, int span, bool after,
                    const ContinuityOptions& options) {
    if constexpr (detail::kIsWidened<P>) {
        SurfaceSide side = whole_side_of(detail::widened(s), axis, at, span, after, options);
        const auto dimension = std::size_t(Space<P>::kDim), wide = std::size_t(side.dimension);
        for (SurfaceSide::Piece& p : side.pieces) {
            std::size_t kept = 0;
            for (std::size_t r = 0; r < p.derivative.size(); ++r)
                if (const std::size_t c = r % (wide + 1); c < dimension || c == wide)
                    std::swap(p.derivative[kept++], p.derivative[r]);
            p.derivative.resize(kept);
        }
        side.origin.resize(dimension);
        side.dimension = Space<P>::kDim;
        return side;
    } else {
        return whole_side_of(s, axis, at, span, after, options);
    }
}

}  // namespace

SurfaceSide reversed_across(SurfaceSide side) {
    for (SurfaceSide::Piece& p : side.pieces)
        for (std::size_t r = 0; r < p.derivative.size(); ++r)
            if (r / std::size_t(side.dimension + 1) % 2 == 1)
                for (Bounded& x : p.derivative[r]) x = -x;
    return side;
}

SurfaceSide reversed_along(SurfaceSide side) {
    std::ranges::reverse(side.pieces);
    for (SurfaceSide::Piece& p : side.pieces) {
        const Bounded from = p.from;
        p.from = Bounded(1) - p.to;
        p.to = Bounded(1) - from;
        std::swap(p.on.lo, p.on.hi);
        for (auto& row : p.derivative) std::ranges::reverse(row);
    }
    return side;
}

SurfaceSide part_of(const SurfaceSide& side, const Interval& on, double grant) {
    // The ends of the line itself are exact.
    const auto known = [&](double t) {
        return t == side.pieces.front().on.lo || t == side.pieces.back().on.hi ? Bounded(t)
                                                                               : Bounded(t, grant);
    };
    const Bounded lo = known(on.lo), hi = known(on.hi), whole = hi - lo;
    FF_REQUIRE(whole.excludes_zero());
    const double sign = whole.value > 0 ? 1 : -1;
    SurfaceSide part = side;
    part.pieces.clear();
    for (const SurfaceSide::Piece& p : side.pieces) {
        const auto within = [&](double t) {
            return sign * (t - on.lo) > grant && sign * (on.hi - t) > grant;
        };
        const bool cut_lo = !within(p.on.lo), cut_hi = !within(p.on.hi);  // the part begins, ends in it
        if (sign * (on.hi - p.on.lo) <= grant || sign * (p.on.hi - on.lo) <= grant) continue;
        const auto local = [&](const Bounded& t) {
            return (t - Bounded(p.on.lo)) / (Bounded(p.on.hi) - Bounded(p.on.lo));
        };
        const auto fraction = [&](double t) { return (Bounded(t) - lo) / whole; };
        const std::array<Bounded, 2> here{cut_lo ? local(lo) : Bounded(0), cut_hi ? local(hi) : Bounded(1)};
        SurfaceSide::Piece piece{cut_lo ? Bounded(0) : fraction(p.on.lo),
                                 cut_hi ? Bounded(1) : fraction(p.on.hi),
                                 {cut_lo ? on.lo : p.on.lo, cut_hi ? on.hi : p.on.hi},
                                 {}};
        for (const auto& row : p.derivative) piece.derivative.push_back(detail::restricted(row, here));
        part.pieces.push_back(std::move(piece));
    }
    const double line = std::abs(side.pieces.back().on.hi - side.pieces.front().on.lo);
    part.length *= std::abs(whole.value) / line;
    part.uncertainty *= line / std::abs(whole.value);
    return part;
}

template <class P>
SurfaceSide side_before(const Surface<P>& s, int axis, double at, const ContinuityOptions& options) {
    FF_REQUIRE(s.basis(axis).domain().lo < at && at <= s.basis(axis).domain().hi);
    return side_of(s, axis, at, span_before(s.basis(axis), at), false, options);
}
template <class P>
SurfaceSide side_after(const Surface<P>& s, int axis, double at, const ContinuityOptions& options) {
    FF_REQUIRE(s.basis(axis).domain().lo <= at && at < s.basis(axis).domain().hi);
    return side_of(s, axis, at, s.basis(axis).span(at), true, options);
}

template <class P>
Result<SurfaceSide> arriving(const Surface<P>& s, SurfaceEdge edge, const ContinuityOptions& options) {
    if (edge.axis != 0 && edge.axis != 1)
        return refuse(RefusalKind::invalid, "edge.axis", text(edge.axis, " is not 0 or 1"));
    if (s.basis(edge.axis).is_closed())
        return refuse(RefusalKind::no_answer, "edge", "is on a closed axis, where the surface has no edge");
    const auto [lo, hi] = s.basis(edge.axis).domain();
    return edge.end == End::end ? side_before(s, edge.axis, hi, options)
                                : reversed_across(side_after(s, edge.axis, lo, options));
}

template <class P>
SurfaceEdges edges_of(const Surface<P>& s, const ContinuityOptions& options) {
    SurfaceEdges all;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (auto side = arriving(s, edge_at(i), options); side && side->length > 0) all[i] = *std::move(side);
    return all;
}

template <class P>
Result<std::vector<LineContinuity>> continuity(const Surface<P>& s, int axis,
                                               const ContinuityOptions& options) {
    FF_REQUIRE(axis == 0 || axis == 1);
    const BSplineBasis& basis = s.basis(axis);
    const auto [lo, hi] = basis.domain();
    const auto breaks = basis.breaks();
    std::vector<LineContinuity> all;
    for (std::size_t i = 1; i < breaks.size(); ++i) {
        const bool seam = i + 1 == breaks.size();
        const double at = seam ? lo : breaks[i];
        auto j =
            continuity(side_before(s, axis, breaks[i], options), side_after(s, axis, at, options), options);
        if (!j) return refuse_within(text("knot ", at), j.error());
        if (seam && !basis.is_closed() && j->c_order < 0) continue;
        all.push_back({at, seam && !basis.is_closed() ? basis.degree() + 1 : basis.multiplicity(at), seam,
                       *std::move(j)});
    }
    return all;
}

#define FF_INSTANTIATE_SIDES(P)                                                                      \
    template SurfaceSide side_before(const Surface<P>&, int, double, const ContinuityOptions&);      \
    template SurfaceSide side_after(const Surface<P>&, int, double, const ContinuityOptions&);       \
    template Result<SurfaceSide> arriving(const Surface<P>&, SurfaceEdge, const ContinuityOptions&); \
    template SurfaceEdges edges_of(const Surface<P>&, const ContinuityOptions&);                     \
    template Result<std::vector<LineContinuity>> continuity(const Surface<P>&, int, const ContinuityOptions&);
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
