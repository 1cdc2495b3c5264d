#include "support/shapes.hpp"

#include <freiform/spline/geometry.hpp>

#include <gtest/gtest.h>
#include <numbers>

using namespace freiform;
using namespace freiform::test;

namespace {

double scale_of(const Vec<3>& v) { return 1 + max_abs(v); }

TEST(Geometry, first_and_second_derivatives_agree_with_differences) {
    std::mt19937 rng(3);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(1))
        for (int k = 0; k < 100; ++k) {
            const double h = 1e-5;
            const Param<2> at{uniform(rng, on[0].lo + 0.01, on[0].hi - 0.01),
                              uniform(rng, on[1].lo + 0.01, on[1].hi - 0.01)};
            const auto j = jet<2>(surface, at);
            const auto up = jet<1>(surface, {at[0] + h, at[1]}), um = jet<1>(surface, {at[0] - h, at[1]});
            const auto vp = jet<1>(surface, {at[0], at[1] + h}), vm = jet<1>(surface, {at[0], at[1] - h});
            // Central differences across a knot see the jump of the third derivative only.
            const auto near = [&](const Vec<3>& exact, const Vec<3>& plus, const Vec<3>& minus,
                                  double limit) {
                const Vec<3> difference = (1 / (2 * h)) * (plus - minus);
                EXPECT_LE(max_abs(difference - exact), limit * scale_of(exact))
                    << name << " at " << at[0] << ", " << at[1];
            };
            near(j(1, 0), up.d[0], um.d[0], 1e-3);
            near(j(0, 1), vp.d[0], vm.d[0], 1e-3);
            near(j(1, 1), vp(1, 0), vm(1, 0), 2e-2);
            if (std::string_view(name) == "nurbs" || std::string_view(name) == "bspline")
                continue;  // degree 2: f_uu jumps
            near(j(2, 0), up(1, 0), um(1, 0), 2e-2);
            near(j(0, 2), vp(0, 1), vm(0, 1), 2e-2);
        }
}

TEST(Geometry, quadrics_satisfy_their_equations) {
    std::mt19937 rng(4);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(1)) {
        const std::string_view kind = kind_name(surface);
        for (int k = 0; k < 50; ++k) {
            const Param<2> at{uniform(rng, on[0].lo, on[0].hi), uniform(rng, on[1].lo, on[1].hi)};
            const Vec<3> p = jet<0>(surface, at).value();
            const double bound = 4 * value_error_bound(surface, on), r = std::hypot(p[0], p[1]);
            if (kind == "cylinder") EXPECT_NEAR(std::hypot(p[0] - 1, p[1]), 2, bound);
            if (kind == "sphere") EXPECT_NEAR(norm(p), 3, bound);
            if (kind == "torus") EXPECT_NEAR(std::hypot(r - 5, p[2]), 1, bound);
            if (kind == "cone") EXPECT_NEAR(r, std::abs(2 + 0.75 * p[2]), 4 * bound);
            if (std::string_view(name) == "offset of a torus")
                EXPECT_NEAR(std::hypot(r - 5, p[2]), 0.75, bound);
            if (std::string_view(name) == "hyperboloid") EXPECT_NEAR(r * r - p[2] * p[2] / 4, 1, 40 * bound);
        }
    }
}

TEST(Geometry, offsets_keep_their_distance_along_the_normal) {
    std::mt19937 rng(5);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(2)) {
        const auto* offset = std::get_if<OffsetSurface>(&surface);
        if (!offset) continue;
        for (int k = 0; k < 50; ++k) {
            const Param<2> at{uniform(rng, on[0].lo, on[0].hi), uniform(rng, on[1].lo, on[1].hi)};
            const Vec<3> d = jet<0>(surface, at).value() - jet<0>(*offset->base, at).value();
            EXPECT_NEAR(norm(d), std::abs(offset->distance), 1e-13) << name;
            EXPECT_NEAR(dot(d, normal(*offset->base, at)), offset->distance, 1e-13) << name;
        }
    }
}

TEST(Geometry, what_has_no_direction_is_refused) {
    const auto where = [](const SurfaceGeometry& s) {
        return check(s) ? std::string("accepted") : check(s).error().where;
    };
    const Line<3> line{{}, {{1, 0, 0}}};
    EXPECT_EQ(where(Extrusion{line, {}, SurfaceKind::plane}), "extrusion.direction");
    EXPECT_EQ(where(Extrusion{Line<3>{}, {{1, 0, 0}}, SurfaceKind::plane}),
              "extrusion.profile.line.direction");
    EXPECT_EQ(where(Revolution{line, {}, {{0, 0, 2}}, SurfaceKind::cone}), "revolution.axis");
    EXPECT_EQ(where(OffsetSurface{}), "offset.base");
    EXPECT_EQ(where(Extrusion{Line<3>{{}, {{1, NAN, 0}}}, {{1, 0, 0}}, SurfaceKind::plane}),
              "extrusion.profile.line");
}

}  // namespace
