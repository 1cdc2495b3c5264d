#include "support/sanitizer.hpp"
#include "support/shapes.hpp"
#include "trim/polygons.hpp"

#include <freiform/spline/bezier.hpp>
#include <freiform/trim/inside.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

namespace freiform {
namespace {

using test::Loops;
using test::plane_bezier;
using test::polygon;

CurveGeometry<2> rational(std::vector<Hom<2>> points) {
    const int n = int(points.size());
    return *Curve<Hom<2>>::make({*BSplineBasis::bezier(n - 1)}, Net<1, Hom<2>>({n}, std::move(points)));
}
Inside ask(const Loops& loops, const Vec<2>& q) { return InsideQuery::make(loops, 0)->at(q); }

TEST(R27, odd_even_counts_vertices_and_edges_on_the_half_line_right) {
    // A square with a notch whose tip, and an edge, lie on the half-line to the right of (1, 2).
    const Loops loops = {
        polygon({{{0, 0}}, {{8, 0}}, {{8, 2}}, {{6, 2}}, {{6, 4}}, {{5, 2}}, {{4, 4}}, {{0, 4}}})};
    EXPECT_EQ(ask(loops, {{1, 2}}), (Inside{Place::inside, 1}));
    EXPECT_EQ(ask(loops, {{-1, 2}}), (Inside{Place::outside, 0}));
    EXPECT_EQ(ask(loops, {{5, 2}}).place, Place::boundary);
    EXPECT_EQ(ask(loops, {{7, 2}}).place, Place::boundary);
    EXPECT_EQ(ask(loops, {{5.5, 2}}).place, Place::inside);
    EXPECT_EQ(ask(loops, {{-1, 0}}).place, Place::outside);
    EXPECT_EQ(ask(loops, {{-1, 4}}).place, Place::outside);
    EXPECT_EQ(ask(loops, {{9, 2}}).place, Place::outside);
    EXPECT_EQ(ask(loops, {{8, 3}}).place, Place::outside);
    EXPECT_EQ(ask(loops, {{5, 3}}).place, Place::outside);
}

TEST(R27, curved_contours_and_holes) {
    // A circle of radius 5 as four rational quarters, a hole that is an ellipse, an island in it.
    const double s = std::sqrt(0.5);
    std::vector<CurveGeometry<2>> circle;
    const Vec<2> corner[5] = {{{5, 0}}, {{0, 5}}, {{-5, 0}}, {{0, -5}}, {{5, 0}}};
    for (int i = 0; i < 4; ++i)
        circle.push_back(rational(
            {weighted(corner[i], 1), weighted(corner[i] + corner[i + 1], s), weighted(corner[i + 1], 1)}));
    const Loops loops = {circle,
                         {Conic<2>{ConicKind::ellipse, {}, {{3, 0}}, {{0, 2}}}},
                         polygon({{{-1, -1}}, {{1, -1}}, {{0, 1}}})};
    EXPECT_EQ(ask(loops, {{4, 0}}).place, Place::inside);
    EXPECT_EQ(ask(loops, {{2, 0}}), (Inside{Place::outside, 2}));
    EXPECT_EQ(ask(loops, {{0, 0}}), (Inside{Place::inside, 3}));
    EXPECT_EQ(ask(loops, {{3, 0}}).place, Place::boundary);
    EXPECT_EQ(ask(loops, {{0, 2}}).place, Place::boundary);
    EXPECT_EQ(ask(loops, {{std::nextafter(3, 4), 0}}).place, Place::inside);
    EXPECT_EQ(ask(loops, {{std::nextafter(3, 0), 0}}).place, Place::outside);
    EXPECT_EQ(ask(loops, {{5, 0}}).place, Place::boundary);
    EXPECT_EQ(ask(loops, {{3.5, 3.5}}).place, Place::inside);
    EXPECT_EQ(ask(loops, {{3.6, 3.6}}).place, Place::outside);
}

TEST(Inside, a_loop_that_is_run_through_twice_counts_twice_and_backwards_minus_once) {
    const std::vector<Vec<2>> square = {{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}};
    auto twice = polygon(square);
    const auto again = twice;
    twice.insert(twice.end(), again.begin(), again.end());
    EXPECT_EQ(ask({twice}, {{1, 1}}), (Inside{Place::outside, 2}));
    EXPECT_EQ(ask({polygon({square.rbegin(), square.rend()})}, {{1, 1}}), (Inside{Place::inside, -1}));
}

TEST(Inside, a_spline_and_its_bezier_pieces_agree) {
    std::mt19937 rng(3);
    for (int round = 0; round < 20; ++round) {
        std::vector<Vec<2>> c;
        for (int i = 0; i < 9; ++i) c.push_back({{test::uniform(rng, -1, 1), test::uniform(rng, -1, 1)}});
        const auto closed = *Curve<Vec<2>>::make(
            {*BSplineBasis::periodic(3, {0, 1, 2, 2.5, 3, 4, 5, 6, 7, 9})}, Net<1, Vec<2>>({9}, c));
        const auto open = *restrict_to(closed, 0, closed.basis().domain());
        const auto a = InsideQuery::make(Loops{{closed}}, 0), b = InsideQuery::make(Loops{{open}}, 1e-15);
        ASSERT_TRUE(a && b) << (a ? b : a).error().message;
        for (int i = 0; i < 200; ++i) {
            const Vec<2> q{{test::uniform(rng, -1, 1), test::uniform(rng, -1, 1)}};
            EXPECT_EQ(a->at(q), b->at(q));
        }
    }
}

// The first point and the last are the same, their weights are not: point times weight is rounded.
TEST(Inside, ends_that_only_rounding_parts_are_one) {
    std::mt19937 rng(12);
    const auto number = [&] { return test::uniform(rng, -1, 1); };
    int parted = 0;
    for (int i = 0; i < 40; ++i) {
        const double scale = i % 2 ? 1e11 : 1e-9, off = i % 4 ? 0 : 1e6 * scale;
        const auto point = [&] { return Vec<2>{{off + scale * number(), off + scale * number()}}; };
        const Vec<2> first = point();
        std::vector<Hom<2>> net{weighted(first, std::exp(number()))};
        for (int k = 0; k < 3; ++k) net.push_back(weighted(point(), std::exp(number())));
        net.push_back(weighted(first, std::exp(number())));
        parted += project(net.front()) != project(net.back());
        const auto query = InsideQuery::make(Loops{{rational(net)}}, 0);
        EXPECT_TRUE(query.has_value()) << i;
        // A periodic spline that is given as one without clamped knots.
        std::vector<double> knots;
        for (int k = 0; k < 12; ++k) knots.push_back(k * 0.3);
        std::vector<Vec<2>> points;
        for (int k = 0; k < 5; ++k) points.push_back(point());
        for (std::size_t k = 0; k < 3; ++k) points.push_back(points[k]);
        const auto ring = *Curve<Vec<2>>::make({*BSplineBasis::make(3, knots)}, Net<1, Vec<2>>({8}, points));
        EXPECT_TRUE(InsideQuery::make(Loops{{ring}}, 0).has_value()) << i;
        net.back() = weighted(first + Vec<2>{{1e-13 * (scale + off), 0}}, net.back().weight());
        EXPECT_FALSE(InsideQuery::make(Loops{{rational(net)}}, 0).has_value()) << i;
    }
    EXPECT_GT(parted, 3);
}

TEST(Inside, open_loops_and_curves_without_ends_are_refused_with_the_place) {
    const Loops open = {polygon({{{0, 0}}, {{1, 0}}, {{1, 1}}}),
                        {plane_bezier({{{0, 0}}, {{1, 0}}}), plane_bezier({{{1, 0.25}}, {{0, 0}}})}};
    const auto refused = InsideQuery::make(open, 0.1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "loops[1]");
    EXPECT_TRUE(refused.error().message.find("0.25") != std::string::npos) << refused.error().message;
    EXPECT_TRUE(InsideQuery::make(open, 0.25));
    EXPECT_EQ(InsideQuery::make(Loops{{Line<2>{{}, {{1, 0}}}}}, 0).error().where, "loops[0][0]");
    EXPECT_FALSE(InsideQuery::make(Loops{{}}, 0));
    EXPECT_EQ(ask({polygon({{{0, 0}}, {{1, 0}}, {{1, 1}}})}, {{NAN, 0}}).place, Place::outside);
}

TEST(Inside, scaling_by_powers_of_two_changes_nothing) {
    std::mt19937 rng(8);
    for (const double scale : {0x1p-300, 0x1p+300}) {
        std::vector<Vec<2>> p, q;
        for (int i = 0; i < 4; ++i)
            p.push_back({{test::uniform(rng, -1, 1), test::uniform(rng, -1, 1)}}),
                q.push_back(scale * p.back());
        const Loops a = {{plane_bezier(p), plane_bezier({p.back(), p.front()})}},
                    b = {{plane_bezier(q), plane_bezier({q.back(), q.front()})}};
        for (int i = 0; i < 300; ++i) {
            const Vec<2> at{{test::uniform(rng, -1, 1), test::uniform(rng, -1, 1)}};
            EXPECT_EQ(ask(a, at), ask(b, scale * at));
        }
        EXPECT_EQ(ask(b, q.front()).place, Place::boundary);
    }
}

// --- the judge: crossings of a half-line, counted by halving in long numbers
// ---------------------------------

using Quad = __float128;
// Averages of whole numbers stay exact in so many bits, 150 halvings deep.
using Long = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<1024, boost::multiprecision::digit_base_2>>;
struct JudgeArc {
    std::vector<Vec<2>> net;
};

// Crossings of the half-line to the right, with signs; nothing where so many halvings do not tell.
template <class T>
std::optional<int> crossings(const JudgeArc& arc, const Vec<2>& q, int deepest) {
    struct Part {
        std::vector<T> g, h;
        int depth;
    };
    Part whole{{}, {}, 0};
    for (const Vec<2>& p : arc.net)
        whole.g.push_back(T(p[1]) - T(q[1])), whole.h.push_back(T(p[0]) - T(q[0]));
    std::vector<Part> todo{whole};
    int sum = 0;
    while (!todo.empty()) {
        Part p = std::move(todo.back());
        todo.pop_back();
        const auto all = [](const std::vector<T>& v, auto&& is) {
            return std::all_of(v.begin(), v.end(), is);
        };
        const auto up = [](const T& a) { return a >= 0; };  // on the line counts as above
        const auto down = [](const T& a) { return a < 0; };
        if (all(p.g, up) && all(p.h, [](const T& a) { return a > 0; })) continue;
        if (all(p.g, [](const T& a) { return a > 0; }) || all(p.g, down) || all(p.h, down)) continue;
        if (all(p.h, [](const T& a) { return a > 0; })) {
            sum += int(up(p.g.back())) - int(up(p.g.front()));
            continue;
        }
        if (p.depth == deepest) return std::nullopt;
        Part right = p;
        right.depth = ++p.depth;
        for (auto [l, r] : {std::pair{&p.g, &right.g}, std::pair{&p.h, &right.h}})
            for (std::size_t k = 1; k < l->size(); ++k) {
                for (std::size_t i = 0; i + k < r->size(); ++i) (*r)[i] = ((*r)[i] + (*r)[i + 1]) / 2;
                (*l)[k] = (*r)[0];
            }
        todo.push_back(std::move(right));
        todo.push_back(std::move(p));
    }
    return sum;
}

Inside judged(const std::vector<JudgeArc>& arcs, const Vec<2>& q) {
    int winding = 0;
    for (const JudgeArc& a : arcs) {
        auto c = crossings<Quad>(a, q, 60);
        if (!c) c = crossings<Long>(a, q, 150);
        if (!c) return {Place::boundary, 0};
        winding += *c;
    }
    return {winding % 2 != 0 ? Place::inside : Place::outside, winding};
}

// Loops of arcs of degree 1 to 5 through integer points, among them horizontal and vertical edges and arcs
// with horizontal tangents.
struct Drawn {
    Loops loops;
    std::vector<JudgeArc> arcs;
    std::vector<std::vector<Vec<2>>> nets;
};
Drawn random_loops(std::mt19937& rng) {
    Drawn d;
    const int count = 1 + int(rng() % 3);
    const auto point = [&] { return Vec<2>{{double(rng() % 17), double(rng() % 17)}}; };
    for (int l = 0; l < count; ++l) {
        std::vector<CurveGeometry<2>> loop;
        const int arcs = 3 + int(rng() % 5);
        const Vec<2> first = point();
        Vec<2> last = first;
        for (int a = 0; a < arcs; ++a) {
            const int degree = 1 + int(rng() % 5);
            std::vector<Vec<2>> net{last};
            for (int i = 1; i < degree; ++i) net.push_back(point());
            net.push_back(a + 1 == arcs ? first : point());
            if (rng() % 4 == 0 && degree > 1)
                net[std::size_t(degree) - 1][1] = net.back()[1];  // horizontal at the end
            if (rng() % 4 == 0 && a + 1 < arcs) net.back()[1] = net.front()[1];
            if (rng() % 6 == 0 && a + 1 < arcs) net.back()[0] = net.front()[0];
            last = net.back();
            d.arcs.push_back({net});
            d.nets.push_back(net);
            loop.push_back(plane_bezier(net));
        }
        d.loops.push_back(std::move(loop));
    }
    return d;
}

// The point at k / 8: exact, because coordinates are whole and the degree is at most 5.
Vec<2> exact_point(std::vector<Vec<2>> b, int k) {
    keep_left(Fibre<Vec<2>>{b.data(), int(b.size()), 1}, k / 8.0);
    return b.back();
}

TEST(Inside, many_points_half_of_them_on_the_boundary_or_a_bit_beside_it) {
    std::mt19937 rng(20);
    int asked = 0, on = 0, beside = 0, wrong = 0;
    for (int set = 0; set < test::cases(200); ++set) {
        const Drawn d = random_loops(rng);
        const auto query = InsideQuery::make(d.loops, 0);
        ASSERT_TRUE(query);
        for (int i = 0; i < 500; ++i) {
            Vec<2> q;
            bool is_on = false;
            if (i % 2 == 0) {
                q = {{test::uniform(rng, -1, 17), test::uniform(rng, -1, 17)}};
                if (i % 8 == 0) q[1] = std::floor(q[1]);  // at the height of vertices
            } else {
                q = exact_point(d.nets[rng() % d.nets.size()],
                                rng() % 2 ? int(rng() % 2) * 8 : int(rng() % 9));
                is_on = i % 10 == 1;
                if (!is_on)
                    for (int c = 0; c < 2; ++c)
                        // A bit beside it; beside 0, what a bit is at 1.
                        if (const int step = int(rng() % 3) - 1; step != 0)
                            q[c] = q[c] == 0 ? step * 0x1p-52 : std::nextafter(q[c], step * 100.0);
            }
            const Inside got = query->at(q), want = is_on ? Inside{Place::boundary, 0} : judged(d.arcs, q);
            ++asked, on += got.place == Place::boundary, beside += i % 2;
            if (!(got == want)) {
                ++wrong;
                ADD_FAILURE() << "set " << set << " point " << q[0] << " " << q[1] << ": " << int(got.place)
                              << " " << got.winding << ", judged " << int(want.place) << " " << want.winding;
                ASSERT_LT(wrong, 5);
            }
        }
    }
    std::printf("%d points, %d of them on or beside the boundary, %d found to be on it, %d wrong\n", asked,
                beside, on, wrong);
    EXPECT_EQ(asked, test::cases(100000));
    EXPECT_GT(on, test::cases(10000));
}

TEST(Inside, many_points_at_once_get_the_same_answers) {
    std::mt19937 rng(4);
    const auto query = *InsideQuery::make(random_loops(rng).loops, 0);
    std::vector<Vec<2>> q;
    for (int i = 0; i < 5000; ++i) q.push_back({{test::uniform(rng, 0, 16), test::uniform(rng, 0, 16)}});
    std::vector<Inside> out(q.size());
    query.at(q, out);
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_EQ(out[i], query.at(q[i]));
}

}  // namespace
}  // namespace freiform
