// The normal equations of a banded least-squares problem, in skyline form.
#pragma once
#include <freiform/basis/band_map.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace freiform::detail {

// Cholesky factor of A^T A, row by row from the first non-zero on. Fixed unknowns keep their value.
class NormalEquations {
public:
    NormalEquations(const BandMap& a, std::vector<char> fixed) : fixed_(std::move(fixed)) {
        const int n = a.cols;
        first_.resize(std::size_t(n));
        std::iota(first_.begin(), first_.end(), 0);
        each_pair(a, [&](std::size_t i, std::size_t j, double) { first_[i] = std::min(first_[i], int(j)); });
        start_.resize(std::size_t(n) + 1);
        for (std::size_t i = 0; i < std::size_t(n); ++i)
            start_[i + 1] = start_[i] + i + 1 - std::size_t(first_[i]);
        l_.assign(start_.back(), 0.0);
        each_pair(a, [&](std::size_t i, std::size_t j, double x) { at(i, j) += x; });
        for (std::size_t i = 0; i < std::size_t(n); ++i)
            if (fixed_[i]) at(i, i) = 1;
        factor();
    }
    bool ok() const { return ok_; }

    // b := (A^T A)^-1 b for every column of b, whose rows are `run` numbers.
    void solve(double* b, std::size_t run) const {
        const std::size_t n = fixed_.size();
        const auto scale = [&](std::size_t i) {
            for (std::size_t c = 0; c < run; ++c) b[i * run + c] *= 1 / at(i, i);
        };
        const auto subtract = [&](std::size_t i, std::size_t j, double factor) {  // row i -= factor row j
            for (std::size_t c = 0; c < run; ++c) b[i * run + c] -= factor * b[j * run + c];
        };
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = std::size_t(first_[i]); j < i; ++j) subtract(i, j, at(i, j));
            scale(i);
        }
        for (std::size_t i = n; i-- > 0;) {
            scale(i);
            for (std::size_t j = std::size_t(first_[i]); j < i; ++j) subtract(j, i, at(i, j));
        }
    }
    bool fixed(std::size_t i) const { return fixed_[i] != 0; }

private:
    double& at(std::size_t i, std::size_t j) { return l_[start_[i] + j - std::size_t(first_[i])]; }
    double at(std::size_t i, std::size_t j) const { return l_[start_[i] + j - std::size_t(first_[i])]; }
    // f(i, j, A_ki A_kj) for j <= i and every row k; a column that a narrow closed basis meets twice counts
    // twice.
    template <class F>
    void each_pair(const BandMap& a, F&& f) const {
        for (int k = 0; k < a.rows(); ++k) {
            const auto row = a.row(k);
            for (int x = 0; x < a.width; ++x)
                for (int y = 0; y < a.width; ++y) {
                    const auto i = std::size_t((a.first[std::size_t(k)] + x) % a.cols);
                    const auto j = std::size_t((a.first[std::size_t(k)] + y) % a.cols);
                    const double product = row[std::size_t(x)] * row[std::size_t(y)];
                    if (j <= i && product != 0 && !fixed_[i] && !fixed_[j]) f(i, j, product);
                }
        }
    }
    void factor() {
        for (std::size_t i = 0; i + 1 < start_.size(); ++i) {
            for (std::size_t j = std::size_t(first_[i]); j <= i; ++j) {
                double sum = at(i, j);
                for (auto k = std::size_t(std::max(first_[i], first_[j])); k < j; ++k)
                    sum -= at(i, k) * at(j, k);
                if (j < i)
                    at(i, j) = sum / at(j, j);
                else if (!(sum > 0))
                    return;
                else
                    at(i, i) = std::sqrt(sum);
            }
        }
        ok_ = true;
    }

    std::vector<char> fixed_;
    std::vector<int> first_;
    std::vector<std::size_t> start_;
    std::vector<double> l_;
    bool ok_ = false;
};

}  // namespace freiform::detail
