// Idea: at a knot that is the left end t_s of its span all but the first degree factors of the recurrence
// are 0 or 1: the values there are those of degree p - 1 on the same knots, and the last one is 0. Spans of
// successive simple knots are successive, so the knots that the recurrence reads for eight sites lie side by
// side: eight sites are done at once, in the lanes of vector registers.
//
// Accuracy: the remaining operations are those of blossom_step, in the same order; the bits are the same as
// of weights(), and with them the count of roundings in patch_detail.hpp.
//
// Cost: p (p - 1) / 2 pairs of divisions for each site.
#include "spline_system_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

std::string_view name_of(SplineEnds ends) {
    constexpr std::string_view names[] = {"natural", "clamped", "not-a-knot", "periodic"};
    return names[int(ends)];
}

namespace detail {

namespace {

constexpr int kLanes = 8;

// Values at the sites t[0] .. t[kLanes - 1], each the left end of its span. p >= 1.
void values_at_knots(const double* t, int p, double* entry) {
    double b[kMaxDegree + 1][kLanes], carry[kLanes];
    for (double& x : b[0]) x = 1;
    for (int k = 2; k <= p; ++k) {
        for (double& x : carry) x = 0;
        for (int r = 0; r + 1 < k; ++r) {
            const double *tl = t + (1 - k + r), *tr = t + (1 + r);
            for (int lane = 0; lane < kLanes; ++lane) {
                const double x = t[lane], width = tr[lane] - tl[lane], old = b[r][lane];
                b[r][lane] = carry[lane] + old * ((tr[lane] - x) / width);
                carry[lane] = old * ((x - tl[lane]) / width);
            }
        }
        for (int lane = 0; lane < kLanes; ++lane) b[k - 1][lane] = carry[lane];
    }
    for (int lane = 0; lane < kLanes; ++lane) {
        for (int r = 0; r < p; ++r) entry[lane * (p + 1) + r] = b[r][lane];
        entry[lane * (p + 1) + p] = 0;
    }
}

Result<void> check_sites(std::span<const double> at, std::size_t expected, int degree) {
    if (degree < 1 || degree > kMaxDegree)
        return refuse(degree < 1 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", degree, " is outside 1..", kMaxDegree));
    if (at.size() != expected)
        return refuse(RefusalKind::invalid, "at", text(at.size(), " parameters, expected ", expected));
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

double middle(double a, double b) { return a + (b - a) / 2; }

Result<BSplineBasis> basis_through(const AxisSpline& axis) {
    const int p = axis.degree, k = p / 2;
    const auto& at = axis.at;
    const std::size_t last = at.size() - 1;
    std::vector<double> t;
    t.reserve(at.size() + 2 * std::size_t(p) + 2);
    if (axis.ends == SplineEnds::periodic) {
        if (p % 2 == 1) return BSplineBasis::periodic(p, {at.begin(), at.end()});
        const double before =
            (at[last] - at[last - 1]) / 2;  // the seam lies between the last point and the first
        t.push_back(at[0] - before);
        for (std::size_t i = 1; i < last; ++i) t.push_back(middle(at[i - 1], at[i]));
        t.push_back(at[last] - before);
        return BSplineBasis::periodic(p, std::move(t));
    }
    t.assign(std::size_t(p) + 1, at[0]);
    const std::size_t skip = axis.ends == SplineEnds::not_a_knot ? std::size_t(k) : 0;
    if (p % 2 == 1) {
        if (last > 1 + 2 * skip)
            t.insert(t.end(), at.begin() + std::ptrdiff_t(1 + skip), at.end() - std::ptrdiff_t(1 + skip));
    } else {
        for (std::size_t i = skip; i + skip < last; ++i) t.push_back(middle(at[i], at[i + 1]));
    }
    t.insert(t.end(), std::size_t(p) + 1, at[last]);
    return BSplineBasis::make(p, std::move(t));
}

SplineSystem::Condition condition(const BSplineBasis& basis, double at, int order) {
    SplineSystem::Condition c{order, 1, std::vector<double>(std::size_t(basis.degree()) + 1)};
    weights_in_span(basis, basis.span(at), at, order, c.entry.data());
    double most = 0;
    for (double x : c.entry) most = std::max(most, std::abs(x));
    c.scale = std::isfinite(most) && most > 0 ? std::scalbn(1.0, -std::ilogb(most)) : 1;
    for (double& x : c.entry) x *= c.scale;
    return c;
}

}  // namespace

void ValueRows::fill(const BSplineBasis& basis, std::span<const double> sites, int& s, int* first,
                     double* entry) {
    const int p = basis.degree(), width = p + 1, n = basis.size() + basis.wrapped();
    const double* t = basis.knots().data();
    for (std::size_t i = 0; i < sites.size();) {
        while (s + 1 < n && t[s + 1] <= sites[i]) ++s;
        std::size_t run = 0;  // of sites that are successive simple knots
        while (p >= 1 && run < kLanes && i + run < sites.size() && s + int(run) < n &&
               sites[i + run] == t[s + int(run)] && t[s + int(run)] < t[s + int(run) + 1])
            ++run;
        double* row = entry + i * std::size_t(width);
        if (run == kLanes) {
            values_at_knots(t + s, p, row);
            for (std::size_t k = 0; k < run; ++k) first[i + k] = s + int(k) - p;
            i += run;
            s += int(run) - 1;
            continue;
        }
        // Too few for all lanes; or the end of the domain, which belongs to the last span.
        const int own = sites[i] < t[n] ? s : basis.span(sites[i]);
        weights_in_span(basis, own, sites[i], 0, row);
        first[i++] = own - p;
    }
}

BandMap values_at(const BSplineBasis& basis, std::span<const double> sites) {
    const int width = basis.degree() + 1;
    BandMap m{basis.size(), width, std::vector<int>(sites.size()),
              std::vector<double>(sites.size() * std::size_t(width))};
    int span = basis.degree();
    ValueRows::fill(basis, sites, span, m.first.data(), m.entry.data());
    return m;
}

Result<SplineSystem> spline_system(const AxisSpline& axis, int layers) {
    const int p = axis.degree,
              k = axis.ends == SplineEnds::natural || axis.ends == SplineEnds::clamped ? p / 2 : 0;
    const bool given = axis.ends == SplineEnds::clamped, closed = axis.ends == SplineEnds::periodic;
    const int points = layers - (given ? 2 * std::max(k, 0) : 0);
    const int least = axis.ends == SplineEnds::not_a_knot ? std::max(2, p + 1) : 2;
    if (points < least)
        return refuse(RefusalKind::invalid, "points",
                      text(points, points == 1 ? " point; " : " points; ", name_of(axis.ends),
                           " ends of degree ", p, " need at least ", least));
    if (auto ok = check_sites(axis.at, std::size_t(points) + closed, p); !ok)
        return std::unexpected(ok.error());
    auto basis = basis_through(axis);
    if (!basis) return refuse_within("at", basis.error());
    SplineSystem s{std::move(*basis), axis.at.first(std::size_t(points)), 0, {}, {}, given};
    s.half_width = std::min(axis.ends == SplineEnds::not_a_knot ? 2 * (p / 2) : p / 2, s.size() - 1);
    for (int j = 1; j <= k; ++j) {
        const int order = given ? j : k + j;
        s.start.push_back(condition(s.basis, axis.at.front(), order));
        s.end.push_back(condition(s.basis, axis.at.back(), order));
    }
    return s;
}

}  // namespace detail

}  // namespace freiform
