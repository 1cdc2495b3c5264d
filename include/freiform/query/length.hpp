// Arc length to a proven bound, its inverse, and points at equal distance along a curve.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <memory>
#include <vector>

namespace freiform {

// |value - exact| <= bound, rounding included.
struct Measure {
    double value = 0, bound = 0;
};

// A parameter; the exact arc length up to it, from where lengths are counted, differs from the wanted one by
// at most `bound` (model units).
struct PlaceAtLength {
    double parameter = 0, bound = 0;
};

// The arc length s(t) of a curve, prepared once; const and safe to share. `accuracy` >= 0 is a distance: what
// the length of the whole curve may be off. 0 asks for all that rounding allows; bounds say what was reached.
// Kinks and cusps need no care; where the curve jumps, the jump adds nothing.
//   const ArcLength s(curve, 1e-9);
//   const double half = s.parameter(s.total().value / 2)->parameter;
template <class P>
class ArcLength {
public:
    // REQUIRES accuracy >= 0.
    ArcLength(const Curve<P>& curve, double accuracy);

    Measure total() const;
    Interval domain() const;
    // From the start of the domain to t. Refuses parameters that are not finite or outside the domain.
    Result<Measure> at(double t) const;
    // The inverse. Refuses lengths that are not finite, negative, or above the total by more than its bound.
    Result<PlaceAtLength> parameter(double length) const;
    // n + 1 places that divide the curve into n parts of equal length, the ends of the domain included.
    // Refuses n < 1, and (limit) n > 10^8.
    Result<std::vector<PlaceAtLength>> equal_parts(int n) const;
    // The places at 0, d, 2 d, .. up to the end. Refuses d that is not positive and finite, and (limit)
    // more than 10^8 places.
    Result<std::vector<PlaceAtLength>> spaced(double d) const;

    // The same of the part on an interval: lengths are counted from its beginning, and bounds include that of
    // where it begins. Refuses, as "on", what is not an interval inside the domain.
    Result<Measure> total(Interval on) const;
    Result<PlaceAtLength> parameter(double length, Interval on) const;
    Result<std::vector<PlaceAtLength>> equal_parts(int n, Interval on) const;
    Result<std::vector<PlaceAtLength>> spaced(double d, Interval on) const;

private:
    struct Table;
    std::shared_ptr<const Table> table_;
};

// The length of a curve, or of its part on an interval inside the domain.
template <class P>
Measure length(const Curve<P>& curve, double accuracy);
template <class P>
Result<Measure> length(const Curve<P>& curve, Interval on, double accuracy);

// Of a curve as models have it: a line, a conic or a spline. Refuses, as "on", what is not an interval inside
// the domain, or not finite, and ranges of parabolas and hyperbolas whose points are beyond doubles.
Result<Measure> length(const CurveGeometry<3>& curve, Interval on, double accuracy);

}  // namespace freiform
