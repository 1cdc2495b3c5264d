// The order of the edges around faces of closed surfaces.
//
// A loop of a file says which edges follow each other, and where a vertex has one way in and one way out,
// that is all. Where two seams cross, or a hole ends at a seam, a loop comes to the same vertex several
// times, and any way on will do for the file: out along a seam and back the same way, say. Only one of them
// is the boundary that the parameters of the face have, with the two uses of a seam a period apart.
//
// Method: at a vertex the face is what is left of an edge that arrives, so the next edge of its boundary is
// the first one that leaves, turning clockwise from where the first came from; an edge that arrives and
// leaves again is the last. Directions are those of the parameters beside the vertex, whose order around it
// is that on the surface. Where the ways on do not make up loops, nothing is changed.
#include "step_loops.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform::step {

namespace {

constexpr double kSame = 1e-6;          // of the domain: nearer than this is the same place
constexpr double kBesideVertex = 1e-3;  // of an edge: where its direction at a vertex is seen
constexpr double kParallel = 1e-6;      // radians

constexpr std::size_t kMostWays = 64;  // out of one vertex

}  // namespace

bool LoopBuilder::is_way_back(const Use& a, const Use& b) const {
    if (a.coedge.edge != b.coedge.edge || a.coedge.reversed == b.coedge.reversed) return false;
    for (int k = 0; k < 2; ++k)
        if (std::abs(a.start[k] - b.end[k]) > kSame * chart_.whole()[std::size_t(k)].length()) return false;
    return true;
}

// Away from the vertex at the begin or the end of the use.
Vec<2> LoopBuilder::direction(const Use& u, bool at_end) const {
    const Interval on = model_.edges[std::size_t(u.coedge.edge)].range;
    const bool at_hi = at_end != u.coedge.reversed;
    const double t = at_hi ? on.hi - kBesideVertex * on.length() : on.lo + kBesideVertex * on.length();
    return jet<0>(u.coedge.curve, t).value() - jet<0>(u.coedge.curve, at_hi ? on.hi : on.lo).value();
}

// The loops that the same uses make when the boundary turns left at every vertex; empty where they make none.
std::vector<std::vector<Use>> LoopBuilder::in_order(const std::vector<Use>& uses) const {
    const std::size_t n = uses.size();
    std::vector<std::size_t> next(n, n);
    std::vector<char> taken(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t given = (i + 1) % n;
        std::size_t best = given;
        if (pole_at(uses[i].end, uses[i].end) == nullptr) {
            const Vec<2> back = direction(uses[i], true);
            double least = kInfinity;
            for (std::size_t k = 0, ways = 0; k < n; ++k) {
                if (uses[k].from != uses[i].to) continue;
                if (++ways > kMostWays) return {};
                const Vec<2> on = direction(uses[k], false);
                double turn = std::atan2(cross(on, back), dot(on, back));  // clockwise from `back`
                if (turn < kParallel) turn += kTwoPi;
                if (turn < least) least = turn, best = k;
            }
        }
        if (std::exchange(taken[best], 1) != 0) return {};
        next[i] = best;
    }
    std::vector<std::vector<Use>> loops;
    std::vector<char> done(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        if (done[i]) continue;
        loops.emplace_back();
        for (std::size_t k = i; !done[k]; k = next[k]) {
            done[k] = 1;
            loops.back().push_back(uses[k]);
        }
    }
    return loops;
}

}  // namespace freiform::step
