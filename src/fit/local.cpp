// Notation: Q_i points at t_i, h_i = t_{i+1} - t_i, d_i = (Q_{i+1} - Q_i) / h_i, v_i the derivative at Q_i.
//
// Method: A cubic piece from Q_i to Q_{i+1} has the Bezier coefficients
//     Q_i,  P+ = Q_i + h_i v_i / 3,  P- = Q_{i+1} - h_i v_{i+1} / 3,  Q_{i+1}.
// Catmull-Rom: v_i = (h_i d_{i-1} + h_{i-1} d_i) / (h_{i-1} + h_i), the slope of the parabola through three
// points [Barry & Goldman 1988]. With a = h_{i-1}, b = h_i, s = a + b the weights of Q_{i-1} and Q_{i+1} are
//     in P+_i:  -b^2 / (3 a s),  a / (3 s)        in P-_i:  b / (3 s),  -a^2 / (3 b s)
// and that of Q_i what is missing to 1. Uniform: -1/6, 1, 1/6.
// Akima: v_i = (|d_{i+1} - d_i| d_{i-1} + |d_{i-1} - d_{i-2}| d_i) / (sum of the two), the mean of d_{i-1}
// and d_i where the sum is 0; beyond open ends d continues linearly [Akima 1970]. Monotone: v_i = 0 where d
// changes sign or vanishes, else the harmonic mean of d_{i-1} and d_i with the weights 2 h_i + h_{i-1} and
// h_i + 2 h_{i-1}; at ends the slope of a parabola, limited to [0, 3 d]. [Fritsch & Butland 1984]; |v| <= 3
// |d| on both sides, which suffices for a monotone piece [Fritsch & Carlson 1980].
//
// Accuracy: points are copied. An inner coefficient carries a few roundings of the largest of the points that
// it depends on.
//
// Fritsch and Carlson: v_i of the parabola, 0 where d changes sign or vanishes; a piece with the ratios
// a = v_i / d_i, b = v_{i+1} / d_i outside the circle a^2 + b^2 <= 9 asks for both to be multiplied by
// 3 / sqrt(a^2 + b^2) [Fritsch & Carlson 1980]. Here a slope gets the smaller factor of its two pieces,
// computed from what the slopes were before: shorter slopes of the same sign stay in the circle, and the
// result does not depend on the order of the pieces, as theirs does.
#include "fit/checks_detail.hpp"

#include <freiform/fit/local.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

Result<void> check(std::span<const double> at, std::size_t points, bool closed) {
    if (points < 2)
        return refuse(RefusalKind::invalid, "points",
                      text(points, points == 1 ? " point, 2 are needed" : " points, 2 are needed"));
    if (points > 0x08000000) return refuse(RefusalKind::limit, "points", "more than 2^27 points");
    if (at.size() != points + closed)
        return refuse(RefusalKind::invalid, "at", text(at.size(), " parameters, expected ", points + closed));
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (!std::isfinite(at[i]))
            return refuse(RefusalKind::nonfinite, text("at[", i, "]"),
                          text(at[i], " is not a finite number"));
        if (i > 0 && !(at[i] > at[i - 1]))
            return refuse(RefusalKind::invalid, text("at[", i, "]"),
                          text("does not increase: ", at[i - 1], " -> ", at[i]));
    }
    return {};
}

// Every point a break of multiplicity 3. Of a closed basis the seam has its three knots in front, so that
// coefficient 0 is point 0.
Result<BSplineBasis> bezier_breaks(std::span<const double> at, bool closed) {
    std::vector<double> t;
    t.reserve(3 * at.size() + 2);
    t.insert(t.end(), closed ? 1 : 4, at.front());
    for (std::size_t i = 1; i + 1 < at.size(); ++i) t.insert(t.end(), 3, at[i]);
    t.insert(t.end(), closed ? 3 : 4, at.back());
    return closed ? BSplineBasis::periodic(3, std::move(t)) : BSplineBasis::make(3, std::move(t));
}

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// What a piece of slope d with the end slopes v and w asks both to be multiplied by.
double shortening(double d, double v, double w) {
    if (d == 0) return 0;
    const double size = std::hypot(v / d, w / d);
    return size > 3 ? 3 / size : 1;
}

// At an open end: `near` and `far` slopes and steps, counted from the end.
double end_slope(double near, double far, double h, double next) {
    const double v = ((2 * h + next) * near - h * far) / (h + next);
    if (sign(v) != sign(near)) return 0;
    if (sign(near) != sign(far) && std::abs(v) > 3 * std::abs(near)) return 3 * near;
    return v;
}

}  // namespace

Result<Change<BSplineBasis>> catmull_rom(std::span<const double> at, bool closed) {
    const int m = int(std::min<std::size_t>(at.size(), 0x10000000)) - closed;
    if (auto ok = check(at, std::size_t(std::max(m, 0)), closed); !ok) return std::unexpected(ok.error());
    auto basis = bezier_breaks(at, closed);
    if (!basis) return refuse_within("at", basis.error());
    const int width = std::min(m, 3);
    BandMap map{m, width, {}, {}};
    const auto step = [&](int i) {  // h_i, of a closed polygon for all i
        i = (i + m) % m;
        return at[std::size_t(i) + 1] - at[std::size_t(i)];
    };
    const auto row = [&](int first, double left, double centre, double right) {
        map.first.push_back((first + m) % m);
        double w[3] = {left, centre, right};
        if (width == 2) {  // closed, of two points: left and right are the same
            w[0] += w[2];
        }
        map.entry.insert(map.entry.end(), w, w + width);
    };
    const auto point = [&](int i) { row(i, 1, 0, 0); };
    const auto after = [&](int i) {  // P+ of point i
        const double a = step(i - 1), b = step(i), s = a + b, l = -(b / a) * (b / s) / 3, r = a / s / 3;
        row(i - 1, l, 1 - l - r, r);
    };
    const auto before = [&](int i) {  // P- of point i
        const double a = step(i - 1), b = step(i), s = a + b, l = b / s / 3, r = -(a / b) * (a / s) / 3;
        row(i - 1, l, 1 - l - r, r);
    };
    point(0);
    for (int i = 0; i + 1 < m + closed; ++i) {
        const int next = (i + 1) % m;
        if (!closed && m == 2) {
            row(0, 2.0 / 3, 1.0 / 3, 0), row(0, 1.0 / 3, 2.0 / 3, 0);
        } else {
            if (closed || i > 0)
                after(i);
            else
                row(0, 0, 0, 0);  // the middle of its neighbours, below
            if (closed || next + 1 < m)
                before(next);
            else
                row(m - 3, 0, 0, 0);
        }
        if (!closed || next != 0) point(next);
    }
    if (!closed && m > 2) {
        const auto entry = [&](int r) { return map.entry.begin() + std::ptrdiff_t(r) * 3; };
        const int last = map.rows() - 1;
        for (int k = 0; k < 3; ++k) {  // rows 2 and last - 2 have the same columns
            entry(1)[k] = (entry(2)[k] + (k == 0)) / 2;
            entry(last - 1)[k] = (entry(last - 2)[k] + (k == 2)) / 2;
        }
    }
    return Change<BSplineBasis>{std::move(*basis), std::move(map)};
}

template <std::size_t N, int D>
Result<Patch<N, Vec<D>>> catmull_rom(const Net<N, Vec<D>>& points,
                                     const std::array<std::span<const double>, N>& at,
                                     const std::array<bool, N>& closed) {
    if (auto ok = detail::check_points<D>(points.flat(), "points"); !ok) return std::unexpected(ok.error());
    Net<N, Vec<D>> net = points;
    std::vector<BSplineBasis> bases;
    Index<N> extent = points.extent();
    for (std::size_t d = 0; d < N; ++d) {
        const std::string where = N == 1 ? "" : text("axes[", d, "]");
        if (auto ok = check(at[d], std::size_t(extent[d]), closed[d]); !ok)
            return refuse_within(where, ok.error());
        auto change = catmull_rom(at[d], closed[d]);
        if (!change) return refuse_within(where, change.error());
        extent[d] = change->map.rows();
        if (count_of(extent) < 0)
            return refuse(RefusalKind::limit, "points", "more than 2^31 - 1 coefficients");
        net = along(int(d), change->map, net);
        bases.push_back(std::move(change->basis));
    }
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return Patch<N, Vec<D>>::make({std::move(bases[I])...}, std::move(net));
    }
    (std::make_index_sequence<N>{});
}

template <int D>
Result<Curve<Vec<D>>> cubic_through(std::span<const Vec<D>> points, std::span<const Vec<D>> derivatives,
                                    std::span<const double> at, bool closed) {
    if (auto ok = check(at, points.size(), closed); !ok) return std::unexpected(ok.error());
    if (derivatives.size() != points.size())
        return refuse(RefusalKind::invalid, "derivatives",
                      text(derivatives.size(), " derivatives for ", points.size(), " points"));
    if (auto ok = detail::check_points(points, "points"); !ok) return std::unexpected(ok.error());
    if (auto ok = detail::check_points(derivatives, "derivatives"); !ok) return std::unexpected(ok.error());
    auto basis = bezier_breaks(at, closed);
    if (!basis) return refuse_within("at", basis.error());
    std::vector<Vec<D>> net;
    net.reserve(3 * points.size() + 1);
    net.push_back(points[0]);
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const std::size_t next = (i + 1) % points.size();
        const double third = (at[i + 1] - at[i]) / 3;
        net.push_back(points[i] + third * derivatives[i]);
        net.push_back(points[next] - third * derivatives[next]);
        if (!closed || next != 0) net.push_back(points[next]);
    }
    const int size = int(net.size());
    return Curve<Vec<D>>::make({std::move(*basis)}, Net<1, Vec<D>>({size}, std::move(net)));
}

template <int D>
Result<std::vector<Vec<D>>> local_slopes(std::span<const Vec<D>> points, std::span<const double> at,
                                         LocalSlopes kind, bool closed) {
    if (auto ok = check(at, points.size(), closed); !ok) return std::unexpected(ok.error());
    if (auto ok = detail::check_points(points, "points"); !ok) return std::unexpected(ok.error());
    const int m = int(points.size()), steps = int(at.size()) - 1;
    std::vector<Vec<D>> out(points.size());
    // d and h of steps -2 .. steps + 1, continued around the seam, or linearly beyond open ends.
    std::vector<double> d(std::size_t(steps) + 4), h(d.size());
    for (int c = 0; c < D; ++c) {
        for (int i = 0; i < steps; ++i) {
            h[std::size_t(i + 2)] = at[std::size_t(i) + 1] - at[std::size_t(i)];
            d[std::size_t(i + 2)] =
                (points[std::size_t((i + 1) % m)][c] - points[std::size_t(i)][c]) / h[std::size_t(i + 2)];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            const std::size_t low = 1 - k, high = std::size_t(steps) + 2 + k, n = std::size_t(steps);
            d[low] = closed ? d[low + n] : n == 1 ? d[2] : 2 * d[low + 1] - d[low + 2];
            d[high] = closed ? d[high - n] : n == 1 ? d[2] : 2 * d[high - 1] - d[high - 2];
            h[low] = closed ? h[low + n] : h[low + 1];
            h[high] = closed ? h[high - n] : h[high - 1];
        }
        for (int i = 0; i < m; ++i) {
            const std::size_t k = std::size_t(i) + 2;  // step i begins at point i
            const double left = d[k - 1], right = d[k];
            double v = 0;
            if (kind == LocalSlopes::akima) {
                const double l = std::abs(right - d[k + 1]), r = std::abs(left - d[k - 2]);
                v = l + r > 0 ? left * (l / (l + r)) + right * (r / (l + r)) : left / 2 + right / 2;
            } else if (!closed && i == 0) {
                v = steps == 1 ? right : end_slope(right, d[k + 1], h[k], h[k + 1]);
            } else if (!closed && i == m - 1) {
                v = steps == 1 ? left : end_slope(left, d[k - 2], h[k - 1], h[k - 2]);
            } else if (sign(left) != sign(right) || left == 0) {
                v = 0;
            } else if (kind == LocalSlopes::fritsch_carlson) {
                const double l = h[k - 1] / (h[k - 1] + h[k]);
                v = (1 - l) * left + l * right;
            } else {
                const double wl = 2 * h[k] + h[k - 1], wr = h[k] + 2 * h[k - 1];
                v = (wl + wr) / (wl / left + wr / right);
            }
            out[std::size_t(i)][c] = v;
        }
        if (kind != LocalSlopes::fritsch_carlson) continue;
        std::vector<double> factor(std::size_t(steps), 1.0);
        for (int i = 0; i < steps; ++i)
            factor[std::size_t(i)] =
                shortening(d[std::size_t(i) + 2], out[std::size_t(i)][c], out[std::size_t((i + 1) % m)][c]);
        for (int i = 0; i < m; ++i) {
            const int before = closed ? (i + steps - 1) % steps : std::max(i - 1, 0),
                      after = std::min(i, steps - 1);
            out[std::size_t(i)][c] *= std::min(factor[std::size_t(before)], factor[std::size_t(after)]);
        }
    }
    if (auto ok = detail::check_points<D>(out, "points"); !ok)
        return refuse(RefusalKind::ill_conditioned, ok.error().where,
                      "the slope there leaves the range of double");
    return out;
}

#define FF_LOCAL(D)                                                                                        \
    template Result<Patch<1, Vec<D>>> catmull_rom(                                                         \
        const Net<1, Vec<D>>&, const std::array<std::span<const double>, 1>&, const std::array<bool, 1>&); \
    template Result<Patch<2, Vec<D>>> catmull_rom(                                                         \
        const Net<2, Vec<D>>&, const std::array<std::span<const double>, 2>&, const std::array<bool, 2>&); \
    template Result<Curve<Vec<D>>> cubic_through(std::span<const Vec<D>>, std::span<const Vec<D>>,         \
                                                 std::span<const double>, bool);                           \
    template Result<std::vector<Vec<D>>> local_slopes(std::span<const Vec<D>>, std::span<const double>,    \
                                                      LocalSlopes, bool);
FF_LOCAL(1)
FF_LOCAL(2)
FF_LOCAL(3)
FF_LOCAL(4)
#undef FF_LOCAL

}  // namespace freiform
