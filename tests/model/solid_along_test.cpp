#include "random.hpp"
#include "refusal.hpp"
#include "regions.hpp"
#include "solids.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/query/length.hpp>

namespace freiform::test {
namespace {

// A square of side 2 about the origin with a round hole of radius 1/2: its centroid is the origin.
RegionLoops frame_of_a_window() {
    Path path = path_from("M -1 -1 L 1 -1 L 1 1 L -1 1 Z");
    path.subpaths.push_back(ellipse({{0, 0}}, 0.5, 0.5));
    return loops_of(path);
}
constexpr double kWindow = 4 - kPi / 4;

template <class P>
Curve<P> rail_through(std::vector<P> net) {
    return Curve<P>::trusted({*BSplineBasis::bezier(int(net.size()) - 1)}, Net<1, P>({int(net.size())}, net));
}
Curve<Vec<3>> winding_rail() {
    return rail_through<Vec<3>>({{{0, 0, 0}}, {{4, 0, 3}}, {{6, 5, -2}}, {{0, 9, 1}}, {{9, 9, 8}}});
}
// A quarter of a circle of radius 5 about the y axis, from (5, 0, 0) to (0, 0, 5).
Curve<Hom<3>> quarter_rail() {
    return rail_through<Hom<3>>({weighted(Vec<3>{{5, 0, 0}}, 1.0),
                                 weighted(Vec<3>{{5, 0, 5}}, std::sqrt(0.5)),
                                 weighted(Vec<3>{{0, 0, 5}}, 1.0)});
}

// Guldin: a region whose centroid moves along the rail, orthogonal to it, sweeps its area times the length.
TEST(SolidAlong, has_the_volume_of_its_region_times_the_length_of_the_rail) {
    const auto check = [](const auto& rail) {
        const SolidAlong s = must(solid_along(frame_of_a_window(), rail, {1e-5, {}}));
        EXPECT_LE(s.bound, 1e-5);
        EXPECT_EQ(s.model.bodies.size(), 1u);
        EXPECT_TRUE(s.model.bodies[0].solid);
        EXPECT_EQ(s.model.faces.size(), 4 + 4 + 2u);
        const double volume = kWindow * length(rail, 1e-9).value;
        EXPECT_NEAR(signed_volume(closed_tessellation(s.model, 1e-3).mesh), volume, 1e-3 * volume);
        return s.pieces;
    };
    EXPECT_GT(check(winding_rail()), 4);
    check(quarter_rail());
}

// Beside the rail it is the way of the centroid that counts.
TEST(SolidAlong, beside_the_rail_has_the_volume_that_pappus_says) {
    const Path square = path_from("M 1 -1 L 2 -1 L 2 1 L 1 1 Z");
    for (const double x : {1.0, -1.0}) {
        const SolidAlong s = must(solid_along(loops_of(square), quarter_rail(), {1e-6, {{x, 0, 0}}}));
        const double volume = 2 * (5 + 1.5 * x) * kPi / 2;
        EXPECT_NEAR(signed_volume(closed_tessellation(s.model, 1e-4).mesh), volume, 1e-3 * volume) << x;
    }
}

TEST(SolidAlong, along_a_line_is_the_prism) {
    const auto rail = rail_through<Vec<3>>({{{0, 0, 0}}, {{0, 0, 3}}});
    const SolidAlong s = must(solid_along(frame_of_a_window(), rail, {1e-9, {{1, 0, 0}}}));
    const Model prism = must(freiform::prism(frame_of_a_window(), {{0, 0, 3}}));
    for (const Vertex& v : prism.vertices)  // which has no more of them than arcs need
        EXPECT_TRUE(std::ranges::any_of(s.model.vertices,
                                        [&](const Vertex& w) { return norm(v.point - w.point) < 1e-15; }));
    EXPECT_NEAR(signed_volume(closed_tessellation(s.model, 1e-4).mesh),
                signed_volume(closed_tessellation(prism, 1e-4).mesh), 1e-2);
}

TEST(SolidAlong, walls_stay_within_the_bound) {
    const auto rail = winding_rail();
    const SolidAlong coarse = must(solid_along(frame_of_a_window(), rail, {1e-2, {}})),
                     fine = must(solid_along(frame_of_a_window(), rail, {1e-9, {}}));
    EXPECT_LT(coarse.pieces, fine.pieces);
    double most = 0;
    Random random(1);
    for (std::size_t f = 0; f < 8; ++f)
        for (int i = 0; i < 200; ++i) {
            const auto on = domain(coarse.model.faces[f].surface);
            const Param<2> uv{random.real(on[0].lo, on[0].hi), random.real(on[1].lo, on[1].hi)};
            most = std::max(most, norm(jet<0>(coarse.model.faces[f].surface, uv).value() -
                                       jet<0>(fine.model.faces[f].surface, uv).value()));
        }
    EXPECT_LE(most, coarse.bound + fine.bound);
    EXPECT_GT(most, 1e-3 * coarse.bound);
    ASSERT_EQ(coarse.model.approximations.size(), 1u);
    EXPECT_EQ(coarse.model.approximations[0].bound, coarse.bound);
}

TEST(SolidAlong, edges_are_where_both_of_their_faces_are) {
    const SolidAlong s = must(solid_along(frame_of_a_window(), winding_rail(), {1e-4, {}}));
    for (const Face& f : s.model.faces)
        for (const Loop& loop : f.loops)
            for (const Coedge& c : loop.coedges) {
                const Edge& e = s.model.edges[std::size_t(c.edge)];
                EXPECT_GT(e.tolerance, 0);
                EXPECT_LT(e.tolerance, 1e-12);
                for (const double share : {0.0, 0.3, 0.7, 1.0}) {
                    const double t = e.range.lo + share * e.range.length();
                    const Vec<3> there = jet<0>(f.surface, jet<0>(c.curve, t).value().c).value();
                    EXPECT_LE(norm(there - jet<0>(*e.curve, t).value()), e.tolerance);
                }
            }
}

TEST(SolidAlong, refuses_rails_and_regions_that_make_no_solid) {
    const auto rail = winding_rail();
    expect_refusal(solid_along({}, rail, {1e-3, {}}), RefusalKind::no_answer, "loops");
    expect_refusal(solid_along(frame_of_a_window(), rail, {0, {}}), RefusalKind::invalid, "tolerance");
    const auto far = rail_through<Vec<3>>({{{0, 0, 1e9}}, {{0, 0, 1e9 + 3}}});
    expect_refusal(solid_along(frame_of_a_window(), far, {1e-9, {}}), RefusalKind::ill_conditioned,
                   "tolerance");
    const auto bow = solid_along(loops_of(path_from("M 0 0 L 2 2 L 2 0 L 0 2 Z")), rail, {1e-3, {}});
    ASSERT_FALSE(bow);
    EXPECT_TRUE(bow.error().where.starts_with("loops[0]")) << bow.error().where;
    const auto ring = rail_through<Vec<3>>({{{0, 0, 0}}, {{9, 0, 0}}, {{0, 9, 0}}, {{0, 0, 0}}});
    expect_refusal(solid_along(frame_of_a_window(), ring, {1e-3, {}}), RefusalKind::unsupported, "rail",
                   "begins");
    const Path wide = path_from("M -6 -1 L 6 -1 L 6 1 L -6 1 Z");
    expect_refusal(solid_along(loops_of(wide), quarter_rail(), {1e-3, {{1, 0, 0}}}), RefusalKind::no_answer,
                   "rail", "fold");
    EXPECT_TRUE(solid_along(loops_of(wide), quarter_rail(), {1e-3, {{0, 1, 0}}}));
}

}  // namespace
}  // namespace freiform::test
