// Surfaces, and faces of all of one: what stands in a file without edges gets them here, so that there is one
// way from here to a model.
#include "rhino_geometry.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/make/conic.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::rhino {

namespace {

constexpr double kWhole = 2 * std::numbers::pi;
constexpr double kSameAngle = 0x1p-30;

Result<SurfaceInSpace> read_plane(Bytes& b) {
    int minor = 0;
    b.version(minor);
    PlaneInSpace p;
    p.origin = b.point(), p.x = b.point(), p.y = b.point();
    b.skip(3 * 8 + 4 * 8);
    const std::array<Interval, 2> domain{b.interval(), b.interval()};
    p.extent = domain;
    if (minor > 0) p.extent = {b.interval(), b.interval()};
    if (b.failed()) return ends_early(b, "a plane");
    for (const Interval& e : p.extent)
        if (!(e.lo < e.hi) || !std::isfinite(e.length()))
            return invalid(b, text("the extent [", e.lo, ", ", e.hi, "] of a plane is empty"));
    if (!is_finite(p.origin) || !(norm(cross(p.x, p.y)) > 0))
        return invalid(b, "the axes of a plane are parallel");
    return SurfaceInSpace(p);
}

Result<SurfaceInSpace> read_revolved(Bytes& b) {
    int minor = 0;
    const int major = b.version(minor);
    const Vec<3> from = b.point(), to = b.point();
    Revolved r;
    r.origin = from, r.axis = to - from;
    r.angle = b.interval();
    if (major > 1) b.skip(2 * 8);  // the parameters that it has instead
    b.skip(6 * 8);
    r.transposed = b.i32() != 0;
    const bool has_profile = b.u8() != 0;
    if (b.failed()) return ends_early(b, "a surface of revolution");
    if (!(norm(r.axis) > 0) || !is_finite(r.axis) || !has_profile)
        return invalid(b, "a surface of revolution without axis or profile");
    if (!(r.angle.lo < r.angle.hi) || !(r.angle.length() < kWhole * (1 + kSameAngle)))
        return invalid(b,
                       text("a surface of revolution over the angles [", r.angle.lo, ", ", r.angle.hi, "]"));
    r.axis = (1 / norm(r.axis)) * r.axis;
    auto o = object_in(b);
    if (!o) return std::unexpected(o.error());
    auto profile = read_curve(*o);
    if (!profile) return std::unexpected(profile.error());
    if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
    r.profile = std::move(*profile);
    return SurfaceInSpace(std::move(r));
}

// As one spline; of several pieces not.
Result<std::variant<Curve<Vec<3>>, Curve<Hom<3>>>> one_spline(const CurveInSpace& c) {
    using Spline = std::variant<Curve<Vec<3>>, Curve<Hom<3>>>;
    if (c.pieces.size() != 1)
        return refuse(RefusalKind::unsupported, "",
                      "is a sum of curves of several pieces, which is not read");
    const Piece& p = c.pieces[0];
    return visit_one(
        [&](const auto& g) -> Result<Spline> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                Net<1, Vec<3>> net({2}, {p.end(false), p.end(true)});
                return Spline(Curve<Vec<3>>::trusted({*BSplineBasis::bezier(1)}, std::move(net)));
            } else if constexpr (std::same_as<G, Conic<3>>) {
                auto arc = conic_arc(g, p.on);
                if (!arc) return std::unexpected(arc.error());
                return Spline(std::move(arc->curve));
            } else {
                return Spline(g);
            }
        },
        p.shape);
}

// a(u) + b(v): the weights of a product, points that are sums of points.
Result<SurfaceInSpace> sum_of(const CurveInSpace& a, const CurveInSpace& b) {
    const auto first = one_spline(a), second = one_spline(b);
    if (!first) return std::unexpected(first.error());
    if (!second) return std::unexpected(second.error());
    return visit_one(
        [&](const auto& f) {
            return visit_one(
                [&](const auto& s) -> Result<SurfaceInSpace> {
                    using F = std::remove_cvref_t<decltype(f)>;
                    using S = std::remove_cvref_t<decltype(s)>;
                    constexpr bool kRational = Space<typename F::Coefficients>::kRational ||
                                               Space<typename S::Coefficients>::kRational;
                    using P = std::conditional_t<kRational, Hom<3>, Vec<3>>;
                    const auto p = f.net().flat();
                    const auto q = s.net().flat();
                    Net<2, P> net({int(p.size()), int(q.size())});
                    for (std::size_t i = 0; i < p.size(); ++i)
                        for (std::size_t j = 0; j < q.size(); ++j) {
                            const Vec<3> x = project(p[i]) + project(q[j]);
                            auto& to = net.flat()[i * q.size() + j];
                            if constexpr (kRational)
                                to = weighted(x, Space<typename F::Coefficients>::weight(p[i]) *
                                                     Space<typename S::Coefficients>::weight(q[j]));
                            else
                                to = x;
                        }
                    auto made = Surface<P>::make({f.basis(), s.basis()}, std::move(net));
                    if (!made) return std::unexpected(made.error());
                    return SurfaceInSpace(std::move(*made));
                },
                *second);
        },
        *first);
}

// Swept, if one of the two is a straight line; else a spline.
Result<SurfaceInSpace> read_summed(Bytes& b) {
    int minor = 0;
    b.version(minor);
    const Vec<3> base = b.point();
    b.skip(6 * 8);
    if (b.failed()) return ends_early(b, "a sum of two curves");
    std::array<CurveInSpace, 2> curves;
    for (CurveInSpace& c : curves) {
        auto o = object_in(b);
        if (!o) return std::unexpected(o.error());
        auto curve = read_curve(*o);
        if (!curve) return std::unexpected(curve.error());
        c = std::move(*curve);
    }
    if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
    if (!is_finite(base)) return invalid(b, "a sum of two curves without a base point");
    for (const bool transposed : {false, true}) {
        const CurveInSpace &profile = curves[transposed], &line = curves[!transposed];
        if (!is_straight(line)) continue;
        const Vec<3> from = line.end(false);
        return SurfaceInSpace(Swept{moved(profile, base + from), line.end(true) - from, transposed});
    }
    auto spline = sum_of(moved(curves[0], base), curves[1]);
    if (!spline) return refuse_within(text("byte ", b.at()), spline.error());
    return spline;
}

}  // namespace

Result<SurfaceInSpace> read_nurbs_surface(Bytes& b) {
    int minor = 0;
    b.version(minor);
    SplineNumbers n;
    n.dim = b.i32();
    n.rational = b.i32() != 0;
    for (int& x : n.order) x = b.i32();
    for (int& x : n.size) x = b.i32();
    b.skip(2 * 4 + 6 * 8);
    for (auto& knots : n.knots) {
        knots.resize(std::size_t(b.count(8)));
        for (double& x : knots) x = b.f64();
    }
    if (!b.failed() && (n.dim < 1 || n.dim > 3))
        return refuse(RefusalKind::unsupported, text("byte ", b.at()),
                      text("is a surface of ", n.dim, " coordinates"));
    const int width = n.dim + (n.rational ? 1 : 0);
    const int count = b.failed() ? 0 : b.count(8 * std::size_t(width));
    n.points.resize(std::size_t(count) * std::size_t(width));
    for (double& x : n.points) x = b.f64();
    if (b.failed()) return ends_early(b, "a NURBS surface");
    if (n.size[0] < 1 || n.size[1] < 1 || (long long)(n.size[0]) * n.size[1] != count)
        return invalid(
            b, text(n.size[0], " by ", n.size[1], " points of a surface are announced, ", count, " there"));
    auto s = spline_surface(n);
    if (!s) return refuse_within(text("byte ", b.at()), s.error());
    return s;
}

Result<SurfaceInSpace> read_surface(StoredObject o) {
    Bytes& b = o.data;
    if (o.of.kind == Kind::nurbs_surface || o.of.kind == Kind::plane_surface)
        if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
    switch (o.of.kind) {
        case Kind::nurbs_surface:
            return read_nurbs_surface(b);
        case Kind::plane_surface:
            return read_plane(b);
        case Kind::rev_surface:
            return read_revolved(b);
        case Kind::sum_surface:
            return read_summed(b);
        default:
            break;
    }
    return refuse(RefusalKind::unsupported, text("byte ", b.at()),
                  text("is ", o.of.name.empty() ? text("of the class ", o.uuid) : std::string(o.of.name),
                       ", which is not read as a surface"));
}

namespace {

// The boundary of a rectangle of parameters: along u below and above (none: that side is a point), along v on
// the left and on the right.
struct Sides {
    std::optional<CurveInSpace> below, above;
    CurveInSpace left, right;
    std::array<Vec<3>, 4> corners;  // lower left, lower right, upper right, upper left
    bool closed_u = false, closed_v = false;
};

BrepOf face_within(SurfaceInSpace surface, Sides s) {
    BrepOf b;
    b.surfaces.emplace_back(std::move(surface));
    std::array<int, 4> at{0, 1, 2, 3};
    if (s.closed_u) at[1] = at[0], at[2] = at[3];
    if (s.closed_v) at[3] = at[0], at[2] = at[1];
    if (!s.below) at[1] = at[0];
    if (!s.above) at[2] = at[3];
    std::array<int, 4> vertex{-1, -1, -1, -1};
    for (int& v : at) {
        int& k = vertex[std::size_t(v)];
        if (k < 0) {
            k = int(b.vertices.size());
            b.vertices.push_back(s.corners[std::size_t(v)]);
        }
        v = k;
    }
    LoopOf loop;
    const auto add = [&](std::optional<CurveInSpace> side, int from, int to) {
        if (!side) return -1;
        b.curves.push_back(std::move(*side));
        b.edges.push_back({{int(b.curves.size()) - 1, {}, false}, {from, to}});
        return int(b.edges.size()) - 1;
    };
    const int below = add(s.below, at[0], at[1]), right = add(s.right, at[1], at[2]);
    const int above = s.closed_v ? below : add(s.above, at[3], at[2]);
    const int left = s.closed_u ? right : add(s.left, at[0], at[3]);
    for (const auto& [edge, reversed] :
         {std::pair{below, false}, {right, false}, {above, true}, {left, true}})
        if (edge >= 0) loop.trims.push_back({edge, reversed});
    b.faces.push_back({0, false, {std::move(loop)}});
    return b;
}

// Turned about the axis by an angle: the vector, or its part along the axis alone.
Vec<3> turned(const Vec<3>& d, const Vec<3>& axis, double angle) {
    const Vec<3> along = dot(d, axis) * axis, out = d - along;
    return along + std::cos(angle) * out + std::sin(angle) * cross(axis, out);
}

CurveInSpace turned(const CurveInSpace& c, const Revolved& r, double angle) {
    if (angle == 0) return c;
    std::array<Vec<3>, 3> axes;
    for (int i = 0; i < 3; ++i) {
        Vec<3> e;
        e[i] = 1;
        axes[std::size_t(i)] = turned(e, r.axis, angle);
    }
    const Vec<3> back = r.origin[0] * axes[0] + r.origin[1] * axes[1] + r.origin[2] * axes[2];
    return mapped(c, {r.origin - back, axes});
}

BrepOf whole_revolved(Revolved r) {
    const CurveInSpace& p = r.profile;
    double size = extent_of(p);
    const auto radius = [&](const Vec<3>& x) {
        const Vec<3> d = x - r.origin;
        return d - dot(d, r.axis) * r.axis;
    };
    for (const Piece& piece : p.pieces) size = std::max(size, norm(radius(piece.end(true))));
    Sides s;
    s.closed_u = r.angle.length() >= kWhole * (1 - kSameAngle);
    s.closed_v = norm(p.end(true) - p.end(false)) <= kClose * size;
    const auto circle = [&](bool last) -> std::optional<CurveInSpace> {
        const Vec<3> at = p.end(last), x = radius(at);
        if (norm(x) <= kClose * size) return std::nullopt;
        return CurveInSpace{{{Conic<3>{ConicKind::ellipse, at - x, x, cross(r.axis, x)}, r.angle, {0, 1}}}};
    };
    s.below = circle(false), s.above = circle(true);
    s.left = turned(p, r, r.angle.lo), s.right = turned(p, r, r.angle.hi);
    if (s.closed_u) s.right = s.left;
    s.corners = {s.left.end(false), s.right.end(false), s.right.end(true), s.left.end(true)};
    const bool transposed = std::exchange(r.transposed, false);
    BrepOf b = face_within(std::move(r), std::move(s));
    b.faces[0].reversed = transposed;
    return b;
}

BrepOf whole_swept(Swept swept) {
    Sides s;
    s.below = swept.profile, s.above = moved(swept.profile, swept.along);
    s.closed_u = closes(swept.profile);
    s.corners = {s.below->end(false), s.below->end(true), s.above->end(true), s.above->end(false)};
    s.left = segment(s.corners[0], s.corners[3]), s.right = segment(s.corners[1], s.corners[2]);
    const bool transposed = std::exchange(swept.transposed, false);
    BrepOf b = face_within(std::move(swept), std::move(s));
    b.faces[0].reversed = transposed;
    return b;
}

}  // namespace

BrepOf whole_face(SurfaceInSpace surface) {
    if (auto* r = std::get_if<Revolved>(&surface)) return whole_revolved(std::move(*r));
    if (auto* s = std::get_if<Swept>(&surface)) return whole_swept(std::move(*s));
    if (const auto* p = std::get_if<PlaneInSpace>(&surface)) {
        const auto at = [&](double x, double y) { return p->origin + x * p->x + y * p->y; };
        const auto& e = p->extent;
        Sides s;
        s.corners = {at(e[0].lo, e[1].lo), at(e[0].hi, e[1].lo), at(e[0].hi, e[1].hi), at(e[0].lo, e[1].hi)};
        s.below = segment(s.corners[0], s.corners[1]), s.above = segment(s.corners[3], s.corners[2]);
        s.left = segment(s.corners[0], s.corners[3]), s.right = segment(s.corners[1], s.corners[2]);
        return face_within(*p, std::move(s));
    }
    BrepOf b;  // a spline needs no edges: it ends where it ends
    b.surfaces.emplace_back(std::move(surface));
    b.faces.push_back({0, false, {}});
    return b;
}

}  // namespace freiform::rhino
