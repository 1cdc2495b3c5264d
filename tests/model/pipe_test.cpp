// Laws: what a disc sweeps across its way has its area times the length of that (Guldin); pipes are closed
// and look outwards, their walls are cylinders and tori as far from the rail as the radius.
#include "random.hpp"
#include "refusal.hpp"
#include "solids.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/nearest.hpp>
#include <freiform/model/pipe.hpp>

namespace freiform::test {
namespace {

double length_of(std::span<const RailPart> rail) {
    double sum = 0;
    for (const RailPart& p : rail) sum += p.on.length() * norm(jet<1>(p.curve, p.on.lo).d[1]);
    return sum;
}

// An L of lines and an arc, then back upwards, out of its plane.
const std::vector<Vec<3>> kCorners{{{0, 0, 0}}, {{9, 0, 0}}, {{9, 7, 1}}, {{2, 7, 9}}, {{2, 0, 20}}};

TEST(Pipe, has_the_volume_that_guldin_says_and_looks_outwards) {
    for (const double hole : {0.0, 0.6}) {
        const auto rail = must(bent_polyline(kCorners, 1.5));
        EXPECT_EQ(rail.size(), 7u);
        const Model m = must(pipe(rail, 0.75, hole));
        EXPECT_EQ(m.faces.size(), (hole > 0 ? 2 : 1) * 7 + 2u);
        const double volume = kPi * (0.75 * 0.75 - hole * hole) * length_of(rail);
        EXPECT_NEAR(signed_volume(closed_tessellation(m, 1e-4).mesh), volume, 2e-3 * volume);
        for (std::size_t f = 0; f + 2 < m.faces.size(); ++f)
            EXPECT_EQ(kind_name(m.faces[f].surface),
                      std::holds_alternative<Line<3>>(rail[f % 7].curve) ? "cylinder" : "torus");
    }
}

TEST(Pipe, rings_take_as_many_triangles_in_any_position) {
    const auto count = [](const Vec<3>& x, const Vec<3>& y) {
        const RailPart ring{Conic<3>{ConicKind::ellipse, {}, 4.0 * x, 4.0 * y}, {0, 2 * kPi}};
        return double(closed_tessellation(must(pipe(std::span(&ring, 1), 1)), 0.017).mesh.triangles.size());
    };
    const double flat = count({{1, 0, 0}}, {{0, 1, 0}});
    for (int i = 1; i < 8; ++i) {
        const Vec<3> x = unit(Vec<3>{{std::cos(i), std::sin(i), 0.3 * i}}),
                     y = unit(cross(Vec<3>{{1, 0.1 * i, -2}}, x));
        EXPECT_NEAR(count(x, y), flat, 0.02 * flat) << i;
    }
}

TEST(Pipe, walls_are_as_far_from_the_rail_as_the_radius) {
    const auto rail = must(bent_polyline(kCorners, 2));
    const Model m = must(pipe(rail, 0.5));
    for (std::size_t i = 0; i < rail.size(); ++i)
        for (int k = 0; k <= 8; ++k) {
            const auto j = jet<1>(rail[i].curve, rail[i].on.lo + rail[i].on.length() * k / 8);
            for (int corner = 0; corner < 7; ++corner) {
                const Vec<3> across =
                    unit(cross(j.d[1], Vec<3>{{std::cos(corner), std::sin(corner), 0.2 + 0.3 * corner}}));
                const Vec<3> p = j.value() + 0.5 * across;
                const Face& wall = m.faces[i];
                double least = kInfinity;  // from the wall of the part, in its own parameters
                const bool turns = std::holds_alternative<Revolution>(wall.surface);
                const auto& e = m.edges[std::size_t(wall.loops[0].coedges[turns ? 0 : 1].edge)];
                for (int n = 0; n < 720; ++n) {
                    const double way = e.range.lo + e.range.length() * k / 8, turn = 2 * kPi * n / 720;
                    const Vec<2> at = turns ? Vec<2>{{way, turn}} : Vec<2>{{turn, way}};
                    least = std::min(least, norm(jet<0>(wall.surface, at.c).value() - p));
                }
                EXPECT_LT(least, 0.5 * kPi / 720 + 1e-9) << i;
            }
        }
}

TEST(Pipe, rings_have_no_ends_and_holes_in_them_are_voids) {
    const std::vector<Vec<3>> square{{{0, 0, 3}}, {{8, 0, 3}}, {{8, 5, 3}}, {{0, 5, 3}}};
    const auto rail = must(bent_polyline(square, 1.2, true));
    ASSERT_EQ(rail.size(), 8u);
    const Model m = must(pipe(rail, 0.5, 0.2));
    EXPECT_EQ(m.faces.size(), 16u);
    ASSERT_EQ(m.bodies.size(), 1u);
    EXPECT_EQ(m.bodies[0].shells.size(), 2u);
    const double volume = kPi * (0.25 - 0.04) * length_of(rail);
    EXPECT_NEAR(signed_volume(closed_tessellation(m, 1e-4).mesh), volume, 2e-3 * volume);
    // A circle alone is a torus.
    const RailPart circle{Conic<3>{ConicKind::ellipse, {}, {{0, 4, 0}}, {{0, 0, 4}}}, {1, 1 + 2 * kPi}};
    const Model torus = must(pipe(std::array{circle}, 1));
    EXPECT_EQ(torus.faces.size(), 1u);
    EXPECT_NEAR(signed_volume(closed_tessellation(torus, 1e-4).mesh), 8 * kPi * kPi, 8e-2);
}

TEST(Pipe, corners_that_are_hardly_any_need_no_arc) {
    for (const double off : {0.0, 1e-15, 5e-13, 1e-11, 1e-6}) {
        const std::vector<Vec<3>> nearly{{{0, 0, 0}}, {{1, 1, 1}}, {{2, 2, 2 + off}}, {{3, 3, 3}}};
        const Model m = must(pipe(must(bent_polyline(nearly, 0.5)), 0.25));
        EXPECT_NEAR(signed_volume(closed_tessellation(m, 1e-3, 1e-11).mesh), kPi / 16 * std::sqrt(27.0), 1e-2)
            << off;
    }
}

TEST(Pipe, parts_may_run_backwards) {
    auto rail = must(bent_polyline(kCorners, 1.5));
    const double volume = signed_volume(closed_tessellation(must(pipe(rail, 0.5)), 1e-3).mesh);
    for (RailPart& p : rail) p.reversed = true;
    std::ranges::reverse(rail);
    EXPECT_NEAR(signed_volume(closed_tessellation(must(pipe(rail, 0.5)), 1e-3).mesh), volume, 1e-2 * volume);
}

TEST(Pipe, joints_may_be_apart_as_far_as_is_said_and_edges_say_so) {
    auto rail = must(bent_polyline(kCorners, 1.5));
    auto& line = std::get<Line<3>>(rail[2].curve);
    line.origin[2] += 1e-4, line.direction = unit(line.direction + Vec<3>{{1e-5, 0, 0}});
    expect_refusal(pipe(rail, 0.5), RefusalKind::invalid, "rail[1]");
    const Model m = must(pipe(rail, 0.5, 0, 1e-3));
    double most = 0;
    for (const Edge& e : m.edges) most = std::max(most, e.tolerance);
    EXPECT_GE(most, 1e-4);
    EXPECT_LE(most, 1e-3);
    const auto t = must(tessellate(m, {.tolerance = 1e-2}));
    EXPECT_EQ(t.topology.open_edges, 0);
    EXPECT_GT(t.boundary_gap, 5e-5);
    EXPECT_LE(t.boundary_gap, most);
}

TEST(Pipe, what_is_no_pipe_is_refused) {
    const auto rail = must(bent_polyline(kCorners, 1.5));
    expect_refusal(pipe(rail, 0), RefusalKind::invalid, "radius");
    expect_refusal(pipe(rail, 1, 1), RefusalKind::invalid, "hole");
    expect_refusal(pipe(rail, 1.5), RefusalKind::unsupported, "rail[1]");
    expect_refusal(pipe({}, 1), RefusalKind::invalid, "rail");
    expect_refusal(bent_polyline(std::span(kCorners).first(1), 1), RefusalKind::invalid, "corners");
    expect_refusal(bent_polyline(kCorners, 0), RefusalKind::invalid, "corners[1]");
    expect_refusal(bent_polyline(kCorners, 6), RefusalKind::no_answer, "corners[1]");
    expect_refusal(bent_polyline(std::vector<Vec<3>>{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0, 0}}}, 1),
                   RefusalKind::invalid, "corners[1]");
    // A ring out of a plane brings the disc back turned.
    const std::vector<Vec<3>> skew{{{0, 0, 0}}, {{9, 0, 0}}, {{9, 9, 4}}, {{0, 9, 9}}};
    expect_refusal(pipe(must(bent_polyline(skew, 1, true)), 0.5), RefusalKind::unsupported, "rail");
    const RailPart ellipse{Conic<3>{ConicKind::ellipse, {}, {{0, 4, 0}}, {{0, 0, 3}}}, {0, 1}};
    expect_refusal(pipe(std::array{ellipse}, 1), RefusalKind::unsupported, "rail[0]");
}

}  // namespace
}  // namespace freiform::test
