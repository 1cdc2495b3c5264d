// Idea. Every analytic type of Open CASCADE is a placement (origin O, directions X, Y, Z) and radii, with a
// parametrisation that its documentation fixes; our Line, Conic, Extrusion and Revolution express the same
// formula. A placement may be left-handed (Z = -X x Y), which the formulas allow for: the angle always turns
// from X to Y, so that the axis of a revolution is X x Y.
//
//     plane    O + u X + v Y                                  extrusion of a line
//     cylinder O + R (cos u X + sin u Y) + v Z                extrusion of a circle
//     cone     O + (R + v sin a)(cos u X + sin u Y) + v cos a Z             revolution of a line
//     sphere   O + R cos v (cos u X + sin u Y) + R sin v Z                  revolution of a circle
//     torus    O + (R + r cos v)(cos u X + sin u Y) + r sin v Z             revolution of a circle
//
// Periodic splines. Let t_0 .. t_n be the knots of one period T, each as often as its multiplicity, but of
// the first knot only one copy: t_0 is its last one, and t_n the last copy of the last knot. On [t_0, t_1)
// the coefficients 0 .. p act. So in the unwound numbering, where coefficients s-p .. s act on [t_s,
// t_{s+1}), coefficient i is number i + p modulo n, and t_{j+n} = t_j + T. The spline that is open and has
// just the knots and coefficients that act on the range is the same function there.
#include "geometry.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/revolve.hpp>

#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Hyperbola.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_Parabola.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform::occt {

namespace {

Vec<3> vec(const gp_XYZ& p) { return {{p.X(), p.Y(), p.Z()}}; }
Vec<2> vec(const gp_XY& p) { return {{p.X(), p.Y()}}; }
template <class P>
auto vec(const P& p) {
    if constexpr (requires { p.XYZ(); })
        return vec(p.XYZ());
    else
        return vec(p.XY());
}

// The basis that a direction of a spline has on `range`, and the number of the first coefficient that acts.
struct Unwound {
    BSplineBasis basis;
    int first = 0;
};

Result<Unwound> unwind(int degree, bool periodic, const TColStd_Array1OfReal& knots,
                       const TColStd_Array1OfInteger& multiplicities, Interval range) {
    const int count = knots.Length();
    std::vector<double> t;
    for (int k = 1; k <= count; ++k)
        t.insert(t.end(), std::size_t(periodic && k == 1 ? 1 : multiplicities(k)), knots(k));
    if (!periodic) {
        auto basis = BSplineBasis::make(degree, std::move(t));
        if (!basis) return std::unexpected(basis.error());
        return Unwound{std::move(*basis), 0};
    }
    const int n = int(t.size()) - 1;
    const double last = knots(count), period = last - knots(1);
    // The first knot and the last are one place of the closed spline: all their copies have to get the same
    // number, or rounding would open a span between them.
    const auto seam = [&](long long turn) {
        return turn > 0 ? last + double(turn - 1) * period : knots(1) + double(turn) * period;
    };
    const auto knot = [&](long long j) {
        const long long turn = j >= 0 ? j / n : -((n - 1 - j) / n);
        const auto k = std::size_t(j - turn * n);
        return k == 0 ? seam(turn) : t[k] == last ? seam(turn + 1) : t[k] + double(turn) * period;
    };
    if (!(period > 0) || !(range.lo <= range.hi) || range.hi - range.lo > 1e4 * period ||
        std::abs(range.lo) > 1e6 * (period + std::abs(last)))
        return refuse(RefusalKind::limit, "periodic spline",
                      text("the range [", range.lo, ", ", range.hi, "] is too many periods of ", period));
    // What is beyond a knot by rounding asks for no span more: a surface over more than its period would
    // overlap itself, which other programs do not understand.
    const double slack = 64 * kUnitRoundoff * (std::abs(range.lo) + std::abs(range.hi) + period);
    range = range.length() > 4 * slack ? Interval{range.lo + slack, range.hi - slack} : range;
    long long from = (long long)(std::floor((range.lo - knots(1)) / period)) * n;
    while (knot(from) > range.lo) --from;
    while (knot(from + 1) <= range.lo) ++from;
    long long to = from + 1;
    while (knot(to) < range.hi) ++to;
    std::vector<double> unwound;
    for (long long j = from - degree; j <= to + degree; ++j) unwound.push_back(knot(j));
    for (std::size_t i = 1; i < unwound.size(); ++i)  // rounding of t + turn * period
        unwound[i] = std::max(unwound[i], unwound[i - 1]);
    auto basis = BSplineBasis::make(degree, std::move(unwound));
    if (!basis) return std::unexpected(basis.error());
    const long long first = from % n;
    return Unwound{std::move(*basis), int(first < 0 ? first + n : first)};
}

template <std::size_t N, class P, class G>
Result<G> patch(const std::array<BSplineBasis, N>& bases, Net<N, P> net) {
    auto s = Patch<N, P>::make(bases, std::move(net));
    if (!s) return std::unexpected(s.error());
    return G(std::move(*s));
}

// A spline curve from any source of poles and weights.
template <int D, class C>
Result<CurveGeometry<D>> spline(const C& c, const Unwound& u) {
    const int poles = c.NbPoles(), n = u.basis.size();
    const bool rational = c.IsRational();
    std::vector<Vec<D>> polynomial;
    std::vector<Hom<D>> weighted_poles;
    for (int i = 0; i < n; ++i) {
        const int k = 1 + (u.first + i) % poles;
        const Vec<D> x = vec(c.Pole(k));
        if (rational)
            weighted_poles.push_back(weighted(x, c.Weight(k)));
        else
            polynomial.push_back(x);
    }
    if (rational) return patch<1, Hom<D>, CurveGeometry<D>>({u.basis}, {{n}, std::move(weighted_poles)});
    return patch<1, Vec<D>, CurveGeometry<D>>({u.basis}, {{n}, std::move(polynomial)});
}

template <class S>
Result<SurfaceGeometry> spline_surface(const S& s, const Unwound& u, const Unwound& v) {
    const int nu = u.basis.size(), nv = v.basis.size();
    const bool rational = s.IsURational() || s.IsVRational();
    std::vector<Vec<3>> polynomial;
    std::vector<Hom<3>> weighted_poles;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const int k = 1 + (u.first + i) % s.NbUPoles(), l = 1 + (v.first + j) % s.NbVPoles();
            const Vec<3> x = vec(s.Pole(k, l));
            if (rational)
                weighted_poles.push_back(weighted(x, s.Weight(k, l)));
            else
                polynomial.push_back(x);
        }
    if (rational)
        return patch<2, Hom<3>, SurfaceGeometry>({u.basis, v.basis}, {{nu, nv}, std::move(weighted_poles)});
    return patch<2, Vec<3>, SurfaceGeometry>({u.basis, v.basis}, {{nu, nv}, std::move(polynomial)});
}

Result<Unwound> bezier_basis(int degree) {
    auto basis = BSplineBasis::bezier(degree);
    if (!basis) return std::unexpected(basis.error());
    return Unwound{std::move(*basis), 0};
}

// The types of curves, which have the same names and members in the plane and in space.
struct Types3 {
    using Trimmed = Geom_TrimmedCurve;
    using Line = Geom_Line;
    using Circle = Geom_Circle;
    using Ellipse = Geom_Ellipse;
    using Hyperbola = Geom_Hyperbola;
    using Parabola = Geom_Parabola;
    using Bezier = Geom_BezierCurve;
    using BSpline = Geom_BSplineCurve;
};
struct Types2 {
    using Trimmed = Geom2d_TrimmedCurve;
    using Line = Geom2d_Line;
    using Circle = Geom2d_Circle;
    using Ellipse = Geom2d_Ellipse;
    using Hyperbola = Geom2d_Hyperbola;
    using Parabola = Geom2d_Parabola;
    using Bezier = Geom2d_BezierCurve;
    using BSpline = Geom2d_BSplineCurve;
};

template <int D, class T, class C>
Result<CurveGeometry<D>> any_curve(Handle(C) c, Interval range) {
    for (int depth = 0; depth < 100 && !c.IsNull() && c->IsKind(STANDARD_TYPE(T::Trimmed)); ++depth)
        c = Handle(typename T::Trimmed)::DownCast(c)->BasisCurve();
    if (c.IsNull()) return refuse(RefusalKind::unreadable, "curve", "is missing");
    const auto conic = [](ConicKind kind, const auto& g, double a, double b) -> CurveGeometry<D> {
        return Conic<D>{kind, vec(g.Location()), a * vec(g.XAxis().Direction()),
                        b * vec(g.YAxis().Direction())};
    };
    if (auto l = Handle(typename T::Line)::DownCast(c); !l.IsNull()) {
        const auto p = l->Position();
        return Line<D>{vec(p.Location()), vec(p.Direction())};
    }
    if (auto g = Handle(typename T::Circle)::DownCast(c); !g.IsNull())
        return conic(ConicKind::ellipse, *g, g->Radius(), g->Radius());
    if (auto g = Handle(typename T::Ellipse)::DownCast(c); !g.IsNull())
        return conic(ConicKind::ellipse, *g, g->MajorRadius(), g->MinorRadius());
    if (auto g = Handle(typename T::Hyperbola)::DownCast(c); !g.IsNull())
        return conic(ConicKind::hyperbola, *g, g->MajorRadius(), g->MinorRadius());
    if (auto g = Handle(typename T::Parabola)::DownCast(c); !g.IsNull())
        return conic(ConicKind::parabola, *g, 1 / (4 * g->Focal()), 1);
    if (auto g = Handle(typename T::Bezier)::DownCast(c); !g.IsNull()) {
        auto u = bezier_basis(g->Degree());
        if (!u) return std::unexpected(u.error());
        return spline<D>(*g, *u);
    }
    if (auto g = Handle(typename T::BSpline)::DownCast(c); !g.IsNull()) {
        auto u = unwind(g->Degree(), g->IsPeriodic(), g->Knots(), g->Multiplicities(), range);
        if (!u) return std::unexpected(u.error());
        return spline<D>(*g, *u);
    }
    return refuse(RefusalKind::unsupported, "curve",
                  text("a curve of type ", c->DynamicType()->Name(), " has no exact counterpart"));
}

Vec<3> at(const gp_Ax3& a) { return vec(a.Location()); }
// The angle u turns right-handed about this axis.
Vec<3> turning_axis(const gp_Ax3& a) { return unit(cross(vec(a.XDirection()), vec(a.YDirection()))); }

Result<SurfaceGeometry> revolved(const gp_Ax3& a, CurveGeometry<3> profile, SurfaceKind kind) {
    return Revolution{std::move(profile), at(a), turning_axis(a), kind};
}
Result<SurfaceGeometry> cylinder(const gp_Ax3& a, double r) {
    return Extrusion{Conic<3>{ConicKind::ellipse, at(a), r * vec(a.XDirection()), r * vec(a.YDirection())},
                     vec(a.Direction()), SurfaceKind::cylinder};
}
Result<SurfaceGeometry> sphere(const gp_Ax3& a, double r) {
    return revolved(a, Conic<3>{ConicKind::ellipse, at(a), r * vec(a.XDirection()), r * vec(a.Direction())},
                    SurfaceKind::sphere);
}
Result<SurfaceGeometry> torus(const gp_Ax3& a, double major, double minor) {
    return revolved(a,
                    Conic<3>{ConicKind::ellipse, at(a) + major * vec(a.XDirection()),
                             minor * vec(a.XDirection()), minor * vec(a.Direction())},
                    SurfaceKind::torus);
}
Result<SurfaceGeometry> plane(const gp_Ax3& a, double offset) {
    const Vec<3> n = turning_axis(a);
    return Extrusion{Line<3>{at(a) + offset * n, vec(a.XDirection())}, vec(a.YDirection()),
                     SurfaceKind::plane};
}

// The elementary surfaces, `offset` along their normal S_u x S_v, as long as they stay what they are.
// Empty for other surfaces.
std::optional<Result<SurfaceGeometry>> elementary(const Handle(Geom_Surface) & s, double offset) {
    const auto outward = [&](const gp_Ax3& a) { return a.Direct() ? offset : -offset; };
    if (auto g = Handle(Geom_Plane)::DownCast(s); !g.IsNull()) return plane(g->Position(), offset);
    if (auto g = Handle(Geom_CylindricalSurface)::DownCast(s); !g.IsNull())
        if (const double r = g->Radius() + outward(g->Position()); r > 0) return cylinder(g->Position(), r);
    if (auto g = Handle(Geom_SphericalSurface)::DownCast(s); !g.IsNull())
        if (const double r = g->Radius() + outward(g->Position()); r > 0) return sphere(g->Position(), r);
    if (auto g = Handle(Geom_ToroidalSurface)::DownCast(s); !g.IsNull())
        if (const double r = g->MinorRadius() + outward(g->Position()); r > 0 && g->MajorRadius() > r)
            return torus(g->Position(), g->MajorRadius(), r);
    if (auto g = Handle(Geom_ToroidalSurface)::DownCast(s); !g.IsNull() && offset == 0)
        return torus(g->Position(), g->MajorRadius(), g->MinorRadius());
    if (auto g = Handle(Geom_ConicalSurface)::DownCast(s); !g.IsNull() && offset == 0) {
        const gp_Ax3& a = g->Position();
        const Vec<3> x = vec(a.XDirection());
        return revolved(a,
                        Line<3>{at(a) + g->RefRadius() * x,
                                std::sin(g->SemiAngle()) * x + std::cos(g->SemiAngle()) * vec(a.Direction())},
                        SurfaceKind::cone);
    }
    return std::nullopt;
}

// Through trimmings and offsets to the surface they are made of, with the sum of the offsets.
Handle(Geom_Surface) unwrapped(Handle(Geom_Surface) s, double& offset) {
    for (int depth = 0; depth < 100 && !s.IsNull(); ++depth) {
        if (auto t = Handle(Geom_RectangularTrimmedSurface)::DownCast(s); !t.IsNull()) {
            s = t->BasisSurface();
        } else if (auto o = Handle(Geom_OffsetSurface)::DownCast(s); !o.IsNull()) {
            offset += o->Offset();
            s = o->BasisSurface();
        } else {
            break;
        }
    }
    return s;
}

}  // namespace

Result<CurveGeometry<3>> curve(const Handle(Geom_Curve) & c, Interval range) {
    return any_curve<3, Types3, Geom_Curve>(c, range);
}
Result<CurveGeometry<2>> curve(const Handle(Geom2d_Curve) & c, Interval range) {
    return any_curve<2, Types2, Geom2d_Curve>(c, range);
}

Result<SurfaceGeometry> surface(const Handle(Geom_Surface) & outer, const std::array<Interval, 2>& range) {
    double offset = 0;
    const Handle(Geom_Surface) s = unwrapped(outer, offset);
    if (s.IsNull()) return refuse(RefusalKind::unreadable, "surface", "is missing");
    if (auto simple = elementary(s, offset)) return *simple;
    const auto base = [&]() -> Result<SurfaceGeometry> {
        if (auto simple = elementary(s, 0)) return *simple;
        if (auto g = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(s); !g.IsNull()) {
            auto profile = curve(g->BasisCurve(), range[0]);
            if (!profile) return std::unexpected(profile.error());
            return Extrusion{std::move(*profile), vec(g->Direction())};
        }
        if (auto g = Handle(Geom_SurfaceOfRevolution)::DownCast(s); !g.IsNull()) {
            auto profile = curve(g->BasisCurve(), range[1]);
            if (!profile) return std::unexpected(profile.error());
            return revolution(std::move(*profile), vec(g->Axis().Location()), unit(vec(g->Direction())));
        }
        if (auto g = Handle(Geom_BezierSurface)::DownCast(s); !g.IsNull()) {
            auto u = bezier_basis(g->UDegree()), v = bezier_basis(g->VDegree());
            if (!u || !v) return std::unexpected(u ? v.error() : u.error());
            return spline_surface(*g, *u, *v);
        }
        if (auto g = Handle(Geom_BSplineSurface)::DownCast(s); !g.IsNull()) {
            auto u = unwind(g->UDegree(), g->IsUPeriodic(), g->UKnots(), g->UMultiplicities(), range[0]);
            auto v = unwind(g->VDegree(), g->IsVPeriodic(), g->VKnots(), g->VMultiplicities(), range[1]);
            if (!u || !v) return std::unexpected(u ? v.error() : u.error());
            return spline_surface(*g, *u, *v);
        }
        return refuse(RefusalKind::unsupported, "surface",
                      text("a surface of type ", s->DynamicType()->Name(), " has no exact counterpart"));
    }();
    if (!base || offset == 0) return base;
    return OffsetSurface{std::make_shared<const SurfaceGeometry>(std::move(*base)), offset};
}

CurveGeometry<2> in_plane(const CurveGeometry<3>& c, const gp_Pln& pln) {
    const gp_Ax3& a = pln.Position();
    const Vec<3> o = at(a), x = vec(a.XDirection()), y = vec(a.YDirection());
    const auto direction = [&](const Vec<3>& d) { return Vec<2>{{dot(d, x), dot(d, y)}}; };
    const auto point = [&](const Vec<3>& p) { return direction(p - o); };
    return std::visit(
        [&](const auto& g) -> CurveGeometry<2> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                return Line<2>{point(g.origin), direction(g.direction)};
            } else if constexpr (std::same_as<G, Conic<3>>) {
                return Conic<2>{g.kind, point(g.centre), direction(g.x), direction(g.y)};
            } else if constexpr (std::same_as<G, Curve<Vec<3>>>) {
                Net<1, Vec<2>> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = point(g.net().flat()[i]);
                return Curve<Vec<2>>::trusted(g.bases(), std::move(net));
            } else {
                Net<1, Hom<2>> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) {
                    const Hom<3>& h = g.net().flat()[i];
                    net.flat()[i] = weighted(point(project(h)), h.weight());
                }
                return Curve<Hom<2>>::trusted(g.bases(), std::move(net));
            }
        },
        c);
}

Result<CurveGeometry<2>> reparametrised(const CurveGeometry<2>& c, Interval from, Interval to) {
    if (from == to) return c;
    const double speed = from.length() / to.length();
    const auto moved = [&](double knot) {  // both ends exactly, and in order
        const double t = to.lo + (knot - from.lo) / speed;
        return knot == from.hi ? to.hi : knot < from.hi ? std::min(t, to.hi) : std::max(t, to.hi);
    };
    return std::visit(
        [&](const auto& g) -> Result<CurveGeometry<2>> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<2>>) {
                return Line<2>{g.origin + (from.lo - speed * to.lo) * g.direction, speed * g.direction};
            } else if constexpr (std::same_as<G, Conic<2>>) {
                return refuse(RefusalKind::unsupported, "parameter curve",
                              text("a conic runs over [", from.lo, ", ", from.hi, "], its edge over [", to.lo,
                                   ", ", to.hi, "]"));
            } else {
                std::vector<double> knots(g.basis().knots().begin(), g.basis().knots().end());
                for (double& t : knots) t = moved(t);
                auto basis = BSplineBasis::make(g.basis().degree(), std::move(knots));
                if (!basis) return std::unexpected(basis.error());
                return G::trusted({std::move(*basis)}, g.net());
            }
        },
        c);
}

template <int D>
double stretch_to(CurveGeometry<D>& c, Interval range) {
    return std::visit(
        [&](auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (requires { g.net(); }) {
                const Interval on = g.domain()[0];
                const double lack = std::max(on.lo - range.lo, range.hi - on.hi);
                if (!(lack > 0) || lack > 1e-6 * on.length()) return 0.0;
                std::vector<double> knots(g.basis().knots().begin(), g.basis().knots().end());
                for (double& t : knots) {
                    if (t <= on.lo) t = std::min(t, range.lo);
                    if (t >= on.hi) t = std::max(t, range.hi);
                }
                if (auto basis = BSplineBasis::make(g.basis().degree(), std::move(knots))) {
                    g = G::trusted({std::move(*basis)}, g.net());
                    return lack;
                }
            }
            return 0.0;
        },
        c);
}
template double stretch_to(CurveGeometry<2>&, Interval);
template double stretch_to(CurveGeometry<3>&, Interval);

}  // namespace freiform::occt
