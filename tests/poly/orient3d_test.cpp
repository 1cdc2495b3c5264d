#include <freiform/poly/predicates.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/sanitizer.hpp>

namespace freiform::test {
namespace {

TEST(Orient3d, is_positive_below_a_triangle_that_turns_counter_clockwise) {
    const Vec<3> a{{0, 0, 0}}, b{{1, 0, 0}}, c{{0, 1, 0}};
    EXPECT_EQ(orient3d(a, b, c, {{0, 0, -1}}), 1);
    EXPECT_EQ(orient3d(a, b, c, {{0, 0, 1}}), -1);
    EXPECT_EQ(orient3d(a, b, c, {{5, 7, 0}}), 0);
    EXPECT_EQ(orient3d(a, b, c, {{1e300, 1e300, 5e-324}}), -1);
    EXPECT_EQ(orient3d(a, b, c, {{1e300, 1e300, -5e-324}}), 1);
}

// a, b, c on small integers, d = a + (b - a) s + (c - a) t moved by the last bit of one coordinate.
TEST(Orient3d, sees_the_last_bit_beside_a_plane_and_changes_its_sign_with_the_order) {
    Random random(6);
    for (int k = 0; k < cases(2000); ++k) {
        Vec<3> a, b, c;
        for (Vec<3>* p : {&a, &b, &c})
            for (int i = 0; i < 3; ++i) (*p)[i] = std::floor(random.real(-8, 8));
        const double s = std::floor(random.real(-4, 5)), t = std::floor(random.real(-4, 5));
        Vec<3> d = a + s * (b - a) + t * (c - a);
        ASSERT_EQ(orient3d(a, b, c, d), 0);
        const Vec<3> n = cross(b - a, c - a);
        if (n[2] == 0) continue;
        d[2] = std::nextafter(d[2], 100.0);
        const int above = n[2] > 0 ? -1 : 1;
        EXPECT_EQ(orient3d(a, b, c, d), above);
        EXPECT_EQ(orient3d(b, a, c, d), -above);
        EXPECT_EQ(orient3d(b, c, d, a), -above);
    }
}

}  // namespace
}  // namespace freiform::test
