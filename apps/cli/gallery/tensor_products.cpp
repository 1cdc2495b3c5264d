// R21 to R24: curves of curves, and patches through points.
#include "gallery/gallery.hpp"
#include "gallery/space.hpp"

#include <freiform/fit/bicubic.hpp>
#include <freiform/make/named_surface.hpp>
#include <freiform/spline/construction.hpp>

namespace freiform::cli::gallery {

namespace {

using Geometry = std::array<std::array<Vec<3>, 4>, 4>;

Colour light(const Colour& c) { return mixed(c, kWhite, 0.5); }

Geometry sixteen(const Surface3& s) {
    Geometry g;
    each_index(Index<2>{4, 4},
               [&](const Index<2>& at) { g[std::size_t(at[0])][std::size_t(at[1])] = s.net().view()(at); });
    return g;
}

DrawingOptions lines(int isolines, bool control = false) {
    DrawingOptions how;
    how.isolines = isolines;
    how.control = control;
    return how;
}

Plot patch(std::string_view name, std::string_view caption, const Surface3& s, const Colour& colour,
           const Eye& eye) {
    Plot plot(name, caption);
    return together(plot, {{s, {colour, 1.8, "", {}}}, {net_of(s.net()), thin(kGrey)}}, eye, lines(7));
}

// The net of level r of the construction along both directions.
Net<2, Vec<3>> level(const Construction<2, Vec<3>>& all, int r) {
    Net<2, Vec<3>> out({all.degree(0) + 1 - r, all.degree(1) + 1 - r});
    each_index(out.extent(), [&](const Index<2>& at) { out.view()(at) = all({r, r}, at); });
    return out;
}

Points3 flat(const Net<2, Vec<3>>& net) { return {net.flat().begin(), net.flat().end()}; }

}  // namespace

Figure bicubic_patches(const Document& d) {
    const Surface3& s = surface_in(d, "patch");
    const Geometry g = sixteen(s);
    const Eye eye = eye_at(-58, 34);
    Plot moving("moving", "four curves of *t*; their points at one *t* control a curve of *s*");
    std::vector<Shown> shown;
    for (std::size_t i = 0; i < 4; ++i) {
        shown.push_back({bezier(Points3(g[i].begin(), g[i].end())), {kGrey, 1.3, "curves *G*_i(*t*)", {}}});
        if (i > 0) shown.back().look.legend = {};
    }
    for (const double t : {0.0, 0.2, 0.6, 0.8, 1.0})
        shown.push_back({iso(s, 1, t), {light(kBlue), 1.6, t == 0 ? "the curve that moves" : "", {}}});
    const auto now = iso(s, 1, 0.4);
    const Points3 control(now.net().flat().begin(), now.net().flat().end());
    shown.push_back({polyline(control), {kOrange, 1.3, "its control points at *t* = 0.4", {}}});
    shown.push_back({now, {kBlue, 3, "", {}}});
    together(moving, shown, eye, {});
    moving.dots(eye(control), kOrange, 4.4);
    const Eye above = eye_at(-58, 50);
    const Plot bezier_patch = patch("Bezier", "Bézier along both", s, kBlue, above);
    Plot spline_patch("B-spline", "uniform B-spline along both: the patch in the middle");
    Plot through("Catmull-Rom", "Catmull and Rom along both: through the inner four");
    const Shape net = net_of(s.net());
    together(
        spline_patch,
        {{sure(bicubic(g, kUniformBSpline, kUniformBSpline)), {kGreen, 1.8, "", {}}}, {net, thin(kGrey)}},
        above, lines(7));
    together(through,
             {{sure(bicubic(g, kCatmullRom, kCatmullRom)), {kPurple, 1.8, "", {}}}, {net, thin(kGrey)}},
             above, lines(7));
    through.dots(above({g[1][1], g[1][2], g[2][1], g[2][2]}), kPurple, 4.4);
    return page("*Q*(*s*, *t*) = *S*^T *M*^T *G* *M* *T*: sixteen points and a matrix",
                {moving.panel, bezier_patch.panel, spline_patch.panel, through.panel}, 2, 1280, 1000);
}

Figure tensor_products(const Document& d) {
    const Eye eye = eye_at(-58, 34);
    const Plot degrees =
        patch("degrees", "degree 2 along *u*, 4 along *v*", surface_in(d, "degrees"), kBlue, eye);

    const auto ends = surface_in(d, "ends").net().view(), tangents = surface_in(d, "tangents").net().view();
    Geometry g;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 2; ++i) {
            g[std::size_t(i)][std::size_t(j)] = ends({i, j});
            g[std::size_t(i) + 2][std::size_t(j)] = tangents({i, j});
        }
    Plot mixed_schemes("mixed", "Hermite along *u*, Bézier along *v*");
    const Surface3 m = sure(bicubic(g, kHermite, kBezier));
    std::vector<Shown> shown{{m, {kGreen, 1.8, "", {}}}};
    for (std::size_t i = 0; i < 2; ++i) shown.push_back({polyline({g[i].begin(), g[i].end()}), thin(kGrey)});
    together(mixed_schemes, shown, eye, lines(7));
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            mixed_schemes.arrow(eye(g[i][j]), eye(g[i][j] + (1 / 3.0) * g[i + 2][j]),
                                {kOrange, 1.4, i + j == 0 ? "tangents by *u*, a third" : "", {}});
            mixed_schemes.dots({eye(g[i][j])}, kGrey, 3.4);
        }

    Plot closed("closed", "closed B-spline along *u*, Bézier along *v*");
    together(closed, {{shape_in(d, "closed"), {kPurple, 1.8, "", {}}}}, eye_at(-58, 28), lines(7, true));

    const Surface3& s = surface_in(d, "degrees");
    Plot corner("corner", "corner: the tangent plane is that of three control points");
    const auto b = s.net().view();
    const Vec<3> p = b({0, 0}), du = b({1, 0}) - p, dv = b({0, 1}) - p;
    const Vec<3> far = p + du + dv;
    together(corner, {{s, {kBlue, 2.2, "boundary curves", {}}}}, eye, lines(0));
    corner.area(eye({p, p + du, far, p + dv}), kOrange, 0.25, "tangent plane");
    corner.arrow(eye(p), eye(p + du), {kOrange, 1.6, "", {}})
        .arrow(eye(p), eye(p + dv), {kOrange, 1.6, "", {}});
    corner.arrow(eye(p), eye(p + unit(cross(du, dv))), {kGreen, 1.8, "normal", {}}, "*N*");
    corner.dots(eye({p, p + du, p + dv}), kInk, 4);
    corner.note(eye(p), "*b*_{00}", {{-1, -1}}).note(eye(p + du), "*b*_{10}").note(eye(p + dv), "*b*_{01}");
    return page("Tensor products: any scheme along *u*, any along *v*",
                {degrees.panel, mixed_schemes.panel, closed.panel, corner.panel}, 2, 1280, 1000);
}

Figure surface_steps(const Document& d) {
    const Surface3& s = surface_in(d, "patch");
    constexpr double u = 0.4, v = 0.6;
    const Eye eye = eye_at(-58, 40);
    const std::array<Colour, 4> colours{kGrey, kOchre, kOrange, kInk};
    Plot levels("bilinear", "bilinear interpolation, three times, at *u* = 0.4, *v* = 0.6");
    DrawingOptions glass = lines(0);
    glass.hidden = HiddenLines::shown;
    const auto construction = sure(de_casteljau(s.net(), {u, v}));
    for (std::size_t r = 0; r < 4; ++r) {
        const Net<2, Vec<3>> net = level(construction, int(r));
        if (r < 3)
            together(levels,
                     {{net_of(net),
                       {colours[r],
                        r == 0 ? 1.0 : 1.6,
                        r == 0   ? "control net"
                        : r == 1 ? "3 × 3 points"
                                 : "2 × 2: tangent plane",
                        {}}}},
                     eye, glass);
        levels.dots(eye(flat(net)), colours[r], r == 3 ? 5.5 : 3.6);
    }
    Plot rows("rows", "the rows at *v* first, then the column of their points at *u*");
    const auto b = s.net().view();
    Points3 column;
    std::vector<std::array<Vec<3>, 2>> across, down;
    Points3 on_rows;
    for (int i = 0; i < 4; ++i) {
        Points3 row;
        for (int j = 0; j < 4; ++j) row.push_back(b({i, j}));
        const auto steps = sure(de_casteljau(std::span<const Vec<3>>(row), v));
        for (int r = 0; r < 3; ++r)
            for (int k = 0; k + 1 <= 3 - r; ++k) {
                across.push_back({steps(r, k), steps(r, k + 1)});
                if (r > 0) on_rows.push_back(steps(r, k)), on_rows.push_back(steps(r, k + 1));
            }
        column.push_back(steps.point());
    }
    const auto steps = sure(de_casteljau(std::span<const Vec<3>>(column), u));
    Points3 on_column;
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k + 1 <= 3 - r; ++k) {
            down.push_back({steps(r, k), steps(r, k + 1)});
            on_column.push_back(steps(r, k)), on_column.push_back(steps(r, k + 1));
        }
    together(rows,
             {{segments(across), {light(kGreen), 1.2, "de Casteljau on each row", {}}},
              {segments(down), {kOrange, 1.8, "on the column", {}}},
              {iso(s, 1, v), {kBlue, 2.4, "curve *v* = 0.6", {}}}},
             eye, glass);
    rows.dots(eye(on_rows), light(kGreen), 3).dots(eye(on_column), kOrange, 3.6);
    rows.dots({eye(steps.point())}, kInk, 5.5);
    const auto parts = [&](std::string_view name, std::string_view caption, std::vector<Surface3> all) {
        Plot plot(name, caption);
        std::vector<Shown> shown;
        for (std::size_t i = 0; i < all.size(); ++i) {
            shown.push_back({all[i], {kPalette[i], 2, "", {}}});
            shown.push_back({net_of(all[i].net()), thin(mixed(kPalette[i], kWhite, 0.25))});
        }
        return together(plot, shown, eye, lines(3));
    };
    const auto left = [](const Surface3& p, int axis, double at) {
        return sure(restrict_to(p, axis, {p.domain()[std::size_t(axis)].lo, at}));
    };
    const auto right = [](const Surface3& p, int axis, double at) {
        return sure(restrict_to(p, axis, {at, p.domain()[std::size_t(axis)].hi}));
    };
    const Surface3 low = left(s, 0, u), high = right(s, 0, u);
    const Plot two = parts("two", "split at *u* = 0.4: two nets", {low, high});
    const Plot four = parts("four", "and at *v* = 0.6: four nets",
                            {left(low, 1, v), right(low, 1, v), left(high, 1, v), right(high, 1, v)});
    return page("De Casteljau on surfaces: quadrangle by quadrangle, or row by row",
                {levels.panel, rows.panel, two.panel, four.panel}, 2, 1280, 1000);
}

Figure interpolating_patches(const Document& d) {
    const Surface3& grid = surface_in(d, "points");
    const std::vector<double> at = grid.basis(0).breaks();
    const Eye eye = eye_at(-55, 48);
    const auto through = [&](Twists t) {
        return sure(bicubic_through(grid.net(), {std::span(at), std::span(at)}, {false, false}, t));
    };
    Plot patches("patches", "49 points, 36 bicubic patches");
    std::vector<Shown> shown{{through(Twists::tensor), {kBlue, 1.8, "", {}}}};
    together(patches, shown, eye, lines(5));
    patches.dots(eye(flat(grid.net())), kOrange, 3.8, false, "points");
    std::vector<Panel> panels{patches.panel};
    const Vec<3> lamp{{0.3, -0.5, 1}};
    struct Case {
        Twists kind;
        const char* caption;
        Colour colour;
    };
    for (const Case& c : {Case{Twists::zero, "twists 0: flat spots at the points", kOrange},
                          {Twists::adini, "Adini's twists", kGreen},
                          {Twists::bessel, "Bessel's twists", kPurple}}) {
        Plot plot(name_of(c.kind), c.caption);
        const Surface3 s = through(c.kind);
        stripes(plot, s, eye, lamp, 4, mixed(c.colour, kWhite, 0.35));
        together(plot, {{s, {kInk, 1, "", {}}}}, eye, lines(0));
        panels.push_back(plot.panel);
    }
    return page("Through points with one continuous derivative; stripes show the twists", std::move(panels),
                2, 1280, 1000);
}

}  // namespace freiform::cli::gallery
