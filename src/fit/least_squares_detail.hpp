// Least squares on one basis: the matrix once, any number of right-hand sides.
#pragma once
#include "band_system_detail.hpp"
#include "spline_system_detail.hpp"

namespace freiform::detail {

struct KeptRow {
    double at = 0;
    int order = 0;
};

class LeastSquaresSystem {
public:
    struct Smoothing {
        double factor = 0;
        int order = 2;
    };
    // `values`: a row for each point. `weights`: one for each point, or none.
    LeastSquaresSystem(const BSplineBasis& basis, BandMap values, std::span<const double> weights,
                       std::span<const KeptRow> kept, Smoothing smoothing);
    // Place of what is not determined: row number of the system.
    std::optional<int> factor() { return system_.factor(); }
    // coefficients := the solution, `width` columns; points and kept values likewise. Refined once, or not.
    void solve(const double* points, const double* kept, double* coefficients, std::size_t width,
               bool refine) const;
    const BandMap& values() const { return values_; }

private:
    void solve_once(const double* gradient, const double* defect, double* coefficients, double* multipliers,
                    std::size_t width) const;

    int n_;
    BandMap values_, kept_, penalty_;      // penalty: weighted rows of the derivative at Gauss points
    std::vector<double> weight_, scale_;   // scale_: of the rows of kept_
    std::vector<int> place_, multiplier_;  // in the system: of each coefficient, of each kept row
    BandSystem system_;
};

// Whether points at these sorted sites (and values kept at `kept`) determine a spline of the basis: every
// function must find a site of its own inside its support.
Result<void> check_determined(const BSplineBasis& basis, std::span<const double> sites,
                              std::span<const KeptRow> kept);

// Nodes and weights of the Gauss quadrature with n nodes on [-1, 1].
struct Quadrature {
    std::vector<double> node, weight;
};
Quadrature gauss_legendre(int n);

// Rows of derivatives of one order at sorted sites, wrapped.
BandMap rows_at(const BSplineBasis& basis, std::span<const KeptRow> rows);

}  // namespace freiform::detail
