#include "support/reference.hpp"
#include "trim/polygons.hpp"

#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace freiform {
namespace {

using test::box;
using test::ellipse;
using test::Loop;
using test::Loops;
using test::plane_bezier;
using test::polygon;
using test::Rational;
constexpr LoopTolerance kFine{0, 1e-9};

CurveGeometry<2> line(Vec<2> a, Vec<2> b) { return plane_bezier({a, b}); }

// "crosses", "undecided", or how many places touch.
std::string verdict(const Loops& loops, const LoopTolerance& tolerance = kFine) {
    const auto r = check_loops(loops, tolerance);
    if (!r) return r.error().message.starts_with("crosses") ? "crosses" : r.error().message;
    for (const LoopContact& c : *r)
        if (c.kind == LoopContactKind::undecided) return "undecided";
    return text("touches ", r->size());
}
// The place in "crosses ... at (X, Y), known within ..".
Vec<2> place(const Loops& loops) {
    Vec<2> p{{NAN, NAN}};
    const auto r = check_loops(loops, kFine);
    if (r) return p;
    const std::string& said = r.error().message;
    const std::size_t at = said.find(" at (");
    if (at != std::string::npos) std::sscanf(said.c_str() + at, " at (%lf, %lf)", &p[0], &p[1]);
    return p;
}

// tau^3 and tau^2, tau^4 over x = 3 tau + x0, tau from -1 to 1.
CurveGeometry<2> cubic(double x0, double sign) {
    return plane_bezier({{{x0 - 3, -sign}}, {{x0 - 1, sign}}, {{x0 + 1, -sign}}, {{x0 + 3, sign}}});
}
CurveGeometry<2> even(double x0, double y0, double sign, int degree) {
    std::vector<Vec<2>> p;
    for (int i = 0; i <= degree; ++i) p.push_back({{x0 - 3 + 6.0 * i / degree, y0 + (i % 2 ? -sign : sign)}});
    return plane_bezier(p);
}

TEST(LoopContacts, tangents_that_pass_through_are_crossings) {
    // Up through y = 0 at the origin and down through it at (12, 0), both times with a horizontal tangent.
    const Loop wave{cubic(0, 1),
                    line({{3, 1}}, {{9, 1}}),
                    cubic(12, -1),
                    line({{15, -1}}, {{15, -4}}),
                    line({{15, -4}}, {{-3, -4}}),
                    line({{-3, -4}}, {{-3, -1}})};
    for (const Loops& loops : {Loops{wave, box(-6, 0, 18, 5)}, Loops{box(-6, 0, 18, 5), wave}}) {
        EXPECT_EQ(verdict(loops), "crosses");
        const Vec<2> at = place(loops);
        EXPECT_NEAR(at[1], 0, 1e-6);
        EXPECT_LE(std::min(std::abs(at[0]), std::abs(at[0] - 12)), 0.02) << at[0];
    }
}

TEST(LoopContacts, tangents_that_turn_back_are_touches) {
    for (const int degree : {2, 4}) {
        // A cup that stands on y = 0, seen from both sides.
        const Loop cup{even(0, 0, 1, degree), line({{3, 1}}, {{-3, 1}})};
        EXPECT_EQ(verdict({cup, box(-9, -3, 9, 0)}), "touches 1") << degree;
        EXPECT_EQ(verdict({box(-9, 0, 9, 3), cup}), "touches 1") << degree;
        // Two cups tip to tip, and two that touch the same line.
        const Loop cap{even(0, 0, -1, degree), line({{3, -1}}, {{-3, -1}})};
        EXPECT_EQ(verdict({cup, cap}), "touches 1") << degree;
        const Loop far{even(12, 0, 1, degree), line({{15, 1}}, {{9, 1}})};
        EXPECT_EQ(verdict({cup, far, box(-9, -3, 19, 0)}), "touches 2") << degree;
    }
    EXPECT_EQ(verdict({ellipse({}, {{2, 0}}, {{0, 2}}), ellipse({{1, 0}}, {{1, 0}}, {{0, 1}})}), "touches 1");
    EXPECT_EQ(verdict({ellipse({}, {{2, 0}}, {{0, 2}}), ellipse({}, {{2, 0}}, {{0, 1}})}), "touches 2");
}

TEST(LoopContacts, vertices_on_curves_are_crossings_where_the_loop_goes_through) {
    const Loop bowl{plane_bezier({{{-2, 4}}, {{0, -4}}, {{2, 4}}}), line({{2, 4}}, {{-2, 4}})};  // y = x^2
    EXPECT_EQ(verdict({bowl, polygon({{{1, 1}}, {{0.5, 2}}, {{-0.5, 2}}})}), "touches 1");
    EXPECT_EQ(verdict({bowl, polygon({{{1, 1}}, {{3, 0}}, {{3, 2}}})}), "touches 1");
    EXPECT_EQ(verdict({bowl, polygon({{{1, 1}}, {{0.5, 2}}, {{-0.5, 2}}, {{-1, 1}}})}), "touches 2");
    const Loops through{bowl, polygon({{{1, 1}}, {{0.5, 2}}, {{-0.5, 2}}, {{-1, 1}}, {{-1, -1}}, {{1, -1}}})};
    EXPECT_EQ(verdict(through), "crosses");
    const Vec<2> at = place(through);
    EXPECT_NEAR(std::abs(at[0]), 1, 1e-6);
    EXPECT_NEAR(at[1], 1, 1e-6);
    // A leg that leaves along the tangent of the curve, on either side of it.
    EXPECT_EQ(verdict({bowl, polygon({{{1, 1}}, {{0.5, 0}}, {{3, 0}}})}), "touches 1");
}

TEST(LoopContacts, a_loop_that_meets_itself_at_a_tangent) {
    const auto up = [](double sign) {
        return std::vector<Vec<2>>{{{-2, 4 * sign}}, {{0, -4 * sign}}, {{2, 4 * sign}}};
    };
    auto down = up(-1);
    std::ranges::reverse(down);
    // Two lobes that touch in the origin, one sense of rotation.
    EXPECT_EQ(verdict({{plane_bezier(up(1)), line({{2, 4}}, {{4, 0}}), line({{4, 0}}, {{2, -4}}),
                        plane_bezier(down), line({{-2, -4}}, {{-4, 0}}), line({{-4, 0}}, {{-2, 4}})}}),
              "touches 1");
    // tau^3 and back along -tau^3: an eight, whose branches have one tangent.
    const Loops eight{{cubic(0, 1), line({{3, 1}}, {{5, 0}}), line({{5, 0}}, {{3, -1}}),
                       plane_bezier({{{3, -1}}, {{1, 1}}, {{-1, -1}}, {{-3, 1}}}), line({{-3, 1}}, {{-5, 0}}),
                       line({{-5, 0}}, {{-3, -1}})}};
    EXPECT_EQ(verdict(eight), "crosses");
    EXPECT_LE(norm(place(eight)), 0.02);
}

TEST(LoopContacts, edges_in_common_and_coincident_loops) {
    EXPECT_TRUE(verdict({box(0, 0, 2, 2), box(2, 0, 4, 2)}).starts_with("touches"));
    EXPECT_TRUE(verdict({box(0, 0, 2, 2), box(0, 0.5, 1, 1)}).starts_with("touches"));
    // In along one edge and out: over a stretch, not in a point.
    EXPECT_EQ(verdict({box(0, 0, 4, 4),
                       polygon({{{4, 1}}, {{4, 2}}, {{6, 2}}, {{6, 6}}, {{2, 6}}, {{2, 3}}, {{3, 1}}})}),
              "crosses");
    EXPECT_EQ(verdict({box(0, 0, 1, 1), box(0, 0, 1, 1)}), "undecided");
    EXPECT_EQ(verdict({polygon({{{0, 0}}, {{2, 0}}, {{1, 0}}, {{1, 1}}})}), "undecided");  // a spike
}

// A slow twin: each edge of one polygon cut where it meets the edges of the other, in rational numbers; the
// polygons cross if the middles of the parts are on both sides of the other.
struct Point {
    Rational x, y;
};
Rational turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
enum class Side { in, out, on };
Side side(const std::vector<Point>& polygon, const Point& q) {
    bool in = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const Rational t = turn(a, b, q);
        if (t == 0 && (q.x - a.x) * (q.x - b.x) + (q.y - a.y) * (q.y - b.y) <= 0) return Side::on;
        if ((a.y <= q.y) != (b.y <= q.y) && (t > 0) == (b.y > a.y)) in = !in;
    }
    return in ? Side::in : Side::out;
}
bool polygons_cross(const std::vector<Point>& a, const std::vector<Point>& b) {
    bool in = false, out = false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Point &p = a[i], &q = a[(i + 1) % a.size()];
        std::vector<Rational> cuts{0, 1};
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Point &r = b[j], &s = b[(j + 1) % b.size()];
            const Rational from = turn(r, s, p), to = turn(r, s, q);
            if (from != to) cuts.push_back(from / (from - to));
            const Rational square = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
            cuts.push_back(((r.x - p.x) * (q.x - p.x) + (r.y - p.y) * (q.y - p.y)) / square);
        }
        std::erase_if(cuts, [](const Rational& t) { return t < 0 || t > 1; });
        std::ranges::sort(cuts);
        for (std::size_t k = 1; k < cuts.size(); ++k) {
            const Rational t = (cuts[k - 1] + cuts[k]) / 2;
            const Side where = side(b, {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
            if (cuts[k - 1] != cuts[k]) in = in || where == Side::in, out = out || where == Side::out;
        }
    }
    return in && out;
}

TEST(LoopContacts, pairs_of_triangles_of_whole_numbers_agree_with_brute_force) {
    std::mt19937 rng(8);
    int crossing = 0, touching = 0, apart = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec<2>> p[2];
        std::vector<Point> exact[2];
        for (int k = 0; k < 2; ++k) do {
                p[k].clear(), exact[k].clear();
                for (int i = 0; i < 3; ++i) {
                    const int x = int(rng() % 6), y = int(rng() % 6);
                    p[k].push_back({{double(x), double(y)}}), exact[k].push_back({x, y});
                }
            } while (turn(exact[k][0], exact[k][1], exact[k][2]) == 0);
        const auto r = check_loops(Loops{polygon(p[0]), polygon(p[1])}, kFine);
        // Both ways: a triangle may cut another one in a corner and an edge.
        const bool cross = polygons_cross(exact[0], exact[1]) || polygons_cross(exact[1], exact[0]);
        EXPECT_EQ(!r, cross) << round;
        crossing += cross;
        if (!r) continue;
        touching += !r->empty(), apart += r->empty();
        if (p[0] != p[1])
            for (const LoopContact& c : *r) EXPECT_EQ(c.kind, LoopContactKind::touch) << round;
    }
    EXPECT_GT(crossing, 50);
    EXPECT_GT(touching, 20);
    EXPECT_GT(apart, 50);
}

// A cylinder, closed along u with the period 4.
Surface<Vec<3>> tube() {
    std::vector<Vec<3>> net;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 2; ++j) net.push_back({{i % 2 ? 0.0 : 1.0 - i, i % 2 ? 2.0 - i : 0.0, 4.0 * j}});
    return *Surface<Vec<3>>::make(
        {*BSplineBasis::periodic(2, {0, 1, 2, 3, 4}), *BSplineBasis::bezier(1, {0, 4})},
        Net<2, Vec<3>>({4, 2}, net));
}

TEST(TrimmedSurface, loops_that_cross_over_the_seam_are_refused) {
    const auto made = [](const Loops& loops) {
        const auto r = TrimmedSurface::make(tube(), loops);
        return r ? "accepted" : text(r.error().where, ": ", r.error().message);
    };
    // u from 3 to 5 is u from 3 to 4 and from 0 to 1.
    EXPECT_EQ(made({box(3, 1, 5, 2), box(1.5, 1, 2.5, 2)}), "accepted");
    EXPECT_EQ(made({box(3, 1, 5, 2), box(1, 1, 2, 2)}), "accepted");  // touches
    const std::string r = made({box(3, 1, 5, 2), box(0.5, 1.5, 2, 3)});
    EXPECT_NE(r.find("crosses loops["), std::string::npos) << r;
    EXPECT_NE(r.find("across the seam at ("), std::string::npos) << r;
    EXPECT_NE(made({box(0.5, 1.5, 2, 3), box(3 - 8, 1, 5 - 8, 2)}).find("across the seam"),
              std::string::npos);
    // A loop that goes round by more than a period crosses itself; a band up to the seam does not.
    EXPECT_NE(made({polygon({{{0, 1}}, {{5, 2}}, {{5, 3}}, {{0, 2}}})}).find("loops[0]"), std::string::npos);
    EXPECT_EQ(made({box(0, 1, 4, 2)}), "accepted");
    EXPECT_EQ(made({box(0, 1, 4, 2), box(3, 2.5, 4.5, 3)}), "accepted");
    // Half a slack over the seam is what rounding does to files.
    const double slack = TrimmedSurface::kSlack * 4;
    EXPECT_EQ(made({box(0, 1, 4 + slack / 2, 2)}), "accepted");
    EXPECT_NE(made({box(0, 1, 4 + 16 * slack, 2)}), "accepted");
    EXPECT_EQ(TrimmedSurface::make(tube(), {box(0, 1, 1e6, 2)}).error().kind, RefusalKind::limit);
}

}  // namespace
}  // namespace freiform
