// The least distance between two sets of parts: branch and bound over pairs, the nearest first.
//
// A side is a tree of parts: `count_of` points whose hull, with `slack` around, contains the part, and
// children that cover it. For any n of length 1 two hulls are at least min n . x - max n . y apart: with n
// the direction between the nearest points the error falls with the square of the parts' size.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace freiform::detail {

// A part, as its side keeps it.
template <int D>
struct PairPart {
    Box<D> box;               // of the hull
    double slack = 0;         // bound: how far the part may leave the hull
    int first = -1, end = 0;  // children; none yet: -1
};

template <int D>
double box_gap(const PairPart<D>& a, const PairPart<D>& b) {
    double s = 0;
    for (int k = 0; k < D; ++k) {
        const double x = std::max({a.box.lo[k] - b.box.hi[k], b.box.lo[k] - a.box.hi[k], 0.0});
        s += x * x;
    }
    return std::sqrt(s) * (1 - 8 * kUnitRoundoff);
}
// How far apart places of the part may be: what nothing is known of is the largest.
template <int D>
double extent(const PairPart<D>& a) {
    return a.box.diagonal() + a.slack;
}
// `A`, `B`: parts(), hull(i), split(i): makes the children, false where there can be none.
// `look`(a, b): the points x, y of the two parts that are thought to be nearest, after they were compared
// with the best; returns their difference. `best`: the least distance so far.
template <int D, class A, class B, class Look>
double least_of_pairs(A& a, B& b, double accuracy, double rounding, int max_pairs, const double& best,
                      Look&& look) {
    struct Item {
        double lower;
        int a, b;
        long order;
    };
    std::vector<Item> heap;
    long made = 0;
    const auto after = [](const Item& x, const Item& y) {
        return x.lower != y.lower ? x.lower > y.lower : x.order > y.order;
    };
    const auto push = [&](int i, int k, const Vec<D>& direction, double lower) {
        const PairPart<D>&x = a.parts()[std::size_t(i)], &y = b.parts()[std::size_t(k)];
        double apart = box_gap(x, y);
        const auto along = [&](const Vec<D>& d) {
            const double length = norm(d);
            if (!(length > 0) || !std::isfinite(length)) return;
            const Vec<D> n = (1 / length) * d;
            double least = std::numeric_limits<double>::infinity(), most = -least;
            for (const Vec<D>& p : a.hull(i)) least = std::min(least, dot(n, p));
            for (const Vec<D>& p : b.hull(k)) most = std::max(most, dot(n, p));
            apart = std::max(apart, least - most);
        };
        along(direction);
        along((x.box.lo - y.box.lo) + (x.box.hi - y.box.hi));
        lower = std::max({lower, apart - x.slack - y.slack - rounding, 0.0});
        if (std::isnan(lower)) lower = 0;
        heap.push_back({lower, i, k, made++});
        std::ranges::push_heap(heap, after);
    };
    push(0, 0, Vec<D>{}, 0);
    while (!heap.empty()) {
        std::ranges::pop_heap(heap, after);
        const Item item = heap.back();
        heap.pop_back();
        if (item.lower >= best - accuracy || max_pairs-- <= 0) return item.lower;
        const Vec<D> direction = look(item.a, item.b);
        const bool larger = extent(a.parts()[std::size_t(item.a)]) >= extent(b.parts()[std::size_t(item.b)]);
        const bool first = larger ? a.split(item.a) : !b.split(item.b) && a.split(item.a);
        if (!first && !b.split(item.b)) return item.lower;
        const PairPart<D> opened = first ? a.parts()[std::size_t(item.a)] : b.parts()[std::size_t(item.b)];
        for (int k = opened.first; k < opened.end; ++k)
            push(first ? k : item.a, first ? item.b : k, direction, item.lower);
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace freiform::detail
