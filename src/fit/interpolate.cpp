// Idea: A spline through points is the solution of one system per axis, "row i of the collocation matrix
// times the coefficients is point i", and all these matrices are banded. A grid of points is solved for axis
// by axis, for the whole of the net at once: the inverse of a tensor product is the tensor product of
// inverses.
//
// Notation: p degree, k = p / 2, m points, n = m + conditions coefficients; A the matrix, c the coefficients.
//
// Method: Where the knots are and which conditions close the system: interpolate.hpp. Rows are in the order
// of the sites, so that row i is around column i (spline_system_detail.hpp) and the band is k wide on either
// side (natural, clamped) or 2 k (not-a-knot, whose first and last pieces see several points). Rows of
// derivatives are scaled by powers of two to entries of about 1, so that pivoting compares like with like.
//
// Cost: linear in the number of points, for fixed degree: O(p^2) for a row of values, O(p^2) for its factors,
// O(p) for each coordinate.
//
// Accuracy: of the solution nothing is promised but what is measured: r = fl(A c) - Q. A row of A holds the
// values of the basis with the roundings counted in patch_detail.hpp, so each coordinate of fl(A c) is within
// e = value_error_bound() of the exact spline on the exact knots, also when A is applied axis by axis. So
//     |f(t_i) - Q_i| <= (|r_i| + sqrt(D) e) (1 + 16 u),
// where the last factor pays for the rounding of the difference, of the norm and of this formula.
//
// Condition: The inverse of a totally positive matrix has the signs of a chessboard, so its norm, the largest
// sum of absolute values in a row, is the largest entry of A^-1 s with s = (1, -1, 1, ..): one more column of
// the right-hand side [deBoor 1976]. Collocation matrices are totally positive; with rows of derivatives it
// is a lower bound of the norm, hence "estimate".
//
// References: [deBoor 1978], [deBoor 1976], [Higham 2002].
//
// Why not elimination without pivoting, which total positivity allows [deBoor & Pinkus 1977]: natural ends
// and derivatives are not covered, and as the interchanges are rare and predicted they cost nothing.
#include "residual_detail.hpp"
#include "spline_system_detail.hpp"

#include <freiform/fit/interpolate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace freiform {

namespace {

using detail::BandSystem;
using detail::chessboard_norm;
using detail::finished;
using detail::Largest;
using detail::SplineSystem;
using detail::with_rounding;

// Calls f(row, first column, entries) for all rows of the system.
template <class F>
void each_row(const SplineSystem& s, F&& f) {
    const int n = s.size(), k = s.conditions(), last = n - s.basis.degree() - 1;
    for (int i = 0; i < s.points(); ++i) f(s.row_of(i), s.values.first[std::size_t(i)], s.values.row(i));
    for (int j = 0; j < k; ++j) {
        f(j + 1, 0, std::span<const double>(s.start[std::size_t(j)].entry));
        f(n - 2 - j, last, std::span<const double>(s.end[std::size_t(j)].entry));
    }
}

// Of a closed system the unknowns are turned, so that the entries of row i are around i.
int turn_of(const SplineSystem& s) { return s.basis.is_closed() ? s.basis.degree() / 2 : 0; }

BandSystem matrix_of(const SplineSystem& s) {
    int below = 0, above = 0;
    const int turn = turn_of(s);
    each_row(s, [&](int i, int first, std::span<const double> w) {
        int lo = 0, hi = int(w.size()) - 1;
        while (lo < hi && w[std::size_t(lo)] == 0) ++lo;
        while (lo < hi && w[std::size_t(hi)] == 0) --hi;
        below = std::max(below, i - (first + lo - turn));
        above = std::max(above, first + hi - turn - i);
    });
    BandSystem a(s.size(), below, above, s.basis.is_closed());
    each_row(s, [&](int i, int first, std::span<const double> w) {
        for (std::size_t k = 0; k < w.size(); ++k)
            if (w[k] != 0) a.add(i, first + int(k) - turn, w[k]);
    });
    return a;
}

// The right-hand side for one line of the net: rows of `width` numbers, `stride` >= width apart on both
// sides.
void arrange(const SplineSystem& s, const double* data, double* rhs, std::size_t width, std::size_t stride) {
    const int k = s.conditions(), n = s.size(), offset = s.given ? k : 0;
    const auto copy = [&](int layer, int row, double scale) {
        const double* from = data + std::size_t(layer) * width;
        double* to = rhs + std::size_t(row) * stride;
        for (std::size_t c = 0; c < width; ++c) to[c] = scale * from[c];
    };
    for (int i = 0; i < s.points(); ++i) copy(offset + i, s.row_of(i), 1);
    for (int j = 1; j <= k && s.given; ++j) {
        copy(k - j, j, s.start[std::size_t(j - 1)].scale);
        copy(k + s.points() + j - 1, n - 1 - j, s.end[std::size_t(j - 1)].scale);
    }
}

template <class T>
void turn_back(const SplineSystem& s, std::span<T> lines, std::size_t inner) {
    const std::size_t length = std::size_t(s.size()) * inner,
                      by = (std::size_t(turn_of(s)) % std::size_t(s.size())) * inner;
    if (by == 0) return;
    for (std::size_t at = 0; at < lines.size(); at += length)
        std::rotate(lines.begin() + std::ptrdiff_t(at), lines.begin() + std::ptrdiff_t(at + length - by),
                    lines.begin() + std::ptrdiff_t(at + length));
}

// Coefficients along `axis` instead of layers of data.
template <std::size_t N, int D>
Net<N, Vec<D>> solved(int axis, const SplineSystem& s, const BandSystem& a, const Net<N, Vec<D>>& data,
                      double& norm_of_inverse) {
    Index<N> extent = data.extent();
    const std::size_t layers = std::size_t(extent[std::size_t(axis)]), n = std::size_t(s.size());
    extent[std::size_t(axis)] = s.size();
    std::size_t inner = 1, outer = 1;
    for (std::size_t d = 0; d < N; ++d)
        (int(d) < axis ? outer : inner) *= int(d) == axis ? 1 : std::size_t(extent[d]);
    Net<N, Vec<D>> out(extent);
    const std::size_t width = inner * D;
    const double* from = &data.flat()[0].c[0];
    double* to = &out.flat()[0].c[0];
    if (outer * inner == 1) {
        // One curve: the column for the condition goes along with the coordinates.
        std::vector<double> x(n * (D + 1));
        arrange(s, from, x.data(), D, D + 1);
        for (std::size_t i = 0; i < n; ++i) x[i * (D + 1) + D] = i % 2 == 0 ? 1 : -1;
        a.solve(x.data(), D + 1);
        double most = 0;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t c = 0; c < D; ++c) to[i * D + c] = x[i * (D + 1) + c];
            most = std::max(most, std::abs(x[i * (D + 1) + D]));
        }
        norm_of_inverse = most;
    } else {
        norm_of_inverse = chessboard_norm(a);
        for (std::size_t o = 0; o < outer; ++o) {
            arrange(s, from + o * layers * width, to + o * n * width, width, width);
            a.solve(to + o * n * width, width);
        }
    }
    turn_back(s, out.flat(), inner);
    return out;
}

double norm_of(const SplineSystem& s) {
    double most = 1;
    for (const auto* side : {&s.start, &s.end})
        for (const auto& c : *side) {
            double sum = 0;
            for (double x : c.entry) sum += std::abs(x);
            most = std::max(most, sum);
        }
    return most;
}

template <int D>
Result<void> check_points(std::span<const Vec<D>> points, std::string_view name) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text(name, "[", i, "]"),
                          "has a coordinate that is not finite");
    return {};
}

std::string axis_name(std::size_t dimensions, std::size_t d) {
    return dimensions == 1 ? "axis" : text("axes[", d, "]");
}

}  // namespace

template <std::size_t N, int D>
Result<Interpolant<N, D>> interpolate(const Net<N, Vec<D>>& points, const std::array<AxisSpline, N>& axes) {
    if (auto ok = check_points<D>(points.flat(), "points"); !ok) return std::unexpected(ok.error());
    std::vector<SplineSystem> systems;
    Index<N> extent = points.extent();
    for (std::size_t d = 0; d < N; ++d) {
        auto s = detail::spline_system(axes[d], extent[d]);
        if (!s) return N == 1 ? std::unexpected(s.error()) : refuse_within(axis_name(N, d), s.error());
        systems.push_back(std::move(*s));
        extent[d] = systems.back().size();
        if (count_of(extent) < 0)
            return refuse(RefusalKind::limit, "points", "more than 2^31 - 1 coefficients");
    }
    Net<N, Vec<D>> net = points;
    double condition = 1;
    for (std::size_t d = 0; d < N; ++d) {
        BandSystem a = matrix_of(systems[d]);
        if (const auto bad = a.factor())
            return refuse(RefusalKind::ill_conditioned, axis_name(N, d),
                          text("no single spline of degree ", axes[d].degree, " with ", name_of(axes[d].ends),
                               " ends goes through points at these parameters (row ", *bad, ")"));
        double inverse = 1;
        net = solved(int(d), systems[d], a, net, inverse);
        condition *= norm_of(systems[d]) * inverse;
    }
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move(systems[I].basis)...};
    }
    (std::make_index_sequence<N>{});
    auto out = finished<N, D>(bases, std::move(net), condition);
    if (!out) return out;

    // The residual at the points alone: derivatives lie in layers of their own.
    Largest<D> residual;
    if constexpr (N == 1) {
        const SplineSystem& s = systems[0];
        const Vec<D>* q = points.flat().data() + (s.given ? s.conditions() : 0);
        const Vec<D>* c = out->patch.net().flat().data();
        const int n = out->patch.basis().size(), width = s.values.width;
        for (int i = 0; i < s.points(); ++i) {
            const double* w = &s.values.entry[std::size_t(i) * std::size_t(width)];
            int column = s.values.first[std::size_t(i)] % n;
            Vec<D> sum{};
            for (int k = 0; k < width; ++k) {
                for (int d = 0; d < D; ++d) sum[d] += w[k] * c[column][d];
                if (++column == n) column = 0;
            }
            residual.add(sum - q[i]);
        }
    } else {
        Net<N, Vec<D>> value = out->patch.net();
        Index<N> from{};
        for (std::size_t d = 0; d < N; ++d) {
            value = along(int(d), systems[d].values, value);
            if (systems[d].given) from[d] = systems[d].conditions();
        }
        const auto q = points.view().window(from, value.extent());
        each_index(value.extent(), [&](const Index<N>& at) { residual.add(value.view()(at) - q(at)); });
    }
    out->bound = with_rounding(residual.norm_, out->patch);
    return out;
}

template <int D>
Result<Interpolant<1, D>> interpolate(std::span<const Vec<D>> points, const AxisSpline& axis,
                                      std::span<const Vec<D>> start, std::span<const Vec<D>> end) {
    if (points.size() > 0x20000000) return refuse(RefusalKind::limit, "points", "more than 2^29 points");
    if (auto ok = check_points(start, "start"); !ok) return std::unexpected(ok.error());
    if (auto ok = check_points(end, "end"); !ok) return std::unexpected(ok.error());
    const std::size_t wanted =
        axis.ends == SplineEnds::clamped && axis.degree > 0 ? std::size_t(axis.degree / 2) : 0;
    for (const auto& [given, name] : {std::pair(start.size(), "start"), std::pair(end.size(), "end")})
        if (given != wanted)
            return refuse(RefusalKind::invalid, name,
                          text(given, given == 1 ? " derivative, " : " derivatives, ", name_of(axis.ends),
                               " ends of degree ", axis.degree, " take ", wanted));
    std::vector<Vec<D>> layers;
    layers.reserve(points.size() + 2 * wanted);
    layers.insert(layers.end(), start.rbegin(), start.rend());
    layers.insert(layers.end(), points.begin(), points.end());
    layers.insert(layers.end(), end.begin(), end.end());
    const int size = int(layers.size());
    return interpolate<1, D>(Net<1, Vec<D>>({size}, std::move(layers)), {axis});
}

#define FF_INTERPOLATE(D)                                                                                    \
    template Result<Interpolant<1, D>> interpolate(const Net<1, Vec<D>>&, const std::array<AxisSpline, 1>&); \
    template Result<Interpolant<2, D>> interpolate(const Net<2, Vec<D>>&, const std::array<AxisSpline, 2>&); \
    template Result<Interpolant<3, D>> interpolate(const Net<3, Vec<D>>&, const std::array<AxisSpline, 3>&); \
    template Result<Interpolant<1, D>> interpolate(std::span<const Vec<D>>, const AxisSpline&,               \
                                                   std::span<const Vec<D>>, std::span<const Vec<D>>);
FF_INTERPOLATE(1)
FF_INTERPOLATE(2)
FF_INTERPOLATE(3)
FF_INTERPOLATE(4)

}  // namespace freiform
