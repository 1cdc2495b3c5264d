// The linear system of a spline through points along one axis: basis, rows, and what stands where.
#pragma once
#include <freiform/fit/interpolate.hpp>

namespace freiform::detail {

// Rows of the system, k of them at each end for conditions that are no points:
//     value 0 | conditions 1 .. k | value 1 .. value m - 2 | conditions k .. 1 | value m - 1
// In this order row i has its entries around column i. Closed systems and not-a-knot ones have values alone.
struct SplineSystem {
    struct Condition {
        int order = 0;
        double scale = 1;           // power of two that makes the row's entries about 1
        std::vector<double> entry;  // scaled; in the first or the last degree + 1 columns
    };
    BSplineBasis basis;
    BandMap values;                     // one row for each point
    std::vector<Condition> start, end;  // of order given by their index: first the one next to the end
    bool given = false;                 // conditions take values from the data, instead of zero

    int size() const { return basis.size(); }
    int conditions() const { return int(start.size()); }
    int points() const { return values.rows(); }
    // The row of a point.
    int row_of(int point) const {
        return point == 0 ? 0 : point == points() - 1 ? size() - 1 : point + conditions();
    }
};

// Values of the basis at sorted sites, one row each. The same numbers as collocation(), in bulk.
BandMap values_at(const BSplineBasis& basis, std::span<const double> sites);

// The system for `layers` layers of data. Refuses as interpolate() says.
Result<SplineSystem> spline_system(const AxisSpline& axis, int layers);

}  // namespace freiform::detail
