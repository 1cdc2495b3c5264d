// Tight boxes of solids against those that are known, and against many points of their faces.
#include <freiform/model/bounds.hpp>

#include <gtest/gtest.h>
#include <support/refusal.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

TEST(ModelBounds, of_solids_are_what_geometry_says) {
    struct Known {
        Model model;
        Vec<3> lo, hi;
    };
    for (const Known& k : {Known{sphere({{1, 2, 3}}, 2), {{-1, 0, 1}}, {{3, 4, 5}}},
                           {torus(3, 1), {{-4, -4, -1}}, {{4, 4, 1}}},
                           {frustum(1, 0.5, 2), {{-1, -1, 0}}, {{1, 1, 2}}}}) {
        const auto b = must(tight_box(k.model, 1e-5));
        EXPECT_LE(b.slack, 1e-5);
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(b.box.lo[i], k.lo[i] + 1e-14) << i;
            EXPECT_GE(b.box.lo[i], k.lo[i] - b.slack - 1e-14) << i;
            EXPECT_GE(b.box.hi[i], k.hi[i] - 1e-14) << i;
            EXPECT_LE(b.box.hi[i], k.hi[i] + b.slack + 1e-14) << i;
        }
    }
}

// A sphere with its cap cut away: the surface goes on, the face does not.
TEST(ModelBounds, end_where_faces_are_trimmed) {
    Model m = sphere({}, 1);
    const double top = 0.4;  // the latitude of the rim
    for (Coedge& c : m.faces[0].loops[0].coedges) {
        const auto cut = [&](Vec<2> p) { return Vec<2>{{p[0], std::min(p[1], top)}}; };
        const Interval on = m.edges[std::size_t(c.edge)].range;
        c.curve = segment(on, cut(jet<0>(c.curve, on.lo).value()), cut(jet<0>(c.curve, on.hi).value()));
    }
    const auto b = must(tight_box(m, 1e-6));
    EXPECT_NEAR(b.box.hi[2], std::sin(top), 1e-6);
    EXPECT_GE(b.box.hi[2], std::sin(top) - 1e-14);
    EXPECT_NEAR(b.box.lo[2], -1, 1e-6);
    EXPECT_NEAR(b.box.hi[0], 1, 1e-6);
}

TEST(ModelBounds, a_spent_budget_is_said_and_nonsense_is_refused) {
    const Model m = torus(3, 1);
    const auto b = must(tight_box(m, 0, 3));
    EXPECT_GT(b.slack, 1e-6);
    EXPECT_GE(b.box.hi[0], 4);
    EXPECT_LE(b.box.hi[0] - b.slack, 4);
    expect_refusal(tight_box(m, -1), RefusalKind::invalid, "accuracy");
    expect_refusal(tight_box(Model{}, 1), RefusalKind::invalid, "model");
}

}  // namespace
}  // namespace freiform::test
