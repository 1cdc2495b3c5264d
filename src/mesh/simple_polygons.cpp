// Idea: nearly all boundaries of faces are fine, which takes far less to see than a triangulation.
//
// Method. Segments are projected onto a slanted line, where those of a rectangle do not fall on each other,
// and sorted by the beginnings of their intervals; only pairs with common parts there, and with boxes that
// meet, are looked at. Two segments without a common point have the ends of one strictly on one side of the
// line through the other, unless they are on one line, which is left to others; two that share an end turn
// there or go on straight.
//
// Cost: O(n log n + pairs); with kMostPairs for each segment it is given up. Accuracy: sides are exact
// (poly/predicates). Projections are sums of two products of numbers in [0, 1], so they are off by less than
// kSlack, by which intervals are longer.
//
// References: [Shewchuk 1997] for signs, [Preparata Shamos 1985] for sweeps. Why not a sweep that knows its
// neighbours: it saves pairs that cost less than its tree.
#include "simple_polygons_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kSlant = 0.618, kSlack = 0x1p-45;
constexpr std::size_t kMostPairs = 64, kFewPairs = 1000;

using Ends = Triangulation::Segment;

bool are_apart(std::span<const Vec<2>> points, const Ends& s, const Ends& t) {
    const auto at = [&](int i) -> const Vec<2>& { return points[std::size_t(i)]; };
    for (const auto& [shared, p] : {std::pair{s.a, s.b}, std::pair{s.b, s.a}})
        for (const auto& [other, q] : {std::pair{t.a, t.b}, std::pair{t.b, t.a}})
            if (shared == other) {
                const Vec<2>& v = at(shared);
                return orient2d(at(p), v, at(q)) != 0 || dot(at(p) - v, at(q) - v) < 0;
            }
    for (int d = 0; d < 2; ++d)
        if (std::max(at(s.a)[d], at(s.b)[d]) < std::min(at(t.a)[d], at(t.b)[d]) ||
            std::max(at(t.a)[d], at(t.b)[d]) < std::min(at(s.a)[d], at(s.b)[d]))
            return true;
    const auto on_one_side = [&](const Ends& line, const Ends& of) {
        return orient2d(at(line.a), at(line.b), at(of.a)) * orient2d(at(line.a), at(line.b), at(of.b)) > 0;
    };
    return on_one_side(s, t) || on_one_side(t, s);
}

}  // namespace

bool are_simple_polygons(std::span<const Vec<2>> points, std::span<const Triangulation::Segment> segments) {
    std::vector<char> ends(points.size(), 0);
    for (const Ends& s : segments)
        for (const int p : {s.a, s.b})
            if (++ends[std::size_t(p)] > 2) return false;
    if (segments.size() < 3 || segments.size() != points.size()) return false;
    Box<2> box;
    for (const Vec<2>& p : points) {
        if (!is_finite(p)) return false;
        box.add(p);
    }
    const Vec<2> size = box.hi - box.lo, scale{{1 / size[0], kSlant / size[1]}};
    if (!is_finite(size) || !is_finite(scale)) return false;
    std::vector<double> along(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = dot(scale, points[i] - box.lo);
    struct Item {
        double lo, hi;
        int segment;
    };
    std::vector<Item> items;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto [lo, hi] =
            std::minmax(along[std::size_t(segments[i].a)], along[std::size_t(segments[i].b)]);
        items.push_back({lo, hi + kSlack, int(i)});
    }
    sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.lo < b.lo; });
    std::size_t left = kMostPairs * items.size() + kFewPairs;
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t k = i + 1; k < items.size() && items[k].lo <= items[i].hi; ++k)
            if (left-- == 0 || !are_apart(points, segments[std::size_t(items[i].segment)],
                                          segments[std::size_t(items[k].segment)]))
                return false;
    return true;
}

}  // namespace freiform
