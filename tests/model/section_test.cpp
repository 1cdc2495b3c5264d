// Sections of solids: closed, in the plane, on the faces, with the areas that are known.
#include <freiform/model/section.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

ModelSection section_of(const Model& m, const Plane& plane, double tolerance) {
    return must(section(m, plane, {.tolerance = tolerance}));
}

double plane_distance(const Plane& plane, const Vec<3>& p) {
    return std::abs(dot(plane.normal, p) + plane.offset) / norm(plane.normal);
}

TEST(ModelSection, of_a_sphere_is_a_circle_over_seam_and_poles) {
    const Vec<3> c{{1, 2, 3}};
    const Model m = sphere(c, 2);
    for (const Plane& plane : {Plane{{{0, 0, 1}}, -3.5}, Plane{{{3, 0, 0}}, -3.0}, Plane{{{1, -2, 0.5}}, 2.0},
                               Plane{{{0, 0, 1}}, -3}}) {
        const auto cut = section_of(m, plane, 4e-3);
        ASSERT_EQ(cut.lines.size(), 1u);
        EXPECT_TRUE(cut.lines[0].closed);
        EXPECT_EQ(cut.lines[0].points.front(), cut.lines[0].points.back());
        EXPECT_EQ(cut.lines[0].faces.size() + 1, cut.lines[0].points.size());
        EXPECT_LE(cut.bound, 4.4e-3);
        const double h = plane_distance(plane, c), r2 = 4 - h * h;
        for (const Vec<3>& p : cut.lines[0].points) {
            EXPECT_LE(plane_distance(plane, p), cut.plane_bound);
            EXPECT_NEAR(norm(p - c), 2, cut.bound);
        }
        for (const int f : cut.lines[0].faces) EXPECT_EQ(f, 0);
        EXPECT_NEAR(cut.area, kPi * r2, 0.02 * kPi * r2);
        EXPECT_LE(cut.area, kPi * r2);
    }
    EXPECT_TRUE(section_of(m, {{{0, 0, 1}}, -6}, 1e-2).lines.empty());
}

TEST(ModelSection, of_a_torus_has_a_hole_that_counts_negative) {
    const Model m = torus(3, 1);
    const auto cut = section_of(m, {{{0, 0, 2}}, 0}, 4e-3);
    ASSERT_EQ(cut.lines.size(), 2u);
    EXPECT_LT(cut.lines[0].area * cut.lines[1].area, 0);
    EXPECT_NEAR(cut.area, kPi * (16 - 4), 0.1);
    const auto across = section_of(m, {{{1, 0, 0}}, 0}, 4e-3);
    ASSERT_EQ(across.lines.size(), 2u);
    EXPECT_GT(across.lines[0].area, 0);
    EXPECT_NEAR(across.area, 2 * kPi, 0.02);
    // The other side of the plane: the same lines, seen from the other side.
    EXPECT_NEAR(section_of(m, {{{-1, 0, 0}}, 0}, 4e-3).area, across.area, 1e-9);
}

TEST(ModelSection, goes_over_edges_and_closes_at_every_angle) {
    Random random(5);
    const Model m = frustum(1, 0.5, 2);
    const Box<3> box = summary(m).box;
    int faces_seen = 0;
    for (int trial = 0; trial < 40; ++trial) {
        Vec<3> n, p;
        for (int k = 0; k < 3; ++k) {
            n[k] = random.real(-1, 1);
            p[k] = random.real(box.lo[k], box.hi[k]);
        }
        const auto cut = section_of(m, {n, -dot(n, p)}, 1e-2);
        EXPECT_TRUE(cut.refused.empty());
        for (const auto& l : cut.lines) {
            EXPECT_TRUE(l.closed) << trial;
            for (const Vec<3>& q : l.points) EXPECT_LE(plane_distance({n, -dot(n, p)}, q), cut.plane_bound);
            std::vector<int> faces = l.faces;
            std::ranges::sort(faces);
            faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
            faces_seen = std::max(faces_seen, int(faces.size()));
            EXPECT_GE(faces.front(), 0);
        }
    }
    EXPECT_EQ(faces_seen, 3);
}

// The ends lie in the plane: they are above it. A cut through the lower one meets nothing, through the upper
// one its rim.
TEST(ModelSection, faces_in_the_plane_are_on_the_side_of_its_normal) {
    const Model m = frustum(1, 0.5, 2);
    for (const double off : {0.0, 1e-13, -1e-13}) {
        EXPECT_TRUE(section_of(m, {{{0, 0, 1}}, off}, 4e-3).lines.empty());
        const auto top = section_of(m, {{{0, 0, 1}}, -2 + off}, 4e-3);
        ASSERT_EQ(top.lines.size(), 1u);
        EXPECT_TRUE(top.lines[0].closed);
        EXPECT_NEAR(top.area, kPi * 0.25, 0.01);
    }
    // A tangent plane touches a sphere, or meets nothing.
    EXPECT_LE(section_of(sphere({}, 1), {{{0, 0, 1}}, -1}, 1e-2).area, 1e-9);
}

TEST(ModelSection, refuses_what_is_no_plane_and_tolerances_that_are_none) {
    const Model m = sphere({}, 1);
    expect_refusal(section(m, {}, {.tolerance = 0.1}), RefusalKind::invalid, "plane");
    expect_refusal(section(m, {{{NAN, 0, 1}}, 0}, {.tolerance = 0.1}), RefusalKind::nonfinite, "plane");
    expect_refusal(section(m, {{{0, 0, 1}}, 0}, {.tolerance = -1}), RefusalKind::invalid, "tolerance");
    // Of any length: its square is beyond doubles.
    EXPECT_EQ(section_of(m, {{{0, 0, 1e300}}, 0}, 0.1).area, section_of(m, {{{0, 0, 1}}, 0}, 0.1).area);
}

}  // namespace
}  // namespace freiform::test
