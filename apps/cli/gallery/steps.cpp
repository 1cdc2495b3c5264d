// R18 to R20: where the points of a drawn curve are.
#include "gallery/gallery.hpp"

#include <freiform/path/flatten.hpp>
#include <freiform/path/forward_differences.hpp>
#include <freiform/query/length.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::cli::gallery {

namespace {

// Two digits and a power of ten: "1.2 \u00b7 10^{\u22124}".
std::string rounded(double x) {
    if (!(x > 0)) return "0";
    int e = int(std::floor(std::log10(x)));
    double m = std::round(x / std::pow(10.0, e) * 10) / 10;
    if (m >= 10) m /= 10, ++e;
    if (e >= -2 && e <= 2) return text(std::round(x * 1000) / 1000);
    return text(m, " \u00b7 10^{", e < 0 ? "\u2212" : "", std::abs(e), "}");
}

Plot polyline(std::string_view name, std::string_view caption, const Curve<Vec<2>>& c, const Points& p) {
    Plot plot(name, caption);
    plot.curve(c, {mixed(kSky, {1, 1, 1, 1}, 0.35), 4, "curve", {}});
    plot.lines(p, {kOrange, 1.5, "what is drawn", {}}).dots(p, kOrange, 3.4);
    return plot;
}

}  // namespace

Figure forward_differences(const Document& d) {
    const auto& c = curve_in(d, "cubic");
    const std::span<const Vec<2>> b = c.net().flat();
    const auto line = sure(flatten(c, FlattenOptions{.method = FlattenMethod::forward, .segments = 12}));
    const Plot a = polyline("steps", "12 equal steps by forward differences", c, line.points);
    Plot e("error", "error after *n* steps, in doubles");
    Points measured, proven;
    for (int k = 3; k <= 17; ++k) {
        const int n = 1 << k;
        ForwardDifferences<Vec<2>> f(b, n);
        double worst = 0;
        for (int i = 1; i <= n; ++i) {
            f.advance();
            worst = std::max(worst, max_abs(f.value() - c(double(i) / n)));
        }
        measured.push_back({{double(k), std::log10(std::max(worst, 0x1p-60))}});
        proven.push_back({{double(k), std::log10(max_abs(f.drift()))}});
    }
    e.lines(proven, {kGrey, 1.6, "proven bound", {6, 4}}).dots(proven, kGrey, 3);
    e.lines(measured, {kBlue, 2, "measured", {}}).dots(measured, kBlue, 3.2);
    e.stretched().axes(Axes::grid, "log_2 *n*", "log_{10} of the error");
    return page("Equal parameter steps: three additions per coordinate and point", {a.panel, e.panel}, 0,
                1280, 560);
}

Figure halving(const Document& d) {
    const auto& c = curve_in(d, "bend");
    FlattenOptions how{.method = FlattenMethod::halving, .tolerance = 0.02};
    const auto halves = sure(flatten(c, how));
    const int n = int(halves.segments());
    how.polygons = true;
    how.tolerance = 0.2;
    const auto polygons = sure(flatten(c, how));
    const auto even = sure(flatten(c, FlattenOptions{.method = FlattenMethod::uniform, .segments = n}));
    const auto said = [](double bound) { return text(", within ", rounded(bound)); };
    const Plot u = polyline("uniform", text(n, " equal steps", said(even.bound)), c, even.points);
    const Plot h = polyline("halving", text(n, " segments by halving", said(halves.bound)), c, halves.points);
    const Plot p = polyline("polygons", "halving: the control polygons of a last level", c, polygons.points);
    Plot t("table", "proven distance at equal effort");
    t.share(1.25);
    const std::array<double, 4> columns{0, 1.5, 3.1, 4.7};
    constexpr std::array<std::string_view, 4> kHeads{"segments", "equal steps", "halving", "adaptive"};
    for (std::size_t k = 0; k < 4; ++k) t.fixed({{columns[k], 0}}, kHeads[k], kGrey, 14);
    t.lines({{{-0.6, -0.35}}, {{5.4, -0.35}}}, thin(kGrey));
    double y = -0.8;
    for (int segments = 4; segments <= 128; segments *= 2, y -= 0.75) {
        t.fixed({{columns[0], y}}, text(segments));
        for (const FlattenComparison& f : sure(compare_flattening(c, segments))) {
            if (f.polygons || f.method == FlattenMethod::forward) continue;
            const std::size_t k = f.method == FlattenMethod::uniform   ? 1
                                  : f.method == FlattenMethod::halving ? 2
                                                                       : 3;
            t.fixed({{columns[k], y}}, rounded(f.bound));
        }
    }
    return page("Halving puts its points where the curve bends", {u.panel, h.panel, p.panel, t.panel}, 2,
                1280, 900);
}

Figure equal_distances(const Document& d) {
    const auto& c = curve_in(d, "cubic");
    constexpr int kParts = 16;
    const ArcLength<Vec<2>> length(c, 1e-9);
    Points even, spaced;
    for (int i = 0; i <= kParts; ++i) even.push_back(c(double(i) / kParts));
    const auto places = sure(length.equal_parts(kParts));
    for (const PlaceAtLength& p : places) spaced.push_back(c(p.parameter));
    Plot a("parameter", "16 equal steps of the parameter"), b("distance", "16 equal distances");
    a.curve(c).dots(even, kOrange, 4.4);
    b.curve(c).dots(spaced, kGreen, 4.4);
    Plot s("length", text("arc length *s*(*t*), ", rounded(length.total().value), " in all"));
    for (const PlaceAtLength& p : places) {
        const double at = sure(length.at(p.parameter)).value;
        s.lines({{{0, at}}, {{p.parameter, at}}, {{p.parameter, 0}}},
                {mixed(kGreen, {1, 1, 1, 1}, 0.5), 0.8, "", {}});
    }
    s.graph([&](double t) { return sure(length.at(t)).value; }, {0, 1}, {kBlue, 2.4, "", {}}, 160);
    s.stretched().axes(Axes::ticks, "*t*", "*s*");
    return page("Arc length: points at equal distances", {a.panel, b.panel, s.panel}, 0, 1280, 520);
}

}  // namespace freiform::cli::gallery
