// Why a mesh may be judged by what is seen along the normals of the surface alone.
//
// Idea: a triangle approximates a piece of the surface, and what moves points along the surface does no harm.
// So the mesh is compared with S at other parameters: those of the foot of the perpendicular.
//
// Notation: D the meshed part of the parameter plane, L the piecewise linear map of D onto the mesh, which
// agrees with S at the corners of triangles; N unit normal of S; |(x, y)|' = |(a x, b y)| for lengths a, b of
// S_u, S_v; e >= |S - L| on a triangle T (curvature_tree.cpp); least |d|' <= |DS d| on T; K:
// |D^2 S(c, d)| <= K |c|' |d|' near T; q = e K / least^2.
//
// The foot of p = L(y), y in T: the minimum of f(x) = |S(x) - p|^2 / 2 over the disc |x - y|' <= r = 2.5 e /
// least, where q <= 0.15. On its edge s = |S(x) - S(y)| >= least r - K r^2 / 2 = (2.5 - 3.125 q) e > 2 e, so
// |S(x) - p| > e >= |S(y) - p|: the minimum is inside. There also, as DS(x) (x - y) is S(x) - S(y) but for K
// r^2 / 2 = 3.125 q e,
//     (S(x) - p) . DS(x) (x - y) >= s^2 - s e - (s + e) 3.125 q e > 0,
// so the gradient points outwards and the critical points inside, counted with their signs, are one. At each
// of them S(x) - p is along N(x), |S(x) - p| = |N(x) . (S(y) - p) + N(x) . (S(x) - S(y))| <= e + K r^2 / 2,
// and |DS(x) d| >= (least - K r) |d|', so D^2 f is positive there, for q (1 + 3.125 q) < (1 - 2.5 q)^2. Then
// there is one critical point F(y) inside, it depends continuously on y, and is the same from the triangles
// on both sides of an edge: their discs intersect in a convex set, where the minimum is again inside.
//
// How far: x = F(y). p - S(x) is along N(x), so the part of S(y) - S(x) along the surface is at most e, and
// (least - K |y - x|') |y - x|' <= |DS(x) (y - x)| <= e + K |y - x|'^2 / 2. For |y - x|' = w e / least this
// is w - 3/2 q w^2 <= 1, so w <= far = 2 / (1 + sqrt(1 - 6 q)): the other root is beyond 2.5. way = far e /
// least. The distance: |p - S(x)| = |N(x) . (S(y) - p) + N(x) . (S(x) - S(y))|. The first term is a linear
// interpolation error of the function N(x) . S, which has the second derivatives that are seen along N(x):
// with |N(x) - n| <= t those along n and t times those of the part of S across n, for N(x) is cos s n + sin s
// b, b a unit vector across n, sin s <= t (`Bending::seen`). The second is at most K way^2 / 2 = q e far^2 /
// 2, for DS(x) (y - x) is orthogonal to N(x). And t: on a box with the middle m and n = N(m), a tangent DS(x)
// d has n . DS(x) d = n . (DS(x) - DS(m)) d, so N turns by an angle with a sine of at most the swing of n .
// DS over the least stretch; from y to x by one of at most K way / (least - K way).
//
// In a cell: T within a box with the middle m and half sides h_u, h_v, v_i its corners, l_i the barycentric
// coordinates of y, d_i = v_i - y, g = N(x) . S. Taylor's formula with its remainder gives
//     g(y) - L g(y) = - sum l_i int_0^1 (1 - t) D^2 g(y + t d_i)(d_i, d_i) dt.
// With |y - m| = (r_u h_u, r_v h_v), y + t d_i is at most (1 - t) r + t half sides from m along each axis,
// and N(x) turns from n by what n . DS swings over |y - m|, so second derivatives there are at most those in
// the middle, third ones times that, and the turn times those beside n; int (1 - t) t = 1/6, int (1 - t)^2 =
// 1/3:
//     |g - L g| <= 1/2 sum l_i Q(d_i),   Q of  c + r_u c_u + r_v c_v,
// c what is in the middle, a third of what the half sides add, and the turn from y to x; c_u two thirds of
// what h_u adds, and what N turns by over h_u. In the metric that gives both sides the same share of mixed
// derivatives, sum l_i |d_i|^2 <= R^2 - |y - m|^2 (curvature_tree.cpp) for c, and <= R^2 for the others: the
// bound is half the largest of A h_u^2 (1 - r_u^2) + r_u Q_u + B h_v^2 (1 - r_v^2) + r_v Q_v. Where the error
// is large, y is near m, where little is known by less; bounds over the whole box are as if y were at its
// edge. Other middles than that of the box count by their distance from it. Saddles: the same with du^2 or
// dv^2 alone in Q.
//
// In one triangle: with H the second derivatives of n . S in the middle, D^2 g is cos s H and a rest that is
// bounded as above with c less |H|. So the error is at most that of the quadratic function, which is known
// with all signs (`Quadratic`), and that of the rest. The former is less near corners: in halves of the cell,
// for A = H_uu h_u^2, B = H_vv h_v^2, C = H_uv h_u h_v (with the other sign for the other diagonal) and (x,
// y) from -1 to 1,
//     g - L g = -(A (1 - x^2) + B (1 - y^2) + 2 C (1 - x) (1 + y)) / 2,  x >= y,
// where (1 - x) (1 + y) is between 0 and both of 1 - x^2 and 1 - y^2; in other triangles it is at most as
// large as with (|A| + |C|) (1 - x^2) + (|B| + |C|) (1 - y^2). So any mean of that and of the largest error
// will do, with what the rest adds to it (`Rest::error`). Of two diagonals the better one is that along which
// A + B and C have opposite signs. All of S - L is -1/2 sum l_i l_j H(v_i - v_j, v_i - v_j), i < j, with the
// second derivatives H of S, and a rest by its third ones: the same with lengths of vectors, and no normal
// that turns (`whole_error`). Of all cells of one size in a box the rest is what D^2 g changes by in it, an
// eighth of it along the diagonal of a cell (`cells_error`).
//
// By a quadratic function: M quadratic along each axis of a box and S at its corners, R = S - M. Of R there
// are bounds from control points (block_rest.cpp), of all of it and of n . R, and of its second derivatives:
// R is small, so that these lose little where weights vary much, which bounds of derivatives of S do. Second
// derivatives of S are those of M, and at most those of R more. And S - L = (M - L M) + (R - L R), where
// |R - L R| <= max |R| in halves of the box, at whose corners R is 0, and twice that in other triangles in
// it. M - L M is known with all signs: p along n, and beside it at most b, quadratic both, and 0 at corners.
// Along N(x), which turns from n by at most t, it is at most |p| + t b, and n . R becomes |n . R| + t |R| at
// most. t is what N turns by over |y - m|, a convex function of y, and from y to x: on each of the four parts
// that the middles of its sides make of T at most linear, so that the Bezier points of |p| + t (b + |R|)
// there bound it (`TurningError`). As t is small near m, where p is large, that is little more than |p|. For
// one triangle M is S at its corners. Where it is hardly more than a side, such an M may be far from S beside
// it; then it is S at the ends and in the middle of that side, and what R is at the third corner is added. So
// what is said of slivers tends to what is true of their sides.
//
// Nothing is left out: let G(y) = y + w(y) (F(y) - y), w continuous and linear on each triangle, 0 or 1 at
// vertices ("plain" ones have 0). G is continuous on D and homotopic to the identity by y + s (G(y) - y), so
// by the invariance of the degree every x in D is G(y) for some y, or is y + s (G(y) - y) for some y of the
// boundary. On triangles without plain vertices |S(x) - L(y)| is the distance above. On those with plain
// ones x lies on the segment from y to F(y). Both its ends are mapped within e of L(y), and S is near the
// chord between them: |S(x) - L(y)| <= e + K way^2 / 8. On the boundary y first goes along its side to the
// point y' with S(y') above L(y), |y' - y|' <= 8/7 e / least (edge_error.cpp), which covers nothing new, and
// then straight to x' = F(y). With E the bound for edges S(y') is within E of L(y), and so is the part of
// S(y') - S(x') along the surface: |y' - x'|' <= E / (least (1 - 4.33 q)), for |y' - x'|' <= 3.65 e / least;
// between them |S - L(y)| <= E + K |y' - x'|'^2 / 8, and the rest is less than 1/64 of E if q <= 1/16, which
// is asked for of triangles at the boundary (sides of those with plain vertices: as before). Triangles with
// three plain vertices need no F. So a face can have poles and kinks, with plain vertices around them. The
// other way round, every L(y) is as near to S(G(y)), which may be beyond the boundary of the face by as much.
//
// A spline that ends within the disc is thought of as continued by reflection in the points of its border,
// S(b - h) = 2 S(b) - S(b + h) in one direction, which has continuous first derivatives and three times the
// second ones at most. G goes there only from the boundary's own zone, and D does not reach there. Rounding:
// first derivatives of a piece of degree p and side w are differences of points times p / w, off by at most
// some 4 p / w times what points are off by. What is turned or moved on has no pieces along that: its first
// derivative is a vector from the axis, off by what points are, or given; so are those of lines and ellipses.
// Asked for is that this is below 1e-7 of a, so a, b and n have relative errors below that; 1e-6 is added.
//
// References: [Milnor 1965] for degrees. Why not all of |S - L|: the wall of a frustum needs a hundred times
// as many triangles. Why not distances from planes: where the foot leaves a triangle its neighbour has to be
// looked at.
#include "bending_detail.hpp"

#include <freiform/core/visit.hpp>

namespace freiform {

namespace {

constexpr double kLeastStretch = 0.1, kMostQ = 0.15, kMostQAtBoundary = 1.0 / 16;
constexpr double kDisc = 2.5;
constexpr double kMuchTurn = 0.1;  // of normals within half a box

Curvature seconds(const DerivativeBounds<2>& b) { return {b(2, 0), b(1, 1), b(0, 2)}; }
std::array<double, 4> thirds(const DerivativeBounds<2>& b) { return {b(3, 0), b(2, 1), b(1, 2), b(0, 3)}; }

// Bounds of |jet<2> - exact| of S_uu, S_uv, S_vv, where second derivatives are continuous in the box and one
// is known. Of profiles that are lines or ellipses they are derivatives of the profile, turned, or vectors
// from the axis to it.
std::optional<Curvature> second_slip(const DerivativeQuery<2, 3>& surface,
                                     const std::array<Interval, 2>& on) {
    if (surface.is_twice_smooth(on))
        return Curvature{surface.second_rounding(0, 0), surface.second_rounding(0, 1),
                         surface.second_rounding(1, 1)};
    const CurveGeometry<3>* profile = nullptr;
    if (const auto* r = std::get_if<Revolution>(&surface.geometry())) profile = &r->profile;
    if (const auto* e = std::get_if<Extrusion>(&surface.geometry())) profile = &e->profile;
    if (!profile) return std::nullopt;
    double size = kInfinity;
    if (const auto* line = std::get_if<Line<3>>(profile)) size = norm(line->direction);
    if (const auto* conic = std::get_if<Conic<3>>(profile); conic && conic->kind == ConicKind::ellipse)
        size = norm(conic->x) + norm(conic->y);
    if (size == kInfinity) return std::nullopt;
    const double slip = 4 * surface.value_error(on) + 64 * kUnitRoundoff * size;
    return Curvature{slip, slip, slip};
}

// The signs of n . S_uu and n . S_vv, where they are what they are in the middle.
void add_signs(Curvature& along, const Vec<3>& n, const Jet<2, 2, Vec<3>>& j, const Curvature& change) {
    const auto sure = [&](const Vec<3>& second, double by) {
        return Curvature::less(dot(n, second), by + 8 * kUnitRoundoff * norm(second));
    };
    along.sure_uu = sure(j(2, 0), change.uu);
    along.sure_vv = sure(j(0, 2), change.vv);
}

Bending::Middle middle_of(const std::array<Interval, 2>& on, const Vec<3>& n, const Jet<2, 2, Vec<3>>& j,
                          const Curvature& slip, const std::array<double, 4>& third,
                          const std::array<double, 4>& whole_third) {
    const std::array size{norm(j(2, 0)), norm(j(1, 1)), norm(j(0, 2))};
    const auto off = [](double of, double by) { return (8 * kUnitRoundoff * of + by) * kSumSlack; };
    return {{{on[0].middle(), on[1].middle()}},
            {dot(n, j(2, 0)), dot(n, j(1, 1)), dot(n, j(0, 2))},
            {off(size[0], slip.uu), off(size[1], slip.uv), off(size[2], slip.vv)},
            third,
            {j(2, 0), j(1, 1), j(0, 2)},
            {off(size[0], slip.uu), off(size[1], slip.uv), off(size[2], slip.vv)},
            whole_third,
            size};
}

// Of second derivatives less their part along n.
Curvature beside_of(const Vec<3>& n, const Jet<2, 2, Vec<3>>& j, const Curvature& change) {
    const auto of = [&](const Vec<3>& second, double by) {
        return (norm(second - dot(n, second) * n) + 16 * kUnitRoundoff * norm(second) + by) * kSumSlack;
    };
    return {of(j(2, 0), change.uu), of(j(1, 1), change.uv), of(j(0, 2), change.vv)};
}

// Of surfaces that are no splines third derivatives are dear: they are asked for at saddles, where signs are
// worth more, and where normals turn much.
bool matters_what_is_beside(const DerivativeQuery<2, 3>& surface, const std::array<Interval, 2>& on,
                            const Jet<2, 2, Vec<3>>& j, const Vec<3>& n) {
    if (surface.piece_numbers() > 0) return true;
    const double uu = dot(n, j(2, 0)), uv = dot(n, j(1, 1)), vv = dot(n, j(0, 2));
    if (uu * vv < 0) return true;
    const double a = norm(j(1, 0)), b = norm(j(0, 1)), hu = on[0].length() / 2, hv = on[1].length() / 2;
    return std::abs(uu) * hu + std::abs(uv) * hv > kMuchTurn * a ||
           std::abs(uv) * hu + std::abs(vv) * hv > kMuchTurn * b;
}

// What first derivatives along an axis are off by, of what points are, times the width of pieces.
double steepness(const SurfaceGeometry& surface, int axis) {
    const auto of_profile = [](const CurveGeometry<3>& c) {
        return visit_one(
            [](const auto& g) {
                if constexpr (requires { g.net(); })
                    return 4.0 * g.basis().degree();
                else
                    return 1.0;
            },
            c);
    };
    return visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); })
                return 4.0 * s.basis(axis).degree();
            else if constexpr (requires { s.base; })
                return 4.0 * kMaxDegree;
            else
                return axis == (requires { s.axis; } ? 1 : 0) ? of_profile(s.profile) : 1.0;
        },
        surface);
}

}  // namespace

std::optional<Vec<3>> normal_in(const DerivativeQuery<2, 3>& surface, const std::array<Interval, 2>& on,
                                const Vec<3>& u, const Vec<3>& v) {
    const double a = norm(u), b = norm(v);
    const Vec<3> m = cross(u, v);
    if (!(a * b > 0) || !(norm(m) > kBendingRounding * a * b)) return std::nullopt;
    const double error = surface.value_error(on);
    for (int d = 0; d < 2; ++d) {
        const double half = on[std::size_t(d)].length() / 2, steep = steepness(surface.geometry(), d);
        const double width = steep == 1 ? std::max(half, 1.0) : std::min(half, surface.thinnest_piece(d));
        if (!(steep * error <= 1e-7 * width * (d == 0 ? a : b))) return std::nullopt;
    }
    return unit(m);
}

void add_normals(BoxBending& out, const std::array<Interval, 2>& on, const Vec<3>& u, const Vec<3>& v,
                 const Vec<3>& n, const Curvature& along, const Curvature& beside) {
    if (!out.full.is_finite()) return;
    const double a = norm(u), b = norm(v), hu = on[0].length() / 2, hv = on[1].length() / 2;
    const double c = std::abs(dot(u, v)) / (a * b);
    const auto swing = [&](const Curvature& k) {
        const double by_u = (k.uu * hu + k.uv * hv) / a, by_v = (k.uv * hu + k.vv * hv) / b;
        return std::sqrt(by_u * by_u + by_v * by_v) + kBendingRounding;
    };
    out.a = a, out.b = b;
    out.n = n;
    out.across = along;
    out.across.restrict_to(out.full);
    out.beside = beside;
    out.beside.restrict_to(out.full);
    const double change = swing(out.full);
    const double least = std::sqrt(std::max(0.0, 1 - c)) - change;
    if (!(least > kLeastStretch)) return;
    const double turn = swing(out.across) / least;
    if (!(turn <= kMostTurn)) return;
    out.least = least;
    out.tilt = kChord * turn;
}

BoxBending bending_of(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                      const Jet<2, 2, Vec<3>>& j, Variation* variation) {
    const std::array<Interval, 2> on{box.side(0), box.side(1)};
    BoxBending out;
    const auto n = knows_normals ? normal_in(surface, on, j.d[1], j.d[2]) : std::nullopt;
    const auto slip =
        n && matters_what_is_beside(surface, on, j, *n) ? second_slip(surface, on) : std::nullopt;
    const int order = variation || slip ? 3 : 2;
    const auto both = n ? surface.both(*n, on, order) : DerivativeQuery<2, 3>::Both{surface(on, order), {}};
    if (variation) *variation = {n.value_or(Vec<3>{}), thirds(both.all), thirds(n ? both.along : both.all)};
    out.full = seconds(both.all);
    out.first[0] = both.all(1, 0), out.first[1] = both.all(0, 1);
    if (!n) return out;
    Curvature along = seconds(both.along);
    Curvature beside = out.full;
    if (slip) {
        const Vec<2> half = half_sides(on);
        add_signs(along, *n, j, change_by(half, thirds(both.along), *slip));
        beside = beside_of(*n, j, change_by(half, thirds(both.all), *slip));
        out.middle = middle_of(on, *n, j, *slip, thirds(both.along), thirds(both.all));
    }
    add_normals(out, on, j.d[1], j.d[2], *n, along, beside);
    return out;
}

BoxBending bending_from_middle(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                               const Jet<2, 2, Vec<3>>& j, const Variation& variation) {
    const std::array<Interval, 2> on{box.side(0), box.side(1)};
    const Vec<2> half = half_sides(on);
    const Curvature slip{surface.second_rounding(0, 0), surface.second_rounding(0, 1),
                         surface.second_rounding(1, 1)};
    const Curvature change = change_by(half, variation.all, slip);
    BoxBending out;
    out.full = Curvature{norm(j(2, 0)), norm(j(1, 1)), norm(j(0, 2))}.plus(kSumSlack, change);
    for (int d = 0; d < 2; ++d)
        out.first[d] = (norm(j.d[std::size_t(d) + 1]) + (d == 0 ? out.full.uu : out.full.uv) * half[0] +
                        (d == 0 ? out.full.uv : out.full.vv) * half[1]) *
                       (1 + kBendingRounding);
    if (!knows_normals) return out;
    const auto n = normal_in(surface, on, j(1, 0), j(0, 1));
    if (!n) return out;
    std::array<double, 4> along;
    const double turned = norm(*n - variation.n);
    for (std::size_t k = 0; k < 4; ++k)
        along[k] = std::min(variation.all[k], variation.along[k] + turned * variation.all[k]);
    const Curvature change_along = change_by(half, along, slip);
    Curvature seen =
        Curvature{std::abs(dot(*n, j(2, 0))), std::abs(dot(*n, j(1, 1))), std::abs(dot(*n, j(0, 2)))}.plus(
            kSumSlack, change_along);
    add_signs(seen, *n, j, change_along);
    out.middle = middle_of(on, *n, j, slip, along, variation.all);
    add_normals(out, on, j(1, 0), j(0, 1), *n, seen, beside_of(*n, j, change));
    return out;
}

Curvature Bending::seen_along(double apart) const {
    Curvature out = across.plus(apart, beside);
    const double shorter = std::max(0.0, 1 - apart * apart / 2 * (1 + 1e-14));  // what of n is in the vector
    out.sure_uu = Curvature::less(shorter * across.sure_uu, apart * beside.uu);
    out.sure_vv = Curvature::less(shorter * across.sure_vv, apart * beside.vv);
    return out;
}

void Bending::include(const Bending& o) {
    full.include(o.full);
    middle = {};
    fit = {};
    if (least > 0 && o.least > 0) {
        const double apart = norm(n - o.n) * (1 + 1e-14);
        across.include(o.seen_along(apart));
        beside.include(o.beside.plus(apart, o.across));
        tilt = std::max(tilt, o.tilt + apart);
        const double a0 = std::min(a, o.a), b0 = std::min(b, o.b);
        a = a0, b = b0;
        least = std::min(least, o.least);
    } else {
        least = 0;
    }
}

Vec<2> reach_of(const Bending& at, double e) {
    const double r = kDisc * e / at.least * (1 + 1e-9);
    return {{r / at.a, r / at.b}};
}

Shift shift_of(const Bending& at, double e, const Curvature& near, double reflected, bool is_deep) {
    Shift out;
    if (!(at.least > 0)) return out;
    const double most = is_deep ? kMostQ : kMostQAtBoundary, stretch = at.least * (at.a * at.b);
    // Where q is clearly too large, it need not be known: divisions are most of the rest.
    if (e * reflected * bend_of_lengths(at, near) > 1.001 * most * (stretch * stretch)) return out;
    const double k =
        reflected * (near.uv / (at.a * at.b) + std::max(near.uu / (at.a * at.a), near.vv / (at.b * at.b)));
    const double q = e * k / (at.least * at.least) * (1 + 1e-9);
    if (!(q <= most)) return out;
    out.exists = true;
    out.q = q;
    out.far = 2 / (1 + std::sqrt(1 - 6 * q)) * (1 + 1e-9);
    const double turn = q * out.far / (1 - q * out.far);
    out.turn = kChord * turn;
    return out;
}

double Shift::across(double seen, double e) const { return (seen + q * e * far * far / 2) * (1 + 1e-14); }

double Shift::left_of(double tolerance, double e) const {
    return (tolerance - q * e * far * far / 2) * (1 - 1e-12);
}

double Shift::way(double e) const { return (e + q * e * far * far / 8) * (1 + 1e-14); }

bool is_rounding(const Kink& kink, double side, double tolerance) {
    constexpr double kLittle = 0x1p-8;  // of the tolerance
    return kink.jump * side <= kLittle * tolerance;
}

bool kinks_are_rounding(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double tolerance) {
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : surface.kinks(d))
            if (!is_rounding(k, (box.hi - box.lo)[d], tolerance)) return false;
    return true;
}

}  // namespace freiform
