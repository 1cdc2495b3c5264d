// Ticks are at multiples of 1, 2 or 5 times a power of ten, the smallest of these that keeps them 60 pixels
// apart.
#include "io/figure_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::figure {

namespace {

constexpr double kApart = 60;  // pixels
constexpr int kMostTicks = 200;

struct Ticks {
    int factor = 1, exponent = 0;  // the step is factor 10^exponent
    double step() const { return factor * std::pow(10.0, exponent); }
    // k steps, as the double nearest to the decimal number.
    double at(long long k) const {
        return exponent < 0 ? double(k * factor) / std::pow(10.0, -exponent)
                            : double(k * factor) * std::pow(10.0, exponent);
    }
};

Ticks ticks_of(double pixels_per_unit) {
    Ticks t;
    const double least = kApart / pixels_per_unit;
    if (!(least > 1e-15 && least < 1e15)) return t;
    t.exponent = int(std::floor(std::log10(least)));
    for (const int factor : {1, 2, 5})
        if (t.factor = factor; t.step() >= least) return t;
    t.factor = 1;
    ++t.exponent;
    return t;
}

// With a minus sign instead of a hyphen.
DrawnText number(double x) { return plain_text(x < 0 ? text("\u2212", -x) : text(x)); }

}  // namespace

std::vector<DrawnGroup> axes_of(const Panel& panel, const Placed& placed) {
    if (panel.axes == Axes::none) return {};
    const auto group = [&](std::string role, const Colour& colour, double width) {
        DrawnGroup g{"", std::move(role), colour, width, {}, {}, {}};
        g.layer = panel.name;
        return g;
    };
    DrawnGroup grid = group("grid", kFaint, 0.8), axes = group("axes", kInk, 1.1),
               words = group("ticks", kInk, 1);
    const Vec<2> lo = placed(placed.shown.lo), hi = placed(placed.shown.hi);  // in pixels, hi[1] < lo[1]
    const double left = lo[0], bottom = lo[1];
    for (int axis = 0; axis < 2; ++axis) {
        const Interval on = placed.shown.side(axis);
        const Ticks ticks = ticks_of(placed.scale[axis]);
        const double first = std::ceil(on.lo / ticks.step() - 1e-9), last = on.hi / ticks.step() + 1e-9;
        if (!(last - first < kMostTicks && std::abs(first) < 1e15)) continue;
        for (double k = first; k <= last; ++k) {
            const double value = ticks.at((long long)(k));
            Vec<2> p{};
            p[axis] = value;
            const double x = placed(p)[axis];
            if (axis == 0) {
                grid.paths.push_back(line_through(std::array{Vec<2>{{x, bottom}}, Vec<2>{{x, hi[1]}}}));
                axes.paths.push_back(line_through(std::array{Vec<2>{{x, bottom}}, Vec<2>{{x, bottom + 5}}}));
                words.labels.push_back({{{x, bottom + 19}}, number(value), kSmallText, Anchor::middle});
            } else {
                grid.paths.push_back(line_through(std::array{Vec<2>{{left, x}}, Vec<2>{{hi[0], x}}}));
                axes.paths.push_back(line_through(std::array{Vec<2>{{left - 5, x}}, Vec<2>{{left, x}}}));
                words.labels.push_back(
                    {{{left - 9, x + 0.33 * kSmallText}}, number(value), kSmallText, Anchor::end});
            }
        }
    }
    const auto axis_line = [&](const Vec<2>& to) {
        axes.paths.push_back(line_through(std::array{Vec<2>{{left, bottom}}, to}));
    };
    axis_line({{hi[0], bottom}});
    axis_line({{left, hi[1]}});
    if (!panel.x_name.empty())
        words.labels.push_back({{{hi[0], bottom + 36}}, panel.x_name, 15, Anchor::end});
    if (!panel.y_name.empty())
        words.labels.push_back({{{left, hi[1] - 10}}, panel.y_name, 15, Anchor::middle});
    std::vector<DrawnGroup> out;
    if (panel.axes == Axes::grid) out.push_back(std::move(grid));
    out.push_back(std::move(axes));
    out.push_back(std::move(words));
    return out;
}

}  // namespace freiform::figure
