// Small systems with a positive definite matrix.
#pragma once
#include <cmath>
#include <cstddef>

namespace freiform::detail {

// Cholesky's method on the lower half of the leading n x n block of h, which is overwritten: x becomes the
// solution for the right-hand side x. False: not positive definite, clear of rounding; x is as it was.
template <class Matrix, class Vector>
bool solve_cholesky(Matrix& h, std::size_t n, Vector& x) {
    for (std::size_t d = 0; d < n; ++d)
        for (std::size_t e = 0; e <= d; ++e) {
            double v = h[d][e];
            for (std::size_t k = 0; k < e; ++k) v -= h[d][k] * h[e][k];
            if (d == e && !(v > 1e-14 * std::abs(h[d][d]))) return false;
            h[d][e] = d == e ? std::sqrt(v) : v / h[e][e];
        }
    for (std::size_t d = 0; d < n; ++d) {
        for (std::size_t k = 0; k < d; ++k) x[d] -= h[d][k] * x[k];
        x[d] /= h[d][d];
    }
    for (std::size_t d = n; d-- > 0;) {
        for (std::size_t k = d + 1; k < n; ++k) x[d] -= h[k][d] * x[k];
        x[d] /= h[d][d];
    }
    return true;
}

}  // namespace freiform::detail
