// R08 to R10 and R13: pieces that meet.
#include "gallery/gallery.hpp"

#include <freiform/fit/local.hpp>
#include <freiform/make/joint.hpp>
#include <freiform/query/continuity.hpp>
#include <freiform/spline/a_frame.hpp>

#include <algorithm>
#include <array>

namespace freiform::cli::gallery {

namespace {

DrawingOptions with_comb() {
    DrawingOptions how;
    how.comb = true;
    return how;
}

// Two pieces with one set of names: P_1 .. P_4 .. P_7.
Plot two_pieces(std::string_view name, std::string_view caption, const Points& p, const Points& q) {
    Plot plot(name, caption);
    plot.polygon(p, thin(kGrey));
    plot.polygon(q, thin(kGrey));
    plot.curve(bezier(p), {kBlue, 2.6, "first piece", {}});
    plot.curve(bezier(q), {kOrange, 2.6, "next piece", {}});
    Points all = p;
    all.insert(all.end(), q.begin() + 1, q.end());
    const auto names = numbered('P', 1, all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        Vec<2> away{};
        if (i > 0) away += unit(all[i] - all[i - 1]);
        if (i + 1 < all.size()) away += unit(all[i] - all[i + 1]);
        plot.note(all[i], names[i], norm(away) > 0.1 ? away : Vec<2>{{0.3, 1}});
    }
    plot.dots({p.back()}, kInk, 5);
    return plot;
}

}  // namespace

Figure joints(const Document& d) {
    const Points p = points_of(curve_in(d, "first"));
    const Vec<2> last{{5.8, 0.4}}, p6{{5, -0.6}};
    const auto& first = curve_in(d, "first");
    const auto panel = [&](std::string_view name, std::string_view caption,
                           const Result<Curve<Vec<2>>>& next) {
        return two_pieces(name, caption, p, points_of(sure(next)));
    };
    const Plot c0 =
        panel("C0", "*C*^0: one common point",
              next_c(first, 0, NextPiece<Vec<2>>{{1, 2}, {p[3] + Vec<2>{{0.5, 0.9}}, {{5.2, 1.6}}, last}}));
    const std::array<double, 1> k{0.5};
    const Plot g1 = panel("G1", "*G*^1: *P*_3 \u2212 *P*_4 = *k*(*P*_4 \u2212 *P*_5), here *k* = \u00bd",
                          next_g(first, k, NextPiece<Vec<2>>{{1, 2}, {p6, last}}));
    const Plot c1 = panel("C1", "*C*^1: *P*_5 = 2*P*_4 \u2212 *P*_3",
                          next_c(first, 1, NextPiece<Vec<2>>{{1, 2}, {p6, last}}));
    Plot c2 = panel("C2", "*C*^2: and *P*_6 = *P*_2 + 4(*P*_4 \u2212 *P*_3)",
                    next_c(first, 2, NextPiece<Vec<2>>{{1, 2}, {last}}));
    // Both prolonged legs end here: P_3 + (P_3 - P_2) = P_5 + (P_5 - P_6).
    const Vec<2> apex = 2 * p[2] - p[1];
    c2.lines({p[2], apex, 2 * p[3] - p[2]}, dashed(kGreen, "A-frame")).dots({apex}, kGreen, 4, true);
    return page("The next piece: what its control points must obey", {c0.panel, g1.panel, c1.panel, c2.panel},
                2, 1280, 900);
}

Figure curvature_joints(const Document& d) {
    const Points p = points_of(curve_in(d, "first"));
    const auto& first = curve_in(d, "first");
    struct Case {
        const char *name, *caption;
        Result<Curve<Vec<2>>> next;
    };
    // With phi' = 5/3 the next piece starts with 3/5 of the speed.
    const std::array<double, 2> slower{5.0 / 3, 0};
    std::vector<Panel> curves, speeds;
    for (const Case& c :
         {Case{"C1", "the curvature jumps",
               next_c(first, 1, NextPiece<Vec<2>>{{1, 2}, {{{5.2, 2.4}}, {{6.2, 1.8}}}})},
          {"G2", "curvature continuous, speed not",
           next_g(first, slower, NextPiece<Vec<2>>{{1, 2}, {{{5.86, 1.16}}}})},
          {"C2", "both continuous", next_c(first, 2, NextPiece<Vec<2>>{{1, 2}, {{{7.4, 0.1}}}})}}) {
        const Points q = points_of(sure(c.next));
        const Continuity found = sure(joint(first, *c.next));
        std::vector<double> knots{0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
        Points all = p;
        all.insert(all.end(), q.begin() + 1, q.end());
        const auto both = spline<Vec<2>>(3, knots, all);
        Plot plot(c.name, text("*C*^", found.c_order, ", *G*^", found.g_order, ": ", c.caption));
        plot.shape(both, with_comb());
        plot.curve(bezier(p), {kBlue, 2.6, "first piece", {}})
            .curve(bezier(q), {kOrange, 2.6, "next piece", {}});
        plot.dots({p[3]}, kInk, 5);
        plot.note(p[3], "joint", {{0, -1}});
        curves.push_back(plot.panel);
        Plot speed(text("speed of ", c.name));
        const auto before = bezier(p);
        speed.graph([&](double t) { return norm(before.jet<1>(t)(1)); }, {0, 1}, {kBlue, 2, "", {}});
        const auto second = bezier(q, {1, 2});
        speed.graph([&](double t) { return norm(second.jet<1>(t)(1)); }, {1, 2}, {kOrange, 2, "", {}});
        speed.stretched().axes(Axes::grid, "*t*", "|*Q*′|").window({{0, 0}}, {{2, 8}});
        speeds.push_back(speed.panel);
    }
    curves.insert(curves.end(), speeds.begin(), speeds.end());
    return page("Curvature at the joint, and speed", std::move(curves), 3, 1280, 760);
}

Figure interpolation(const Document& d) {
    const Points q = points_of(curve_in(d, "points"));
    const std::size_t l = q.size();
    std::vector<double> at;
    for (std::size_t i = 0; i < l; ++i) at.push_back(double(i));
    // P_{3i-2} = Q_i, P_{3i-1} = Q_i + (Q_{i+1} - Q_{i-1}) / 6, P_{3i-3} = Q_i - (Q_{i+1} - Q_{i-1}) / 6.
    const auto curve = sure(catmull_rom<1, 2>(Net<1, Vec<2>>({int(l)}, q), {at}));
    const Points p = points_of(curve);
    Plot plot("interpolation");
    plot.lines({q[1], q[3]}, dashed(kGrey, "chords *Q*_{i\u22121}*Q*_{i+1}"));
    for (std::size_t i = 2; i + 2 < l; ++i) plot.lines({q[i], q[i + 2]}, dashed(kGrey));
    plot.lines({q[0], q[2]}, dashed(kGrey));
    for (std::size_t i = 0; i < l; ++i) {
        Points arm;
        if (i > 0) arm.push_back(p[3 * i - 1]);
        arm.push_back(p[3 * i]);
        if (i + 1 < l) arm.push_back(p[3 * i + 1]);
        plot.polygon(arm, {kOrange, 1.2, i == 0 ? "Bézier points" : "", {}});
    }
    plot.curve(curve, {kBlue, 2.6, "*C*^1 spline of cubic Bézier pieces", {}});
    plot.dots(q, kInk, 5, false, "*Q*_i");
    const auto names = numbered('Q', 1, l);
    for (std::size_t i = 0; i < l; ++i) plot.note(q[i], names[i]);
    return page("Through seven points: tangents parallel to the chords of the neighbours", {plot.panel}, 0,
                1200, 640);
}

Figure a_frames(const Document& d) {
    const auto& s = curve_in(d, "spline");
    const BezierPieces<1, Vec<2>> pieces(s);
    Plot plot("A-frames");
    std::vector<Points> b;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        Points p;
        for (int k = 0; k <= 3; ++k) p.push_back(pieces.net({i})({k}));
        b.push_back(p);
    }
    Points all{b[0][0]};
    for (const Points& piece : b) all.insert(all.end(), piece.begin() + 1, piece.end());
    const Points boor = points_of(s);
    // At the ends Bezier points are de Boor points, and have both names.
    auto names = numbered('d', 0, boor.size());
    std::vector<std::size_t> unnamed;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto same =
            std::ranges::find_if(boor, [&](const Vec<2>& p) { return norm(p - all[i]) < 1e-9; });
        if (same == boor.end())
            unnamed.push_back(i);
        else
            names[std::size_t(same - boor.begin())] += text(" = *b*_", i);
    }
    plot.polygon(boor, {kGrey, 1.2, "de Boor points", {}}, names);
    constexpr std::array<Colour, 3> kPieces{kBlue, kGreen, kPurple};
    for (const AFrame<Vec<2>>& f : sure(freiform::a_frames(s))) {
        plot.area({f.from_left[1], f.apex, f.from_right[1]}, kOrange, 0.14);
        plot.lines({f.from_left[0], f.apex, f.from_right[0]}, {kOrange, 1.8, "A-frame", {}});
        plot.lines({f.from_left[1], f.from_right[1]}, {kOrange, 1.8, "", {}});
    }
    for (std::size_t i = 0; i < b.size(); ++i)
        plot.curve(bezier(b[i]), {kPieces[i], 2.8, text("piece ", i + 1), {}});
    plot.dots(all, kInk, 3.6, true, "Bézier points");
    for (const std::size_t i : unnamed)
        plot.note(all[i], text("*b*_", i), all[i] - s(s.domain()[0].hi * double(i) / double(all.size() - 1)));
    return page("A-frames: the *C*^2 condition between Bézier and de Boor points", {plot.panel}, 0, 1200,
                680);
}

}  // namespace freiform::cli::gallery
