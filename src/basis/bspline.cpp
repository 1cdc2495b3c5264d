#include <freiform/basis/bspline.hpp>

#include <algorithm>
#include <cmath>
#include <ranges>

namespace freiform {

namespace {

Result<void> check_degree(int degree) {
    if (degree < 0 || degree > kMaxDegree)
        return refuse(degree < 0 ? RefusalKind::invalid : RefusalKind::unsupported, "degree",
                      text("degree ", degree, " is outside 0..", kMaxDegree));
    return {};
}

Result<void> check_sorted(std::string_view field, std::span<const double> t) {
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (!std::isfinite(t[i]))
            return refuse(RefusalKind::nonfinite, text(field, "[", i, "]"),
                          text(t[i], " is not a finite number"));
        if (i > 0 && t[i] < t[i - 1])
            return refuse(RefusalKind::invalid, text(field, "[", i, "]"),
                          text("decreases: ", t[i - 1], " -> ", t[i]));
    }
    if (!t.empty() && !std::isfinite(t.back() - t.front()))
        return refuse(RefusalKind::nonfinite, std::string(field), "the range of the numbers overflows");
    return {};
}

}  // namespace

Result<Bernstein> Bernstein::make(int degree, Interval on) {
    if (auto ok = check_degree(degree); !ok) return std::unexpected(ok.error());
    if (!std::isfinite(on.hi - on.lo))
        return refuse(RefusalKind::nonfinite, "interval", text("[", on.lo, ", ", on.hi, "] is not finite"));
    if (!(on.lo < on.hi))
        return refuse(RefusalKind::invalid, "interval", text("[", on.lo, ", ", on.hi, "] is empty"));
    return Bernstein(degree, on);
}

Result<BSplineBasis> BSplineBasis::checked(BSplineBasis basis) {
    const int p = basis.degree_;
    const auto& t = basis.knots_;
    if (!(basis.domain().lo < basis.domain().hi))
        return refuse(RefusalKind::invalid, "knots",
                      text("the domain [", basis.domain().lo, ", ", basis.domain().hi, "] is empty"));
    for (std::size_t i = 0; i + std::size_t(p) + 1 < t.size(); ++i)
        if (t[i] == t[i + std::size_t(p) + 1])
            return refuse(RefusalKind::invalid, text("knots[", i, "]"),
                          text(t[i], " is repeated more than degree + 1 = ", p + 1, " times"));
    return basis;
}

Result<BSplineBasis> BSplineBasis::make(int degree, std::vector<double> knots) {
    if (auto ok = check_degree(degree); !ok) return std::unexpected(ok.error());
    if (knots.size() < 2 * (std::size_t(degree) + 1))
        return refuse(RefusalKind::invalid, "knots",
                      text(knots.size(), " knots, degree ", degree, " needs at least ", 2 * (degree + 1)));
    if (knots.size() > 0x20000000) return refuse(RefusalKind::limit, "knots", "more than 2^29 knots");
    if (auto ok = check_sorted("knots", knots); !ok) return std::unexpected(ok.error());
    return checked({degree, std::move(knots), 0, false});
}

Result<BSplineBasis> BSplineBasis::periodic(int degree, std::vector<double> breaks) {
    if (auto ok = check_degree(degree); !ok) return std::unexpected(ok.error());
    if (breaks.size() < 2)
        return refuse(RefusalKind::invalid, "breaks", text(breaks.size(), " breaks, at least 2 are needed"));
    if (breaks.size() > 0x20000000) return refuse(RefusalKind::limit, "breaks", "more than 2^29 breaks");
    if (auto ok = check_sorted("breaks", breaks); !ok) return std::unexpected(ok.error());
    const int n = int(breaks.size()) - 1;
    for (int i = 0; i + std::max(degree, 1) <= n; ++i)
        if (breaks[std::size_t(i)] == breaks[std::size_t(i + std::max(degree, 1))])
            return refuse(RefusalKind::invalid, text("breaks[", i, "]"),
                          text("a closed spline of degree ", degree, " cannot repeat a break more than ",
                               std::max(degree, 1), " times"));
    const double period = breaks.back() - breaks.front();
    if (!std::isfinite(breaks.back() + (degree + 1) * period) ||
        !std::isfinite(breaks.front() - (degree + 1) * period))
        return refuse(RefusalKind::nonfinite, "breaks", "the unwound knots overflow");
    const double front = breaks.front(), back = breaks.back();
    const auto seam =
        std::count(breaks.begin(), breaks.end(), front) + std::count(breaks.begin(), breaks.end(), back) - 1;
    if (front < back && seam > std::max(degree, 1))
        return refuse(RefusalKind::invalid, "breaks[0]",
                      text("the seam has ", seam, " knots; a closed spline of degree ", degree,
                           " cannot have more than ", std::max(degree, 1)));
    // Breaks equal to an end stay equal to it on every turn, also where front + period rounds away from back.
    const auto place = [&](int turns) { return turns == 1 ? back : front + turns * period; };
    std::vector<double> t;
    t.reserve(std::size_t(n) + 2 * std::size_t(degree) + 1);
    for (int i = -degree; i <= n + degree; ++i) {
        const int turns = i >= 0 ? i / n : -((n - 1 - i) / n);
        const double x = breaks[std::size_t(i - turns * n)];
        t.push_back(x == front ? place(turns) : x == back ? place(turns + 1) : x + turns * period);
    }
    for (std::size_t i = 1; i < t.size(); ++i)
        t[i] = std::max(t[i], t[i - 1]);  // rounding of the unwound ones
    return checked({degree, std::move(t), degree, degree == 0});
}

Result<BSplineBasis> BSplineBasis::bezier(int degree, Interval on) {
    if (auto ok = Bernstein::make(degree, on); !ok) return std::unexpected(ok.error());
    std::vector<double> t(std::size_t(degree) + 1, on.lo);
    t.insert(t.end(), std::size_t(degree) + 1, on.hi);
    return make(degree, std::move(t));
}

Result<BSplineBasis> BSplineBasis::clamped_uniform(int degree, int size) {
    if (auto ok = check_degree(degree); !ok) return std::unexpected(ok.error());
    if (size <= degree)
        return refuse(RefusalKind::invalid, "size",
                      text(size, " coefficients, degree ", degree, " needs ", degree + 1));
    if (size > 0x20000000) return refuse(RefusalKind::limit, "size", "more than 2^29 coefficients");
    std::vector<double> t;
    for (int i = -degree; i <= size; ++i) t.push_back(std::clamp(i, 0, size - degree));
    return make(degree, std::move(t));
}

int BSplineBasis::span(double u) const {
    const double* t = knots_.data();
    const int last = unwound();
    if (!(u < t[last])) {  // also NaN: any span will do
        int s = last - 1;
        while (t[s] == t[last]) --s;
        return s;
    }
    return int(std::upper_bound(t + degree_ + 1, t + last, std::max(u, t[degree_])) - t) - 1;
}

double BSplineBasis::wrap(double u) const {
    const Interval on = domain();
    if (!is_closed() || on.contains(u)) return u;
    const double period = on.length(), ahead = u - on.lo;
    const double r =
        std::isfinite(ahead) ? std::fmod(ahead, period) : 2 * std::fmod(u / 2 - on.lo / 2, period / 2);
    return std::clamp(r < 0 ? on.hi + r : on.lo + r, on.lo, on.hi);
}

int BSplineBasis::multiplicity(double u) const {
    const auto count = [](std::span<const double> sorted, double t) {
        return int(std::ranges::equal_range(sorted, t).size());
    };
    if (!is_closed()) return count(knots_, u);
    const auto once = defining().first(std::size_t(size()));  // one period without its last break
    const auto [lo, hi] = domain();
    if (u != lo && u != hi) return count(once, u);
    return count(once, lo) + count(once, hi);
}

std::vector<double> BSplineBasis::breaks() const {
    std::vector<double> b;
    for (int i = degree_; i <= unwound(); ++i)
        if (b.empty() || knot(i) != b.back()) b.push_back(knot(i));
    return b;
}

}  // namespace freiform
