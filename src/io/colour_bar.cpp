#include <freiform/core/decimal.hpp>
#include <freiform/io/colour_bar.hpp>
#include <freiform/io/figure.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kStrips = 128;
constexpr double kWidth = 18, kSize = 13, kLine = 17;

DrawnGroup strip(const Box<2>& box, const Colour& colour) {
    DrawnGroup g{"", "legend", colour, 0, {}, {}, {}};
    DrawnPath path = line_through(
        std::array{box.lo, Vec<2>{{box.hi[0], box.lo[1]}}, box.hi, Vec<2>{{box.lo[0], box.hi[1]}}}, true);
    path.solid = true;
    g.paths.push_back(std::move(path));
    return g;
}

Box<2> box(double x0, double y0, double x1, double y1) {
    Box<2> b;
    b.add(Vec<2>{{x0, y0}});
    b.add(Vec<2>{{x1, y1}});
    return b;
}

// Where a value is on the map.
double place(const ColourBar& bar, double value) {
    if (*bar.map == MapKind::diverging) {
        const double most = std::max(std::abs(bar.range.lo), std::abs(bar.range.hi));
        return most > 0 ? 0.5 + value / most / 2 : 0.5;
    }
    return bar.range.length() > 0 ? (value - bar.range.lo) / bar.range.length() : 0;
}

// Multiples of 1, 2 or 5 times a power of ten in the range, at most about 9.
std::vector<double> ticks(const Interval& on) {
    std::vector<double> out;
    if (!(on.length() > 0 && std::isfinite(on.length()))) return {on.lo};
    const double least = on.length() / 8;
    const int exponent = int(std::floor(std::log10(least)));
    for (int k = 0; k < 4; ++k) {
        const int factor = std::array{1, 2, 5, 10}[std::size_t(k)];
        const auto at = [&](double i) {
            return exponent < 0 ? i * factor / std::pow(10.0, -exponent)
                                : i * factor * std::pow(10.0, exponent);
        };
        if (at(1) < least) continue;
        for (double i = std::ceil(on.lo / at(1) - 1e-9);
             at(i) <= on.hi + 1e-9 * on.length() && out.size() < 20; ++i)
            out.push_back(at(i));
        break;
    }
    return out;
}

// A zero of either sign is "0"; without a power of ten where the range is not far from 1: 0.0005 beside
// 0.001.
DrawnText number(double value, const Interval& range) {
    const double most = std::max(std::abs(range.lo), std::abs(range.hi));
    std::string digits = text(std::abs(value));
    if (most >= 1e-4 && most < 1e6) digits.clear(), append_fixed(digits, shortest_decimal(std::abs(value)));
    return plain_text(value < 0 ? text("\u2212", digits) : digits);
}

}  // namespace

Drawing drawing_of(const ColourBar& bar, int width, int height) {
    Drawing d;
    d.width = width, d.height = height;
    const double right = width - 22.0, left = width - kColourBarRoom + 30;
    const double bottom = 0.5 * height + 0.3 * height, top = 0.5 * height - 0.3 * height;
    DrawnGroup words{"", "legend", kInk, 1, {}, {}, {}};
    words.labels.push_back({{{right, top - 22}}, bar.title, kSize + 2, Anchor::end});
    double below = bottom + 26;
    const auto remark = [&](const DrawnText& t, double size) {
        words.labels.push_back({{{right, below}}, t, size, Anchor::end});
        below += kLine;
    };
    if (bar.map) {
        const ColourMap map(*bar.map);
        const auto y = [&](double t) { return bottom + t * (top - bottom); };
        // From the top; each reaches down to the end, so that no seam is seen between two.
        for (int i = kStrips - 1; i >= 0; --i) {
            const double value = bar.range.lo + bar.range.length() * (i + 0.5) / kStrips;
            d.groups.push_back(
                strip(box(left, y((i + 1.0) / kStrips), left + kWidth, bottom), map(place(bar, value))));
        }
        DrawnGroup frame{"", "legend", kInk, 0.8, {}, {}, {}};
        const Box<2> around = box(left, top, left + kWidth, bottom);
        frame.paths.push_back(line_through(std::array{around.lo, Vec<2>{{around.hi[0], around.lo[1]}},
                                                      around.hi, Vec<2>{{around.lo[0], around.hi[1]}}},
                                           true));
        for (const double value : ticks(bar.range)) {
            const double at =
                bar.range.length() > 0 ? y((value - bar.range.lo) / bar.range.length()) : (top + bottom) / 2;
            frame.paths.push_back(
                line_through(std::array{Vec<2>{{left + kWidth, at}}, Vec<2>{{left + kWidth + 5, at}}}));
            words.labels.push_back(
                {{{left + kWidth + 9, at + 0.33 * kSize}}, number(value, bar.range), kSize});
        }
        d.groups.push_back(std::move(frame));
    } else {
        below = top;
    }
    if (bar.no_value) {
        d.groups.push_back(strip(box(left, below - 11, left + kWidth, below + 3), kNoValue));
        words.labels.push_back({{{left + kWidth + 9, below}}, plain_text("no value"), kSize});
        below += kLine + 4;
    }
    for (const DrawnText& t : bar.remarks) remark(t, kSize - 1);
    d.groups.push_back(std::move(words));
    return d;
}

}  // namespace freiform
