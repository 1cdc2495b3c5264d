// What every answer of sewing keeps.
#pragma once
#include <freiform/model/sew.hpp>

#include <gtest/gtest.h>

namespace freiform::test {

// What every answer keeps, whatever was sewn.
inline void expect_sound(const Sewing& s, const Model& before) {
    ASSERT_TRUE(make_model(s.model)) << make_model(s.model).error().message;
    EXPECT_EQ(s.model.faces.size(), before.faces.size());
    EXPECT_EQ(std::size_t(summary(s.model).open_edges), s.remaining.size());
    std::vector<int> uses(s.model.edges.size());
    for (const Face& f : s.model.faces)
        for (const Loop& l : f.loops)
            for (std::size_t c = 0; c < l.coedges.size(); ++c) {
                const Coedge& here = l.coedges[c];
                const Coedge& next = l.coedges[(c + 1) % l.coedges.size()];
                const Edge &e = s.model.edges[std::size_t(here.edge)],
                           &n = s.model.edges[std::size_t(next.edge)];
                EXPECT_EQ(here.reversed ? e.start : e.end, next.reversed ? n.end : n.start) << "chains";
                ++uses[std::size_t(here.edge)];
                // Samples keep the bound of the join.
                for (const SewnEdge& j : s.joined) {
                    if (j.edge != here.edge) continue;
                    for (int k = 0; k <= 50; ++k) {
                        const double t = k == 50 ? e.range.hi : e.range.lo + e.range.length() * k / 50;
                        const Vec<2> uv = jet<0>(here.curve, t).value();
                        EXPECT_LE(norm(jet<0>(f.surface, uv.c).value() - jet<0>(*e.curve, t).value()),
                                  std::max(j.face_bound, e.tolerance) * (1 + 1e-12));
                    }
                }
            }
    for (const SewnEdge& j : s.joined) {
        EXPECT_LE(j.bound, s.tolerance);
        EXPECT_EQ(std::size_t(uses[std::size_t(j.edge)]), j.faces.size());
    }
}

}  // namespace freiform::test
