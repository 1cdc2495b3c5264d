// The bases that polynomials are given in, of any degree: monomial, Bernstein, Hermite, Lagrange, Newton,
// B-spline; and the change from one to another as a matrix, with its condition and a bound of what it costs.
//
// The cubic ones as 4 x 4 matrices: named.hpp. Curves from coefficients in any of them: make/named_curve.hpp.
#pragma once
#include <freiform/basis/band_map.hpp>
#include <freiform/core/bounded.hpp>

#include <string_view>

namespace freiform {

enum class Scheme { monomial, bernstein, hermite, lagrange, newton, b_spline };
std::string_view name_of(Scheme scheme);

// degree() + 1 polynomials of degree() that span all polynomials of that degree. A value.
class PolynomialBasis {
public:
    // All refuse degrees outside [0, kMaxDegree], numbers that are not finite, intervals that are empty.

    // (t - o)^n, .., t - o, 1: highest power first, as in Q = C T. A basis about the origin o.
    static Result<PolynomialBasis> monomial(int degree, double origin = 0);
    static Result<PolynomialBasis> bernstein(int degree, Interval on = {0, 1});
    // Odd degrees 2 m + 1. Coefficients: value at lo, value at hi, first derivative at lo, at hi, .., the
    // m-th derivative at lo, at hi (with respect to t). Degree 3: (P1, P4, R1, R4).
    static Result<PolynomialBasis> hermite(int degree, Interval on = {0, 1});
    // degree + 1 nodes, all different. Coefficients: the values there.
    static Result<PolynomialBasis> lagrange(std::vector<double> nodes);
    // 1, t - x_0, (t - x_0)(t - x_1), ..: degree + 1 nodes, of which the last has no influence on the
    // functions (it is where the last divided difference takes its last value). Nodes may repeat.
    static Result<PolynomialBasis> newton(std::vector<double> nodes);
    // The degree + 1 functions that live on one non-empty span: of knots at .., -1, 0, 1, 2, .. on [0, 1]; or
    // of `basis` on [t_span, t_{span+1}).
    static Result<PolynomialBasis> uniform_b_spline(int degree);
    static Result<PolynomialBasis> b_spline(const BSplineBasis& basis, int span);

    Scheme scheme() const { return scheme_; }
    int degree() const { return degree_; }
    int size() const { return degree_ + 1; }
    // monomial: the origin; Hermite: both ends; Lagrange, Newton: the nodes; Bernstein, B-spline: the
    // 2 (degree + 1) knots t_0 .., the span being [t_degree, t_{degree+1}].
    std::span<const double> numbers() const { return numbers_; }
    double knot(int i) const { return numbers_[std::size_t(i)]; }  // REQUIRES Bernstein or B-spline
    // The functions at t, in double precision.
    std::vector<double> values(double t) const;
    friend bool operator==(const PolynomialBasis&, const PolynomialBasis&) = default;

private:
    PolynomialBasis(Scheme scheme, int degree, std::vector<double> numbers)
        : scheme_(scheme), degree_(degree), numbers_(std::move(numbers)) {}
    static Result<PolynomialBasis> checked(PolynomialBasis basis);

    Scheme scheme_;
    int degree_;
    std::vector<double> numbers_;
};

// n equidistant numbers from on.lo to on.hi (one: the middle).
std::vector<double> equidistant(int n, Interval on);

// If f = sum_j c_j F_j ("from") = sum_i d_i T_i ("to"), then d = A c. The functions go with the transpose:
// F_j = sum_i A_ij T_i. (So with c = M d for columns of functions, F = M T, the coefficients go with M^T =
// A.)
struct BasisChange {
    PolynomialBasis from, to;
    std::vector<double> entry;  // A, size() rows of size() numbers; each is the nearest double
    std::vector<double> error;  // bounds of |entry - exact|
    // Infinity norms of A and of its inverse, and their product: how much larger relative errors may be
    // behind the change than before. Rounded up by less than 1e-9 of themselves. 1e16 and more: all digits of
    // doubles can be lost, by any method.
    double norm = 0, inverse_norm = 0, condition = 0;
    // Bounds for coefficients that map() carries over in double precision (underflow apart):
    //   |computed - exact| <= absolute_loss max |c|  in every coefficient,
    //   |computed - exact| <= relative_loss max |d|; 1 and more: no digit of the smaller ones need be right.
    double absolute_loss = 0, relative_loss = 0;

    int size() const { return from.size(); }
    double operator()(int i, int j) const { return entry[std::size_t(i * size() + j)]; }
    BandMap map() const;  // for along(), on any axis of any net
};

// Refuses different degrees (elevate first) as invalid, and as ill_conditioned what 512 binary digits do not
// determine, or what leaves the range of double.
//   auto a = change_basis(*PolynomialBasis::bernstein(5), *PolynomialBasis::monomial(5));
Result<BasisChange> change_basis(const PolynomialBasis& from, const PolynomialBasis& to);

// The same for given coefficients, in 512 binary digits and rounded once: what the change alone costs is one
// rounding per coefficient, whatever the condition is (which still says what errors of `coefficients` do).
// `values`: size() rows of `columns` numbers. Refuses as change_basis does.
struct ConvertedNumbers {
    std::vector<Bounded> values;
    double condition = 0;
};
Result<ConvertedNumbers> convert_coefficients(const PolynomialBasis& from, const PolynomialBasis& to,
                                              std::span<const double> values, int columns);
// Of a tensor product: along axis k from from[k] to to[k]. `values` as a net has them, `columns` numbers for
// each coefficient. Nothing is rounded between the axes. REQUIRES as many bases here as there, at least one.
Result<ConvertedNumbers> convert_coefficients(std::span<const PolynomialBasis> from,
                                              std::span<const PolynomialBasis> to,
                                              std::span<const double> values, int columns);

template <Coefficient P>
struct Converted {
    std::vector<P> coefficients;
    double bound = 0;  // no coordinate of a coefficient is off by more
    double condition = 0;
};
template <Coefficient P>
Result<Converted<P>> convert_coefficients(const PolynomialBasis& from, const PolynomialBasis& to,
                                          std::span<const P> coefficients) {
    std::vector<double> flat;
    for (const P& p : coefficients) flat.insert(flat.end(), p.c.begin(), p.c.end());
    auto numbers = convert_coefficients(from, to, flat, P::kCoords);
    if (!numbers) return std::unexpected(numbers.error());
    Converted<P> out{std::vector<P>(coefficients.size()), 0, numbers->condition};
    for (std::size_t i = 0; i < numbers->values.size(); ++i) {
        out.coefficients[i / P::kCoords][int(i % P::kCoords)] = numbers->values[i].value;
        out.bound = std::max(out.bound, numbers->values[i].bound);
    }
    return out;
}

}  // namespace freiform
