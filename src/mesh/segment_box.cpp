// A segment misses a box if an axis separates them: x, y, or the normal of the segment, tested with a slack
// for the rounding of the products.
#include <freiform/core/constants.hpp>
#include <freiform/mesh/segment_box.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

bool meets(const Box<2>& box, const Vec<2>& p, const Vec<2>& q) {
    for (int i = 0; i < 2; ++i)
        if (std::max(p[i], q[i]) < box.lo[i] || std::min(p[i], q[i]) > box.hi[i]) return false;
    const Vec<2> d = q - p;
    int left = 0, right = 0;
    for (int k = 0; k < 4; ++k) {
        const Vec<2> corner{{k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1]}};
        const double side = cross(d, corner - p),
                     slack = 1e-12 * (std::abs(d[0]) + std::abs(d[1])) * (max_abs(corner - p) + max_abs(d));
        left += side >= -slack;
        right += side <= slack;
    }
    return left > 0 && right > 0;
}

PolygonRows::PolygonRows(std::span<const Vec<2>> polygon, std::span<const std::array<int, 2>> segments) {
    constexpr double kSidesOfRow = 4, kMostRows = 4096;
    if (segments.empty()) return;
    double lowest = kInfinity, highest = -kInfinity, heights = 0;
    const auto side_of = [&](const std::array<int, 2>& s) {
        return std::array{polygon[std::size_t(s[0])], polygon[std::size_t(s[1])]};
    };
    for (const auto& s : segments) {
        const auto [p, q] = side_of(s);
        lowest = std::min({lowest, p[1], q[1]}), highest = std::max({highest, p[1], q[1]});
        heights += std::abs(q[1] - p[1]);
    }
    // High sides are in many rows.
    const double sides = double(segments.size()), height = highest - lowest,
                 rows = std::min({sides / kSidesOfRow, kSidesOfRow * sides * (height / heights), kMostRows});
    const std::size_t count = rows >= 1 ? std::size_t(rows) : 1;
    lowest_ = lowest;
    if (double(count) / height < kInfinity) scale_ = double(count) / height;
    first_.assign(count + 1, 0);
    const auto each_row = [&](const std::array<Vec<2>, 2>& side, auto&& visit) {
        const double a = side[0][1], b = side[1][1];
        for (std::size_t row = row_of(std::min(a, b)), last = row_of(std::max(a, b)); row <= last; ++row)
            visit(row);
    };
    for (const auto& s : segments) each_row(side_of(s), [&](std::size_t row) { ++first_[row + 1]; });
    for (std::size_t row = 0; row < count; ++row) first_[row + 1] += first_[row];
    sides_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& s : segments) {
        const auto side = side_of(s);
        each_row(side, [&](std::size_t row) { sides_[next[row]++] = side; });
    }
}

// Grows with y, rounded as it may be, so the row of y has all sides that reach it.
std::size_t PolygonRows::row_of(double y) const {
    const double row = (y - lowest_) * scale_;
    return row > 0 ? std::size_t(std::min(row, double(first_.size() - 2))) : 0;
}

bool PolygonRows::is_inside(const Vec<2>& x) const {
    bool in = false;
    if (first_.empty()) return in;
    const std::size_t row = row_of(x[1]);
    for (std::size_t i = first_[row]; i < first_[row + 1]; ++i) {
        const auto& [p, q] = sides_[i];
        if ((p[1] > x[1]) == (q[1] > x[1])) continue;
        if (x[0] < p[0] + (x[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])) in = !in;
    }
    return in;
}

}  // namespace freiform
