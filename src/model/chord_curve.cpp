// Idea: what bounds of second derivatives over a short part cost is mostly the restriction of control points
// to it. But C'' over the part is at most C'' in its middle and half its length times |C'''|, of which a
// bound over something longer will do: it is found once for some parts of each piece, and the middle is a
// sample.
//
// Notation: e direction of the chord, P the projection across it, h the length of the part.
// Bounds: with C' . e > 0 the points of curve and chord correspond by their projections onto e; their
// distance is |P (C - linear)| <= h^2/8 max|P C''| (edge_error.cpp). C' . e >= C'(m) . e - h/2 max|C''| less
// jumps, and C' may be no steeper against the chord than bending.cpp takes for granted. Over parts that reach
// over a break of the knots C''' says nothing of C'', and where the estimate above is too large for `enough`
// control points may say less: there C'' is bounded in two directions f across the chord by itself. Where
// short pieces of the curve bend more than others max|C''| counts as PiecewiseBound says.
//
// Lifts: a plane is an affine map, so the image of a line, conic or spline has the images of its
// coefficients. Along a parameter line surfaces are their profile moved, a circle, a straight line, or the
// iso-curve of a spline. Distances from chords do not change by moves, which are left out.
//
// Accuracy: C''(m) is a sum of products of coefficients (of size A, weights w) with factors up to 4 p^2 /
// width^2, divided by weights up to three times: 2^11 u for all of its roundings. Coefficients of lifts are
// off by a few units in the last place, which is within what points of surfaces are off by and added where
// these are.
#include "chord_curve_detail.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kParts = 8;            // of a curve at least, each with a bound of its own
constexpr double kSteepest = 0.55;           // speed across the chord beside that along it (edge_error.cpp)
constexpr double kFrameSlack = 1 + 0x1p-40;  // more than the roundings of directions and sums below

template <class C>
double largest_coefficient(const C& curve, double& thinnest_weight, double& widest_weight) {
    using S = Space<typename C::Coefficients>;
    double most = 0;
    thinnest_weight = kInfinity, widest_weight = 0;
    for (const auto& p : curve.net().flat()) {
        const double w = S::weight(p);
        thinnest_weight = std::min(thinnest_weight, w), widest_weight = std::max(widest_weight, w);
        for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(p[i]) / w);
    }
    return most;
}

}  // namespace

std::optional<ChordFrame> frame_of(const Vec<3>& chord, const Vec<3>& bend) {
    if (!(norm(chord) > 0)) return std::nullopt;
    const Vec<3> e = unit(chord);
    const auto across = [&](const Vec<3>& x) { return x - dot(x, e) * e; };
    Vec<3> f = across(bend);
    if (!(norm(f) > 0x1p-20 * norm(bend))) {
        Vec<3> axis{};
        axis[std::abs(e[0]) < 0.6 ? 0 : 1] = 1;
        f = across(axis);
    }
    f = unit(across(unit(f)));
    return ChordFrame{e, f, cross(e, f)};
}

ChordCurve::ChordCurve(const CurveGeometry<3>& curve) : query_(curve) {
    visit_one(
        [&](const auto& c) {
            using C = std::remove_cvref_t<decltype(c)>;
            straight_ = std::same_as<C, Line<3>>;
            if constexpr (requires { c.net(); }) {
                const int p = c.basis().degree();
                double least = 0, most = 0;
                const double size = largest_coefficient(c, least, most);
                const double width = query_.thinnest_piece(0), ratio = most / least;
                second_rounding_ = 0x1p-42 * ratio * ratio * size * (4.0 * p * p / (width * width));
                if (c.basis().is_closed()) return;  // parameters may go around
                const auto breaks = c.basis().breaks();
                const std::size_t pieces = breaks.size() - 1;
                const int parts = int((kParts + pieces - 1) / pieces);
                begin_ = breaks[0];
                for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
                    for (int k = 1; k <= parts; ++k) {
                        const Interval on{
                            pieces_.empty() ? begin_ : pieces_.back().end,
                            k == parts ? breaks[i + 1] : breaks[i] + (breaks[i + 1] - breaks[i]) * k / parts};
                        const auto d = query_({on}, 3);
                        pieces_.push_back({on.hi, k > 1, d(2), d(3)});
                        second_.add(on.hi, d(2));
                    }
            }
        },
        curve);
}

// Of third derivatives infinity where the part reaches over a break.
ChordCurve::Most ChordCurve::over(Interval on) const {
    if (pieces_.empty()) {
        const auto d = query_({on}, 3);
        return {d(2), d(3)};
    }
    auto first = std::upper_bound(pieces_.begin(), pieces_.end(), on.lo,
                                  [](double t, const Piece& p) { return t < p.end; });
    if (first == pieces_.end()) --first;
    Most out{first->second, first->third};
    for (auto p = first; p->end < on.hi && std::next(p) != pieces_.end();) {
        ++p;
        out.second = std::max(out.second, p->second);
        out.third = p->smooth ? std::max(out.third, p->third) : kInfinity;
        if (!p->smooth) {
            for (; p->end < on.hi && std::next(p) != pieces_.end(); ++p)
                out.second = std::max(out.second, std::next(p)->second);
            break;
        }
    }
    return out;
}

double ChordCurve::at_equal(Interval on) const {
    if (straight_) return 0;
    return on.length() * on.length() / 8 * query_({on})(2);
}

double ChordCurve::across(Interval on, double enough) const {
    if (straight_) return 0;
    const double h = on.length(), share = h * h / 8;
    const Most most = over(on);
    if (share * most.second <= enough / 16) return share * most.second;
    const double steady = second_.is_empty() ? most.second : second_.steady(on);
    const auto& curve = query_.geometry();
    const auto middle = jet<2>(curve, on.middle());
    const auto frame = frame_of(jet<0>(curve, on.hi).value() - jet<0>(curve, on.lo).value(), middle.d[2]);
    double torn = 0;
    for (const Kink& k : query_.kinks(0))
        if (on.lo < k.at && k.at < on.hi) torn += k.jump;
    const auto equal = [&] { return std::min(at_equal(on), share * steady); };
    if (!frame) return equal();
    const auto across_chord = [&](const Vec<3>& x) { return x - dot(x, (*frame)[0]) * (*frame)[0]; };
    const double bend =
        norm(across_chord(middle.d[2])) + h / 2 * most.third + second_rounding_ + 0x1p-44 * most.second;
    const double along = dot((*frame)[0], middle.d[1]) - (h / 2 * steady + torn) * kFrameSlack;
    const double aside =
        norm(across_chord(middle.d[1])) + (h / 2 * std::min(bend, steady) + torn) * kFrameSlack;
    if (!(along > 0 && aside <= kSteepest * along)) return equal();
    const double sampled = share * std::min(bend * kFrameSlack, steady);
    if (sampled <= enough) return sampled;
    const double directions =
        std::hypot(query_.along((*frame)[1], {on})(2), query_.along((*frame)[2], {on})(2));
    return std::min(sampled, share * (directions + 0x1p-44 * most.second) * kFrameSlack);
}

namespace {

// The image under (x, y) -> origin + x a + y b.
struct AffineImage {
    Vec<3> origin, a, b;
    Vec<3> linear(const Vec<2>& x) const { return x[0] * a + x[1] * b; }
    CurveGeometry<3> operator()(const Line<2>& c) const {
        return Line<3>{origin + linear(c.origin), linear(c.direction)};
    }
    CurveGeometry<3> operator()(const Conic<2>& c) const {
        return Conic<3>{c.kind, origin + linear(c.centre), linear(c.x), linear(c.y)};
    }
    CurveGeometry<3> operator()(const Curve<Vec<2>>& c) const {
        std::vector<Vec<3>> p;
        for (const auto& q : c.net().flat()) p.push_back(origin + linear(q));
        return Curve<Vec<3>>::trusted(c.bases(), Net<1, Vec<3>>(c.net().extent(), std::move(p)));
    }
    CurveGeometry<3> operator()(const Curve<Hom<2>>& c) const {
        std::vector<Hom<3>> p;
        for (const auto& q : c.net().flat()) {
            const Vec<3> x = q.weight() * origin + linear({{q[0], q[1]}});
            p.push_back({{x[0], x[1], x[2], q.weight()}});
        }
        return Curve<Hom<3>>::trusted(c.bases(), Net<1, Hom<3>>(c.net().extent(), std::move(p)));
    }
};

// Along the parameter line where parameter 1 - axis is `at`.
std::optional<CurveGeometry<3>> parameter_line(const SurfaceGeometry& surface, int axis, double at) {
    return visit_one(
        [&](const auto& s) -> std::optional<CurveGeometry<3>> {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (std::same_as<S, Extrusion>) {
                return axis == 0 ? s.profile : CurveGeometry<3>{Line<3>{{}, s.direction}};
            } else if constexpr (std::same_as<S, Revolution>) {
                if (axis == 1) return s.profile;
                const double r = norm(cross(s.axis, jet<0>(s.profile, at).value() - s.origin));
                return Conic<3>{ConicKind::ellipse, {}, {{r, 0, 0}}, {{0, r, 0}}};
            } else if constexpr (std::same_as<S, OffsetSurface>) {
                return std::nullopt;
            } else {
                return iso(s, 1 - axis, clamped(at, s.domain()[std::size_t(1 - axis)]));
            }
        },
        surface);
}

}  // namespace

std::optional<LiftedCurve> lifted(const SurfaceGeometry& surface, const CurveGeometry<2>& curve) {
    const auto make = [](CurveGeometry<3> g, double shift, double speed, bool plane) {
        return LiftedCurve{std::make_unique<const CurveGeometry<3>>(std::move(g)), shift, speed, plane};
    };
    if (const auto* e = std::get_if<Extrusion>(&surface))
        if (const auto* line = std::get_if<Line<3>>(&e->profile))
            return make(visit_one(AffineImage{line->origin, line->direction, e->direction}, curve), 0, 1,
                        true);
    const auto* line = std::get_if<Line<2>>(&curve);
    if (!line) return std::nullopt;
    for (int axis = 0; axis < 2; ++axis)
        if (line->direction[1 - axis] == 0 && line->direction[axis] != 0)
            if (auto g = parameter_line(surface, axis, line->origin[1 - axis]))
                return make(std::move(*g), line->origin[axis], line->direction[axis], false);
    return std::nullopt;
}

double distance_of_twins(const CurveGeometry<3>& a, const CurveGeometry<3>& b) {
    return visit_one(
        [&](const auto& x) {
            using C = std::remove_cvref_t<decltype(x)>;
            const C* y = std::get_if<C>(&b);
            if constexpr (requires { x.net(); }) {
                if (!y || x.basis() != y->basis()) return kInfinity;
                const auto p = x.net().flat(), q = y->net().flat();
                double most = 0;
                for (std::size_t i = 0; i < p.size(); ++i) {
                    using S = Space<typename C::Coefficients>;
                    if (S::weight(p[i]) != S::weight(q[i])) return kInfinity;
                    most = std::max(most, norm(project(p[i]) - project(q[i])));
                }
                return most;
            } else {
                return kInfinity;
            }
        },
        a);
}

}  // namespace freiform
