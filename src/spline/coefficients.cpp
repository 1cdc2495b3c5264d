#include "coefficients_detail.hpp"

#include <cmath>

namespace freiform::detail {

Result<void> check_coefficients(const Tuples& all) {
    constexpr double kLargest = 0x1p1022;  // so that a sum of weighted coefficients cannot overflow
    for (std::size_t i = 0; i < all.count(); ++i) {
        const double *p = all[i], w = all.weight(i);
        bool finite = true;
        double number = 0, coordinate = 0;
        for (int k = 0; k < all.size; ++k) {
            finite = finite && p[k] - p[k] == 0;
            number = std::max(number, std::abs(p[k]));
        }
        if (!finite)
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
        if (!(w > 0))
            return refuse(RefusalKind::invalid, text("weights[", i, "]"),
                          text("weight ", w, " is not positive"));
        if (w < std::numeric_limits<double>::min())
            return refuse(RefusalKind::ill_conditioned, text("weights[", i, "]"),
                          text("weight ", w, " is subnormal; give all weights a common factor"));
        if (all.rational)
            for (int k = 0; k < all.dim(); ++k) coordinate = std::max(coordinate, std::abs(p[k] / w));
        if (number > kLargest || coordinate > kLargest)
            return refuse(RefusalKind::limit, text("points[", i, "]"),
                          "a coordinate, or its product with the weight, is above 2^1022");
    }
    return {};
}

Reach reach_of(const Tuples& all) {
    Reach r{0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < all.count(); ++i) {
        const double w = all.weight(i);
        for (int k = 0; k < all.dim(); ++k) r.coordinate = std::max(r.coordinate, std::abs(all[i][k] / w));
        r.weight = std::min(r.weight, w);
    }
    return r;
}

Result<void> check_axis(std::span<const double> at, const Interval& domain, bool closed, std::size_t axis) {
    for (std::size_t i = 0; i < at.size(); ++i)
        if (!std::isfinite(at[i]) || !(closed || domain.contains(at[i])))
            return bad_parameter(at[i], domain, "axes", axis, std::ptrdiff_t(i));
    return {};
}

Result<std::vector<double>> grid_of(const Tuples& net, std::span<const int> extent, std::span<const int> rows,
                                    const std::function<BandMap(std::size_t)>& map) {
    const auto count = [](std::span<const int> of) {  // -1: too many
        long long n = 1;
        for (const int e : of) n = n < 0 || n * e > 0x7fffffff ? -1 : n * e;
        return n;
    };
    if (count(rows) < 0) return refuse(RefusalKind::limit, "axes", "more than 2^31 - 1 grid points");
    std::vector<int> between(extent.begin(), extent.end());  // of the nets on the way
    for (std::size_t d = 0; d < rows.size(); ++d) {
        between[d] = rows[d];
        if (count(between) < 0)
            return refuse(RefusalKind::limit, "axes",
                          "more than 2^31 - 1 coefficients on the way to the grid");
    }
    std::vector<double> now(net.all.begin(), net.all.end());
    between.assign(extent.begin(), extent.end());
    for (std::size_t d = 0; d < rows.size(); ++d) {
        std::size_t blocks = 1, run = std::size_t(net.size);
        for (std::size_t k = 0; k < rows.size(); ++k)
            if (k != d) (k < d ? blocks : run) *= std::size_t(between[k]);
        std::vector<double> next(blocks * std::size_t(rows[d]) * run);
        map(d).apply(now.data(), next.data(), run, blocks);
        now = std::move(next);
        between[d] = rows[d];
    }
    if (!net.rational) return now;
    std::vector<double> points;
    points.reserve(now.size());
    const std::size_t size = std::size_t(net.size);
    for (std::size_t i = 0; i < now.size(); i += size)
        for (std::size_t k = 0; k + 1 < size; ++k) points.push_back(now[i + k] / now[i + size - 1]);
    return points;
}

std::unexpected<Refusal> bad_parameter(double u, const Interval& domain, std::string_view name,
                                       std::size_t first, std::ptrdiff_t second) {
    std::string where = text(name, "[", first, "]");
    if (second >= 0) where += text("[", second, "]");
    if (!std::isfinite(u))
        return refuse(RefusalKind::nonfinite, std::move(where), text(u, " is not a finite number"));
    return refuse(RefusalKind::out_of_domain, std::move(where),
                  text(u, " is outside the domain [", domain.lo, ", ", domain.hi, "]"));
}

}  // namespace freiform::detail
