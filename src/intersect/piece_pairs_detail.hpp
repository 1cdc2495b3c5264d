// All pairs of pieces whose boxes overlap, by hierarchies of boxes over neighbouring pieces.
#pragma once
#include "parts_detail.hpp"

namespace freiform::detail {

template <int D>
class BoxTree {
public:
    template <class PartsOf>
    void reset(const PartsOf& parts) {
        count_ = parts.pieces();
        leaves_ = 1;
        while (leaves_ < count_) leaves_ *= 2;
        box_.assign(std::size_t(2 * leaves_), {});
        for (int i = 0; i < count_; ++i) {
            Box<D>& b = box_[std::size_t(leaves_ + i)];
            b.lo = parts[i].lo, b.hi = parts[i].hi;
            for (int k = 0; k < D; ++k) b.lo[k] -= 1.01 * parts[i].error, b.hi[k] += 1.01 * parts[i].error;
        }
        for (int i = leaves_ - 1; i > 0; --i) {
            box_[std::size_t(i)].add(box_[std::size_t(2 * i)]);
            box_[std::size_t(i)].add(box_[std::size_t(2 * i + 1)]);
        }
    }
    // Calls f(i, j) for pieces i of this and j of the other, in increasing order of i, then j, within nodes.
    template <class F>
    void each_pair(const BoxTree& other, F&& f) const {
        std::vector<std::pair<int, int>> left{{1, 1}};
        while (!left.empty()) {
            const auto [i, j] = left.back();
            left.pop_back();
            const Box<D>&a = box_[std::size_t(i)], &b = other.box_[std::size_t(j)];
            bool apart = false;
            for (int k = 0; k < D; ++k) apart = apart || a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k];
            if (apart || a.is_empty() || b.is_empty()) continue;
            const bool leaf = i >= leaves_, other_leaf = j >= other.leaves_;
            if (leaf && other_leaf)
                f(i - leaves_, j - other.leaves_);
            else if (!leaf && (other_leaf || i <= j))
                left.push_back({2 * i + 1, j}), left.push_back({2 * i, j});
            else
                left.push_back({i, 2 * j + 1}), left.push_back({i, 2 * j});
        }
    }

private:
    int count_ = 0, leaves_ = 1;
    std::vector<Box<D>> box_;
};

}  // namespace freiform::detail
