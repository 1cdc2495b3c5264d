// Boundaries that cross themselves within the tolerance of the model.
//
//     A --------.            The file means a sharp tip, and its edges cross before they meet. What the loop
//                X == tip    does beyond the crossing X is a lens, no wider than the model is accurate.
//     B --------'
//
// The face ends at the crossing: its polygon goes from the last corner before it to the first one after it.
// The points of the lens are on edges that other faces have, too, so they stay; a strip of triangles between
// its two sides closes the mesh. In the parameter plane these may be turned over: what bounds the distance
// of a triangle from the surface does not ask for that. Nothing of the face is left out: polygon and strip
// together are a chain that has the loop as its boundary, so what it is mapped to covers all parameters about
// which the loop winds. On the side that both have, triangles of the polygon are compared with the surface at
// feet (bending.cpp), and those of the strip straight: what lies between a place y there and its foot is
// covered by going downhill from y, where the surface is within the bound of the strip, which becomes that of
// the face if it is larger.
#include "tessellator_detail.hpp"

#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr int kMostLenses = 16;             // of a face
constexpr std::size_t kMostTried = 64;      // crossings, each time
constexpr std::size_t kMostCorners = 1024;  // of a lens
constexpr double kNarrow = 0.25;            // width over length
constexpr int kLensRounds = 6;              // each cuts the segments that cross
constexpr double kFlat = 1e-9;              // of the squared longest side: no area
constexpr double kLeastCut = 1.0 / 64;      // of a segment, that is cut from it

struct Chain {
    std::vector<int> corners;    // of the polygon
    std::vector<double> length;  // from the first to each
};

// Between the ends of segments `s` and `t`, in the parameter plane.
double area_within(const FaceBoundary& polygon, int s, int t, const std::vector<int>& lens) {
    const Vec<2> from = polygon.uv[std::size_t(polygon.segments[std::size_t(s)][0])];
    Vec<2> last{};
    double area = 0;
    const auto add = [&](int corner) {
        const Vec<2> d = polygon.uv[std::size_t(corner)] - from;
        area += cross(last, d);
        last = d;
    };
    for (const int corner : lens) add(corner);
    add(polygon.segments[std::size_t(t)][1]);
    return std::abs(area);
}

bool is_flat(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return !(norm(cross(b - a, c - a)) > kFlat * longest * longest);
}

double distance(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b) {
    const Vec<3> d = b - a;
    const double l = dot(d, d), t = l > 0 ? std::clamp(dot(p - a, d) / l, 0.0, 1.0) : 0;
    return norm(p - a - t * d);
}

}  // namespace

// The corners from the one behind segment `s` to the first one of segment `t`; nothing if they are not of one
// loop.
std::vector<int> Tessellator::corners_between(const FaceBoundary& polygon, int s, int t) {
    std::vector<int> next(polygon.uv.size(), -1);
    for (const auto& [a, b] : polygon.segments) next[std::size_t(a)] = b;
    std::vector<int> out;
    const int last = polygon.segments[std::size_t(t)][0];
    for (int at = polygon.segments[std::size_t(s)][1];; at = next[std::size_t(at)]) {
        if (at < 0 || out.size() > polygon.uv.size()) return {};
        out.push_back(at);
        if (at == last) return out;
    }
}

// The strip that closes the lens between the ends of two segments that cross; false if it is too wide, and
// the segments have to be cut where they cross, or its triangles are further from the surface than the
// tolerance, and their sides have to be cut.
bool Tessellator::add_strip(std::size_t f, int s, int t, const std::vector<int>& lens,
                            std::vector<Cut>& cuts) {
    BoundaryOfFace& boundary = boundaries_[f];
    const FaceBoundary& polygon = boundary.polygon;
    const auto at = [&](int corner) { return points_[std::size_t(polygon.point[std::size_t(corner)])]; };
    Chain whole{{polygon.segments[std::size_t(s)][0]}, {0}};
    const auto add = [&](Chain& c, int corner) {
        c.length.push_back(c.length.back() + norm(at(corner) - at(c.corners.back())));
        c.corners.push_back(corner);
    };
    for (const int corner : lens) add(whole, corner);
    add(whole, polygon.segments[std::size_t(t)][1]);
    std::size_t tip = 1;  // as far from both ends
    const double half = whole.length.back() / 2;
    for (std::size_t k = 1; k + 1 < whole.corners.size(); ++k)
        if (std::abs(whole.length[k] - half) < std::abs(whole.length[tip] - half)) tip = k;
    Chain there{{whole.corners[0]}, {0}}, back{{whole.corners.back()}, {0}};
    for (std::size_t k = 1; k <= tip; ++k) add(there, whole.corners[k]);
    for (std::size_t k = whole.corners.size() - 1; k-- > tip;) add(back, whole.corners[k]);

    double width = 0, accuracy = model_.faces[f].tolerance;
    for (const auto& [one, other] : {std::pair(&there, &back), std::pair(&back, &there)})
        for (std::size_t c = 1; c < one->corners.size(); ++c) {  // the first one is before the crossing
            const int corner = one->corners[c];
            double near = kInfinity;
            for (std::size_t k = 0; k + 1 < other->corners.size(); ++k)
                near = std::min(near, distance(at(corner), at(other->corners[k]), at(other->corners[k + 1])));
            width = std::max(width, near);
        }
    for (std::size_t k = 0; k < boundary.sources.size(); ++k)
        if (const int e = boundary.sources[k].edge;
            e >= 0 && std::ranges::find(lens, polygon.segments[k][0]) != lens.end())
            accuracy = std::max(accuracy, model_.edges[std::size_t(e)].tolerance);
    if (!(width <= std::min(4 * accuracy, kNarrow * half))) {
        cut_at_crossing(f, s, t, cuts);
        cut_at_crossing(f, t, s, cuts);
        return false;
    }

    std::vector<BoundaryOfFace::StripTriangle> strip;
    double bound = 0;
    // `begin`: of the segment that is a side of it.
    const auto take = [&](int a, int b, int c, int begin) {
        const BoundaryOfFace::StripTriangle made{
            {polygon.uv[std::size_t(a)], polygon.uv[std::size_t(b)], polygon.uv[std::size_t(c)]},
            {polygon.point[std::size_t(a)], polygon.point[std::size_t(b)], polygon.point[std::size_t(c)]}};
        const auto& p = made.point;
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return;
        if (is_flat(at(a), at(b), at(c))) bound = kInfinity;
        const double own = triangle_bound(*queries_[f], made.uv);
        bound = std::max(bound, own);
        strip.push_back(made);
        if (own <= tolerance_) return;
        for (std::size_t k = 0; k < polygon.segments.size(); ++k)
            if (polygon.segments[k][0] == begin) add_cut(f, int(k), 0.5, cuts);
    };
    std::size_t i = 0, j = 0;
    while (i + 1 < there.corners.size() || j + 1 < back.corners.size()) {
        const int a = there.corners[i], b = back.corners[j];
        const bool may_forth = i + 1 < there.corners.size(), may_back = j + 1 < back.corners.size();
        bool forth = may_forth;
        if (may_forth && may_back) {
            const bool flat = is_flat(at(a), at(there.corners[i + 1]), at(b)),
                       flat_back = is_flat(at(a), at(back.corners[j + 1]), at(b));
            forth = flat != flat_back ? flat_back
                                      : there.length[i + 1] / there.length.back() <=
                                            back.length[j + 1] / back.length.back();
        }
        if (forth)
            ++i, take(a, there.corners[i], b, a);
        else
            ++j, take(a, back.corners[j], b, back.corners[j]);
    }
    if (!(bound <= tolerance_)) return false;
    boundary.strip.insert(boundary.strip.end(), strip.begin(), strip.end());
    boundary.strip_bound = std::max(boundary.strip_bound, bound);
    boundary.gap = std::max(boundary.gap, width);
    return true;
}

// The polygon without these corners: a segment goes past them.
void Tessellator::leave_out(BoundaryOfFace& boundary, int s, int t, const std::vector<int>& lens) {
    FaceBoundary& polygon = boundary.polygon;
    std::vector<int> place(polygon.uv.size(), 0);
    for (const int corner : lens) place[std::size_t(corner)] = -1;
    int kept = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
        if (place[k] < 0) continue;
        polygon.uv[std::size_t(kept)] = polygon.uv[k], polygon.point[std::size_t(kept)] = polygon.point[k];
        place[k] = kept++;
    }
    polygon.uv.resize(std::size_t(kept)), polygon.point.resize(std::size_t(kept));
    const int past = polygon.segments[std::size_t(t)][1];
    std::size_t n = 0;
    for (std::size_t k = 0; k < polygon.segments.size(); ++k) {
        auto [a, b] = polygon.segments[k];
        auto source = boundary.sources[k];
        if (int(k) == s) b = past, source = {};
        if (place[std::size_t(a)] < 0) continue;
        polygon.segments[n] = {place[std::size_t(a)], place[std::size_t(b)]};
        boundary.sources[n++] = source;
    }
    polygon.segments.resize(n), boundary.sources.resize(n);
}

// The segment where it crosses another one is to be cut, so that the lens ends near the crossing.
void Tessellator::cut_at_crossing(std::size_t f, int s, int t, std::vector<Cut>& cuts) const {
    const FaceBoundary& polygon = boundaries_[f].polygon;
    const auto [a, b] = polygon.segments[std::size_t(s)];
    const auto [c, d] = polygon.segments[std::size_t(t)];
    const auto at = [&](int corner) { return polygon.uv[std::size_t(corner)]; };
    const Vec<2> along = at(b) - at(a), other = at(d) - at(c);
    const double turn = cross(along, other);
    if (turn == 0) return;
    const double part = cross(at(c) - at(a), other) / turn;
    if (part > kLeastCut && part < 1 - kLeastCut) add_cut(f, s, part, cuts);
}

// Whether the boundary of the face is one that can be filled now; if not, where to cut it before the next
// try.
bool Tessellator::close_lenses(std::size_t f, std::vector<Cut>& cuts) {
    BoundaryOfFace& boundary = boundaries_[f];
    for (int n = 0;; ++n) {
        auto conflicts = find_conflicts(boundary.polygon);
        if (conflicts.empty()) return boundary.polygon.segments.size() >= 3;
        if (n == kMostLenses) return false;
        if (conflicts.size() > kMostTried) conflicts.resize(kMostTried);
        bool closed = false;
        for (const BoundaryConflict& c : conflicts) {
            std::vector<int> others{c.second};
            if (c.second < 0 && c.corner >= 0) {  // those on both sides of the corner
                others.clear();
                for (std::size_t k = 0; k < boundary.polygon.segments.size(); ++k)
                    for (const int end : boundary.polygon.segments[k])
                        if (end == c.corner && int(k) != c.first) others.push_back(int(k));
            }
            std::vector<int> lens;
            std::array<int, 2> ends{};
            double least = 0;
            for (const int other : others)
                for (const auto& [s, t] : {std::array{c.first, other}, std::array{other, c.first}}) {
                    if (s < 0 || t < 0) continue;
                    auto between = corners_between(boundary.polygon, s, t);
                    if (between.empty() || between.size() > kMostCorners) continue;
                    const double area = area_within(boundary.polygon, s, t, between);
                    if (lens.empty() || area < least) lens = std::move(between), ends = {s, t}, least = area;
                }
            if (lens.empty()) continue;
            closed = add_strip(f, ends[0], ends[1], lens, cuts);
            if (!closed) continue;
            leave_out(boundary, ends[0], ends[1], lens);
            break;
        }
        if (!closed) return false;
    }
}

// The faces of which the boundary crosses itself whatever is cut. Cuts in the edges of one are in those of
// its neighbours, too, which are looked at again. Those of faces that stay refused are undone.
void Tessellator::close_all_lenses(std::vector<char> crossing) {
    std::vector<std::vector<double>> before;
    const auto any = [&] {
        bool found = false;
        for (std::size_t f = 0; f < faces(); ++f) found |= crossing[f] = crossing[f] && is_refused(f);
        return found;
    };
    while (any()) {
        for (std::size_t e = before.size(); e < model_.edges.size(); ++e)
            before.push_back(edges_->mesh(int(e)).parameters);
        std::vector<std::optional<Refusal>> why(faces());
        for (std::size_t f = 0; f < faces(); ++f)
            if (crossing[f]) why[f] = std::exchange(refusals_[f], std::nullopt);
        const std::vector<char> open = cut_lenses(crossing);
        bool in_vain = false;
        for (std::size_t f = 0; f < faces(); ++f) {
            if (!open[f]) continue;
            in_vain = true;
            if (why[f])
                refusals_[f] = why[f], crossing[f] = 0;
            else  // it was fine before others were cut
                std::fill(crossing.begin(), crossing.end(), 0);
        }
        if (!in_vain) return;
        for (std::size_t f = 0; f < faces(); ++f)
            if (why[f]) refusals_[f] = why[f];
        for (std::size_t e = 0; e < before.size(); ++e) edges_->mesh(int(e)).parameters = before[e];
        number_points();
        parallel_for(faces(), 1, [&](std::size_t f) {
            if (!is_refused(f)) assemble(f);
        });
    }
}

// The faces that touch themselves in the end, or the first that do whatever is cut.
std::vector<char> Tessellator::cut_lenses(std::vector<char> looked_at) {
    std::vector<char> open(faces(), 0);
    for (int round = 0;; ++round) {
        number_points();
        std::vector<std::vector<Cut>> cuts(faces());
        parallel_for(faces(), 1, [&](std::size_t f) {
            if (is_refused(f)) return;
            assemble(f);
            open[f] = is_refused(f) || (looked_at[f] && !close_lenses(f, cuts[f]));
            refusals_[f].reset();
        });
        std::map<std::pair<int, int>, double, std::greater<>> all;  // later segments of an edge first
        std::vector<char> hopeless(faces(), 0);
        bool any = false;
        for (std::size_t f = 0; f < faces(); ++f) {
            if (!open[f]) continue;
            any |= hopeless[f] = cuts[f].empty();
            for (const Cut& c : cuts[f]) all.try_emplace({c.edge, c.segment}, c.part);
        }
        if (any) return hopeless;
        if (all.empty() || round == kLensRounds) return open;
        for (const auto& [where, part] : all) {
            edges_->split(where.first, where.second, part);
            for (const auto& use : edges_->mesh(where.first).uses) looked_at[std::size_t(use->face)] = 1;
        }
    }
}

// To the triangles of the face, once these stay as they are.
void Tessellator::add_strips() {
    for (std::size_t f = 0; f < faces(); ++f) {
        if (is_refused(f)) continue;
        FaceMesh& mesh = meshes_[f];
        for (const auto& t : boundaries_[f].strip) {
            const int first = int(mesh.uv.size());
            mesh.uv.insert(mesh.uv.end(), t.uv.begin(), t.uv.end());
            mesh.point.insert(mesh.point.end(), t.point.begin(), t.point.end());
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        mesh.bound = std::max(mesh.bound, boundaries_[f].strip_bound);
    }
}

}  // namespace freiform
