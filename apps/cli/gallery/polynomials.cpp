// R01 to R07: descriptions of curves, and one cubic curve in many bases.
#include "gallery/gallery.hpp"

#include <freiform/basis/blossom.hpp>
#include <freiform/basis/named.hpp>
#include <freiform/core/constants.hpp>

namespace freiform::cli::gallery {

namespace {

// Function i of a basis at u.
double value(const Bernstein& basis, int i, double u) {
    std::array<double, kMaxDegree + 1> w{};
    weights(basis, u, 0, w.data());
    return w[std::size_t(i)];
}

Colour shade(std::size_t i) { return kPalette[i % kPalette.size()]; }

// A cubic from four functions on [0, 1] and four points: the product of geometry and basis.
using Functions = std::array<std::function<double(double)>, 4>;

Plot product(std::string_view name, std::string_view caption, const Functions& m, const Points& g) {
    Plot plot(name, caption);
    plot.polygon(g, thin(kGrey), numbered('P', 1, 4));
    plot.path(
        [&](double t) {
            Vec<2> q{};
            for (std::size_t i = 0; i < 4; ++i) q += m[i](t) * g[i];
            return q;
        },
        {0, 1}, {kBlue, 2.6, "", {}});
    return plot;
}

Plot functions(std::string_view name, const Functions& m) {
    Plot plot(name);
    for (std::size_t i = 0; i < 4; ++i) plot.graph(m[i], {0, 1}, {shade(i), 2, text("of *P*_", i + 1), {}});
    plot.axes(Axes::grid, "*t*", "").stretched();
    plot.window({{0, -0.3}}, {{1, 1}});
    return plot;
}

Functions functions_of(const Matrix4& m) {
    Functions f;
    for (std::size_t i = 0; i < 4; ++i) f[i] = [m, i](double t) { return basis_functions(m, powers(t))[i]; };
    return f;
}

// Lagrange's polynomials to the nodes 0, 1/3, 2/3, 1.
constexpr Matrix4 kLagrange =
    scaled(0.5, Matrix4{{{-9, 18, -11, 2}, {27, -45, 18, 0}, {-27, 36, -9, 0}, {9, -9, 2, 0}}});

// "-3t^3 + 4.5t^2 + 3t", from the highest power down.
std::string polynomial(const std::vector<double>& c) {
    std::string s;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const std::size_t power = c.size() - 1 - i;
        if (c[i] == 0) continue;
        s += c[i] < 0 ? (s.empty() ? "\u2212" : " \u2212 ") : (s.empty() ? "" : " + ");
        if (std::abs(c[i]) != 1 || power == 0) s += text(std::abs(c[i]));
        if (power > 0) s += "*t*";
        if (power > 1) s += text("^", power);
    }
    return s;
}

}  // namespace

Figure descriptions(const Document& d) {
    DrawingOptions how;
    how.names = PointNames::from_one;
    Plot a("explicit", "explicit: *y* = *f*(*x*), a cubic polynomial");
    a.shape(shape_in(d, "graph"), how).axes(Axes::ticks, "*x*", "*y*");

    Plot b("implicit", "implicit: *f*(*x*, *y*) = *x*^2 + *y*^2 \u2212 1 = 0");
    const auto circle = [](double r) {
        return [r](double u) { return r * Vec<2>{{std::cos(u), std::sin(u)}}; };
    };
    Points disc;
    for (int i = 0; i < 120; ++i) disc.push_back(circle(1)(kTwoPi * i / 120));
    b.area(disc, kBlue, 0.1);
    for (const double c : {-0.75, -0.4, 0.6, 1.4})
        b.path(circle(std::sqrt(1 + c)), {0, kTwoPi}, {mixed(kGrey, {1, 1, 1, 1}, 0.3), 1, "", {3, 4}});
    b.curve(shape_in(d, "circle"));
    b.fixed({{0, 0}}, "*f* < 0", kGrey).fixed({{1.5, -1.5}}, "*f* > 0", kGrey);
    b.note({{0, 1}}, "*f* = 0", {{0, 1}}, kBlue).axes(Axes::ticks, "*x*", "*y*");

    Plot c("parametric", "parametric: (*x*(*t*), *y*(*t*)), a cubic with a loop");
    const auto& loop = curve_in(d, "loop");
    c.curve(loop);
    Points places;
    for (int i = 0; i <= 10; ++i) places.push_back(loop(0.1 * i));
    c.dots(places, kBlue, 3.4, true);
    for (const double t : {0.0, 0.2, 0.5, 0.8, 1.0}) {
        const auto jet = loop.jet<1>(t);
        c.note(jet.value(), text("*t* = ", t), {{jet(1)[1], -jet(1)[0]}}, kInk, 14);
    }
    c.axes(Axes::ticks, "*x*", "*y*");
    return page("Three descriptions of a curve", {a.panel, b.panel, c.panel}, 0, 1280, 520);
}

Figure coefficients(const Document& d) {
    const auto& q = curve_in(d, "cubic");
    Plot a("curve", "*Q*(*t*) = *C* · (*t*^3, *t*^2, *t*, 1)^T and *Q*′(*t*)/3");
    a.curve(q);
    for (const double t : {0.1, 0.5, 0.9}) {
        const auto jet = q.jet<1>(t);
        a.arrow(jet.value(), jet.value() + (1 / 3.0) * jet(1), {kOrange, 1.6, "tangent *Q*′", {}});
        a.dots({jet.value()}, kInk, 4);
        a.note(jet.value(), text("*t* = ", t), {{jet(1)[1], -jet(1)[0]}}, kInk, 14);
    }
    a.axes(Axes::grid, "*x*", "*y*");
    // The coefficients from Taylor's formula at 0, which is exact.
    const auto c = q.derivatives(0.0, 3);
    const auto row = [&](int i) { return polynomial({c[3][i] / 6, c[2][i] / 2, c[1][i], c[0][i]}); };
    Plot b("coordinates", "each coordinate is a polynomial of *t*");
    const std::string x = "*x*(*t*) = " + row(0), y = "*y*(*t*) = " + row(1);
    b.graph([&](double t) { return q(t)[0]; }, {0, 1}, {kBlue, 2.2, x, {}});
    b.graph([&](double t) { return q(t)[1]; }, {0, 1}, {kGreen, 2.2, y, {}});
    b.stretched().axes(Axes::grid, "*t*", "");
    const auto hodograph = derivative(q, 0);
    Plot h("hodograph", "*Q*′(*t*) = *C* · (3*t*^2, 2*t*, 1, 0)^T, a parabola");
    h.polygon(points_of(hodograph), thin(kGrey)).curve(hodograph, {kOrange, 2.4, "", {}});
    for (const double t : {0.1, 0.5, 0.9}) h.arrow({{0, 0}}, hodograph(t), {kOrange, 1.3, "", {}});
    h.axes(Axes::grid, "*x*′", "*y*′").dots({{{0, 0}}}, kInk, 3.4);
    return page("A polynomial curve, its coefficients and its tangents", {a.panel, b.panel, h.panel}, 0, 1280,
                560);
}

Figure one_product(const Document& d) {
    const Points g = points_of(curve_in(d, "four points"));
    const std::array<std::tuple<const char*, const char*, Functions>, 4> bases{
        {{"Bézier", "Bézier: Bernstein polynomials", functions_of(kBezier)},
         {"B-spline", "uniform B-spline", functions_of(kUniformBSpline)},
         {"Catmull-Rom", "Catmull and Rom: from *P*_2 to *P*_3", functions_of(kCatmullRom)},
         {"Lagrange", "Lagrange: through all four", functions_of(kLagrange)}}};
    std::vector<Panel> panels;
    for (const auto& [name, caption, m] : bases) panels.push_back(product(name, caption, m, g).panel);
    for (const auto& [name, caption, m] : bases) panels.push_back(functions(text(name, " basis"), m).panel);
    return page("*Q*(*t*) = *G* · *M* · *T*: the same four points *G* with four matrices *M*",
                std::move(panels), 4, 1280, 760);
}

Figure hermite(const Document& d) {
    Plot a("lengths", "the tangent *R*_1 at *P*_1 becomes longer"), b("turns", "the tangent *R*_1 turns");
    for (auto& [plot, name, shown, named] : {std::tuple(&a, "length ", 0.25, 5), {&b, "turn ", 0.15, 1}}) {
        Vec<2> from{}, to{}, r4{};
        for (int k = 1; k <= 5; ++k) {
            const auto& c = curve_in(d, text(name, k));
            plot->curve(c, {mixed(kSky, kBlue, k / 4.0 - 0.25), 2.2, "", {}});
            from = c(0.0), to = c(1.0), r4 = c.jet<1>(1.0)(1);
            plot->arrow(from, from + shown * c.jet<1>(0.0)(1), {mixed(kOchre, kOrange, k / 5.0), 1.4, "", {}},
                        k == named ? "*R*_1" : "");
        }
        plot->arrow(to, to + 0.2 * r4, {kOrange, 1.8, "", {}}, "*R*_4");
        plot->dots({from, to}, kInk, 4.5).note(from, "*P*_1", {{-1, 0}}).note(to, "*P*_4", {{1, 0.3}});
    }
    Plot f("polynomials", "the four Hermite polynomials");
    const Functions m = functions_of(kHermite);
    constexpr std::array<const char*, 4> kNames{"of *P*_1", "of *P*_4", "of *R*_1", "of *R*_4"};
    for (std::size_t i = 0; i < 4; ++i) f.graph(m[i], {0, 1}, {shade(i), 2.2, kNames[i], {}});
    f.axes(Axes::grid, "*t*", "").stretched().share(0.8);
    return page("Hermite: two points and two tangents", {a.panel, b.panel, f.panel}, 0, 1280, 540);
}

Figure bezier_cubics(const Document& d) {
    std::vector<Panel> panels;
    for (const auto& [name, caption] :
         {std::pair("arch", "no inflection"), {"S", "one inflection"}, {"loop", "a loop"}}) {
        Plot plot(name, caption);
        const auto& c = curve_in(d, name);
        const Points p = points_of(c);
        DrawingOptions how;
        how.names = PointNames::from_one;
        how.hull = true;
        plot.shape(c, how);
        plot.arrow(
            p[0], p[0] + 0.8 * (p[1] - p[0]),
            {kOrange, 1.9, "*R*_1 = 3(*P*_2 \u2212 *P*_1) and *R*_4 = 3(*P*_4 \u2212 *P*_3), shortened", {}});
        plot.arrow(p[3], p[3] + 0.4 * (p[3] - p[2]), {kOrange, 1.9, "", {}});
        panels.push_back(plot.panel);
    }
    return page("Cubic Bézier curves: the polygon tells the shape", std::move(panels), 0, 1280, 520);
}

Figure bernstein(const Document& d) {
    std::vector<Panel> panels;
    for (int n = 1; n <= 5; ++n) {
        Plot plot(text("degree ", n), text("degree ", n));
        const auto basis = sure(Bernstein::make(n));
        for (int i = 0; i <= n; ++i)
            plot.graph([&](double u) { return value(basis, i, u); }, {0, 1},
                       {shade(std::size_t(i)), 2, "", {}});
        for (int i = 0; i <= n; ++i) {
            const double u = double(i) / n;
            if (n > 1 && i > 0 && i < n) plot.dots({{{u, value(basis, i, u)}}}, shade(std::size_t(i)), 3);
        }
        plot.axes(Axes::grid, "*u*", "").stretched();
        panels.push_back(plot.panel);
    }
    Plot c("curve", "a curve of degree 5");
    DrawingOptions how;
    how.names = PointNames::from_zero;
    c.shape(shape_in(d, "degree 5"), how);
    panels.push_back(c.panel);
    return page("Bernstein polynomials *B*_i^n: each has its maximum at *i*/*n*, and their sum is 1",
                std::move(panels), 3, 1280, 780);
}

Figure changes(const Document& d) {
    const auto& q = curve_in(d, "cubic");
    const auto c = q.derivatives(0.0, 3);
    const auto plot = [&](std::string_view name, std::string_view caption) {
        Plot p(name, caption);
        p.window({{-0.3, -0.3}}, {{4.3, 2.2}});
        p.curve(q);
        return p;
    };
    Plot a = plot("Bernstein", "Bernstein: control points");
    a.polygon(points_of(q), thin(kOrange), numbered('b', 0, 4));
    Plot b = plot("Hermite", "Hermite: ends and tangents (a third)");
    for (const double t : {0.0, 1.0}) {
        const auto jet = q.jet<1>(t);
        b.dots({jet.value()}, kOrange, 4.5);
        b.arrow(jet.value(), jet.value() + (1 / 3.0) * jet(1), {kOrange, 1.8, "", {}},
                t == 0 ? "*R*_1" : "*R*_4");
        b.note(jet.value(), t == 0 ? "*P*_1" : "*P*_4", {{t - 1, -1}}, kOrange);
    }
    Plot m = plot("monomial", "monomial: powers of *t*, a fifth of each");
    Vec<2> at = c[0];
    m.dots({at}, kOrange, 4.5);
    for (int k = 1; k <= 3; ++k) {
        const Vec<2> step = (0.2 / (k == 3 ? 6 : k)) * c[std::size_t(k)];
        m.arrow(at, at + step, {kOrange, 1.8, "", {}});
        m.note(at + 0.5 * step, text("*c*_", k), {}, kOrange);
        at += step;
    }
    Plot l = plot("Lagrange", "Lagrange: points at *t* = 0, 1/3, 2/3, 1");
    Points on;
    for (int i = 0; i <= 3; ++i) on.push_back(q(i / 3.0));
    l.polygon(on, {kOrange, 1.1, "", {4, 4}}, numbered('Q', 0, 4));
    Plot n = plot("Newton", "Newton: divided differences, a fifth of each");
    Points differences = on;
    for (std::size_t k = 1; k < 4; ++k)
        for (std::size_t i = 3; i >= k; --i)
            differences[i] = (3.0 / double(k)) * (differences[i] - differences[i - 1]);
    at = differences[0];
    n.dots({at}, kOrange, 4.5);
    for (std::size_t k = 1; k < 4; ++k) {
        const Vec<2> step = 0.2 * differences[k];
        n.arrow(at, at + step, {kOrange, 1.8, "", {}});
        n.note(at + 0.5 * step, text("*a*_", k), {}, kOrange);
        at += step;
    }
    // Coefficient i of the uniform B-spline is the blossom at (i - 2, i - 1, i).
    Plot s = plot("B-spline", "uniform B-spline: control points");
    const Points p = points_of(q);
    const auto blossom_at = [&](std::array<double, 3> u) {
        Points r = p;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i + k < 3; ++i) r[i] = (1 - u[k]) * r[i] + u[k] * r[i + 1];
        return r[0];
    };
    Points de_boor;
    for (int i = 0; i < 4; ++i) de_boor.push_back(blossom_at({i - 2.0, i - 1.0, double(i)}));
    s.polygon(de_boor, thin(kOrange), numbered('d', 0, 4));
    return page("One cubic, six bases", {a.panel, b.panel, m.panel, l.panel, n.panel, s.panel}, 3, 1280, 820);
}

}  // namespace freiform::cli::gallery
