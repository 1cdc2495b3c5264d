// Where things are: points in boxes, and how far open edges are from each other.
//
// Cost of the latter: quadratic in the number of edges that stay open, but for boxes that most pairs are told
// apart by.
#include "sew_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace freiform {

namespace {

constexpr int kPlacesOfGap = 33;

// Of n places the k-th to look at, both ends among them. Not all of them breaks of the curve, which are every
// 4th place: there approximations of one curve agree that differ elsewhere.
std::size_t place_of_gap(std::size_t n, std::size_t k) {
    return std::min(n - 1, k * (n - 1) / (kPlacesOfGap - 1) + k % std::size_t(kPlacesPerSpan));
}

double distance_from_box(const Box<3>& box, const Vec<3>& p) {
    Vec<3> d;
    for (int i = 0; i < 3; ++i) d[i] = std::max({0.0, box.lo[i] - p[i], p[i] - box.hi[i]});
    return norm(d);
}

double distance_from_places(const std::vector<Vec<3>>& places, const Vec<3>& p) {
    double best = kInfinity;
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        const Vec<3> d = places[k + 1] - places[k], to = p - places[k];
        const double length2 = dot(d, d);
        const double part = length2 > 0 ? std::clamp(dot(to, d) / length2, 0.0, 1.0) : 0;
        best = std::min(best, norm(to - part * d));
    }
    return best;
}

}  // namespace

PointTree::PointTree(std::vector<Vec<3>> points)
    : points_(std::move(points)), order_(points_.size()), axis_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::vector<std::pair<std::size_t, std::size_t>> todo{{0, order_.size()}};
    while (!todo.empty()) {
        const auto [begin, end] = todo.back();
        todo.pop_back();
        if (begin >= end) continue;
        Box<3> box;
        for (std::size_t i = begin; i < end; ++i) box.add(points_[std::size_t(order_[i])]);
        int axis = 0;
        for (int d = 1; d < 3; ++d)
            if (box.side(d).length() > box.side(axis).length()) axis = d;
        const std::size_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + std::ptrdiff_t(begin), order_.begin() + std::ptrdiff_t(middle),
                         order_.begin() + std::ptrdiff_t(end), [&](int a, int b) {
                             return points_[std::size_t(a)][axis] < points_[std::size_t(b)][axis];
                         });
        axis_[middle] = axis;
        todo.push_back({begin, middle});
        todo.push_back({middle + 1, end});
    }
}

std::vector<int> PointTree::in(const Box<3>& box) const {
    std::vector<int> found;
    std::vector<std::pair<std::size_t, std::size_t>> todo{{0, order_.size()}};
    while (!todo.empty()) {
        const auto [begin, end] = todo.back();
        todo.pop_back();
        if (begin >= end) continue;
        const std::size_t middle = begin + (end - begin) / 2;
        const Vec<3>& p = points_[std::size_t(order_[middle])];
        const int axis = axis_[middle];
        if (box.contains(p)) found.push_back(order_[middle]);
        if (box.lo[axis] <= p[axis]) todo.push_back({begin, middle});
        if (p[axis] <= box.hi[axis]) todo.push_back({middle + 1, end});
    }
    sort(found.begin(), found.end());
    return found;
}

std::vector<RemainingGap> remaining_gaps(const Model& model, double tolerance) {
    std::vector<int> uses(model.edges.size());
    std::vector<std::pair<int, const Coedge*>> user(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& l : model.faces[f].loops)
            for (const Coedge& c : l.coedges) {
                ++uses[std::size_t(c.edge)];
                user[std::size_t(c.edge)] = {int(f), &c};
            }
    struct Open {
        int edge, face;
        std::vector<Vec<3>> at;
        Box<3> box;
    };
    std::vector<Open> open;
    for (std::size_t e = 0; e < model.edges.size(); ++e) {
        const Edge& edge = model.edges[e];
        if (uses[e] != 1 || edge.degenerate) continue;
        Open o{int(e), user[e].first, {}, {}};
        if (edge.curve) {
            o.at = trace_of(*edge.curve, edge.range).at;
        } else {
            const auto& surface = model.faces[std::size_t(o.face)].surface;
            for (int k = 0; k < 2 * kPlacesOfGap; ++k) {
                const double t = edge.range.lo + edge.range.length() * k / (2 * kPlacesOfGap - 1);
                const Vec<2> uv = clamped(jet<0>(user[e].second->curve, t).value(), limits(surface));
                o.at.push_back(jet<0>(surface, uv.c).value());
            }
        }
        for (const Vec<3>& p : o.at) o.box.add(p);
        open.push_back(std::move(o));
    }
    std::vector<RemainingGap> gaps(open.size());
    parallel_for(open.size(), 1, [&](std::size_t i) {
        const Open& own = open[i];
        RemainingGap& gap = gaps[i];
        gap.edge = own.edge, gap.face = own.face, gap.at = own.at.front();
        gap.box = own.box;
        gap.face_name = model.faces[std::size_t(own.face)].name;
        gap.reason = {RefusalKind::no_answer, text("edges[", own.edge, "]"),
                      text("no other edge with one face runs along it within ", tolerance)};
        for (int k = 0; k < kPlacesOfGap; ++k) {
            const Vec<3>& p = own.at[place_of_gap(own.at.size(), std::size_t(k))];
            double best = kInfinity;
            for (std::size_t j = 0; j < open.size(); ++j)
                if (j != i && distance_from_box(open[j].box, p) < best)
                    best = std::min(best, distance_from_places(open[j].at, p));
            if (best > gap.gap) gap.gap = best, gap.at = p;
        }
    });
    return gaps;
}

}  // namespace freiform
