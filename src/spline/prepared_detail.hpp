// The tables behind PreparedPatch, and their view for the kernels.
#pragma once
#include "kernel/evaluate.hpp"

#include <freiform/spline/prepared.hpp>

#include <vector>

namespace freiform::detail {

struct AxisTable {
    BSplineBasis basis;
    kernel::Axis axis;  // without pointers
    std::vector<kernel::Span> spans;
    std::vector<double> matrix, starts;
    std::vector<int> bucket;

    kernel::Axis view() const;
};

// The rows of matrices of `basis`; of a curve, its coordinates: `curve` is then the coefficients in places of
// `lanes` numbers.
AxisTable make_axis(const BSplineBasis& basis, std::span<const double> curve, int lanes);

struct PreparedNet::Tables {
    std::vector<AxisTable> axis;
    kernel::Net net;  // without pointers
    std::vector<double> coefficients;
    double error = 0;

    kernel::Net view() const;
    bool any_closed() const;
};

// A bound of the rounding of a value, argument in prepared_tables.cpp.
double batch_error_bound(std::span<const int> degrees, const Tuples& net);

}  // namespace freiform::detail
