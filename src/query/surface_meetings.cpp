// Which edges of surfaces meet, and along which parts of them.
//
// Idea: where two edges have a part in common, it begins and ends at an end of one of them. So the four ends
// are looked for on the other edge; those within the gap are pairs of parameters, and the common part is
// between the two pairs that are farthest apart.
//
// Method: edges sorted by the lower ends of their boxes along the first coordinate, each compared with those
// that begin before it ends. Whole edges are compared first, at 9 places; that needs no search. The nearest
// place of an edge to a point: the best of some places of each piece, then the method of Gauss and Newton,
// which converges like Newton where the distance vanishes. Places beside a knot by no more than rounding
// are the knot.
//
// Accuracy: parameters are known up to what moves points by the roundings that are granted to coordinates,
// and to their own roundings; `part_of` carries that into the bounds of all jumps.
//
// Why not intersect the edges? Curves that have a part in common meet in every point of it, none of which is
// a crossing.
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/query/surface_continuity.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace freiform {

namespace {

constexpr int kPlaces = 9;
using Point = std::vector<double>;

double distance_of(const Point& a, const Point& b) {
    double d = 0;
    for (std::size_t c = 0; c < a.size(); ++c) d = std::hypot(d, b[c] - a[c]);
    return d;
}

struct LinePoint {
    Point at, slope;  // the derivative is by the fraction of the piece
};

// At x in [0, 1] of a piece.
LinePoint on_piece(const SurfaceSide& side, const SurfaceSide::Piece& piece, double x) {
    const auto row = [&](std::size_t r) {
        std::vector<double> b;
        for (const Bounded& c : piece.derivative[r]) b.push_back(c.value);
        const std::size_t n = b.size();
        for (std::size_t k = 1; k + 1 < n; ++k)
            for (std::size_t i = 0; i + k < n; ++i) b[i] = (1 - x) * b[i] + x * b[i + 1];
        return n < 2 ? std::array{b[0], 0.0}
                     : std::array{(1 - x) * b[0] + x * b[1], double(n - 1) * (b[1] - b[0])};
    };
    const auto [w, dw] = row(std::size_t(side.dimension));
    LinePoint p;
    for (std::size_t c = 0; c < std::size_t(side.dimension); ++c) {
        const auto [n, dn] = row(c);
        p.at.push_back(side.origin[c] + n / w);
        p.slope.push_back((dn - n / w * dw) / w);
    }
    return p;
}

double parameter(const SurfaceSide::Piece& piece, double x) {
    return x == 0 ? piece.on.lo : x == 1 ? piece.on.hi : piece.on.lo + x * (piece.on.hi - piece.on.lo);
}

Point point_at(const SurfaceSide& side, double t) {
    const auto has = [&](const SurfaceSide::Piece& p) { return t <= p.on.hi; };
    const auto found = std::ranges::find_if(side.pieces, has);
    const SurfaceSide::Piece& p = found == side.pieces.end() ? side.pieces.back() : *found;
    return on_piece(side, p, std::clamp((t - p.on.lo) / (p.on.hi - p.on.lo), 0.0, 1.0)).at;
}

Interval line_of(const SurfaceSide& side) { return {side.pieces.front().on.lo, side.pieces.back().on.hi}; }

struct Foot {
    double t = 0, distance = 0;
    double speed = 0;  // |derivative by t| there
};

// The nearest place of the line to q.
Foot foot_of(const SurfaceSide& side, const Point& q) {
    constexpr int kGrid = 8, kSteps = 40;
    const SurfaceSide::Piece* best = nullptr;
    double x = 0, least = std::numeric_limits<double>::infinity();
    for (const SurfaceSide::Piece& p : side.pieces)
        for (int i = 0; i <= kGrid; ++i)
            if (const double d = distance_of(on_piece(side, p, double(i) / kGrid).at, q); d < least)
                best = &p, x = double(i) / kGrid, least = d;
    if (!best) return {0, least, 0};
    LinePoint here = on_piece(side, *best, x);
    for (int k = 0; k < kSteps; ++k) {
        double along = 0, square = 0;
        for (std::size_t c = 0; c < q.size(); ++c)
            along += (q[c] - here.at[c]) * here.slope[c], square += here.slope[c] * here.slope[c];
        if (!(square > 0)) break;
        double next = x + along / square;
        // Over the end of a piece: on in its neighbour.
        const auto at = best - side.pieces.data();
        if (next > 1 && x == 1 && best != &side.pieces.back())
            best = &side.pieces[std::size_t(at + 1)], next = 0;
        else if (next < 0 && x == 0 && at > 0)
            best = &side.pieces[std::size_t(at - 1)], next = 1;
        next = std::clamp(next, 0.0, 1.0);
        if (next == x) break;
        x = next;
        here = on_piece(side, *best, x);
    }
    const double length = best->on.hi - best->on.lo, t = parameter(*best, x);
    double speed = 0;
    for (const double s : here.slope) speed = std::hypot(speed, s / length);
    return {t, distance_of(here.at, q), speed};
}

struct Edge {
    const SurfaceSide* side = nullptr;
    std::vector<Point> point;  // at equal fractions
    Point lo, hi;              // a box of the line
    std::size_t surface = 0, index = 0;
};

Edge edge_of(const SurfaceSide& side, std::size_t surface, std::size_t index) {
    Edge e{&side, {}, {}, {}, surface, index};
    const Interval on = line_of(side);
    for (int k = 0; k < kPlaces; ++k) {
        const double f = double(k) / (kPlaces - 1);
        e.point.push_back(point_at(side, k + 1 == kPlaces ? on.hi : on.lo + f * (on.hi - on.lo)));
    }
    const std::size_t d = std::size_t(side.dimension);
    e.lo.assign(d, std::numeric_limits<double>::infinity());
    e.hi.assign(d, -std::numeric_limits<double>::infinity());
    for (const auto& piece : side.pieces)
        for (std::size_t c = 0; c < d; ++c)
            for (std::size_t i = 0; i < piece.derivative[c].size(); ++i) {
                const double w = side.is_rational ? piece.derivative[d][i].value : 1;
                const double x = side.origin[c] + piece.derivative[c][i].value / w;
                e.lo[c] = std::min(e.lo[c], x), e.hi[c] = std::max(e.hi[c], x);
            }
    return e;
}

bool boxes_are_near(const Edge& a, const Edge& b, double gap) {
    for (std::size_t c = 0; c < a.lo.size(); ++c)
        if (a.lo[c] - b.hi[c] > gap || b.lo[c] - a.hi[c] > gap) return false;
    return true;
}

double distance_of(const Edge& a, const Edge& b, bool against) {
    double most = 0;
    for (std::size_t i = 0; i < kPlaces; ++i)
        most = std::max(most, distance_of(a.point[i], b.point[against ? kPlaces - 1 - i : i]));
    return most;
}

// Parameters of both lines that are one place.
struct Pair {
    double a = 0, b = 0;
};

// What moves points of the line by a few roundings of coordinates and of parameters.
double grant_of(const SurfaceSide& side, double t, double speed, double roundings) {
    double size = 0;
    for (const double x : side.origin) size = std::max(size, std::abs(x));
    size = std::max(size, side.length);
    return roundings * kUnitRoundoff * (std::abs(t) + (speed > 0 ? size / speed : 0));
}

// The common part of two edges of which neither needs to be whole.
std::optional<SurfaceMeeting> common_part(const Edge& a, const Edge& b, double gap, double roundings) {
    const Interval on_a = line_of(*a.side), on_b = line_of(*b.side);
    std::vector<Pair> pairs;
    double grant[2] = {0, 0};
    const auto look = [&](const Edge& from, const Edge& to, std::size_t k) {
        const Interval &own = k == 0 ? on_a : on_b, &other = k == 0 ? on_b : on_a;
        for (const bool end : {false, true}) {
            const Foot f = foot_of(*to.side, end ? from.point.back() : from.point.front());
            if (!(f.distance <= gap)) continue;
            const double known = grant_of(*to.side, f.t, f.speed, roundings);
            double t = f.t;
            for (const double x : {other.lo, other.hi})
                if (std::abs(t - x) <= known) t = x;
            if (t != other.lo && t != other.hi) grant[1 - k] = std::max(grant[1 - k], known);
            const double mine = end ? own.hi : own.lo;
            pairs.push_back(k == 0 ? Pair{mine, t} : Pair{t, mine});
        }
    };
    look(a, b, 0);
    look(b, a, 1);
    if (pairs.size() < 2) return std::nullopt;
    const auto [lo, hi] = std::ranges::minmax(pairs, {}, &Pair::a);
    SurfaceMeeting m;
    m.whole = false;
    m.against = hi.b < lo.b;
    m.first_on = {lo.a, hi.a};
    m.second_on = {std::min(lo.b, hi.b), std::max(lo.b, hi.b)};
    std::ranges::copy(grant, m.grant);
    if (!(m.first_on.length() > 2 * grant[0]) || !(m.second_on.length() > 2 * grant[1])) return std::nullopt;
    double length = 0;
    Point before;
    for (int k = 0; k < kPlaces; ++k) {
        const double f = double(k) / (kPlaces - 1);
        const Point p = point_at(*a.side, lo.a + f * (hi.a - lo.a)),
                    q = point_at(*b.side, lo.b + f * (hi.b - lo.b));
        m.distance = std::max(m.distance, distance_of(p, q));
        if (k > 0) length += distance_of(before, p);
        before = p;
    }
    if (!(m.distance <= gap) || !(length > gap)) return std::nullopt;
    return m;
}

std::optional<SurfaceMeeting> meeting(const Edge& a, const Edge& b, double gap, double roundings) {
    const double same = distance_of(a, b, false), turned = distance_of(a, b, true);
    std::optional<SurfaceMeeting> m;
    if (std::min(same, turned) <= gap) {
        m.emplace();
        m->against = turned < same;
        m->distance = std::min(same, turned);
        m->first_on = line_of(*a.side), m->second_on = line_of(*b.side);
    } else {
        m = common_part(a, b, gap, roundings);
    }
    if (m) {
        m->first = a.surface, m->first_edge = edge_at(a.index);
        m->second = b.surface, m->second_edge = edge_at(b.index);
    }
    return m;
}

auto key(const SurfaceMeeting& m) {
    return std::tuple(m.first, m.second, m.first_edge.axis, m.first_edge.end, m.second_edge.axis,
                      m.second_edge.end);
}

}  // namespace

Result<std::vector<SurfaceMeeting>> meetings(std::span<const SurfaceEdges> surfaces, double gap,
                                             double roundings, std::size_t most) {
    if (!(gap >= 0)) return refuse(RefusalKind::invalid, "gap", text(gap, " is not a number >= 0"));
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        for (std::size_t e = 0; e < 4; ++e)
            if (const SurfaceSide& side = surfaces[i][e]; !side.pieces.empty() && side.length > gap)
                edges.push_back(edge_of(side, i, e));
    sort(edges, [](const Edge& a, const Edge& b) {
        return std::tuple(a.lo[0], a.surface, a.index) < std::tuple(b.lo[0], b.surface, b.index);
    });
    std::vector<SurfaceMeeting> all;
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size() && edges[j].lo[0] - edges[i].hi[0] <= gap; ++j) {
            const bool ordered =
                std::tuple(edges[i].surface, edges[i].index) < std::tuple(edges[j].surface, edges[j].index);
            const Edge &a = ordered ? edges[i] : edges[j], &b = ordered ? edges[j] : edges[i];
            if (a.lo.size() != b.lo.size() || !boxes_are_near(a, b, gap)) continue;
            auto m = meeting(a, b, gap, roundings);
            if (!m) continue;
            if (all.size() >= most)
                return refuse(RefusalKind::limit, "gap",
                              text("more than ", most, " pairs of edges are at most ", gap, " apart"));
            all.push_back(*std::move(m));
        }
    sort(all, {}, key);
    return all;
}

Result<std::vector<SurfaceJoint>> joints(std::span<const SurfaceEdges> surfaces, double gap,
                                         const ContinuityOptions& options, std::size_t most) {
    const auto pairs = meetings(surfaces, gap, options.roundings, most);
    if (!pairs) return std::unexpected(pairs.error());
    const auto side = [&](std::size_t surface, SurfaceEdge e) -> const SurfaceSide& {
        return surfaces[surface][std::size_t(2 * e.axis + (e.end == End::end))];
    };
    std::vector<SurfaceJoint> all;
    for (const SurfaceMeeting& m : *pairs) {
        SurfaceSide first = side(m.first, m.first_edge), second = side(m.second, m.second_edge);
        if (!m.whole) {
            first = part_of(first, m.first_on, m.grant[0]);
            second = part_of(second, m.second_on, m.grant[1]);
        }
        second = reversed_across(std::move(second));
        if (m.against) second = reversed_along(std::move(second));
        auto j = continuity(first, second, options);
        if (!j) return refuse_within(text("surfaces[", m.first, "] and surfaces[", m.second, "]"), j.error());
        all.push_back({m, *std::move(j)});
    }
    return all;
}

}  // namespace freiform
