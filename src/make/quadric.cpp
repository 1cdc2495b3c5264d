// Idea: a surface of revolution is a tensor product. If c(u) is the unit circle and (rho(v), zeta(v)) a
// profile, both rational, then rho(v) c(u) and zeta(v) are the coordinates; in homogeneous coefficients
//     X = rho_j c_i,   Y = rho_j s_i,   Z = zeta_j w_i,   W = w_j w_i,
// and a frame maps them affinely. Circle and profile are those of conic.hpp; a cone's profile is a line.
//
// Tiles without poles: stereographic projection takes circles to circles, and its inverse takes a rational
// plane patch (p, q, w) of degree n to one of degree 2 n on the sphere, (2 p w, 2 q w, w^2 - p^2 - q^2; w^2 +
// p^2 + q^2). The face of a cube, projected from the centre of the sphere onto it and from there onto the
// plane, is bounded by four arcs of circles, and a biquadratic patch has them for its edges; an octant by
// three, which a quadratic triangle has. The coefficients are numbers a + b sqrt 2 + c sqrt 3 + d sqrt 6; the
// tables below hold a, b, c, d as integers. A test derives the octant's once more, in exact arithmetic.
//
// Notation: `Surd` a number of the field above. (x, y, z, w): homogeneous coordinates on the unit sphere.
//
// Accuracy. With the stored circle c' within b1 of c and the stored profile p' within b2 of p, a point moves
// by |rho' c' - rho c| <= max rho' b1 + |rho' - rho| in the plane of the circle and by |zeta' - zeta| along
// the axis, together by max rho' b1 + b2; the frame stretches that by at most the root of the sum of its
// squared lengths. What the products and the frame round is counted as it happens (bounded_net_detail.hpp).
// Coefficients that are equal in exact arithmetic come from the same operations on the same doubles, or
// mirrored ones, so neighbouring tiles have the same bits.
//
// References: [PT97, ch. 7 and 8], [Cobb 1988], [Farin & Piper & Worsey 1987], [Dietz & Hoschek & Juttler
// 1993] for the projection.
//
// Why not a sphere of degree 2 x 2 without poles? There is none; and rotating a half circle is what every
// reader of NURBS expects. The tiles are for those who need normals everywhere.
#include "bounded_net_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/make/quadric.hpp>

#include <cmath>

namespace freiform {

namespace {

using bounded::RoundedNet;
using bounded::Vector;
using bounded::operator+;
using bounded::operator-;
using bounded::operator*;

constexpr double kHalfTurn = std::numbers::pi;

std::unexpected<Refusal> invalid(std::string where, std::string message) {
    return refuse(RefusalKind::invalid, std::move(where), std::move(message));
}

Result<void> check_radius(std::string_view name, double r, bool zero_too = false) {
    if (!std::isfinite(r)) return refuse(RefusalKind::nonfinite, std::string(name), text(r, " is no number"));
    if (!(r > 0) && !(zero_too && r == 0))
        return invalid(std::string(name), text(r, zero_too ? " is negative" : " is not positive"));
    return {};
}
Result<void> check_interval(std::string_view name, Interval on) {
    if (!std::isfinite(on.lo) || !std::isfinite(on.hi))
        return refuse(RefusalKind::nonfinite, std::string(name), "has an end that is not finite");
    if (!(on.lo < on.hi)) return invalid(std::string(name), text("[", on.lo, ", ", on.hi, "] is empty"));
    return {};
}

// A frame with its bounds, and how much it stretches at most.
struct Map {
    Vector<3> origin, x, y, z;
    double stretch = 0;

    Vector<3> operator()(const Bounded& a, const Bounded& b, const Bounded& c, const Bounded& w) const {
        return w * origin + a * x + b * y + c * z;
    }
};

Result<Map> map_of(const FoundFrame& f) {
    for (const auto& [name, v] :
         {std::pair{"frame.origin", &f.origin}, {"frame.x", &f.x}, {"frame.y", &f.y}, {"frame.z", &f.z}})
        if (!is_finite(*v))
            return refuse(RefusalKind::nonfinite, name, "has a coordinate that is not finite");
    Map m{bounded::vector(f.origin, f.origin_bound), bounded::vector(f.x, f.x_bound),
          bounded::vector(f.y, f.y_bound), bounded::vector(f.z, f.z_bound)};
    // The determinant of the vectors, each divided by a power of two.
    const auto scaled = [](Vector<3> v) {
        double most = 0;
        for (const Bounded& b : v) most = std::max(most, std::abs(b.value));
        const int e = most > 0 ? -std::ilogb(most) : 0;
        for (Bounded& b : v) b = {std::scalbn(b.value, e), std::scalbn(b.bound, e)};
        return v;
    };
    if (!dot(cross(scaled(m.x), scaled(m.y)), scaled(m.z)).excludes_zero())
        return invalid("frame", "its vectors are in one plane as far as rounding tells");
    const double bounds = 2 * (f.x_bound + f.y_bound + f.z_bound);
    m.stretch = (norm(Vec<3>{{norm(f.x), norm(f.y), norm(f.z)}}) + bounds) * (1 + 0x1p-48);
    return m;
}

const Conic<2> kUnitCircle{ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}};

Result<ConicArc<2>> circle_over(const Conic<2>& circle, const Turn& turn, std::string_view name) {
    if (turn.form == EllipseForm::open) {
        auto arc = conic_arc(circle, turn.angle);
        if (!arc) return refuse_within(name, arc.error());
        return arc;
    }
    if (turn.angle != Interval{0, 2 * kHalfTurn})
        return invalid(text(name, ".form"), "only the full turn from 0 on can be closed or quintic");
    return full_ellipse(circle, turn.form);
}

Result<ConicArc<2>> profile(RoundedNet<2> net, Result<BSplineBasis> basis) {
    if (!basis) return std::unexpected(basis.error());
    const double bound = net.bound();
    const int n = int(net.net.size());
    auto curve = Curve<Hom<2>>::make({std::move(*basis)}, Net<1, Hom<2>>({n}, std::move(net.net)));
    if (!curve) return std::unexpected(curve.error());
    return ConicArc<2>{std::move(*curve), bound};
}

// rho(v) c(u) and zeta(v) in the frame.
Result<RoundSurface> turned(const FoundFrame& frame, const Turn& turn, const ConicArc<2>& profile) {
    const auto map = map_of(frame);
    if (!map) return std::unexpected(map.error());
    const auto circle = circle_over(kUnitCircle, turn, "turn");
    if (!circle) return std::unexpected(circle.error());
    RoundedNet<3> out;
    double widest = 0;
    for (const Hom<2>& p : profile.curve.net().flat()) widest = std::max(widest, std::abs(project(p)[0]));
    for (const Hom<2>& c : circle->curve.net().flat())
        for (const Hom<2>& p : profile.curve.net().flat()) {
            const Bounded rho = p[0], zeta = p[1], w = Bounded(p[2]) * c[2];
            out.add((*map)(rho * c[0], rho * c[1], zeta * c[2], w), w);
        }
    const double bound =
        (out.bound() + map->stretch * (widest * circle->bound + profile.bound)) * (1 + 0x1p-48);
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "frame", "rounding leaves nothing of the surface");
    const Index<2> extent{circle->curve.net().extent()[0], profile.curve.net().extent()[0]};
    auto surface = Surface<Hom<3>>::make({circle->curve.basis(), profile.curve.basis()},
                                         Net<2, Hom<3>>(extent, std::move(out.net)));
    if (!surface) return std::unexpected(surface.error());
    return RoundSurface{std::move(*surface), bound};
}

// (1 - t^2, 2 t) / (1 + t^2) for t = -1 .. 1, elevated once: the half circle without irrational numbers.
Result<ConicArc<2>> rational_half_circle(double r) {
    constexpr double kX[] = {0, 2, 2, 0}, kY[] = {-3, -1, 1, 3}, kW[] = {3, 1, 1, 3};
    RoundedNet<2> net;
    for (int i = 0; i < 4; ++i) net.add({Bounded(kX[i]) * r, Bounded(kY[i]) * r}, kW[i]);
    return profile(std::move(net), BSplineBasis::bezier(3));
}

// Two quarters: the first half of a whole circle that begins at the lower pole.
Result<ConicArc<2>> half_circle(double r) {
    const auto whole = full_ellipse(Conic<2>{ConicKind::ellipse, {}, {{0, -r}}, {{r, 0}}}, EllipseForm::open);
    if (!whole) return std::unexpected(whole.error());
    const auto all = whole->curve.net().flat();
    const auto basis = BSplineBasis::make(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1});
    auto curve = Curve<Hom<2>>::make({*basis}, Net<1, Hom<2>>({5}, {all.begin(), all.begin() + 5}));
    if (!curve) return std::unexpected(curve.error());
    return ConicArc<2>{std::move(*curve), whole->bound};
}

// The circle of radius r about 0 over latitudes; its ends at the poles have distance 0 from the axis.
Result<ConicArc<2>> meridian(double r, Interval latitude, EllipseForm form) {
    if (latitude == kPoleToPole)
        return form == EllipseForm::quintic ? rational_half_circle(r) : half_circle(r);
    auto arc = conic_arc(Conic<2>{ConicKind::ellipse, {}, {{r, 0}}, {{0, r}}}, latitude);
    if (!arc) return refuse_within("latitude", arc.error());
    auto net = arc->curve.net();
    const double bound = arc->bound;
    for (const bool low : {true, false}) {
        if (low ? latitude.lo != kPoleToPole.lo : latitude.hi != kPoleToPole.hi) continue;
        // The double nearest to pi/2 is 6e-17 from the pole. The end of an arc has weight 1.
        Hom<2>& end = low ? net.flat().front() : net.flat().back();
        const Hom<2> pole{{0, low ? -r : r, 1}};
        arc->bound = (arc->bound + norm(end - pole)) * (1 + 0x1p-48);
        end = pole;
    }
    if (arc->bound == bound) return arc;
    return ConicArc<2>{Curve<Hom<2>>::trusted(arc->curve.bases(), std::move(net)), arc->bound};
}

Result<ConicArc<2>> line(const Vec<2>& from, const Vec<2>& to) {
    RoundedNet<2> net;
    for (const Vec<2>& p : {from, to}) net.add(bounded::vector(p), 1);
    return profile(std::move(net), BSplineBasis::bezier(1));
}

// a + b sqrt 2 + c sqrt 3 + d sqrt 6.
struct Surd {
    int a, b, c, d;
};
using SurdPoint = std::array<Surd, 4>;

Bounded value_of(const Surd& s) {
    static const std::array<double, 4> kRoot{1, std::sqrt(2.0), std::sqrt(3.0), std::sqrt(6.0)};
    const std::array<int, 4> factor{s.a, s.b, s.c, s.d};
    Bounded sum;
    for (std::size_t i = 0; i < 4; ++i)
        sum += Bounded(factor[i]) * Bounded(kRoot[i], i == 0 ? 0 : kRoot[i] * 0x1p-53);
    return sum;
}
using LocalPoint = std::array<Bounded, 4>;
LocalPoint value_of(const SurdPoint& p) {
    return {value_of(p[0]), value_of(p[1]), value_of(p[2]), value_of(p[3])};
}

// A quarter of the face z < 0 of the cube, 18 times the coefficients of the reference. The rows run along y,
// the others follow from the mirror images in x and y.
constexpr SurdPoint kFace[3][3] = {{{{{72, 0, -72, 0}, {72, 0, -72, 0}, {72, 0, -72, 0}, {216, 0, -72, 0}}},
                                    {{{0, -18, 0, 0}, {0, -72, 0, 18}, {0, -72, 0, 18}, {0, -36, 0, 54}}},
                                    {{{0, 0, 0, 0}, {24, 0, -48, 0}, {24, 0, -48, 0}, {120, 0, -24, 0}}}},
                                   {{{{0, -72, 0, 18}, {0, -18, 0, 0}, {0, -72, 0, 18}, {0, -36, 0, 54}}},
                                    {{{18, 0, -27, 0}, {18, 0, -27, 0}, {-54, 0, -9, 0}, {54, 0, 9, 0}}},
                                    {{{0, 0, 0, 0}, {0, -42, 0, 12}, {0, 0, 0, -30}, {0, 36, 0, 6}}}},
                                   {{{{24, 0, -48, 0}, {0, 0, 0, 0}, {24, 0, -48, 0}, {120, 0, -24, 0}}},
                                    {{{0, -42, 0, 12}, {0, 0, 0, 0}, {0, 0, 0, -30}, {0, 36, 0, 6}}},
                                    {{{0, 0, 0, 0}, {0, 0, 0, 0}, {-120, 0, 24, 0}, {-8, 0, 40, 0}}}}};

// b_ijk of the octant with i >= j >= k, 3 times the coefficients of the reference: 400, 310, 220, 211. The
// others follow by exchanging coordinates.
constexpr SurdPoint kOctant[4] = {{{{36, 0, -12, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {36, 0, -12, 0}}},
                                  {{{0, 9, 0, 0}, {0, 9, 0, -3}, {0, 0, 0, 0}, {0, 9, 0, 0}}},
                                  {{{6, 0, 2, 0}, {6, 0, 2, 0}, {0, 0, 0, 0}, {12, 0, 0, 0}}},
                                  {{{0, -3, 4, 3}, {0, 0, 2, 1}, {0, 0, 2, 1}, {0, -3, 4, 3}}}};

LocalPoint octant_point(const std::array<int, 3>& ijk) {
    std::array<std::size_t, 3> order{0, 1, 2};  // the axes by descending index
    sort(order.begin(), order.end(),
         [&](auto p, auto q) { return ijk[p] != ijk[q] ? ijk[p] > ijk[q] : p < q; });
    const int first = ijk[order[0]], second = ijk[order[1]];
    const LocalPoint p = value_of(kOctant[first == 4 ? 0 : first == 3 ? 1 : second == 2 ? 2 : 3]);
    LocalPoint out{{{}, {}, {}, p[3]}};
    for (std::size_t k = 0; k < 3; ++k) out[order[k]] = p[k];
    return out;
}

}  // namespace

Result<FoundFrame> frame_about(const Vec<3>& origin, const Vec<3>& axis, const Vec<3>& toward) {
    for (const auto& [name, v] : {std::pair{"origin", &origin}, {"axis", &axis}, {"toward", &toward}})
        if (!is_finite(*v))
            return refuse(RefusalKind::nonfinite, name, "has a coordinate that is not finite");
    if (max_abs(axis) == 0) return invalid("axis", "is zero");
    const auto scaled = [](Vec<3> v) {
        const int e = std::ilogb(max_abs(v));
        for (double& x : v.c) x = std::scalbn(x, -e);
        return bounded::vector(v);
    };
    Vec<3> side = toward;
    if (max_abs(side) == 0) {
        int least = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
        side[least] = 1;
    }
    const Vector<3> n = scaled(axis), across = cross(n, scaled(side));
    if (!dot(across, across).excludes_zero())
        return invalid("toward", "is parallel to the axis as far as rounding tells");
    const auto unit_of = [](const Vector<3>& v) {
        const Bounded l = bounded::length(v);
        return Vector<3>{v[0] / l, v[1] / l, v[2] / l};
    };
    FoundFrame f;
    f.origin = origin;
    const auto store = [](const Vector<3>& v, Vec<3>& to, double& bound) {
        for (int i = 0; i < 3; ++i) {
            to[i] = v[std::size_t(i)].value;
            bound = std::max(bound, v[std::size_t(i)].bound);
        }
    };
    store(unit_of(cross(across, n)), f.x, f.x_bound);
    store(unit_of(across), f.y, f.y_bound);
    store(unit_of(n), f.z, f.z_bound);
    return f;
}

Result<RoundSurface> sphere(const FoundFrame& frame, double radius, const Turn& turn, Interval latitude) {
    if (auto ok = check_radius("radius", radius); !ok) return std::unexpected(ok.error());
    if (auto ok = check_interval("latitude", latitude); !ok) return std::unexpected(ok.error());
    if (latitude.lo < kPoleToPole.lo || latitude.hi > kPoleToPole.hi)
        return invalid("latitude", text("[", latitude.lo, ", ", latitude.hi, "] is beyond a pole"));
    const auto arc = meridian(radius, latitude, turn.form);
    if (!arc) return std::unexpected(arc.error());
    return turned(frame, turn, *arc);
}

Result<RoundSurface> cylinder(const FoundFrame& frame, double radius, Interval height, const Turn& turn) {
    if (auto ok = check_radius("radius", radius); !ok) return std::unexpected(ok.error());
    return cone(frame, radius, radius, height, turn);
}

Result<RoundSurface> cone(const FoundFrame& frame, double radius_lo, double radius_hi, Interval height,
                          const Turn& turn) {
    if (auto ok = check_radius("radius_lo", radius_lo, true); !ok) return std::unexpected(ok.error());
    if (auto ok = check_radius("radius_hi", radius_hi, true); !ok) return std::unexpected(ok.error());
    if (radius_lo == 0 && radius_hi == 0) return invalid("radius_hi", "is 0 as the other one: a line");
    if (auto ok = check_interval("height", height); !ok) return std::unexpected(ok.error());
    const auto side = line({{radius_lo, height.lo}}, {{radius_hi, height.hi}});
    if (!side) return std::unexpected(side.error());
    return turned(frame, turn, *side);
}

Result<RoundSurface> torus(const FoundFrame& frame, double ring, double tube, const Turn& turn,
                           const Turn& around) {
    if (auto ok = check_radius("ring", ring); !ok) return std::unexpected(ok.error());
    if (auto ok = check_radius("tube", tube); !ok) return std::unexpected(ok.error());
    const auto arc =
        circle_over(Conic<2>{ConicKind::ellipse, {{ring, 0}}, {{tube, 0}}, {{0, tube}}}, around, "around");
    if (!arc) return std::unexpected(arc.error());
    return turned(frame, turn, *arc);
}

Result<SphereInSix> sphere_in_six(const FoundFrame& frame, double radius) {
    if (auto ok = check_radius("radius", radius); !ok) return std::unexpected(ok.error());
    const auto map = map_of(frame);
    if (!map) return std::unexpected(map.error());
    const auto basis = *BSplineBasis::bezier(4);
    std::vector<Surface<Hom<3>>> faces;
    double bound = 0;
    for (int face = 0; face < 6; ++face) {
        RoundedNet<3> out;
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 5; ++j) {
                LocalPoint p = value_of(kFace[std::min(i, 4 - i)][std::min(j, 4 - j)]);
                const Bounded r = radius;
                Bounded x = r * (j > 2 ? -p[0] : p[0]), y = r * (i > 2 ? -p[1] : p[1]), z = r * p[2];
                if (face % 2 == 1) y = -y, z = -z;  // half a turn about x
                const std::array<Bounded, 3> at{x, y, z};
                const auto k = std::size_t(face / 2);  // -z, -x, -y by a third of a turn about (1, 1, 1) each
                out.add((*map)(at[(3 - k) % 3], at[(4 - k) % 3], at[(5 - k) % 3], p[3]), p[3]);
            }
        bound = std::max(bound, out.bound());
        auto s = Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({5, 5}, std::move(out.net)));
        if (!s) return std::unexpected(s.error());
        faces.push_back(std::move(*s));
    }
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "frame", "rounding leaves nothing of the surface");
    return SphereInSix{{faces[0], faces[1], faces[2], faces[3], faces[4], faces[5]}, bound};
}

Result<SphereInEight> sphere_in_eight(const FoundFrame& frame, double radius) {
    if (auto ok = check_radius("radius", radius); !ok) return std::unexpected(ok.error());
    const auto map = map_of(frame);
    if (!map) return std::unexpected(map.error());
    std::vector<SimplexPatch<2, Hom<3>>> octants;
    double bound = 0;
    for (int octant = 0; octant < 8; ++octant) {
        const bool flip[3] = {(octant & 4) != 0, (octant & 2) != 0, (octant & 1) != 0};
        const bool odd = (flip[0] + flip[1] + flip[2]) % 2 == 1;  // then corner 2 is on the z axis
        RoundedNet<3> out;
        for (int row = 0; row <= 4; ++row)
            for (int k = 0; k <= row; ++k) {
                const int j = row - k;
                const LocalPoint p = octant_point({4 - row, odd ? k : j, odd ? j : k});
                const auto coordinate = [&](std::size_t c) {
                    return Bounded(radius) * (flip[c] ? -p[c] : p[c]);
                };
                out.add((*map)(coordinate(0), coordinate(1), coordinate(2), p[3]), p[3]);
            }
        bound = std::max(bound, out.bound());
        auto s = SimplexPatch<2, Hom<3>>::make(4, std::move(out.net));
        if (!s) return std::unexpected(s.error());
        octants.push_back(std::move(*s));
    }
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "frame", "rounding leaves nothing of the surface");
    const auto& o = octants;
    return SphereInEight{{o[0], o[1], o[2], o[3], o[4], o[5], o[6], o[7]}, bound};
}

}  // namespace freiform
