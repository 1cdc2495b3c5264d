// Cells of the parameter domain with the Bernstein coefficients of a function of two parameters on them, and
// what can be told from the coefficients alone.
//
// Notation. Places: a parameter counted in Bezier pieces, 2.25 is a quarter into the piece with index 2.
// Along a cyclic axis of n pieces, x and x + n are one place. The lines of the grid avoid knots, so a cell
// may hold parts of several pieces; the function is continuous over a cell.
//
// Accuracy. A cut at t leaves split_error(n) of the largest coefficient; t itself has two roundings, which
// move the coefficients by no more than 2 n times as much. 12 n u together.
#pragma once
#include "arc_pieces_detail.hpp"

namespace freiform::detail {

using Place = std::array<double, 2>;

struct LevelBlock {
    std::array<Interval, 2> on{};
    Index<2> degree{};
    std::vector<double> c;  // row-major
    double error = 0;       // of each

    double coefficient(int i, int j) const { return c[std::size_t(i * (degree[1] + 1) + j)]; }
    double most() const {
        double m = 0;
        for (const double x : c) m = std::max(m, std::abs(x));
        return m;
    }
    NetView<2, double> net() {
        return {c.data(), {degree[0] + 1, degree[1] + 1}, {std::ptrdiff_t(degree[1] + 1), 1}};
    }
    bool contains(const Place& x) const { return on[0].contains(x[0]) && on[1].contains(x[1]); }
};

// Both sides of the line where the place along `axis` is `at`.
inline std::array<LevelBlock, 2> cut(const LevelBlock& b, int axis, double at) {
    const std::size_t k = std::size_t(axis);
    std::array<LevelBlock, 2> out{b, b};
    const double t = (at - b.on[k].lo) / b.on[k].length();
    each_fibre(axis, Index<2>{b.degree[0] + 1, b.degree[1] + 1}, [&](const Index<2>& i) {
        keep_left(out[0].net().fibre(axis, i), t);
        keep_right(out[1].net().fibre(axis, i), t);
    });
    out[0].on[k].hi = out[1].on[k].lo = at;
    out[0].error = out[1].error = 1.01 * (b.error + 12 * b.degree[k] * kUnitRoundoff * b.most()) + 0x1p-1060;
    return out;
}
inline LevelBlock part_of(LevelBlock b, const std::array<Interval, 2>& box) {
    for (int axis = 0; axis < 2; ++axis) {
        const Interval on = box[std::size_t(axis)];
        if (on.hi < b.on[std::size_t(axis)].hi) b = cut(b, axis, on.hi)[0];
        if (on.lo > b.on[std::size_t(axis)].lo) b = cut(b, axis, on.lo)[1];
    }
    return b;
}

// The function divided by its distance (in places) from a side of the block on which its coefficients are 0.
inline void deflate(LevelBlock& b, int axis, int side) {
    const std::size_t k = std::size_t(axis);
    LevelBlock out = b;
    const int n = b.degree[k];
    out.degree[k] = n - 1;
    out.c.assign(std::size_t((out.degree[0] + 1) * (out.degree[1] + 1)), 0.0);
    each_index(Index<2>{out.degree[0] + 1, out.degree[1] + 1}, [&](const Index<2>& at) {
        Index<2> from = at;
        from[k] += side == 0;
        out.net()(at) = b.net()(from) * n / (side == 0 ? at[k] + 1 : n - at[k]);
    });
    out.error = 1.01 * n * (b.error + 2 * kUnitRoundoff * b.most());
    b = std::move(out);
}
inline bool is_zero_side(const LevelBlock& b, int axis, int side) {
    const std::size_t k = std::size_t(axis);
    bool zero = true;
    each_index(Index<2>{b.degree[0] + 1, b.degree[1] + 1}, [&](const Index<2>& at) {
        if (at[k] == (side == 0 ? 0 : b.degree[k])) zero = zero && b.coefficient(at[0], at[1]) == 0;
    });
    return zero;
}

// +1 or -1 where all numbers have that sign by more than an error.
class SignSeen {
public:
    void add(double x, double error) { positive_ &= x > error, negative_ &= x < -error; }
    int sign() const { return positive_ == negative_ ? 0 : positive_ ? 1 : -1; }

private:
    bool positive_ = true, negative_ = true;  // both: nothing seen
};

struct LevelCell {
    std::array<Interval, 2> on{};
    std::vector<LevelBlock> blocks;

    // Of the function all over the cell.
    int sign() const {
        SignSeen s;
        for (const LevelBlock& b : blocks)
            for (const double x : b.c) s.add(x, b.error);
        return s.sign();
    }
    // Of the derivative along an axis; where the function has kinks, on both sides of them.
    int slope_sign(int axis) const {
        SignSeen s;
        for (const LevelBlock& b : blocks)
            add_slopes(
                b, axis, [](const Index<2>&) { return true; }, s);
        return s.sign();
    }
    // The function along a side has one sign, or is monotone.
    bool is_simple_side(int axis, int side) const {
        const std::size_t k = std::size_t(axis);
        SignSeen value, slope;
        for (const LevelBlock& b : blocks) {
            if (side == 0 ? b.on[k].lo != on[k].lo : b.on[k].hi != on[k].hi) continue;
            const auto there = [&](const Index<2>& at) { return at[k] == (side == 0 ? 0 : b.degree[k]); };
            each_index(Index<2>{b.degree[0] + 1, b.degree[1] + 1}, [&](const Index<2>& at) {
                if (there(at)) value.add(b.coefficient(at[0], at[1]), b.error);
            });
            add_slopes(b, 1 - axis, there, slope);
        }
        return value.sign() != 0 || slope.sign() != 0;
    }
    // The axis along which the function is monotone, if the topology in the cell is that of one arc or none;
    // -1 if that is not known. Solutions are a graph over the other axis, over the interval where the
    // function is <= 0 on one of the sides across and >= 0 on the other: an intersection of two intervals.
    int simple_axis() const {
        for (int axis = 0; axis < 2; ++axis)
            if (slope_sign(axis) != 0 && is_simple_side(axis, 0) && is_simple_side(axis, 1)) return axis;
        return -1;
    }

    const LevelBlock& block_at(const Place& x) const {
        for (const LevelBlock& b : blocks)
            if (b.contains(x)) return b;
        return blocks.front();  // beside the cell by rounding
    }
    // The sign at a place, where it is certain.
    int sign_at(const Place& x) const {
        for (const LevelBlock& b : blocks) {
            if (!b.contains(x)) continue;
            const LevelBlock p = part_of(b, {Interval{x[0], x[0]}, Interval{x[1], x[1]}});
            if (std::abs(p.c[0]) > p.error) return p.c[0] > 0 ? 1 : -1;
        }
        return 0;
    }
    int corner_sign(int side0, int side1) const {
        const Place x{side0 ? on[0].hi : on[0].lo, side1 ? on[1].hi : on[1].lo};
        for (const LevelBlock& b : blocks) {
            if (!b.contains(x)) continue;
            const double c = b.coefficient(side0 ? b.degree[0] : 0, side1 ? b.degree[1] : 0);
            if (std::abs(c) > b.error) return c > 0 ? 1 : -1;
        }
        return 0;
    }

private:
    template <class F>
    static void add_slopes(const LevelBlock& b, int axis, F&& which, SignSeen& s) {
        const std::size_t k = std::size_t(axis);
        if (b.degree[k] == 0) s.add(0, 0);
        Index<2> extent{b.degree[0] + 1, b.degree[1] + 1};
        --extent[k];
        each_index(extent, [&](const Index<2>& at) {
            if (!which(at)) return;
            Index<2> next = at;
            ++next[k];
            s.add(b.coefficient(next[0], next[1]) - b.coefficient(at[0], at[1]),
                  2.02 * b.error + 4 * kUnitRoundoff * std::abs(b.coefficient(at[0], at[1])));
        });
    }
};

// Value and derivatives by places, in plain doubles.
struct LevelValue {
    double value = 0;
    Place slope{};
};
inline LevelValue level_value(const LevelBlock& b, const Place& x) {
    const int n = b.degree[0], m = b.degree[1];
    const double s = (x[0] - b.on[0].lo) / b.on[0].length(), t = (x[1] - b.on[1].lo) / b.on[1].length();
    // Rows collapse along the second axis, to values and slopes; then these along the first.
    const auto collapse = [](double* p, int degree, double at, double& slope) {
        slope = 0;
        for (int r = 1; r <= degree; ++r) {
            if (r == degree) slope = degree * (p[1] - p[0]);
            for (int k = 0; k <= degree - r; ++k) p[k] = (1 - at) * p[k] + at * p[k + 1];
        }
        return p[0];
    };
    std::array<double, kMaxDegree + 1> row, value, slope;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) row[std::size_t(j)] = b.coefficient(i, j);
        value[std::size_t(i)] = collapse(row.data(), m, t, slope[std::size_t(i)]);
    }
    LevelValue out;
    double ignored;
    out.slope[1] = collapse(slope.data(), n, s, ignored) / b.on[1].length();
    out.value = collapse(value.data(), n, s, out.slope[0]);
    out.slope[0] /= b.on[0].length();
    return out;
}

}  // namespace freiform::detail
