// Arcs of curves by their control points, and what can be proven of them: self_intersection.cpp says why.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

namespace freiform::detail {

// Control points of an arc, of one part or several in a row, with what bounds them.
template <int D>
struct Arc {
    Interval on;
    std::vector<Vec<D>> points, legs;
    double error = 0;  // of each coordinate of `points`
    Box<D> box;
};

// A bound for each number of some homogeneous points: coordinates and weights have units of their own.
struct NumberError {
    double point = 0, weight = 0;
};
// The largest coordinate and the largest weight, times `factor`.
template <class P>
NumberError share_of(const std::vector<P>& b, double factor) {
    NumberError most;
    for (const P& p : b) {
        for (int k = 0; k < Space<P>::kDim; ++k) most.point = std::max(most.point, std::abs(p[k]));
        if (Space<P>::kRational) most.weight = std::max(most.weight, std::abs(Space<P>::weight(p)));
    }
    return {factor * most.point + 0x1p-1060, Space<P>::kRational ? factor * most.weight + 0x1p-1060 : 0};
}
inline NumberError operator+(const NumberError& a, const NumberError& b) {
    return {a.point + b.point, a.weight + b.weight};
}

// Numbers X, W that are off by e_X, e_W: X / W is off by (e_X + |X / W| e_W) / (W - e_W) at most.
template <class P>
void add_points(Arc<Space<P>::kDim>& arc, const std::vector<P>& b, const NumberError& error, int skip_lo,
                int skip_hi) {
    double x = 0, w = std::numeric_limits<double>::infinity();
    const std::size_t first = arc.points.size();
    for (const P& p : b) {
        arc.points.push_back(project(p));
        x = std::max(x, max_abs(arc.points.back()));
        w = std::min(w, Space<P>::weight(p));
    }
    double e = error.point;
    if (Space<P>::kRational)
        e = w > 2 * error.weight
                ? (error.point + x * error.weight) / (w - error.weight) + 2 * kUnitRoundoff * x
                : std::numeric_limits<double>::infinity();
    arc.error = std::max(arc.error, 1.01 * e);
    for (std::size_t i = first + std::size_t(skip_lo); i + 1 + std::size_t(skip_hi) < arc.points.size(); ++i)
        arc.legs.push_back(arc.points[i + 1] - arc.points[i]);
    for (std::size_t i = first; i < arc.points.size(); ++i) arc.box.add(arc.points[i]);
}

// The range of n . x over the arc, rounding included.
template <int D>
Interval range_along(const Arc<D>& arc, const Vec<D>& n) {
    Interval r{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    double size = 0;
    for (int k = 0; k < D; ++k) size += std::abs(n[k]);
    for (const Vec<D>& p : arc.points) {
        const double v = dot(n, p);
        r = {std::min(r.lo, v), std::max(r.hi, v)};
    }
    const double slack = size * (1.01 * arc.error + (D + 1) * 1.01 * kUnitRoundoff * arc.box.scale());
    return {r.lo - slack, r.hi + slack};
}

template <int D>
double leg_error(const Arc<D>& arc) {
    return 2.02 * arc.error + 2 * kUnitRoundoff * arc.box.scale();
}

// Do all legs of all arcs point into one open half-space?
template <int D>
bool moves_on(std::initializer_list<const Arc<D>*> arcs) {
    Vec<D> a{};
    for (const Arc<D>* arc : arcs)
        for (const Vec<D>& leg : arc->legs) a += unit(leg);
    a = unit(a);
    for (const Arc<D>* arc : arcs) {
        const double e = 2 * leg_error(*arc);  // |a|_1 <= sqrt(D) < 2
        for (const Vec<D>& leg : arc->legs)
            if (!(dot(a, leg) > e + 4 * kUnitRoundoff * norm(leg))) return false;
    }
    return true;
}

// Is cross(leg of a, leg of b) of one sign for all legs?
inline bool meet_at_most_once(std::initializer_list<const Arc<2>*> as,
                              std::initializer_list<const Arc<2>*> bs) {
    int sign = 0;
    for (const Arc<2>* a : as)
        for (const Arc<2>* b : bs) {
            const double ea = leg_error(*a), eb = leg_error(*b);
            for (const Vec<2>& p : a->legs)
                for (const Vec<2>& q : b->legs) {
                    const double c = cross(p, q), mp = std::abs(p[0]) + std::abs(p[1]),
                                 mq = std::abs(q[0]) + std::abs(q[1]);
                    const double e = ea * mq + eb * mp + 2 * ea * eb + 3 * kUnitRoundoff * mp * mq;
                    const int s = c > 1.01 * e ? 1 : c < -1.01 * e ? -1 : 0;
                    if (s == 0 || (sign != 0 && s != sign)) return false;
                    sign = s;
                }
        }
    return sign != 0;
}

template <int D>
bool are_apart(const Arc<D>& a, const Arc<D>& b) {
    for (int k = 0; k < D; ++k) {
        const double e = 1.01 * (a.error + b.error);
        if (a.box.lo[k] > b.box.hi[k] + e || b.box.lo[k] > a.box.hi[k] + e) return true;
    }
    if constexpr (D == 2)
        for (const Arc<2>* side : {&a, &b}) {
            const Vec<2> chord = side->points.back() - side->points.front();
            const Vec<2> n = unit(Vec<2>{{-chord[1], chord[0]}});
            const Interval ra = range_along(a, n), rb = range_along(b, n);
            if (ra.hi < rb.lo || rb.hi < ra.lo) return true;
        }
    return false;
}

// The width across its chord.
template <int D>
double thickness(const Arc<D>& a) {
    if constexpr (D != 2) return a.box.diagonal();
    const Vec<D> chord = unit(a.points.back() - a.points.front());
    double most = 0;
    for (const Vec<D>& p : a.points) {
        const Vec<D> d = p - a.points.front();
        most = std::max(most, norm(d - dot(d, chord) * chord));
    }
    return most;
}

inline bool is_certainly_crossing(const Arc<2>& p, const Arc<2>& q) {
    if (!meet_at_most_once({&p}, {&q})) return false;
    const auto passes = [](const Arc<2>& through, const Arc<2>& strip) {
        const Vec<2> chord = strip.points.back() - strip.points.front();
        const Vec<2> n = unit(Vec<2>{{-chord[1], chord[0]}});
        const Interval r = range_along(strip, n);
        const double e = 2 * (1.01 * through.error + 4 * kUnitRoundoff * through.box.scale());
        const double from = dot(n, through.points.front()), to = dot(n, through.points.back());
        return (from + e < r.lo && to - e > r.hi) || (to + e < r.lo && from - e > r.hi);
    };
    return passes(p, q) && passes(q, p);
}

}  // namespace freiform::detail
