// R28 and R29: rational surfaces, and triangles.
#include "gallery/gallery.hpp"

#include <freiform/make/quadric.hpp>
#include <freiform/make/triangle_joint.hpp>
#include <freiform/spline/simplex_construction.hpp>

namespace freiform::cli::gallery {

namespace {

using Patch3 = SimplexPatch<2, Vec<3>>;

// The small triangles of a net that point away from corner 1.
Plot& net(Plot& plot, int degree, std::span<const Vec<3>> b, Look look) {
    for (int row = 1; row <= degree; ++row)
        for (int k = 0; k < row; ++k) {
            const int j = row - 1 - k;
            const auto at = [&](int x, int y) { return b[Patch3::slot(x, y)]; };
            plot.curve(Patch3::trusted(1, {at(j, k), at(j + 1, k), at(j, k + 1)}), look);
            look.legend = {};
        }
    return plot;
}

template <class P>
Shape edge_of(const SimplexPatch<2, P>& s, int edge) {
    const auto curve = boundary(s, edge);
    return bezier(std::vector<P>(curve.net().flat().begin(), curve.net().flat().end()));
}

// Curves on which one barycentric coordinate is constant, and the edges.
template <class P>
Plot& lines_of(Plot& plot, const SimplexPatch<2, P>& s, const Colour& colour, int count = 6) {
    for (int i = 1; i < count; ++i) {
        const double t = double(i) / count, r = 1 - t;
        plot.curve(edge_of(restrict_to(s, std::array<Param<2>, 3>{{{0, 0}, {t, 0}, {0, t}}}), 0),
                   {mixed(colour, {1, 1, 1, 1}, 0.45), 1, "", {}});
        plot.curve(edge_of(restrict_to(s, std::array<Param<2>, 3>{{{r, 0}, {1, 0}, {r, t}}}), 1),
                   {mixed(colour, {1, 1, 1, 1}, 0.45), 1, "", {}});
        plot.curve(edge_of(restrict_to(s, std::array<Param<2>, 3>{{{0, r}, {t, r}, {0, 1}}}), 2),
                   {mixed(colour, {1, 1, 1, 1}, 0.45), 1, "", {}});
    }
    return plot.curve(s, {colour, 2.2, "", {}});
}

}  // namespace

Figure rational_surfaces(const Document& d) {
    const Turn most{{0, 1.5 * std::numbers::pi}};
    std::vector<Panel> panels;
    const auto add = [&](std::string_view name, const Shape& s, const Colour& colour) {
        Plot plot(name, name);
        plot.shape(s, {}, colour);
        panels.push_back(plot.panel);
    };
    add("a sphere of integers", shape_in(d, "sphere"), kBlue);
    Plot six("six patches, no pole", "six patches, no pole");
    const auto tiles = sure(sphere_in_six({}, 1));
    for (const auto& face : tiles.faces) six.shape(face, {}, kOrange);
    panels.push_back(six.panel);
    Plot eight("octants", "octants: triangles of degree 4");
    for (const auto& o : sure(sphere_in_eight({}, 1)).octants) lines_of(eight, o, kGreen, 4);
    panels.push_back(eight.panel);
    add("cylinder", sure(cylinder({}, 1, {0, 2}, most)).surface, kSky);
    add("cone", sure(cone({}, 1, 0.3, {0, 1.6}, most)).surface, kPurple);
    add("torus", sure(torus({}, 2, 0.75, most)).surface, kOchre);
    return page("Exact surfaces: every point is where it should be, but for rounding", std::move(panels), 3,
                1280, 900);
}

Figure triangles(const Document& d) {
    const auto& s = std::get<Patch3>(shape_in(d, "triangle"));
    Plot control("net", "ten control points, *b*_{300} to *b*_{003}");
    lines_of(control, s, kBlue);
    net(control, 3, s.coefficients(), thin(kGrey, "control net"));
    Plot steps("de Casteljau", "de Casteljau at (0.4, 0.25, 0.35)");
    const auto all = sure(de_casteljau(s, {0.25, 0.35}));
    net(steps, 3, all.level(0), thin(kGrey));
    net(steps, 2, all.level(1), {kOrange, 1.4, "degree 2", {}});
    net(steps, 1, all.level(2), {kGreen, 2, "degree 1: tangent plane", {}});
    const Vec<3>& p = all.point();
    const double size = 0.03;  // a mark at the point: a small triangle
    steps.curve(
        Patch3::trusted(1, {p - Vec<3>{{size, size, 0}}, p + Vec<3>{{size, 0, 0}}, p + Vec<3>{{0, size, 0}}}),
        {kInk, 5, "", {}});
    steps.curve(s, {kBlue, 2.2, "", {}});
    Plot four("four parts", "four parts with their nets");
    const Colour colours[] = {kBlue, kOrange, kGreen, kPurple};
    const auto parts = split_in_four(s);
    for (std::size_t i = 0; i < 4; ++i) {
        net(four, 3, parts[i].coefficients(), thin(mixed(colours[i], {1, 1, 1, 1}, 0.3)));
        four.curve(parts[i], {colours[i], 2.2, "", {}});
    }
    Plot joint("joint", "the next one: *C*^1 determines the pairs of triangles at the edge");
    const auto next =
        sure(next_c(s, 0, 1, {1, 1}, std::vector<Vec<3>>{{{3, 3, 0.2}}, {{2.1, 3.1, 0.9}}, {{3.2, 2, 0.8}}}));
    lines_of(joint, s, kBlue);
    lines_of(joint, next.patch, kOrange);
    net(joint, 3, s.coefficients(), thin(kGrey));
    net(joint, 3, next.patch.coefficients(), thin(kGrey));
    return page("A cubic triangle: its net, its points, its parts, its neighbour",
                {control.panel, steps.panel, four.panel, joint.panel}, 2, 1280, 1100);
}

}  // namespace freiform::cli::gallery
