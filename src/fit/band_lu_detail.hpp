// LU factors of square band matrices, with partial pivoting.
//
// Notation: n unknowns, `below` and `above` the number of diagonals on either side of the main one.
//
// Method: Gaussian elimination inside the band. A row is a contiguous run of 2 below + above + 1 numbers. On
// entry it holds the columns i - below .. i + above; after `factor` the multipliers of column i, the
// reciprocal of the pivot, and the row of U, which interchanges of rows make up to `below` wider. Right-hand
// sides are rows too: n rows of `width` numbers, so all coordinates of a point, or all points of a row of a
// net, are solved for at once. Narrow systems (the cubic splines) go through kernels whose sizes are known to
// the compiler and which carry the rows that are still in use in registers: what is left is the latency of
// one division per row.
//
// Cost: n (below + 1) (below + above) for the factors, n (2 below + above) per column of the right-hand side.
//
// Accuracy: backward stable as partial pivoting is; who uses a solution measures its residual and builds the
// bound on that, not on the solver. References: [Higham 2002, ch. 9], [GolubVanLoan2013, 4.3].
#pragma once
#include <freiform/core/result.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

namespace freiform::detail {

class BandLU {
public:
    // The zero matrix. REQUIRES n >= 1, and below, above in [0, n - 1].
    BandLU(int n, int below, int above)
        : n_(n),
          below_(below),
          above_(above),
          row_(2 * std::size_t(below) + std::size_t(above) + 1),
          a_(std::size_t(n) * row_) {}

    int size() const { return n_; }
    int below() const { return below_; }
    int above() const { return above_; }
    // The entry (i, j) before `factor`. REQUIRES -below <= j - i <= above.
    double& at(int i, int j) {
        FF_REQUIRE(j - i >= -below_ && j - i <= above_);
        return a_[std::size_t(i) * row_ + std::size_t(j - i + below_)];
    }

    // The row without a pivot, where the matrix is singular (or holds NaN).
    std::optional<int> factor() {
        if (below_ == 1 && above_ == 1) return factor_narrow<1, 1>();
        if (below_ == 2 && above_ == 2) return factor_narrow<2, 2>();
        return factor_any();
    }

    // x := A^-1 x, of n rows of `width` numbers each; `more`, if there is any, is one more column of its own.
    // REQUIRES a successful `factor`.
    void solve(double* x, std::size_t width, double* more = nullptr) const {
        if (below_ == 1 && above_ == 1) return solve_narrow<1, 1>(x, width, more);
        if (below_ == 2 && above_ == 2) return solve_narrow<2, 2>(x, width, more);
        solve_any(x, width);
        if (more) solve_any(more, 1);
    }

private:
    double* row(int i) { return a_.data() + std::size_t(i) * row_; }
    const double* row(int i) const { return a_.data() + std::size_t(i) * row_; }
    bool swapped() const { return !swap_.empty(); }
    void mark_swap(int i, int by) {
        if (swap_.empty()) swap_.resize(std::size_t(n_));
        swap_[std::size_t(i)] = by;
    }
    static bool usable(double pivot) { return std::abs(pivot) > 0 && std::isfinite(1 / pivot); }

    std::optional<int> factor_any();
    void solve_any(double* x, std::size_t width) const;

    // A window of KL + 1 rows moves down the matrix; its first column is the one to be eliminated.
    template <int KL, int KU>
    std::optional<int> factor_narrow() {
        constexpr int U = KL + KU;
        double w[KL + 1][U + 1] = {};
        const auto load = [&](int i, int column, double* to) {  // row i from `column` on
            for (int k = 0; k <= U; ++k) to[k] = 0;
            if (i < n_)
                for (int k = std::max(0, column - i + KL); k <= KL + KU; ++k)
                    to[k - (column - i + KL)] = row(i)[k];
        };
        for (int r = 0; r < KL; ++r) load(r, 0, w[r]);
        for (int i = 0; i < n_; ++i) {
            // Row i + KL enters: its columns from i on are all it has.
            if (i + KL < n_) {
                const double* a = row(i + KL);
                for (int k = 0; k <= U; ++k) w[KL][k] = a[k];
            } else {
                for (int k = 0; k <= U; ++k) w[KL][k] = 0;
            }
            int p = 0;
            for (int r = 1; r <= KL; ++r)
                if (std::abs(w[r][0]) > std::abs(w[p][0])) p = r;
            if (p != 0) {
                for (int k = 0; k <= U; ++k) std::swap(w[0][k], w[p][k]);
                mark_swap(i, p);
            }
            if (!usable(w[0][0])) return i;
            const double inverse = 1 / w[0][0];
            double head[U + 1], *out = row(i);
            for (int k = 0; k <= U; ++k) head[k] = w[0][k];
            for (int r = 1; r <= KL; ++r) {
                const double l = w[r][0] * inverse;
                out[r - 1] = l;
                for (int k = 1; k <= U; ++k) w[r - 1][k - 1] = w[r][k] - l * head[k];
                w[r - 1][U] = 0;
            }
            out[KL] = inverse;
            for (int k = 1; k <= U; ++k) out[KL + k] = head[k];
        }
        return std::nullopt;
    }

    template <int KL, int KU>
    void solve_narrow(double* x, std::size_t width, double* more) const {
        switch (width) {
            case 1:
                return solve_rows<KL, KU, 1>(x, more);
            case 2:
                return solve_rows<KL, KU, 2>(x, more);
            case 3:
                return solve_rows<KL, KU, 3>(x, more);
            case 4:
                return solve_rows<KL, KU, 4>(x, more);
            default:
                solve_any(x, width);
                if (more) solve_any(more, 1);
        }
    }
    template <int KL, int KU, int W>
    void solve_rows(double* x, double* more) const {
        // One column more, in a place of its own, costs little beside the others.
        if (more)
            solve_columns<KL, KU>(std::integral_constant<int, W + 1>{}, [=](int i, int c) -> double& {
                return c < W ? x[std::ptrdiff_t(i) * W + c] : more[i];
            });
        else
            solve_columns<KL, KU>(std::integral_constant<int, W>{},
                                  [=](int i, int c) -> double& { return x[std::ptrdiff_t(i) * W + c]; });
    }
    template <int KL, int KU, int C, class X>
    void solve_columns(std::integral_constant<int, C>, X x) const {
        if (swapped()) {
            forward<KL, C, true>(x);
            backward<KL, KL + KU, C>(x);
        } else {  // interchanges alone make U wider than A
            forward<KL, C, false>(x);
            backward<KL, KU, C>(x);
        }
    }
    template <int KL, int C, bool Swapped, class X>
    void forward(X x) const {
        double w[KL + 1][C] = {};
        for (int r = 0; r < KL && r < n_; ++r)
            for (int c = 0; c < C; ++c) w[r][c] = x(r, c);
        for (int i = 0; i < n_; ++i) {
            const double* l = row(i);
            const bool enters = i + KL < n_;
            for (int c = 0; c < C; ++c) w[KL][c] = enters ? x(i + KL, c) : 0;
            if constexpr (Swapped)
                if (const int p = swap_[std::size_t(i)]; p != 0)
                    for (int c = 0; c < C; ++c) std::swap(w[0][c], w[p][c]);
            for (int c = 0; c < C; ++c) {
                const double head = w[0][c];
                x(i, c) = head;
                for (int r = 1; r <= KL; ++r) w[r - 1][c] = w[r][c] - l[r - 1] * head;
            }
        }
    }
    template <int KL, int U, int C, class X>
    void backward(X x) const {
        double w[U + 1][C] = {};
        for (int i = n_; i-- > 0;) {
            const double* u = row(i) + KL;
            for (int c = 0; c < C; ++c) {
                double sum = x(i, c);
                for (int k = U; k >= 1; --k) sum -= u[k] * w[k - 1][c];
                for (int k = U; k >= 1; --k) w[k][c] = w[k - 1][c];
                x(i, c) = w[0][c] = sum * u[0];
            }
        }
    }

    int n_, below_, above_;
    std::size_t row_;
    std::vector<double> a_;
    std::vector<int> swap_;  // row i was exchanged with row i + swap_[i]; empty if none was
};

inline std::optional<int> BandLU::factor_any() {
    const int reach = below_ + above_;
    // Entry (r, i + k) of the part that is left: row r is stored from column r - below on.
    const auto left = [&](int r, int i) { return row(r) + (i - r + below_); };
    for (int i = 0; i < n_; ++i) {
        const int last = std::min(n_ - 1, i + below_);
        int p = i;
        for (int r = i + 1; r <= last; ++r)
            if (std::abs(*left(r, i)) > std::abs(*left(p, i))) p = r;
        const int columns = std::min(reach, n_ - 1 - i);
        if (p != i) {
            // What the rows hold of the columns i .. i + reach; beyond their own ends they hold zeros.
            for (int k = 0; k <= columns; ++k) std::swap(left(i, i)[k], left(p, i)[k]);
            mark_swap(i, p - i);
        }
        const double pivot = *left(i, i);
        if (!usable(pivot)) return i;
        const double inverse = 1 / pivot;
        for (int r = i + 1; r <= last; ++r) {
            const double l = *left(r, i) * inverse;
            row(i)[r - i - 1] = l;
            if (l != 0)
                for (int k = 1; k <= columns; ++k) left(r, i)[k] -= l * left(i, i)[k];
        }
        *left(i, i) = inverse;
    }
    return std::nullopt;
}

inline void BandLU::solve_any(double* x, std::size_t width) const {
    const auto at = [&](int i) { return x + std::size_t(i) * width; };
    const auto subtract = [&](double* to, double f, const double* from) {
        for (std::size_t c = 0; c < width; ++c) to[c] -= f * from[c];
    };
    for (int i = 0; i < n_; ++i) {
        if (const int p = swapped() ? swap_[std::size_t(i)] : 0; p != 0)
            std::swap_ranges(at(i), at(i) + width, at(i + p));
        for (int r = 1; r <= below_ && i + r < n_; ++r)
            if (const double l = row(i)[r - 1]; l != 0) subtract(at(i + r), l, at(i));
    }
    const int reach = swapped() ? below_ + above_ : above_;
    for (int i = n_; i-- > 0;) {
        const double* u = row(i) + below_;
        for (int k = std::min(reach, n_ - 1 - i); k >= 1; --k)
            if (u[k] != 0) subtract(at(i), u[k], at(i + k));
        double* own = at(i);
        for (std::size_t c = 0; c < width; ++c) own[c] *= u[0];
    }
}

}  // namespace freiform::detail
