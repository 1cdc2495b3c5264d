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
        const std::uint64_t h = hash(p);
        int& there = at_[slot(p, h)];
        if (there < 0) {
            there = int(points_.size());
            note(h);
            points_.push_back(p);
        }
        return there;
    }
    // -1 if it has not been there.
    int find(const Vec<2>& p) const {
        const std::uint64_t h = hash(p);
        return may_be_there(h) ? at_[slot(p, h)] : -1;
    }
    const std::vector<Vec<2>>& points() const { return points_; }

private:
    // Coordinates with few digits differ in their upper bits alone: these are brought down each time.
    static std::uint64_t hash(const Vec<2>& p) {
        const auto mixed = [](double x, std::uint64_t by) {
            const auto bits = std::bit_cast<std::uint64_t>(x + 0.0);
            const std::uint64_t h = (bits ^ bits >> 32) * by;
            return h ^ h >> 32;
        };
        const std::uint64_t h =
            (mixed(p[0], 0x9e3779b97f4a7c15u) + std::rotl(mixed(p[1], 0xd6e8feb86659fd93u), 24)) *
            0xd6e8feb86659fd93u;
        return h ^ h >> 32;
    }
    // One bit for each of some kinds of points: most points that are not there are told from a small table.
    bool may_be_there(std::uint64_t h) const { return bits_[bit(h) / 64] >> bit(h) % 64 & 1; }
    void note(std::uint64_t h) { bits_[bit(h) / 64] |= std::uint64_t(1) << bit(h) % 64; }
    std::size_t bit(std::uint64_t h) const { return std::size_t(h >> 24) & (64 * bits_.size() - 1); }
    // Of the point, or the free one where it belongs.
    std::size_t slot(const Vec<2>& p, std::uint64_t h) const {
        const std::size_t mask = at_.size() - 1;
        std::size_t i = std::size_t(h) & mask;
        while (at_[i] >= 0 && points_[std::size_t(at_[i])] != p) i = (i + 1) & mask;
        return i;
    }
    void reserve(std::size_t expected) {
        at_.assign(std::bit_ceil(2 * expected + 2), -1);
        bits_.assign((at_.size() + 15) / 16, 0);
        points_.reserve(expected);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const std::uint64_t h = hash(points_[i]);
            at_[slot(points_[i], h)] = int(i);
            note(h);
        }
    }

    std::vector<int> at_;
    std::vector<std::uint64_t> bits_;
    std::vector<Vec<2>> points_;
};

}  // namespace freiform
