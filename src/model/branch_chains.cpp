// Branches of models, joined over the edges of faces.
//
// Idea. Two branches that end at one place, on an edge that both faces have or at a corner, are one curve.
// Ends are off by what their branches are off, divided by the sine of the angle at which they meet the loop,
// so there is no proof that two belong together; where more than two are as near, nothing is joined.
//
// Method. Ends at loops, sorted along x; each with those within reach. Pairs that have each other and none
// else are joined, and followed from branches that have a free end, then around.
#include "branch_chains_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kReach = 64;  // tolerances

struct FreeEnd {
    Vec<3> point{};
    double reach = 0;
    int partner = -1;
};

Vec<3> end_point(const FaceBranch& b, std::size_t e) {
    const Interval on = b.curve.domain()[0];
    return b.curve(e == 0 ? on.lo : on.hi);
}

}  // namespace

std::vector<BranchChain> chains_of(const std::vector<FaceBranch>& branches,
                                   const std::array<const Model*, 2>& models, double tolerance) {
    // End e of branch i is number 2 i + e.
    std::vector<FreeEnd> ends(2 * branches.size());
    std::vector<int> order;
    for (std::size_t n = 0; n < ends.size(); ++n) {
        const FaceBranch& b = branches[n / 2];
        if (b.closed || b.ends[n % 2] != kAtTrim) continue;
        const TrimPlace& at = b.trims[n % 2];
        ends[n].point = end_point(b, n % 2);
        ends[n].reach = kReach / 2 * tolerance;
        if (at.edge >= 0)
            ends[n].reach += models[std::size_t(at.side)]->edges[std::size_t(at.edge)].tolerance;
        order.push_back(int(n));
    }
    const auto at = [&](int n) -> FreeEnd& { return ends[std::size_t(n)]; };
    sort(order, {}, [&](int n) { return at(n).point[0]; });
    double widest = 0;
    for (const int n : order) widest = std::max(widest, at(n).reach);
    std::vector<int> near(ends.size(), 0), last(ends.size(), -1);
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const int p = order[i], q = order[j];
            if (at(q).point[0] - at(p).point[0] > 2 * widest) break;
            if (!(norm(at(p).point - at(q).point) <= at(p).reach + at(q).reach)) continue;
            for (const auto& [x, y] : {std::pair(p, q), {q, p}})
                ++near[std::size_t(x)], last[std::size_t(x)] = y;
        }
    for (const int n : order)
        if (const int other = last[std::size_t(n)];
            near[std::size_t(n)] == 1 && near[std::size_t(other)] == 1)
            at(n).partner = other;

    std::vector<BranchChain> out;
    std::vector<char> used(branches.size(), 0);
    const auto follow = [&](int entry) {  // the end that it is entered by
        BranchChain chain;
        const int first = entry;
        while (!used[std::size_t(entry / 2)]) {
            used[std::size_t(entry / 2)] = 1;
            chain.links.push_back({entry / 2, entry % 2 == 1});
            const int exit = entry ^ 1, next = at(exit).partner;
            if (next < 0) break;
            chain.gap = std::max(chain.gap, norm(at(exit).point - at(next).point) * (1 + 0x1p-40));
            chain.closed = next == first;
            entry = next;
        }
        if (branches[std::size_t(first / 2)].closed) chain.closed = true;
        out.push_back(std::move(chain));
    };
    for (int n = 0; n < int(ends.size()); ++n)
        if (at(n).partner < 0 && !used[std::size_t(n / 2)]) follow(n);
    for (int n = 0; n < int(ends.size()); n += 2)
        if (!used[std::size_t(n / 2)]) follow(n);
    return out;
}

}  // namespace freiform
