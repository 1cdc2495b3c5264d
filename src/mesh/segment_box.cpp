// A segment misses a box if an axis separates them: x, y, or the normal of the segment, tested with a slack
// for the rounding of the products.
#include <freiform/mesh/segment_box.hpp>

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

bool is_inside(const Vec<2>& x, std::span<const Vec<2>> polygon,
               std::span<const std::array<int, 2>> segments) {
    bool in = false;
    for (const auto& s : segments) {
        const Vec<2>&p = polygon[std::size_t(s[0])], &q = polygon[std::size_t(s[1])];
        if ((p[1] > x[1]) == (q[1] > x[1])) continue;
        if (x[0] < p[0] + (x[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])) in = !in;
    }
    return in;
}

}  // namespace freiform
