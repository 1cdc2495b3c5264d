// What is asked of a polynomial in Bernstein form on the unit box: is it convex, how low does it come.
#include "query/nearest_form_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/chain.hpp>

namespace freiform::detail {

using Parameters = NearestTree::Parameters;

namespace {

// Second differences along d and e, times the degrees: the least, and the largest absolute one.
struct Bend {
    double least = std::numeric_limits<double>::infinity(), most = 0;
};

Bend bend(const NearestForm& form, int d, int e) {
    const int params = form.params;
    const auto& degree = form.degree;
    const double* f = form.f;
    std::array<int, kMostParams> size{1, 1, 1}, stride{};
    int s = 1;
    for (int k = params - 1; k >= 0; --k) {
        size[std::size_t(k)] = 2 * degree[std::size_t(k)] + 1;
        stride[std::size_t(k)] = s;
        s *= size[std::size_t(k)];
    }
    const int sd = stride[std::size_t(d)], se = stride[std::size_t(e)];
    std::array<int, kMostParams> end = size;
    --end[std::size_t(d)], --end[std::size_t(e)];
    const double m = size[std::size_t(d)] - 1, factor = d == e ? m * (m - 1) : m * (size[std::size_t(e)] - 1);
    Bend b;
    for (int x = 0; x < end[0]; ++x)
        for (int y = 0; y < end[1]; ++y)
            for (int z = 0; z < end[2]; ++z) {
                const double* g = f + x * stride[0] + y * stride[1] + z * stride[2];
                const double v = factor * ((g[sd + se] - g[sd]) - (g[se] - g[0]));
                b.least = std::min(b.least, v);
                b.most = std::max(b.most, std::abs(v));
            }
    return b;
}

}  // namespace

Parameters NearestForm::place(std::size_t i, const Parameters& lo, const Parameters& hi) const {
    Parameters t{};
    for (std::size_t d = std::size_t(params); d-- > 0;) {
        const std::size_t n = std::size_t(2 * degree[d] + 1);
        const double x = n == 1 ? 0.5 : double(i % n) / double(n - 1);
        t[d] = lo[d] + x * (hi[d] - lo[d]);
        i /= n;
    }
    return t;
}

bool NearestForm::convex(double eps) const {
    const int n = params;
    double own[kMostParams], mixed[kMostParams][kMostParams] = {};
    for (int d = 0; d < n; ++d) {
        const double m = 2 * degree[std::size_t(d)];
        if (m < 2) return false;
        own[d] = bend(*this, d, d).least - 8 * eps * m * (m - 1);
        if (!(own[d] > 0)) return false;
    }
    for (int d = 0; d < n; ++d)
        for (int e = 0; e < d; ++e)
            mixed[d][e] = mixed[e][d] =
                bend(*this, d, e).most + 16 * eps * degree[std::size_t(d)] * (2.0 * degree[std::size_t(e)]);
    if (n == 1) return true;
    if (n == 2) return own[0] * own[1] * (1 - 8 * kUnitRoundoff) > mixed[0][1] * mixed[0][1];
    for (int d = 0; d < n; ++d) {  // Gershgorin's circles
        double sum = 0;
        for (int e = 0; e < n; ++e) sum += mixed[d][e];
        if (!(own[d] * (1 - 8 * kUnitRoundoff) > sum)) return false;
    }
    return true;
}

double NearestForm::below_tangent(const Parameters& x, double eps) const {
    const int n = params;
    double size = 0;
    for (int i = 0; i < count; ++i) size = std::max(size, std::abs(f[i]));
    double degrees = 0;
    std::array<int, kMostParams> m{};
    for (std::size_t k = 0; k < std::size_t(n); ++k) {
        m[k] = 2 * degree[k];
        degrees += m[k];
    }
    const std::array<Bernsteins, kMostParams> b{Bernsteins(m[0], x[0]), Bernsteins(m[1], x[1]),
                                                Bernsteins(m[2], x[2])};
    const auto value = [&](int along) {
        double sum = 0;
        std::size_t i = 0;
        for (int x0 = 0; x0 <= m[0]; ++x0) {
            const double w0 = b[0].b[along == 0][x0];
            if (n == 1) {
                sum += w0 * f[i++];
                continue;
            }
            double row = 0;
            for (int x1 = 0; x1 <= m[1]; ++x1) {
                const double w1 = b[1].b[along == 1][x1];
                if (n == 2) {
                    row += w1 * f[i++];
                    continue;
                }
                double line = 0;
                for (int x2 = 0; x2 <= m[2]; ++x2) line += b[2].b[along == 2][x2] * f[i++];
                row += w1 * line;
            }
            sum += w0 * row;
        }
        return sum;
    };
    // Basis values: 3 m roundings each; sums of at most prod (m_d + 1) terms, nested.
    const double noise = eps + 1.01 * (4 * degrees + 4 * n + 4) * kUnitRoundoff * size;
    double low = value(-1) - noise;
    for (int d = 0; d < n; ++d) {
        const std::size_t k = std::size_t(d);
        const double g = value(d), off = 2 * m[k] * noise;
        // min over s in [0, 1] of g (s - x), for all gradients within `off`.
        low += std::min({0.0, -(g + off) * x[k], (g - off) * (1 - x[k])});
    }
    return low;
}

std::optional<Parameters> NearestForm::inner_corner(double eps) const {
    std::optional<Parameters> corner;
    double least = -2 * eps;
    for (unsigned bits = 0; bits < (1u << params); ++bits) {
        std::size_t i = 0;
        Parameters t{};
        for (std::size_t d = 0; d < std::size_t(params); ++d) {
            const bool end = bits >> d & 1;
            const std::size_t m = std::size_t(2 * degree[d]);
            i = i * (m + 1) + (end ? m : 0);
            t[d] = end;
        }
        if (f[i] < least) least = f[i], corner = t;
    }
    return corner;
}

int NearestForm::longest_axis() const {
    int best_axis = 0;
    double most = -1;
    std::size_t stride = std::size_t(count);
    for (int d = 0; d < params; ++d) {
        const std::size_t n = std::size_t(2 * degree[std::size_t(d)] + 1);
        stride /= n;
        double change = 0;
        for (std::size_t i = 0; i < std::size_t(count); ++i)
            if (i / stride % n + 1 < n) change = std::max(change, std::abs(f[i + stride] - f[i]));
        change *= double(n - 1);
        if (change > most) most = change, best_axis = d;
    }
    return best_axis;
}

}  // namespace freiform::detail
