// Where a sewn model is still open.
//
// Method: open edges that follow each other from vertex to vertex, two at each, are the rim of an opening;
// what forks or ends is none. Cost: linear but for the sets.
#include "sew_detail.hpp"

#include <map>

namespace freiform {

std::vector<Opening> openings_of(const Model& model, std::vector<RemainingGap>& gaps) {
    std::map<int, std::vector<std::size_t>> at;  // by vertex: the gaps that end there, closed ones twice
    const auto ends = [&](std::size_t i) {
        const Edge& e = model.edges[std::size_t(gaps[i].edge)];
        return std::array{e.start, e.end};
    };
    for (std::size_t i = 0; i < gaps.size(); ++i)
        for (const int v : ends(i)) at[v].push_back(i);
    std::vector<Opening> all;
    std::vector<char> seen(gaps.size());
    for (std::size_t first = 0; first < gaps.size(); ++first) {
        if (seen[first]) continue;
        Opening rim;
        bool closes = true;
        std::size_t i = first;
        for (int v = ends(first)[1];;) {
            seen[i] = 1;
            rim.edges.push_back(gaps[i].edge);
            rim.box.add(gaps[i].box.lo), rim.box.add(gaps[i].box.hi);
            const auto& there = at[v];
            closes = there.size() == 2;
            if (!closes) break;
            i = there[there[0] == i ? 1 : 0];
            if (seen[i]) break;
            v = ends(i)[ends(i)[0] == v ? 1 : 0];
        }
        if (!closes || i != first) continue;
        for (RemainingGap& g : gaps)
            if (std::find(rim.edges.begin(), rim.edges.end(), g.edge) != rim.edges.end())
                g.opening = int(all.size());
        all.push_back(std::move(rim));
    }
    return all;
}

}  // namespace freiform
