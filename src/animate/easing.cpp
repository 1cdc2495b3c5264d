// Easing by a cubic Bezier curve: y(x) = y(s) where x(s) = x.
//
// Idea: x(s) does not decrease for x1, x2 in [0, 1], so a sign of x(s) - x that is sure on both sides
// encloses every solution. Newton's method within a bracket finds s to rounding; then steps outwards, each
// twice as long as the one before, go on until the signs on both sides are proven by running error analysis
// (core/bounded.hpp).
//
// Accuracy: with |s' - s| <= w for every exact solution s', |y(s') - y(s)| <= (|y'(s)| + w max |y''|) w, and
// |y''| <= 6 max |second difference|. Where x'(s) = 0, w is of the order of a root of the roundoff, and so is
// the change of the exact y under a change of x in its last digit, unless y' vanishes there too.
//
// Why monotone: x'(s) / 3 = x1 (1 - s)^2 + 2 (x2 - x1) s (1 - s) + (1 - x2) s^2; x2 - x1 >= -1 is smallest at
// x1 = 1, x2 = 0, where it is (1 - 2 s)^2.
//
// References: the CSS Easing Functions specification; [Higham 2002, 3.3].
#include <freiform/animate/easing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform {
namespace detail {

Bounded cubic_at(const std::array<Bounded, 4>& y, const Bounded& s) {
    const Bounded r = Bounded(1) - s;
    return r * r * (r * y[0] + Bounded(3) * s * y[1]) + s * s * (Bounded(3) * r * y[2] + s * y[3]);
}

Bounded cubic_at(const std::array<double, 4>& y, const CubicPlace& p) {
    const Bounded v = cubic_at({Bounded(y[0]), y[1], y[2], y[3]}, Bounded(p.at));
    if (p.off == 0) return v;
    const double s = p.at, r = 1 - s;
    const std::array d = {y[1] - y[0], y[2] - y[1], y[3] - y[2]};
    const double size = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    const double slope = 3 * std::abs(d[0] * r * r + 2 * d[1] * r * s + d[2] * s * s) + 0x1p-46 * size,
                 bend = 6 * std::max(std::abs(d[1] - d[0]), std::abs(d[2] - d[1])) + 0x1p-46 * size;
    return {v.value, above(v.bound + (slope + bend * p.off) * p.off)};
}

CubicPlace place_on_monotone_cubic(const std::array<double, 4>& x, double wanted) {
    const auto side = [&](double s) {
        return cubic_at({Bounded(x[0]), x[1], x[2], x[3]}, Bounded(s)) - Bounded(wanted);
    };
    double lo = 0, hi = 1, s = 0.5;
    if (x[3] > x[0]) s = std::clamp((wanted - x[0]) / (x[3] - x[0]), 0.0, 1.0);
    for (int i = 0; i < 80; ++i) {
        const double f = side(s).value, r = 1 - s;
        if (f == 0) break;
        (f > 0 ? hi : lo) = s;
        const double slope = 3 * ((x[1] - x[0]) * r * r + 2 * (x[2] - x[1]) * r * s + (x[3] - x[2]) * s * s);
        double next = s - f / slope;
        // Newton's steps are left to halving where they leave the bracket, or creep after many.
        if (!(next > lo && next < hi) || i > 20) next = lo / 2 + hi / 2;
        if (std::abs(next - s) <= 0x1p-54 * s) break;
        s = next;
    }
    // Everything exact is between `below` and `beyond`.
    double below = s, beyond = s, step = std::max(0x1p-54 * s, 0x1p-1040);
    for (; below > 0; step *= 2) {
        below = std::max(0.0, s - step);
        const Bounded f = side(below);
        if (f.value + f.bound < 0) break;
    }
    step = std::max(0x1p-54 * s, 0x1p-1040);
    for (; beyond < 1; step *= 2) {
        beyond = std::min(1.0, s + step);
        const Bounded f = side(beyond);
        if (f.value - f.bound > 0) break;
    }
    return {s, above(std::max(s - below, beyond - s))};
}

}  // namespace detail

Result<CubicBezierEasing> CubicBezierEasing::make(double x1, double y1, double x2, double y2) {
    const std::array<double, 4> all = {x1, y1, x2, y2};
    static constexpr const char* kNames[] = {"x1", "y1", "x2", "y2"};
    for (std::size_t i = 0; i < 4; ++i) {
        if (!std::isfinite(all[i])) return refuse(RefusalKind::nonfinite, kNames[i], "a number is expected");
        if (i % 2 == 0 && !(all[i] >= 0 && all[i] <= 1))
            return refuse(RefusalKind::invalid, kNames[i],
                          text("it is ", all[i], "; between 0 and 1 the curve is the graph of a function"));
    }
    return CubicBezierEasing(all);
}

Result<CubicBezierEasing> CubicBezierEasing::named(std::string_view name) {
    static constexpr std::pair<std::string_view, std::array<double, 4>> kNamed[] = {
        {"linear", {0, 0, 1, 1}},      {"ease", {0.25, 0.1, 0.25, 1}},      {"ease-in", {0.42, 0, 1, 1}},
        {"ease-out", {0, 0, 0.58, 1}}, {"ease-in-out", {0.42, 0, 0.58, 1}},
    };
    for (const auto& [known, handles] : kNamed)
        if (known == name) return CubicBezierEasing(handles);
    return refuse(RefusalKind::invalid, "",
                  text("easing \"", name, "\" is not one of linear, ease, ease-in, ease-out, ease-in-out"));
}

Bounded CubicBezierEasing::operator()(double x) const {
    const auto [x1, y1, x2, y2] = handles_;
    if (std::isnan(x)) return {x, std::numeric_limits<double>::infinity()};
    if (x < 0) {
        if (x1 > 0) return Bounded(x) * (Bounded(y1) / Bounded(x1));
        if (y1 == 0 && x2 > 0) return Bounded(x) * (Bounded(y2) / Bounded(x2));
        return {};
    }
    if (x > 1) {
        const Bounded beyond = Bounded(x) - Bounded(1);
        const auto slope = [](double px, double py) {
            return (Bounded(1) - Bounded(py)) / (Bounded(1) - Bounded(px));
        };
        if (x2 < 1) return Bounded(1) + beyond * slope(x2, y2);
        if (y2 == 1 && x1 < 1) return Bounded(1) + beyond * slope(x1, y1);
        return {1};
    }
    if (x1 == y1 && x2 == y2) return {x};
    return detail::cubic_at({0, y1, y2, 1}, detail::place_on_monotone_cubic({0, x1, x2, 1}, x));
}

double step_easing(double x, int count, StepJump jump) {
    FF_REQUIRE(count >= (jump == StepJump::neither ? 2 : 1));
    const bool at_start = jump == StepJump::start || jump == StepJump::both;
    const int jumps = count + (jump == StepJump::both ? 1 : jump == StepJump::neither ? -1 : 0);
    // The step whose beginning, a rounded quotient in both, is not after x.
    double step = std::floor(x * count);
    if ((step + 1) / count <= x) ++step;
    if (step / count > x) --step;
    step += at_start ? 1 : 0;
    if (x >= 0 && step < 0) step = 0;
    if (x <= 1 && step > jumps) step = jumps;
    return step / jumps;
}

}  // namespace freiform
