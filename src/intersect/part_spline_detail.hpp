// The surfaces of models, over a box of their parameters, as rational splines of the same shape.
//
// Notation. x: a parameter of the surface; s: the one of the spline, on [0, 1] where they differ. Circles and
// ellipses become quadratic arcs of equal angle with weights 1, cos h, 1; over each of them
//     x = m + 2 atan(K (2 tau - 1)),   K = tan(h / 2),
// m the middle angle, h half the angle, tau in [0, 1] the place between its knots. Hyperbolas likewise, with
// cosh, atanh and tanh. Parabolas are quadratic in x.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/spline/geometry.hpp>

namespace freiform::detail {

class ParameterArcs {
public:
    ParameterArcs() = default;  // x = s
    ParameterArcs(Interval on, int arcs, bool hyperbolic = false)
        : on_(on), arcs_(arcs), hyperbolic_(hyperbolic) {
        const double quarter = on.length() / arcs / 4;
        k_ = hyperbolic ? std::tanh(quarter) : std::tan(quarter);
    }

    bool is_identity() const { return arcs_ == 0; }
    double at(double s) const;
    double slope(double s) const;  // dx/ds
    // Contains x of all s of an interval, rounding included.
    Interval over(const Interval& s) const;

private:
    struct Place {
        int arc;
        double v;  // 2 tau - 1
    };
    Place place(double s) const;
    Interval on_{};
    int arcs_ = 0;
    bool hyperbolic_ = false;
    double k_ = 0;
};

struct PartSpline {
    Surface<Hom<3>> surface;
    std::array<ParameterArcs, 2> map{};
    double bound = 0;  // distance of every point from the surface at the same place
};

// Offsets of splines within the tolerance, without one none; refuses (unsupported) other offsets, and boxes
// that are not bounded.
Result<PartSpline> part_spline(const SurfaceGeometry& surface, const std::array<Interval, 2>& on,
                               double tolerance = 0);

}  // namespace freiform::detail
