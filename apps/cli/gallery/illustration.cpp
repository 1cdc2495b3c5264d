// R32 and R35: what illustration programs do with curves, and gradients.
#include "gallery/gallery.hpp"
#include "gallery/regions.hpp"

#include <freiform/colour/mesh_gradient.hpp>
#include <freiform/region/stroke.hpp>

namespace freiform::cli::gallery {

Plot& filled(Plot& plot, const Path& path, const Colour& colour) {
    DrawnGroup inside{"", "area", mixed(colour, kWhite, 0.65), 0, {}, {}, {}};
    DrawnGroup outline{"", "lines", colour, 1.6, {}, {}, {}};
    for (const Subpath& s : path.subpaths) {
        DrawnPath drawn{s.start, {}, true, false, {}};
        for (const PathSegment& p : s.segments) {
            if (p.weight == 1) {
                drawn.segments.push_back({p.degree, {}});
                for (std::size_t k = 0; k < std::size_t(p.degree); ++k)
                    drawn.segments.back().points[k] = p.points[k + 1];
                continue;
            }
            const int parts = 1 + int(30 * std::acos(std::min(1.0, p.weight)));  // as the arc turns
            for (int i = 1; i <= parts; ++i) {
                const double t = double(i) / parts, a = (1 - t) * (1 - t), b = 2 * t * (1 - t) * p.weight,
                             c = t * t;
                drawn.segments.push_back(
                    {1, {(1 / (a + b + c)) * (a * p.points[0] + b * p.points[1] + c * p.points[2])}});
            }
        }
        inside.paths.push_back(drawn), outline.paths.push_back(std::move(drawn));
    }
    inside.area = true;
    plot.panel.groups.push_back(std::move(inside));
    plot.panel.groups.push_back(std::move(outline));
    return plot;
}

Path path_in(const Document& d, std::initializer_list<std::string_view> names) {
    Path path;
    for (const std::string_view name : names)
        path.subpaths.push_back(sure(subpath_of(curve_in(d, name), 1e-6)).subpath);
    return path;
}

Figure regions(const Document& d) {
    const Path drop = path_in(d, {"drop"}), star = path_in(d, {"star"}), line = path_in(d, {"line"});
    const RegionOptions how{.tolerance = 1e-6};
    std::vector<Panel> panels;
    for (const auto operation : {RegionOperation::union_of, RegionOperation::intersection,
                                 RegionOperation::difference, RegionOperation::exclusion}) {
        Plot plot(name_of(operation), name_of(operation));
        plot.curve(shape_in(d, "drop"), thin(kGrey)).curve(shape_in(d, "star"), thin(kGrey));
        filled(plot, sure(combine({drop}, {star, FillRule::nonzero}, operation, how)).path, kBlue);
        panels.push_back(std::move(plot.panel));
    }
    Plot stroke("stroke", "a stroke as an outline: dashes, round caps");
    StrokeStyle pen;
    pen.width = 0.3, pen.cap = LineCap::round, pen.dashes = {0.9, 0.55};
    filled(stroke, sure(stroked(line, pen, {.tolerance = 1e-4})).path, kOrange);
    stroke.curve(shape_in(d, "line"), thin(kGrey));
    panels.push_back(std::move(stroke.panel));
    Plot offsets("offsets", "regions made larger and smaller");
    for (const double distance : {0.3, 0.15, -0.15, -0.3})
        filled(offsets, sure(grown({drop}, {.distance = distance}, {.tolerance = 1e-4})).path, kGreen);
    offsets.curve(shape_in(d, "drop"), thin(kInk));
    panels.push_back(std::move(offsets.panel));
    return page("Regions and strokes", std::move(panels), 3, 1200, 860);
}

namespace {

void quad(Plot& plot, const std::array<Vec<2>, 4>& p, const Colour& colour, double width) {
    DrawnGroup group{"", "cells", colour, width, {}, {}, {}};
    group.fill = 1;
    group.paths.push_back({p[0], {{1, {p[1]}}, {1, {p[2]}}, {1, {p[3]}}}, true, false, {}});
    plot.panel.groups.push_back(std::move(group));
}

Plot strip(ColourSpace space) {
    Plot plot(name_of(space), name_of(space));
    const std::vector<ColourStop> stops = {
        {0, {0.78, 0.2, 0.1}}, {0.5, {1, 0.9, 0.5}}, {1, {0.05, 0.3, 0.75}}};
    const auto g = sure(Gradient::make(stops, {space, GradientOptions::Way::smooth}));
    constexpr int kParts = 128;
    for (int i = 0; i < kParts; ++i) {
        const double a = 4.0 * i / kParts, b = std::min(4.0, a + 4.0 / kParts);
        quad(plot, std::array<Vec<2>, 4>{{{{a, 0}}, {{b, 0}}, {{b, 0.5}}, {{a, 0.5}}}}, g((i + 0.5) / kParts),
             0.7);
    }
    return plot;
}

Plot mesh(const Document& d, std::string_view name, ColourSpace space) {
    Plot plot(name, text("a mesh of colours, mixed in ", name_of(space)));
    const auto found = std::ranges::find(d.objects, name, &Object::name);
    const auto& surface = std::get<Surface<Vec<2>>>(found->shape);
    const auto m = sure(MeshGradient::make(surface, found->colours, space));
    const auto g = m.grid(24);
    for (int i = 0; i + 1 < g.rows; ++i)
        for (int j = 0; j + 1 < g.columns; ++j) {
            const auto at = [&](int a, int b) {
                return std::size_t(i + a) * std::size_t(g.columns) + std::size_t(j + b);
            };
            const Colour c = mixed(mixed(g.colours[at(0, 0)], g.colours[at(1, 1)], 0.5),
                                   mixed(g.colours[at(0, 1)], g.colours[at(1, 0)], 0.5), 0.5);
            const std::array<Vec<2>, 4> ring = {g.points[at(0, 0)], g.points[at(0, 1)], g.points[at(1, 1)],
                                                g.points[at(1, 0)]};
            quad(plot, ring, c, 0.7);  // lines around it, so that nothing shines through
        }
    return plot;
}

}  // namespace

Figure gradients(const Document& d) {
    std::vector<Panel> panels;
    for (const auto space : {ColourSpace::srgb, ColourSpace::linear, ColourSpace::oklab, ColourSpace::oklch})
        panels.push_back(std::move(strip(space).panel));
    panels.push_back(std::move(mesh(d, "sail", ColourSpace::srgb).panel));
    panels.push_back(std::move(mesh(d, "sail", ColourSpace::oklab).panel));
    return page("Gradients", std::move(panels), 2, 1100, 1000);
}

}  // namespace freiform::cli::gallery
