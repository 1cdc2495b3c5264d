// The Bezier pieces of a curve as arcs, halved where they are asked to be: self_intersection.cpp looks at
// pairs of them. Errors of the coefficients are counted, as bounds.cpp does.
#pragma once
#include "arc_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

namespace freiform::detail {

template <class P>
class HalvedArcs {
public:
    static constexpr int D = Space<P>::kDim;

    // `errors`: what the coefficients of each piece are off by; empty: nothing.
    HalvedArcs(const Curve<P>& curve, std::span<const double> errors) : domain_(curve.basis().domain()) {
        const BezierPieces<1, P> pieces(curve);
        const BSplineBasis& basis = curve.basis();
        const int p = basis.degree();
        for (int i = 0; i < pieces.extent()[0]; ++i) {
            Part part;
            const auto net = pieces.net({i});
            for (int j = 0; j <= p; ++j) part.b.push_back(net({j}));
            part.arc.on = pieces.box({i})[0];
            const int s = basis.span(part.arc.on.lo);
            const bool exact =
                p > 0 && basis.knot(s - p + 1) == part.arc.on.lo && basis.knot(s + p) == part.arc.on.hi;
            if (exact) {
                while (part.still_lo < p && net({part.still_lo}) == net({part.still_lo + 1})) ++part.still_lo;
                while (part.still_hi < p && net({p - part.still_hi}) == net({p - part.still_hi - 1}))
                    ++part.still_hi;
            } else {
                part.error = share_of(part.b, (12 * p + 8) * kUnitRoundoff);
            }
            if (!errors.empty())
                part.error = part.error + NumberError{errors[std::size_t(i)], errors[std::size_t(i)]};
            if (i > 0) jumps_.push_back(basis.multiplicity(part.arc.on.lo) > p);
            finish(part);
            parts_.push_back(std::move(part));
        }
        parameter_error_ = 4 * kUnitRoundoff * std::max(std::abs(domain_.lo), std::abs(domain_.hi));
        count_ = int(parts_.size());
    }

    int count() const { return count_; }  // of the pieces, which come before all halves
    const Arc<D>& arc(int i) const { return parts_[std::size_t(i)].arc; }
    bool is_point(int i) const { return parts_[std::size_t(i)].b.size() < 2; }
    // What the ends of halves, which are rounded, are off by at most.
    double parameter_error() const { return parameter_error_; }

    // The halves of an arc, exactly at half of its local parameter; `on` says where that is up to
    // parameter_error(): a mean of two ends that are off by 2 u of the largest parameter is so, too. Nothing
    // where no double lies between the ends. What arc() has returned stays where it is.
    std::optional<std::array<int, 2>> halves(int i) {
        if (parts_[std::size_t(i)].left >= 0)
            return std::array{parts_[std::size_t(i)].left, parts_[std::size_t(i)].right};
        const Part& whole = parts_[std::size_t(i)];
        const double middle = whole.arc.on.middle();
        if (!(whole.arc.on.lo < middle && middle < whole.arc.on.hi)) return std::nullopt;
        const int n = int(whole.b.size());
        const NumberError e = whole.error + share_of(whole.b, 1.01 * n * kUnitRoundoff);
        Part left{whole.b, e, whole.still_lo, 0, -1, -1, {}},
            right{whole.b, e, 0, whole.still_hi, -1, -1, {}};
        keep_left(Fibre<P>{left.b.data(), n, 1}, 0.5);
        keep_right(Fibre<P>{right.b.data(), n, 1}, 0.5);
        left.arc.on = {whole.arc.on.lo, middle};
        right.arc.on = {middle, whole.arc.on.hi};
        finish(left);
        finish(right);
        const int at = int(parts_.size());
        parts_[std::size_t(i)].left = at;
        parts_[std::size_t(i)].right = at + 1;
        parts_.push_back(std::move(left));
        parts_.push_back(std::move(right));
        return std::array{at, at + 1};
    }

    // The control points of the curve over an interval, which may reach over knots.
    Arc<D> arc_over(const Interval& on) const {
        Arc<D> out;
        out.on = on;
        for (int i = std::max(0, first_from(on.lo) - 1); i < count_ && arc(i).on.lo < on.hi; ++i) {
            const Part& part = parts_[std::size_t(i)];
            const Interval own = part.arc.on;
            const double lo = std::max(on.lo, own.lo), hi = std::min(on.hi, own.hi);
            if (!(lo < hi)) continue;
            std::vector<P> b = part.b;
            const int n = int(b.size());
            // Local parameters are off by 6 u, their quotients, with divisors of at least 1/2, by 24 u; that
            // moves coefficients by 2 n times as much of the largest. Each cut has 3 n roundings of its own.
            const NumberError e = part.error + share_of(b, 60 * n * kUnitRoundoff);
            const double from = (lo - own.lo) / own.length(), to = (hi - own.lo) / own.length();
            const Fibre<P> row{b.data(), n, 1};
            if (from <= 0.5) {
                if (lo > own.lo) keep_right(row, from);
                if (hi < own.hi) keep_left(row, std::clamp((to - from) / (1 - from), 0.0, 1.0));
            } else {
                if (hi < own.hi) keep_left(row, to);
                keep_right(row, std::clamp(from / to, 0.0, 1.0));
            }
            add_points(out, b, e, 0, 0);
        }
        return out;
    }

    // Where the curve goes on without a jump around t.
    Interval stretch_around(double t) const {
        Interval on = domain_;
        for (int i = 1; i < count_; ++i) {
            const double at = arc(i).on.lo;
            if (jumps_[std::size_t(i) - 1]) (at <= t ? on.lo : on.hi) = at;
            if (at > t && on.hi == at) break;
        }
        return on;
    }

    // Whether the curve jumps where two arcs have their parameter in common.
    bool jumps_at(double t) const {
        const int i = first_from(t);
        return i > 0 && i < count_ && arc(i).on.lo == t && jumps_[std::size_t(i) - 1];
    }

private:
    // The first of the pieces that begins at t or later.
    int first_from(double t) const {
        const auto all = std::views::iota(0, count_);
        return int(std::ranges::lower_bound(all, t, {}, [&](int i) { return arc(i).on.lo; }) - all.begin());
    }

    struct Part {
        std::vector<P> b;
        NumberError error;               // of the numbers in b
        int still_lo = 0, still_hi = 0;  // legs at the ends that are exactly zero
        int left = -1, right = -1;       // halves, once they are made
        Arc<D> arc;
    };

    static void finish(Part& part) {
        const int n = int(part.b.size()) - 1;
        const bool point = part.still_lo == n;
        add_points(part.arc, part.b, part.error, point ? 0 : part.still_lo, point ? 0 : part.still_hi);
    }

    Interval domain_;
    double parameter_error_ = 0;
    int count_ = 0;
    std::deque<Part> parts_;   // a deque: references to arcs outlive new halves
    std::vector<char> jumps_;  // at the beginning of piece i + 1
};

}  // namespace freiform::detail
