// Entities of STEP files, and the geometry among them.
#pragma once
#include "step_elementary.hpp"
#include "step_part21.hpp"
#include "written_point.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/geometry.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <string>
#include <vector>

namespace freiform::detail {

// A real number of the standard has a point.
inline std::string real(double x) {
    std::string s = text(x + 0.0);
    const std::size_t e = s.find('e');
    std::string mantissa = s.substr(0, e);
    if (mantissa.find('.') == std::string::npos) mantissa += '.';
    return e == std::string::npos ? mantissa : mantissa + "E" + s.substr(e + 1);
}

inline std::string quoted(std::string_view name) { return "'" + step::encoded(name) + "'"; }

// The parts between knots where only the place goes on: readers take edges to be smooth.
inline Result<std::vector<CurveGeometry<2>>> without_corners(const CurveGeometry<2>& curve) {
    return visit_one(
        [](const auto& c) -> Result<std::vector<CurveGeometry<2>>> {
            std::vector<CurveGeometry<2>> parts;
            if constexpr (requires { c.net(); }) {
                const Interval on = c.basis().domain();
                double from = on.lo;
                for (const double t : c.basis().breaks()) {
                    if (t <= from || (t < on.hi && c.basis().multiplicity(t) < c.basis().degree())) continue;
                    auto part = restrict_to(c, 0, {from, t});
                    if (!part) return std::unexpected(part.error());
                    parts.push_back(*std::move(part)), from = t;
                }
            } else {
                parts.push_back(c);
            }
            return parts;
        },
        curve);
}

// Outer loops counter-clockwise, holes clockwise, all cut at their corners.
inline Result<OrientedLoops> oriented_loops(const TrimmedSurface& t) {
    const auto sides = visit_one([](const auto& s) { return s.domain(); }, t.surface);
    const double gap = TrimmedSurface::kSlack * std::hypot(sides[0].length(), sides[1].length());
    auto out = orient_loops(t.loops, {gap, gap});
    if (!out) return out;
    for (auto& loop : out->loops) {
        std::vector<CurveGeometry<2>> cut;
        for (const auto& curve : loop) {
            auto parts = without_corners(curve);
            if (!parts) return std::unexpected(parts.error());
            for (auto& part : *parts) cut.push_back(std::move(part));
        }
        loop = std::move(cut);
    }
    return out;
}

template <class List, class F>
std::string listed_as(const List& list, F&& f) {
    std::string s = "(";
    for (const auto& x : list) {
        if (s.size() > 1) s += ',';
        s += f(x);
    }
    return s + ")";
}

class Entities {
public:
    int add(std::string_view body) {
        out += text("#", ++count_, "=", body, ";\n");
        return count_;
    }
    int last() const { return count_; }  // the number of the last one
    static std::string ref(int id) { return text("#", id); }
    static std::string refs(const std::vector<int>& ids) { return listed_as(ids, ref); }

    std::string out;

private:
    int count_ = 0;
};

class StepGeometry {
public:
    explicit StepGeometry(Entities& entities) : e_(entities) {}

    int point(const Vec<3>& p) { return e_.add(text("CARTESIAN_POINT('',", triple(p), ")")); }

    Result<int> curve(const CurveGeometry<3>& c) {
        return visit_one([&](const auto& x) { return one(x); }, c);
    }

    // A curve in space that is the image of a parameter curve of a surface, and says so.
    Result<int> surface_curve(const CurveGeometry<3>& in_space, const CurveGeometry<2>& c, int of_surface) {
        const auto space = curve(in_space);
        if (!space) return space;
        const auto flat = visit_one(
            [&](const auto& x) -> Result<int> {
                if constexpr (requires { x.net(); })
                    return one(x);
                else
                    return refuse(RefusalKind::unsupported, "", "a parameter curve that is no spline");
            },
            c);
        if (!flat) return flat;
        if (parameters_ == 0)
            parameters_ = e_.add(
                "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()REPRESENTATION_"
                "CONTEXT("
                "'2D SPACE',''))");
        const int held = e_.add(text("DEFINITIONAL_REPRESENTATION('',(#", *flat, "),#", parameters_, ")"));
        const int pcurve = e_.add(text("PCURVE('',#", of_surface, ",#", held, ")"));
        return e_.add(text("SURFACE_CURVE('',#", *space, ",(#", pcurve, "),.CURVE_3D.)"));
    }

    Result<int> surface(const SurfaceGeometry& s) {
        return visit_one([&](const auto& x) { return one(x); }, s);
    }

    template <class P>
    Result<int> one(const Curve<P>& given) {
        const auto c = over_domain(given);
        if (!c) return std::unexpected(c.error());
        const auto k = knots(c->basis());
        if (!k) return std::unexpected(k.error());
        const int degree = c->basis().degree();
        const std::string points = Entities::refs(points_of(c->net().flat()));
        if constexpr (!Space<P>::kRational)
            return e_.add(text("B_SPLINE_CURVE_WITH_KNOTS('',", degree, ",", points,
                               ",.UNSPECIFIED.,.F.,.F.,", *k, ",.UNSPECIFIED.)"));
        else
            return e_.add(
                text("(BOUNDED_CURVE()B_SPLINE_CURVE(", degree, ",", points,
                     ",.UNSPECIFIED.,.F.,.F.)B_SPLINE_CURVE_WITH_KNOTS(", *k,
                     ",.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(",
                     weights_of(c->net().flat()), ")REPRESENTATION_ITEM(''))"));
    }

private:
    static std::string triple(const Vec<3>& p) { return listed_as(p.c, real); }
    int direction(const Vec<3>& d) { return e_.add(text("DIRECTION('',", triple(d), ")")); }
    int vector(const Vec<3>& v) {
        const int d = direction(v);
        return e_.add(text("VECTOR('',#", d, ",", real(norm(v)), ")"));
    }
    int placement(const Vec<3>& at, const Vec<3>& z, const Vec<3>& x) {
        const int p = point(at), axis = direction(z), toward = direction(x);
        return e_.add(text("AXIS2_PLACEMENT_3D('',#", p, ",#", axis, ",#", toward, ")"));
    }

    template <class Coefficients>
    std::vector<int> points_of(const Coefficients& list) {
        std::vector<int> ids;
        for (const auto& p : list) {
            if constexpr (Space<std::remove_cvref_t<decltype(p)>>::kDim == 2)
                ids.push_back(e_.add(text("CARTESIAN_POINT('',", listed_as(project(p).c, real), ")")));
            else
                ids.push_back(point(written_point(p)));
        }
        return ids;
    }
    template <class Coefficients>
    static std::string weights_of(const Coefficients& list) {
        return listed_as(list, [](const auto& p) { return real(p.weight()); });
    }

    // Closed ones end where they begin.
    template <class Patch>
    static Result<Patch> over_domain(const Patch& given) {
        Result<Patch> out = given;
        for (int axis = 0; axis < int(Patch::kParams) && out; ++axis)
            if (given.basis(axis).is_closed()) out = restrict_to(*out, axis, given.basis(axis).domain());
        return out;
    }

    // Multiplicities and knots.
    static Result<std::array<std::string, 2>> knot_lists(const BSplineBasis& basis) {
        std::vector<double> values;
        std::vector<int> counts;
        for (const double t : basis.knots()) {
            if (values.empty() || t != values.back()) values.push_back(t), counts.push_back(0);
            ++counts.back();
        }
        for (std::size_t i = 1; i + 1 < counts.size(); ++i)
            if (counts[i] > basis.degree())
                return refuse(RefusalKind::unsupported, text("knot ", values[i]),
                              "the curve or surface jumps here; STEP has connected ones");
        return std::array{listed_as(counts, [](int n) { return text(n); }), listed_as(values, real)};
    }
    static Result<std::string> knots(const BSplineBasis& basis) {
        const auto k = knot_lists(basis);
        if (!k) return std::unexpected(k.error());
        return (*k)[0] + "," + (*k)[1];
    }

    Result<int> one(const Line<3>& l) {
        const int p = point(l.origin), v = vector(l.direction);
        return e_.add(text("LINE('',#", p, ",#", v, ")"));
    }

    Result<int> one(const Conic<3>& given) {
        const auto [c, shift] = by_axes(given);
        if (!std::isfinite(shift)) return refuse(RefusalKind::unsupported, "", "a hyperbola without width");
        const auto& [kind, centre, x, y] = c;
        if (kind == ConicKind::parabola) {
            const int at = placement(centre, cross(x, y), x);
            return e_.add(text("PARABOLA('',#", at, ",", real(dot(y, y) / (4 * norm(x))), ")"));
        }
        const int at = placement(centre, cross(x, y), x);
        if (kind == ConicKind::hyperbola)
            return e_.add(text("HYPERBOLA('',#", at, ",", real(norm(x)), ",", real(norm(y)), ")"));
        if (norm(x) - norm(y) <= 8 * kUnitRoundoff * norm(x))
            return e_.add(text("CIRCLE('',#", at, ",", real(norm(x)), ")"));
        return e_.add(text("ELLIPSE('',#", at, ",", real(norm(x)), ",", real(norm(y)), ")"));
    }

    Result<int> one(const Extrusion& s) {
        if (const auto* l = std::get_if<Line<3>>(&s.profile)) {
            const int at = placement(l->origin, cross(l->direction, s.direction), l->direction);
            return e_.add(text("PLANE('',#", at, ")"));
        }
        if (const auto named = elementary_of(s)) return one(*named);
        const auto profile = curve(s.profile);
        if (!profile) return profile;
        const int v = vector(s.direction);
        return e_.add(text("SURFACE_OF_LINEAR_EXTRUSION('',#", *profile, ",#", v, ")"));
    }

    int one(const Elementary& s) {
        const int at = placement(s.at, s.axis, s.x);
        std::string sizes;
        for (const double x : s.sizes) sizes += text(",", real(x));
        return e_.add(text(s.name, "('',#", at, sizes, ")"));
    }

    Result<int> one(const Revolution& s) {
        if (const auto named = elementary_of(s)) return one(*named);
        const auto profile = curve(s.profile);
        if (!profile) return profile;
        const int p = point(s.origin), d = direction(s.axis);
        const int axis = e_.add(text("AXIS1_PLACEMENT('',#", p, ",#", d, ")"));
        return e_.add(text("SURFACE_OF_REVOLUTION('',#", *profile, ",#", axis, ")"));
    }

    Result<int> one(const OffsetSurface& s) {
        const auto base = surface(*s.base);
        if (!base) return base;
        return e_.add(text("OFFSET_SURFACE('',#", *base, ",", real(s.distance), ",.F.)"));
    }

    template <class P>
    Result<int> one(const Surface<P>& given) {
        const auto clamped = over_domain(given);
        if (!clamped) return std::unexpected(clamped.error());
        const Surface<P>& s = *clamped;
        const auto u = knot_lists(s.basis(0)), v = knot_lists(s.basis(1));
        if (!u) return std::unexpected(u.error());
        if (!v) return std::unexpected(v.error());
        const std::string degrees = text(s.basis(0).degree(), ",", s.basis(1).degree(), ",");
        const std::string all = text((*u)[0], ",", (*v)[0], ",", (*u)[1], ",", (*v)[1], ",.UNSPECIFIED.");
        const auto flat = s.net().flat();
        const auto columns = std::size_t(s.net().extent()[1]);
        std::string points = "(", weights = "(";
        for (std::size_t i = 0; i < flat.size(); i += columns) {
            const auto row = flat.subspan(i, columns);
            points += (i > 0 ? "," : "") + Entities::refs(points_of(row));
            if constexpr (Space<P>::kRational) weights += (i > 0 ? "," : "") + weights_of(row);
        }
        points += ")", weights += ")";
        if constexpr (!Space<P>::kRational)
            return e_.add(text("B_SPLINE_SURFACE_WITH_KNOTS('',", degrees, points,
                               ",.UNSPECIFIED.,.F.,.F.,.F.,", all, ")"));
        else
            return e_.add(text("(BOUNDED_SURFACE()B_SPLINE_SURFACE(", degrees, points,
                               ",.UNSPECIFIED.,.F.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS(", all,
                               ")GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(", weights,
                               ")REPRESENTATION_ITEM('')SURFACE())"));
    }

    Entities& e_;
    int parameters_ = 0;  // the context of parameter curves, once there is one
};

}  // namespace freiform::detail
