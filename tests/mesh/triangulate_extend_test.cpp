// A boundary first, and what is inside of it later: as if all had been there from the beginning.
#include "support/constrained_triangulation.hpp"

namespace freiform {
namespace {

using namespace test;

// The first loop, or all loops but the last one; the rest later.
struct Halves {
    Region all, first;
    Points later;
    Segments sides;
};

Halves halves(const Region& r, std::size_t first_loop_ends) {
    Halves h{r, {}, {}, {}};
    const auto n = std::ptrdiff_t(first_loop_ends);
    h.first.points.assign(r.points.begin(), r.points.begin() + n);
    h.first.segments.assign(r.segments.begin(), r.segments.begin() + n);
    h.later.assign(r.points.begin() + n, r.points.end());
    h.sides.assign(r.segments.begin() + n, r.segments.end());
    return h;
}

TEST(TriangulationExtend, makes_what_is_made_at_once) {
    std::mt19937 random(3);
    for (const std::size_t first : {97u, 97u + 40, 97u + 40 + 33 + 21}) {  // loops of nested_rings
        const Halves h = halves(nested_rings(random), first);
        Triangulation t = make(h.first);
        ASSERT_TRUE(t.extend(h.later, h.sides));
        EXPECT_TRUE(t.changed().empty());
        for (std::size_t i = 0; i < h.all.points.size(); ++i) ASSERT_EQ(t.points()[i], h.all.points[i]);
        ASSERT_NO_FATAL_FAILURE(check_structure(t, h.all.segments));
        ASSERT_NO_FATAL_FAILURE(check_by_definition(t, h.all));
        EXPECT_EQ(inside_area(t), inside_area(make(h.all)));
    }
}

TEST(TriangulationExtend, takes_points_anywhere) {
    std::mt19937 random(4);
    for (int k = 0; k < 8; ++k) {
        Region r = region_number(k, random);
        Triangulation t = make(r);
        std::set<std::array<double, 2>> known;
        for (const auto& p : r.points) known.insert(p.c);
        std::uniform_real_distribution<double> x(-2e6, 2e6);
        Points more;
        for (int i = 0; i < 60; ++i)
            if (const Vec<2> p = on_lattice(x(random), x(random)); known.insert(p.c).second)
                more.push_back(p);
        ASSERT_TRUE(t.extend(more, {}));
        r.points.insert(r.points.end(), more.begin(), more.end());
        ASSERT_NO_FATAL_FAILURE(check_structure(t, r.segments));
        ASSERT_NO_FATAL_FAILURE(check_by_definition(t, r));
    }
}

TEST(TriangulationExtend, refuses_what_does_not_fit) {
    const Region square{{{{0, 0}}, {{8, 0}}, {{8, 8}}, {{0, 8}}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
    const auto told = [&](const Points& points, const Segments& segments) {
        Triangulation t = make(square);
        const auto ok = t.extend(points, segments);
        return ok ? std::string("done")
                  : text(name_of(ok.error().kind), " ", ok.error().where, ": ", ok.error().message);
    };
    EXPECT_EQ(told({{{2, 2}}, {{4, 2}}, {{2, 4}}}, {{4, 5}, {5, 6}, {6, 4}}), "done");
    EXPECT_EQ(told({{{8, 8}}}, {}), "invalid points[4]: equals another point, or lies on a segment");
    EXPECT_EQ(told({{{1, 1}}, {{1, 1}}}, {}).substr(0, 14), "invalid points");
    EXPECT_EQ(told({{{4, 0}}}, {}), "invalid points[4]: equals another point, or lies on a segment");
    EXPECT_EQ(told({{{kInfinity, 0}}}, {}), "nonfinite points[4]: (inf, 0) is not finite");
    EXPECT_EQ(told({{{2, 2}}}, {{4, 5}}), "invalid segments[0]: ends at point 5, but there are 5 points");
    EXPECT_EQ(told({{{2, 2}}}, {{4, 0}}),
              "invalid points[0]: the boundary is not closed: an odd number of segments ends here");
    EXPECT_EQ(told({{{2, 2}}, {{9, 2}}, {{9, 3}}}, {{4, 5}, {5, 6}, {6, 4}}).substr(0, 28),
              "invalid segments[0]: crosses");
    EXPECT_EQ(told({{{2, 2}}, {{6, 2}}, {{4, 2}}, {{4, 6}}}, {{4, 5}, {5, 7}, {7, 4}}),
              "invalid segments[0]: crosses another segment, or passes through a point");
    Triangulation flat = make({{{{0, 0}}, {{1, 0}}, {{3, 0}}}, {}});
    EXPECT_FALSE(flat.extend(Points{{{1, 1}}}, {}));
}

}  // namespace
}  // namespace freiform
