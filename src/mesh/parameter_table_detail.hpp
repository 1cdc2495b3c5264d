// Points of the parameter plane, numbered in the order in which they come: a table at most half full.
#pragma once
#include <freiform/core/vec.hpp>

#include <bit>
#include <cstdint>
#include <vector>

namespace freiform {

class ParameterTable {
public:
    explicit ParameterTable(std::size_t expected) { reserve(expected); }
    std::size_t size() const { return points_.size(); }
    // False if it has been there.
    bool add(const Vec<2>& p) {
        const std::size_t before = points_.size();
        return number(p) == int(before);
    }
    // Of the point, which is taken up if it has not been there.
    int number(const Vec<2>& p) {
        if (at_.size() < 2 * points_.size() + 2) reserve(2 * points_.size() + 2);
        int& there = at_[slot(p)];
        if (there < 0) {
            there = int(points_.size());
            points_.push_back(p);
        }
        return there;
    }
    // -1 if it has not been there.
    int find(const Vec<2>& p) const { return at_[slot(p)]; }
    const std::vector<Vec<2>>& points() const { return points_; }

private:
    // Of the point, or the free one where it belongs.
    std::size_t slot(const Vec<2>& p) const {
        // Coordinates with few digits differ in their upper bits alone: these are brought down each time.
        std::uint64_t h = 0;
        for (const double x : p.c) {
            h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;
            h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
            h ^= h >> 32;
        }
        const std::size_t mask = at_.size() - 1;
        std::size_t i = std::size_t(h) & mask;
        while (at_[i] >= 0 && points_[std::size_t(at_[i])] != p) i = (i + 1) & mask;
        return i;
    }
    void reserve(std::size_t expected) {
        at_.assign(std::bit_ceil(2 * expected + 2), -1);
        points_.reserve(expected);
        for (std::size_t i = 0; i < points_.size(); ++i) at_[slot(points_[i])] = int(i);
    }

    std::vector<int> at_;
    std::vector<Vec<2>> points_;
};

}  // namespace freiform
