#include "rhino_geometry.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::rhino {

namespace {

constexpr int kMostCurvesInCurves = 16;  // polycurves in each other
constexpr double kAtEnd = 0x1p-30;  // of a piece: what is left over after a cut this near its end is nothing

Piece line_piece(const Vec<3>& a, const Vec<3>& b, Interval of) { return {Line<3>{a, b - a}, {0, 1}, of}; }

Result<CurveInSpace> checked(CurveInSpace c, const Bytes& b) {
    for (const Piece& p : c.pieces) {
        if (!(p.of.lo < p.of.hi) || !std::isfinite(p.of.length()))
            return invalid(b, text("the parameters [", p.of.lo, ", ", p.of.hi, "] of a curve are empty"));
        if (auto ok = check(p.shape); !ok) return invalid(b, ok.error().message);
    }
    return c;
}

Result<CurveInSpace> read_line(Bytes& b) {
    int minor = 0;
    b.version(minor);
    const Vec<3> from = b.point(), to = b.point();
    const Interval domain = b.interval();
    if (b.failed()) return ends_early(b, "a line");
    return checked({{line_piece(from, to, domain)}}, b);
}

Result<CurveInSpace> read_arc(Bytes& b) {
    int minor = 0;
    b.version(minor);
    const Vec<3> centre = b.point(), x = b.point(), y = b.point();
    b.skip(3 * 8 + 4 * 8);  // the axis, the equation of the plane
    const double radius = b.f64();
    b.skip(3 * 3 * 8);  // points on the circle
    const Interval angle = b.interval(), domain = b.interval();
    if (b.failed()) return ends_early(b, "an arc");
    if (!(radius > 0) || !(angle.lo < angle.hi) || !(angle.length() < 6.2832))
        return invalid(
            b, text("an arc of radius ", radius, " over the angles [", angle.lo, ", ", angle.hi, "]"));
    return checked({{{Conic<3>{ConicKind::ellipse, centre, radius * x, radius * y}, angle, domain}}}, b);
}

Result<CurveInSpace> read_polyline(Bytes& b) {
    int minor = 0;
    b.version(minor);
    std::vector<Vec<3>> points(std::size_t(b.count(24)));
    for (Vec<3>& p : points) p = b.point();
    std::vector<double> t(std::size_t(b.count(8)));
    for (double& x : t) x = b.f64();
    if (b.failed()) return ends_early(b, "a polyline");
    if (points.size() < 2 || t.size() != points.size())
        return invalid(b, text("a polyline of ", points.size(), " points and ", t.size(), " parameters"));
    CurveInSpace c;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i] != points[i - 1])
            c.pieces.push_back(line_piece(points[i - 1], points[i], {t[i - 1], t[i]}));
    if (c.pieces.empty()) return invalid(b, "all points of a polyline are one");
    return checked(std::move(c), b);
}

}  // namespace

Result<CurveInSpace> read_nurbs_curve(Bytes& b) {
    int minor = 0;
    b.version(minor);
    SplineNumbers n;
    n.dim = b.i32();
    n.rational = b.i32() != 0;
    n.order[0] = b.i32(), n.size[0] = b.i32();
    b.skip(2 * 4 + 6 * 8);
    n.knots[0].resize(std::size_t(b.count(8)));
    for (double& x : n.knots[0]) x = b.f64();
    if (n.dim < 1 || n.dim > 3) {
        if (b.failed()) return ends_early(b, "a NURBS curve");
        return refuse(RefusalKind::unsupported, text("byte ", b.at()),
                      text("is a curve of ", n.dim, " coordinates"));
    }
    const int width = n.dim + (n.rational ? 1 : 0), count = b.count(8 * std::size_t(width));
    n.points.resize(std::size_t(count) * std::size_t(width));
    for (double& x : n.points) x = b.f64();
    if (b.failed()) return ends_early(b, "a NURBS curve");
    if (count != n.size[0])
        return invalid(b, text(n.size[0], " points of a curve are announced, ", count, " there"));
    auto c = spline_curve(n);
    if (!c) return refuse_within(text("byte ", b.at()), c.error());
    return c;
}

Result<CurveInSpace> read_poly_curve(Bytes& b, int depth) {
    if (depth > kMostCurvesInCurves)
        return refuse(RefusalKind::limit, text("byte ", b.at()), "curves are nested too deep");
    int minor = 0;
    b.version(minor);
    const int count = b.count(8);
    b.skip(2 * 4 + 6 * 8);
    std::vector<double> t(std::size_t(b.count(8)));
    for (double& x : t) x = b.f64();
    if (b.failed()) return ends_early(b, "a polycurve");
    if (count < 1 || t.size() != std::size_t(count) + 1)
        return invalid(b, text("a polycurve of ", count, " segments and ", t.size(), " parameters"));
    CurveInSpace c;
    for (int i = 0; i < count; ++i) {
        auto o = object_in(b);
        if (!o) return std::unexpected(o.error());
        const auto segment = read_curve(*o, depth + 1);
        if (!segment) return segment;
        const Interval own = segment->domain(), here{t[std::size_t(i)], t[std::size_t(i) + 1]};
        const auto place = [&](double x) {
            return x == own.hi ? here.hi : here.lo + (x - own.lo) / own.length() * here.length();
        };
        for (Piece p : segment->pieces) {
            p.of = {place(p.of.lo), place(p.of.hi)};
            c.pieces.push_back(std::move(p));
        }
    }
    return checked(std::move(c), b);
}

Result<CurveInSpace> read_curve(StoredObject o, int depth) {
    Bytes& b = o.data;
    if (o.of.kind != Kind::poly_curve)
        if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
    switch (o.of.kind) {
        case Kind::nurbs_curve:
            return read_nurbs_curve(b);
        case Kind::line_curve:
            return read_line(b);
        case Kind::arc_curve:
            return read_arc(b);
        case Kind::polyline_curve:
            return read_polyline(b);
        case Kind::poly_curve: {
            auto c = read_poly_curve(b, depth);
            if (c)
                if (auto ok = b.check_sum(); !ok) return std::unexpected(ok.error());
            return c;
        }
        default:
            break;
    }
    return refuse(RefusalKind::unsupported, text("byte ", b.at()),
                  text("is ", o.of.name.empty() ? text("of the class ", o.uuid) : std::string(o.of.name),
                       ", which is not read as a curve"));
}

namespace {

// With the knots that the file leaves out.
Result<BSplineBasis> basis_of(const SplineNumbers& n, std::size_t axis) {
    const auto& k = n.knots[axis];
    if (n.order[axis] < 2 || n.order[axis] - 1 > kMaxDegree)
        return refuse(RefusalKind::unsupported, "",
                      text("order ", n.order[axis], " is outside 2..", kMaxDegree + 1));
    if (k.size() != std::size_t(n.order[axis]) + std::size_t(n.size[axis]) - 2 ||
        n.size[axis] < n.order[axis])
        return refuse(RefusalKind::invalid, "",
                      text(k.size(), " knots for ", n.size[axis], " points of order ", n.order[axis]));
    std::vector<double> all{k.front()};
    all.insert(all.end(), k.begin(), k.end());
    all.push_back(k.back());
    return BSplineBasis::make(n.order[axis] - 1, std::move(all));
}

template <std::size_t N, class P>
Result<Patch<N, P>> patch_of(const SplineNumbers& n) {
    Net<N, P> net([&] {
        std::array<int, N> extent{};
        for (std::size_t a = 0; a < N; ++a) extent[a] = n.size[a];
        return extent;
    }());
    const double* x = n.points.data();
    for (P& p : net.flat()) {
        for (int i = 0; i < n.dim; ++i) p[i] = *x++;
        if constexpr (Space<P>::kRational) p[3] = *x++;
    }
    const auto u = basis_of(n, 0), v = N == 2 ? basis_of(n, 1) : u;
    if (!u) return std::unexpected(u.error());
    if (!v) return std::unexpected(v.error());
    const auto bases = [&]() -> std::array<BSplineBasis, N> {
        if constexpr (N == 2)
            return {*u, *v};
        else
            return {*u};
    }();
    return Patch<N, P>::make(bases, std::move(net));
}

}  // namespace

Result<CurveInSpace> spline_curve(const SplineNumbers& n) {
    const auto made = [](auto curve) -> Result<CurveInSpace> {
        if (!curve) return std::unexpected(curve.error());
        const Interval on = curve->basis().domain();
        return CurveInSpace{{{std::move(*curve), on, on}}};
    };
    return n.rational ? made(patch_of<1, Hom<3>>(n)) : made(patch_of<1, Vec<3>>(n));
}

Result<SurfaceInSpace> spline_surface(const SplineNumbers& n) {
    const auto made = [](auto surface) -> Result<SurfaceInSpace> {
        if (!surface) return std::unexpected(surface.error());
        return SurfaceInSpace(std::move(*surface));
    };
    return n.rational ? made(patch_of<2, Hom<3>>(n)) : made(patch_of<2, Vec<3>>(n));
}

Result<CurveInSpace> part_of(const CurveInSpace& c, Interval part) {
    CurveInSpace out;
    for (const Piece& p : c.pieces) {
        const double near = kAtEnd * p.of.length();
        const bool low = part.lo <= p.of.lo + near, high = part.hi >= p.of.hi - near;
        if (low && high) {
            out.pieces.push_back(p);
            continue;
        }
        const Interval of{low ? p.of.lo : part.lo, high ? p.of.hi : part.hi};
        if (!(of.length() > near)) continue;
        const auto place = [&](double t) { return p.on.lo + (t - p.of.lo) / p.of.length() * p.on.length(); };
        Piece cut{p.shape, {low ? p.on.lo : place(of.lo), high ? p.on.hi : place(of.hi)}, of};
        const auto ok = visit_one(
            [&](auto& g) -> Result<void> {
                if constexpr (requires { g.net(); }) {
                    auto shape = restrict_to(g, 0, cut.on);
                    if (!shape) return std::unexpected(shape.error());
                    g = std::move(*shape);
                }
                return {};
            },
            cut.shape);
        if (!ok) return std::unexpected(ok.error());
        out.pieces.push_back(std::move(cut));
    }
    if (out.pieces.empty())
        return refuse(RefusalKind::invalid, "",
                      text("the part [", part.lo, ", ", part.hi, "] of a curve with parameters [",
                           c.domain().lo, ", ", c.domain().hi, "] is empty"));
    return out;
}

Result<CurveInSpace> part_of(const CurveInSpace& c, const Along& along) {
    return along.part ? part_of(c, *along.part) : Result<CurveInSpace>(c);
}

AffineMap operator*(const AffineMap& a, const AffineMap& b) {
    return {a.point(b.origin), {a.vector(b.axes[0]), a.vector(b.axes[1]), a.vector(b.axes[2])}};
}

namespace {

template <class S>
S mapped_patch(const S& s, const AffineMap& map) {
    auto net = s.net();
    for (auto& x : net.flat()) {
        if constexpr (Space<typename S::Coefficients>::kRational)
            x = weighted(map.point(project(x)), x.weight());
        else
            x = map.point(x);
    }
    return S::trusted(s.bases(), std::move(net));
}

Result<SurfaceInSpace> mapped_surface(const SurfaceInSpace& s, const AffineMap& map) {
    return visit_one(
        [&](const auto& x) -> Result<SurfaceInSpace> {
            using S = std::remove_cvref_t<decltype(x)>;
            if constexpr (std::same_as<S, PlaneInSpace>)
                return PlaneInSpace{map.point(x.origin), map.vector(x.x), map.vector(x.y), x.extent};
            else if constexpr (std::same_as<S, Revolved>)
                return refuse(RefusalKind::unsupported, "",
                              "a surface of revolution in a block that is stretched, sheared or projected");
            else if constexpr (std::same_as<S, Swept>)
                return Swept{mapped(x.profile, map), map.vector(x.along), x.transposed};
            else
                return mapped_patch(x, map);
        },
        s);
}

}  // namespace

CurveInSpace mapped(const CurveInSpace& c, const AffineMap& map) {
    CurveInSpace out = c;
    for (Piece& p : out.pieces)
        visit_one(
            [&](auto& g) {
                using G = std::remove_cvref_t<decltype(g)>;
                if constexpr (std::same_as<G, Line<3>>)
                    g = {map.point(g.origin), map.vector(g.direction)};
                else if constexpr (std::same_as<G, Conic<3>>)
                    g = {g.kind, map.point(g.centre), map.vector(g.x), map.vector(g.y)};
                else
                    g = mapped_patch(g, map);
            },
            p.shape);
    return out;
}

BrepOf mapped(const BrepOf& b, const AffineMap& map) {
    BrepOf out = b;
    for (CurveInSpace& c : out.curves) c = mapped(c, map);
    for (Vec<3>& p : out.vertices) p = map.point(p);
    for (auto& s : out.surfaces)
        if (s) s = mapped_surface(*s, map);
    // In a mirror normals that pointed out point in.
    if (dot(cross(map.axes[0], map.axes[1]), map.axes[2]) < 0)
        for (FaceOf& f : out.faces) f.reversed = !f.reversed;
    return out;
}

CurveInSpace backwards(const CurveInSpace& c) {
    CurveInSpace out;
    double t = 0;
    for (std::size_t i = c.pieces.size(); i-- > 0;) {
        Piece p = c.pieces[i];
        const double length = p.of.length();
        visit_one(
            [&](auto& g) {
                using G = std::remove_cvref_t<decltype(g)>;
                if constexpr (std::same_as<G, Line<3>>) {
                    g.direction = -1.0 * g.direction;
                    p.on = {-p.on.hi, -p.on.lo};
                } else if constexpr (std::same_as<G, Conic<3>>) {
                    g.y = -1.0 * g.y;
                    p.on = {-p.on.hi, -p.on.lo};
                } else {
                    g = reverse(g, 0);
                    p.on = g.basis().domain();
                }
            },
            p.shape);
        p.of = {t, t + length};
        t += length;
        out.pieces.push_back(std::move(p));
    }
    return out;
}

bool is_straight(const CurveInSpace& c) {
    return c.pieces.size() == 1 && std::holds_alternative<Line<3>>(c.pieces[0].shape);
}

double extent_of(const CurveInSpace& c) {
    double size = 0;
    for (const Piece& p : c.pieces)
        for (const double x : {p.on.lo, p.on.middle(), p.on.hi})
            size = std::max(size, norm(jet<0>(p.shape, x).value() - c.end(false)));
    return size;
}

bool closes(const CurveInSpace& c) { return norm(c.end(true) - c.end(false)) <= kClose * extent_of(c); }

CurveInSpace segment(const Vec<3>& a, const Vec<3>& b) { return {{line_piece(a, b, {0, 1})}}; }

}  // namespace freiform::rhino
