// What a pass of sewing looks at, and what speaks against a join: essay in sew.cpp.
#include "sewer_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kExtents = 4;   // of an edge, in bounds of its join
constexpr double kShortest = 2;  // extent of an edge, in distances that its ends move

}  // namespace

std::vector<Owner> owners_of(const Model& m) {
    std::vector<Owner> owners(m.edges.size());
    for (std::size_t f = 0; f < m.faces.size(); ++f)
        for (std::size_t l = 0; l < m.faces[f].loops.size(); ++l)
            for (std::size_t c = 0; c < m.faces[f].loops[l].coedges.size(); ++c) {
                Owner& o = owners[std::size_t(m.faces[f].loops[l].coedges[c].edge)];
                o = {int(f), int(l), int(c), o.uses + 1};
            }
    return owners;
}

void Sewer::measure_extents() {
    extent_.resize(m_.edges.size(), -1);
    edges_at_.clear();
    for (std::size_t e = 0; e < m_.edges.size(); ++e) {
        const Edge& edge = m_.edges[e];
        if (edge.degenerate || owners_[e].uses == 0) continue;
        edges_at_[edge.start].push_back(int(e));
        edges_at_[edge.end].push_back(int(e));
        if (extent_[e] >= 0) continue;
        if (edge.curve) {
            extent_[e] = trace_of(*edge.curve, edge.range).extent;
            continue;
        }
        const Owner& o = owners_[e];
        const Face& f = m_.faces[std::size_t(o.face)];
        const auto& curve = f.loops[std::size_t(o.loop)].coedges[std::size_t(o.index)].curve;
        const auto at = [&](double t) { return jet<0>(f.surface, jet<0>(curve, t).value().c).value(); };
        for (int k = 0; k <= 16; ++k)
            extent_[e] = std::max(extent_[e],
                                  norm(at(edge.range.lo + edge.range.length() * k / 16) - at(edge.range.lo)));
    }
}

// Where ends of others lie along the edge, clear of its own ends; ends that belong together count once.
// Within the tolerance of its own ends only those of edges that may lie between: others may become one vertex
// with them, and the part between would be a loop.
std::vector<double> Sewer::cuts_along(const EdgeTrace& trace, const PointTree& tree,
                                      std::span<const int> ends) const {
    std::vector<int> near;
    for (std::size_t k = 0; k + 1 < trace.at.size(); ++k) {
        Box<3> box;
        box.add(trace.at[k]);
        box.add(trace.at[k + 1]);
        const double wide = tolerance_ + norm(trace.at[k + 1] - trace.at[k]) / 4;
        for (int d = 0; d < 3; ++d) box.lo[d] -= wide, box.hi[d] += wide;
        const auto found = tree.in(box);
        near.insert(near.end(), found.begin(), found.end());
    }
    sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<EdgeFoot> feet;
    for (const int i : near) {
        const int v = ends[std::size_t(i)];
        const EdgeFoot foot = foot_on(trace, m_.vertices[std::size_t(v)].point);
        const double room = std::min(norm(foot.point - trace.end(false)), norm(foot.point - trace.end(true)));
        const auto may_lie_between = [&](int e) { return extent_[std::size_t(e)] <= kShortest * room; };
        if (foot.distance <= tolerance_ &&
            room > std::max(kExtents * foot.distance, 0x1p-40 * trace.extent) &&
            (room > tolerance_ || std::ranges::any_of(edges_at_.at(v), may_lie_between)))
            feet.push_back(foot);
    }
    sort(feet.begin(), feet.end(), [](const EdgeFoot& x, const EdgeFoot& y) { return x.t < y.t; });
    std::vector<EdgeFoot> apart;
    for (const EdgeFoot& f : feet)
        if (apart.empty() ||
            norm(f.point - apart.back().point) >
                std::max(kExtents * std::max(f.distance, apart.back().distance), 0x1p-40 * trace.extent))
            apart.push_back(f);
        else if (f.distance < apart.back().distance)
            apart.back() = f;
    std::vector<double> t;
    for (const EdgeFoot& f : apart) t.push_back(f.t);
    return t;
}

std::vector<Part> Sewer::parts(bool cut) const {
    std::vector<Part> whole;
    for (std::size_t e = 0; e < m_.edges.size(); ++e)
        if (is_open(e)) {
            const Edge& edge = m_.edges[e];
            whole.push_back({int(e), trace_of(*edge.curve, edge.range), {edge.start, edge.end}});
        }
    if (!cut) return whole;
    std::vector<int> ends;
    for (const Part& p : whole)
        if (!is_group(p.edge)) ends.insert(ends.end(), p.ends.begin(), p.ends.end());
    sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Vec<3>> at;
    for (const int v : ends) at.push_back(m_.vertices[std::size_t(v)].point);
    const PointTree tree(std::move(at));
    std::vector<std::vector<Part>> cuts(whole.size());
    parallel_for(whole.size(), 4, [&](std::size_t i) {
        const Part& p = whole[i];
        const EdgeTrace& trace = p.trace;
        const std::vector<double> t =
            is_group(p.edge) ? std::vector<double>{} : cuts_along(trace, tree, ends);
        for (std::size_t k = 0; k <= t.size(); ++k)
            cuts[i].push_back({p.edge,
                               trace_of(*trace.curve, {k == 0 ? trace.on.lo : t[k - 1],
                                                       k == t.size() ? trace.on.hi : t[k]}),
                               {k == 0 ? p.ends[0] : -1, k == t.size() ? p.ends[1] : -1}});
    });
    std::vector<Part> all;
    for (auto& list : cuts)
        for (Part& p : list) all.push_back(std::move(p));
    return all;
}

std::vector<Pair> Sewer::candidates(const std::vector<Part>& parts) const {
    std::vector<Vec<3>> starts;
    for (const Part& p : parts)
        for (const bool last : {false, true}) starts.push_back(p.trace.end(last));
    const PointTree tree(starts);
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < parts.size(); ++a) {
        Box<3> box;
        box.add(parts[a].trace.end(false));
        for (int d = 0; d < 3; ++d) box.lo[d] -= tolerance_, box.hi[d] += tolerance_;
        for (const int end : tree.in(box)) {
            const int b = end / 2;
            const bool reversed = end % 2 == 1;
            if (b == int(a) || parts[a].edge == parts[std::size_t(b)].edge) continue;
            const bool groups[2] = {is_group(parts[a].edge), is_group(parts[std::size_t(b)].edge)};
            if (groups[0] && groups[1]) continue;
            const bool stays = groups[0] || (!groups[1] && int(a) < b);
            if (!stays) continue;  // found from the other side
            if (norm(parts[a].trace.end(true) - parts[std::size_t(b)].trace.end(!reversed)) <= tolerance_)
                pairs.push_back({int(a), b, reversed, {}});
        }
    }
    return pairs;
}

// Are the two sides of one face that its loop runs through in opposite directions, the face closed by them?
bool Sewer::is_seam(const Part& a, const Part& b, const Pair& p) const {
    const Owner &x = owners_[std::size_t(a.edge)], &y = owners_[std::size_t(b.edge)];
    if (x.uses != 1 || y.uses != 1 || x.face != y.face || x.loop != y.loop) return false;
    const auto& coedges = m_.faces[std::size_t(x.face)].loops[std::size_t(x.loop)].coedges;
    return coedges[std::size_t(x.index)].reversed == (coedges[std::size_t(y.index)].reversed == p.reversed);
}

// May joining the sides of a face make both ends of the edge one? A rim of that face, far larger than the
// tolerance.
bool Sewer::may_close(int edge, const Part& side) const {
    const Owner& o = owners_[std::size_t(side.edge)];
    const auto stays = [&](int e) {
        for (auto it = given_.find(e); it != given_.end(); it = given_.find(e)) e = it->second.stays;
        return e;
    };
    const auto& coedges = m_.faces[std::size_t(o.face)].loops[std::size_t(o.loop)].coedges;
    return extent_[std::size_t(edge)] > kExtents * tolerance_ &&
           std::any_of(coedges.begin(), coedges.end(),
                       [&](const Coedge& c) { return stays(c.edge) == stays(edge); });
}

// Is it no longer than vertices may lie apart that become one, and used by one face alone?
bool Sewer::may_vanish(int e) const {
    return is_open(std::size_t(e)) && !is_group(e) && extent_[std::size_t(e)] <= 2 * tolerance_;
}

// Edges that are still open and have become points, in loops that are far larger.
void Sewer::find_points() {
    owners_ = owners_of(m_);
    measure_extents();
    for (std::size_t e = 0; e < m_.edges.size(); ++e) {
        const Edge& edge = m_.edges[e];
        if (owners_[e].uses != 1 || edge.degenerate || vertex(edge.start) != vertex(edge.end) ||
            !may_vanish(int(e)))
            continue;
        // A loop of its own stays: without it there would be no hole.
        const Owner& o = owners_[e];
        double largest = 0;
        for (const Coedge& c : m_.faces[std::size_t(o.face)].loops[std::size_t(o.loop)].coedges)
            largest = std::max(largest, extent_[std::size_t(c.edge)]);
        if (largest > kExtents * tolerance_) points_.push_back({int(e), extent_[e]});
    }
}

// The vertices that are one with v by now, the one that stays first; -1 alone where a cut ends.
std::vector<int> Sewer::chain_of(int v) const {
    if (v < 0) return {-1};
    std::vector<int> all{vertex(v)};
    if (const auto chain = chain_.find(all[0]); chain != chain_.end())
        all.insert(all.end(), chain->second.begin(), chain->second.end());
    return all;
}

// Why the pair may not be joined although it is near enough.
std::optional<Refusal> Sewer::obstacle(const Part& a, const Part& b, const Pair& p) const {
    const double bound = p.match->bound;
    if (!(std::min(a.trace.extent, b.trace.extent) > kExtents * bound))
        return Refusal{
            RefusalKind::ill_conditioned, text("edges[", b.edge, "]"),
            text("is ", b.trace.extent, " large, too short to be told from a point within ", bound)};
    std::map<int, int> becomes;  // what both unions together do
    for (const bool last : {false, true}) {
        const Vec<3>&at = a.trace.end(last), &of = b.trace.end(p.reversed != last);
        // Vertices that would be one. An edge may end a little beside its vertex, which is not what counts.
        const std::array<std::vector<int>, 2> chains{chain_of(a.ends[last]),
                                                     chain_of(b.ends[p.reversed != last])};
        const auto point = [&](std::size_t k, int y) {
            return y >= 0 ? before_[std::size_t(y)].point : k == 0 ? at : of;
        };
        Box<3> box;
        for (std::size_t k = 0; k < 2; ++k)
            for (const int y : chains[k]) box.add(point(k, y));
        for (std::size_t k = 0; k < 2; ++k)
            for (const int y : chains[k]) {
                if (!(norm(point(k, y) - middle_of(box)) <= tolerance_))
                    return Refusal{
                        RefusalKind::ill_conditioned, text("edges[", (k == 0 ? a : b).edge, "]"),
                        text("would end in a vertex whose middle is farther away than ", tolerance_)};
                if (y < 0) continue;
                becomes[vertex(y)] = last ? 1 : 0;
                const auto edges = edges_at_.find(y);
                if (edges == edges_at_.end()) continue;
                for (const int e : edges->second)
                    if (careful_ && !(extent_[std::size_t(e)] > kShortest * norm(at - of)))
                        return Refusal{RefusalKind::ill_conditioned, text("edges[", e, "]"),
                                       text("is ", extent_[std::size_t(e)],
                                            " large and may lie between two ends ", norm(at - of), " apart")};
            }
    }
    // Ends of one edge that are different vertices stay different, but for rims that a seam closes.
    const bool seam = is_seam(a, b, p);
    const auto is_closed = [&](const Part& x) {
        return x.ends[0] >= 0 && x.ends[1] >= 0 && vertex(x.ends[0]) == vertex(x.ends[1]);
    };
    const bool closes = is_closed(a) || is_closed(b);
    const bool are_large = std::min(a.trace.extent, b.trace.extent) > kExtents * tolerance_;
    const auto name = [&](int v) {
        const int root = vertex(v);
        const auto it = becomes.find(root);
        return it == becomes.end() ? root : closes ? -1 : -1 - it->second;
    };
    for (const auto& [root, which] : becomes) {
        for (const int y : chain_of(root)) {
            const auto edges = edges_at_.find(y);
            if (edges == edges_at_.end()) continue;
            for (const int e : edges->second) {
                const Edge& edge = m_.edges[std::size_t(e)];
                if (vertex(edge.start) != vertex(edge.end) && name(edge.start) == name(edge.end) &&
                    !(seam && may_close(e, a)) && !(are_large && may_vanish(e)))
                    return Refusal{RefusalKind::ill_conditioned, text("edges[", e, "]"),
                                   "both its ends would become one vertex"};
            }
        }
    }
    return {};
}

}  // namespace freiform
