// Idea. A map is a path in a space where distance is what the eye sees, walked at even speed: then no step
// stands out that the numbers do not have (the bands of the usual rainbow) and none disappears. Lightness
// rises all the way (or to the middle and down again), so a map is read in grey print and by the
// colour-blind.
//
// Method. Corners of the path are given by lightness, chroma and hue; hue and chroma vary linearly between
// them. Points outside of sRGB lose chroma until they are inside. The path is then walked in equal steps of
// its length. The halves of the diverging map are straight lines of equal length from the white in the
// middle.
//
// References. [Ottosson 2020] for the space. Why not CIELAB: its blue turns violet where only lightness
// changes, and this map begins in blue.
#include "colour_detail.hpp"

#include <freiform/colour/colour_map.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace freiform {

namespace {

double distance(const Oklab& p, const Oklab& q) { return std::hypot(p.L - q.L, p.a - q.a, p.b - q.b); }

struct Corner {
    double L, chroma, hue;  // degrees
};

Oklab at(const Corner& c) {
    const double h = c.hue * std::numbers::pi / 180;
    const auto with = [&](double chroma) { return Oklab{c.L, chroma * std::cos(h), chroma * std::sin(h)}; };
    const auto has = [&](double chroma) {
        return std::ranges::all_of(detail::light_of(with(chroma)), [](double x) { return x >= 0 && x <= 1; });
    };
    if (has(c.chroma)) return with(c.chroma);
    double lo = 0, hi = c.chroma;
    for (int i = 0; i < 50; ++i) (has((lo + hi) / 2) ? lo : hi) = (lo + hi) / 2;
    return with(lo);
}

std::vector<Oklab> path(std::initializer_list<Corner> corners) {
    constexpr int kSteps = 500;
    std::vector<Oklab> out;
    for (const Corner* c = corners.begin(); c + 1 != corners.end(); ++c)
        for (int k = 0; k <= kSteps; ++k) {
            const double t = double(k) / kSteps;
            out.push_back(at({c[0].L + t * (c[1].L - c[0].L), c[0].chroma + t * (c[1].chroma - c[0].chroma),
                              c[0].hue + t * (c[1].hue - c[0].hue)}));
        }
    return out;
}

// `n` points at equal distances along the path, ends included.
std::vector<Oklab> evenly(const std::vector<Oklab>& p, int n) {
    double length = 0;
    for (std::size_t i = 1; i < p.size(); ++i) length += distance(p[i - 1], p[i]);
    std::vector<Oklab> out;
    double done = 0;
    std::size_t i = 1;
    for (int k = 0; k < n; ++k) {
        const double wanted = length * k / (n - 1);
        while (i + 1 < p.size() && done + distance(p[i - 1], p[i]) < wanted)
            done += distance(p[i - 1], p[i]), ++i;
        const double step = distance(p[i - 1], p[i]);
        const double t = step > 0 ? std::clamp((wanted - done) / step, 0.0, 1.0) : 0;
        const Oklab &a = p[i - 1], &b = p[i];
        out.push_back({a.L + t * (b.L - a.L), a.a + t * (b.a - a.a), a.b + t * (b.b - a.b)});
    }
    return out;
}

}  // namespace

Oklab to_oklab(const Colour& c) {
    const double r = detail::linear_light(c.r), g = detail::linear_light(c.g), b = detail::linear_light(c.b);
    const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double oklab_distance(const Colour& p, const Colour& q) { return distance(to_oklab(p), to_oklab(q)); }

ColourMap::ColourMap(MapKind kind) {
    constexpr Corner kMiddle{0.96, 0, 0};
    std::vector<Oklab> points;
    if (kind == MapKind::sequential) {
        points = evenly(path({{0.27, 0.11, 285},
                              {0.45, 0.11, 250},
                              {0.62, 0.11, 195},
                              {0.79, 0.15, 140},
                              {0.95, 0.15, 105}}),
                        kSize);
    } else {
        points = evenly(path({{0.42, 0.13, 258}, {kMiddle.L, 0, 258}}), kSize / 2 + 1);
        const auto red = evenly(path({{kMiddle.L, 0, 32}, {0.42, 0.13, 32}}), kSize / 2 + 1);
        points.insert(points.end(), red.begin() + 1, red.end());
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto light = detail::light_of(points[i]);
        const auto component = [&](std::size_t c) {
            return detail::encoded_light(std::clamp(light[c], 0.0, 1.0));
        };
        colours_[i] = {component(0), component(1), component(2), 1};
    }
}

Colour ColourMap::operator()(double t) const {
    const double x = (t > 0 ? std::min(t, 1.0) : 0) * (kSize - 1);
    const auto i = std::min(std::size_t(x), std::size_t(kSize - 2));
    const double f = x - double(i);
    const Colour &a = colours_[i], &b = colours_[i + 1];
    return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b), 1};
}

}  // namespace freiform
