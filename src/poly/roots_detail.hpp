// The stages of the root finder, each on its own.
#pragma once
#include <freiform/poly/integer.hpp>
#include <freiform/poly/integer_roots.hpp>
#include <freiform/poly/roots.hpp>

#include <optional>
#include <span>
#include <vector>

namespace freiform::detail {

// Coefficients, the lowest first; not always all of its degree are there.
using IntegerPolynomial = std::vector<Integer>;
void trim(IntegerPolynomial& a);            // without leading zeros: zero is empty
void make_primitive(IntegerPolynomial& a);  // divided by the greatest common divisor of the coefficients
IntegerPolynomial derivative_of(const IntegerPolynomial& a);
// From Bernstein coefficients c to the coefficients C(n, i) c_i of the powers of t / (1 - t).
IntegerPolynomial to_power(const IntegerPolynomial& bernstein);

// The sign of a polynomial at a double of [0, 1], with all the work that it takes.
class ExactSign {
public:
    explicit ExactSign(std::vector<Integer> bernstein) : c_(std::move(bernstein)) {}
    int operator()(double t) const;
    const std::vector<Integer>& coefficients() const { return c_; }

private:
    std::vector<Integer> c_;
};

// A polynomial as the refinement of a bracket sees it: coefficients in [-1, 1], off by at most `error`.
struct Approximate {
    std::span<const double> c;
    double error = 0;
};

// A bracket of a simple root, narrowed to `width`. The polynomial has the sign `before` at at.lo and the
// other at at.hi. `exact` may be null: then the result may be wider.
Interval refined(const Approximate& p, const ExactSign* exact, Interval at, int before, double width);

// Writes down the signs between roots that are all known exactly, from the one right of 0 on.
void set_signs(std::vector<Root>& roots, int sign);

// Part [cell / 2^depth, (cell + 1) / 2^depth] of [0, 1]; its left end does not belong to it.
struct Cell {
    long long cell = 0;
    int depth = 0;
};
// The roots in the cells (in order, without overlap), but not those at 0 and 1. Signs are left open.
std::vector<Root> exact_roots(const std::vector<Integer>& bernstein, std::span<const Cell> cells,
                              double width);

// The polynomials S_1, S_2, ..: S_k has the roots of p in (0, 1) whose multiplicity is k or more, each once.
// Bernstein coefficients, up to a factor. p has no root at 0 and none at 1.
std::vector<std::vector<Integer>> multiplicity_chain(const std::vector<Integer>& bernstein);

}  // namespace freiform::detail
