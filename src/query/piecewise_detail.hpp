// Curves as questions about roots see them: Bezier pieces as rows of numbers, and functions made of them by
// sums, products and derivatives, in doubles that carry bounds or in integers.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/poly/form.hpp>
#include <freiform/poly/roots.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace freiform::detail {

struct CurvePiece {
    Interval on;
    std::vector<std::vector<double>> row;  // the coordinates; of rational pieces also the weights
    std::vector<double> error;             // of each number of a row; 0: exact
    int degree() const { return int(row[0].size()) - 1; }
    bool is_exact() const {
        return std::ranges::all_of(error, [](double e) { return e == 0; });
    }
};
struct CurvePieces {
    int dimension = 0;
    bool is_rational = false, is_closed = false;
    std::vector<CurvePiece> pieces;
};

// Between knots of multiplicity p on both sides the coefficients of a piece are those of the spline, exactly;
// elsewhere extraction leaves (12 p + 8) roundings of the largest of the row (derivative_bounds.cpp).
template <class P>
CurvePieces pieces_of(const Curve<P>& curve);

// The coordinates of a piece, and its weight (of a polynomial one: the constant 1).
template <class T>
struct Coordinates {
    std::vector<Form<T>> x;
    Form<T> w;
};
Coordinates<Bounded> bounded_coordinates(const CurvePiece& piece, int dimension);
Coordinates<Integer> integer_coordinates(const CurvePiece& piece, int dimension);  // REQUIRES is_exact()

std::vector<Bounded> bernstein(const Form<Bounded>& f);
std::vector<Integer> bernstein(const Form<Integer>& f);  // up to a positive factor

// A function of a curve, in both arithmetics.
struct Expression {
    std::function<Form<Bounded>(const Coordinates<Bounded>&)> bounded;
    std::function<Form<Integer>(const Coordinates<Integer>&)> whole;
};
// expression([](const auto& c) { return derivative(c.x[0]); })
template <class F>
Expression expression(F f) {
    return {[f](const Coordinates<Bounded>& c) -> Form<Bounded> { return f(c); },
            [f](const Coordinates<Integer>& c) -> Form<Integer> { return f(c); }};
}

// The zeros of a function on one piece, in its local parameter.
struct PieceZeros {
    RealRoots found;
    int first = 0, last = 0;  // its signs at the ends, 0 if it vanishes there or the sign is not certain
};
Result<PieceZeros> zeros_of(const Expression& f, const CurvePiece& piece, int dimension, double width);
// From an answer about exact coefficients, or about some known up to an error.
PieceZeros with_ends(RealRoots found, std::span<const Bounded> coefficients);

// A zero of a piecewise function, or an interval where it vanishes, in the parameter of the curve.
struct Zero {
    Interval at;
    int least = 1, most = 1;
    bool is_one = true;
    bool everywhere = false;  // in `at`
    bool jump = false;        // at.lo == at.hi is a knot where the sign changes without a zero
    int before = 0, after = 0;
};
inline constexpr int kUncounted = std::numeric_limits<int>::max();  // Zero::most of what may be an overlap

// In increasing order. Zeros on both sides of a knot are one. Of a closed curve the first knot and the last
// are the same.
std::vector<Zero> joined(const CurvePieces& curve, std::span<const PieceZeros> zeros);

// The part of a domain for a part of [0, 1]; contains the exact image.
Interval image(const Interval& on, const Interval& part);

// Of every piece an upper bound of |dC/dt| in its local parameter; infinite if the weights allow none.
std::vector<double> speed_bounds(const CurvePieces& curve);
// A width of [0, 1] over which a piece of this speed moves by less than `accuracy`.
double width_for(double accuracy, double speed);
// No point of the curve over `at` is farther than this from another one.
double reach_of(const CurvePieces& curve, std::span<const double> speed, const Interval& at);

}  // namespace freiform::detail
