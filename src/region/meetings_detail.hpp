// Where arcs meet: as intervals of their parameters, with what belongs to one place united.
#pragma once
#include "arc_tree_detail.hpp"

#include <vector>

namespace freiform::detail {

// Places that are one after all: a forest of sets. What stands for a place is the least of the best points
// that are known of it: an end of an arc, the crossing of two lines, any other.
class Places {
public:
    int add(int rank, const Vec<2>& p) {
        parent_.push_back(int(parent_.size()));
        best_.push_back({rank, p});
        return parent_.back();
    }
    int find(int i) {
        while (parent_[std::size_t(i)] != i)
            i = parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
        return i;
    }
    void unite(int i, int j) {
        i = find(i), j = find(j);
        if (i == j) return;
        const Best &a = best_[std::size_t(i)], &b = best_[std::size_t(j)];
        if (std::pair(b.rank, b.point.c) < std::pair(a.rank, a.point.c)) best_[std::size_t(i)] = b;
        parent_[std::size_t(j)] = i;
    }
    const Vec<2>& point(int i) { return best_[std::size_t(find(i))].point; }
    std::size_t size() const { return parent_.size(); }

private:
    struct Best {
        int rank;
        Vec<2> point;
    };
    std::vector<int> parent_;
    std::vector<Best> best_;
};

// All of an arc over `at` belongs to the place.
struct Cut {
    Interval at;
    int place = 0;
};

// Arcs i and j are the same over these intervals, within `gap`.
struct SharedStretch {
    std::size_t i = 0, j = 0;
    Interval a, b;
    bool reversed = false;
    double gap = 0;
    bool equal = false;  // in their parameters too
};

struct Meetings {
    Places places;
    std::vector<std::vector<Cut>> cuts;  // of each arc, ends included
    std::vector<SharedStretch> shared;
};

// Between the cuts an arc meets no other arc and not itself, but for what it shares. `accuracy`: arcs that
// run along each other no farther apart may be called shared.
Result<Meetings> meetings_of(std::span<const RegionArc> arcs, const ArcTree& tree, double accuracy,
                             std::size_t max_pairs);

std::string place_text(const RegionArc& arc);  // "b.subpaths[0].segments[2]"
std::string place_text(const Vec<2>& p);       // "(1, 2)"

}  // namespace freiform::detail
