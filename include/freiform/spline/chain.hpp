// The Bezier pieces of a curve one after the other, prepared for algorithms that count their roundings:
// coordinates and weights are divided by powers of two, so that nothing overflows and bounds are numbers near
// 1; and `error(k)` says how far a point may be off that was computed with k roundings.
//
// Accuracy. Notation: u = 2^-53, M >= |coordinate| of every projected coefficient (between 1 and 2 after
// scaling, or 0). Bezier extraction takes convex combinations whose weights carry at most 5 p roundings, and
// sums them (change.cpp, patch_detail.hpp): 6 p roundings in all, and none where a row of the map has a
// single entry 1, as for all pieces of a curve that is given in Bezier form. Convex combinations of what they
// give add their own roundings. k roundings in all put the numerator off by at most g M W and the weight by g
// W, g = 1.01 k u, W the exact weight; so the quotient by 1.02 (2 k + 1) u M, and a polynomial point by g M.
// Products that underflow lose 2 k denormal numbers h at most, in a quotient (1 + M) 2 k h / w_min.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace freiform::detail {

template <int D>
Vec<D> scaled(Vec<D> p, int exponent) {
    for (int i = 0; i < D; ++i) p[i] = std::scalbn(p[i], exponent);
    return p;
}

// The exponent e with 2^e <= x < 2^(e+1); 0 for 0.
inline int exponent_of(double x) { return x > 0 && std::isfinite(x) ? std::ilogb(x) : 0; }

template <class P>
class Chain {
public:
    static constexpr int D = Space<P>::kDim;
    using Point = Vec<D>;

    explicit Chain(const Curve<P>& curve) : degree_(curve.basis().degree()), breaks_(curve.basis().breaks()) {
        double largest = 0, heaviest = 0;
        const double weight = Space<P>::weight(curve.net().flat()[0]);
        for (const P& p : curve.net().flat()) {
            largest = std::max(largest, max_abs(project(p)));
            polynomial_ = polynomial_ && Space<P>::weight(p) == weight;
            heaviest = std::max(heaviest, Space<P>::weight(p));
        }
        exponent_ = exponent_of(largest);
        const int heavy = Space<P>::kRational ? exponent_of(heaviest) : 0;
        size_ = std::scalbn(largest, -exponent_) * (1 + 4 * kUnitRoundoff);
        Net<1, P> net = curve.net();
        for (P& p : net.flat()) {
            for (int i = 0; i < D; ++i) p[i] = std::scalbn(p[i], -exponent_ - heavy);
            if constexpr (Space<P>::kRational) p[D] = std::scalbn(p[D], -heavy);
            lightest_ = std::min(lightest_, Space<P>::weight(p));
        }
        const Change<BSplineBasis> change = to_bezier(curve.basis());
        for (int r = 0; r < change.map.rows() && roundings_ == 0; ++r) {
            const auto row = change.map.row(r);
            const auto zeros = std::ranges::count(row, 0.0), ones = std::ranges::count(row, 1.0);
            if (ones != 1 || zeros + ones != std::ptrdiff_t(row.size())) roundings_ = 6 * degree_;
        }
        net_ = along(0, change.map, net);
        closed_ = curve.basis().is_closed() && !jump(pieces() - 1, 0, curve.basis(), breaks_.front());
        jumps_.assign(breaks_.size(), false);
        for (int i = 1; i < pieces(); ++i)
            jumps_[std::size_t(i)] = jump(i - 1, i, curve.basis(), breaks_[std::size_t(i)]);
    }

    int degree() const { return degree_; }
    int pieces() const { return int(breaks_.size()) - 1; }
    std::span<const P> piece(int i) const {
        return net_.flat().subspan(std::size_t(i) * std::size_t(degree_ + 1), std::size_t(degree_ + 1));
    }
    double at(int i) const { return breaks_[std::size_t(i)]; }
    int exponent() const { return exponent_; }  // coordinates are divided by 2^exponent()
    double size() const { return size_; }       // of the largest coordinate, in divided units
    double lightest() const { return lightest_; }
    bool closed() const { return closed_; }
    bool polynomial() const { return polynomial_; }                // all weights are equal
    int roundings() const { return roundings_; }                   // in the coefficients of the pieces
    bool jumps_at(int i) const { return jumps_[std::size_t(i)]; }  // at the break between pieces i - 1 and i

    // The piece with at(i) <= t < at(i + 1), or < and <= where the end is meant. Outside: the first, the
    // last.
    int starting(double t) const {
        const auto p = std::upper_bound(breaks_.begin(), breaks_.end(), t);
        return std::clamp(int(p - breaks_.begin()) - 1, 0, pieces() - 1);
    }
    int ending(double t) const {
        const auto p = std::lower_bound(breaks_.begin(), breaks_.end(), t);
        return std::clamp(int(p - breaks_.begin()) - 1, 0, pieces() - 1);
    }
    double local(int i, double t) const { return std::clamp((t - at(i)) / (at(i + 1) - at(i)), 0.0, 1.0); }
    double global(int i, double x) const {
        return x >= 1 ? at(i + 1) : std::min(at(i) + x * (at(i + 1) - at(i)), at(i + 1));
    }

    // b[0..p]: the coefficients of piece i on [0, x1] in its local parameter: 3 p roundings.
    void copy_left(int i, double x1, P* b) const {
        std::ranges::copy(piece(i), b);
        if (x1 < 1) keep_left(Fibre<P>{b, degree_ + 1, 1}, x1);
    }
    // From [0, x1] to a part that contains [x0, x1] and begins at most 2 u x0 before it: 3 p roundings.
    // Rounding the quotient down means that neighbouring parts leave no gap.
    void cut_left(double x0, double x1, P* b) const {
        if (x0 > 0) keep_right(Fibre<P>{b, degree_ + 1, 1}, std::nextafter(x0 / x1, 0.0));
    }
    Point value(int i, double x) const {
        P b[kMaxDegree + 1];
        copy_left(i, x, b);
        return project(b[degree_]);
    }

    // Euclidean distance, in divided units, between an exact point and one computed from the pieces by convex
    // combinations with k roundings and one division.
    double error(int k) const {
        k += roundings_;
        const double lost = 2 * k * std::numeric_limits<double>::denorm_min();
        const double each = Space<P>::kRational
                                ? 1.02 * (2 * k + 1) * kUnitRoundoff * size_ + (1 + size_) * lost / lightest_
                                : 1.01 * k * kUnitRoundoff * size_ + lost;
        return std::sqrt(double(D)) * (1 + 4 * kUnitRoundoff) * each;
    }

private:
    // Whether the end of piece a and the start of piece b differ by more than rounding.
    bool jump(int a, int b, const BSplineBasis& basis, double knot) const {
        if (basis.multiplicity(knot) <= degree_ && degree_ > 0) return false;
        return norm(project(piece(a).back()) - project(piece(b).front())) > 2 * error(0);
    }

    int degree_, exponent_ = 0, roundings_ = 0;
    double size_ = 0, lightest_ = Space<P>::kRational ? std::numeric_limits<double>::infinity() : 1;
    bool closed_ = false, polynomial_ = true;
    std::vector<double> breaks_;
    std::vector<bool> jumps_;
    Net<1, P> net_;
};

}  // namespace freiform::detail
