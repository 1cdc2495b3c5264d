// One side of a joint written in arc length, with bounds.
#pragma once
#include <freiform/poly/series.hpp>
#include <freiform/query/continuity.hpp>

namespace freiform::detail {

using BoundedVector = std::vector<Bounded>;

inline Bounded scaled(const Bounded& a, int e) { return {std::scalbn(a.value, e), std::scalbn(a.bound, e)}; }
Bounded length(const BoundedVector& v);
Bounded inner(const BoundedVector& a, const BoundedVector& b);
BoundedVector unit(const BoundedVector& v);  // empty where v may be 0

BoundedVector derivative_of(const CurveSide& side, std::size_t k);
// The order of the first derivative that is not 0, as far as is known; 0 where there is none.
int first_order(const CurveSide& side);

// A side in scaled units: coordinates times 2^-length, parameters times 2^-time.
struct Expansion {
    int dimension = 0, time = 0;
    int first = 0;                           // order of the first derivative that is not 0; 0: none
    BoundedVector tangent;                   // in the direction of the curve; empty where there is none
    std::vector<Series<Bounded>> by_length;  // per coordinate, in arc length; up to where it has derivatives
    int unbounded = 0;    // the order of the derivative by arc length that has no limit; 0: none so far
    Series<Bounded> arc;  // arc length of the (scaled) parameter, of a regular side

    bool is_regular() const { return first == 1; }
    // By arc length.
    BoundedVector derivative(std::size_t k) const;
};

// Up to `terms` terms. `tolerance`, in model units: terms that move no point by more within the piece may be
// taken for none where the derivative is 0.
Expansion expand(const CurveSide& side, std::size_t terms, int length_scale, bool after, double tolerance);

}  // namespace freiform::detail
