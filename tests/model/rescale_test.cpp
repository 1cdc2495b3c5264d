#include "support/refusal.hpp"
#include "support/solids.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/rescale.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

TEST(Rescale, models_of_any_size_have_the_same_mesh) {
    const auto plain = tessellate(torus(3, 1), {.tolerance = 0.01});
    ASSERT_TRUE(plain);
    for (const int k : {-1000, -700, -400, 400, 700, 1000}) {
        const auto far =
            tessellate(torus(std::ldexp(3, k), std::ldexp(1, k)), {.tolerance = std::ldexp(0.01, k)});
        ASSERT_TRUE(far) << k << ": " << far.error().message;
        ASSERT_TRUE(far->refused.empty()) << k;
        ASSERT_EQ(plain->mesh.triangles, far->mesh.triangles) << k;
        for (std::size_t i = 0; i < plain->mesh.points.size(); ++i)
            for (int d = 0; d < 3; ++d)
                ASSERT_EQ(std::ldexp(plain->mesh.points[i][d], k), far->mesh.points[i][d]) << k;
        EXPECT_GE(far->error_bound, std::ldexp(plain->error_bound, k)) << k;
        EXPECT_LE(far->error_bound, std::ldexp(0.01, k)) << k;
    }
}

TEST(Rescale, far_parameters_are_refused_by_name) {
    // The parameters of a plane are lengths.
    const double far = 0x1p400;
    Model m = frustum(far, far, 2 * far);
    const auto t = tessellate(m, {.tolerance = far / 100});
    ASSERT_TRUE(t);
    for (const RefusedFace& f : t->refused) {
        EXPECT_EQ(f.reason.kind, RefusalKind::unsupported) << f.reason.message;
        EXPECT_NE(f.reason.message.find("2^320"), std::string::npos) << f.reason.message;
    }
    EXPECT_FALSE(t->refused.empty());
}

TEST(Rescale, there_and_back_is_where_it_was_and_infinity_is_refused) {
    for (const Model& m : {test::sphere({{1, 2, 3}}, 2), frustum(2, 1, 3), torus(3, 1)}) {
        const auto there = rescaled(m, 600);
        ASSERT_TRUE(there);
        const auto back = rescaled(*there, -600);
        ASSERT_TRUE(back);
        for (std::size_t i = 0; i < m.edges.size(); ++i) EXPECT_EQ(m.edges[i].curve, back->edges[i].curve);
        for (std::size_t i = 0; i < m.vertices.size(); ++i)
            EXPECT_EQ(m.vertices[i].point, back->vertices[i].point);
        EXPECT_EQ(jet<0>(m.faces[0].surface, {0.5, 0.25}).value(),
                  jet<0>(back->faces[0].surface, {0.5, 0.25}).value());
    }
    expect_refusal(rescaled(torus(3, 1), 1023), RefusalKind::nonfinite, "vertices[0]", "2^1023");
}

TEST(Rescale, divided_numbers_are_those_of_another_unit) {
    const Model m = test::sphere({{25.4, 50.8, 0}}, 2.54);
    const auto inches = divided(m, 25.4);
    ASSERT_TRUE(inches);
    for (const Vec<2>& at : {Vec<2>{{0.5, 0.25}}, Vec<2>{{2, 1}}}) {
        const Vec<3> before = jet<0>(m.faces[0].surface, at.c).value(),
                     after = jet<0>(inches->faces[0].surface, at.c).value();
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(25.4 * after[d], before[d], 1e-14 * 50.8);
    }
    for (std::size_t i = 0; i < m.edges.size(); ++i)
        EXPECT_EQ(inches->edges[i].tolerance, m.edges[i].tolerance / 25.4);
    for (const double by : {0.0, -1.0, kInfinity, std::nan("")})
        expect_refusal(divided(m, by), RefusalKind::invalid, "by", "positive");
    expect_refusal(divided(torus(3, 1), 1e-320), RefusalKind::nonfinite, "vertices[0]", "1e-320");
}

}  // namespace
