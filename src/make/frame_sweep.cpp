// Sweeps in a rotation-minimising frame.
//
// Idea: with c the rail, vectors r and s orthogonal to c' do not turn about it if
//     r' = A r,    A = (c'' c'^T - c' c''^T) / |c'|^2,
// which is minus (T' . r) T for r orthogonal to the tangent T, written with a skew matrix. A is the same for
// all parametrisations. The frame is approximated by cubic Hermite pieces q through frames at nodes, and what
// is proven is proven of q, wherever it comes from: its defect d = q' - A q is known as a polynomial over a
// polynomial.
//
// Method: nodes divide each piece of the rail into m equal parts; frames come from node to node by two
// reflections [Wang et al. 2008], which is accurate to the fourth order; their derivatives are A times them.
// m is doubled until the bound is within the tolerance.
//
// Accuracy: let e = q - r, r exact. e' = A e + d, and as A is skew, |e|' <= |d|: no exponential of the
// curvature appears. But d is of third order in 1/m and changes its sign within each part, where e is of
// fourth order. So it is integrated before its norm is taken. With U the rotation that solves U' = A U and D
// the integral of d from the beginning of a part, by parts, as (U^-1)' = -U^-1 A:
//     U^-1 e (v) - U^-1 e (v0) = integral of U^-1 d = U^-1 D (v) + integral of U^-1 A D.
// Norms: a part adds |D| at its end + the integral of |A| |D|; inside it |e| is larger by the largest |D| at
// most.
//     Over a part |c'|^2 d = |c'|^2 q' - c'' (c' . q) + c' (c'' . q) = g is a polynomial, computed in
//     Bernstein
// form with bounds of all roundings (bounded.hpp). With p the linear function through 1 / |c'|^2 at both
// ends,
//     d = p g + (1 - p |c'|^2) g / |c'|^2,
// the first term has a polynomial as integral, the second, of fifth order, is bounded by the largest
// coefficients of its first factor, the mean of the norms of those of g, and the smallest of |c'|^2. |A| is
// |c' x c''| / |c'|^2. Norms of polynomials are bounded by coefficients. At the start q is a computed frame;
// e(v0) is its distance from an orthonormal one: |q . T| + | |q| - 1 |, for s also |s - T x r|. The surface
// is off by at most |x| |e_r| + |y| |e_s|, with x and y in the hull of the profile, and the rounding of its
// net.
//
// Rational rails c = C / w. A depends on c' only up to a positive factor, which may vary, so c' and c'' are
// replaced by N = C' w - C w' and N', polynomials of degree 2 p - 1. The surface has the numerators w_p C + w
// (X r + Y s) for a coefficient (X, Y, w_p) of the profile, and the weights w_p w: rational, with nothing
// more to approximate.
//
// References: [Bishop 1975], [Wang et al. 2008], [Farin 2002].
//
// Why not the Frenet frame? It turns about the rail, and jumps where the curvature vanishes. Why not
// Gronwall's inequality for r' = -(T' . r) T? Its matrix is not skew, and the bound grows with exp of the
// total curvature.
#include "bernstein_detail.hpp"
#include "rounding_detail.hpp"

#include <freiform/make/frame_sweep.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>

namespace freiform {

namespace {

using Scalar = detail::BernsteinScalar;
using SpaceVector = detail::BernsteinVector;
using detail::elevated;
using detail::scaled_by;

Scalar inner(const SpaceVector& a, const SpaceVector& b) {
    return detail::bernstein_product(
        a, b, [](const BoundedVec<3>& x, const BoundedVec<3>& y) { return dot(x, y); });
}
SpaceVector derivative_of(const SpaceVector& v) {
    SpaceVector d(std::max<std::size_t>(v.size() - 1, 1));
    for (std::size_t i = 0; i + 1 < v.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) d[i][k] = Bounded(double(v.size() - 1)) * (v[i + 1][k] - v[i][k]);
    return d;
}
// The part over [i / m, (i + 1) / m], by de Casteljau with bounds.
SpaceVector part(SpaceVector b, int i, int m) {
    const std::size_t n = b.size();
    const auto mix = [](const BoundedVec<3>& x, const BoundedVec<3>& y, const Bounded& t) {
        BoundedVec<3> z;
        for (std::size_t k = 0; k < 3; ++k) z[k] = (Bounded(1) - t) * x[k] + t * y[k];
        return z;
    };
    const Bounded right = Bounded(i + 1) / Bounded(m), left = Bounded(i) / Bounded(i + 1);
    if (i + 1 < m)
        for (std::size_t r = 1; r < n; ++r)
            for (std::size_t k = n - 1; k >= r; --k) b[k] = mix(b[k - 1], b[k], right);
    if (i > 0)
        for (std::size_t r = 1; r < n; ++r)
            for (std::size_t k = 0; k < n - r; ++k) b[k] = mix(b[k], b[k + 1], left);
    return b;
}
double length_above(const BoundedVec<3>& v) {
    Vec<3> x;
    for (int k = 0; k < 3; ++k) x[k] = std::abs(v[std::size_t(k)].value) + v[std::size_t(k)].bound;
    return norm(x) * (1 + 0x1p-48);
}
Vec<3> values(const BoundedVec<3>& v) { return {{v[0].value, v[1].value, v[2].value}}; }
BoundedVec<3> bounded(const Vec<3>& v) { return {Bounded(v[0]), Bounded(v[1]), Bounded(v[2])}; }

Vec<3> reflected(const Vec<3>& x, const Vec<3>& normal) {
    const double c = dot(normal, normal);
    return c > 0 ? x - (2 * dot(normal, x) / c) * normal : x;
}

// The rail c / w over one part, by a parameter from 0 to 1; N and N' (of polynomial rails c' and c'').
struct Part {
    SpaceVector c, d1, d2;
    Scalar w;
    Interval on;  // of the rail's parameter

    Vec<3> from() const { return point(c.front(), w.front()); }
    Vec<3> to() const { return point(c.back(), w.back()); }

private:
    static Vec<3> point(const BoundedVec<3>& x, const Bounded& weight) {
        return (1 / weight.value) * values(x);
    }
};

// A vector of the frame as a cubic.
SpaceVector hermite(const Vec<3>& q0, const Vec<3>& d0, const Vec<3>& q1, const Vec<3>& d1) {
    const double third = 1.0 / 3;
    return {bounded(q0), bounded(q0 + third * d0), bounded(q1 - third * d1), bounded(q1)};
}
// A q.
Vec<3> turned(const Vec<3>& q, const Vec<3>& d1, const Vec<3>& d2) {
    const double c = dot(d1, d1);
    return (dot(d1, q) / c) * d2 - (dot(d2, q) / c) * d1;
}

// What a part adds to the error of a vector at its end, and inside.
struct Defect {
    double at_end = 0, inside = 0;
};

// The integral from the lower end, of degree one more.
SpaceVector integral_of(const SpaceVector& g) {
    SpaceVector sum(g.size() + 1);
    const Bounded share = Bounded(1) / Bounded(double(g.size()));
    for (std::size_t i = 0; i < g.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) sum[i + 1][k] = sum[i][k] + share * g[i][k];
    return sum;
}
double mean_length(const SpaceVector& g) {
    double sum = 0;
    for (const auto& x : g) sum += length_above(x);
    return sum / double(g.size()) * (1 + 0x1p-44);
}
double largest_length(const SpaceVector& g) {
    double most = 0;
    for (const auto& x : g) most = std::max(most, length_above(x));
    return most;
}

// Infinite where |c'|^2 is not proven positive.
Defect defect(const Part& s, const SpaceVector& q) {
    const Scalar speed = inner(s.d1, s.d1);
    double least = std::numeric_limits<double>::infinity();
    for (const Bounded& x : speed) least = std::min(least, x.value - x.bound);
    if (!(least > 0)) return {std::numeric_limits<double>::infinity(), 0};
    const SpaceVector a = scaled_by(speed, derivative_of(q)), b = scaled_by(inner(s.d1, q), s.d2),
                      c = scaled_by(inner(s.d2, q), s.d1);
    const std::size_t n = std::max({a.size(), b.size(), c.size()});
    const SpaceVector ea = elevated(a, n - 1), eb = elevated(b, n - 1), ec = elevated(c, n - 1);
    SpaceVector g(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) g[i][k] = ea[i][k] - eb[i][k] + ec[i][k];
    const Scalar p = {Bounded(1 / speed.front().value), Bounded(1 / speed.back().value)};
    double off = 0;
    for (const Bounded& x : scaled_by(p, speed)) {
        const Bounded rest = Bounded(1) - x;
        off = std::max(off, std::abs(rest.value) + rest.bound);
    }
    const double rest = off * mean_length(g) / least * (1 + 0x1p-44);
    const SpaceVector d = integral_of(scaled_by(p, g));
    const SpaceVector turning = detail::bernstein_product(
        s.d1, s.d2, [](const BoundedVec<3>& x, const BoundedVec<3>& y) { return cross(x, y); });
    const double by_turning = largest_length(turning) / least * (mean_length(d) + rest) * (1 + 0x1p-44);
    const Defect found{(length_above(d.back()) + rest + by_turning) * (1 + 0x1p-44),
                       (largest_length(d) + rest + by_turning) * (1 + 0x1p-44)};
    const double direct = mean_length(g) / least * (1 + 0x1p-44);  // the integral of |d|
    return {std::min(direct, found.at_end), std::min(direct, found.inside)};
}

struct Framed {
    std::vector<SpaceVector> r, s;  // for each part
    double off_r = 0, off_s = 0;    // at the end of the last part
    double most_r = 0, most_s = 0;  // anywhere
};

// The pieces of a rail, in divided units.
struct Rail {
    struct Piece {
        SpaceVector c, d1, d2;
        Scalar w;  // {1} if the rail is polynomial
        Interval on;
    };
    std::vector<Piece> pieces;
};

template <class R>
Rail rail_of(const Curve<R>& rail, const detail::Powers& powers, double relative) {
    const BezierPieces<1, R> pieces(rail);
    Rail out;
    double largest = 0, heaviest = 0;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        Rail::Piece piece{{}, {}, {}, {}, pieces.box({i})[0]};
        for (int k = 0; k <= pieces.degree(0); ++k) {
            const auto q = powers.coefficient(pieces.net({i})({k}));
            piece.c.push_back(q.x), piece.w.push_back(q.w);
            largest = std::max(largest, max_abs(values(q.x)));
            heaviest = std::max(heaviest, q.w.value);
        }
        out.pieces.push_back(std::move(piece));
    }
    for (Rail::Piece& piece : out.pieces) {
        for (auto& x : piece.c)
            for (Bounded& b : x) b.bound += relative * largest;
        if constexpr (!Space<R>::kRational) {
            piece.w = {Bounded(1)};
            piece.d1 = derivative_of(piece.c);
        } else {
            for (Bounded& w : piece.w) w.bound += relative * heaviest;
            Scalar slope(std::max<std::size_t>(piece.w.size() - 1, 1));
            for (std::size_t i = 0; i + 1 < piece.w.size(); ++i)
                slope[i] = Bounded(double(piece.w.size() - 1)) * (piece.w[i + 1] - piece.w[i]);
            piece.d1 = scaled_by(piece.w, derivative_of(piece.c));
            const SpaceVector other = scaled_by(slope, piece.c);
            for (std::size_t i = 0; i < other.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k) piece.d1[i][k] = piece.d1[i][k] - other[i][k];
        }
        piece.d2 = derivative_of(piece.d1);
    }
    return out;
}

std::vector<Part> parts_of(const Rail& rail, int m) {
    std::vector<Part> out;
    const Bounded h = Bounded(1) / Bounded(m);
    for (const Rail::Piece& piece : rail.pieces)
        for (int k = 0; k < m; ++k) {
            Part s{part(piece.c, k, m), part(piece.d1, k, m), part(piece.d2, k, m), {}, {}};
            SpaceVector w;  // as the first coordinate
            for (const Bounded& x : piece.w) w.push_back({x, Bounded(0), Bounded(0)});
            for (const auto& x : part(std::move(w), k, m)) s.w.push_back(x[0]);
            for (auto& v : s.d1)
                for (Bounded& x : v) x = h * x;
            for (auto& v : s.d2)
                for (Bounded& x : v) x = h * h * x;
            const Interval on = piece.on;
            s.on = {k == 0 ? on.lo : on.lo + on.length() * k / m,
                    k + 1 == m ? on.hi : on.lo + on.length() * (k + 1) / m};
            out.push_back(std::move(s));
        }
    return out;
}

Vec<3> first_direction(const Vec<3>& tangent, const Vec<3>& wanted) {
    Vec<3> x = unit(wanted);
    if (max_abs(wanted) == 0) {
        int least = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(tangent[i]) < std::abs(tangent[least])) least = i;
        x = {};
        x[least] = 1;
    }
    for (int twice = 0; twice < 2; ++twice) x = unit(x - dot(x, tangent) * tangent);
    return x;
}

// Distance of a computed frame from an orthonormal one.
void measure_start(const Part& s, const Vec<3>& r, const Vec<3>& side, Framed& out) {
    const Bounded length = sqrt(dot(s.d1[0], s.d1[0]));
    BoundedVec<3> t = s.d1[0], q = bounded(r);
    for (Bounded& x : t) x /= length;
    const Bounded lean = dot(q, t), ell = sqrt(dot(q, q) - lean * lean) - Bounded(1);
    out.off_r = std::abs(lean.value) + lean.bound + std::abs(ell.value) + ell.bound;
    BoundedVec<3> d = cross(t, q);
    for (std::size_t k = 0; k < 3; ++k) d[k] = d[k] - Bounded(side[int(k)]);
    out.off_s = out.off_r + length_above(d);
}

Framed framed(const std::vector<Part>& parts, const Vec<3>& wanted) {
    Framed out;
    Vec<3> t = unit(values(parts[0].d1[0])), r = first_direction(t, wanted);
    measure_start(parts[0], r, cross(t, r), out);
    for (const Part& p : parts) {
        const Vec<3> from = p.from(), to = p.to(), next = unit(values(p.d1.back()));
        const Vec<3> half = reflected(r, to - from), half_t = reflected(t, to - from);
        const Vec<3> q = reflected(half, next - half_t), s = cross(t, r), side = cross(next, q);
        const Vec<3> a1 = values(p.d1.front()), a2 = values(p.d2.front()), b1 = values(p.d1.back()),
                     b2 = values(p.d2.back());
        out.r.push_back(hermite(r, turned(r, a1, a2), q, turned(q, b1, b2)));
        out.s.push_back(hermite(s, turned(s, a1, a2), side, turned(side, b1, b2)));
        const Defect in_r = defect(p, out.r.back()), in_s = defect(p, out.s.back());
        out.most_r = std::max(out.most_r, out.off_r + in_r.inside);
        out.most_s = std::max(out.most_s, out.off_s + in_s.inside);
        out.off_r += in_r.at_end;
        out.off_s += in_s.at_end;
        r = q, t = next;
    }
    out.most_r = std::max(out.most_r, out.off_r);
    out.most_s = std::max(out.most_s, out.off_s);
    return out;
}

template <class Q>
Result<MadeSurface<Q>> placed(const BSplineBasis& u, const std::vector<detail::SpaceCoefficient>& profile,
                              const detail::Powers& powers, const std::vector<Part>& parts,
                              const Framed& frame, std::size_t degree) {
    detail::SurfaceNet<Q> net(powers);
    std::vector<double> t(degree + 1, parts[0].on.lo);
    for (const Part& p : parts) t.insert(t.end(), degree, p.on.hi);
    t.push_back(parts.back().on.hi);
    std::vector<SpaceVector> rail, r, s;
    std::vector<Scalar> w;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        rail.push_back(elevated(parts[i].c, degree));
        r.push_back(elevated(scaled_by(parts[i].w, frame.r[i]), degree));
        s.push_back(elevated(scaled_by(parts[i].w, frame.s[i]), degree));
        w.push_back(elevated(parts[i].w, degree));
    }
    for (const detail::SpaceCoefficient& p : profile)
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (std::size_t k = i == 0 ? 0 : 1; k <= degree; ++k) {
                detail::SpaceCoefficient c;
                for (std::size_t a = 0; a < 3; ++a)
                    c.x[a] = p.w * rail[i][k][a] + p.x[0] * r[i][k][a] + p.x[1] * s[i][k][a];
                c.w = p.w * w[i][k];
                net.add(c);
            }
    auto basis = BSplineBasis::make(int(degree), std::move(t));
    if (!basis) return std::unexpected(basis.error());
    const double bound = net.bound();
    const Index<2> extent{u.size(), basis->size()};
    auto surface = Surface<Q>::make({u, std::move(*basis)}, Net<2, Q>(extent, net.take()));
    if (!surface) return std::unexpected(surface.error());
    return MadeSurface<Q>{std::move(*surface), bound};
}

Result<void> check(const BSplineBasis& b, const FrameSweepOptions& options) {
    if (!is_finite(options.x_at_start)) return refuse(RefusalKind::nonfinite, "x_at_start", "is not finite");
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance",
                      text(options.tolerance, " is not a positive distance"));
    if (b.degree() < 1) return refuse(RefusalKind::unsupported, "rail", "has degree 0");
    for (const double t : b.breaks())
        if (t != b.domain().lo && t != b.domain().hi && b.multiplicity(t) >= b.degree())
            return refuse(RefusalKind::unsupported, "rail",
                          text("its knot ", t, " has multiplicity ", b.multiplicity(t),
                               ", so that its direction may jump there"));
    return {};
}

}  // namespace

template <class P, class R>
Result<FrameSweep<Swept<P, R>>> sweep(const Curve<P>& profile, const Curve<R>& rail,
                                      const FrameSweepOptions& options) {
    if (auto ok = check(rail.basis(), options); !ok) return std::unexpected(ok.error());
    // Of the weights, products are taken; so each curve has its own power of two.
    detail::Powers powers;
    powers.include(profile);
    powers.include(rail);
    detail::Powers of_rail = powers, of_profile = powers;
    of_rail.heaviest = of_profile.heaviest = 0;
    of_rail.include(rail), of_profile.include(profile);
    powers.heaviest = std::scalbn(1.0, of_profile.weight() + of_rail.weight());
    const BSplineBasis& basis = rail.basis();
    const int p = basis.degree();
    const bool one = basis.size() == p + 1 && !basis.is_closed() &&
                     basis.multiplicity(basis.domain().lo) > p && basis.multiplicity(basis.domain().hi) > p;
    const Rail pieces = rail_of(rail, of_rail, one ? 0 : 1.01 * refinement_error(p));
    const int degree = Space<R>::kRational ? p + 3 : std::max(3, p);
    std::vector<detail::SpaceCoefficient> net;
    double x = 0, y = 0, reached = 0;
    for (const P& c : profile.net().flat()) {
        net.push_back(of_profile.coefficient(c));
        const Vec<2> q = project(c);
        x = std::max(x, std::abs(q[0]) * (1 + 0x1p-52)), y = std::max(y, std::abs(q[1]) * (1 + 0x1p-52));
    }
    constexpr int kMost = 1 << 14;
    for (int m = 1; m * int(pieces.pieces.size()) <= kMost; m *= 2) {
        const auto parts = parts_of(pieces, m);
        const Framed frame = framed(parts, options.x_at_start);
        const double turned = (x * frame.most_r + y * frame.most_s) * (1 + 0x1p-40);
        if (m == 64 && !std::isfinite(turned))
            return refuse(RefusalKind::ill_conditioned, "rail",
                          "its derivative cannot be told from zero everywhere");
        reached = turned;
        if (!(turned <= options.tolerance)) continue;
        auto made = placed<Swept<P, R>>(profile.basis(), net, powers, parts, frame, std::size_t(degree));
        if (!made) return std::unexpected(made.error());
        const double bound = (turned + made->bound) * (1 + 0x1p-48);
        if (2 * made->bound > options.tolerance)
            return refuse(RefusalKind::ill_conditioned, "tolerance",
                          text(options.tolerance, " is too small beside rounding, which may move points by ",
                               made->bound));
        if (!(bound <= options.tolerance)) continue;
        return FrameSweep<Swept<P, R>>{std::move(made->surface), bound, int(parts.size())};
    }
    return refuse(RefusalKind::limit, "tolerance",
                  text(options.tolerance, " was not reached with ", kMost, " pieces, but ", reached));
}

#define FF_FRAME_SWEEP(P, R)                                                         \
    template Result<FrameSweep<Swept<P, R>>> sweep(const Curve<P>&, const Curve<R>&, \
                                                   const FrameSweepOptions&);
FF_FRAME_SWEEP(Vec<2>, Vec<3>)
FF_FRAME_SWEEP(Hom<2>, Vec<3>)
FF_FRAME_SWEEP(Vec<2>, Hom<3>)
FF_FRAME_SWEEP(Hom<2>, Hom<3>)
#undef FF_FRAME_SWEEP

}  // namespace freiform
