// R25, R26 and R31: surfaces that are made from others, and how they meet.
#include "gallery/gallery.hpp"
#include "gallery/space.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/make/frame_sweep.hpp>
#include <freiform/make/revolve.hpp>
#include <freiform/make/surface_joint.hpp>
#include <freiform/model/tessellate.hpp>
#include <freiform/query/surface_continuity.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::cli::gallery {

namespace {

// The exact surface turns the profile by an angle; the spline's angle at the same parameters is near.
double farthest(const Surface3& s, const Curve<Vec<3>>& profile) {
    double most = 0;
    for (int i = 0; i <= 2000; ++i)
        for (const double v : {0.1, 0.35, 0.6, 0.9}) {
            const Vec<3> p = s(i / 2000.0, v), q = profile(v);
            most = std::max(most, std::abs(std::hypot(p[0], p[1]) - std::hypot(q[0], q[1])));
        }
    return most;
}

}  // namespace

Figure revolution(const Document& d) {
    const auto& profile = curve_in<Vec<3>>(d, "profile");
    const Axis axis{};
    const Eye front = eye_at(-90, 0), eye = eye_at(-60, 24);
    Plot curve("profile", "a profile and an axis");
    together(curve, {{profile, {kBlue, 2.6, "", {}}}}, front);
    Points3 control(profile.net().flat().begin(), profile.net().flat().end());
    curve.polygon(front(control), thin(kGrey), numbered('b', 0, control.size()));
    curve.lines(front({{{0, 0, -0.3}}, {{0, 0, 3.4}}}), dashed(kOrange));
    curve.note(front(Vec<3>{{0, 0, 3.4}}), "axis", {{-1, 0}}, kOrange);
    Plot body("body", "exact: a rational surface, 8 columns of control points");
    DrawingOptions how;
    how.control = true;
    how.isolines = 7;
    together(body, {{sure(revolve(profile, axis, kTwoPi)).surface, {kBlue, 1.8, "", {}}}}, eye, how);
    Plot bounds("bound", "polynomial: pieces and distance");
    Points proven, measured;
    for (int k = 1; k <= 7; ++k) {
        const auto made = sure(revolve_polynomial(profile, axis, kTwoPi, std::pow(10.0, -k)));
        const double x = std::log10(made.pieces);
        proven.push_back({{x, std::log10(made.bound)}});
        measured.push_back({{x, std::log10(farthest(made.surface, profile))}});
    }
    bounds.lines(proven, {kGrey, 1.6, "proven bound", {6, 4}}).dots(proven, kGrey, 3);
    bounds.dots(measured, kBlue, 4, true, "measured");
    bounds.stretched().axes(Axes::grid, "log_{10} of the pieces", "log_{10} of the distance");

    const auto& rail = curve_in<Vec<3>>(d, "rail");
    const FrameSweepOptions fine{1e-4, {}};
    Plot pipe("pipe", "a closed curve along a rail, in the frame that does not turn");
    const Eye side = eye_at(-62, 30);
    how.control = false;
    how.isolines = 11;
    together(pipe,
             {{sure(sweep(curve_in(d, "section"), rail, fine)).surface, {kGreen, 1.8, "", {}}},
              {rail, {kInk, 1.6, "rail", {}}}},
             side, how);
    Plot frames("frames", "the rail and its frames: *r* and *s* stand across it");
    together(frames, {{rail, {kInk, 2.4, "", {}}}}, side);
    // What the axes of the profile's plane sweep.
    const auto x = sure(sweep(bezier<Vec<2>>({{{0, 0}}, {{1, 0}}}), rail, fine)).surface,
               y = sure(sweep(bezier<Vec<2>>({{{0, 0}}, {{0, 1}}}), rail, fine)).surface;
    const Interval on = rail.domain()[0];
    for (int i = 0; i <= 12; ++i) {
        const double t = on.lo + on.length() * i / 12;
        const Vec<3> foot = rail(t);
        const double size = 0.8;
        frames.arrow(side(foot), side(foot + size * (x(1, t) - x(0, t))),
                     {kOrange, 1.3, i == 0 ? "*r*" : "", {}});
        frames.arrow(side(foot), side(foot + size * (y(1, t) - y(0, t))),
                     {kGreen, 1.3, i == 0 ? "*s*" : "", {}});
    }
    return page("Bodies of revolution, and curves along a rail",
                {curve.panel, body.panel, bounds.panel, frames.panel, pipe.panel}, 3, 1280, 900);
}

Figure curved_walls(const Document& d) {
    const Surface3 &arch = surface_in(d, "arch"), &wall = surface_in(d, "wall");
    const Eye eye = eye_at(-50, 30);
    Plot grid("grid", "a level stores a grid of 5 × 3 points");
    DrawingOptions how;
    how.isolines = 7;
    how.control = true;
    together(grid, {{arch, {kBlue, 1.8, "", {}}}}, eye, how);
    how.control = false;
    Plot pieces("pieces", "two patches of degree 2 × 2 with three common points");
    const BezierPieces<2, Vec<3>> parts(arch);
    std::vector<Shown> shown;
    for (int i = 0; i < parts.extent()[0]; ++i) {
        Net<2, Vec<3>> net({3, 3});
        const auto from = parts.net({i, 0});
        each_index(net.extent(), [&](const Index<2>& at) { net.view()(at) = from(at); });
        const Colour colour = i == 0 ? kOrange : kGreen;
        shown.push_back({bezier_surface(net), {colour, 1.8, "", {}}});
        shown.push_back({net_of(net), thin(colour)});
    }
    how.isolines = 3;
    together(pieces, shown, eye, how);
    Plot cracks("triangles", "two walls share the vertices of their common edge");
    Document both;
    both.objects.push_back({"", arch, {}});
    both.objects.push_back({"", wall, {}});
    const Model model = sure(scene_of(both));
    triangles_of(cracks, sure(tessellate(model, {.tolerance = 0.03})).mesh, eye, {kBlue, kPurple});
    return page("Curved walls of Quake 3: biquadratic patches", {grid.panel, pieces.panel, cracks.panel}, 0,
                1280, 560);
}

Figure surface_joints(const Document& d) {
    const Surface3& first = surface_in(d, "first");
    const auto rows = [&](int from) {  // of the neighbour, those that nothing determines
        const auto all = surface_in(d, "next").net().view();
        const int n = all.extent[0] - from;
        Net<2, Vec<3>> net({n, 4});
        each_index(net.extent(), [&](const Index<2>& at) { net.view()(at) = all({at[0] + from, at[1]}); });
        return NextRows<Vec<3>>{{0, 1}, net};
    };
    const SurfaceEdge end{0, End::end}, start{0, End::start};
    const Eye eye = eye_at(-65, 52);
    struct Case {
        const char *name, *says;
        Surface3 next;
    };
    const std::vector<Case> cases{
        {"G0", "a common edge", sure(next_c(first, end, 0, rows(1)))},
        {"G1", "stripes meet", sure(next_g(first, end, {{{0.6}}, {{0.4, -0.3}}}, rows(2)))},
        {"G2", "without kinks", sure(next_g(first, end, {{{0.6}, {0}}, {{0.4, -0.3}, {0}}}, rows(3)))}};
    std::vector<Panel> nets, striped;
    for (const Case& c : cases) {
        const SurfaceContinuity found = sure(joint(first, end, c.next, start));
        Plot net(c.name, text("*G*^", found.g_order, ": ", c.says));
        DrawingOptions how;
        how.isolines = 5;
        together(net,
                 {{first, {kBlue, 1.8, "first", {}}},
                  {c.next, {kOrange, 1.8, "next", {}}},
                  {net_of(first.net()), thin(mixed(kBlue, kWhite, 0.4))},
                  {net_of(c.next.net()), thin(mixed(kOrange, kWhite, 0.3))}},
                 eye, how);
        nets.push_back(net.panel);
        const auto jump = found.first_g_jump();
        const int order = found.g_order + 1;
        const auto two = [](double x) { return std::round(x * 100) / 100; };
        Plot zebra(text(c.name, " stripes"),
                   !jump        ? std::string("no jump up to the curvature")
                   : order == 1 ? text("the angle jumps by ", two(jump->size * 180 / std::numbers::pi), "°")
                                : text("the curvature jumps by ", two(jump->size)));
        const Vec<3> lamp{{-0.3, -0.4, 1}};
        stripes(zebra, first, eye, lamp, 5, mixed(kBlue, kWhite, 0.3));
        stripes(zebra, c.next, eye, lamp, 5, mixed(kOrange, kWhite, 0.3));
        how.isolines = 0;
        together(zebra, {{first, {kInk, 1, "", {}}}, {c.next, {kInk, 1, "", {}}}}, eye, how);
        striped.push_back(zebra.panel);
    }
    nets.insert(nets.end(), striped.begin(), striped.end());
    return page("How smoothly surfaces meet: stripes of equal angle to the light", std::move(nets), 3, 1280,
                800);
}

}  // namespace freiform::cli::gallery
