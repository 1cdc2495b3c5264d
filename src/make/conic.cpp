// Conics as rational quadratic splines.
//
// Idea: over a parameter interval [m - h, m + h], centre + cos(t) x + sin(t) y is the rational quadratic with
//     weights 1, cos h, 1    and middle numerator    v = cos(h) centre + cos(m) x + sin(m) y,
// and with cosh, sinh the same holds of hyperbolas; a parabola is a polynomial. An arc that is given by ends
// (a, 1), (c, 1) and a middle (v, w) is halved in this form, too: both halves have the middle weight
// sqrt((1 + w) / 2), and numerators ((a + v) / (1 + w)) and ((v + c) / (1 + w)) times that; they meet in
// (a + 2 v + c) / (2 (1 + w)). Neither needs a centre, so arcs that are nearly straight are no special case.
//
// Circle through a, b, c: by the theorem of the inscribed angle the half angle of the arc is pi less the
// angle at b, so w = -cos(angle at b), and v = w m + sin(angle) |c - a| / 2 n with m the middle of a c and n
// the unit vector orthogonal to a c on the side of b.
//
// Tangents: w (c - a) = lambda at_a + mu at_c with lambda, mu > 0 makes v = w a + lambda at_a. Where the
// tangents are not parallel, a corner exists, and with p = t0 a + t1 corner + t2 c in barycentric coordinates
// w^2 = t1^2 / (4 t0 t2); where they are, w = 0 and lambda^2 = k^2 / (4 t0 t2) for p = t0 a + t2 c + k at_a.
//
// Quintic: with p = 1 - 2 s and q = 2 s (1 - s) the angle of p + i q runs from 0 to pi, so that of its square
// runs once around: (p^2 - q^2, 2 p q) / (p^2 + q^2), a quartic with the weights 1 0 1/3 0 1, elevated once
// and multiplied by 5.
//
// Accuracy: all is computed with bounds (bounded.hpp), and so is what the rounding of the coefficients moves
// (bounded_net_detail.hpp).
// sin and cos of the C library are taken to be off by at most one unit in the last place, sinh and cosh by
// two, as glibc and musl state. Weights that reach the curve are above cos 45 degrees, unless `widest` allows
// less.
//
// References: [PT97, ch. 7], [Farin 2002, ch. 12], [Chou 1995] for the quintic.
//
// Why not the fewest pieces that exist, 3 for a circle? Control points would be twice as far away. `widest`
// allows it.
#include "bounded_net_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::cosine;
using detail::sine;

using bounded::length;
using bounded::Vector;
using bounded::operator+;
using bounded::operator-;
using bounded::operator*;

// A rational quadratic with end weights 1, or any Bezier piece: numerators and weights.
template <int D>
struct Piece {
    std::vector<Vector<D>> numerator;
    std::vector<Bounded> weight;
};
template <int D>
Piece<D> quadratic(const Vector<D>& a, const Vector<D>& v, const Bounded& w, const Vector<D>& c) {
    return {{a, v, c}, {1, w, 1}};
}

// The coefficients of pieces that follow each other, ends shared.
template <int D>
using Assembled = bounded::RoundedNet<D>;
template <int D>
Assembled<D> assembled(const std::vector<Piece<D>>& pieces) {
    Assembled<D> out;
    for (const Piece<D>& piece : pieces)
        for (std::size_t i = out.net.empty() ? 0 : 1; i < piece.weight.size(); ++i)
            out.add(piece.numerator[i], piece.weight[i]);
    return out;
}

template <int D>
Result<ConicArc<D>> finished(Assembled<D> parts, Result<BSplineBasis> basis) {
    if (!basis) return std::unexpected(basis.error());
    const double bound = parts.bound();
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "conic",
                      "rounding leaves nothing of the weights or of the axes of this conic");
    const int n = int(parts.net.size());
    auto curve = Curve<Hom<D>>::make({std::move(*basis)}, Net<1, Hom<D>>({n}, std::move(parts.net)));
    if (!curve) return std::unexpected(curve.error());
    return ConicArc<D>{std::move(*curve), bound};
}

// Quadratic pieces on [0, 1], all of the same length.
template <int D>
Result<ConicArc<D>> spline_of(const std::vector<Piece<D>>& pieces, bool closed = false) {
    Assembled<D> parts = assembled(pieces);
    const int n = int(pieces.size());
    std::vector<double> t(closed ? 1 : 3, 0.0);
    for (int i = 1; i <= n; ++i) t.insert(t.end(), 2, double(i) / n);
    if (closed)
        parts.net.pop_back();
    else
        t.push_back(1);
    return finished(std::move(parts),
                    closed ? BSplineBasis::periodic(2, std::move(t)) : BSplineBasis::make(2, std::move(t)));
}

Bounded hyperbolic_cosine(const Bounded& t) {
    const double c = std::cosh(t.value);
    return {c, 2 * c * t.bound +
                   5 * kUnitRoundoff * c};  // the derivative is at most cosh(t + 1/2) / cosh(t) < 2 larger
}
Bounded hyperbolic_sine(const Bounded& t) {
    const double c = std::cosh(t.value);
    return {std::sinh(t.value), 2 * c * t.bound + 5 * kUnitRoundoff * c};
}

// Do a, b, c lie on one line? Exact: they do if their shadows in all coordinate planes do.
template <int D>
bool collinear(const Vec<D>& a, const Vec<D>& b, const Vec<D>& c) {
    for (int i = 0; i < D; ++i)
        for (int j = 0; j < i; ++j)
            if (orient2d({{a[i], a[j]}}, {{b[i], b[j]}}, {{c[i], c[j]}}) != 0) return false;
    return true;
}

template <int D>
struct Axes {
    Vector<D> centre, x, y;
};

template <int D>
Result<Axes<D>> checked(const FoundConic<D>& f) {
    const Conic<D>& c = f.conic;
    if (auto ok = check(CurveGeometry<D>(c)); !ok) return std::unexpected(ok.error());
    if (collinear(Vec<D>{}, c.x, c.y))
        return refuse(RefusalKind::invalid, "conic", "x and y are parallel: it is flat");
    return Axes<D>{bounded::vector(c.centre, f.centre_bound), bounded::vector(c.x, f.x_bound),
                   bounded::vector(c.y, f.y_bound)};
}

// The four quarters from parameter 0 on.
template <int D>
std::vector<Piece<D>> quarters(const Axes<D>& axes) {
    const Bounded w(std::sqrt(0.5), kUnitRoundoff);
    const Vector<D> zero{}, spokes[5] = {axes.x, axes.y, zero - axes.x, zero - axes.y, axes.x};
    std::vector<Piece<D>> pieces;
    for (int k = 0; k < 4; ++k)
        pieces.push_back(quadratic<D>(axes.centre + spokes[k],
                                      w * (axes.centre + (spokes[k] + spokes[k + 1])), w,
                                      axes.centre + spokes[k + 1]));
    return pieces;
}

template <int D>
std::vector<Piece<D>> elliptic_pieces(const Axes<D>& axes, Interval on, int n) {
    // Joints are doubles, and exact; what is between them follows with bounds.
    const auto joint = [&](int k) { return k == n ? on.hi : on.lo + on.length() * k / n; };
    const auto spoke = [&](const Bounded& t) { return cosine(t) * axes.x + sine(t) * axes.y; };
    std::vector<Piece<D>> pieces;
    for (int k = 0; k < n; ++k) {
        const Bounded from = joint(k), to = joint(k + 1), half(0.5), w = cosine(half * (to - from));
        pieces.push_back(quadratic<D>(axes.centre + spoke(from), w * axes.centre + spoke(half * (from + to)),
                                      w, axes.centre + spoke(to)));
    }
    return pieces;
}

template <int D>
Piece<D> hyperbolic_piece(const Axes<D>& axes, Interval on) {
    const Bounded halved(0.5), middle = halved * (Bounded(on.lo) + Bounded(on.hi)),
                               half = halved * (Bounded(on.hi) - Bounded(on.lo));
    const auto spoke = [&](const Bounded& t) {
        return hyperbolic_cosine(t) * axes.x + hyperbolic_sine(t) * axes.y;
    };
    const Bounded w = hyperbolic_cosine(half);
    return quadratic<D>(axes.centre + spoke(on.lo), w * axes.centre + spoke(middle), w,
                        axes.centre + spoke(on.hi));
}

template <int D>
Piece<D> parabolic_piece(const Axes<D>& axes, Interval on) {
    const Bounded s = on.lo, t = on.hi;
    return quadratic<D>(axes.centre + (s * s * axes.x + s * axes.y),
                        axes.centre + (s * t * axes.x + Bounded(0.5) * (s + t) * axes.y), 1,
                        axes.centre + (t * t * axes.x + t * axes.y));
}

// Halves of an arc with end weights 1, as in the essay, until the middle weight is at least `least`.
template <int D>
std::vector<Piece<D>> halved(Piece<D> whole, double least) {
    std::vector<Piece<D>> pieces{std::move(whole)};
    for (int round = 0; round < 40 && pieces[0].weight[1].value < least; ++round) {
        std::vector<Piece<D>> next;
        for (const Piece<D>& p : pieces) {
            const Vector<D>&a = p.numerator[0], &v = p.numerator[1], &c = p.numerator[2];
            const Bounded sum = Bounded(1) + p.weight[1], w = sqrt(Bounded(0.5) * sum), q = w / sum;
            const Vector<D> joint = Bounded(0.5) / sum * ((a + c) + (v + v));
            next.push_back(quadratic<D>(a, q * (a + v), w, joint));
            next.push_back(quadratic<D>(joint, q * (v + c), w, c));
        }
        pieces = std::move(next);
    }
    return pieces;
}

Result<void> check_widest(double widest) {
    if (!(widest > 0x1p-10 && widest < std::numbers::pi))
        return refuse(RefusalKind::invalid, "widest",
                      text(widest, " is not an angle between 2^-10 and pi, both excluded"));
    return {};
}

template <int D>
Result<void> check_points(std::initializer_list<std::pair<const char*, Vec<D>>> points) {
    for (const auto& [name, p] : points)
        if (!is_finite(p)) return refuse(RefusalKind::nonfinite, name, "has a coordinate that is not finite");
    return {};
}

// Of arcs with end weights 1: halved where needed.
template <int D>
Result<ConicArc<D>> halves(const Vector<D>& a, const Vector<D>& v, const Bounded& w, const Vector<D>& c,
                           double least) {
    if (!(w.value - w.bound > -1))
        return refuse(
            RefusalKind::invalid, "weight",
            text("the middle weight ", w.value, " is not above -1: the arc would go through infinity"));
    return spline_of(halved(quadratic<D>(a, v, w, c), least));
}

// Points divided by the power of two that makes the largest coordinate about 1, so that products stay in
// range. Exact, up to underflow below 2^-1000 of the largest.
template <int D>
int exponent_of(std::initializer_list<Vec<D>> points) {
    double m = 0;
    for (const Vec<D>& p : points) m = std::max(m, max_abs(p));
    return m == 0 ? 0 : std::ilogb(m);
}
template <int D>
Vec<D> scaled(Vec<D> p, int exponent) {
    for (double& x : p.c) x = std::scalbn(x, exponent);
    return p;
}
constexpr double kRoundTurn = 0x1p-32;  // a turn that is longer by this is one, with the digits of a file

template <int D>
Result<ConicArc<D>> scaled_back(Result<ConicArc<D>> arc, int exponent) {
    if (!arc || exponent == 0) return arc;
    Net<1, Hom<D>> net = arc->curve.net();
    for (Hom<D>& h : net.flat())
        for (int k = 0; k < D; ++k) h[k] = std::scalbn(h[k], exponent);
    auto curve = Curve<Hom<D>>::make(arc->curve.bases(), std::move(net));
    if (!curve) return std::unexpected(curve.error());
    return ConicArc<D>{std::move(*curve), std::scalbn(arc->bound, exponent) + 0x1p-1070};
}

}  // namespace

template <int D>
Result<ConicArc<D>> conic_arc(const FoundConic<D>& conic, Interval on, double widest) {
    const auto axes = checked(conic);
    if (!axes) return std::unexpected(axes.error());
    if (!std::isfinite(on.lo) || !std::isfinite(on.hi))
        return refuse(RefusalKind::nonfinite, "on", "has an end that is not finite");
    if (!(on.lo < on.hi))
        return refuse(RefusalKind::invalid, "on", text("[", on.lo, ", ", on.hi, "] is empty"));
    if (conic.conic.kind == ConicKind::hyperbola) return spline_of<D>({hyperbolic_piece(*axes, on)});
    if (conic.conic.kind == ConicKind::parabola) return spline_of<D>({parabolic_piece(*axes, on)});
    if (auto ok = check_widest(widest); !ok) return std::unexpected(ok.error());
    if (on.length() > (1 + kRoundTurn) * kTwoPi)
        return refuse(RefusalKind::invalid, "on", text("is ", on.length(), " long, more than a full turn"));
    const int n = int(std::ceil(on.length() / widest - 0x1p-40));
    if (on.length() == kTwoPi && n <= 4 && 2 * widest < kTwoPi / 1.5) {
        const Bounded c = on.lo == 0 ? Bounded(1) : cosine(on.lo), s = on.lo == 0 ? Bounded(0) : sine(on.lo);
        const Vector<D> x = on.lo == 0 ? axes->x : c * axes->x + s * axes->y;
        const Vector<D> y = on.lo == 0 ? axes->y : c * axes->y - s * axes->x;
        return spline_of(quarters(Axes<D>{axes->centre, x, y}));
    }
    return spline_of(elliptic_pieces(*axes, on, n));
}

template <int D>
Result<ConicArc<D>> full_ellipse(const Conic<D>& conic, EllipseForm form) {
    if (conic.kind != ConicKind::ellipse)
        return refuse(RefusalKind::invalid, "conic", "is no ellipse: it does not close");
    const auto axes = checked(FoundConic<D>{conic});
    if (!axes) return std::unexpected(axes.error());
    if (form != EllipseForm::quintic) return spline_of(quarters(*axes), form == EllipseForm::closed);
    constexpr double kX[] = {5, 1, -3, -3, 1, 5}, kY[] = {0, 4, 2, -2, -4, 0}, kW[] = {5, 1, 1, 1, 1, 5};
    Piece<D> piece;
    for (int i = 0; i < 6; ++i) {
        piece.numerator.push_back(Bounded(kW[i]) * axes->centre +
                                  (Bounded(kX[i]) * axes->x + Bounded(kY[i]) * axes->y));
        piece.weight.push_back(kW[i]);
    }
    return finished(assembled<D>({piece}), BSplineBasis::bezier(5));
}

Result<Conic<2>> circle(const Vec<2>& centre, double radius) {
    if (auto ok = check_points<2>({{"centre", centre}, {"radius", {{radius, 0}}}}); !ok)
        return std::unexpected(ok.error());
    if (!(radius > 0)) return refuse(RefusalKind::invalid, "radius", text(radius, " is not positive"));
    return Conic<2>{ConicKind::ellipse, centre, {{radius, 0}}, {{0, radius}}};
}

Result<FoundConic<3>> circle(const Vec<3>& centre, const Vec<3>& normal, double radius) {
    if (auto ok = check_points<3>({{"centre", centre}, {"normal", normal}, {"radius", {{radius, 0, 0}}}});
        !ok)
        return std::unexpected(ok.error());
    if (!(radius > 0)) return refuse(RefusalKind::invalid, "radius", text(radius, " is not positive"));
    if (max_abs(normal) == 0) return refuse(RefusalKind::invalid, "normal", "is zero");
    const Vec<3> n = scaled(normal, -std::ilogb(max_abs(normal)));
    int least = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) < std::abs(n[least])) least = i;
    // x is orthogonal to n and to the axis that n is farthest from; y = n x x / |n|.
    Vec<3> side;
    side[(least + 1) % 3] = -n[(least + 2) % 3], side[(least + 2) % 3] = n[(least + 1) % 3];
    const Vector<3> across = bounded::vector(side), up = cross(bounded::vector(n), across);
    const Vector<3> x = Bounded(radius) / length(across) * across, y = Bounded(radius) / length(up) * up;
    FoundConic<3> found{{ConicKind::ellipse, centre, {}, {}}, 0, 0, 0};
    for (int i = 0; i < 3; ++i) {
        found.conic.x[i] = x[std::size_t(i)].value, found.conic.y[i] = y[std::size_t(i)].value;
        found.x_bound = std::max(found.x_bound, x[std::size_t(i)].bound);
        found.y_bound = std::max(found.y_bound, y[std::size_t(i)].bound);
    }
    return found;
}

template <int D>
Result<ConicArc<D>> arc_through(const Vec<D>& a, const Vec<D>& b, const Vec<D>& c, double widest) {
    if (auto ok = check_points<D>({{"a", a}, {"b", b}, {"c", c}}); !ok) return std::unexpected(ok.error());
    if (auto ok = check_widest(widest); !ok) return std::unexpected(ok.error());
    if (collinear(a, b, c)) return refuse(RefusalKind::invalid, "b", "a, b and c are on one line");
    const int e = exponent_of<D>({a, b, c});
    const Vector<D> A = bounded::vector(scaled(a, -e)), B = bounded::vector(scaled(b, -e)),
                    C = bounded::vector(scaled(c, -e));
    const Vector<D> to_a = A - B, to_c = C - B, chord = C - A;
    const Bounded size = length(to_a) * length(to_c), w = -(dot(to_a, to_c) / size);
    // The part of b - a that is orthogonal to the chord; its length is sin(angle) |to_a| |to_c| / |chord|.
    const Vector<D> offset = (B - A) - dot(B - A, chord) / dot(chord, chord) * chord;
    const Vector<D> v = w * (Bounded(0.5) * (A + C)) + Bounded(0.5) * dot(chord, chord) / size * offset;
    return scaled_back(halves<D>(A, v, w, C, std::cos(widest / 2) * (1 - 8 * kUnitRoundoff)), e);
}

template <int D>
Result<ConicArc<D>> weighted_arc(const Vec<D>& a, const Vec<D>& corner, const Vec<D>& c, double weight) {
    if (auto ok = check_points<D>({{"a", a}, {"corner", corner}, {"c", c}}); !ok)
        return std::unexpected(ok.error());
    if (!std::isfinite(weight))
        return refuse(RefusalKind::nonfinite, "weight", text(weight, " is not finite"));
    if (weight == 0) return refuse(RefusalKind::invalid, "weight", "is 0: the chord, not a conic");
    if (!(weight > -1))
        return refuse(RefusalKind::invalid, "weight",
                      text(weight, " is not above -1: the arc would go through infinity"));
    if (collinear(a, corner, c))
        return refuse(RefusalKind::invalid, "corner", "a, corner and c are on one line");
    const Bounded w = weight;
    return halves<D>(bounded::vector(a), w * bounded::vector(corner), w, bounded::vector(c),
                     weight > 0 ? 0 : std::sqrt(0.5));
}

Result<ConicArc<2>> tangent_arc(const Vec<2>& a, const Vec<2>& at_a, const Vec<2>& c, const Vec<2>& at_c,
                                const Vec<2>& through) {
    if (auto ok = check_points<2>({{"a", a}, {"at_a", at_a}, {"c", c}, {"at_c", at_c}, {"through", through}});
        !ok)
        return std::unexpected(ok.error());
    if (max_abs(at_a) == 0) return refuse(RefusalKind::invalid, "at_a", "is zero");
    if (max_abs(at_c) == 0) return refuse(RefusalKind::invalid, "at_c", "is zero");
    const auto none = [](const char* where, const char* why) {
        return refuse(RefusalKind::no_answer, where, why);
    };
    const auto unclear = [] {
        return refuse(RefusalKind::ill_conditioned, "through",
                      "rounding does not tell on which side of the tangents or the chord it is");
    };
    const int e = exponent_of<2>({a, c, through});
    const Vector<2> A = bounded::vector(scaled(a, -e)), C = bounded::vector(scaled(c, -e)),
                    P = bounded::vector(scaled(through, -e));
    const Vec<2> ta = scaled(at_a, -std::ilogb(max_abs(at_a))), tc = scaled(at_c, -std::ilogb(max_abs(at_c)));
    const Vector<2> s = bounded::vector(ta), t = bounded::vector(tc), chord = C - A, to_p = P - A;
    const auto turn = [](const Vector<2>& u, const Vector<2>& v) { return u[0] * v[1] - u[1] * v[0]; };
    constexpr double kLeast = 0x1.6a09e667f3bcp-1;  // a little less than cos 45 degrees

    if (orient2d({}, ta, tc) == 0) {  // parallel
        if (dot(ta, tc) > 0)
            return none("at_c", "is the direction at a: an arc of a conic does not come back to it");
        // p - a = t2 chord + k ta
        const Bounded area = turn(chord, s);
        if (!area.excludes_zero()) return none("at_a", "is parallel to the chord");
        const Bounded t2 = turn(to_p, s) / area, k = turn(chord, to_p) / area,
                      product = t2 * (Bounded(1) - t2);
        if (!product.excludes_zero() || !k.excludes_zero()) return unclear();
        if (product.value < 0) return none("through", "is not between the parallel tangents");
        if (k.value < 0) return none("through", "is on the wrong side of the chord for these tangents");
        return scaled_back(halves<2>(A, k / sqrt(Bounded(4) * product) * s, 0, C, kLeast), e);
    }
    const Bounded area = turn(s, t), alpha = turn(chord, t) / area, gamma = turn(s, chord) / area;
    if (!alpha.excludes_zero() || !gamma.excludes_zero())
        return refuse(RefusalKind::ill_conditioned, "at_a",
                      "a tangent is parallel to the chord, as far as "
                      "rounding tells");
    if ((alpha.value > 0) != (gamma.value > 0))
        return none("at_c", "the tangents ask for an inflection, which conics have not");
    // p = t0 a + t1 corner + t2 c, corner = a + alpha s.
    const Bounded both = turn(alpha * s, chord), t1 = turn(to_p, chord) / both,
                  t2 = turn(alpha * s, to_p) / both, t0 = Bounded(1) - t1 - t2, product = t0 * t2;
    if (!product.excludes_zero() || !t1.excludes_zero()) return unclear();
    if (product.value < 0 || t0.value < 0) return none("through", "is not between the tangents");
    if ((t1.value > 0) != (alpha.value > 0))
        return none("through", "is on the wrong side of the chord for these tangents");
    const Bounded w = t1 / sqrt(Bounded(4) * product);
    if (!(w.value > -1)) return none("through", "needs a hyperbola that goes through infinity");
    return scaled_back(halves<2>(A, w * A + w * alpha * s, w, C, w.value > 0 ? 0 : kLeast), e);
}

#define FF_CONIC(D)                                                                                \
    template Result<ConicArc<D>> conic_arc(const FoundConic<D>&, Interval, double);                \
    template Result<ConicArc<D>> full_ellipse(const Conic<D>&, EllipseForm);                       \
    template Result<ConicArc<D>> arc_through(const Vec<D>&, const Vec<D>&, const Vec<D>&, double); \
    template Result<ConicArc<D>> weighted_arc(const Vec<D>&, const Vec<D>&, const Vec<D>&, double);
FF_CONIC(2)
FF_CONIC(3)
#undef FF_CONIC

}  // namespace freiform
