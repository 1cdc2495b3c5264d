// Idea: the spline on a given basis that meets given values and derivatives solves a square system whose rows
// are values and derivatives of the basis. Sorted by site the rows form a band.
//
// Method: Datum i, in the order of the sites, must lie where function i is not zero, t_i < site_i <
// t_{i+p+1}, or at the end of a support that a knot of sufficient multiplicity cuts off: the theorem of
// Schoenberg and Whitney in the form for repeated sites [deBoor 1978, ch. XIII]. If an order is left out at a
// site (Birkhoff) the condition is necessary only, and the missing pivot says the rest. Rows of derivatives
// are scaled by powers of two to entries of about 1.
//
// Cost: O(p^2) for each datum, and the sorting.
//
// Accuracy: as in interpolate.cpp.
//
// References: [Schoenberg & Whitney 1953], [deBoor 1978].
#include "residual_detail.hpp"

#include <freiform/core/sort.hpp>

#include <numeric>

namespace freiform {

using detail::BandSystem;

Result<BSplineBasis> averaged_basis(int degree, std::span<const double> sites) {
    FF_REQUIRE(degree >= 1);
    const std::size_t p = std::size_t(degree), n = sites.size();
    if (n < p + 1)
        return refuse(RefusalKind::invalid, "sites",
                      text(n, " data, degree ", degree, " needs at least ", degree + 1));
    std::vector<double> t(p + 1, sites.front());
    for (std::size_t i = 1; i + p < n; ++i) {
        // The mean of sites, without leaving their range.
        double mean = 0;
        for (std::size_t k = 0; k < p; ++k) mean += (sites[i + k] - sites[i]) / double(p);
        t.push_back(std::clamp(sites[i] + mean, sites[i], sites[i + p - 1]));
    }
    t.insert(t.end(), p + 1, sites.back());
    return BSplineBasis::make(degree, std::move(t));
}

namespace {

// Datum number i in the order of the sites must see function i: else the place of what is wrong.
template <int D>
Result<void> check_interlacing(const BSplineBasis& basis, std::span<const Datum<D>> data,
                               const std::vector<int>& order) {
    const int n = basis.size(), p = basis.degree();
    for (int i = 0; i < n; ++i) {
        const int own = order[std::size_t(i)];
        const double at = data[std::size_t(own)].at, lo = basis.knot(i), hi = basis.knot(i + p + 1);
        int before = 0;  // data at the same site that come first
        while (before < i && data[std::size_t(order[std::size_t(i - before - 1)])].at == at) ++before;
        const bool left_end = at == lo && i <= basis.span(at) - p + before;
        const bool right_end = at == hi && at == basis.domain().hi;
        if ((lo < at && at < hi) || left_end || right_end) continue;
        return refuse(
            RefusalKind::ill_conditioned, text("data[", own, "]"),
            text("lies at ", at, ", where function ", i, " of the basis, alone on (", lo, ", ", hi, "), ",
                 at <= lo ? "does not begin yet: too many data are before"
                          : "has ended: too few data are before"));
    }
    return {};
}

}  // namespace

template <int D>
Result<Interpolant<1, D>> interpolate(const BSplineBasis& basis, std::span<const Datum<D>> data) {
    const int n = basis.size(), p = basis.degree();
    if (data.size() != std::size_t(n))
        return refuse(RefusalKind::invalid, "data",
                      text(data.size(), " data for a basis of ", n, " functions"));
    const Interval on = basis.domain();
    for (std::size_t i = 0; i < data.size(); ++i) {
        const auto where = text("data[", i, "]");
        if (!std::isfinite(data[i].at) || !is_finite(data[i].value))
            return refuse(RefusalKind::nonfinite, where, "has a number that is not finite");
        if (!on.contains(data[i].at))
            return refuse(RefusalKind::out_of_domain, where,
                          text(data[i].at, " is outside the domain [", on.lo, ", ", on.hi, "]"));
        if (data[i].order < 0 || data[i].order > p)
            return refuse(RefusalKind::invalid, where, text("order ", data[i].order, " is outside 0..", p));
    }
    std::vector<int> order(data.size());
    std::iota(order.begin(), order.end(), 0);
    sort(order.begin(), order.end(), [&](int a, int b) {
        const auto &x = data[std::size_t(a)], &y = data[std::size_t(b)];
        return x.at != y.at ? x.at < y.at : x.order != y.order ? x.order < y.order : a < b;
    });
    for (std::size_t i = 1; i < order.size(); ++i) {
        const auto &x = data[std::size_t(order[i - 1])], &y = data[std::size_t(order[i])];
        if (x.at == y.at && x.order == y.order)
            return refuse(RefusalKind::invalid, text("data[", order[i], "]"),
                          text("gives derivative ", y.order, " at ", y.at, " a second time, after data[",
                               order[i - 1], "]"));
    }
    if (!basis.is_closed())
        if (auto ok = check_interlacing(basis, data, order); !ok) return std::unexpected(ok.error());

    const std::size_t rows = data.size();
    std::vector<double> entry(rows * std::size_t(p + 1)), rhs(rows * D), scale(rows);
    std::vector<int> first(rows);
    int below = 0, above = 0;
    for (int i = 0; i < n; ++i) {
        const auto& d = data[std::size_t(order[std::size_t(i)])];
        double* w = &entry[std::size_t(i) * std::size_t(p + 1)];
        first[std::size_t(i)] = weights(basis, d.at, d.order, w);
        double most = 0;
        for (int k = 0; k <= p; ++k) most = std::max(most, std::abs(w[k]));
        scale[std::size_t(i)] =
            d.order == 0 || !(most > 0) || !std::isfinite(most) ? 1 : std::scalbn(1.0, -std::ilogb(most));
        for (int k = 0; k <= p; ++k) w[k] *= scale[std::size_t(i)];
        for (int c = 0; c < D; ++c) rhs[std::size_t(i * D + c)] = scale[std::size_t(i)] * d.value[c];
        below = std::max(below, i - first[std::size_t(i)]);
        above = std::max(above, first[std::size_t(i)] + p - i);
    }
    BandSystem a(n, std::clamp(below, 0, n - 1), std::clamp(above, 0, n - 1), basis.is_closed());
    for (int i = 0; i < n; ++i)
        for (int k = 0; k <= p; ++k)
            if (const double x = entry[std::size_t(i * (p + 1) + k)]; x != 0)
                a.add(i, first[std::size_t(i)] + k, x);
    if (const auto bad = a.factor())
        return refuse(
            RefusalKind::ill_conditioned, text("data[", order[std::size_t(*bad)], "]"),
            "says nothing that the other data do not say: no single spline of this basis meets all of them");
    a.solve(rhs.data(), D);
    Net<1, Vec<D>> net({n});
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < D; ++c) net.flat()[std::size_t(i)][c] = rhs[std::size_t(i * D + c)];
    double norm_of_matrix = 1;
    for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int k = 0; k <= p; ++k) sum += std::abs(entry[std::size_t(i * (p + 1) + k)]);
        norm_of_matrix = std::max(norm_of_matrix, sum);
    }
    auto out = detail::finished<1, D>({basis}, std::move(net), norm_of_matrix * detail::chessboard_norm(a));
    if (!out) return out;
    detail::LargestResidual<D> residual;
    for (const auto& d : data)
        if (d.order == 0) residual.add(out->patch(d.at) - d.value);
    out->bound = detail::with_rounding(residual.norm_, out->patch);
    return out;
}

#define FF_INTERPOLATE_DATA(D) \
    template Result<Interpolant<1, D>> interpolate(const BSplineBasis&, std::span<const Datum<D>>);
FF_INTERPOLATE_DATA(1)
FF_INTERPOLATE_DATA(2)
FF_INTERPOLATE_DATA(3)
FF_INTERPOLATE_DATA(4)
#undef FF_INTERPOLATE_DATA

}  // namespace freiform
