// Of polygons that share sides, those sides that one of them has alone.
#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace freiform {

class OuterSides {
public:
    // `expected`: sides, about.
    OuterSides(std::size_t points, std::size_t expected) : first_(points, -1) { sides_.reserve(expected); }

    // A closed polygon, by numbers of its points.
    void add(std::span<const int> border) { count(border, 1); }
    // One that has been added.
    void remove(std::span<const int> border) { count(border, -1); }
    // In the order in which they came.
    template <class Visit>
    void each(Visit&& visit) const {
        for (const Side& s : sides_)
            if (s.polygons == 1) visit(s.lo, s.hi);
    }

private:
    struct Side {
        int lo, hi;  // ends, the smaller first
        int next;    // with the same smaller one
        int polygons = 0;
    };
    void count(std::span<const int> border, int by) {
        for (std::size_t k = 0; k < border.size(); ++k) {
            const auto [lo, hi] = std::minmax(border[k], border[k + 1 < border.size() ? k + 1 : 0]);
            int at = first_[std::size_t(lo)];
            while (at >= 0 && sides_[std::size_t(at)].hi != hi) at = sides_[std::size_t(at)].next;
            if (at < 0) {
                at = int(sides_.size());
                sides_.push_back({lo, hi, std::exchange(first_[std::size_t(lo)], at)});
            }
            sides_[std::size_t(at)].polygons += by;
        }
    }
    std::vector<Side> sides_;
    std::vector<int> first_;  // by smaller end, the last
};

}  // namespace freiform
