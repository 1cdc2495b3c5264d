// More changes of a B-spline basis: one knot by Boehm's algorithm, all midpoints of a uniform basis by that
// of Lane and Riesenfeld, and a larger domain. Insertion of any knots (Oslo), restriction: change.hpp.
#pragma once
#include <freiform/basis/change.hpp>

namespace freiform {

// Boehm's algorithm: one knot u inside the domain, of multiplicity <= p + 1 afterwards (closed: p). Of the
// new coefficients at most p are a mean of two neighbours, the others are old ones. The same function, basis
// and coefficients as insert_knots, up to rounding; cheaper where knots come one by one. Refuses as
// insert_knots does, to which closed bases of fewer than p - 1 coefficients are left.
//   auto more = insert_knot(curve.basis(), 0.5);
Result<Change<BSplineBasis>> insert_knot(const BSplineBasis& old, double u);

// The same function on a larger domain: the first and the last piece are continued as the polynomials that
// they are. Clamped at both ends; inner knots stay. A closed basis is opened at its seam first. Extrapolation
// amplifies errors of the coefficients: by up to about (2 x)^p where x is the new length in first (last)
// spans; `entry_bound` says what the entries of the map are off themselves, at most. Refuses domains that do
// not contain the old one.
struct Extension : Change<BSplineBasis> {
    std::vector<double> entry_bound;  // as map.entry
};
Result<Extension> extend_to(const BSplineBasis& old, Interval on);

// The matrix that refines n coefficients of a uniform B-spline of this degree to knots at half the distance.
// Open: knots i = 0, 1, .., n + p without multiplicities, domain [p, n]; 2 n - p rows, the coefficients that
// the domain depends on. Closed: 2 n rows. Entries C(p + 1, k) / 2^p: exact. REQUIRES 0 <= degree <=
// kMaxDegree, and size > degree if open, size >= 1 if closed.
BandMap uniform_subdivision(int degree, int size, bool closed);

// Lane and Riesenfeld: the same without a matrix, by doubling every coefficient and taking means of
// neighbours p times. Only sums and halves. REQUIRES as above.
template <Coefficient P>
std::vector<P> lane_riesenfeld(std::span<const P> coefficients, int degree, bool closed) {
    FF_REQUIRE(degree >= 0 && degree <= kMaxDegree &&
               coefficients.size() >= (closed ? 1u : unsigned(degree) + 1));
    std::vector<P> c;
    for (const P& p : coefficients) c.insert(c.end(), 2, p);
    for (int pass = 0; pass < degree; ++pass) {
        const P wrapped = c.front();
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] = 0.5 * c[i] + 0.5 * c[i + 1];
        if (closed)
            c.back() = 0.5 * c.back() + 0.5 * wrapped;
        else
            c.pop_back();
    }
    return c;
}

// Every span of a uniform basis halved, by uniform_subdivision: all differences of neighbouring knots must be
// the same number. Refuses other bases as unsupported (insert_knots takes any).
Result<Change<BSplineBasis>> halve_uniform(const BSplineBasis& old);

}  // namespace freiform
