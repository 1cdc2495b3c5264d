// Descartes' rule on parts of [0, 1]: where a polynomial known up to an error has one root, none, or nobody
// knows. Why, and with which errors: roots.cpp.
#pragma once
#include "poly/roots_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/double_double.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform::detail {

inline constexpr double kUnderflow = 0x1p-840;
inline constexpr int kDepth = 52;

// --- the two kinds of numbers ------------------------------------------------------------------------------

inline double high(double x) { return x; }
inline double high(const DoubleDouble& x) { return x.hi; }
inline double mean(double a, double b) { return 0.5 * (a + b); }
inline DoubleDouble mean(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = a + b;
    return {0.5 * s.hi, 0.5 * s.lo};
}
template <class T>
inline constexpr double kUnit = 0;
template <>
inline constexpr double kUnit<double> = kUnitRoundoff;
template <>
inline constexpr double kUnit<DoubleDouble> = 0x1p-100;

// --- signs -------------------------------------------------------------------------------------------------

struct Signs {
    int first = 0, last = 0;  // 0: not certain
    int most = 0;             // variations
    bool all_certain = true;
    double max = 0;
};

template <class T>
Signs signs_of(const T* b, int n, double error) {
    Signs s;
    int last = 0, gap = 0;  // the last certain sign, and how many uncertain ones followed it
    for (int i = 0; i <= n; ++i) {
        const double x = high(b[i]);
        s.max = std::max(s.max, std::abs(x));
        const int sign = x > error ? 1 : x < -error ? -1 : 0;
        if (i == 0) s.first = sign;
        if (sign == 0) {
            ++gap;
            continue;
        }
        // Between two certain signs the number of variations is odd if they differ.
        const bool differ = sign != last;
        s.most += last == 0 ? gap : gap + 1 - ((gap + 1) % 2 != int(differ));
        s.all_certain = s.all_certain && gap == 0;
        last = sign;
        gap = 0;
    }
    s.last = gap == 0 ? last : 0;
    s.most += last == 0 ? std::max(0, gap - 1) : gap;
    s.all_certain = s.all_certain && gap == 0;
    return s;
}

// What is known about a piece.
struct Found {
    Cell cell;
    int most;  // 1 and decided: exactly one root
    bool decided;
    int before, after;  // signs at the ends, 0 if not certain
};

// Depth-first search of a piece.
template <class T>
class RootSearch {
public:
    RootSearch(const T* c, int n, double error, Cell cell) : n_(n) {
        buffer_.assign(c, c + n + 1);
        open_.push_back({cell, error});
    }

    // Appends what it finds, in order, without the pieces that have no roots.
    void run(std::vector<Found>& found) {
        const std::size_t width = std::size_t(n_) + 1;
        while (!open_.empty()) {
            const Open piece = open_.back();
            T* b = buffer_.data() + (open_.size() - 1) * width;
            const Signs s = signs_of(b, n_, piece.error);
            if (s.all_certain && s.most == 0) {
                open_.pop_back();
            } else if (s.first * s.last < 0 && s.most == 1) {
                found.push_back({piece.cell, 1, true, s.first, s.last});
                open_.pop_back();
            } else if (s.max <= 8 * piece.error || piece.cell.depth >= kDepth) {
                found.push_back({piece.cell, s.most, false, s.first, s.last});
                open_.pop_back();
            } else {
                halve(piece, s.max);
            }
        }
    }

private:
    struct Open {
        Cell cell;
        double error;
    };
    // The right half replaces the piece, the left half goes on top of it.
    void halve(const Open& piece, double max) {
        const std::size_t width = std::size_t(n_) + 1, at = (open_.size() - 1) * width;
        if (buffer_.size() < at + 2 * width) buffer_.resize(at + 2 * width);
        T *b = buffer_.data() + at, *left = b + width;
        left[0] = b[0];
        for (int r = 1; r <= n_; ++r) {
            for (int i = 0; i + r <= n_; ++i) b[i] = mean(b[i], b[i + 1]);
            left[r] = b[0];
        }
        const double error = piece.error + 1.01 * n_ * kUnit<T> * max;
        const Cell& c = piece.cell;
        open_.back() = {{2 * c.cell + 1, c.depth + 1}, error};
        open_.push_back({{2 * c.cell, c.depth + 1}, error});
    }

    int n_;
    std::vector<T> buffer_;
    std::vector<Open> open_;
};

}  // namespace freiform::detail
