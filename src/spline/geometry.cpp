// Values, derivatives and checks of the analytic curves and surfaces; splines answer for themselves.
#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace freiform {

namespace {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

// The functions that its derivatives are sums of, at one place.
template <int D>
struct ConicAt {
    ConicAt(const Conic<D>& conic, double at) : c(conic), t(at) {
        if (c.kind == ConicKind::ellipse) even = std::cos(t), odd = std::sin(t);
        if (c.kind == ConicKind::hyperbola) even = std::cosh(t), odd = std::sinh(t);
    }
    Vec<D> derivative(int order) const {
        const Vec<D> at = order == 0 ? c.centre : Vec<D>{};
        if (c.kind == ConicKind::parabola) {
            if (order == 0) return at + (t * t) * c.x + t * c.y;
            return order == 1 ? (2 * t) * c.x + c.y : order == 2 ? 2.0 * c.x : Vec<D>{};
        }
        if (c.kind == ConicKind::hyperbola)
            return at + (order % 2 == 0 ? even * c.x + odd * c.y : odd * c.x + even * c.y);
        const Vec<D> r = order % 2 == 0 ? even * c.x + odd * c.y : even * c.y - odd * c.x;
        return at + (order % 4 < 2 ? r : -r);
    }

    const Conic<D>& c;
    double t, even = 0, odd = 0;
};

}  // namespace

template <int D>
std::array<Interval, 1> domain(const CurveGeometry<D>& curve) {
    return visit_one(Overloaded{[](const Line<D>&) {
                                    return std::array{Interval{-kInfinity, kInfinity}};
                                },
                                [](const Conic<D>& c) {
                                    return std::array{c.kind == ConicKind::ellipse
                                                          ? Interval{0, kTwoPi}
                                                          : Interval{-kInfinity, kInfinity}};
                                },
                                [](const auto& spline) { return spline.domain(); }},
                     curve);
}

std::array<Interval, 2> domain(const SurfaceGeometry& surface) {
    const SurfaceGeometry* s = &surface;
    if (const auto* offset = std::get_if<OffsetSurface>(s)) s = offset->base.get();
    return visit_one(Overloaded{[](const Extrusion& e) {
                                    return std::array{domain(e.profile)[0], Interval{-kInfinity, kInfinity}};
                                },
                                [](const Revolution& r) {
                                    return std::array{Interval{0, kTwoPi}, domain(r.profile)[0]};
                                },
                                [](const OffsetSurface&) { return std::array<Interval, 2>{}; },
                                [](const auto& spline) { return spline.domain(); }},
                     *s);
}

std::array<Interval, 2> limits(const SurfaceGeometry& surface) {
    static constexpr Interval kNone{-kInfinity, kInfinity};
    const auto of_profile = [](const CurveGeometry<3>& profile) {
        return visit_one(
            Overloaded{[](const Line<3>&) { return kNone; }, [](const Conic<3>&) { return kNone; },
                       [](const auto& spline) { return spline.domain()[0]; }},
            profile);
    };
    const auto* offset = std::get_if<OffsetSurface>(&surface);
    return visit_one(Overloaded{[&](const Extrusion& e) {
                                    return std::array{of_profile(e.profile), kNone};
                                },
                                [&](const Revolution& r) {
                                    return std::array{kNone, of_profile(r.profile)};
                                },
                                [](const OffsetSurface&) {
                                    return std::array{kNone, kNone};
                                },
                                [](const auto& spline) { return spline.domain(); }},
                     offset ? *offset->base : surface);
}

template <int D>
Result<void> check(const CurveGeometry<D>& curve) {
    return visit_one(
        Overloaded{[](const Line<D>& l) -> Result<void> {
                       if (!is_finite(l.origin) || !is_finite(l.direction))
                           return refuse(RefusalKind::nonfinite, "line", "origin or direction is not finite");
                       if (max_abs(l.direction) == 0)
                           return refuse(RefusalKind::invalid, "line.direction", "is zero");
                       return {};
                   },
                   [](const Conic<D>& c) -> Result<void> {
                       if (!is_finite(c.centre) || !is_finite(c.x) || !is_finite(c.y))
                           return refuse(RefusalKind::nonfinite, "conic", "centre or axis is not finite");
                       if (max_abs(c.x) == 0 && max_abs(c.y) == 0)
                           return refuse(RefusalKind::invalid, "conic", "both axes are zero");
                       return {};
                   },
                   [](const auto&) -> Result<void> { return {}; }},
        curve);
}

Result<void> check(const SurfaceGeometry& surface) {
    const SurfaceGeometry* s = &surface;
    if (const auto* offset = std::get_if<OffsetSurface>(s)) {
        if (!offset->base) return refuse(RefusalKind::invalid, "offset.base", "is missing");
        if (!std::isfinite(offset->distance))
            return refuse(RefusalKind::nonfinite, "offset.distance", "is not finite");
        s = offset->base.get();
        if (std::holds_alternative<OffsetSurface>(*s))
            return refuse(RefusalKind::invalid, "offset.base",
                          "is an offset itself; the distances have to be added");
    }
    if (const auto* e = std::get_if<Extrusion>(s)) {
        if (!is_finite(e->direction))
            return refuse(RefusalKind::nonfinite, "extrusion.direction", "is not finite");
        if (max_abs(e->direction) == 0) return refuse(RefusalKind::invalid, "extrusion.direction", "is zero");
        if (auto ok = check(e->profile); !ok) return refuse_within("extrusion.profile", ok.error());
    }
    if (const auto* r = std::get_if<Revolution>(s)) {
        if (!is_finite(r->origin) || !is_finite(r->axis))
            return refuse(RefusalKind::nonfinite, "revolution", "origin or axis is not finite");
        if (std::abs(dot(r->axis, r->axis) - 1) > 64 * kUnitRoundoff)
            return refuse(RefusalKind::invalid, "revolution.axis",
                          text("has length ", norm(r->axis), ", not 1"));
        if (auto ok = check(r->profile); !ok) return refuse_within("revolution.profile", ok.error());
    }
    return {};
}

template <int K, int D>
Jet<1, K, Vec<D>> jet(const CurveGeometry<D>& curve, double t) {
    return visit_one(Overloaded{[&](const Line<D>& l) {
                                    Jet<1, K, Vec<D>> j;
                                    j.d[0] = l.origin + t * l.direction;
                                    if constexpr (K >= 1) j.d[1] = l.direction;
                                    return j;
                                },
                                [&](const Conic<D>& c) {
                                    Jet<1, K, Vec<D>> j;
                                    const ConicAt<D> at(c, t);
                                    for (int k = 0; k <= K; ++k) j.d[std::size_t(k)] = at.derivative(k);
                                    return j;
                                },
                                [&](const auto& spline) { return spline.template jet<K>(t); }},
                     curve);
}

namespace {

template <int K>
Jet<2, K, Vec<3>> jet_of(const Extrusion& e, const Param<2>& uv) {
    const auto c = jet<K, 3>(e.profile, uv[0]);
    Jet<2, K, Vec<3>> s;
    for (int i = 0; i <= K; ++i) s.d[jet_slot(Index<2>{i, 0})] = c.d[std::size_t(i)];
    s.d[0] += uv[1] * e.direction;
    if constexpr (K >= 1) s.d[2] = e.direction;
    return s;
}

template <int K>
Jet<2, K, Vec<3>> jet_of(const Revolution& r, const Param<2>& uv) {
    auto c = jet<K, 3>(r.profile, uv[1]);
    c.d[0] -= r.origin;
    const double si = std::sin(uv[0]), co = std::cos(uv[0]);
    Jet<2, K, Vec<3>> s;
    for (int j = 0; j <= K; ++j) {
        const Vec<3>& p = c.d[std::size_t(j)];
        const Vec<3> along_axis = dot(r.axis, p) * r.axis, across = p - along_axis, side = cross(r.axis, p);
        const Vec<3> even = co * across + si * side, odd = co * side - si * across;
        for (int i = 0; i + j <= K; ++i) {
            const Vec<3> turned = i % 2 == 0 ? even : odd;
            s.d[jet_slot(Index<2>{i, j})] = i == 0 ? along_axis + even : i % 4 < 2 ? turned : -turned;
        }
    }
    s.d[0] += r.origin;
    return s;
}

// With m = S_u x S_v, L = |m|, n = m / L:   n_a = (m_a - n (n.m_a)) / L,
//     n_ab = (m_ab - n_b (n.m_a) - n (n_b.m_a + n.m_ab) - n_a (n.m_b)) / L.
// Zero where m vanishes (a singular point of the base has no normal).
template <int K>
Jet<2, K, Vec<3>> jet_of(const OffsetSurface& o, const Param<2>& uv) {
    const auto b = jet<K + 1>(*o.base, uv);
    const auto& S = b.d;
    const Vec<3> m = cross(S[1], S[2]), n = unit(m);
    const double length = norm(m), q = length == 0 ? 0 : o.distance / length,
                 invert = length == 0 ? 0 : 1 / length;
    Jet<2, K, Vec<3>> s;
    s.d[0] = S[0] + o.distance * n;
    if constexpr (K >= 1) {
        const Vec<3> first[2] = {cross(S[3], S[2]) + cross(S[1], S[4]),
                                 cross(S[4], S[2]) + cross(S[1], S[5])};
        Vec<3> tilt[2];
        for (int a = 0; a < 2; ++a) {
            tilt[a] = invert * (first[a] - dot(n, first[a]) * n);
            s.d[std::size_t(1 + a)] = S[std::size_t(1 + a)] + o.distance * tilt[a];
        }
        if constexpr (K >= 2) {
            const Vec<3> second[3] = {cross(S[6], S[2]) + 2.0 * cross(S[3], S[4]) + cross(S[1], S[7]),
                                      cross(S[7], S[2]) + cross(S[3], S[5]) + cross(S[1], S[8]),
                                      cross(S[8], S[2]) + 2.0 * cross(S[4], S[5]) + cross(S[1], S[9])};
            for (int k = 0; k < 3; ++k) {
                const int a = k == 2, c = k >= 1;
                s.d[std::size_t(3 + k)] =
                    S[std::size_t(3 + k)] +
                    q * (second[k] - dot(n, first[a]) * tilt[c] - dot(n, first[c]) * tilt[a] -
                         (dot(tilt[c], first[a]) + dot(n, second[k])) * n);
            }
        }
    }
    return s;
}

}  // namespace

template <int K>
Jet<2, K, Vec<3>> jet(const SurfaceGeometry& surface, const Param<2>& uv) {
    return visit_one(
        [&](const auto& s) -> Jet<2, K, Vec<3>> {
            if constexpr (requires { s.template jet<K>(uv); })
                return s.template jet<K>(uv);
            else if constexpr (K <= 2 || !std::same_as<std::remove_cvref_t<decltype(s)>, OffsetSurface>)
                return jet_of<K>(s, uv);
            else
                return {};  // not reached: the base of an offset is not an offset (checked by `check`)
        },
        surface);
}

Vec<3> normal(const SurfaceGeometry& surface, const Param<2>& uv) {
    const auto j = jet<1>(surface, uv);
    return unit(cross(unit(j.d[1]), unit(j.d[2])));
}

namespace {
constexpr double kRound = 0x1p-46;  // of squares: axes of a circle that was turned
}

template <int D>
std::string_view kind_name(const CurveGeometry<D>& curve) {
    return visit_one(Overloaded{[](const Line<D>&) { return std::string_view("line"); },
                                [](const Conic<D>& c) -> std::string_view {
                                    if (c.kind == ConicKind::hyperbola) return "hyperbola";
                                    if (c.kind == ConicKind::parabola) return "parabola";
                                    const double x = dot(c.x, c.x), y = dot(c.y, c.y), least = kRound * x;
                                    return std::abs(x - y) <= least && std::abs(dot(c.x, c.y)) <= least
                                               ? "circle"
                                               : "ellipse";
                                },
                                [](const Curve<Vec<D>>&) { return std::string_view("bspline"); },
                                [](const Curve<Hom<D>>&) { return std::string_view("nurbs"); }},
                     curve);
}

std::string_view kind_name(const SurfaceGeometry& surface) {
    static constexpr std::string_view kNames[] = {"", "plane", "cylinder", "cone", "sphere", "torus"};
    return visit_one(Overloaded{[](const Extrusion& e) {
                                    return e.kind == SurfaceKind::general ? std::string_view("extrusion")
                                                                          : kNames[int(e.kind)];
                                },
                                [](const Revolution& r) {
                                    return r.kind == SurfaceKind::general ? std::string_view("revolution")
                                                                          : kNames[int(r.kind)];
                                },
                                [](const OffsetSurface&) { return std::string_view("offset"); },
                                [](const Surface<Vec<3>>&) { return std::string_view("bspline"); },
                                [](const Surface<Hom<3>>&) { return std::string_view("nurbs"); }},
                     surface);
}

// Every analytic value is a sum of at most eight products of a coordinate with a sine, cosine or parameter,
// each with a relative error of a few units; 64 units of the largest absolute term cover them.
template <int D>
double value_error_bound(const CurveGeometry<D>& curve, const std::array<Interval, 1>& on) {
    const double t = std::max(std::abs(on[0].lo), std::abs(on[0].hi));
    return visit_one(
        Overloaded{[&](const Line<D>& l) {
                       return 64 * kUnitRoundoff * (max_abs(l.origin) + t * max_abs(l.direction));
                   },
                   [&](const Conic<D>& c) {
                       const double f = c.kind == ConicKind::ellipse     ? 1
                                        : c.kind == ConicKind::hyperbola ? std::cosh(t)
                                                                         : std::max(t, t * t);
                       return 64 * kUnitRoundoff * (max_abs(c.centre) + f * (max_abs(c.x) + max_abs(c.y)));
                   },
                   [](const auto& spline) { return spline.value_error_bound(); }},
        curve);
}

double value_error_bound(const SurfaceGeometry& surface, const std::array<Interval, 2>& on) {
    return visit_one(
        Overloaded{[&](const Extrusion& e) {
                       const double v = std::max(std::abs(on[1].lo), std::abs(on[1].hi));
                       return 2 * value_error_bound(e.profile, {on[0]}) +
                              8 * kUnitRoundoff * v * max_abs(e.direction);
                   },
                   [&](const Revolution& r) {
                       const double reach = norm(jet<0>(r.profile, on[1].middle()).d[0]) + norm(r.origin);
                       const double first = norm(jet<1>(r.profile, on[1].middle()).d[1]) * on[1].length();
                       return 4 * value_error_bound(r.profile, {on[1]}) +
                              64 * kUnitRoundoff * (2 * reach + first);
                   },
                   [&](const OffsetSurface& o) {
                       return 2 * value_error_bound(*o.base, on) + 64 * kUnitRoundoff * std::abs(o.distance);
                   },
                   [](const auto& spline) { return spline.value_error_bound(); }},
        surface);
}

CurveGeometry<2> translated(const CurveGeometry<2>& curve, const Vec<2>& by) {
    return visit_one(
        [&](const auto& c) -> CurveGeometry<2> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<2>>) {
                return Line<2>{c.origin + by, c.direction};
            } else if constexpr (std::same_as<C, Conic<2>>) {
                return Conic<2>{c.kind, c.centre + by, c.x, c.y};
            } else {
                auto net = c.net();
                for (auto& p : net.flat()) {
                    if constexpr (std::same_as<C, Curve<Vec<2>>>)
                        p += by;
                    else
                        p = Hom<2>{{p[0] + p.weight() * by[0], p[1] + p.weight() * by[1], p.weight()}};
                }
                return C::trusted(c.bases(), std::move(net));
            }
        },
        curve);
}

#define FF_INSTANTIATE_CURVE_GEOMETRY(D)                                   \
    template std::array<Interval, 1> domain(const CurveGeometry<D>&);      \
    template Result<void> check(const CurveGeometry<D>&);                  \
    template Jet<1, 0, Vec<D>> jet<0, D>(const CurveGeometry<D>&, double); \
    template Jet<1, 1, Vec<D>> jet<1, D>(const CurveGeometry<D>&, double); \
    template Jet<1, 2, Vec<D>> jet<2, D>(const CurveGeometry<D>&, double); \
    template Jet<1, 3, Vec<D>> jet<3, D>(const CurveGeometry<D>&, double); \
    template std::string_view kind_name(const CurveGeometry<D>&);          \
    template double value_error_bound(const CurveGeometry<D>&, const std::array<Interval, 1>&);
FF_INSTANTIATE_CURVE_GEOMETRY(1)
FF_INSTANTIATE_CURVE_GEOMETRY(2)
FF_INSTANTIATE_CURVE_GEOMETRY(3)
#undef FF_INSTANTIATE_CURVE_GEOMETRY
template Jet<2, 0, Vec<3>> jet<0>(const SurfaceGeometry&, const Param<2>&);
template Jet<2, 1, Vec<3>> jet<1>(const SurfaceGeometry&, const Param<2>&);
template Jet<2, 2, Vec<3>> jet<2>(const SurfaceGeometry&, const Param<2>&);

}  // namespace freiform
