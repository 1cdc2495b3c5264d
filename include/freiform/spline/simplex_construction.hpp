// The construction of de Casteljau in a triangle with all its intermediate nets, blossoms, and derivatives in
// any directions.
//
//     level 0: the net of degree n      (r; j, k) is level r, place i + j + k = n - r:
//     level 1: degree n - 1
//     ..                                (r; j, k) = t1 (r-1; i+1, j, k) + t2 (r-1; i, j+1, k)
//     level n: the point                            + t3 (r-1; i, j, k+1)
//
// The levels are the layers of a tetrahedron over the net: its three other faces are the nets of the parts
// around the point.
//   auto all = *de_casteljau(patch, {0.2, 0.3});
//   for (int r = 0; r <= all.degree(); ++r) draw_net(all.level(r));
#pragma once
#include <freiform/spline/simplex.hpp>

namespace freiform {

template <Coefficient P>
class TriangleConstruction {
public:
    int degree() const { return degree_; }
    const Param<2>& parameter() const { return u_; }
    const P& operator()(int r, int j, int k) const {
        return points_[start(r) + SimplexPatch<2, P>::slot(j, k)];
    }
    // A net of degree() - r, ordered as those of patches are.
    std::span<const P> level(int r) const {
        return std::span(points_).subspan(start(r), start(r + 1) - start(r));
    }
    const P& point() const { return points_.back(); }
    // The part that has the point for corner `corner` (0, 1, 2) and the other two of the whole. REQUIRES a
    // parameter inside the triangle.
    SimplexPatch<2, P> part(int corner) const {
        std::vector<P> b;
        for (int row = 0; row <= degree_; ++row)
            for (int k = 0; k <= row; ++k) {
                std::array<int, 3> at{degree_ - row, row - k, k};
                const int r = std::exchange(at[std::size_t(corner)], 0);
                b.push_back((*this)(r, at[1], at[2]));
            }
        return SimplexPatch<2, P>::trusted(degree_, std::move(b));
    }
    // No (homogeneous) coordinate of any point of the construction is off by more.
    double bound() const { return bound_; }

    template <Coefficient Q>
    friend Result<TriangleConstruction<Q>> de_casteljau(const SimplexPatch<2, Q>& s, const Param<2>& u);

private:
    TriangleConstruction(int degree, const Param<2>& u) : degree_(degree), u_(u) {}
    // (n + 1)(n + 2)/2 + n (n + 1)/2 + .. of r terms.
    std::size_t start(int r) const {
        std::size_t sum = 0;
        for (int m = degree_; m > degree_ - r; --m) sum += std::size_t((m + 1) * (m + 2) / 2);
        return sum;
    }

    int degree_;
    Param<2> u_;
    double bound_ = 0;
    std::vector<P> points_;
};

// u may be any finite parameter; outside the triangle the points are extrapolated. Refuses, as "at",
// parameters that are not finite and constructions that leave the range of double.
template <Coefficient P>
Result<TriangleConstruction<P>> de_casteljau(const SimplexPatch<2, P>& s, const Param<2>& u);

// F(a_1, .., a_n), the function with F(a, .., a) = f(a) that is symmetric and affine in each of its n =
// degree() arguments, as a (homogeneous) coefficient. Arguments are parameters. REQUIRES n of them, finite.
//   b_ijk = blossom of i times (0, 0), j times (1, 0), k times (0, 1)
template <Coefficient P>
P blossom(const SimplexPatch<2, P>& s, std::span<const Param<2>> arguments);

// The derivative in all these directions, one after the other: D_d1 .. D_dr f(u). A direction is a vector of
// the parameter plane, and its length counts. No directions: the value. REQUIRES finite parameters.
template <Coefficient P>
PointOf<P> derivative(const SimplexPatch<2, P>& s, const Param<2>& u, std::span<const Vec<2>> directions) {
    // prod (d_0 du + d_1 dv) as a polynomial: factor[k] belongs to du^(r-k) dv^k.
    std::vector<double> factor{1};
    for (const Vec<2>& d : directions) {
        factor.push_back(0);
        for (std::size_t k = factor.size(); k-- > 0;)
            factor[k] = d[0] * factor[k] + (k > 0 ? d[1] * factor[k - 1] : 0);
    }
    const int r = int(directions.size());
    const auto all = s.derivatives(u, r);
    PointOf<P> sum{};
    for (int k = 0; k <= r; ++k) sum += factor[std::size_t(k)] * all[jet_slot<2>(Index<2>{r - k, k})];
    return sum;
}

}  // namespace freiform
