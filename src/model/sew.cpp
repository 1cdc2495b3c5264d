// Joining the edges of loose faces.
//
// Idea. Two edges are joined because their curves are the same within the tolerance, never because their ends
// are near each other; vertices become one because edges do. So a tolerance that is far too large joins wrong
// pairs at worst where curves really run side by side, and does not collapse what is small.
//
// Method, in passes until nothing changes. (1) Open edges (one face) whose ends are near each other in pairs
// are candidates; the tree of all end points finds them. Each is matched (sew_match.cpp), in parallel. (2)
// The accepted pairs are joined, nearest first. A third edge may join a pair, which makes it non-manifold;
// two pairs stay two. (3) In the next pass every open edge is seen as the parts between the ends of others
// that lie along it; parts are candidates as edges are. Where parts are joined, the edges are cut.
//
// What is not joined although it is near enough. With d the distance between two ends that would become one
// vertex, and b the bound for the curves:
//   - edges of which 4 b or more is all their extent: they are points within what is known of them;
//   - ends at which any edge has an extent of at most 2 d: that edge could be what lies between the two ends
//     (a short edge along a long one, where the other face has one edge for both);
//   - ends that would make both ends of an edge one vertex, or vertices one that are not all within the
//     tolerance of the middle of their box. What becomes one is where the first was, or in that middle where
//     the first is too far from another.
// But an open edge no longer than such vertices may lie apart may be what a file has in their gap, where its
// other face has none. It becomes a point with them where the pair is far larger, and so do open edges of
// that size that are closed, in a loop that is far larger. And if the two are opposite sides of one face, the
// edges of its loop between them may become closed: the face is a full turn, and the two its seam. Such edges
// have to be four times as large as the tolerance, so strips that are narrower than it are not rolled up.
//
// Accuracy. The bounds of joined edges are proven; that no pair is missed is not: feet and places are
// samples. What is left is reported, so a miss is seen.
#include "sewer_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace freiform {

namespace {

constexpr int kPasses = 8;  // a backstop

}  // namespace

Sewer::Sewer(const Model& model, double tolerance) : tolerance_(tolerance), m_(model) {
    out_.tolerance = tolerance;
    for (const Face& f : m_.faces) queries_.push_back(std::make_unique<DerivativeQuery<2, 3>>(f.surface));
    vertex_of_.resize(m_.vertices.size());
    std::iota(vertex_of_.begin(), vertex_of_.end(), 0);
    before_ = m_.vertices;
}

void Sewer::refused(int edge, const Refusal& why, int rank) {
    const auto [it, fresh] = why_.try_emplace(edge, rank, why);
    if (!fresh && rank < it->second.first) it->second = {rank, why};
}

Box<3> Sewer::box_of(std::span<const int> chain) const {
    Box<3> box;
    for (const int v : chain) box.add(before_[std::size_t(v)].point);
    return box;
}

void Sewer::unite(int v, int w) {
    const int a = std::min(vertex(v), vertex(w)), b = std::max(vertex(v), vertex(w));
    if (a == b) return;
    const std::vector<int> others = chain_of(b);
    chain_.erase(b);
    auto& chain = chain_[a];
    chain.insert(chain.end(), others.begin(), others.end());
    // Where the first was, or in the middle where that is too far from another.
    Vec<3>& at = m_.vertices[std::size_t(a)].point;
    at = before_[std::size_t(a)].point;
    for (const int x : chain)
        if (!(norm(before_[std::size_t(x)].point - before_[std::size_t(a)].point) <= tolerance_))
            at = middle_of(box_of(chain_of(a)));
    vertex_of_[std::size_t(b)] = a;
    ++out_.vertices_joined;
}

// Joins the pair if nothing speaks against it. `stays_for`: how many were joined to a part, `given`: it was.
bool Sewer::join(std::vector<Part>& parts, std::vector<int>& stays_for, std::vector<char>& given, Pair p,
                 bool pairs_only, std::vector<std::pair<Pair, FollowedCurve>>& done) {
    const auto at = [](int i) { return std::size_t(i); };
    if (given[at(p.a)] || given[at(p.b)]) return false;
    const auto has_others = [&](int i) { return stays_for[at(i)] > 0 || is_group(parts[at(i)].edge); };
    if (pairs_only && (has_others(p.a) || has_others(p.b))) return false;
    if (has_others(p.b)) {
        if (has_others(p.a)) return false;
        std::swap(p.a, p.b);
        auto other_way = match(parts[at(p.a)].trace, parts[at(p.b)].trace, p.reversed, tolerance_);
        if (!other_way) return false;
        p.match = *std::move(other_way);
    }
    Part &a = parts[at(p.a)], &b = parts[at(p.b)];
    if (const auto why = obstacle(a, b, p)) {
        refused(a.edge, *why, 0), refused(b.edge, *why, 0);
        return false;
    }
    const Owner& o = owners_[at(b.edge)];
    const auto& curve = m_.faces[at(o.face)].loops[at(o.loop)].coedges[at(o.index)].curve;
    const EdgeGapOptions coarse{.target = tolerance_ / 8, .roundings = kFewRoundings};
    const double own = edge_gap(*queries_[at(o.face)], curve, *b.trace.curve, b.trace.on, coarse).bound;
    const double allowed = 1.25 * (p.match->bound + own) + tolerance_ / 16;
    auto follows = followed(*queries_[at(o.face)], curve, a.trace, *p.match, allowed);
    if (!follows) {
        refused(a.edge, follows.error(), 0), refused(b.edge, follows.error(), 0);
        return false;
    }
    // Ends that only a cut makes become vertices, of the part beside too.
    const auto make_vertex = [&](int i, std::size_t last) {
        Part& part = parts[at(i)];
        if (part.ends[last] >= 0) return;
        part.ends[last] = int(m_.vertices.size());
        m_.vertices.push_back({part.trace.end(last == 1), 0});
        before_.push_back(m_.vertices.back());
        vertex_of_.push_back(part.ends[last]);
        parts[last == 1 ? at(i) + 1 : at(i) - 1].ends[1 - last] = part.ends[last];
    };
    for (std::size_t last = 0; last < 2; ++last) make_vertex(p.a, last), make_vertex(p.b, last);
    for (std::size_t last = 0; last < 2; ++last) {
        unite(a.ends[last], b.ends[p.reversed ? 1 - last : last]);
    }
    ++stays_for[at(p.a)];
    given[at(p.b)] = 1;
    done.push_back({std::move(p), *std::move(follows)});
    return true;
}

// Cuts edges at the vertices that joined parts got; the edge of each such part.
void Sewer::cut_edges(const std::vector<Part>& parts, std::vector<int>& edge_of) {
    std::map<std::pair<int, int>, std::vector<std::pair<int, std::vector<int>>>> by_loop;
    for (std::size_t i = 0; i < parts.size();) {
        std::size_t end = i;
        std::vector<int> pieces{parts[i].edge};
        const Edge whole = m_.edges[std::size_t(parts[i].edge)];
        for (; end < parts.size() && parts[end].edge == parts[i].edge; ++end) {
            edge_of[end] = pieces.back();
            const bool last = end + 1 == parts.size() || parts[end + 1].edge != parts[i].edge;
            if (last || parts[end].ends[1] < 0) continue;
            Edge next = whole;
            next.start = parts[end].ends[1], next.range.lo = parts[end].trace.on.hi;
            Edge& before = m_.edges[std::size_t(pieces.back())];
            before.end = next.start, before.range.hi = next.range.lo;
            pieces.push_back(int(m_.edges.size()));
            if (const auto why = why_.find(parts[i].edge); why != why_.end())
                why_.insert_or_assign(pieces.back(), std::pair(why->second));
            m_.edges.push_back(std::move(next));
        }
        const Owner& o = owners_[std::size_t(parts[i].edge)];
        if (pieces.size() > 1) by_loop[{o.face, o.loop}].push_back({o.index, pieces});
        out_.split += int(pieces.size()) - 1;
        i = end;
    }
    for (auto& [loop, cuts] : by_loop) {
        auto& coedges = m_.faces[std::size_t(loop.first)].loops[std::size_t(loop.second)].coedges;
        sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
        for (auto& [index, pieces] : cuts) {
            const Coedge whole = coedges[std::size_t(index)];
            if (whole.reversed) std::reverse(pieces.begin(), pieces.end());
            coedges.erase(coedges.begin() + index);
            for (std::size_t k = 0; k < pieces.size(); ++k)
                coedges.insert(coedges.begin() + index + int(k), {pieces[k], whole.reversed, whole.curve});
        }
    }
}

bool Sewer::pass(bool cut) {
    owners_ = owners_of(m_);
    measure_extents();
    std::vector<Part> all = parts(cut);
    std::vector<Pair> pairs = candidates(all);
    std::vector<std::optional<Refusal>> misses(pairs.size());
    parallel_for(pairs.size(), 1, [&](std::size_t i) {
        auto m = match(all[std::size_t(pairs[i].a)].trace, all[std::size_t(pairs[i].b)].trace,
                       pairs[i].reversed, tolerance_);
        if (m)
            pairs[i].match = *std::move(m);
        else
            misses[i] = m.error();
    });
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (misses[i])
            for (const int p : {pairs[i].a, pairs[i].b})
                refused(all[std::size_t(p)].edge, *misses[i],
                        misses[i]->kind == RefusalKind::not_converged ? 1 : 2);
    std::erase_if(pairs, [](const Pair& p) { return !p.match; });
    sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
        return std::tie(x.match->bound, x.a, x.b, x.reversed) <
               std::tie(y.match->bound, y.a, y.b, y.reversed);
    });
    std::vector<int> stays_for(all.size());
    std::vector<char> given(all.size());
    std::vector<std::pair<Pair, FollowedCurve>> done;
    for (const bool pairs_only : {true, false})
        for (const Pair& p : pairs) join(all, stays_for, given, p, pairs_only, done);
    std::vector<int> edge_of(all.size());
    cut_edges(all, edge_of);
    for (auto& [p, follows] : done) {
        const int stays = edge_of[std::size_t(p.a)], other = edge_of[std::size_t(p.b)];
        given_[other] = {stays, p.reversed, p.match->bound, std::move(follows)};
        members_[stays].push_back(other);
        why_.erase(stays), why_.erase(other);
    }
    extent_.clear();
    return !done.empty();
}

// Puts what was found into the model, and leaves out what nothing uses any more.
void Sewer::rebuild() {
    for (Face& f : m_.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges)
                if (const auto it = given_.find(c.edge); it != given_.end()) {
                    c.edge = it->second.stays;
                    c.reversed = c.reversed != it->second.reversed;
                    c.curve = it->second.followed.curve;
                }
    for (const auto& [stays, others] : members_) {
        SewnEdge sewn{stays, {}, 0, 0};
        Edge& edge = m_.edges[std::size_t(stays)];
        for (const int e : others) {
            const Given& g = given_.at(e);
            sewn.bound = std::max(sewn.bound, g.bound);
            sewn.face_bound = std::max(sewn.face_bound, g.followed.bound);
            edge.tolerance = std::max(edge.tolerance, m_.edges[std::size_t(e)].tolerance);
        }
        edge.tolerance = std::max(edge.tolerance, sewn.face_bound);
        out_.joined.push_back(std::move(sewn));
    }
    for (const auto& [root, others] : chain_) {
        Vertex& kept = m_.vertices[std::size_t(root)];
        const std::vector<int> all = chain_of(root);
        for (const int v : all) {
            const Vertex& was = before_[std::size_t(v)];
            kept.tolerance = std::max(kept.tolerance, was.tolerance + norm(was.point - kept.point));
            for (const int w : all)
                out_.vertex_moved =
                    std::max(out_.vertex_moved, norm(was.point - before_[std::size_t(w)].point));
        }
    }
    for (const auto& [e, extent] : points_) {
        Edge& edge = m_.edges[std::size_t(e)];
        edge.degenerate = true, edge.curve.reset(), edge.end = edge.start;
        edge.tolerance = std::max(edge.tolerance, extent);
    }
    std::vector<int> edge_at(m_.edges.size(), -1), vertex_at(m_.vertices.size(), -1);
    std::vector<Edge> edges;
    std::map<int, std::pair<int, Refusal>> why;
    for (std::size_t e = 0; e < m_.edges.size(); ++e) {
        if (given_.contains(int(e))) continue;
        edge_at[e] = int(edges.size());
        if (const auto it = why_.find(int(e)); it != why_.end()) why.insert({edge_at[e], it->second});
        edges.push_back(std::move(m_.edges[e]));
    }
    std::vector<Vertex> vertices;
    for (std::size_t v = 0; v < m_.vertices.size(); ++v) {
        if (vertex(int(v)) != int(v)) continue;
        vertex_at[v] = int(vertices.size());
        vertices.push_back(m_.vertices[v]);
    }
    for (Edge& e : edges)
        for (int* v : {&e.start, &e.end}) *v = vertex_at[std::size_t(vertex(*v))];
    for (Face& f : m_.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge = edge_at[std::size_t(c.edge)];
    for (SewnEdge& s : out_.joined) s.edge = edge_at[std::size_t(s.edge)];
    if (!given_.empty())
        for (Approximation& a : m_.approximations) a.where = "before sewing, " + a.where;
    for (const auto& [e, extent] : points_)
        m_.approximations.push_back({text("edges[", edge_at[std::size_t(e)], "]"),
                                     text("has become a point: it is no larger than twice ", tolerance_),
                                     std::nullopt, extent});
    m_.edges = std::move(edges), m_.vertices = std::move(vertices), why_ = std::move(why);
    std::vector<std::vector<int>> faces(m_.edges.size());
    for (std::size_t f = 0; f < m_.faces.size(); ++f)
        for (const Loop& l : m_.faces[f].loops)
            for (const Coedge& c : l.coedges) faces[std::size_t(c.edge)].push_back(int(f));
    for (SewnEdge& s : out_.joined) s.faces = faces[std::size_t(s.edge)];
}

Sewing Sewer::run() {
    owners_ = owners_of(m_);
    for (std::size_t e = 0; e < m_.edges.size(); ++e)
        out_.open_before += owners_[e].uses == 1 && !m_.edges[e].degenerate;
    // Whole edges first, as long as there are some: a rim can be joined once the seam has closed it, and is
    // not to be cut where its start is a little beside that of its twin.
    for (int i = 0; i < kPasses && pass(false); ++i) {
    }
    for (int i = 1; i < kPasses && pass(true); ++i) {
    }
    find_points();
    rebuild();
    orient(m_, out_.joined, out_.flipped, out_.twisted);
    unite_shells(m_, out_.joined);
    out_.remaining = remaining_gaps(m_, tolerance_);
    for (RemainingGap& g : out_.remaining)
        if (const auto it = why_.find(g.edge); it != why_.end()) g.reason = it->second.second;
    out_.openings = openings_of(m_, out_.remaining);
    out_.model = std::move(m_);
    return std::move(out_);
}

double largest_tolerance(const Model& model) {
    double most = 0;
    for (const Vertex& v : model.vertices) most = std::max(most, v.tolerance);
    for (const Edge& e : model.edges) most = std::max(most, e.tolerance);
    for (const Face& f : model.faces) most = std::max(most, f.tolerance);
    return most;
}

Result<Sewing> sew(const Model& model, const SewOptions& options) {
    if (!std::isfinite(options.tolerance))
        return refuse(RefusalKind::nonfinite, "tolerance",
                      text(options.tolerance, " is not a finite number"));
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not positive"));
    Model with_curves = model;
    give_images(with_curves, options.tolerance);
    return Sewer(with_curves, options.tolerance).run();
}

}  // namespace freiform
