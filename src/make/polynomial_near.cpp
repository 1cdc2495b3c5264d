// Polynomial curves near rational ones.
//
// Idea: cubic Hermite interpolation of the Bezier pieces of the curve, halved until near. What is proven is
// the distance of the spline that comes out, rounded as it is, so the interpolation itself needs no proof.
//
// Notation: a piece is a(s) / w(s), s from 0 to 1, of degree p, with w > 0 by its Bernstein coefficients;
// c(s) the cubic beside it.
//
// Method: the derivative of a / w by s at 0 is p w_1 / w_0 (P_1 - P_0) with the control points P, so the
// cubic has P_0 and P_0 + p w_1 / (3 w_0) (P_1 - P_0), and likewise at its end. Breaks are doubles; a piece
// is cut where its break lies in it, not in the middle, as far as those differ. Knots inside a piece are
// double, as are those where the curve has fewer equal knots than its degree (it is C1 there); others are
// triple.
//
// Accuracy: a - w c is a polynomial of degree p + 3; its Bernstein coefficients, divided by the least of w,
// bound |a / w - c|. Everything is computed with bounds (bounded.hpp), from the extraction of the pieces on,
// with the coefficients of c as the knots and control points of the spline give them. For the error of an
// interpolant, x s^2 (1 - s)^2 to first order, the largest coefficient of degree 5 is 1.6 times the maximum.
//
// Cost: pieces of order tolerance^-1/4, O(p) products for each, O(p^2) for cutting.
//
// References: [Farin 2002, 7.5] for Hermite interpolation.
//
// Why not quintic or geometric Hermite pieces, which are fewer? Cubics suffice for surfaces whose other
// direction is cubic, and corresponding parameters must stay.
#include "bernstein_detail.hpp"
#include "rounding_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/polynomial_near.hpp>
#include <freiform/spline/bezier.hpp>

namespace freiform {

namespace {

using detail::BernsteinScalar;
using detail::BernsteinVector;

constexpr std::size_t kMostSpans = std::size_t(1) << 14;

// A piece of the rational curve over a span.
struct Span {
    Interval on;
    BernsteinVector a;
    BernsteinScalar w;
};

using Cubic = std::array<Vec<3>, 4>;

BoundedVec<3> blend(const Bounded& s, const BoundedVec<3>& x, const BoundedVec<3>& y) {
    BoundedVec<3> out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = (Bounded(1) - s) * x[c] + s * y[c];
    return out;
}
Bounded blend(const Bounded& s, const Bounded& x, const Bounded& y) { return (Bounded(1) - s) * x + s * y; }

// de Casteljau: `left` keeps [0, s], what is returned has [s, 1].
template <class T>
std::vector<T> cut(std::vector<T>& left, const Bounded& s) {
    std::vector<T> right = left;
    const std::size_t n = left.size();
    for (std::size_t r = 1; r < n; ++r) {
        for (std::size_t i = 0; i + r < n; ++i) right[i] = blend(s, right[i], right[i + 1]);
        left[r] = right[0];
    }
    return right;
}

Span cut_at(Span& span, double at) {
    const Bounded s = (Bounded(at) - Bounded(span.on.lo)) / (Bounded(span.on.hi) - Bounded(span.on.lo));
    Span right{{at, span.on.hi}, cut(span.a, s), cut(span.w, s)};
    span.on.hi = at;
    return right;
}

Vec<3> control_point(const Span& s, std::size_t i) {
    Vec<3> p;
    for (int c = 0; c < 3; ++c) p[c] = s.a[i][std::size_t(c)].value / s.w[i].value;
    return p;
}

Cubic hermite(const Span& s) {
    const std::size_t n = s.a.size() - 1;
    const auto leg = [&](std::size_t end, std::size_t next) {
        const Vec<3> p = control_point(s, end);
        return p + double(n) * s.w[next].value / (3 * s.w[end].value) * (control_point(s, next) - p);
    };
    return {control_point(s, 0), leg(0, 1), leg(n, n - 1), control_point(s, n)};
}

// At least the distance of corresponding points.
double distance(const Span& s, const BernsteinVector& cubic) {
    const BernsteinVector a = detail::elevated(s.a, s.a.size() + 2), b = detail::scaled_by(s.w, cubic);
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const Bounded& w : s.w) least = std::min(least, w.value - w.bound);
    for (std::size_t i = 0; i < a.size(); ++i) {
        Vec<3> e;
        for (std::size_t c = 0; c < 3; ++c) {
            const Bounded d = a[i][c] - b[i][c];
            e[int(c)] = std::abs(d.value) + d.bound;
        }
        const double size = norm(e);
        if (!(size <= most)) most = size;  // also where it is not a number
    }
    return least > 0 && most >= 0 ? most / least * (1 + 0x1p-48) : std::numeric_limits<double>::infinity();
}

BernsteinVector exactly(const Cubic& c) {
    BernsteinVector b;
    for (const Vec<3>& p : c) b.push_back({Bounded(p[0]), Bounded(p[1]), Bounded(p[2])});
    return b;
}

std::vector<Span> pieces_of(const Curve<Hom<3>>& curve, const detail::Powers& powers) {
    const BezierPieces<1, Hom<3>> pieces(curve);
    const double e = refinement_error(curve.basis().degree());
    std::vector<Span> all;
    BoundedVec<3> largest{};  // of numerators and weights: what the extraction of pieces is relative to
    double heaviest = 0;
    for (const Hom<3>& h : curve.net().flat()) {
        const auto c = powers.coefficient(h);
        for (std::size_t k = 0; k < 3; ++k)
            largest[k].value = std::max(largest[k].value, std::abs(c.x[k].value));
        heaviest = std::max(heaviest, c.w.value);
    }
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        Span s{pieces.box({i})[0], {}, {}};
        for (int k = 0; k <= pieces.degree(0); ++k) {
            auto c = powers.coefficient(pieces.net({i})({k}));
            for (std::size_t d = 0; d < 3; ++d) c.x[d].bound += e * largest[d].value;
            c.w.bound += e * heaviest;
            s.a.push_back(c.x);
            s.w.push_back(c.w);
        }
        all.push_back(std::move(s));
    }
    return all;
}

// Spans cut until the cubic of each is within `room`, in divided units.
Result<std::vector<Span>> fine_enough(std::vector<Span> rest, double room) {
    std::reverse(rest.begin(), rest.end());
    std::vector<Span> done;
    while (!rest.empty()) {
        Span& s = rest.back();
        if (distance(s, exactly(hermite(s))) <= room) {
            done.push_back(std::move(s));
            rest.pop_back();
            continue;
        }
        const double at = s.on.middle();
        if (!(s.on.lo < at && at < s.on.hi))
            return refuse(RefusalKind::ill_conditioned, text("t = ", s.on.lo),
                          "rounding alone moves the curve by more than the tolerance");
        if (done.size() + rest.size() >= kMostSpans)
            return refuse(RefusalKind::limit, text("t = ", s.on.lo),
                          text("the tolerance needs more than ", kMostSpans, " spans"));
        Span right = cut_at(s, at);
        std::swap(s, right);  // the left one is next
        rest.push_back(std::move(right));
    }
    return done;
}

// How many equal knots the cubic gets where the curve has some.
std::size_t multiplicity(const BSplineBasis& given, double at) {
    return given.multiplicity(at) >= given.degree() ? 3 : 2;
}

struct Spline {
    BSplineBasis basis;
    std::vector<Vec<3>> net;  // in divided units
};

// Coefficients at joints with double knots are left out: those are means of their neighbours.
Result<Spline> assembled(const std::vector<Span>& spans, const BSplineBasis& given) {
    const bool closed = given.is_closed();
    const Interval on = given.domain();
    std::vector<double> t(closed ? 1 : 4, on.lo);
    std::vector<Vec<3>> net;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const Cubic c = hermite(spans[i]);
        const double lo = spans[i].on.lo;
        const std::size_t knots = i == 0 && !closed ? 3 : multiplicity(given, lo);
        if (i > 0) t.insert(t.end(), knots, lo);
        net.insert(net.end(), c.begin() + (knots == 3 ? 0 : 1), c.end() - 1);
    }
    if (!closed) net.push_back(hermite(spans.back())[3]);
    const std::size_t seam = multiplicity(given, on.lo);
    t.insert(t.end(), closed ? seam : 4, on.hi);
    // A closed basis begins with the coefficients of the knots up to its seam.
    if (closed) std::rotate(net.begin(), net.end() - std::ptrdiff_t(3 - seam), net.end());
    auto basis = closed ? BSplineBasis::periodic(3, std::move(t)) : BSplineBasis::make(3, std::move(t));
    if (!basis) return std::unexpected(basis.error());
    return Spline{*std::move(basis), std::move(net)};
}

// The Bezier coefficients over span s of the knots: blossoms at lo, lo, lo to hi, hi, hi, with bounds.
BernsteinVector bezier_of(const BSplineBasis& basis, std::span<const BoundedVec<3>> net, int s) {
    BernsteinVector out;
    for (int k = 0; k <= 3; ++k) {
        std::array<BoundedVec<3>, 4> d;
        for (int i = 0; i <= 3; ++i) d[std::size_t(i)] = net[std::size_t((s - 3 + i) % basis.size())];
        for (int r = 1; r <= 3; ++r) {
            const Bounded at = basis.knot(r <= 3 - k ? s : s + 1);
            for (int i = 3; i >= r; --i) {
                const Bounded lo = basis.knot(s - 3 + i), hi = basis.knot(s + 1 + i - r);
                d[std::size_t(i)] = blend((at - lo) / (hi - lo), d[std::size_t(i) - 1], d[std::size_t(i)]);
            }
        }
        out.push_back(d[3]);
    }
    return out;
}

double distance(const std::vector<Span>& spans, const BSplineBasis& basis,
                std::span<const BoundedVec<3>> net) {
    double most = 0;
    for (const Span& s : spans)
        most = std::max(most, distance(s, bezier_of(basis, net, basis.span(s.on.lo))));
    return most;
}

template <int D>
Result<NearPolynomial<D>> without_equal_weights(const Curve<Hom<D>>& curve, double tolerance) {
    std::vector<Vec<D>> net;
    double most = 0;
    for (const Hom<D>& h : curve.net().flat()) {
        net.push_back(project(h));
        most = std::max(most, norm(net.back()));
    }
    const double weight = curve.net().flat().front().weight();
    const double bound = weight == 1 ? 0 : most * (1.01 * kUnitRoundoff) + 0x1p-1070;
    if (!(bound <= tolerance))
        return refuse(RefusalKind::ill_conditioned, "tolerance",
                      text(tolerance, " is too small: rounding alone may move points by ", bound));
    const int n = int(net.size());
    return NearPolynomial<D>{Curve<Vec<D>>::trusted(curve.bases(), Net<1, Vec<D>>({n}, std::move(net))),
                             bound};
}

Result<void> check(const BSplineBasis& basis) {
    for (const double t : basis.breaks()) {
        const bool end = !basis.is_closed() && (t == basis.domain().lo || t == basis.domain().hi);
        if (!end && basis.multiplicity(t) > basis.degree())
            return refuse(RefusalKind::unsupported, "curve", text("jumps at ", t));
    }
    return {};
}

}  // namespace

template <int D>
Result<NearPolynomial<D>> polynomial_near(const Curve<Hom<D>>& curve, double tolerance) {
    if (!(tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a positive distance"));
    const auto weights = curve.net().flat();
    if (std::all_of(weights.begin(), weights.end(),
                    [&](const Hom<D>& h) { return h.weight() == weights.front().weight(); }))
        return without_equal_weights(curve, tolerance);
    if (auto ok = check(curve.basis()); !ok) return std::unexpected(ok.error());
    detail::Powers powers;
    powers.include(curve);
    auto pieces = pieces_of(in_space(curve), powers);
    if (pieces.size() == 1 && curve.basis().is_closed()) {  // too few for a closed cubic
        Span right = cut_at(pieces[0], pieces[0].on.middle());
        pieces.push_back(std::move(right));
    }
    const double allowed = std::scalbn(tolerance, -powers.point());
    double room = allowed;  // less what rounding moves, once that is known
    for (int round = 0; round < 4 && room > 0; ++round) {
        const auto spans = fine_enough(pieces, room);
        if (!spans) return std::unexpected(spans.error());
        auto made = assembled(*spans, curve.basis());
        if (!made) return std::unexpected(made.error());
        std::vector<Vec<D>> net;
        std::vector<BoundedVec<3>> units;
        for (const Vec<3>& p : made->net) {
            Vec<3> q;
            for (int c = 0; c < 3; ++c) q[c] = std::scalbn(p[c], powers.point());
            units.push_back(powers.vector(q));
            Vec<D>& stored = net.emplace_back();
            for (int c = 0; c < D; ++c) stored[c] = q[c];
        }
        const double off = distance(*spans, made->basis, units);
        const int n = int(net.size());
        if (off <= allowed)
            return NearPolynomial<D>{
                Curve<Vec<D>>::trusted({std::move(made->basis)}, Net<1, Vec<D>>({n}, std::move(net))),
                std::scalbn(off, powers.point()) * (1 + 0x1p-52) + 0x1p-1074};
        room = room - 2 * (off - room);
    }
    return refuse(RefusalKind::ill_conditioned, "tolerance",
                  text(tolerance, " is too small: it was not reached beside rounding"));
}

template Result<NearPolynomial<2>> polynomial_near(const Curve<Hom<2>>&, double);
template Result<NearPolynomial<3>> polynomial_near(const Curve<Hom<3>>&, double);

}  // namespace freiform
