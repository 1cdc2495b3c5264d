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
#include "fit/checks_detail.hpp"
#include "residual_detail.hpp"
#include "spline_system_detail.hpp"

#include <freiform/fit/interpolate.hpp>
#include <freiform/spline/wide.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace freiform {

namespace {

using detail::BandSystem;
using detail::finished;
using detail::LargestResidual;
using detail::SplineSystem;
using detail::ValueRows;
using detail::with_rounding;

// Of a closed system the unknowns are turned, so that the entries of row i are around i.
int turn_of(const SplineSystem& s) { return s.basis.is_closed() ? s.basis.degree() / 2 : 0; }

BandSystem matrix_of(const SplineSystem& s) {
    const int n = s.size(), turn = turn_of(s), width = s.basis.degree() + 1;
    BandSystem a(n, s.half_width, s.half_width, s.basis.is_closed());
    const auto add = [&](int row, int first, const double* w) {
        for (int k = 0; k < width; ++k)
            if (w[k] != 0) a.add(row, first + k - turn, w[k]);
    };
    ValueRows(s.basis, s.sites).each_block([&](int i, const BandMap& rows) {
        for (int k = 0; k < rows.rows(); ++k)
            add(s.row_of(i + k), rows.first[std::size_t(k)], &rows.entry[std::size_t(k * width)]);
    });
    for (int j = 0; j < s.conditions(); ++j) {
        add(j + 1, 0, s.start[std::size_t(j)].entry.data());
        add(n - 2 - j, n - width, s.end[std::size_t(j)].entry.data());
    }
    return a;
}

// The right-hand side for one line of the net, of rows of `width` numbers.
void arrange(const SplineSystem& s, const double* data, double* rhs, std::size_t width) {
    const int k = s.conditions(), n = s.size(), offset = s.given ? k : 0;
    const auto copy = [&](int layer, int row, double scale) {
        const double* from = data + std::size_t(layer) * width;
        double* to = rhs + std::size_t(row) * width;
        for (std::size_t c = 0; c < width; ++c) to[c] = scale * from[c];
    };
    const int m = s.points();  // the first and the last point stand outside the conditions
    copy(offset, 0, 1);
    copy(offset + m - 1, n - 1, 1);
    const double* inner = data + std::size_t(offset + 1) * width;
    std::copy(inner, inner + std::size_t(m - 2) * width, rhs + std::size_t(k + 1) * width);
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
Net<N, Vec<D>> solved(int axis, const SplineSystem& s, const BandSystem& a, std::span<const Vec<D>> data,
                      Index<N> extent, double& norm_of_inverse) {
    const std::size_t layers = std::size_t(extent[std::size_t(axis)]), n = std::size_t(s.size());
    extent[std::size_t(axis)] = s.size();
    std::size_t inner = 1, outer = 1;
    for (std::size_t d = 0; d < N; ++d)
        (int(d) < axis ? outer : inner) *= int(d) == axis ? 1 : std::size_t(extent[d]);
    Net<N, Vec<D>> out(extent);
    const std::size_t width = inner * D;
    const double* from = &data[0].c[0];
    double* to = &out.flat()[0].c[0];
    // For the condition: one more column, along with the first line.
    std::vector<double> chessboard(n);
    for (std::size_t i = 0; i < n; ++i) chessboard[i] = i % 2 == 0 ? 1 : -1;
    for (std::size_t o = 0; o < outer; ++o) {
        arrange(s, from + o * layers * width, to + o * n * width, width);
        a.solve(to + o * n * width, width, o == 0 ? chessboard.data() : nullptr);
    }
    norm_of_inverse = 0;
    for (const double x : chessboard) norm_of_inverse = std::max(norm_of_inverse, std::abs(x));
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

std::string axis_name(std::size_t dimensions, std::size_t d) {
    return dimensions == 1 ? "axis" : text("axes[", d, "]");
}

// The largest distance of a point from the patch at its parameters, as computed. Derivatives lie in layers of
// their own and do not count.
template <std::size_t N, int D>
double residual_of(const std::vector<SplineSystem>& systems, const Patch<N, Vec<D>>& patch,
                   std::span<const Vec<D>> points, const Index<N>& extent) {
    LargestResidual<D> residual;
    if constexpr (N == 1) {
        const SplineSystem& s = systems[0];
        const Vec<D>* q = points.data() + (s.given ? s.conditions() : 0);
        const Vec<D>* c = patch.net().flat().data();
        const int n = patch.basis().size(), width = patch.basis().degree() + 1;
        ValueRows(patch.basis(), s.sites).each_block([&](int begin, const BandMap& rows) {
            for (int i = 0; i < rows.rows(); ++i) {
                const double* w = &rows.entry[std::size_t(i * width)];
                const int first = rows.first[std::size_t(i)];
                Vec<D> sum{};
                for (int k = 0; k < width; ++k) {
                    const int column = first + k < n ? first + k : (first + k) % n;
                    for (int d = 0; d < D; ++d) sum[d] += w[k] * c[column][d];
                }
                residual.add(sum - q[begin + i]);
            }
        });
    } else {
        Net<N, Vec<D>> value = patch.net();
        Index<N> from{};
        for (std::size_t d = 0; d < N; ++d) {
            value = along(int(d), detail::values_at(patch.basis(int(d)), systems[d].sites), value);
            if (systems[d].given) from[d] = systems[d].conditions();
        }
        std::array<std::ptrdiff_t, N> stride{};
        std::ptrdiff_t step = 1;
        for (std::size_t d = N; d-- > 0; step *= extent[d]) stride[d] = step;
        const NetView<N, const Vec<D>> all{points.data(), extent, stride};
        const auto q = all.window(from, value.extent());
        each_index(value.extent(), [&](const Index<N>& at) { residual.add(value.view()(at) - q(at)); });
    }
    return residual.norm_;
}

template <std::size_t N, int D>
Result<Interpolant<N, D>> through(std::span<const Vec<D>> points, Index<N> extent,
                                  const std::array<AxisSpline, N>& axes) {
    if (auto ok = detail::check_points<D>(points, "points"); !ok) return std::unexpected(ok.error());
    const Index<N> given = extent;
    std::vector<SplineSystem> systems;
    for (std::size_t d = 0; d < N; ++d) {
        auto s = detail::spline_system(axes[d], extent[d]);
        if (!s) return N == 1 ? std::unexpected(s.error()) : refuse_within(axis_name(N, d), s.error());
        systems.push_back(std::move(*s));
        extent[d] = systems.back().size();
        if (count_of(extent) < 0)
            return refuse(RefusalKind::limit, "points", "more than 2^31 - 1 coefficients");
    }
    Net<N, Vec<D>> net;
    extent = given;
    double condition = 1;
    for (std::size_t d = 0; d < N; ++d) {
        BandSystem a = matrix_of(systems[d]);
        if (const auto bad = a.factor())
            return refuse(RefusalKind::ill_conditioned, axis_name(N, d),
                          text("no single spline of degree ", axes[d].degree, " with ", name_of(axes[d].ends),
                               " ends goes through points at these parameters (row ", *bad, ")"));
        double inverse = 1;
        net = solved<N, D>(int(d), systems[d], a, d == 0 ? points : net.flat(), extent, inverse);
        extent = net.extent();
        condition *= norm_of(systems[d]) * inverse;
    }
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{std::move(systems[I].basis)...};
    }
    (std::make_index_sequence<N>{});
    auto out = finished<N, D>(std::move(bases), std::move(net), condition);
    if (out) out->bound = with_rounding(residual_of<N, D>(systems, out->patch, points, given), out->patch);
    return out;
}

template <std::size_t N, int D>
Result<Interpolant<N, D>> interpolant(std::span<const Vec<D>> points, const Index<N>& extent,
                                      const std::array<AxisSpline, N>& axes) {
    if constexpr (detail::kIsWidened<Vec<D>>) {
        const auto wide = through<N, detail::kWidest>(detail::widened(points), extent, axes);
        if (!wide) return std::unexpected(wide.error());
        return Interpolant<N, D>{detail::narrowed<D>(wide->patch), wide->bound, wide->condition_estimate};
    } else {
        return through<N, D>(points, extent, axes);
    }
}

}  // namespace

template <std::size_t N, int D>
Result<Interpolant<N, D>> interpolate(const Net<N, Vec<D>>& points, const std::array<AxisSpline, N>& axes) {
    return interpolant<N, D>(points.flat(), points.extent(), axes);
}

template <int D>
Result<Interpolant<1, D>> interpolate(std::span<const Vec<D>> points, const AxisSpline& axis,
                                      std::span<const Vec<D>> start, std::span<const Vec<D>> end) {
    if (points.size() > 0x20000000) return refuse(RefusalKind::limit, "points", "more than 2^29 points");
    if (auto ok = detail::check_points(start, "start"); !ok) return std::unexpected(ok.error());
    if (auto ok = detail::check_points(end, "end"); !ok) return std::unexpected(ok.error());
    const std::size_t wanted =
        axis.ends == SplineEnds::clamped && axis.degree > 0 ? std::size_t(axis.degree / 2) : 0;
    for (const auto& [given, name] : {std::pair(start.size(), "start"), std::pair(end.size(), "end")})
        if (given != wanted)
            return refuse(RefusalKind::invalid, name,
                          text(given, given == 1 ? " derivative, " : " derivatives, ", name_of(axis.ends),
                               " ends of degree ", axis.degree, " take ", wanted));
    if (wanted == 0) return interpolant<1, D>(points, {int(points.size())}, {axis});
    std::vector<Vec<D>> layers;
    layers.reserve(points.size() + 2 * wanted);
    layers.insert(layers.end(), start.rbegin(), start.rend());
    layers.insert(layers.end(), points.begin(), points.end());
    layers.insert(layers.end(), end.begin(), end.end());
    return interpolant<1, D>(layers, {int(layers.size())}, {axis});
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
#undef FF_INTERPOLATE

}  // namespace freiform
