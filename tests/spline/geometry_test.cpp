#include "support/shapes.hpp"

#include <freiform/spline/geometry.hpp>
#include <freiform/spline/hull_box.hpp>

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

TEST(Geometry, circles_are_called_so_within_rounding) {
    const auto name = [](const Vec<3>& x, const Vec<3>& y) {
        return kind_name(CurveGeometry<3>(Conic<3>{ConicKind::ellipse, {}, x, y}));
    };
    EXPECT_EQ(name({{3, 0, 0}}, {{0, 3 * (1 + 0x1p-50), 0x1p-50}}), "circle");
    EXPECT_EQ(name({{3, 0, 0}}, {{0, 3 * (1 + 1e-9), 0}}), "ellipse");
    EXPECT_EQ(name({{3, 0, 0}}, {{3 * std::sin(0.1), 3 * std::cos(0.1), 0}}), "ellipse") << "oblique";
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

TEST(Geometry, boxes_of_control_points_contain_what_they_stand_for) {
    std::mt19937 rng(6);
    int found = 0;
    for (const auto& [name, surface, on] : surfaces_of_every_kind(3))
        for (int k = 0; k < 40; ++k) {
            std::array<Interval, 2> part;
            for (int d = 0; d < 2; ++d) {
                const double a = uniform(rng, on[d].lo, on[d].hi), b = uniform(rng, on[d].lo, on[d].hi);
                part[d] = {std::min(a, b), std::max(a, b)};
            }
            const auto box = hull_box(surface, part);
            if (!box) continue;
            ++found;
            for (int i = 0; i <= 10; ++i)
                for (int j = 0; j <= 10; ++j) {
                    const Param<2> at{part[0].lo + part[0].length() * i / 10,
                                      part[1].lo + part[1].length() * j / 10};
                    const Vec<3> x = jet<0>(surface, at).value();
                    const double bound = 2 * value_error_bound(surface, part);
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_GE(x[c], box->lo[c] - bound) << name;
                        EXPECT_LE(x[c], box->hi[c] + bound) << name;
                    }
                }
        }
    EXPECT_GE(found, 200);
    // Pieces that are not met do not count; those of a closed curve may be named by any of its periods.
    const auto open = *Curve<Vec<1>>::make({*BSplineBasis::make(1, {0, 0, 1, 2, 3, 3})},
                                           Net<1, Vec<1>>({4}, {{{0}}, {{1}}, {{9}}, {{5}}}));
    const auto near = [](const CurveGeometry<1>& c, Interval part, double lo, double hi) {
        const auto box = hull_box(c, {part});
        ASSERT_TRUE(box);
        EXPECT_NEAR(box->lo[0], lo, 1e-13);
        EXPECT_NEAR(box->hi[0], hi, 1e-13);
    };
    near(open, {0.25, 0.5}, 0, 1);
    near(open, {0.25, 1.5}, 0, 9);
    near(open, {2.5, 3}, 5, 9);
    const auto closed = *Curve<Vec<1>>::make({*BSplineBasis::periodic(1, {0, 1, 2, 3})},
                                             Net<1, Vec<1>>({3}, {{{0}}, {{1}}, {{9}}}));
    const double ends[2] = {jet<0>(CurveGeometry<1>(closed), 0.0).value()[0],
                            jet<0>(CurveGeometry<1>(closed), 1.0).value()[0]};
    near(closed, {0.25, 0.5}, std::min(ends[0], ends[1]), std::max(ends[0], ends[1]));
    for (const auto& points :
         {std::vector<Vec<1>>{{{0}}, {{1}}, {{9}}}, {{{9}}, {{0}}, {{1}}}, {{{1}}, {{9}}, {{0}}}})
        near(*Curve<Vec<1>>::make(closed.bases(), Net<1, Vec<1>>({3}, points)), {3.25, 3.5}, 0, 9);
    near(Line<1>{{{1}}, {{-2}}}, {0, 3}, -5, 1);
    EXPECT_FALSE(hull_box(CurveGeometry<3>(Conic<3>{}), {{{0, 1}}}));
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
