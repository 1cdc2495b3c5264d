// Gradients as splines of coordinates in a space of colours.
//
// Method. Stops become points of a curve of four coordinates: three of the colour and the opacity. Hues are
// unwound, so that the curve goes the shorter (or longer) way round. What the curve gives is brought back to
// sRGB at the end, so a curve of smooth coordinates stays smooth in the space in which it was made.
//
// Accuracy. That of the published matrices, 10 digits [Ottosson 2020]; colours come back within 1e-6.
//
// Why are components cut off, and not chroma taken away, where sRGB does not have a colour? The edge of sRGB
// is hollow in places (at blue, between green and cyan): with less chroma, a path that leaves it jumps; cut
// off, it bends.
//
// Why is opacity not multiplied in? The stops of CSS are premultiplied; a spline of premultiplied colours
// would pass other colours than its stops where opacity falls to 0. Between opaque colours both are the same.
#include "colour_detail.hpp"

#include <freiform/colour/gradient.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/make/named_curve.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

using detail::encoded_light;
using detail::linear_light;

std::string_view name_of(ColourSpace space) {
    static constexpr std::string_view kNames[] = {"srgb", "linear", "oklab", "oklch"};
    return kNames[int(space)];
}

Vec<3> coordinates(const Colour& c, ColourSpace space) {
    if (space == ColourSpace::srgb) return {{c.r, c.g, c.b}};
    if (space == ColourSpace::linear) return {{linear_light(c.r), linear_light(c.g), linear_light(c.b)}};
    const Oklab lab = to_oklab(c);
    if (space == ColourSpace::oklab) return {{lab.L, lab.a, lab.b}};
    return {{lab.L, std::hypot(lab.a, lab.b), std::atan2(lab.b, lab.a)}};
}

Colour colour_at(const Vec<3>& x, double opacity, ColourSpace space) {
    const double a = std::clamp(opacity, 0.0, 1.0);
    const auto component = [](double y) { return std::clamp(y, 0.0, 1.0); };
    if (space == ColourSpace::srgb) return {component(x[0]), component(x[1]), component(x[2]), a};
    const auto shown = [&](const std::array<double, 3>& light) {
        return Colour{component(encoded_light(component(light[0]))),
                      component(encoded_light(component(light[1]))),
                      component(encoded_light(component(light[2]))), a};
    };
    if (space == ColourSpace::linear) return shown({x[0], x[1], x[2]});
    const bool polar = space == ColourSpace::oklch;
    const double lightness = std::clamp(x[0], 0.0, 1.0);
    const Vec<2> ab = polar ? Vec<2>{{x[1] * std::cos(x[2]), x[1] * std::sin(x[2])}} : Vec<2>{{x[1], x[2]}};
    return shown(detail::light_of({lightness, ab[0], ab[1]}));
}

namespace {

constexpr double kGrey = 1e-4;  // chroma below which a hue means nothing

void unwind_hues(std::vector<Vec<4>>& p, bool longer) {
    const std::size_t n = p.size();
    std::size_t first = 0;
    while (first < n && p[first][1] < kGrey) ++first;
    if (first == n) first = 0;
    for (std::size_t i = 0; i < first; ++i) p[i][2] = p[first][2];
    for (std::size_t i = first + 1; i < n; ++i) {
        if (p[i][1] < kGrey) {
            p[i][2] = p[i - 1][2];
            continue;
        }
        double turn = std::remainder(p[i][2] - p[i - 1][2], kTwoPi);
        if (longer && turn != 0) turn -= std::copysign(kTwoPi, turn);
        p[i][2] = p[i - 1][2] + turn;
    }
}

std::optional<Refusal> trouble_with(std::span<const ColourStop> stops) {
    if (stops.size() < 2) return Refusal{RefusalKind::invalid, "stops", "at least two are expected"};
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const auto& [at, c] = stops[i];
        const std::string where = text("stops[", i, "]");
        if (!std::isfinite(at)) return Refusal{RefusalKind::nonfinite, where, "its place is not a number"};
        if (i > 0 && !(at > stops[i - 1].at))
            return Refusal{RefusalKind::invalid, where,
                           text("it is at ", at, ", not after ", stops[i - 1].at)};
        for (const double x : {c.r, c.g, c.b, c.a})
            if (!(x >= 0 && x <= 1))
                return Refusal{RefusalKind::invalid, where,
                               text("a component is ", x, ", not between 0 and 1")};
    }
    return std::nullopt;
}

}  // namespace

Result<Gradient> Gradient::make(std::span<const ColourStop> stops, const GradientOptions& options) {
    if (auto trouble = trouble_with(stops)) return std::unexpected(*std::move(trouble));
    const std::size_t n = stops.size();
    std::vector<Vec<4>> p, tangents(n);
    std::vector<double> at;
    for (const auto& [place, c] : stops) {
        const Vec<3> x = coordinates(c, options.space);
        p.push_back({{x[0], x[1], x[2], c.a}}), at.push_back(place);
    }
    if (options.space == ColourSpace::oklch) unwind_hues(p, options.longer_hue);
    using Way = GradientOptions::Way;
    if (options.way == Way::smooth) {
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, n - 1);
            tangents[i] = (1 / (at[b] - at[a])) * (p[b] - p[a]);
        }
        auto curve = hermite_spline<Vec<4>>(p, tangents, at);
        if (!curve) return std::unexpected(curve.error());
        return Gradient(*std::move(curve), options.space);
    }
    const int degree = options.way == Way::lines ? 1 : std::min(3, int(n) - 1);
    // Lines have their stops as knots; splines near them, the means of so many, so that they keep their
    // places.
    std::vector<double> knots(std::size_t(degree) + 1, at.front());
    for (std::size_t i = 1; i + std::size_t(degree) < n; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < std::size_t(degree); ++k) sum += at[i + k];
        knots.push_back(sum / degree);
    }
    knots.insert(knots.end(), std::size_t(degree) + 1, at.back());
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    auto curve = Curve<Vec<4>>::make({*std::move(basis)}, Net<1, Vec<4>>({int(n)}, std::move(p)));
    if (!curve) return std::unexpected(curve.error());
    return Gradient(*std::move(curve), options.space);
}

Colour Gradient::operator()(double t) const {
    const Interval on = domain();
    const Vec<4> x = curve_(t >= on.lo ? std::min(t, on.hi) : on.lo);
    return colour_at({{x[0], x[1], x[2]}}, x[3], space_);
}

Result<std::vector<ColourStop>> Gradient::stops_in_srgb(double tolerance) const {
    if (!(tolerance > 0)) return refuse(RefusalKind::invalid, "tolerance", "a positive number is expected");
    constexpr std::size_t kMost = 4096;
    const auto off = [&](double a, double b) {
        const Colour p = (*this)(a), q = (*this)(b);
        double most = 0;
        for (int k = 1; k < 9; ++k) {
            const double t = k / 9.0;
            const Colour c = (*this)(a + t * (b - a));
            const auto mixed = [&](double x, double y, double z) {
                return std::abs((1 - t) * x + t * y - z);
            };
            most = std::max({most, mixed(p.r, q.r, c.r), mixed(p.g, q.g, c.g), mixed(p.b, q.b, c.b),
                             mixed(p.a, q.a, c.a)});
        }
        return most;
    };
    std::vector<ColourStop> out;
    const std::vector<double> breaks = curve_.basis().breaks();
    std::vector<double> ahead(breaks.rbegin(), breaks.rend());
    double from = ahead.back();
    ahead.pop_back();
    out.push_back({from, (*this)(from)});
    while (!ahead.empty()) {
        const double to = ahead.back();
        if (off(from, to) > tolerance && to - from > 1e-9 * domain().length()) {
            if (out.size() + ahead.size() > kMost)
                return refuse(RefusalKind::limit, "tolerance",
                              text(tolerance, " takes more than ", kMost, " stops"));
            ahead.push_back(from / 2 + to / 2);
            continue;
        }
        out.push_back({to, (*this)(to)});
        from = to;
        ahead.pop_back();
    }
    return out;
}

Result<Colour> colour_named(std::string_view hex) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    const std::string_view d = hex.substr(std::min<std::size_t>(1, hex.size()));
    const bool known = hex.starts_with('#') &&
                       (d.size() == 3 || d.size() == 4 || d.size() == 6 || d.size() == 8) &&
                       std::ranges::all_of(d, [&](char c) { return digit(c) >= 0; });
    if (!known)
        return refuse(RefusalKind::invalid, "",
                      text("\"", hex.substr(0, 40), "\" is not a colour such as #c84018"));
    std::array<double, 4> all = {0, 0, 0, 1};
    const std::size_t each = d.size() < 6 ? 1 : 2;
    for (std::size_t i = 0; i * each < d.size(); ++i)
        all[i] = each == 1 ? digit(d[i]) / 15.0 : (16 * digit(d[2 * i]) + digit(d[2 * i + 1])) / 255.0;
    return Colour{all[0], all[1], all[2], all[3]};
}

std::string hex_of(const Colour& c) {
    std::string out = "#";
    const auto add = [&](double x) {
        const int v = int(std::lround(255 * std::clamp(x, 0.0, 1.0)));
        out += "0123456789abcdef"[v / 16], out += "0123456789abcdef"[v % 16];
    };
    add(c.r), add(c.g), add(c.b);
    if (c.a < 1) add(c.a);
    return out;
}

}  // namespace freiform
