// Closed intervals of the real line and axis-parallel boxes.
#pragma once
#include <freiform/core/vec.hpp>

#include <algorithm>
#include <limits>

namespace freiform {

struct Interval {
    double lo = 0, hi = 0;

    constexpr double length() const { return hi - lo; }
    constexpr double middle() const { return lo + (hi - lo) / 2; }
    constexpr bool contains(double t) const { return lo <= t && t <= hi; }
    constexpr bool overlaps(const Interval& o) const { return lo <= o.hi && o.lo <= hi; }
    friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

constexpr double clamped(double t, const Interval& on) { return t < on.lo ? on.lo : on.hi < t ? on.hi : t; }
constexpr Interval hull(const Interval& a, const Interval& b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

// The smallest axis-parallel box of what was added. Empty until something is.
template <int D>
struct Box {
    Vec<D> lo = filled(std::numeric_limits<double>::infinity());
    Vec<D> hi = filled(-std::numeric_limits<double>::infinity());

    static constexpr Vec<D> filled(double x) {
        Vec<D> v;
        for (int i = 0; i < D; ++i) v[i] = x;
        return v;
    }
    friend constexpr bool operator==(const Box&, const Box&) = default;
    constexpr bool is_empty() const { return lo[0] > hi[0]; }
    constexpr void add(const Vec<D>& p) {
        for (int i = 0; i < D; ++i) lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    }
    constexpr void add(const Box& b) {
        for (int i = 0; i < D; ++i) lo[i] = std::min(lo[i], b.lo[i]), hi[i] = std::max(hi[i], b.hi[i]);
    }
    constexpr Interval side(int i) const { return {lo[i], hi[i]}; }
    constexpr bool contains(const Vec<D>& p) const {
        for (int i = 0; i < D; ++i)
            if (!(lo[i] <= p[i] && p[i] <= hi[i])) return false;
        return true;
    }
    // What is in both.
    friend constexpr Box common(const Box& a, const Box& b) {
        Box out;
        for (int i = 0; i < D; ++i)
            out.lo[i] = std::max(a.lo[i], b.lo[i]), out.hi[i] = std::min(a.hi[i], b.hi[i]);
        return out;
    }
    // Largest absolute coordinate: the scale that rounding errors are measured by.
    constexpr double scale() const { return is_empty() ? 0 : std::max(max_abs(lo), max_abs(hi)); }
    double diagonal() const { return is_empty() ? 0 : norm(hi - lo); }
};

}  // namespace freiform
