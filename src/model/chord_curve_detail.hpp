// Curves in space that are asked many times how far a chord is from them: essay in chord_curve.cpp.
#pragma once
#include "piecewise_bound_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace freiform {

// Orthonormal: along the chord, and two directions across it, the first where `bend` points. None of a chord
// without length.
using ChordFrame = std::array<Vec<3>, 3>;
std::optional<ChordFrame> frame_of(const Vec<3>& chord, const Vec<3>& bend);

class ChordCurve {
public:
    // REQUIRES that the geometry outlives it.
    explicit ChordCurve(const CurveGeometry<3>& curve);

    // Of the distance between the curve over `on` and its chord, at equal parameters, and as sets; the latter
    // is not made better than `enough`. Kinks are not in it.
    double at_equal(Interval on) const;
    double across(Interval on, double enough) const;
    double kinks(Interval on) const { return kink_bound_of(query_.kinks(0), on); }
    const DerivativeQuery<1, 3>& query() const { return query_; }

private:
    struct Piece {
        double end;            // where it ends
        bool smooth;           // it is of one polynomial or rational piece with the one before
        double second, third;  // bounds
    };
    struct Most {
        double second = 0, third = 0;
    };
    Most over(Interval on) const;

    DerivativeQuery<1, 3> query_;
    std::vector<Piece> pieces_;  // empty: ask the query
    PiecewiseBound second_;      // of the same pieces
    double begin_ = 0;
    double second_rounding_ = 0;
    bool straight_ = false;
};

// A curve congruent to S(p(t)) for t = (s - shift) / speed, s its own parameter, where that is a curve of the
// same sort: on planes, and along parameter lines of others.
struct LiftedCurve {
    std::unique_ptr<const CurveGeometry<3>> geometry;
    double shift = 0, speed = 1;
    bool on_plane = false;
    Interval over(Interval t) const {
        const double a = shift + speed * t.lo, b = shift + speed * t.hi;
        return a < b ? Interval{a, b} : Interval{b, a};
    }
};
std::optional<LiftedCurve> lifted(const SurfaceGeometry& surface, const CurveGeometry<2>& curve);

// Infinite if the two are not the same but for rounding of their coefficients; else a bound of their
// distance.
double distance_of_twins(const CurveGeometry<3>& a, const CurveGeometry<3>& b);

}  // namespace freiform
