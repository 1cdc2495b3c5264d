// Curves as questions about roots see them: Bezier pieces as rows of numbers, and functions made of them by
// sums, products and derivatives, in doubles that carry bounds or in integers.
//
// Notation. A polynomial of degree n is kept by its scaled Bernstein coefficients s_i = C(n, i) c_i, the
// power coefficients in x = t / (1 - t): products are convolutions, all factors are whole numbers. No
// coefficients: the zero polynomial.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/poly/integer.hpp>
#include <freiform/poly/roots.hpp>
#include <freiform/spline/bezier.hpp>

#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace freiform::detail {

struct CurvePiece {
    Interval on;
    std::vector<std::vector<double>> row;  // the coordinates; of rational pieces also the weights
    double error = 0;                      // of each number; 0: exact
    int degree() const { return int(row[0].size()) - 1; }
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

template <class T>
struct Form {
    std::vector<T> s;

    bool is_zero() const { return s.empty(); }
    int degree() const { return int(s.size()) - 1; }
};

template <class T>
T whole_number(int k) {
    if constexpr (std::same_as<T, Integer>)
        return integer(k);
    else
        return T(double(k));
}

template <class T>
Form<T> operator*(const Form<T>& a, const Form<T>& b) {
    if (a.is_zero() || b.is_zero()) return {};
    Form<T> p{std::vector<T>(a.s.size() + b.s.size() - 1)};
    for (std::size_t i = 0; i < a.s.size(); ++i)
        for (std::size_t j = 0; j < b.s.size(); ++j) p.s[i + j] = p.s[i + j] + a.s[i] * b.s[j];
    return p;
}
// The same polynomial with a higher degree: times (t + (1 - t))^k.
template <class T>
Form<T> elevated(Form<T> a, int degree) {
    while (!a.is_zero() && a.degree() < degree) {
        a.s.push_back(whole_number<T>(0));
        for (std::size_t i = a.s.size() - 1; i > 0; --i) a.s[i] = a.s[i] + a.s[i - 1];
    }
    return a;
}
template <class T>
Form<T> operator+(const Form<T>& a, const Form<T>& b) {
    if (a.is_zero()) return b;
    if (b.is_zero()) return a;
    Form<T> sum = elevated(a, b.degree());
    const Form<T> other = elevated(b, a.degree());
    for (std::size_t i = 0; i < sum.s.size(); ++i) sum.s[i] = sum.s[i] + other.s[i];
    return sum;
}
template <class T>
Form<T> operator-(const Form<T>& a, const Form<T>& b) {
    Form<T> minus = b;
    for (T& x : minus.s) x = whole_number<T>(-1) * x;
    return a + minus;
}
template <class T>
Form<T> operator*(int k, Form<T> a) {
    for (T& x : a.s) x = whole_number<T>(k) * x;
    return a;
}
template <class T>
Form<T> derivative(const Form<T>& a) {
    Form<T> d;
    const int n = a.degree();
    for (int i = 0; i < n; ++i)
        d.s.push_back(whole_number<T>(i + 1) * a.s[std::size_t(i) + 1] -
                      whole_number<T>(n - i) * a.s[std::size_t(i)]);
    return d;
}

// The coordinates of a piece, and its weight (of a polynomial one: the constant 1).
template <class T>
struct Coordinates {
    std::vector<Form<T>> x;
    Form<T> w;
};
Coordinates<Bounded> bounded_coordinates(const CurvePiece& piece, int dimension);
Coordinates<Integer> integer_coordinates(const CurvePiece& piece, int dimension);  // REQUIRES error == 0

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
