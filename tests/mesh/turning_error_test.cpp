// The largest error along normals that turn is no more than what is said, and hardly less.
#include "mesh/turning_error_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/vec.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

struct Case {
    TurningError error;
    std::array<Vec<2>, 3> corner;
    Vec<2> by_u{}, by_v{};  // t is the length of what these make of a place, and `still` more
    double still = 0;

    double turning(const Vec<2>& x) const { return norm(x[0] * by_u + x[1] * by_v) + still; }
    // By barycentric coordinates: p and b as sums over sides.
    double at(const std::array<double, 3>& l, bool with_p) const {
        double p = 0, b = 0;
        Vec<2> x{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double both = l[(k + 1) % 3] * l[(k + 2) % 3];
            p += both * error.along[k] / 2, b += both * error.beside[k] / 2;
            x += l[k] * corner[k];
        }
        return (with_p ? std::abs(p) : 0) + turning(x) * (b + error.more);
    }
    double largest(bool with_p) const {
        double most = 0;
        constexpr int kSteps = 48;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j) {
                const double a = double(i) / kSteps, b = double(j) / kSteps;
                most = std::max(most, at({a, b, 1 - a - b}, with_p));
            }
        return most;
    }
    void find() {
        for (std::size_t k = 0; k < 3; ++k) {
            error.at_corner[k] = turning(corner[k]);
            error.at_middle[k] = turning(0.5 * (corner[(k + 1) % 3] + corner[(k + 2) % 3]));
        }
        error.find();
    }
};

Case random_case(Random& random, bool has_p) {
    Case c;
    const auto place = [&] { return Vec<2>{{random.real(-1, 1), random.real(-1, 1)}}; };
    for (std::size_t k = 0; k < 3; ++k) {
        c.corner[k] = place();
        c.error.along[k] = has_p ? random.real(-1, 1) : 0, c.error.beside[k] = random.real(0, 1);
    }
    c.by_u = random.real(0, 1) * place(), c.by_v = random.real(0, 1) * place();
    c.still = random.integer(0, 1) * random.real(0, 0.5),
    c.error.more = random.integer(0, 1) * random.real(0, 0.2);
    return c;
}

TEST(TurningError, holds_everywhere_on_the_triangle) {
    Random random(71);
    double slackest = 0, sharpest = 0;
    for (int k = 0; k < 2000; ++k) {
        Case c = random_case(random, k % 4 != 0);
        if (k % 4 == 1) {  // still, and most inside
            for (double& x : c.error.along) x = random.real(0.9, 1);
            c.by_u = c.by_v = {}, c.still = 0;
        }
        c.find();
        const double most = c.largest(true), turned = c.largest(false);
        EXPECT_LE(most, c.error.together * (1 + 1e-12));
        EXPECT_LE(turned, c.error.turned * (1 + 1e-12));
        slackest = std::max(slackest, c.error.together / most),
        sharpest = std::max(sharpest, most / c.error.together);
    }
    EXPECT_LT(slackest, 2);
    EXPECT_GT(sharpest, 0.999);
}

// Halves of a square where one axis bends: the largest error is in the middle of the longest side, where
// normals have not turned yet.
TEST(TurningError, is_hardly_more_than_without_turning_where_normals_are_still) {
    Case c;
    c.corner = {Vec<2>{{-1, -1}}, Vec<2>{{1, -1}}, Vec<2>{{1, 1}}};
    c.error.along = {1, 2, 1}, c.error.beside = {1, 2, 1};
    c.by_u = {{0.1, 0}}, c.by_v = {{0, 0.1}};
    c.find();
    EXPECT_NEAR(c.largest(true), 0.25, 0.01);
    EXPECT_LT(c.error.together, 1.07 * c.largest(true));
    EXPECT_GT(c.error.turned, 0);
}

}  // namespace
}  // namespace freiform
