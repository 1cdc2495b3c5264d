// Surfaces of revolution.
//
// Idea: to turn a point x = c + p (c on the axis, p orthogonal to it) by t about an axis of direction k is
//     c + cos(t) p + sin(t) k x p,
// linear in x and its weight. So every column of control points of the surface is the column of the profile
// under one linear map of homogeneous coordinates, whatever the degree, the knots and the weights of the
// profile are.
//
// Method: of an arc over [m - h, m + h] the coefficients, with weights 1, cos h, 1, are
//     c + cos(m -+ h) p + sin(m -+ h) k x p    and    cos(h) c + cos(m) p + sin(m) k x p   (see conic.cpp).
// A Station is such a triple (weight, cos, sin) -> weight c + cos p + sin k x p. A cubic arc of angle a has
// the stations 1, 1 + i z at its beginning and e^(ia) (1 - i z), e^(ia) at its end, z = 4/3 tan(a/4), written
// as complex numbers cos + i sin. Neighbouring arcs of equal angle have equal derivatives, so they join with
// double knots, and the stations at joints are no coefficients.
//
// Accuracy: all is computed with bounds (rounding_detail.hpp). Of the cubic arc q(s), |q|^2 - 1 has degree 6
// and double zeros at 0, 1/2 and 1, where the arc touches the circle: it touches at the ends by construction,
// at 1/2 because cos(a/2) + 3/4 z sin(a/2) = 1, with a tangent that is orthogonal by symmetry. So it is
// |d|^2 / 4 s^2 (1-s)^2 (1-2s)^2 with d the leading coefficient of q, the third difference of its
// coefficients, |d| = 8 T^3 / (1 + T^2), T = tan(a/4). The maximum of the product is 1/108. Hence
//     0 <= |q| - 1 <= |d|^2 / 864 = 2/27 T^6 / (1 + T^2)^2 = eps,
// attained but for terms of higher order. Points of the surface are c + q p, their nearest ones on the circle
// of the same v are at a distance | |q| - 1 | |p| <= eps max |p|; and as the angle of q runs over all of [0,
// a], every point of the circle has one of the cubic that is as near. max |p| comes from the convex hulls of
// sixteen parts of each piece of p(v), a curve itself.
//     Knots k/n are rounded by 2^-54 at most. With lengths h, h' of neighbouring spans, off by 2^-53 each,
//     the
// joint divides the leg from e^(ia) (1 - iz) to e^(ia) (1 + iz) not in the middle, but off by |h' - h| / (2
// (h
// + h')) < 1.01 n 2^-54 of its length 2 |z|; n |z| <= 8/3, because n >= 2 where there are joints and n arcs
// are at most a full turn. So joints, and with them the points between, move by 3 2^-53 |p| at most.
//
//     Turning keeps distances: a polynomial curve within e of a rational profile, parameter by parameter, has
//     a
// surface within e of that of the profile, turned by the same angle. So bounds add up.
//
// References: [PT97, 8.5] for the rational surface; [Goldapp 1991] for cubic arcs.
//
// Why not the best cubic arcs, which stay on both sides of the circle and are twice as near? Their ends are
// off the circle, or their tangents are; so the surface would not begin at its profile.
#include "rounding_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/polynomial_near.hpp>
#include <freiform/make/revolve.hpp>
#include <freiform/spline/bezier.hpp>

#include <numbers>

namespace freiform {

SurfaceGeometry revolution(CurveGeometry<3> profile, const Vec<3>& origin, const Vec<3>& axis) {
    const auto* l = std::get_if<Line<3>>(&profile);
    if (l != nullptr && norm(cross(l->direction, axis)) <= 4 * kUnitRoundoff * norm(l->direction)) {
        const Vec<3> centre = origin + dot(l->origin - origin, axis) * axis, x = l->origin - centre;
        if (norm(x) > 0)
            return Extrusion{Conic<3>{ConicKind::ellipse, centre, x, cross(axis, x)}, l->direction,
                             SurfaceKind::cylinder};
    }
    return Revolution{std::move(profile), origin, axis};
}

namespace {

using detail::cosine;
using detail::sine;

// More arcs than that are never better: at 2^14 arcs of a full turn eps is 2^-83, far below rounding.
constexpr int kMostPieces = 1 << 14;
// Of the tolerance, for rational profiles: a profile needs about x^-1/4 pieces, arcs (1 - x)^-1/6, and their
// product is least at 3/5.
constexpr double kForProfile = 0.6;

Result<void> check(const Axis& axis, double angle) {
    if (!is_finite(axis.origin)) return refuse(RefusalKind::nonfinite, "axis.origin", "is not finite");
    if (!is_finite(axis.direction)) return refuse(RefusalKind::nonfinite, "axis.direction", "is not finite");
    if (max_abs(axis.direction) == 0) return refuse(RefusalKind::invalid, "axis.direction", "is zero");
    if (!std::isfinite(angle)) return refuse(RefusalKind::nonfinite, "angle", text(angle, " is not finite"));
    if (angle == 0) return refuse(RefusalKind::invalid, "angle", "is 0: it sweeps no surface");
    if (std::abs(angle) > kTwoPi)
        return refuse(RefusalKind::invalid, "angle", text(angle, " is more than a full turn, 2 pi"));
    return {};
}

Result<void> check_tolerance(double tolerance) {
    if (tolerance > 0) return {};
    return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a positive distance"));
}

// One coefficient of the profile, taken apart: x = centre + arm, and the arm turned by 90 degrees.
struct Arm {
    BoundedVec<3> centre, arm, turned;
    Bounded w;
};

struct Station {
    Bounded weight = 1, cos = 1, sin = 0;
    bool first = false;  // angle 0 and weight 1: the profile itself
};

detail::SpaceCoefficient at(const Station& s, const Arm& a) {
    detail::SpaceCoefficient c;
    for (std::size_t i = 0; i < 3; ++i)
        c.x[i] = s.weight * a.centre[i] + s.cos * a.arm[i] + s.sin * a.turned[i];
    c.w = s.weight * a.w;
    return c;
}

template <class P>
class Turning {
public:
    Turning(const Curve<P>& profile, const Axis& axis) : profile_(profile) {
        powers_.include(profile);
        powers_.include(axis.origin);
        const int e = std::ilogb(max_abs(axis.direction));
        BoundedVec<3> k{}, o = powers_.vector(axis.origin);
        for (int i = 0; i < 3; ++i) k[std::size_t(i)] = detail::scaled(axis.direction[i], -e);
        const Bounded length = sqrt(dot(k, k));
        for (Bounded& x : k) x /= length;
        for (const P& p : profile.net().flat()) {
            const auto c = powers_.coefficient(p);
            BoundedVec<3> r = c.x;
            for (std::size_t i = 0; i < 3; ++i) r[i] -= c.w * o[i];
            const Bounded height = dot(r, k);
            Arm a{c.x, r, cross(k, r), c.w};
            for (std::size_t i = 0; i < 3; ++i) {
                a.arm[i] -= height * k[i];
                a.centre[i] -= a.arm[i];
                on_axis_ = on_axis_ && !a.arm[i].excludes_zero();
            }
            arms_.push_back(a);
        }
    }

    Result<void> check_arms() const {
        if (on_axis_)
            return refuse(RefusalKind::ill_conditioned, "profile",
                          "lies on the axis, as far as rounding tells: it sweeps no surface");
        return {};
    }

    template <class Q>
    Result<MadeSurface<Q>> surface(const std::vector<Station>& stations, Result<BSplineBasis> basis) const {
        if (!basis) return std::unexpected(basis.error());
        detail::SurfaceNet<Q> net(powers_);
        for (const Station& s : stations)
            for (std::size_t j = 0; j < arms_.size(); ++j) {
                if (s.first)
                    net.add_exact(profile_.net().flat()[j]);
                else
                    net.add(at(s, arms_[j]));
            }
        const double bound = net.bound();
        auto surface = Surface<Q>::make({std::move(*basis), profile_.basis()},
                                        Net<2, Q>({int(stations.size()), int(arms_.size())}, net.take()));
        if (!surface) return std::unexpected(surface.error());
        if (!std::isfinite(bound))
            return refuse(RefusalKind::ill_conditioned, "profile", "rounding leaves nothing of its weights");
        return MadeSurface<Q>{std::move(*surface), bound};
    }

    // At least the distance of every point of the profile from the axis. Of polynomial profiles.
    double reach() const {
        std::vector<Vec<3>> c;
        double error = 0, hull = 0;
        for (const Arm& a : arms_) {
            Vec<3> p, e;
            for (int i = 0; i < 3; ++i)
                p[i] = a.arm[std::size_t(i)].value, e[i] = a.arm[std::size_t(i)].bound;
            c.push_back(p);
            error = std::max(error, norm(e));
            hull = std::max(hull, norm(p));
        }
        const int n = int(c.size());
        const auto pieces =
            decompose(Curve<Vec<3>>::trusted({profile_.basis()}, Net<1, Vec<3>>({n}, std::move(c))));
        double most = 0;
        for (int i = 0; i < pieces.extent()[0]; ++i)
            for (int part = 0; part < kParts; ++part) {
                const auto piece = pieces.net({i});
                std::vector<Vec<3>> b;
                for (int k = 0; k <= pieces.degree(0); ++k) b.push_back(piece({k}));
                const Fibre<Vec<3>> fibre{b.data(), int(b.size()), 1};
                keep_left(fibre, double(part + 1) / kParts);
                keep_right(fibre, double(part) / (part + 1));
                for (const Vec<3>& p : b) most = std::max(most, norm(p));
            }
        // Extraction and two splits round by less than 2^-44 of the largest coordinate.
        const double r = most + error + hull * 0x1p-43;
        return std::scalbn(r * (1 + 0x1p-48), powers_.point());
    }

private:
    static constexpr int kParts = 16;
    const Curve<P>& profile_;
    detail::Powers powers_;
    std::vector<Arm> arms_;
    bool on_axis_ = true;
};

// Double knots at 1/n, 2/n, ..; open ones are clamped.
Result<BSplineBasis> turning_basis(int degree, int n, bool closed) {
    std::vector<double> t(closed ? 1 : std::size_t(degree) + 1, 0.0);
    for (int i = 1; i <= n; ++i) t.insert(t.end(), 2, double(i) / n);
    if (!closed) t.insert(t.end(), std::size_t(degree) - 1, 1.0);
    return closed ? BSplineBasis::periodic(degree, std::move(t)) : BSplineBasis::make(degree, std::move(t));
}

// Of a full turn, to the sign of its sense: quarters, whose cosines and sines are 0, 1 and -1.
std::vector<Station> full_turn(double sense, bool closed) {
    constexpr double kCos[] = {1, 0, -1, 0, 1}, kSin[] = {0, 1, 0, -1, 0};
    const Bounded w(std::sqrt(0.5), kUnitRoundoff);
    std::vector<Station> out;
    for (int k = 0; k < 4; ++k) {
        out.push_back({1, kCos[k], sense * kSin[k], k == 0});
        out.push_back(
            {w, w * Bounded(kCos[k] + kCos[k + 1]), w * Bounded(sense * (kSin[k] + kSin[k + 1])), false});
    }
    if (!closed) out.push_back({1, 1, 0, true});
    return out;
}

std::vector<Station> arcs(double angle, int n) {
    const auto joint = [&](int k) { return k == n ? angle : angle * k / n; };
    std::vector<Station> out{{1, 1, 0, true}};
    for (int k = 0; k < n; ++k) {
        const Bounded from = joint(k), to = joint(k + 1), half(0.5), m = half * (from + to);
        out.push_back({cosine(half * (to - from)), cosine(m), sine(m), false});
        out.push_back({1, cosine(to), sine(to), false});
    }
    return out;
}

// Of n cubic arcs; joints are no coefficients. A closed basis begins with the end of its last arc.
std::vector<Station> cubic_arcs(double angle, int n, bool closed) {
    const Bounded step = Bounded(angle) / Bounded(n), quarter = Bounded(0.25) * step,
                  z = Bounded(4) / Bounded(3) * (sine(quarter) / cosine(quarter));
    std::vector<Station> out;
    if (!closed) out.push_back({1, 1, 0, true});
    for (int k = 0; k < n; ++k) {
        for (const double side : {1.0, -1.0}) {
            const int joint = side > 0 ? k : k + 1;
            const Bounded t = Bounded(joint) * step, zs = Bounded(side) * z;
            const Bounded c = joint == 0 ? Bounded(1) : cosine(t), s = joint == 0 ? Bounded(0) : sine(t);
            out.push_back({1, c - zs * s, s + zs * c, false});
        }
    }
    if (!closed && std::abs(angle) == kTwoPi) out.push_back({1, 1, 0, true});
    if (!closed && std::abs(angle) != kTwoPi) out.push_back({1, cosine(angle), sine(angle), false});
    if (closed) std::rotate(out.begin(), out.end() - 1, out.end());
    return out;
}

// The eps of the essay, rounded up; of arcs of at most 180 degrees.
double off_circle(double angle, int n) {
    const double t = std::tan(std::abs(angle) / n / 4);
    return 2.0 / 27 * std::pow(t, 6) / ((1 + t * t) * (1 + t * t)) * (1 + 0x1p-44);
}

int fewest(double angle, double widest) {
    return std::max(1, int(std::ceil(std::abs(angle) / widest - 0x1p-40)));
}

}  // namespace

template <class P>
Result<MadeSurface<Hom<3>>> revolve(const Curve<P>& profile, const Axis& axis, double angle, Seam seam) {
    if (auto ok = check(axis, angle); !ok) return std::unexpected(ok.error());
    const Turning<P> turning(profile, axis);
    if (auto ok = turning.check_arms(); !ok) return std::unexpected(ok.error());
    if (std::abs(angle) == kTwoPi)
        return turning.template surface<Hom<3>>(full_turn(angle > 0 ? 1 : -1, seam == Seam::closed),
                                                turning_basis(2, 4, seam == Seam::closed));
    const int n = fewest(angle, std::numbers::pi / 2);
    return turning.template surface<Hom<3>>(arcs(angle, n), turning_basis(2, n, false));
}

template <int D>
Result<RevolvedPolynomial> revolve_polynomial(const Curve<Vec<D>>& profile, const Axis& axis, double angle,
                                              double tolerance, Seam seam) {
    if (auto ok = check(axis, angle); !ok) return std::unexpected(ok.error());
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    const Turning<Vec<D>> turning(profile, axis);
    if (auto ok = turning.check_arms(); !ok) return std::unexpected(ok.error());
    const bool closed = std::abs(angle) == kTwoPi && seam == Seam::closed;
    const double reach = turning.reach(), knots = 3 * kUnitRoundoff * reach;
    double room = tolerance;  // less what rounding moves, once that is known
    for (int round = 0; round < 8; ++round) {
        int n = fewest(angle, std::numbers::pi);
        while (n < kMostPieces && !(reach * off_circle(angle, n) <= room)) ++n;
        auto made =
            turning.template surface<Vec<3>>(cubic_arcs(angle, n, closed), turning_basis(3, n, closed));
        if (!made) return std::unexpected(made.error());
        const double rounding = (made->bound + knots) * (1 + 0x1p-48);
        const double bound = (rounding + reach * off_circle(angle, n)) * (1 + 0x1p-48);
        if (bound <= tolerance) return RevolvedPolynomial{std::move(made->surface), bound, n};
        room = tolerance - 2 * rounding;
        if (!(room > 0))
            return refuse(RefusalKind::ill_conditioned, "tolerance",
                          text(tolerance, " is too small: rounding alone may move points by ", rounding));
    }
    return refuse(RefusalKind::ill_conditioned, "tolerance",
                  text(tolerance, " is too small: it was not reached beside rounding"));
}

template <int D>
Result<RevolvedPolynomial> revolve_polynomial(const Curve<Hom<D>>& profile, const Axis& axis, double angle,
                                              double tolerance, Seam seam) {
    if (auto ok = check(axis, angle); !ok) return std::unexpected(ok.error());
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    const auto near = polynomial_near(profile, kForProfile * tolerance);
    if (!near) return refuse_within("profile", near.error());
    auto made = revolve_polynomial(near->curve, axis, angle,
                                   (tolerance - near->bound) * (1 - kUnitRoundoff * 4), seam);
    if (made) made->bound = std::min((made->bound + near->bound) * (1 + 0x1p-52), tolerance);
    return made;
}

template Result<MadeSurface<Hom<3>>> revolve(const Curve<Vec<2>>&, const Axis&, double, Seam);
template Result<MadeSurface<Hom<3>>> revolve(const Curve<Hom<2>>&, const Axis&, double, Seam);
template Result<MadeSurface<Hom<3>>> revolve(const Curve<Vec<3>>&, const Axis&, double, Seam);
template Result<MadeSurface<Hom<3>>> revolve(const Curve<Hom<3>>&, const Axis&, double, Seam);
template Result<RevolvedPolynomial> revolve_polynomial(const Curve<Vec<2>>&, const Axis&, double, double,
                                                       Seam);
template Result<RevolvedPolynomial> revolve_polynomial(const Curve<Vec<3>>&, const Axis&, double, double,
                                                       Seam);

template Result<RevolvedPolynomial> revolve_polynomial(const Curve<Hom<2>>&, const Axis&, double, double,
                                                       Seam);
template Result<RevolvedPolynomial> revolve_polynomial(const Curve<Hom<3>>&, const Axis&, double, double,
                                                       Seam);

}  // namespace freiform
