// On which side of each edge the regions lie: winding numbers of points beside it, exactly.
//
// Idea. The winding number of a point that is a pair of doubles is known exactly (poly/arc_index.hpp). So for
// an edge two points p, q are taken, left and right of a point on it, such that the segment pq meets nothing
// but the edge and others of its bundle, which is proven by the control points. Then the winding numbers of p
// and q are those on both sides of the edge, provided that they differ by what crossing it once adds:
//     The points of pq that are not on the bundle lie in faces beside it. Edges do not meet in their inner
//     points, so these are the face on its left, that on its right, and the slits inside of the bundle. p and
//     q are farther from the edge than the bundle is wide, so they lie in the outer two; and if w(p) - w(q)
//     is the jump, which is not zero, p lies in the left one.
//
// Chains. Where a place has two edges with a jump, whoever goes along one of them and around the place comes
// to the same side of the other one. If the places at both ends were not connected, he would come back on the
// other side of the same edge, and it had no jump. So one edge of a chain answers for all; the longest is
// asked first.
//
// Cost. A pair of winding numbers for each chain, each a walk down the hierarchy of runs (arc_tree.cpp).
//
// Why not walk around the places, and sort what meets there by angle? Edges that touch need derivatives of
// any order, and what was drawn together has no angles.
#include "arrangement_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>

#include <cmath>
#include <optional>

namespace freiform::detail {

namespace {

// At the two ends of a bundle: index of the first edge, and whether it is the end.
struct End {
    std::size_t edge;
    bool at_to;
};

class SideFinder {
public:
    explicit SideFinder(const Arrangement& a) : a_(a), sides_(a.edges.size()), ends_(a.places.size()) {
        for (std::size_t e = 0; e < a.edges.size(); ++e) {
            if (!has_jump(e)) continue;
            ends_[std::size_t(a.edges[e].from)].push_back({e, false});
            ends_[std::size_t(a.edges[e].to)].push_back({e, true});
        }
    }

    Result<std::vector<EdgeSides>> run() && {
        std::vector<std::vector<Link>> chains;
        std::vector<bool> seen(a_.edges.size());
        for (std::size_t e = 0; e < a_.edges.size(); ++e)
            if (has_jump(e) && !seen[e]) chains.push_back(chain_of(e, seen));
        std::vector<std::optional<Refusal>> failed(chains.size());
        parallel_for(chains.size(), 4, [&](std::size_t i) { failed[i] = ask(chains[i]); });
        for (const auto& f : failed)
            if (f) return std::unexpected(*f);
        return std::move(sides_);
    }

private:
    // An edge of a chain, and whether it runs as the first one.
    struct Link {
        std::size_t edge;
        int sign;
    };

    bool has_jump(std::size_t e) const {
        return a_.edges[e].is_first(e) && a_.edges[e].jump != std::array<int, 2>{};
    }

    std::vector<Link> chain_of(std::size_t e, std::vector<bool>& seen) const {
        std::vector<Link> chain{{e, 1}};
        seen[e] = true;
        for (const bool forward : {true, false}) {
            Link at{e, 1};
            for (;;) {
                const bool leave_by_to = (at.sign > 0) == forward;
                const RegionEdge& edge = a_.edges[at.edge];
                const auto& ends = ends_[std::size_t(leave_by_to ? edge.to : edge.from)];
                if (ends.size() != 2) break;
                const End next = ends[0].edge == at.edge && ends[0].at_to == leave_by_to ? ends[1] : ends[0];
                if (seen[next.edge]) break;
                const int sign = (next.at_to != leave_by_to) ? at.sign : -at.sign;
                const auto &x = edge.jump, &y = a_.edges[next.edge].jump;
                if (at.sign * x[0] != sign * y[0] || at.sign * x[1] != sign * y[1]) break;
                seen[next.edge] = true;
                at = {next.edge, sign};
                chain.push_back(at);
            }
        }
        return chain;
    }

    Vec<2> on_edge(const RegionEdge& e, double t) const {
        return point_of(a_.arcs[e.arc].s, e.on.lo + t * e.on.length());
    }

    std::optional<Refusal> ask(const std::vector<Link>& chain) {
        std::vector<std::pair<double, Link>> order;
        for (const Link& l : chain) {
            const RegionEdge& e = a_.edges[l.edge];
            const Vec<2> middle = on_edge(e, 0.5);
            order.push_back({-std::max(norm(middle - on_edge(e, 0)), norm(middle - on_edge(e, 1))), l});
        }
        sort(order.begin(), order.end(), [](const auto& x, const auto& y) {
            return std::pair(x.first, x.second.edge) < std::pair(y.first, y.second.edge);
        });
        for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 8); ++k) {
            const Link& l = order[k].second;
            for (const double t : {0.5, 0.625, 0.375, 0.75, 0.25, 0.875, 0.125, 0.9375, 0.0625})
                if (const auto found = probe(l.edge, t, -order[k].first)) {
                    spread(chain, l, *found);
                    return {};
                }
        }
        const RegionEdge& e = a_.edges[order[0].second.edge];
        return Refusal{RefusalKind::ill_conditioned, place_text(a_.arcs[e.arc]),
                       text("and ", neighbour(order[0].second.edge), " are so near to each other near ",
                            place_text(on_edge(e, 0.5)), " that its sides are not told apart")};
    }

    // An arc that is in the way of the shortest probe.
    std::string neighbour(std::size_t index) const {
        const RegionEdge& e = a_.edges[index];
        const double at = e.on.middle(), d = std::max(2 * kTouchError * a_.scale, 4 * e.gap);
        const Vec<2> middle = point_of(a_.arcs[e.arc].s, at), along = unit(tangent_of(a_.arcs[e.arc].s, at));
        const Vec<2> left{{-along[1], along[0]}}, p = middle + d * left, q = middle - d * left;
        std::string name = "other segments";
        a_.tree.each_near(p, q, d, [&](std::size_t i) {
            if (i == e.arc || !may_touch(a_.arcs[i], {0, 1}, p, q, kTouchError * a_.scale)) return true;
            name = place_text(a_.arcs[i]);
            return false;
        });
        return name;
    }

    void spread(const std::vector<Link>& chain, const Link& from, const EdgeSides& found) {
        for (const Link& l : chain) {
            sides_[l.edge] = found;
            if (l.sign != from.sign) std::swap(sides_[l.edge].left, sides_[l.edge].right);
        }
    }

    std::optional<EdgeSides> probe(std::size_t index, double t, double size) const {
        const RegionEdge& e = a_.edges[index];
        const PathSegment& s = a_.arcs[e.arc].s;
        const double at = e.on.lo + t * e.on.length();
        const Vec<2> middle = point_of(s, at), along = unit(tangent_of(s, at));
        if (!(max_abs(along) > 0)) return {};
        const Vec<2> left{{-along[1], along[0]}};
        const double least = std::max(2 * kTouchError * a_.scale, 4 * e.gap);
        for (double d = size / 4; d > least; d = d > 64 * least ? d / 16 : d / 4) {
            const Vec<2> p = middle + d * left, q = middle - d * left;
            if (!is_clear(index, p, q)) continue;
            const auto wp = windings(p), wq = windings(q);
            if (!wp || !wq) continue;
            if ((*wp)[0] - (*wq)[0] != e.jump[0] || (*wp)[1] - (*wq)[1] != e.jump[1]) continue;
            return EdgeSides{true, *wp, *wq};
        }
        return {};
    }

    // Does pq meet nothing but this bundle, and are p and q apart from it?
    bool is_clear(std::size_t index, const Vec<2>& p, const Vec<2>& q) const {
        const double slack = kTouchError * a_.scale, reach = std::max(slack, 2 * a_.edges[index].gap);
        Box<2> box;
        box.add(p), box.add(q);
        const auto& members = a_.members[index];
        const auto crosses = [&](std::size_t i) {
            const RegionArc& arc = a_.arcs[i];
            if (arc.box.lo[0] > box.hi[0] + reach || arc.box.hi[0] < box.lo[0] - reach ||
                arc.box.lo[1] > box.hi[1] + reach || arc.box.hi[1] < box.lo[1] - reach)
                return false;
            double from = 0;  // of the arc, what is not the bundle's; members are in order
            for (const std::size_t m : members) {
                const RegionEdge& e = a_.edges[m];
                if (e.arc != i) continue;
                if (may_touch(arc, {from, e.on.lo}, p, q, slack)) return true;
                const double apart = std::max(slack, e.gap + a_.edges[index].gap);
                if (members.size() > 1 &&
                    (may_touch(arc, e.on, p, p, apart) || may_touch(arc, e.on, q, q, apart)))
                    return true;
                from = e.on.hi;
            }
            return may_touch(arc, {from, 1}, p, q, slack);
        };
        return a_.tree.each_near(p, q, reach, [&](std::size_t i) { return !crosses(i); });
    }

    // Of both operands; nothing on an arc.
    std::optional<std::array<int, 2>> windings(const Vec<2>& p) const {
        const auto quarters = a_.tree.quarters(a_.arcs, p);
        if (!quarters) return {};
        return {{(*quarters)[0] / 4, (*quarters)[1] / 4}};
    }

    const Arrangement& a_;
    std::vector<EdgeSides> sides_;
    std::vector<std::vector<End>> ends_;
};

}  // namespace

Result<std::vector<EdgeSides>> sides_of(const Arrangement& arrangement) {
    return SideFinder(arrangement).run();
}

}  // namespace freiform::detail
