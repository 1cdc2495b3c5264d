// What explains a curve: control points and their names, knots, curvature, the scheme of de Boor, tangent,
// normal and circle of curvature at a parameter, hull and box.
//
// Notation: c', c'' derivatives, T = c' / |c'|. Curvature vector k = (c'' - (c''.T) T) / |c'|^2; the centre
// of curvature is c + k / |k|^2 [PT97, sec. 6.3 has the same in coordinates].
#include "io/drawing_detail.hpp"

#include <freiform/query/hull.hpp>
#include <freiform/spline/construction.hpp>

#include <algorithm>
#include <numbers>

namespace freiform::drawing {

namespace {

constexpr int kNeedles = 200, kFewestNeedles = 8;  // of a comb: per curve, per Bezier piece
constexpr double kCombSize = 0.3;                  // longest needle, of the size of its curve
constexpr double kStraight = 1e-7;                 // curvature times size below which a line is straight
constexpr double kPointRadius = 3.5;
constexpr int kMostNamedLevels = 5;  // of a scheme, so that names do not cover everything
constexpr Colour kFirstLevel{0.93, 0.65, 0.10, 1}, kLastLevel{0.72, 0.05, 0.10, 1};

// What the curve does at a parameter, in the scaled coordinates of the sketch.
struct Frame {
    Vec<3> point, tangent, curvature;  // tangent of length 1
    bool regular = false;
};

template <class C>
Frame frame_at(const Plane& plane, const C& curve, double u, double size) {
    const auto jet = curve.template jet<2>(u);
    const Vec<3> d = plane.scaled(jet(1)), a = plane.scaled(jet(2));
    Frame f{plane.scaled(jet.value()), {}, {}};
    const double speed = norm(d);
    if (!(speed * curve.domain()[0].length() > kStraight * size)) return f;  // no tangent, no curvature
    f.tangent = (1 / speed) * d;
    f.curvature = (1 / speed / speed) * (a - dot(a, f.tangent) * f.tangent);
    f.regular = is_finite(f.curvature);
    return f;
}

Vec<2> flat(const Plane& plane, const Vec<3>& p) { return {{dot(plane.right, p), dot(plane.up, p)}}; }

// Refuses parameters outside the domain; otherwise the parameter inside it.
std::optional<double> inside(Sketch& s, const BSplineBasis& basis, double u, std::string_view what) {
    const Interval on = basis.domain();
    if (!basis.is_closed() && !on.contains(u)) {
        s.failure = Refusal{
            RefusalKind::out_of_domain, s.label,
            text("the ", what, " is asked for at ", u, ", outside the domain [", on.lo, ", ", on.hi, "]")};
        return std::nullopt;
    }
    s.answered = true;
    return basis.wrap(u);
}

// Away from both neighbours of point i of a polygon.
Vec<2> outward(std::span<const Vec<2>> p, std::size_t i, bool closed) {
    const std::size_t n = p.size();
    Vec<2> sum{};
    if (i > 0 || closed) sum += unit(p[i] - p[(i + n - 1) % n]);
    if (i + 1 < n || closed) sum += unit(p[i] - p[(i + 1) % n]);
    return sum;
}

// b, c, d, .. or P, Q, R, ..: one letter for each curve.
char letter_of(const Sketch& s) {
    const bool zero = s.options.names == PointNames::from_zero;
    return char((zero ? 'b' : 'P') + int(s.curves % (zero ? 9 : 10)));
}

template <class P>
void add_control(Sketch& s, const Curve<P>& curve) {
    DrawnGroup& g = s.group("control", mixed(s.colour, kGrey, 0.65), 1.1);
    std::vector<Vec<3>> points;
    std::vector<Vec<2>> line;
    for (const P& c : curve.net().flat())
        points.push_back(project(c)), line.push_back(s.plane(points.back()));
    const bool closed = curve.basis().is_closed();
    s.add_polygon(g, points, closed);
    g.legend = plain_text("control polygon");
    add_points(s, g, curve.net().flat());
    if (s.options.names == PointNames::none) return;
    const int first = s.options.names == PointNames::from_zero ? 0 : 1;
    for (std::size_t i = 0; i < line.size(); ++i)
        s.notes.push_back({line[i], formula(text("*", letter_of(s), "*_{", int(i) + first, "}")),
                           mixed(s.colour, kInk, 0.4), 16, outward(line, i, closed)});
}

template <class P>
void add_knots(Sketch& s, const Curve<P>& curve, const BSplineBasis& basis) {
    DrawnGroup& g = s.group("knots", mixed(s.colour, {0, 0, 0, 1}, 0.3), 1.5);
    g.legend = plain_text("knots");
    for (const double u : basis.breaks())
        if (const auto p = curve(u); !s.is_behind(p))
            g.discs.push_back({s.plane(p), 2.2 + 0.9 * basis.multiplicity(u), true});
}

struct Needle {
    int piece;
    Vec<3> foot, k;
};

// The needle is -k times a length chosen per curve; the line through the tips is that of one piece: the
// curvature may jump between two.
void draw_comb(Sketch& s, const std::vector<Needle>& needles, double scale) {
    DrawnGroup& g = s.group("comb", mixed(s.colour, {0.85, 0.85, 0.85, 1}, 0.7), 0.7);
    g.legend = plain_text("curvature");
    for (const Needle& n : needles) {
        const Vec<2> foot = flat(s.plane, n.foot), tip = flat(s.plane, n.foot - scale * n.k);
        s.take(g, line_through(std::array{foot, tip}));
    }
    std::vector<Vec<2>> envelope;
    for (std::size_t i = 0; i < needles.size(); ++i) {
        envelope.push_back(flat(s.plane, needles[i].foot - scale * needles[i].k));
        if (i + 1 < needles.size() && needles[i + 1].piece == needles[i].piece) continue;
        s.take(g, line_through(envelope));
        envelope.clear();
    }
}

template <class P>
void add_comb(Sketch& s, const Curve<P>& curve) {
    const BezierPieces<1, P> pieces(curve);
    if (pieces.degree(0) < 2) return;
    const int n = std::max(kFewestNeedles, kNeedles / pieces.extent()[0]);
    std::vector<Needle> needles;
    double longest = 0;
    Box<3> feet;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto piece = pieces.piece({i});
        const Interval on = pieces.box({i})[0];
        for (int j = 0; j <= n; ++j) {
            const Frame f = frame_at(s.plane, piece, on.lo + on.length() * j / n, s.size);
            if (!f.regular) continue;
            longest = std::max(longest, norm(f.curvature));
            needles.push_back({i, f.point, f.curvature});
            feet.add(f.point);
        }
    }
    if (needles.empty()) return;
    const double size = max_abs(feet.hi - feet.lo);
    if (longest * size > kStraight) draw_comb(s, needles, kCombSize * size / longest);
}

template <class P>
void draw_level(Sketch& s, std::span<const P> d, int level, int degree, int first) {
    DrawnGroup& g = s.group("construction", mixed(kFirstLevel, kLastLevel, double(level) / degree),
                            level == degree ? 2 : 1.3);
    std::vector<Vec<2>> line;
    for (const P& c : d) line.push_back(s.plane(project(c)));
    if (line.size() > 1) s.take(g, line_through(line));
    for (const Vec<2>& p : line) g.discs.push_back({p, 3.2, false});
    if (s.options.names == PointNames::none || degree > kMostNamedLevels) return;
    for (std::size_t i = 0; i < line.size(); ++i)
        s.notes.push_back({line[i],
                           formula(text("*", letter_of(s), "*_{", int(i) + first, "}^{", level, "}")),
                           mixed(g.colour, kInk, 0.35), 14, outward(line, i, false)});
}

// All levels of the scheme of de Boor; with one Bezier piece that is de Casteljau.
template <class P>
void add_construction(Sketch& s, const Curve<P>& curve, double at) {
    const BSplineBasis& basis = curve.basis();
    const auto wrapped = inside(s, basis, at, "construction");
    if (!wrapped) return;
    const auto scheme = de_boor(curve, *wrapped);
    if (!scheme) return s.leave_out(scheme.error().message);
    const int first = scheme->first() + (s.options.names == PointNames::from_one ? 1 : 0);
    for (int r = 1; r <= scheme->degree(); ++r) draw_level(s, scheme->level(r), r, scheme->degree(), first);
    DrawnGroup& g = s.group("point", {0.1, 0.1, 0.1, 1}, 1);
    g.discs.push_back({s.plane(project(scheme->point())), 5, false});
}

template <class P>
void add_tangent(Sketch& s, const Curve<P>& curve, double at) {
    const auto u = inside(s, curve.basis(), at, "tangent");
    if (!u) return;
    const Frame f = frame_at(s.plane, curve, *u, s.size);
    if (!f.regular) return s.leave_out(text("it has no tangent at ", at));
    const double length = 0.22 * s.size;
    const auto arrow = [&](const char* role, const char* name, const Colour& c, const Vec<3>& along) {
        DrawnGroup& g = s.group(role, c, 1.6);
        const Vec<2> tip = flat(s.plane, f.point + length * along);
        s.take(g, line_through(std::array{flat(s.plane, f.point), tip}));
        g.arrows = true;
        g.legend = plain_text(role);
        s.notes.push_back({tip, formula(name), c, 16, flat(s.plane, along)});
    };
    arrow("tangent", "*T*", kLastLevel, f.tangent);
    if (norm(f.curvature) * s.size > kStraight) arrow("normal", "*N*", kPalette[2], unit(f.curvature));
    s.group("point", {0.1, 0.1, 0.1, 1}, 1).discs.push_back({flat(s.plane, f.point), 4.5, false});
}

// The whole circle, or where it is much larger than the drawing, an arc on both sides of the point.
template <class P>
void add_osculating(Sketch& s, const Curve<P>& curve, double at) {
    const auto u = inside(s, curve.basis(), at, "circle of curvature");
    if (!u) return;
    const Frame f = frame_at(s.plane, curve, *u, s.size);
    const double k = norm(f.curvature);
    if (!f.regular || !(k * s.size > kStraight))
        return s.leave_out(text("it has no circle of curvature at ", at));
    const double radius = 1 / k;
    const Vec<3> normal = unit(f.curvature), centre = f.point + radius * normal;
    const bool whole = radius < s.size;
    const double half = whole ? std::numbers::pi : std::min(std::numbers::pi, 0.6 * s.size / radius);
    // The angle 0 is the point itself. The sagitta of a step of angle a is at most radius a^2 / 8.
    const double steps = std::ceil(2 * half / std::sqrt(8 * s.tolerance / radius));
    DrawnGroup& g = s.group("osculating", kPalette[1], 1.5);
    g.legend = plain_text("circle of curvature");
    g.dashes = {7, 4};
    const auto point = [&](double a) {
        return flat(s.plane, centre + radius * (std::sin(a) * f.tangent - std::cos(a) * normal));
    };
    s.take(g, sampled_path(point, {-half, half}, int(std::clamp(steps, 16.0, 100000.0))));
    s.group("point", {0.1, 0.1, 0.1, 1}, 1).discs.push_back({flat(s.plane, f.point), 4.5, false});
    if (!whole) return;
    DrawnGroup& c = s.group("centre", kPalette[1], 1);
    c.discs.push_back({flat(s.plane, centre), 3, false});
    s.take(c, line_through(std::array{flat(s.plane, f.point), flat(s.plane, centre)}));
    s.notes.push_back({flat(s.plane, centre), formula("1/*κ*"), kPalette[1], 15, flat(s.plane, normal)});
}

template <class P>
void add_hull(Sketch& s, const Curve<P>& curve) {
    std::vector<Vec<2>> p;
    for (const P& c : curve.net().flat()) p.push_back(s.plane(project(c)));
    const auto corners = convex_hull(p);
    if (!corners || corners->size() < 3) return;
    std::vector<Vec<2>> hull;
    for (const int i : *corners) hull.push_back(p[std::size_t(i)]);
    DrawnGroup& g = s.group("hull", mixed(s.colour, {1, 1, 1, 1}, 0.3), 0.9);
    g.dashes = {2, 3};
    g.fill = 0.1;
    g.legend = plain_text("convex hull");
    s.take(g, line_through(hull, true));
}

void add_box(Sketch& s, const DrawnGroup& curve) {
    const Box<2> box = box_of(std::span(&curve, 1), s.tolerance);
    if (box.is_empty()) return;
    DrawnGroup& g = s.group("box", mixed(s.colour, {1, 1, 1, 1}, 0.2), 0.9);
    g.dashes = {6, 3};
    g.legend = plain_text("box");
    const std::array<Vec<2>, 4> p{box.lo, {{box.hi[0], box.lo[1]}}, box.hi, {{box.lo[0], box.hi[1]}}};
    s.take(g, line_through(p, true));
}

}  // namespace

template <class P>
void add_points(Sketch& s, DrawnGroup& g, std::span<const P> coefficients) {
    double mean = 0;
    for (const P& c : coefficients) mean += Space<P>::weight(c) / double(coefficients.size());
    for (const P& c : coefficients) {
        const double radius =
            std::clamp(kPointRadius * std::sqrt(Space<P>::weight(c) / mean), 1.5, 3 * kPointRadius);
        (s.is_behind(project(c)) ? s.behind.points : g.discs).push_back({s.plane(project(c)), radius, false});
    }
}

template <class P>
void add_curve(Sketch& s, const Curve<P>& curve, const BSplineBasis& basis) {
    const DrawingOptions& o = s.options;
    const bool names = o.names != PointNames::none;
    DrawnGroup drawn{s.name, "curve", s.colour, 2.4, {}, {}, {}};
    s.add_paths(drawn, curve);
    if (!drawn.paths.empty()) drawn.legend = plain_text(s.name);
    if (o.hull) add_hull(s, curve);
    if (o.box) add_box(s, drawn);
    if (o.comb && s.size > 0) add_comb(s, curve);
    if (o.control || names) add_control(s, curve);
    if (o.a_frames) add_a_frames(s, curve);
    s.groups.push_back(std::move(drawn));
    if (o.knots) add_knots(s, curve, basis);
    if (o.joints && s.size > 0) add_joints(s, curve);
    if (o.osculating) add_osculating(s, curve, *o.osculating);
    if (o.construction) add_construction(s, curve, *o.construction);
    if (o.tangent) add_tangent(s, curve, *o.tangent);
    if (o.hodograph) add_hodograph(s, curve);
    if (o.basis) add_basis(s, basis);
    ++s.curves;
}

template void add_curve(Sketch&, const Curve<Vec<3>>&, const BSplineBasis&);
template void add_curve(Sketch&, const Curve<Hom<3>>&, const BSplineBasis&);
template void add_points(Sketch&, DrawnGroup&, std::span<const Vec<3>>);
template void add_points(Sketch&, DrawnGroup&, std::span<const Hom<3>>);

}  // namespace freiform::drawing
