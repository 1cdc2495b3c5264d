// How far the chord of a part of an edge is from the edge, in space and on the faces.
//
// Notation: C curve of the edge, p = (u, v) parameter curve on a face with surface S, chord c(t) linear
// between p(a) and p(b), L(t) linear between the mesh points at a and b, h = b - a, Q as in
// curvature_tree.cpp, M over a box that contains p([a, b]). Bounds on [a, b]:
//   |C(t) - linear|        <= h^2/8 max|C''|
//   |S(p(t)) - linear|     <= h^2/8 max|(S o p)''|,  (S o p)'' = D^2 S(p', p') + S_u u'' + S_v v''
//   |S(c(t)) - linear|     <= Q(p(b) - p(a)) / 8
//   |p(t) - c(t)|          <= h^2/8 max|p''|, component by component: the sliver between chord and curve.
// A point of the sliver lies on a segment from p(t) to c(t); S along it stays within Q(p(t) - c(t)) / 8 of
// the chord of its ends, and both ends are near L(t). So the faces' region outside the polygon is within
//   max(|S o p - L|, |S o c - L|) + Q(sliver) / 8
// of the mesh edge, not counting the gap between S(p) and the mesh points, which the model brings along.
//
// Across the chord: what moves points along the chord does no harm, and uneven speed of a parametrisation is
// all of that sort. Let e be the direction of the chord in space and X any of C, S o p, S o c, with X' . e >
// 0. Then X(t) and the chord's points correspond by their projections onto e, monotonically, ends to ends,
// and their distance is that of X from the line: at most h^2/8 max|P X''|, P the projection across e, of
// which two orthonormal directions f across e have the coordinates: h^2/8 hypot(max|f_1 . X''|, max|f_2 .
// X''|). On a face p(t) and c(s) correspond if they have the same projection. With `slope` <= h (S o c)' . e
// the difference |s - t| / h is at most |S(p(t)) - S(c(t))| / slope <= D / slope, D = |S_u| sag_u + |S_v|
// sag_v; so the segments from p(t) to c(s) are longer than the sliver is wide by D / slope of the chord at
// most, and as they are a homotopy from the parameter curve to the chord, none of the sliver is left out.
// f . S_u p_u'' + f . S_v p_v'' is bounded by that of the middle, where it is one coordinate of p'', and
// what f . DS changes by. That the chord's map to itself, c(t) -> c(s) with S(c(s)) above L(t), moves points
// no farther than 8/7 of |S(c(t)) - L(t)| is asked for by (S o c)' . e >= 7/8 |(S o c)'|. What e . DS changes
// by needs a bound of e . D^2 S only where one of all of D^2 S is not enough.
//
// Pieces of p some of which are short may bend much there without p going far from its chord: p'' counts as
// PiecewiseBound says, which holds for all that is asked of it, that p is off its chord (with Green's
// function under the integral) and that p' is off the chord's direction.
//
// Triangles of cones stand for sides that bow away from c (cone_face.cpp). With L(t) c(s) corresponds, whose
// projection is the same, so |s - t| / h is at most Q(p(b) - p(a)) / 8 / slope; the segments from c(s) to the
// bowed side at t are a homotopy likewise, and what is between counts as a sliver.
//
// Spheres: likewise, with slivers of (E + e)^2 / (8 R), E and e at most the tolerance of faces.
//
// Why not all of C'': the quarter of a rational circle takes up to 1.4 times as many chords.
#include "chord_curve_detail.hpp"
#include "edge_mesh_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/chord_triangles.hpp>
#include <freiform/mesh/normal_cone.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kBothSides = 0.52;  // (E + e)^2 / 8 beside the squared tolerance, a 64th below that of faces
constexpr double kSteep = 0.55;      // speed across the chord beside that along it: cos atan is above 7/8
constexpr double kDirectionSlack = 1 + 0x1p-40;  // more than the roundings of directions and sums below

// The larger one; where there is no bound, as at singular points of an offset, infinity times zero is none.
double worse(double a, double b) { return b <= a ? a : std::isnan(b) ? kInfinity : b; }

// Bounds of second derivatives.
struct SecondBounds {
    double uu = 0, uv = 0, vv = 0;
    double along(double du, double dv) const {
        return uu * du * du + 2 * uv * std::abs(du * dv) + vv * dv * dv;
    }
};

// One use of the edge between a and b. Derivatives along p are scaled by h.
struct OnFace {
    OnFace(const DerivativeQuery<2, 3>& face, const CoedgeQuery& use, double a, double b);
    double kinks() const {
        return kink_bound_of(surface.kinks(0), box.side(0)) + kink_bound_of(surface.kinks(1), box.side(1)) +
               bent * (first[0] + first[1]);
    }
    double along(const Vec<2>& d) const { return second.along(d[0], d[1]); }
    double crude() const;
    struct Across {
        double distance;
        // Parts of the chord: how much wider slivers are, and how far what corresponds is apart.
        double wider, uneven;
    };
    std::optional<Across> across() const;

    const DerivativeQuery<2, 3>& surface;
    const CoedgeQuery& use;
    Interval on;
    PlaneCurveBounds plane;
    Vec<2> from, to, chord, sag, speed, change;  // speed >= |h p'|, change: what stands for |h^2 p''|
    Box<2> box;
    DerivativeBounds<2> over;
    SecondBounds second;
    double first[2];
    double bent;  // what kinks of p add to its distance from the chord
};

OnFace::OnFace(const DerivativeQuery<2, 3>& face, const CoedgeQuery& of, double a, double b)
    : surface(face),
      use(of),
      on{a, b},
      plane(coordinate_bounds(*of.curve, on)),
      from(jet<0>(of.coedge->curve, a).value()),
      to(jet<0>(of.coedge->curve, b).value()),
      chord(to - from),
      bent(kink_bound_of(of.curve->kinks(0), on)) {
    const double h = b - a;
    for (int i = 0; i < 2; ++i) {
        const DerivativeBounds<1>& d = plane.coordinate[std::size_t(i)];
        const PiecewiseBound& by_pieces = of.second[std::size_t(i)];
        const double most = by_pieces.is_empty() ? d(2) : std::min(d(2), by_pieces.steady(on));
        speed[i] = h * d(1), change[i] = h * h * most, sag[i] = change[i] / 8 + bent;
    }
    for (const Vec<2>& p : {from, to}) {
        box.add(p - sag);
        box.add(p + sag);
    }
    over = surface({box.side(0), box.side(1)});
    second = {over(2, 0), over(1, 1), over(0, 2)};
    first[0] = over(1, 0), first[1] = over(0, 1);
}

// Of the distance at equal parameters.
double OnFace::crude() const {
    // The largest stretch of the surface's first derivative: exact in the middle of the box, plus its
    // variation.
    const Vec<2> size = box.hi - box.lo, middle = from + 0.5 * chord;
    const auto j = jet<1>(surface.geometry(), middle.c);
    const double uu = dot(j.d[1], j.d[1]), vv = dot(j.d[2], j.d[2]), uv = dot(j.d[1], j.d[2]);
    const double stretch = 1.0000001 * std::sqrt((uu + vv + std::hypot(uu - vv, 2 * uv)) / 2) +
                           (second.uu + second.uv) * size[0] / 2 + (second.uv + second.vv) * size[1] / 2;
    const double h = on.length();
    const double bend =
        std::min(first[0] * change[0] + first[1] * change[1], stretch * (h * h * plane.both(2)));
    return worse(along(speed) + bend, along(chord)) / 8 + kinks();
}

std::optional<OnFace::Across> OnFace::across() const {
    const double h = on.length();
    const Vec<2> middle = from + 0.5 * chord, half = 0.5 * (box.hi - box.lo);
    const auto j = jet<2>(surface.geometry(), middle.c);
    const Vec<2> turn = (h * h) * jet<2>(use.coedge->curve, on.middle()).d[2];
    const double x = chord[0], y = chord[1];
    const auto frame =
        frame_of(jet<0>(surface.geometry(), to.c).value() - jet<0>(surface.geometry(), from.c).value(),
                 (x * x) * j(2, 0) + (2 * x * y) * j(1, 1) + (y * y) * j(0, 2) + turn[0] * j(1, 0) +
                     turn[1] * j(0, 1));
    if (!frame) return std::nullopt;
    double torn[2] = {0, 0};  // what first derivatives jump by inside
    for (int i = 0; i < 2; ++i)
        for (const Kink& k : surface.kinks(i))
            if (box.lo[i] < k.at && k.at < box.hi[i]) torn[i] += k.jump;
    const std::array<Interval, 2> sides{box.side(0), box.side(1)};
    const auto vary = [&](const SecondBounds& seen) {  // of first derivatives, from the middle
        return Vec<2>{{seen.uu * half[0] + seen.uv * half[1] + torn[0],
                       seen.uv * half[0] + seen.vv * half[1] + torn[1]}};
    };
    const auto second_of = [](const DerivativeBounds<2>& b) {
        return SecondBounds{b(2, 0), b(1, 1), b(0, 2)};
    };
    const auto beside = surface.along_two(std::array{(*frame)[1], (*frame)[2]}, sides);
    double aside = 0, on_chord = 0, on_curve = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        const SecondBounds seen = second_of(beside[i - 1]);
        const Vec<2> g{{dot((*frame)[i], j(1, 0)), dot((*frame)[i], j(0, 1))}}, varies = vary(seen);
        aside =
            std::hypot(aside, std::abs(dot(g, chord)) + varies[0] * std::abs(x) + varies[1] * std::abs(y));
        on_chord = std::hypot(on_chord, seen.along(x, y));
        double bend = 0;
        if (change != Vec<2>{} && norm(g) > 0)
            bend = std::min(std::abs(g[0]) * change[0] + std::abs(g[1]) * change[1],
                            norm(g) * (h * h) * use.curve->along(unit(g), {on})(2)) +
                   varies[0] * change[0] + varies[1] * change[1];
        on_curve = std::hypot(on_curve, seen.along(speed[0], speed[1]) + bend);
    }
    const Vec<2> g{{dot((*frame)[0], j(1, 0)), dot((*frame)[0], j(0, 1))}};
    // (S o c)' . e at least, where it is enough.
    const auto slope_by = [&](const Vec<2>& varies) -> std::optional<double> {
        const double slope = dot(g, chord) - (varies[0] * std::abs(x) + varies[1] * std::abs(y));
        const double backward =
            ((std::abs(g[0]) + varies[0]) * change[0] + (std::abs(g[1]) + varies[1]) * change[1]) / 2;
        if (!(aside * kDirectionSlack <= kSteep * slope) || !(slope > backward * kDirectionSlack))
            return std::nullopt;
        return slope;
    };
    auto slope = slope_by(vary(second));  // all of S'' will do, as a rule
    if (!slope) slope = slope_by(vary(second_of(surface.along((*frame)[0], sides))));
    if (!slope) return std::nullopt;
    const double rounding = 0x1p-44 * (along(speed) + first[0] * change[0] + first[1] * change[1]);
    return Across{(std::max(on_chord, on_curve) / 8 + rounding) * kDirectionSlack + kinks(),
                  (first[0] * sag[0] + first[1] * sag[1]) / *slope * kDirectionSlack,
                  (along(chord) / 8 + kinks()) / *slope * kDirectionSlack};
}

// Half the cone of normals over the box where it is more than `cone` and where shorter segments have less.
double turn_over(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double cone) {
    if (!std::isfinite(cone)) return 0;
    const double turn = normal_cone(surface, box).angle;
    return turn <= cone || has_narrow_cones(surface, box, cone) ? turn : 0;
}

}  // namespace

SegmentError EdgeMesher::error(int edge, double a, double b, double tolerance, double cone) const {
    const EdgeMesh& mesh = edges_[std::size_t(edge)];
    const bool degenerate = model_.edges[std::size_t(edge)].degenerate;
    const Interval on{a, b};
    SegmentError out;
    if (mesh.curve) out.polyline = mesh.curve->across(on, tolerance) + mesh.curve->kinks(on);
    const double own = mesh.curve ? out.polyline : kInfinity;
    for (const auto& use : mesh.uses) {
        const DerivativeQuery<2, 3>& surface = *faces_[std::size_t(use->face)];
        std::optional<Apex> apex = apexes_[std::size_t(use->face)];
        if (apex && !apex->is_true_to(tolerance)) apex.reset();
        if (apex && apex->radius > 0)
            out.sliver = worse(out.sliver, kBothSides * tolerance * tolerance / apex->radius);
        if (use->lift) {
            const Vec<2> from = jet<0>(use->coedge->curve, a).value(),
                         to = jet<0>(use->coedge->curve, b).value();
            Box<2> box;
            box.add(from), box.add(to);
            if (!use->lift->on_plane)
                out.triangle =
                    worse(out.triangle,
                          BoundarySide{surface, box, surface({box.side(0), box.side(1)}), from, to, apex}
                              .error_beside());
            if (degenerate) continue;
            out.turn = std::max(out.turn, turn_over(surface, box, cone));
            const Interval there = use->lift->over(on);
            const double polyline = use->is_twin(tolerance)
                                        ? own + 2 * use->twin
                                        : use->chords->across(there, tolerance) + use->chords->kinks(there);
            out.polyline = std::max(out.polyline, polyline);
            continue;
        }
        const OnFace face(surface, *use, a, b);
        double sliver = face.along(face.sag) / 8 + face.kinks();
        const BoundarySide side{surface, face.box, face.over, face.from, face.to, apex};
        const double beside = side.error_beside();
        out.triangle = worse(out.triangle, beside);
        const auto bow = side.bow();
        double uneven = 0;  // of the chord, what places on the side and on the chord differ by
        if (!degenerate) {
            out.turn = std::max(out.turn, turn_over(surface, face.box, cone));
            double polyline = face.crude();
            if (!(polyline <= tolerance))
                if (const auto better = face.across(); better && better->distance < polyline) {
                    polyline = better->distance;
                    const Vec<2> wide{{face.sag[0] + better->wider * std::abs(face.chord[0]),
                                       face.sag[1] + better->wider * std::abs(face.chord[1])}};
                    sliver = face.along(wide) / 8 + face.kinks();
                    uneven = better->uneven;
                }
            if (bow) polyline = worse(polyline, beside);
            out.polyline = worse(out.polyline, polyline);
        }
        if (bow) {
            const Vec<2> wide{
                {(*bow)[0] + uneven * std::abs(face.chord[0]), (*bow)[1] + uneven * std::abs(face.chord[1])}};
            sliver = worse(sliver, face.along(wide) / 8 + face.kinks());
        }
        out.sliver = worse(out.sliver, sliver);
    }
    return out;
}

}  // namespace freiform
