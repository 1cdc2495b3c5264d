// Triangular Bezier patches: Bernstein polynomials over a triangle.
//
//     f(t) = project( sum_{i+j+k=n}  n! / (i! j! k!)  t1^i t2^j t3^k  b_ijk ),     t1 + t2 + t3 = 1
//
// The parameters are u = t2 and v = t3, so t1 = 1 - u - v. Corners, edges and the order of the coefficients
// (i = n..0, then j = n-i..0: row after row, away from corner 1), here for degree 2:
//
//      v
//      |  corner 3: b_00n                    5
//      |  | \                                | \                edges: 0 from corner 2 to 3 (t1 = 0)
//      |  |   \                              2   4                     1 from corner 3 to 1 (t2 = 0)
//      |  |     \                            |     \                   2 from corner 1 to 2 (t3 = 0)
//      |  corner 1 - corner 2                0 - 1 - 3
//      |  b_n00      b_0n0
//      +------------------- u
//
// Not a tensor product, but the same jets, the same coefficients and the same Bezier curves along its edges.
#pragma once
#include <freiform/spline/patch.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

template <std::size_t N, Coefficient P>
class SimplexPatch {
    static_assert(N == 2, "triangles only");

public:
    static constexpr std::size_t kParams = N;
    using Coefficients = P;
    using Point = PointOf<P>;

    // Refuses degrees outside [0, kMaxDegree], a number of coefficients other than (n + 1)(n + 2) / 2,
    // coefficients that are not finite or above 2^1022, weights that are not positive or subnormal.
    static Result<SimplexPatch> make(int degree, std::vector<P> coefficients);
    // REQUIRES what `make` checks.
    static SimplexPatch trusted(int degree, std::vector<P> coefficients) {
        return {degree, std::move(coefficients)};
    }

    int degree() const { return degree_; }
    std::span<const P> coefficients() const { return coefficients_; }
    // The place of b_ijk, the same for every degree.
    static constexpr std::size_t slot(int j, int k) { return std::size_t((j + k) * (j + k + 1) / 2 + k); }
    // b_ijk with i = degree() - j - k.
    const P& coefficient(int j, int k) const { return coefficients_[slot(j, k)]; }

    // The box around the triangle. Beyond its diagonal the map is continued (a rational one may have poles
    // there).
    std::array<Interval, 2> domain() const { return {Interval{0, 1}, Interval{0, 1}}; }
    // In the triangle; the sum u + v is rounded before it is compared with 1.
    static constexpr bool contains(const Param<2>& u) { return u[0] >= 0 && u[1] >= 0 && u[0] + u[1] <= 1; }
    // (1 - u - v, u, v); on parameters that the triangle contains the first is not negative.
    static std::array<double, 3> barycentric(const Param<2>& u);

    // Primary interface: many parameters, caller's memory. REQUIRES out.size() == at.size(). Refuses, with
    // the index, parameters that are not finite or outside the triangle. Error of a value: at most
    // value_error_bound().
    Result<void> evaluate(std::span<const Param<2>> at, std::span<Point> out) const;
    template <int K>
    Result<void> evaluate(std::span<const Param<2>> at, std::span<Jet<2, K, Point>> out) const {
        FF_REQUIRE(at.size() == out.size());
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (auto ok = check(at[i], i); !ok) return ok;
            partials(at[i], K, out[i].d);
            for (const Point& d : out[i].d)
                if (!is_finite(d))
                    return refuse(RefusalKind::ill_conditioned, text("at[", i, "]"),
                                  "a derivative is above the largest double");
        }
        return {};
    }

    // Conveniences. REQUIRES finite parameters.
    Point operator()(const Param<2>& u) const { return at_barycentric(barycentric(u)); }
    Point operator()(double u, double v) const { return (*this)(Param<2>{u, v}); }
    Point at_barycentric(const std::array<double, 3>& t) const;
    template <int K>
    Jet<2, K, Point> jet(const Param<2>& u) const {
        Jet<2, K, Point> j;
        partials(u, K, j.d);
        return j;
    }
    // All partial derivatives by u and v up to total order `order` >= 0, in graded order.
    std::vector<Point> derivatives(const Param<2>& u, int order) const;

    // A bound of |computed - exact| in each coordinate of a value inside the triangle.
    double value_error_bound() const;

    friend bool operator==(const SimplexPatch&, const SimplexPatch&) = default;

private:
    SimplexPatch(int degree, std::vector<P> coefficients)
        : degree_(degree), coefficients_(std::move(coefficients)) {}
    Result<void> check(const Param<2>& u, std::size_t index) const;
    void partials(const Param<2>& u, int order, std::span<Point> out) const;

    int degree_;
    std::vector<P> coefficients_;
};

// The same map with degree n + 1. Refused beyond kMaxDegree.
template <class P>
Result<SimplexPatch<2, P>> elevate(const SimplexPatch<2, P>& s);

// The part over the triangle of three parameters: corner i + 1 of the result is corners[i]. REQUIRES finite
// corners; inside the triangle all new coefficients are convex combinations of the old ones. Parts that have
// two corners in common have the same bits along the edge between them.
template <class P>
SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>& s, const std::array<Param<2>, 3>& corners);

// The three parts around a point: part i has the point for its corner i + 1 and the other two corners of the
// whole.
template <class P>
std::array<SimplexPatch<2, P>, 3> split_at(const SimplexPatch<2, P>& s, const Param<2>& u);

// The four parts between corners and middles of edges: part i < 3 keeps corner i + 1, part 3 lies between
// them, turned by half a turn. All have the orientation of the whole.
template <class P>
std::array<SimplexPatch<2, P>, 4> split_in_four(const SimplexPatch<2, P>& s);

// The edge 0, 1 or 2 (see the drawing) as a Bezier curve on [0, 1].
template <class P>
Curve<P, Bernstein> boundary(const SimplexPatch<2, P>& s, int edge);

// The unit normal f_u x f_v. Refuses (ill_conditioned) where the cross product is not above its rounding
// error, and parameters outside the triangle.
template <class P>
requires(Space<P>::kDim == 3) Result<Vec<3>> normal(const SimplexPatch<2, P>& s, const Param<2>& u);

}  // namespace freiform
