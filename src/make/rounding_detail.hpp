// What the rounding of coefficients moves, and coefficients that are known up to rounding.
//
// With errors e_i of numerators and d_i of weights, the difference of the stored map f and the exact one g
// is sum B_i (e_i - g d_i) / sum B_i w_i, B_i >= 0 and w_i the stored weights, hence at most
//     max_i (|e_i| + |g| |d_i|) / w_i,    |g| <= max |P_i| + |f - g|.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/spline/in_space.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform::detail {

// The bound above, coefficient by coefficient.
class MovedBound {
public:
    // `point`: the stored coefficient, projected; `moved`: |e_i| / w_i; `rho`: |d_i| / w_i.
    template <int D>
    void add(const Vec<D>& point, double moved, double rho) {
        reach_ = std::max(reach_, norm(point));
        moved_ = std::max(moved_, moved);
        rho_ = std::max(rho_, rho);
    }
    // Infinite where nothing is known.
    double value() const {
        return rho_ < 0.5 ? (moved_ + reach_ * rho_) / (1 - rho_) * (1 + 32 * kUnitRoundoff)
                          : std::numeric_limits<double>::infinity();
    }

private:
    double reach_ = 0, moved_ = 0, rho_ = 0;
};

// cos and sin of the C library are taken to be off by at most one unit in the last place, as glibc and musl
// state; their derivatives are at most 1.
inline Bounded off_by_an_ulp(double x, double more) {
    return {x, std::abs(x) * (2.01 * kUnitRoundoff) + more};
}
inline Bounded cosine(const Bounded& t) { return off_by_an_ulp(std::cos(t.value), t.bound); }
inline Bounded sine(const Bounded& t) { return off_by_an_ulp(std::sin(t.value), t.bound); }

// A coefficient in space, numerators and weight, divided by powers of two so that products stay in range.
struct SpaceCoefficient {
    BoundedVec<3> x;
    Bounded w = 1;
};

// x 2^k, and what underflow took.
inline Bounded scaled(double x, int k) {
    const double y = std::scalbn(x, k);
    return {y, std::scalbn(y, -k) == x ? 0.0 : 0x1p-1074};
}

// The powers of two of a set of coefficients: of the largest coordinate of their points, and of the largest
// weight.
struct Powers {
    double reach = 0, heaviest = 0;

    void include(const Vec<3>& point) { reach = std::max(reach, max_abs(point)); }
    template <class P>
    void include(const Patch<1, P>& curve) {
        for (const P& p : curve.net().flat()) {
            include(project(in_space(p)));
            heaviest = std::max(heaviest, Space<P>::weight(p));
        }
    }
    int point() const { return reach > 0 ? std::ilogb(reach) : 0; }
    int weight() const { return heaviest > 0 ? std::ilogb(heaviest) : 0; }

    template <class P>
    SpaceCoefficient coefficient(const P& p) const {
        const auto q = in_space(p);
        SpaceCoefficient c;
        for (int i = 0; i < 3; ++i) c.x[std::size_t(i)] = scaled(q[i], -point() - weight());
        c.w = scaled(Space<P>::weight(p), -weight());
        return c;
    }
    BoundedVec<3> vector(const Vec<3>& v) const {
        return {scaled(v[0], -point()), scaled(v[1], -point()), scaled(v[2], -point())};
    }
};

// Takes coefficients in divided units and gives those of the surface: Q is Vec<3>, where all weights are
// exactly 1, or Hom<3>.
template <class Q>
class SurfaceNet {
public:
    explicit SurfaceNet(const Powers& powers) : powers_(powers) {}

    // As it is, to the bit.
    template <class P>
    void add_exact(const P& p) {
        const auto q = in_space(p);
        Q out{};
        for (int i = 0; i < 3; ++i) out[i] = q[i];
        if constexpr (Space<Q>::kRational) out[3] = Space<P>::weight(p);
        add(powers_.coefficient(p), out);
    }
    void add(const SpaceCoefficient& c) {
        const int e = powers_.point(), heavy = powers_.weight();
        Q q{};
        for (int i = 0; i < 3; ++i) q[i] = std::scalbn(c.x[std::size_t(i)].value, e + heavy);
        if constexpr (Space<Q>::kRational) q[3] = std::scalbn(c.w.value, heavy);
        add(c, q);
    }
    const std::vector<Q>& net() const { return net_; }
    std::vector<Q> take() { return std::move(net_); }
    // Distance of every point from that of the exact surface at the same parameters.
    double bound() const { return std::scalbn(moved_.value(), powers_.point()) + lost_; }

private:
    void add(const SpaceCoefficient& c, const Q& q) {
        Vec<3> point, e;
        const double w = c.w.value;
        bool underflow = false;
        for (int i = 0; i < 3; ++i) {
            const Bounded& x = c.x[std::size_t(i)];
            point[i] = x.value / w, e[i] = x.bound / w;
            underflow = underflow || std::scalbn(q[i], -powers_.point() - powers_.weight()) != x.value;
        }
        moved_.add(point, norm(e), c.w.bound / w);
        if (underflow) lost_ = std::max(lost_, 0x1p-1073 / Space<Q>::weight(q));
        net_.push_back(q);
    }

    Powers powers_;
    MovedBound moved_;
    double lost_ = 0;  // to underflow on the way back
    std::vector<Q> net_;
};

}  // namespace freiform::detail
