// The implicit form of a plane rational curve: a polynomial F with F(x, y) = 0 on the curve, as the
// determinant of a matrix of lines, M(x, y) = X x + Y y + W, and as coefficients.
//
// F belongs to the doubles of the curve exactly: its sign at a point is never wrong.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/spline/patch.hpp>

#include <vector>

namespace freiform {

// Highest degree of curves with an implicit form.
inline constexpr int kMaxImplicitDegree = 8;

class Implicit {
public:
    // Of a curve of one piece (decompose gives the pieces of others; each has an equation of its own).
    // Refuses degrees 0 and above kMaxImplicitDegree, and a curve that is a single point.
    static Result<Implicit> make(const Curve<Hom<2>, Bernstein>& curve);
    static Result<Implicit> make(const Curve<Vec<2>, Bernstein>& curve);

    // The degree of F: that of the curve less the degree of what its coordinates have as a common factor
    // (elevated, but not rounded: the factor is found exactly).
    int degree() const { return degree_; }
    // How often the curve runs along its image for one run of all parameters: 1, or 2 and more for a curve
    // that turns back, such as (t^2, t^4). F is then a power with this exponent.
    int traces() const { return traces_; }

    // F(x, y) = det M of coordinates divided by scale(): x / scale()[0], y / scale()[1], which are powers of
    // two. Up to a factor, one polynomial; the factor is not 0. REQUIRES finite coordinates.
    Bounded operator()(const Vec<2>& at) const;
    // The sign of F: exact, 0 on the curve and on what else F vanishes on. By bounded doubles where they
    // tell, otherwise by exact arithmetic. The two sides of a simple point of the curve have different signs
    // if traces() is odd. REQUIRES finite coordinates.
    int sign(const Vec<2>& at) const;

    // Row i, column j of M in scaled coordinates: (X, Y, W). Symmetric; i, j < degree().
    std::array<Bounded, 3> entry(int i, int j) const;
    Vec<2> scale() const;

    struct Term {
        int x = 0, y = 0;  // exponents
        Bounded coefficient;
    };
    // F as a sum of coefficient x^i y^j in the coordinates of the curve, every coefficient with a proven
    // bound, all divided by one power of two that makes the largest about 1. Constant first, by total degree,
    // powers of x before those of y. Far from the origin coefficients cancel when summed; the matrix form
    // does not. Refuses coefficients too far apart for doubles.
    Result<std::vector<Term>> terms() const;

private:
    std::vector<Hom<2>> curve_;  // scaled Bernstein form: C(n, i) P_i is coefficient i
    Index<3> exponent_{};        // of the powers of two that x, y and w were divided by
    int degree_ = 0, traces_ = 1;
    std::vector<std::array<Bounded, 3>> matrix_;  // of order curve degree
    int order() const { return int(curve_.size()) - 1; }
};

}  // namespace freiform
