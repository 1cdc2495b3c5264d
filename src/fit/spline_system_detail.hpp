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
    std::span<const double> sites;      // of the points
    int half_width = 0;                 // of the band around the diagonal
    std::vector<Condition> start, end;  // of order given by their index: first the one next to the end
    bool given = false;                 // conditions take values from the data, instead of zero

    int size() const { return basis.size(); }
    int conditions() const { return int(start.size()); }
    int points() const { return int(sites.size()); }
    // The row of a point.
    int row_of(int point) const {
        return point == 0 ? 0 : point == points() - 1 ? size() - 1 : point + conditions();
    }
};

// Values of the basis at sorted sites, one row each. The same numbers as collocation(), in bulk.
BandMap values_at(const BSplineBasis& basis, std::span<const double> sites);

// The same, a few rows at a time, which stay near the processor: calls f(index of the first row, rows).
class ValueRows {
public:
    ValueRows(const BSplineBasis& basis, std::span<const double> sites) : basis_(&basis), sites_(sites) {}
    template <class F>
    void each_block(F&& f) const {
        constexpr std::size_t kBlock = 128;
        BandMap rows{basis_->size(), basis_->degree() + 1, {}, {}};
        int span = basis_->degree();
        for (std::size_t i = 0; i < sites_.size(); i += kBlock) {
            const std::size_t count = sites_.size() - i < kBlock ? sites_.size() - i : kBlock;
            rows.first.resize(count);
            rows.entry.resize(count * std::size_t(rows.width));
            fill(*basis_, sites_.subspan(i, count), span, rows.first.data(), rows.entry.data());
            f(int(i), rows);
        }
    }
    // Rows for these sites; `span` is where the search begins, and where it ended.
    static void fill(const BSplineBasis& basis, std::span<const double> sites, int& span, int* first,
                     double* entry);

private:
    const BSplineBasis* basis_;
    std::span<const double> sites_;
};

// The system for `layers` layers of data. Refuses as interpolate() says.
Result<SplineSystem> spline_system(const AxisSpline& axis, int layers);

}  // namespace freiform::detail
