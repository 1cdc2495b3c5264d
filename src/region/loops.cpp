// Loops from the edges that bound a region.
//
// At a place where several loops meet every way to go on gives the same winding numbers, since those are sums
// over edges. The pretty one: on along the same arc, if the region lies on the same side of it; otherwise the
// way that turns around the least of the inside, so that regions that meet in a corner have a loop each.
// Neighbouring edges of one arc become one segment again, the whole arc if they are all of it.
#include "arrangement_detail.hpp"

#include <freiform/core/constants.hpp>

#include <cmath>

namespace freiform::detail {

namespace {

class LoopMaker {
public:
    LoopMaker(const Arrangement& a, std::span<const int> keep) : a_(a), keep_(keep) {}

    Result<Path> run() && {
        std::vector<std::vector<std::size_t>> in(a_.places.size()), out(a_.places.size());
        for (std::size_t e = 0; e < a_.edges.size(); ++e) {
            if (keep_[e] == 0) continue;
            in[std::size_t(end(e))].push_back(e), out[std::size_t(begin(e))].push_back(e);
        }
        next_.assign(a_.edges.size(), kNone);
        for (std::size_t p = 0; p < a_.places.size(); ++p)
            if (in[p].size() != out[p].size())
                return refuse(
                    RefusalKind::not_converged, place_text(a_.places[p]),
                    text(in[p].size(), " edges of the region end here and ", out[p].size(), " begin"));
            else
                link(in[p], out[p]);
        Path path;
        std::vector<bool> seen(a_.edges.size());
        for (std::size_t e = 0; e < a_.edges.size(); ++e) {
            if (keep_[e] == 0 || seen[e]) continue;
            std::vector<std::size_t> loop;
            for (std::size_t at = e; !seen[at]; at = next_[at]) loop.push_back(at), seen[at] = true;
            Subpath s = subpath(loop);
            const bool flat =
                s.segments.size() <= 2 &&
                std::ranges::all_of(s.segments, [](const PathSegment& x) { return x.degree == 1; });
            if (!flat) path.subpaths.push_back(std::move(s));
        }
        return path;
    }

private:
    static constexpr std::size_t kNone = std::size_t(-1);

    int begin(std::size_t e) const { return keep_[e] > 0 ? a_.edges[e].from : a_.edges[e].to; }
    int end(std::size_t e) const { return keep_[e] > 0 ? a_.edges[e].to : a_.edges[e].from; }
    bool goes_on(std::size_t e, std::size_t f) const {
        const RegionEdge &x = a_.edges[e], &y = a_.edges[f];
        return x.arc == y.arc && keep_[e] == keep_[f] && y.number == x.number + std::size_t(keep_[e]);
    }
    // Away from the place that it begins at; against its run: from the place that it ends at.
    Vec<2> direction(std::size_t e, bool at_end) const {
        const RegionEdge& edge = a_.edges[e];
        const bool hi = (keep_[e] > 0) == at_end;
        const PathSegment& s = a_.arcs[edge.arc].s;
        Vec<2> d = tangent_of(s, hi ? edge.on.hi : edge.on.lo);
        if (max_abs(d) == 0) d = point_of(s, edge.on.hi) - point_of(s, edge.on.lo);
        return (hi ? -1.0 : 1.0) * d;
    }

    void link(std::vector<std::size_t>& in, std::vector<std::size_t>& out) {
        std::erase_if(in, [&](std::size_t e) {
            const auto f = std::ranges::find_if(out, [&](std::size_t o) { return goes_on(e, o); });
            if (f == out.end()) return false;
            next_[e] = *f;
            out.erase(f);
            return true;
        });
        for (const std::size_t e : in) {
            const Vec<2> back = direction(e, true);
            const auto turn = [&](std::size_t f) {  // clockwise from where we come from, over the inside
                const Vec<2> d = direction(f, false);
                const double angle = -std::atan2(cross(back, d), dot(back, d));
                return angle <= 0 ? angle + kTwoPi : angle;
            };
            const auto f = std::ranges::min_element(out, {}, turn);
            next_[e] = *f;
            out.erase(f);
        }
    }

    Subpath subpath(std::vector<std::size_t> loop) const {
        std::size_t start = 0;
        while (start < loop.size() && goes_on(loop[(start + loop.size() - 1) % loop.size()], loop[start]))
            ++start;
        std::ranges::rotate(loop, loop.begin() + std::ptrdiff_t(start % loop.size()));
        Subpath out;
        out.closed = true;
        out.start = a_.places[std::size_t(begin(loop[0]))];
        for (std::size_t i = 0; i < loop.size();) {
            std::size_t j = i;
            while (j + 1 < loop.size() && goes_on(loop[j], loop[j + 1])) ++j;
            const RegionEdge &x = a_.edges[loop[i]], &y = a_.edges[loop[j]];
            PathSegment s = keep_[loop[i]] > 0 ? part_of(a_.arcs[x.arc].s, x.on.lo, y.on.hi)
                                               : part_of(a_.arcs[x.arc].s, x.on.hi, y.on.lo);
            s.points[0] = a_.places[std::size_t(begin(loop[i]))];
            s.points[std::size_t(s.degree)] = a_.places[std::size_t(end(loop[j]))];
            if (s.degree > 1 || s.front() != s.back()) out.segments.push_back(s);
            i = j + 1;
        }
        return out;
    }

    const Arrangement& a_;
    std::span<const int> keep_;
    std::vector<std::size_t> next_;
};

}  // namespace

Result<Path> loops_of(const Arrangement& arrangement, std::span<const int> keep) {
    return LoopMaker(arrangement, keep).run();
}

}  // namespace freiform::detail
