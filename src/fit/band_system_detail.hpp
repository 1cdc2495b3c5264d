// Square systems whose entries lie near the diagonal, perhaps around the corner: what splines through points,
// open and closed, are solved with.
//
// Method: An open system is a band matrix. In a closed one the last K unknowns, K the larger half-width of
// the band, couple to both ends; with them set apart,
//     [ B  E ] [ x ]   [ f ]        B Y = E,  B z = f,  (G - F Y) y = g - F z,  x = z - Y y,
//     [ F  G ] [ y ] = [ g ]
// B is a band matrix, and only K more right-hand sides are needed. A closed system of few unknowns, where the
// ends overlap, is solved as a full matrix.
//
// Accuracy: that of BandLU for B and for the small matrix G - F Y. B is a principal part of the matrix: for
// sites that interlace with the knots it is not singular either (Schoenberg and Whitney).
#pragma once
#include "band_lu_detail.hpp"

namespace freiform::detail {

class BandSystem {
public:
    // The zero matrix of n rows. Entries are at |j - i| within the band, j modulo n if closed.
    BandSystem(int n, int below, int above, bool closed)
        : n_(n),
          border_(border(n, below, above, closed)),
          full_(closed && border_ == 0),
          band_(n - border_, full_ ? n - 1 : std::min(below, n - border_ - 1),
                full_ ? n - 1 : std::min(above, n - border_ - 1)),
          e_(std::size_t(n - border_) * std::size_t(border_)),
          f_(std::size_t(n - border_) * std::size_t(border_)),
          g_(std::max(border_, 1), std::max(border_, 1) - 1, std::max(border_, 1) - 1) {}

    int size() const { return n_; }
    // Adds x to the entry (i, j). REQUIRES 0 <= i < n; j is taken modulo n if the system is closed.
    void add(int i, int j, double x) {
        if (border_ == 0 && !full_) {
            band_.at(i, j) += x;
            return;
        }
        j = ((j % n_) + n_) % n_;
        const int inner = n_ - border_;
        if (i < inner && j < inner)
            band_.at(i, j) += x;
        else if (i < inner)
            e_[std::size_t(i) * std::size_t(border_) + std::size_t(j - inner)] += x;
        else if (j < inner)
            f_[std::size_t(i - inner) * std::size_t(inner) + std::size_t(j)] += x;
        else
            g_.at(i - inner, j - inner) += x;
    }
    // The row that is (nearly) a combination of the rows before it, where the matrix is singular.
    std::optional<int> factor() {
        if (const auto bad = band_.factor()) return bad;
        if (border_ == 0) return std::nullopt;
        const int inner = n_ - border_;
        band_.solve(e_.data(), std::size_t(border_));  // now Y
        for (int r = 0; r < border_; ++r)
            for (int c = 0; c < border_; ++c) {
                double sum = 0;
                for (int k = 0; k < inner; ++k) sum += f(r, k) * y_of(k, c);
                g_.at(r, c) -= sum;
            }
        if (const auto bad = g_.factor()) return inner + *bad;
        return std::nullopt;
    }
    // x := A^-1 x, of n rows of `width` numbers each; `more`, if there is any, is one more column of its own.
    // REQUIRES a successful `factor`.
    void solve(double* x, std::size_t width, double* more = nullptr) const {
        band_.solve(x, width, more);
        if (border_ == 0) return;
        finish(x, width);
        if (more) finish(more, 1);
    }

private:
    // The border, after the band.
    void finish(double* x, std::size_t width) const {
        const int inner = n_ - border_;
        double* y = x + std::size_t(inner) * width;
        for (int r = 0; r < border_; ++r)
            for (int k = 0; k < inner; ++k)
                if (const double a = f(r, k); a != 0)
                    for (std::size_t c = 0; c < width; ++c)
                        y[std::size_t(r) * width + c] -= a * x[std::size_t(k) * width + c];
        g_.solve(y, width);
        for (int k = 0; k < inner; ++k)
            for (int r = 0; r < border_; ++r)
                if (const double a = y_of(k, r); a != 0)
                    for (std::size_t c = 0; c < width; ++c)
                        x[std::size_t(k) * width + c] -= a * y[std::size_t(r) * width + c];
    }

    static int border(int n, int below, int above, bool closed) {
        const int k = std::max(below, above);
        return closed && n > 4 * k + 4 ? k : 0;
    }
    double y_of(int k, int c) const { return e_[std::size_t(k) * std::size_t(border_) + std::size_t(c)]; }
    double f(int r, int k) const { return f_[std::size_t(r) * std::size_t(n_ - border_) + std::size_t(k)]; }

    int n_, border_;
    bool full_;
    BandLU band_;
    std::vector<double> e_, f_;  // e_: inner x border, becomes Y; f_: border x inner
    BandLU g_;
};

}  // namespace freiform::detail
