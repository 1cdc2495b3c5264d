// How far a block is from a quadratic function.
//
// Notation: S = A / w, A the numerator, w the weight; M quadratic along each axis, R = S - M, D = A - w M.
// Idea: where there are weights, D and w, written with two degrees more than A, are blocks, and R = D / w
// lies in the convex hull of the quotients of their coefficients: those of D are means of A_i - w_i b_k, i +
// k = I, by C(p, i) C(2, k) / C(p + 2, I) along each axis, b_k the coefficients of M on the part of the box
// that the block is of, where M is again such a function. Without weights R = D is a block of the degree of
// A. Nothing is lost where weights vary. Derivatives: D and w have derivatives of at most p (p - 1) .. times
// their differences, and by Leibniz, as in block_bounds.cpp, |R_a| <= (|D_a| + sum_{0 < b <= a} C(a, b) |w_b|
// |R_{a-b}|) / w_min. As R is small, so are the terms with w_b: for first differences of D, which are in
// these alone, twice its coefficients will do.
//
// Accuracy: coefficients of the block are off as block_bounds.cpp says; those of D are sums of at most nine
// products, with fewer than 64 roundings, or 16 without weights, of numbers of the size |A_i| + w_i |b_k|. Of
// b_k the size is that of the terms that M is the sum of, which are larger than M where the block reaches far
// beyond the box. All of that counts twice, as M meets S at corners but for as much. n . D is found once for
// each coefficient, and differences are of that: n . D is off by less than sqrt(3) times what coordinates
// are, and by five roundings more, together less than the twice of them, of which bounds along n have two.
// Bulges along axes of degree 1 are no part of blocks without weights: what they are at most is added.
#include "block_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace freiform {

namespace {

constexpr double kLarge = 1e140;  // squares are numbers

// C(p, I - k) C(2, k) / C(p + 2, I) for k = 0, 1, 2.
constexpr std::array<double, 3> shares(int p, int I) {
    const double all = double(p + 2) * (p + 1), left = p + 2 - I;
    return {left * (left - 1) / all, 2 * I * left / all, I * (I - 1.0) / all};
}

// RestTask's numbers that depend on degrees alone: along one axis of at most `kMost` coefficients.
template <int kMost>
struct OfDegree {
    static constexpr std::ptrdiff_t kStride = kernel::lanes_of(kMost);
    double by_row[3 * (kMost + 2)] = {};
    double by_column[3 * kStride] = {}, linear[kStride] = {}, bulges[kStride] = {};

    constexpr void set_rows(int rows) {
        for (int I = 0; I < rows + 2; ++I) {
            const auto share = shares(rows - 1, I);
            for (int k = 0; k < 3; ++k) by_row[3 * I + k] = share[std::size_t(k)];
        }
    }
    constexpr void set_columns(int columns) {
        for (int J = 0; J < columns + 2; ++J) {
            const auto share = shares(columns - 1, J);
            for (int l = std::max(0, J - columns + 1); l <= std::min(2, J); ++l)
                by_column[l * kStride + J - l] = share[std::size_t(l)];
        }
        const double q = columns - 1;
        for (int j = 0; j < columns; ++j) {
            linear[j] = j / q;
            bulges[j] = columns > 2 ? linear[j] * ((q - j) / (q - 1)) : 0;
        }
    }
    void put_rows(kernel::RestTask& task) const { task.share[0] = by_row; }
    void put_columns(kernel::RestTask& task) const {
        task.share[1] = by_column, task.stride = kStride;
        task.linear = linear, task.bulges = bulges;
    }
};

// Of degrees 1 to 3, which most surfaces have.
constexpr int kFew = 4;
constexpr auto kOfFew = [] {
    std::array<OfDegree<kFew>, kFew - 1> out;
    for (int k = 0; k < kFew - 1; ++k) {
        out[std::size_t(k)].set_rows(k + 2);
        out[std::size_t(k)].set_columns(k + 2);
    }
    return out;
}();
#if defined(__wasm__)
constexpr bool is_few(int) { return false; }  // for size
#else
constexpr bool is_few(int count) { return 2 <= count && count <= kFew; }
#endif

// M on a part of the box, or around it. What the terms of its values are together, at most.
double set_part(const BoxQuadratic& m, const std::array<Interval, 2>& part, kernel::RestTask& out) {
    const bool is_all = part[0] == Interval{0, 1} && part[1] == Interval{0, 1};
    double corner = 0, most = 0;
    for (const Vec<3>& c : m.corner) corner = std::max(corner, max_abs(c));
    const double bulge[2] = {max_abs(m.bulge[0]), max_abs(m.bulge[1])};
    for (std::size_t k = 0; k < 4; ++k) {
        const double s = k & 1 ? part[0].hi : part[0].lo, t = k & 2 ? part[1].hi : part[1].lo,
                     u = std::abs(1 - s) + std::abs(s), v = std::abs(1 - t) + std::abs(t);
        const Vec<3> x = is_all ? m.corner[k] : m(s, t);
        for (int d = 0; d < 3; ++d) out.corner[k][d] = x[d];
        const double terms = u * v * corner + u * u * bulge[0] + v * v * bulge[1];
        if (!(terms <= most)) most = terms;
    }
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (int d = 0; d < 3; ++d)
            out.bulge[axis][d] = part[axis].length() * part[axis].length() * m.bulge[axis][d];
    return most;
}

}  // namespace

void include_rest(const BezierBlock& block, const std::array<Interval, 2>& part, const Vec<3>& n,
                  QuadraticFit& fit) {
    const int rows = block.shape().rows, columns = block.shape().columns;
    const bool rational = block.shape().rational;
    kernel::RestTask task;
    task.shape = block.shape();
    task.numbers = block.numbers();
    double of_m = set_part(fit.m, part, task);
    std::optional<OfDegree<kMaxDegree + 1>> other;
    if (!is_few(rows) || !is_few(columns)) other.emplace();
    if (is_few(rows))
        kOfFew[std::size_t(rows - 2)].put_rows(task);
    else
        other->set_rows(rows), other->put_rows(task);
    if (is_few(columns))
        kOfFew[std::size_t(columns - 2)].put_columns(task);
    else
        other->set_columns(columns), other->put_columns(task);
    double left_out = 0;  // bulges that no block of degree 1 has
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (int d = 0; d < 3; ++d) {
            double& x = task.bulge[axis][d];
            of_m += std::abs(x);
            if (!rational && (axis == 0 ? rows : columns) == 2) left_out += std::abs(std::exchange(x, 0));
        }
    for (int d = 0; d < 3; ++d) task.direction[d] = n[d];
    kernel::RestFound found;
    kernel::block_kernels().rest(task, found);
    if (!(std::max(found.largest, found.most_weight) < kLarge && of_m < kLarge &&
          found.least_weight > 1 / kLarge)) {
        fit.all.fill(kInfinity), fit.along.fill(kInfinity);
        return;
    }

    const double steps = 8 + 12 * (rows + columns - 2) + (rational ? 64 : 16),
                 rounding = 2 * steps * kUnitRoundoff,
                 slip = rounding * (found.largest + found.most_weight * of_m),
                 divide = (1 + 1e-13) / (found.least_weight * (1 - rounding));
    // Of the blocks whose differences were looked at.
    const double degree_u = rational ? rows + 1 : rows - 1, degree_v = rational ? columns + 1 : columns - 1,
                 by_u = 1 / (part[0].length() * fit.m.box[0].length()),
                 by_v = 1 / (part[1].length() * fit.m.box[1].length());
    // As in graded order after the values.
    const double factor[5] = {degree_u * by_u, degree_v * by_v, degree_u * by_u * (degree_u - 1) * by_u,
                              degree_u * by_u * degree_v * by_v, degree_v * by_v * (degree_v - 1) * by_v};
    const double unseen[6] = {left_out / 4,
                              left_out * by_u,
                              left_out * by_v,
                              2 * left_out * by_u * by_u,
                              0,
                              2 * left_out * by_v * by_v};
    const auto include = [&](std::array<double, jet_size(2, 2)>& out, double value, int which, double times) {
        std::array<double, 6> r{value * (1 + 1e-13) + times * slip / found.least_weight};
        std::array<double, 6> weight{};
        for (std::size_t k = 0; k < 5; ++k) {
            const double twice = k < 2 ? 2 : 4, *const of = found.of[k];
            weight[k + 1] = factor[k] * (of[2] + twice * rounding * found.most_weight);
            r[k + 1] = factor[k] * (k < 2 ? 2 * r[0] * found.most_weight * (1 + rounding)
                                          : (which == 0 ? std::sqrt(of[0]) : of[1]) + twice * times * slip);
        }
        if (rational) {
            r[1] += weight[1] * r[0], r[2] += weight[2] * r[0];
            r[1] *= divide, r[2] *= divide;
            r[3] += 2 * weight[1] * r[1] + weight[3] * r[0];
            r[4] += weight[1] * r[2] + weight[2] * r[1] + weight[4] * r[0];
            r[5] += 2 * weight[2] * r[2] + weight[5] * r[0];
            for (std::size_t k = 3; k < 6; ++k) r[k] *= divide;
        }
        for (std::size_t k = 0; k < 6; ++k)
            if (const double x = (r[k] + unseen[k]) * (1 + 1e-13); !(x <= out[k])) out[k] = x;
    };
    include(fit.all, std::sqrt(found.square), 0, 1);
    include(fit.along, found.across, 1, 2);
}

}  // namespace freiform
