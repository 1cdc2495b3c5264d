// Determinants without division: over bounded doubles, exact numbers and polynomials alike.
#pragma once
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

namespace freiform {

// Highest order of determinants without division.
inline constexpr int kMaxDivisionFree = 12;

// The determinant of the leading n x n block of a row-major matrix with `stride` columns. By Laplace
// expansion along rows, every minor of the first k rows once: n 2^(n-1) products. REQUIRES 0 <= n <=
// kMaxDivisionFree. T: sums, differences and products; T(1.0) is the unit.
template <class T>
T determinant(std::span<const T> m, int n, int stride) {
    // minor[s]: the determinant of the first |s| rows and the columns in the set s.
    std::vector<T> minor(std::size_t(1) << n);
    minor[0] = T(1.0);
    for (std::size_t s = 1; s < minor.size(); ++s) {
        const int row = std::popcount(s) - 1;
        bool plus = row % 2 == 0;  // the sign of the first column of the set in this row
        bool first = true;
        T sum{};
        for (int c = 0; c < n; ++c) {
            if ((s >> c & 1) == 0) continue;
            const T term = m[std::size_t(row * stride + c)] * minor[s ^ (std::size_t(1) << c)];
            sum = first ? (plus ? term : T{} - term) : plus ? sum + term : sum - term;
            first = false;
            plus = !plus;
        }
        minor[s] = std::move(sum);
    }
    return std::move(minor.back());
}

}  // namespace freiform
