// R11, R12, R14 to R17: B-splines, weights, and what control points tell.
#include "gallery/gallery.hpp"

#include <freiform/basis/subdivide.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/query/crossings.hpp>

#include <algorithm>
#include <array>

namespace freiform::cli::gallery {

namespace {

// The pieces of a spline in two colours, one after the other, and where they meet.
Plot& add_pieces(Plot& plot, const Curve<Vec<2>>& s) {
    const BezierPieces<1, Vec<2>> pieces(s);
    Points joints;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        Points p;
        for (int k = 0; k <= pieces.degree(0); ++k) p.push_back(pieces.net({i})({k}));
        plot.curve(bezier(p), {i % 2 ? kSky : kBlue, 2.7, i < 2 ? "pieces" : "", {}});
        if (i == 0) joints.push_back(p.front());
        joints.push_back(p.back());
    }
    return plot.dots(joints, kInk, 3.6, true, "knots");
}

Panel spline_panel(const Document& d, std::string_view name, std::string_view caption) {
    Plot plot(name, caption);
    const auto& s = curve_in(d, name);
    Points p = points_of(s);
    std::vector<std::string> names;
    Points distinct;
    for (std::size_t i = 0, n = 0; i < p.size(); ++i) {
        const auto same = std::ranges::find(distinct, p[i]);
        if (same == distinct.end()) {
            distinct.push_back(p[i]);
            names.push_back(text("*P*_", ++n));
        }
    }
    plot.polygon(distinct, thin(kGrey), names);
    add_pieces(plot, s);
    return plot.panel;
}

}  // namespace

Figure uniform_splines(const Document& d) {
    return page("Uniform cubic B-splines: a control point that is used once, twice, three times",
                {spline_panel(d, "simple", "*P*_4 once: *C*^2"),
                 spline_panel(d, "doubled", "twice: drawn towards *P*_4"),
                 spline_panel(d, "tripled", "three times: through *P*_4, straight on both sides")},
                0, 1280, 500);
}

Figure nonuniform_splines(const Document& d) {
    const auto& s = curve_in(d, "spline");
    DrawingOptions how;
    how.names = PointNames::from_zero;
    how.knots = true;
    Plot a("curve", "knots 0, 0, 0, 0, 1, 1, 2, 3, 3, 3, 4, 4, 4, 4");
    a.shape(s, how);
    for (const double u : {0.0, 1.0, 2.0, 3.0, 4.0}) {
        const auto jet = s.jet<1>(u);
        const double side = u == 4 ? -1 : 1;
        a.note(jet.value(), text("*u* = ", u), {{-side * jet(1)[1], side * jet(1)[0]}}, kInk, 14);
        a.panel.notes.back().gap = 12;
    }
    Document alone;
    alone.objects.push_back({"", s, {}});
    how = {};
    how.basis = true;
    std::vector<Refusal> left_out;
    Panel b = sure(panels_of(alone, {}, how, left_out)).at(1);
    b.caption = formula("basis functions; a dot below for each knot");
    b.share = 0.9;
    for (DrawnGroup& g : b.groups) g.name.clear();
    return page("A non-uniform B-spline: the triple knot at 3 interpolates *b*_6, without straight pieces",
                {a.panel, b}, 0, 1280, 580);
}

Figure conics(const Document& d) {
    const Points p = points_of(curve_in<Hom<2>>(d, "arc"));
    Plot a("weights", "one weight *w* makes all arcs of conics");
    a.share(1.25);
    a.polygon(p, thin(kGrey), {"", "*P*_1", "*P*_2"});
    a.note(p[0], "*P*_0", {{-1, 0}}, mixed(kGrey, kInk, 0.4));
    struct Case {
        double w;
        Colour colour;
        const char* legend;
    };
    for (const Case& c : {Case{0, kGrey, "*w* = 0: line"},
                          {0.4, kGreen, "*w* < 1: ellipse"},
                          {1, kBlue, "*w* = 1: parabola"},
                          {2, kOrange, "*w* > 1: hyperbola"}}) {
        const Look look{c.colour, c.w == 1 ? 3.0 : 2.0, c.legend, {}};
        if (c.w == 0) {
            a.lines({p[0], p[2]}, look);
            continue;
        }
        const auto arc = sure(weighted_arc(p[0], p[1], p[2], c.w)).curve;
        a.curve(arc, look);
        a.note(arc(0.5), text("*w* = ", c.w), p[1] - 0.5 * (p[0] + p[2]), mixed(c.colour, kInk, 0.3), 13);
    }
    a.curve(sure(weighted_arc(p[0], p[1], p[2], -0.4)).curve,
            dashed(kGreen, "*w* = \u22120.4: the rest of it"));
    Plot b("circle", "a circle: weights 1 and \u221a\u00bd in turn");
    DrawingOptions how;
    how.control = how.knots = true;
    b.shape(shape_in(d, "circle"), how);
    const Points c = points_of(curve_in<Hom<2>>(d, "circle"));
    for (std::size_t i = 0; i + 1 < c.size(); ++i) b.note(c[i], i % 2 ? "\u221a\u00bd" : "1", c[i]);

    // The parabola (1 - t^2, 2 t, 1 + t^2), which lies in a plane, and rays from the origin to it.
    const auto eye = [](double x, double y, double w) { return Vec<2>{{0.9 * y - 0.45 * x, w - 0.35 * x}}; };
    const auto parabola = [](double t) { return Vec<3>{{1 - t * t, 2 * t, 1 + t * t}}; };
    const auto seen = [&](const Vec<3>& q) { return eye(q[0], q[1], q[2]); };
    Plot h("projection", "rays from the origin: parabola to circle");
    h.area({eye(-0.4, -1.3, 1), eye(1.4, -1.3, 1), eye(1.4, 1.3, 1), eye(-0.4, 1.3, 1)}, kGrey, 0.12);
    for (int i = -5; i <= 5; ++i)
        h.lines({eye(0, 0, 0), seen(parabola(i / 5.0))}, {mixed(kGrey, {1, 1, 1, 1}, 0.4), 0.8, "", {}});
    h.path([&](double t) { return seen(parabola(t)); }, {-1, 1},
           {kOrange, 2.4, "parabola of (*wx*, *wy*, *w*)", {}});
    h.path([&](double t) { return seen((1 / parabola(t)[2]) * parabola(t)); }, {-1, 1},
           {kBlue, 2.4, "half of a circle, in *w* = 1", {}});
    h.dots({eye(0, 0, 0)}, kInk, 4).note(eye(0, 0, 0), "origin", {{0, -1}});
    h.note(eye(1.4, 1.3, 1), "*w* = 1", {{0.3, -1}});
    return page("Weights: exact conics", {a.panel, b.panel, h.panel}, 0, 1280, 540);
}

Figure de_casteljau(const Document& d) {
    DrawingOptions how;
    how.names = PointNames::from_zero;
    how.construction = 0.4;
    Plot a("cubic", "degree 3 at *t* = 0.4");
    a.shape(shape_in(d, "cubic"), how);
    how.construction = 0.6;
    Plot b("quintic", "degree 5 at *t* = 0.6");
    b.shape(shape_in(d, "quintic"), how).share(1.5);
    how.construction = 0.4;
    Plot c("rational", "rational, weight of *b*_2 is 4, at *t* = 0.4");
    c.shape(shape_in(d, "rational"), how);
    return page("De Casteljau: *b*_i^r = (1 \u2212 *t*) *b*_i^{r\u22121} + *t* *b*_{i+1}^{r\u22121}",
                {a.panel, b.panel, c.panel}, 0, 1280, 540);
}

Figure subdivision(const Document& d) {
    std::vector<Panel> panels;
    const auto& c = curve_in(d, "cubic");
    for (int level = 0; level < 4; ++level) {
        std::vector<double> halves;  // where all pieces of this level meet, each three times
        for (int i = 1; i < 1 << level; ++i) halves.insert(halves.end(), 3, double(i) / (1 << level));
        const Points p = points_of(sure(insert_knots(c, 0, halves)));
        Plot plot(text("level ", level), level == 0   ? "cubic Bézier curve"
                                         : level == 1 ? "halved once"
                                         : level == 2 ? "twice"
                                                      : "three times");
        plot.curve(c, {mixed(kSky, {1, 1, 1, 1}, 0.3), 3.2, "curve", {}});
        plot.polygon(p, {kOrange, 1.3, "control polygons", {}});
        panels.push_back(plot.panel);
    }
    auto s = curve_in(d, "closed");
    for (int level = 0; level < 4; ++level) {
        Plot plot(text("B-spline level ", level), level == 0   ? "closed uniform B-spline"
                                                  : level == 1 ? "one knot more in each span"
                                                               : "and again");
        plot.curve(s, {mixed(kSky, {1, 1, 1, 1}, 0.3), 3.2, "", {}});
        plot.polygon(points_of(s), {kOrange, 1.3, "", {}}, {}, true);
        panels.push_back(plot.panel);
        s = rebase(s, 0, sure(halve_uniform(s.basis())));
    }
    return page("Subdivision: polygons close in on the curve, about four times closer with each step",
                std::move(panels), 4, 1280, 720);
}

Figure properties(const Document& d) {
    const auto& s = curve_in(d, "spline");
    DrawingOptions how;
    how.control = how.hull = true;
    Plot a("hull", "each piece lies in the hull of its four points");
    const Points p = points_of(s);
    const BezierPieces<1, Vec<2>> pieces(s);
    for (std::size_t i = 0; i + 3 < p.size(); ++i) {
        const Points four(p.begin() + std::ptrdiff_t(i), p.begin() + std::ptrdiff_t(i) + 4);
        DrawingOptions only_hull;
        only_hull.hull = true;
        a.shape(bezier(four), only_hull, kPalette[i % 4]);
        std::erase_if(a.panel.groups, [](const DrawnGroup& g) { return g.role == "curve"; });
    }
    a.polygon(p, thin(kGrey));
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        Points b;
        for (int k = 0; k <= 3; ++k) b.push_back(pieces.net({i})({k}));
        a.curve(bezier(b), {kPalette[std::size_t(i) % 4], 2.8, "", {}});
    }
    const auto& wave = curve_in(d, "wave");
    Plot b("boxes", "box of the curve and box of the points");
    how = {};
    how.control = how.box = true;
    b.shape(wave, how);
    Box<2> box;
    for (const Vec<2>& q : points_of(wave)) box.add(q);
    b.lines({box.lo, {{box.hi[0], box.lo[1]}}, box.hi, {{box.lo[0], box.hi[1]}}}, {kOrange, 1, "", {6, 3}},
            true);
    Plot c("crossings", "crossings with a line");
    c.polygon(points_of(wave), thin(kGrey)).curve(wave);
    const auto line = [](double x) { return 0.95 + 0.33 * x; };
    c.graph(line, {-0.2, 6.2}, {kOrange, 1.8, "", {}}, 1);
    const auto side = [&](const Vec<2>& q) { return q[1] - line(q[0]); };
    Points on_curve, on_polygon;
    for (const auto& hit : sure(crossings(wave, Vec<2>{{-0.33, 1}}, -0.95, 1e-9)))
        on_curve.push_back(hit.point);
    const Points w = points_of(wave);
    for (std::size_t i = 0; i + 1 < w.size(); ++i) {
        const double f = side(w[i]), g = side(w[i + 1]);
        if (f * g < 0) on_polygon.push_back(w[i] + (f / (f - g)) * (w[i + 1] - w[i]));
    }
    c.dots(on_polygon, kGrey, 4.5, true, text("with the polygon: ", on_polygon.size()));
    c.dots(on_curve, kBlue, 4.5, false, text("with the curve: ", on_curve.size()));
    return page("What control points tell: hulls, boxes, crossings", {a.panel, b.panel, c.panel}, 0, 1280,
                540);
}

}  // namespace freiform::cli::gallery
