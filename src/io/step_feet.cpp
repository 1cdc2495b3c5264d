// A polygon of nearest points as parameter curve: the last resort at poles and folds. Each point is looked
// for from the one before it, so that the polygon is continuous where parameters are periodic. At a pole,
// where all values of one parameter are the same point, it keeps the value that it came with. And a polygon
// with few corners, for edges that run into themselves within the distance by which they lie beside the
// surface.
#include "step_trace.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kFeet = 64;
constexpr int kPlacesOfPolygon = 48;  // where corners may be
constexpr int kMostLooks = 8000;      // at a polygon and its edge
constexpr double kAtPole = 1e-7;      // of the way that an edge goes from a pole
constexpr double kAlongPole = 1e-3;   // of its parameters: less is an edge along the pole

void keep_at_pole(std::vector<Vec<2>>& net, const Pole& pole) {
    const int free = 1 - pole.axis;
    double farthest = 0;
    for (const Vec<2>& uv : net) farthest = std::max(farthest, std::abs(uv[pole.axis] - pole.at));
    if (farthest <= kAlongPole * (farthest + std::abs(net.front()[free] - net.back()[free]))) return;
    const auto keep = [&](Vec<2>& uv, const Vec<2>& beside) {
        if (std::abs(uv[pole.axis] - pole.at) > kAtPole * farthest || beside[pole.axis] == pole.at) return;
        uv[pole.axis] = pole.at, uv[free] = beside[free];
    };
    for (std::size_t i = 1; i < net.size(); ++i) keep(net[i], net[i - 1]);
    for (std::size_t i = net.size() - 1; i-- > 0;) keep(net[i], net[i + 1]);
}

}  // namespace

std::optional<Trace> polygon_of_feet(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                     double rough) {
    const auto place = [&](int i, int n) { return i == n ? on.hi : on.lo + on.length() * i / n; };
    const auto gap_at = [&](const Vec<2>& uv, double t) {
        return norm(chart.point(uv) - jet<0>(c, t).value());
    };
    const auto near = [&](const Vec<2>& a, const Vec<2>& b) {
        for (int k = 0; k < 2; ++k)
            if (chart.period(k) > 0 && std::abs(a[k] - b[k]) > 0.05 * chart.period(k)) return false;
        return true;
    };
    std::vector<double> knots{on.lo};
    std::vector<Vec<2>> net;
    for (int i = 0; i <= kFeet; ++i) {
        const double t = place(i, kFeet);
        const Vec<3> p = jet<0>(c, t).value();
        const Vec<2> guess = net.empty() ? chart.locate(p) : net.back();
        net.push_back(chart.damped_foot(p, guess));
        if (i > 0 && chart.point(net.back()) == chart.point(guess)) {  // stuck at a pole
            const Vec<2> other = chart.damped_foot(p, chart.locate(p));
            if (near(other, guess) && gap_at(other, t) < gap_at(net.back(), t)) net.back() = other;
        }
        knots.push_back(t);
    }
    knots.push_back(on.hi);
    for (const Pole& p : chart.poles()) keep_at_pole(net, p);
    auto basis = BSplineBasis::make(1, std::move(knots));
    if (!basis) return std::nullopt;
    Trace out;
    out.fitted = true;
    out.curve = Curve<Vec<2>>::trusted({*std::move(basis)}, Net<1, Vec<2>>({kFeet + 1}, std::move(net)));
    for (int i = 0; i <= 3 * kFeet; ++i) {
        const double t = place(i, 3 * kFeet), gap = gap_at(jet<0>(out.curve, t).value(), t);
        if (!(gap <= rough)) return std::nullopt;
        out.gap = std::max(out.gap, gap);
    }
    return out;
}

std::optional<Trace> coarse_polygon(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                    const CurveGeometry<2>& fine, double beside, double accuracy) {
    constexpr int n = kPlacesOfPolygon;
    std::array<double, n + 1> t{};
    std::array<Vec<2>, n + 1> uv{};
    std::array<Vec<3>, n + 1> at{};
    for (int i = 0; i <= n; ++i) {
        const auto k = std::size_t(i);
        t[k] = i == n ? on.hi : on.lo + on.length() * i / n;
        uv[k] = chart.inside(jet<0>(fine, t[k]).value());
        at[k] = jet<0>(c, t[k]).value();
    }
    double gap = 0;  // of the last polygon that was looked at
    int looks = 0;
    const auto follows = [&](std::size_t i, std::size_t j) {
        gap = 0;
        for (std::size_t k = i; k < j && gap <= accuracy; ++k)
            for (const double y : {0.0, 0.5}) {
                ++looks;
                const double s = t[k] + y * (t[k + 1] - t[k]), x = (s - t[i]) / (t[j] - t[i]);
                const Vec<3> p = y == 0 ? at[k] : jet<0>(c, s).value();
                gap = std::max(gap, norm(chart.point(uv[i] + x * (uv[j] - uv[i])) - p));
            }
        return gap <= accuracy;
    };
    const auto may_be_corner = [&](std::size_t k) {
        const Vec<3> p = chart.point(uv[k]);
        return norm(p - chart.point(uv[0])) > beside && norm(p - chart.point(uv[n])) > beside;
    };
    std::vector<double> knots{on.lo, on.lo};
    std::vector<Vec<2>> net{uv[0]};
    Trace out;
    for (std::size_t i = 0; i < n;) {
        std::size_t j = n;
        while (j > i && looks <= kMostLooks && !((j == n || may_be_corner(j)) && follows(i, j))) --j;
        if (j == i || uv[i] == uv[j] || looks > kMostLooks) return std::nullopt;
        out.gap = std::max(out.gap, gap);
        knots.push_back(t[j]), net.push_back(uv[j]);
        i = j;
    }
    knots.push_back(on.hi);
    auto basis = BSplineBasis::make(1, std::move(knots));
    if (!basis) return std::nullopt;
    out.fitted = true;
    const int size = int(net.size());
    out.curve = Curve<Vec<2>>::trusted({*std::move(basis)}, Net<1, Vec<2>>({size}, std::move(net)));
    return out;
}

}  // namespace freiform::step
