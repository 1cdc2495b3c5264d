// Boxes sorted into horizontal strips: which are beside a point, which overlap.
#pragma once
#include <freiform/core/interval.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace freiform::detail {

class Strips {
public:
    // Of boxes with finite sides. As many strips as boxes, fewer if many of them are high: at most some 16
    // entries for each box.
    explicit Strips(std::span<const Box<2>> boxes) {
        Box<2> all;
        double heights = 0;
        for (const Box<2>& b : boxes) all.add(b);
        if (boxes.empty()) return;
        lo_ = all.lo[1], height_ = all.hi[1] - all.lo[1];
        for (const Box<2>& b : boxes) heights += height_ > 0 ? (b.hi[1] - b.lo[1]) / height_ : 0;
        const double n = double(boxes.size());
        count_ = std::size_t(std::clamp(heights > 0 ? 14 * n / heights : n, 1.0, n));
        std::vector<std::size_t> first(count_ + 1, 0);
        for (const Box<2>& b : boxes)
            for (std::size_t s = of(b.lo[1]); s <= of(b.hi[1]); ++s) ++first[s + 1];
        for (std::size_t s = 0; s < count_; ++s) first[s + 1] += first[s];
        first_ = first;
        items_.resize(first.back());
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (std::size_t s = of(boxes[i].lo[1]); s <= of(boxes[i].hi[1]); ++s) items_[first[s]++] = i;
    }
    std::size_t size() const { return count_; }
    // The strip that y is in; monotone, so a box that contains y is in it.
    std::size_t of(double y) const {
        if (!(height_ > 0)) return 0;
        const double at = std::floor((y - lo_) / height_ * double(count_));
        return std::size_t(std::clamp(at, 0.0, double(count_ - 1)));
    }
    std::span<const std::size_t> items(std::size_t strip) const {
        if (count_ == 0) return {};
        return std::span(items_).subspan(first_[strip], first_[strip + 1] - first_[strip]);
    }

private:
    double lo_ = 0, height_ = 0;
    std::size_t count_ = 0;
    std::vector<std::size_t> first_, items_;
};

}  // namespace freiform::detail
