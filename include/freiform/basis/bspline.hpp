// Univariate bases as values: Bernstein polynomials and B-splines, open and closed.
//
// A basis is a degree, a size, a knot sequence and a span search. Everything else about it (values,
// derivatives, knot insertion, elevation, Bezier extraction) follows from the blossom, see blossom.hpp.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>

#include <concepts>
#include <span>
#include <vector>

namespace freiform {

// Highest degree that any basis of the library has; beyond it construction is refused.
inline constexpr int kMaxDegree = 25;

template <class B>
concept Basis = requires(const B& b, int i, double u) {
    { b.degree() } -> std::same_as<int>;
    { b.size() } -> std::same_as<int>;
    { b.knot(i) } -> std::same_as<double>;
    { b.span(u) } -> std::same_as<int>;
    { b.domain() } -> std::same_as<Interval>;
    { b.wrap(u) } -> std::same_as<double>;
};

// Bernstein polynomials of one degree on an interval.
class Bernstein {
public:
    // Refuses degrees outside [0, kMaxDegree] and intervals that are empty or not finite.
    static Result<Bernstein> make(int degree, Interval on = {0, 1});

    int degree() const { return degree_; }
    int size() const { return degree_ + 1; }
    double knot(int i) const { return i <= degree_ ? on_.lo : on_.hi; }
    int span(double) const { return degree_; }
    Interval domain() const { return on_; }
    double wrap(double u) const { return u; }
    friend bool operator==(const Bernstein&, const Bernstein&) = default;

private:
    Bernstein(int degree, Interval on) : degree_(degree), on_(on) {}
    int degree_;
    Interval on_;
};

// B-splines of one degree p.
//
// Open: a non-decreasing knot vector of size() + p + 1 knots t_i; the domain is [t_p, t_size()], and spans
// are half-open, the last one closed. A knot may have any multiplicity up to p + 1 (there the spline jumps).
//
// Closed: the breaks of one period, stored unwound on both sides, so that knots and spans are found as in the
// open case; coefficient i stands for every i + k size(). One type for both, so that a tube (closed x open)
// is an ordinary surface. Parameters outside the domain are taken modulo the period.
class BSplineBasis {
public:
    static Result<BSplineBasis> make(int degree, std::vector<double> knots);
    // `breaks`: size() + 1 non-decreasing numbers; the first and the last are the same place of the closed
    // curve.
    static Result<BSplineBasis> periodic(int degree, std::vector<double> breaks);
    // The Bezier basis on `on`: degree + 1 equal knots at both ends.
    static Result<BSplineBasis> bezier(int degree, Interval on = {0, 1});
    // Knots 0, 0, .., 0, 1, 2, .., n, .., n for `size` coefficients: uniform and clamped.
    static Result<BSplineBasis> clamped_uniform(int degree, int size);

    int degree() const { return degree_; }
    int size() const { return unwound() - wrapped_; }
    double knot(int i) const { return knots_[std::size_t(i)]; }
    Interval domain() const { return {knot(degree_), knot(unwound())}; }
    bool is_closed() const { return wrapped_ > 0 || closed_constant_; }
    // The index s of the non-empty span with t_s <= u < t_{s+1}; u left or right of the domain: the first,
    // the last.
    int span(double u) const;
    // Closed: u moved into the domain by a multiple of the period. Open: u itself.
    double wrap(double u) const;

    // All knots, of a closed basis unwound by degree() on both sides.
    std::span<const double> knots() const { return knots_; }
    // What the basis was made from: the knot vector, or the breaks of one period.
    std::span<const double> defining() const {
        return is_closed() ? knots().subspan(std::size_t(degree_), std::size_t(size()) + 1) : knots();
    }
    // A basis of the same kind (open or closed) on other knots.
    Result<BSplineBasis> same_kind(int degree, std::vector<double> defining) const {
        return is_closed() ? periodic(degree, std::move(defining)) : make(degree, std::move(defining));
    }
    // Number of knots equal to u in the knot vector (of a closed basis: around u, not counted twice at the
    // seam).
    int multiplicity(double u) const;
    // The distinct knots inside the domain, both ends included.
    std::vector<double> breaks() const;
    // Number of coefficients that are repeated at the end of the unwound knot vector (0 if open).
    int wrapped() const { return wrapped_; }

    friend bool operator==(const BSplineBasis&, const BSplineBasis&) = default;

private:
    BSplineBasis(int degree, std::vector<double> knots, int wrapped, bool closed_constant)
        : degree_(degree), wrapped_(wrapped), closed_constant_(closed_constant), knots_(std::move(knots)) {}
    static Result<BSplineBasis> checked(BSplineBasis basis);
    int unwound() const { return int(knots_.size()) - degree_ - 1; }

    int degree_, wrapped_;
    bool closed_constant_;  // closed and of degree 0, where nothing is wrapped
    std::vector<double> knots_;
};

}  // namespace freiform
