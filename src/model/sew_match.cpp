// Are two edges the same curve within a tolerance?
//
// Idea. Curves that are the same within a tolerance need not run at the same speed, so the distance of points
// with equal parameters says nothing. Feet of places on one curve say which point of the other belongs to it;
// a monotone map phi through them, with the right slopes, makes the distance |A(t) - B(phi(t))| hardly larger
// than that of the curves. And this distance has a proof: B swept along any direction is a surface, t ->
// (phi(t), 0) is a curve in its parameter plane, and edge_gap bounds how far the two together stray from A.
// phi is continuous and takes the ends to the ends, so it meets every parameter of B, and the bound holds for
// the Hausdorff distance (even that of Frechet) of the two.
//
// Method. phi: affine first (most twins in files are), then Hermite's cubics between n = 2, 4, .. nodes;
// kinks of either curve are nodes with two slopes. The slope of the foot of A(t), from (A - B) . B' = 0:
//     phi' = A' . B' / (B' . B' - (A - B) . B'').
// Slopes are held between 0 and three times those of the neighbouring chords, which keeps the cubic monotone
// [Fritsch & Carlson 1980]. What the parameter curve of B's face becomes is Hermite's cubic again, through
// p(phi(t)) with slopes p'(phi) phi'; its distance from A is proven by edge_gap too.
//
// Cost: n feet and a proof for each n; errors fall with n^4. Two edges with nothing in common are told by
// nine feet.
//
// Why not compose p and phi exactly? Degree 9 for a cubic, and conics have no such form.
#include "sew_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kFeetFirst = 9;
constexpr int kMostNodes = 256;      // a backstop
constexpr int kMostFollowed = 4096;  // likewise, of a parameter curve that follows
constexpr double kSlack = 1.5;       // a bound up to this times what was measured is good enough
// Slopes are those so far (of the step) inside of a node: at the ends of pieces without a length to speak of,
// which images have where a break lies beside a knot of the surface, derivatives are noise.
constexpr double kBeside = 0x1p-30;
constexpr double kFine = 1.0 / 8;                     // so is one up to this times the tolerance
constexpr double kFineExtent = 1.0 / 16;              // and up to this times the extent
constexpr double kWithin = 0.995, kTightest = 1.002;  // what is close to the tolerance is bounded closely

// Where it would be if the two ran at the same speed.
double same_place(const EdgeTrace& from, const EdgeTrace& onto, bool reversed, double t) {
    const double x = (t - from.on.lo) / from.on.length();
    return clamped(onto.on.lo + (reversed ? 1 - x : x) * onto.on.length(), onto.on);
}

double slope_of_foot(const EdgeTrace& stays, const EdgeTrace& other, double t, double s) {
    const auto a = jet<2>(*stays.curve, t), b = jet<2>(*other.curve, s);
    const double down = dot(b(1), b(1)) - dot(a(0) - b(0), b(2));
    return dot(a(1), b(1)) / down;
}

// Slopes that keep the cubics monotone.
void tame(std::vector<EdgeMap::Node>& nodes) {
    const auto held = [](double slope, double chord) {
        const double most = 3 * chord;
        if (!(std::isfinite(slope))) return chord;
        return chord >= 0 ? std::clamp(slope, 0.0, most) : std::clamp(slope, most, 0.0);
    };
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const double chord = (nodes[k + 1].s - nodes[k].s) / (nodes[k + 1].t - nodes[k].t);
        nodes[k].after = held(nodes[k].after, chord);
        nodes[k + 1].before = held(nodes[k + 1].before, chord);
    }
}

// The control points of Hermite's cubics between the nodes, over knots of multiplicity 3: (s, 0).
CurveGeometry<2> plane_curve_of(const EdgeMap& map) {
    std::vector<double> knots{map.nodes.front().t};
    std::vector<Vec<2>> net{{{map.nodes.front().s, 0}}};
    for (std::size_t k = 0; k + 1 < map.nodes.size(); ++k) {
        const auto &a = map.nodes[k], &b = map.nodes[k + 1];
        const double third = (b.t - a.t) / 3;
        for (int i = 0; i < 3; ++i) knots.push_back(a.t);
        net.push_back({{a.s + third * a.after, 0}});
        net.push_back({{b.s - third * b.before, 0}});
        net.push_back({{b.s, 0}});
    }
    for (int i = 0; i < 4; ++i) knots.push_back(map.nodes.back().t);
    const int size = int(net.size());
    return Curve<Vec<2>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                  Net<1, Vec<2>>({size}, std::move(net)));
}

// Nodes at `fixed` and at `parts` - 1 equal steps between each two of them. Nothing if feet run backwards.
std::optional<EdgeMap> map_with(const EdgeTrace& stays, const EdgeTrace& other, bool reversed,
                                std::span<const double> fixed, int parts) {
    EdgeMap map;
    for (std::size_t k = 0; k + 1 < fixed.size(); ++k)
        for (int i = 0; i < parts; ++i)
            map.nodes.push_back({fixed[k] + (fixed[k + 1] - fixed[k]) * i / parts});
    map.nodes.push_back({fixed.back()});
    for (EdgeMap::Node& n : map.nodes)
        n.s = foot_on(other, jet<0>(*stays.curve, n.t).value(), same_place(stays, other, reversed, n.t)).t;
    map.nodes.front().s = reversed ? other.on.hi : other.on.lo;
    map.nodes.back().s = reversed ? other.on.lo : other.on.hi;
    for (std::size_t k = 0; k + 1 < map.nodes.size(); ++k) {
        const auto &a = map.nodes[k], &b = map.nodes[k + 1];
        if (!(a.t < b.t && (reversed ? a.s > b.s : a.s < b.s))) return {};
    }
    map.is_affine = map.nodes.size() == 2;
    if (map.is_affine) {
        const double chord = (map.nodes[1].s - map.nodes[0].s) / (map.nodes[1].t - map.nodes[0].t);
        map.nodes[0].after = map.nodes[1].before = chord;
        return map;
    }
    for (std::size_t k = 0; k + 1 < map.nodes.size(); ++k) {
        EdgeMap::Node &a = map.nodes[k], &b = map.nodes[k + 1];
        const double dt = kBeside * (b.t - a.t), ds = kBeside * (b.s - a.s);
        a.after = slope_of_foot(stays, other, a.t + dt, a.s + ds);
        b.before = slope_of_foot(stays, other, b.t - dt, b.s - ds);
    }
    tame(map.nodes);
    return map;
}

// Interior nodes: where either curve has a kink.
std::vector<double> fixed_nodes(const EdgeTrace& stays, const EdgeTrace& other) {
    std::vector<double> t{stays.on.lo, stays.on.hi};
    for (const double k : breaks_inside(*stays.curve, stays.on, true)) t.push_back(k);
    for (const double k : breaks_inside(*other.curve, other.on, true)) {
        const double at = foot_on(stays, jet<0>(*other.curve, k).value()).t;
        const bool known = std::any_of(t.begin(), t.end(), [&](double x) {
            return std::abs(x - at) <= 0x1p-30 * stays.on.length();  // the same kink
        });
        if (!known) t.push_back(at);
    }
    sort(t.begin(), t.end());
    return t;
}

// What was measured between the two: at a few feet in each direction first, which tells most pairs apart.
double measured_apart(const EdgeTrace& a, const EdgeTrace& b, bool reversed, double enough) {
    double most = 0;
    for (int way = 0; way < 2; ++way) {
        const EdgeTrace &from = way ? b : a, &onto = way ? a : b;
        for (int k = 0; k < kFeetFirst && most <= enough; ++k) {
            const double t = from.on.lo + from.on.length() * (k + 0.5) / kFeetFirst;
            most = std::max(
                most,
                foot_on(onto, jet<0>(*from.curve, t).value(), same_place(from, onto, reversed, t)).distance);
        }
    }
    for (std::size_t k = 0; k < a.at.size() && most <= enough; ++k)
        most = std::max(most, foot_on(b, a.at[k], same_place(a, b, reversed, a.t[k])).distance);
    return most;
}

}  // namespace

double EdgeMap::operator()(double t) const {
    const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, t,
                                        [](double x, const Node& n) { return x < n.t; });
    const Node &a = *(after - 1), &b = *after;
    const double h = b.t - a.t, x = (t - a.t) / h, y = 1 - x;
    return y * y * (1 + 2 * x) * a.s + x * x * (1 + 2 * y) * b.s + h * x * y * (y * a.after - x * b.before);
}

double EdgeMap::slope(double t) const {
    const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, t,
                                        [](double x, const Node& n) { return x < n.t; });
    const Node &a = *(after - 1), &b = *after;
    const double h = b.t - a.t, x = (t - a.t) / h, y = 1 - x;
    return 6 * x * y * (b.s - a.s) / h + y * (y - 2 * x) * a.after + x * (x - 2 * y) * b.before;
}

Result<EdgeMatch> match(const EdgeTrace& stays, const EdgeTrace& other, bool reversed, double tolerance) {
    const double ends =
        std::max(norm(stays.end(false) - other.end(reversed)), norm(stays.end(true) - other.end(!reversed)));
    const double apart =
        std::max(ends, ends <= tolerance ? measured_apart(stays, other, reversed, tolerance) : 0);
    if (!(apart <= tolerance))
        return refuse(RefusalKind::no_answer, "edges", text("they are ", apart, " apart"));
    const Extrusion swept{*other.curve, {{0, 0, 1}}, SurfaceKind::general};
    const SurfaceGeometry surface = swept;
    const DerivativeQuery<2, 3> query(surface);
    // Of short edges finer: those that are no larger than the bound are told from points by it.
    const double fine = std::min(kFine * tolerance, kFineExtent * std::min(stays.extent, other.extent));
    const double enough = std::min(tolerance, std::max(kSlack * apart, fine));
    EdgeGapOptions how{.target = fine};
    how.factor = std::clamp(kWithin * tolerance / apart, kTightest, how.factor);
    const auto fixed = fixed_nodes(stays, other);
    std::optional<EdgeMatch> best;
    for (int parts = 1; parts * int(fixed.size() - 1) <= kMostNodes; parts *= 2) {
        auto map = map_with(stays, other, reversed, fixed, parts);
        if (!map) continue;
        const auto on_other = plane_curve_of(*map);
        EdgeGap gap = edge_gap(query, on_other, *stays.curve, stays.on, how);
        if (gap.bound > tolerance && kTightest * gap.found <= kWithin * tolerance) {
            // More than was measured, and yet within the tolerance. Far from zero that may be rounding.
            how.roundings = kFewRoundings;
            how.factor = std::clamp(kWithin * tolerance / gap.found, kTightest, how.factor);
            gap = edge_gap(query, on_other, *stays.curve, stays.on, how);
        }
        if (!best || gap.bound < best->bound) best = EdgeMatch{*std::move(map), gap.bound};
        if (best->bound <= enough) break;
    }
    if (!best || !(best->bound <= tolerance))
        return refuse(
            RefusalKind::not_converged, "edges",
            text("they seem to be ", apart, " apart, proven is only ", best ? best->bound : kInfinity));
    return *std::move(best);
}

namespace {

struct Places {
    std::vector<double> t;      // increasing, the ends included
    std::vector<double> kinks;  // some of them
    double same = 0;            // places no farther apart than this are one
    bool is_kink(double at) const {
        return std::any_of(kinks.begin(), kinks.end(), [&](double x) { return std::abs(x - at) <= same; });
    }
};

// Nodes of the map, and where the parameter curve has breaks.
Places places_of(const CurveGeometry<2>& on_surface, const EdgeTrace& stays, const EdgeMap& map, Interval on,
                 bool reversed) {
    Places out;
    out.same = 0x1p-30 * stays.on.length();
    for (const auto& n : map.nodes) out.t.push_back(n.t);
    const auto kinks = breaks_inside(on_surface, on, true);
    for (const double b : breaks_inside(on_surface, on, false)) {
        Interval within = stays.on;
        for (int step = 0; step < 64; ++step) {
            const double m = within.middle();
            ((map(m) < b) != reversed ? within.lo : within.hi) = m;
        }
        out.t.push_back(within.middle());
        if (std::find(kinks.begin(), kinks.end(), b) != kinks.end()) out.kinks.push_back(within.middle());
    }
    for (std::size_t k = 1; k + 1 < map.nodes.size(); ++k)
        if (const auto& n = map.nodes[k]; std::abs(n.before - n.after) > 0x1p-20 * std::abs(n.after))
            out.kinks.push_back(n.t);
    sort(out.t.begin(), out.t.end());
    out.t.erase(
        std::unique(out.t.begin(), out.t.end(), [&](double a, double b) { return b - a <= out.same; }),
        out.t.end());
    out.t.back() = stays.on.hi;
    return out;
}

// Hermite's cubics through p(phi(t)) at the places and `parts` - 1 more between each two of them.
std::optional<CurveGeometry<2>> hermite(const CurveGeometry<2>& p, const EdgeMap& map, const Places& places,
                                        int parts, Interval on, bool reversed) {
    std::vector<double> t;
    for (std::size_t k = 0; k + 1 < places.t.size(); ++k)
        for (int i = 0; i < parts; ++i)
            t.push_back(places.t[k] + (places.t[k + 1] - places.t[k]) * i / parts);
    t.push_back(places.t.back());
    const auto value = [&](double at) { return jet<0>(p, clamped(map(at), on)).value(); };
    const auto slope = [&](double at, bool before) {
        const double s = clamped(map(at), on);
        return map.slope(before ? std::nextafter(at, -kInfinity) : at) *
               jet<1>(p, before == reversed ? s : clamped(std::nextafter(s, -kInfinity), on))(1);
    };
    std::vector<double> knots(4, t.front());
    std::vector<Vec<2>> net{value(t.front())};
    for (std::size_t k = 0; k < t.size(); ++k) {
        const bool first = k == 0, last = k + 1 == t.size(), kink = places.is_kink(t[k]);
        const Vec<2> here = value(t[k]);
        if (!first) net.push_back(here - ((t[k] - t[k - 1]) / 3) * slope(t[k], true));
        if ((kink && !first) || last) net.push_back(here);
        if (!last) net.push_back(here + ((t[k + 1] - t[k]) / 3) * slope(t[k], false));
        if (!first && !last) knots.insert(knots.end(), kink ? 3 : 2, t[k]);
    }
    knots.insert(knots.end(), 4, t.back());
    auto basis = BSplineBasis::make(3, std::move(knots));
    const int size = int(net.size());
    if (!basis || basis->size() != size) return {};
    return Curve<Vec<2>>::trusted({std::move(*basis)}, Net<1, Vec<2>>({size}, std::move(net)));
}

// The parameter curve at the speed of an affine map: exactly, but for the rounding of knots. Nothing for
// conics, whose speed is their own.
std::optional<CurveGeometry<2>> at_speed(const CurveGeometry<2>& on_surface, const EdgeMap& map) {
    const EdgeMap::Node &a = map.nodes.front(), &b = map.nodes.back();
    const double slope = a.after;
    return visit_one(
        [&](const auto& c) -> std::optional<CurveGeometry<2>> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<2>>) {
                return Line<2>{c.origin + (a.s - slope * a.t) * c.direction, slope * c.direction};
            } else if constexpr (std::same_as<C, Conic<2>>) {
                return std::nullopt;
            } else {
                if (c.basis().is_closed()) return std::nullopt;
                std::vector<double> knots;
                for (const double s : c.basis().knots())
                    knots.push_back(s == a.s ? a.t : s == b.s ? b.t : a.t + (s - a.s) / slope);
                if (slope < 0) std::reverse(knots.begin(), knots.end());
                auto basis = BSplineBasis::make(c.basis().degree(), std::move(knots));
                if (!basis) return std::nullopt;
                return C::trusted({*basis}, slope < 0 ? reverse(c, 0).net() : c.net());
            }
        },
        on_surface);
}

}  // namespace

Result<FollowedCurve> followed(const DerivativeQuery<2, 3>& surface, const CurveGeometry<2>& on_surface,
                               const EdgeTrace& stays, const EdgeMatch& match, double allowed) {
    const auto bound_of = [&](const CurveGeometry<2>& curve) {
        const EdgeGapOptions how{.target = allowed / 8, .roundings = kFewRoundings};
        return edge_gap(surface, curve, *stays.curve, stays.on, how).bound;
    };
    const auto& nodes = match.map.nodes;
    double reached = kInfinity;
    if (const auto exact = match.map.is_affine ? at_speed(on_surface, match.map) : std::nullopt) {
        reached = bound_of(*exact);
        if (reached <= allowed) return FollowedCurve{*exact, reached};
    }
    const double first = nodes.front().s, last = nodes.back().s;
    const Interval on{std::min(first, last), std::max(first, last)};
    const Places places = places_of(on_surface, stays, match.map, on, last < first);
    for (int parts = 1; parts == 1 || parts * int(places.t.size()) <= kMostFollowed; parts *= 2) {
        const auto curve = hermite(on_surface, match.map, places, parts, on, last < first);
        if (!curve) break;
        const double bound = bound_of(*curve);
        if (bound <= allowed) return FollowedCurve{*curve, bound};
        reached = std::min(reached, bound);
    }
    return refuse(RefusalKind::not_converged, "edges",
                  text("the face's parameter curve follows the edge only within ", reached));
}

}  // namespace freiform
