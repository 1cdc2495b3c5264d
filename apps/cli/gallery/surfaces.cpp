// R28 and R29: rational surfaces, and triangles.
#include "gallery/gallery.hpp"
#include "gallery/space.hpp"

#include <freiform/make/quadric.hpp>
#include <freiform/make/triangle_joint.hpp>
#include <freiform/spline/simplex_construction.hpp>

namespace freiform::cli::gallery {

namespace {

using Patch3 = SimplexPatch<2, Vec<3>>;

// The small triangles of a net that point away from corner 1.
Shown net(int degree, std::span<const Vec<3>> b, Look look) {
    std::vector<std::array<Vec<3>, 2>> lines;
    for (int row = 1; row <= degree; ++row)
        for (int k = 0; k < row; ++k) {
            const int j = row - 1 - k;
            const auto at = [&](int x, int y) { return b[Patch3::slot(x, y)]; };
            lines.push_back({at(j, k), at(j + 1, k)});
            lines.push_back({at(j + 1, k), at(j, k + 1)});
            lines.push_back({at(j, k + 1), at(j, k)});
        }
    return {segments(lines), std::move(look)};
}

template <class P>
Shape edge_of(const SimplexPatch<2, P>& s, int edge) {
    const auto curve = boundary(s, edge);
    return bezier(std::vector<P>(curve.net().flat().begin(), curve.net().flat().end()));
}

// The patch and curves on it along which one barycentric coordinate is constant.
template <class P>
void add_lines(std::vector<Shown>& to, const SimplexPatch<2, P>& s, const Colour& colour, int count = 6) {
    to.push_back({s, {colour, 2.2, "", {}}});
    const Look look{mixed(colour, {1, 1, 1, 1}, 0.45), 1, "", {}};
    for (int i = 1; i < count; ++i) {
        const double t = double(i) / count, r = 1 - t;
        const auto part = [&](const std::array<Param<2>, 3>& corners, int edge) {
            to.push_back({edge_of(restrict_to(s, corners), edge), look});
        };
        part({{{0, 0}, {t, 0}, {0, t}}}, 0);
        part({{{r, 0}, {1, 0}, {r, t}}}, 1);
        part({{{0, r}, {t, r}, {0, 1}}}, 2);
    }
}

DrawingOptions only_borders() {
    DrawingOptions how;
    how.isolines = 0;
    return how;
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
    Plot six("six patches, no pole", "six patches, no pole"),
        eight("octants", "octants: triangles of degree 4");
    std::vector<Shown> tiles, octants;
    for (const auto& face : sure(sphere_in_six({}, 1)).faces) tiles.push_back({face, {kOrange, 1.8, "", {}}});
    for (const auto& o : sure(sphere_in_eight({}, 1)).octants) add_lines(octants, o, kGreen, 4);
    const Eye turned = eye_at(-25, 28);
    DrawingOptions some;
    some.isolines = 5;
    panels.push_back(together(six, tiles, turned, some).panel);
    panels.push_back(together(eight, octants, turned, only_borders()).panel);
    add("cylinder", sure(cylinder({}, 1, {0, 2}, most)).surface, kSky);
    add("cone", sure(cone({}, 1, 0.3, {0, 1.6}, most)).surface, kPurple);
    add("torus", sure(torus({}, 2, 0.75, most)).surface, kOchre);
    return page("Exact surfaces: every point is where it should be, but for rounding", std::move(panels), 3,
                1280, 900);
}

Figure triangles(const Document& d) {
    const auto& s = std::get<Patch3>(shape_in(d, "triangle"));
    const Eye eye;
    Plot control("net", "ten control points, *b*_{300} to *b*_{003}");
    std::vector<Shown> shown{net(3, s.coefficients(), thin(kGrey, "control net"))};
    add_lines(shown, s, kBlue);
    together(control, shown, eye, only_borders());
    control.dots(eye({s.coefficients().begin(), s.coefficients().end()}), kGrey, 3.2);
    Plot steps("de Casteljau", "de Casteljau at (0.4, 0.25, 0.35)");
    const auto all = sure(de_casteljau(s, {0.25, 0.35}));
    shown = {{edge_of(s, 0), {kBlue, 2.2, "", {}}},
             {edge_of(s, 1), {kBlue, 2.2, "", {}}},
             {edge_of(s, 2), {kBlue, 2.2, "", {}}},
             net(3, all.level(0), thin(kGrey)),
             net(2, all.level(1), {kOrange, 1.4, "degree 2", {}}),
             net(1, all.level(2), {kGreen, 2, "degree 1: tangent plane", {}})};
    together(steps, shown, eye);
    steps.dots({eye(all.point())}, kInk, 5);
    Plot four("four parts", "four parts with their nets");
    const auto parts = split_in_four(s);
    shown.clear();
    for (std::size_t i = 0; i < 4; ++i) {
        shown.push_back(net(3, parts[i].coefficients(), thin(mixed(kPalette[i], {1, 1, 1, 1}, 0.3))));
        add_lines(shown, parts[i], kPalette[i], 4);
    }
    together(four, shown, eye, only_borders());
    Plot joint("joint", "the next one: *C*^1 determines the pairs of triangles at the edge");
    const auto next =
        sure(next_c(s, 0, 1, {1, 1}, std::vector<Vec<3>>{{{3, 3, 0.2}}, {{2.1, 3.1, 0.9}}, {{3.2, 2, 0.8}}}));
    shown = {net(3, s.coefficients(), thin(kGrey)), net(3, next.patch.coefficients(), thin(kGrey))};
    add_lines(shown, s, kBlue);
    add_lines(shown, next.patch, kOrange);
    together(joint, shown, eye, only_borders());
    return page("A cubic triangle: its net, its points, its parts, its neighbour",
                {control.panel, steps.panel, four.panel, joint.panel}, 2, 1280, 1100);
}

}  // namespace freiform::cli::gallery
