// What is asked of a polynomial in Bernstein form on the unit box: is it convex, how low does it come.
#include "query/nearest_form_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/chain.hpp>

namespace freiform::detail {

using Parameters = NearestTree::Parameters;

namespace {

// F as [outer][size][inner] with axis d in the middle.
struct Sides {
    int outer = 1, size = 1, inner = 1;
};
Sides sides(const NearestForm& form, int d) {
    Sides s;
    for (int k = 0; k < form.params; ++k)
        (k < d ? s.outer : k == d ? s.size : s.inner) *= 2 * form.degree[std::size_t(k)] + 1;
    return s;
}

// The range of f(0) .. f(count - 1), of none: 0 to 0. Four at a time do not wait for each other.
template <class F>
void widen(Interval& range, int count, F&& f) {
    double lo[4], hi[4];
    for (int k = 0; k < 4; ++k) lo[k] = range.lo, hi[k] = range.hi;
    int i = 0;
    for (; i + 4 <= count; i += 4)
        for (int k = 0; k < 4; ++k) {
            const double v = f(i + k);
            lo[k] = v < lo[k] ? v : lo[k];
            hi[k] = v > hi[k] ? v : hi[k];
        }
    for (; i < count; ++i) {
        const double v = f(i);
        lo[0] = v < lo[0] ? v : lo[0];
        hi[0] = v > hi[0] ? v : hi[0];
    }
    range.lo = std::min(std::min(lo[0], lo[1]), std::min(lo[2], lo[3]));
    range.hi = std::max(std::max(hi[0], hi[1]), std::max(hi[2], hi[3]));
}

constexpr Interval kNothing{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};

// Second differences along the axis d.
Interval own_bend(const NearestForm& form, int d) {
    const Sides s = sides(form, d);
    Interval range = kNothing;
    for (int o = 0; o < s.outer; ++o) {
        const double* g = form.f + o * s.size * s.inner;
        widen(range, (s.size - 2) * s.inner,
              [&](int i) { return (g[i + 2 * s.inner] - g[i + s.inner]) - (g[i + s.inner] - g[i]); });
    }
    return range;
}
// Along d, then e > d.
Interval mixed_bend(const NearestForm& form, int d, int e) {
    const Sides s = sides(form, d), r = sides(form, e);
    Interval range = kNothing;
    for (int o = 0; o < s.outer; ++o)
        for (int i = 0; i + 1 < s.size; ++i)
            for (int q = 0; q < s.inner; q += r.size * r.inner) {
                const double *g = form.f + (o * s.size + i) * s.inner + q, *h = g + s.inner;
                widen(range, (r.size - 1) * r.inner,
                      [&](int k) { return (h[k + r.inner] - g[k + r.inner]) - (h[k] - g[k]); });
            }
    return range;
}

}  // namespace

NearestForm::Extreme NearestForm::least() const {
    double lo[4] = {f[0], f[0], f[0], f[0]};
    int i = 0;
    for (; i + 4 <= count; i += 4)
        for (int k = 0; k < 4; ++k) lo[k] = f[i + k] < lo[k] ? f[i + k] : lo[k];
    for (; i < count; ++i) lo[0] = f[i] < lo[0] ? f[i] : lo[0];
    const double value = std::min(std::min(lo[0], lo[1]), std::min(lo[2], lo[3]));
    std::size_t at = 0;
    if (!(value > 0))
        while (at + 1 < std::size_t(count) && f[at] != value) ++at;
    return {value, at};
}

NearestForm::Extreme NearestForm::most() const {
    const double* at = std::max_element(f, f + count);
    return {*at, std::size_t(at - f)};
}

Interval NearestForm::slope(int axis) const {
    const Sides s = sides(*this, axis);
    Interval range = kNothing;
    for (int o = 0; o < s.outer; ++o) {
        const double* g = f + o * s.size * s.inner;
        widen(range, (s.size - 1) * s.inner, [&](int i) { return g[i + s.inner] - g[i]; });
    }
    return range;
}

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
    double own[kMostParams], mixed[kMostParams][kMostParams] = {};
    int axes[kMostParams], n = 0;  // those that F depends on
    for (int d = 0; d < params; ++d)
        if (degree[std::size_t(d)] > 0) axes[n++] = d;
    for (int a = 0; a < n; ++a) {
        const double m = 2 * degree[std::size_t(axes[a])];
        own[a] = m * (m - 1) * (own_bend(*this, axes[a]).lo - 8 * eps);
        if (!(own[a] > 0)) return false;
    }
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < a; ++b) {
            const Interval range = mixed_bend(*this, axes[b], axes[a]);
            mixed[a][b] = mixed[b][a] = 4.0 * degree[std::size_t(axes[a])] * degree[std::size_t(axes[b])] *
                                        (std::max(-range.lo, range.hi) + 8 * eps);
        }
    if (n < 2) return true;
    if (n == 2) return own[0] * own[1] * (1 - 8 * kUnitRoundoff) > mixed[0][1] * mixed[0][1];
    for (int a = 0; a < n; ++a) {  // Gershgorin's circles
        double sum = 0;
        for (int b = 0; b < n; ++b) sum += mixed[a][b];
        if (!(own[a] * (1 - 8 * kUnitRoundoff) > sum)) return false;
    }
    return true;
}

bool NearestForm::concave_along(int axis, double eps) const { return own_bend(*this, axis).hi < -8 * eps; }

// h_dd h_ee < h_de^2 with the largest h_dd and h_ee of both, and the least |h_de|; with the factors of the
// degrees.
bool NearestForm::is_saddle(const NearestForm& g, int d, int e, double eps) const {
    const double m = 2.0 * degree[std::size_t(d)], n = 2.0 * degree[std::size_t(e)];
    const auto largest = [&](int axis) {
        return std::max({own_bend(*this, axis).hi + 8 * eps, own_bend(g, axis).hi + 8 * eps, 0.0});
    };
    const int first = std::min(d, e), second = std::max(d, e);
    const Interval mixed = hull(mixed_bend(*this, first, second), mixed_bend(g, first, second));
    const double least = m * n * (std::max(mixed.lo, -mixed.hi) - 8 * eps);
    const double own = (m * (m - 1) * largest(d)) * (n * (n - 1) * largest(e));
    return least > 0 && least * least * (1 - 8 * kUnitRoundoff) > own;
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

}  // namespace freiform::detail
