// R27: loops in the plane of the parameters, and what they leave of a surface.
#include "gallery/gallery.hpp"
#include "gallery/space.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/trim/inside.hpp>

#include <algorithm>

namespace freiform::cli::gallery {

namespace {

Points loop_points(const std::vector<CurveGeometry<2>>& loop) {
    Points out;
    for (const CurveGeometry<2>& c : loop) {
        const Interval on = domain(c)[0];
        for (int i = 0; i < 160; ++i) out.push_back(jet<0>(c, on.lo + on.length() * i / 160).value());
    }
    return out;
}

// Loops inside of loops: those at even depth keep what is in them.
Plot& region(Plot& plot, const TrimmedSurface& s, const Colour& colour) {
    DrawnGroup kept{"", "area", mixed(colour, kWhite, 0.8), 1, {}, {}, {}}, holes = kept;
    holes.colour = kWhite;
    for (const auto& loop : s.loops) {
        const Vec<2> place = loop_points(loop).front();
        int depth = 0;
        for (const auto& other : s.loops)
            if (&other != &loop)
                depth += sure(InsideQuery::make(std::span(&other, 1), 0)).at(place).place == Place::inside;
        DrawnGroup& to = depth % 2 == 0 ? kept : holes;
        to.paths.push_back(line_through(loop_points(loop), true));
        to.paths.back().solid = true;
        if (depth > 1) {  // an island, over its hole
            plot.panel.groups.push_back(kept);
            plot.panel.groups.push_back(holes);
            kept.paths = {to.paths.back()};
            holes.paths.clear();
        }
    }
    plot.panel.groups.push_back(kept);
    plot.panel.groups.push_back(holes);
    for (const auto& loop : s.loops)
        for (const CurveGeometry<2>& c : loop)
            visit_one(
                [&](const auto& curve) {
                    if constexpr (requires { curve.net(); })
                        plot.curve(curve, {colour, 2.2, "", {}});
                    else
                        plot.lines(loop_points(loop), {colour, 2.2, "", {}}, true);
                },
                c);
    return plot;
}

// Where the half-line to the right of p crosses the loops, up to a pixel.
Points crossings_right_of(const Vec<2>& p, const TrimmedSurface& s) {
    Points out;
    for (const auto& loop : s.loops) {
        const Points l = loop_points(loop);
        for (std::size_t i = 0; i < l.size(); ++i) {
            const Vec<2>&a = l[i], &b = l[(i + 1) % l.size()];
            if ((a[1] > p[1]) == (b[1] > p[1])) continue;
            const double x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            if (x > p[0]) out.push_back({{x, p[1]}});
        }
    }
    sort(out, {}, [](const Vec<2>& q) { return q[0]; });
    return out;
}

void ray(Plot& plot, const Vec<2>& from, double to, const InsideQuery& query, std::string_view why) {
    const Inside answer = query.at(from);
    const Colour colour = answer.place == Place::inside ? kGreen : kOrange;
    plot.arrow(from, {{to, from[1]}}, {mixed(colour, kWhite, 0.2), 1.3, "", {}});
    plot.dots({from}, colour, 5, false, answer.place == Place::inside ? "inside" : "outside");
    if (!why.empty()) plot.note({{to, from[1]}}, why, {{1, 0}}, mixed(colour, kInk, 0.3), 14);
}

}  // namespace

Figure trimming(const Document& d) {
    const auto& s = std::get<TrimmedSurface>(shape_in(d, "surface"));
    const InsideQuery query = sure(InsideQuery::make(s.loops, 0));
    Plot plane("parameters", "loops in the plane of *u* and *v*");
    region(plane, s, kBlue).axes(Axes::ticks, "*u*", "*v*");
    for (const Vec<2>& p : points_of(curve_in(d, "places"))) {
        const Points hits = crossings_right_of(p, s);
        ray(plane, p, 1.08, query, text(hits.size()));
        plane.dots(hits, kInk, 3.6, true);
    }
    plane.window({{0, 0}}, {{1.12, 1}});
    const auto& hard = std::get<TrimmedSurface>(shape_in(d, "hard"));
    const InsideQuery exact = sure(InsideQuery::make(hard.loops, 0));
    Plot rays("rays", "rays that meet edges, vertices, tangents");
    region(rays, hard, kPurple);
    static constexpr std::array<std::string_view, 5> kWhy{"touches a tangent", "through two vertices",
                                                          "along an edge", "through a vertex",
                                                          "along the lowest edge"};
    const Points places = points_of(curve_in(d, "hard places"));
    for (std::size_t i = 0; i < places.size(); ++i) ray(rays, places[i], 6.6, exact, kWhy.at(i));
    rays.window({{-0.6, -0.2}}, {{8.6, 5}});
    Plot space("space", "what is left of the surface");
    DrawingOptions how;
    how.isolines = 9;
    together(space, {{s, {kBlue, 2, "", {}}}}, eye_at(-60, 38), how);
    return page("Trimming: inside is where a half-line crosses the loops an odd number of times",
                {plane.panel, rays.panel, space.panel}, 0, 1280, 540);
}

}  // namespace freiform::cli::gallery
