// The sphere that a rational surface lies on.
//
// Idea. For S = X / W and a centre c, |S - c|^2 - r^2 = (|X - c W|^2 - r^2 W^2) / W^2: the numerator is a
// polynomial of twice the degree, whose Bernstein coefficients bound it. Centre and radius come from points
// of the surface; that they are right needs no proof, since the surface is measured against them.
//
// Accuracy. Products of coefficients and their weighted means: 16 (degrees + 4) u of the sum of what was
// added, each without its sign.
#include <freiform/core/constants.hpp>
#include <freiform/query/sphere_of.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace freiform {

namespace {

// How much coefficients i and j of degree n have of coefficient i + j of the product.
double product_share(int n, int i, int j) {
    const auto choose = [](int m, int k) {
        double c = 1;
        for (int l = 1; l <= k; ++l) c = c * (m - k + l) / l;
        return c;
    };
    return choose(n, i) * choose(n, j) / choose(2 * n, i + j);
}

}  // namespace

std::optional<FoundSphere> sphere_through(std::span<const Vec<3>> points) {
    // Of |x|^2 = 2 c . x + k, about the mean of the points.
    Vec<3> mean{};
    for (const Vec<3>& p : points) mean += (1 / double(points.size())) * p;
    double scale = 0;
    for (const Vec<3>& p : points) scale = std::max(scale, max_abs(p - mean));
    if (!(scale > 0)) return std::nullopt;
    std::array<std::array<double, 5>, 4> m{};
    for (const Vec<3>& p : points) {
        const Vec<3> x = (1 / scale) * (p - mean);
        const std::array<double, 5> row{2 * x[0], 2 * x[1], 2 * x[2], 1, dot(x, x)};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 5; ++j) m[i][j] += row[i] * row[j];
    }
    for (std::size_t k = 0; k < 4; ++k) {
        std::size_t pivot = k;
        for (std::size_t r = k + 1; r < 4; ++r)
            if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
        std::swap(m[k], m[pivot]);
        if (!(std::abs(m[k][k]) > 0x1p-30)) return std::nullopt;
        for (std::size_t r = 0; r < 4; ++r)
            if (r != k)
                for (std::size_t c = 5; c-- > k;) m[r][c] -= m[r][k] / m[k][k] * m[k][c];
    }
    const Vec<3> c{{m[0][4] / m[0][0], m[1][4] / m[1][1], m[2][4] / m[2][2]}};
    const double squared = m[3][4] / m[3][3] + dot(c, c);
    if (!(squared > 0)) return std::nullopt;
    FoundSphere found{mean + scale * c, scale * std::sqrt(squared), 0};
    for (const Vec<3>& p : points)
        found.off = std::max(found.off, std::abs(norm(p - found.centre) - found.radius));
    return found;
}

double off_sphere(const Surface<Hom<3>>& surface, const Vec<3>& centre, double radius) {
    const BezierPieces<2, Hom<3>> pieces(surface);
    const int n = pieces.degree(0), m = pieces.degree(1);
    double most = 0;
    each_index(pieces.extent(), [&](const Index<2>& at) {
        const auto net = pieces.net(at);
        const std::size_t width = std::size_t(2 * m + 1);
        std::vector<double> sum(std::size_t(2 * n + 1) * width), size = sum;
        double least = kInfinity, scale = 0;
        each_index(net.extent, [&](const Index<2>& i) {
            least = std::min(least, net(i).weight());
            scale = std::max(scale, max_abs(project(net(i))) + max_abs(centre));
        });
        each_index(net.extent, [&](const Index<2>& i) {
            const Hom<3>& p = net(i);
            const Vec<3> x = p.weight() * (project(p) - centre);
            each_index(net.extent, [&](const Index<2>& j) {
                const Hom<3>& q = net(j);
                const Vec<3> y = q.weight() * (project(q) - centre);
                const double w = p.weight() * q.weight(),
                             share = product_share(n, i[0], j[0]) * product_share(m, i[1], j[1]);
                const std::size_t k = std::size_t(i[0] + j[0]) * width + std::size_t(i[1] + j[1]);
                sum[k] += share * (dot(x, y) - radius * radius * w);
                // Coordinates are off by roundings of their size, not of what is left of it.
                size[k] += share * (w * (scale + radius) * (scale + radius));
            });
        });
        for (std::size_t k = 0; k < sum.size(); ++k)
            most = std::max(
                most, (std::abs(sum[k]) + 16 * (n + m + 4) * kUnitRoundoff * size[k]) / (least * least));
    });
    return 1.01 * most / radius;
}

std::optional<FoundSphere> sphere_of(const Surface<Hom<3>>& surface, double tolerance) {
    std::vector<Vec<3>> points;
    constexpr int kSamples = 4;
    const auto on = surface.domain();
    for (int i = 0; i <= kSamples; ++i)
        for (int j = 0; j <= kSamples; ++j)
            points.push_back(surface(Param<2>{clamped(on[0].lo + on[0].length() * i / kSamples, on[0]),
                                              clamped(on[1].lo + on[1].length() * j / kSamples, on[1])}));
    auto found = sphere_through(points);
    if (!found || !(found->off <= tolerance)) return std::nullopt;
    found->off = off_sphere(surface, found->centre, found->radius);
    if (!(found->off <= tolerance)) return std::nullopt;
    return found;
}

}  // namespace freiform
