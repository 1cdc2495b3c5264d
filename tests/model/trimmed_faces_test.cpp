// Random trimmed faces: closed along their loops, of the right area, within the bound.
// FREIFORM_TRIMMED_FACES=1000 looks at so many.
#include "support/trimmed_faces.hpp"

#include "support/solids.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <support/sanitizer.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

int wanted(const char* name, int usual) {
    const char* said = std::getenv(name);
    return said ? std::atoi(said) : cases(usual);
}

// Open edges close up: each point has as many going out as coming in; and lie on the loops, which they are as
// long as, in the parameter plane.
void expect_closed_along_loops(const TriangleMesh& mesh, const std::string& where) {
    std::map<int, int> balance;
    std::map<int, int> degree;
    for (const MeshEdge& e : edges(mesh)) {
        if (e.forward + e.backward != 1) continue;
        ++balance[e.forward ? e.a : e.b];
        --balance[e.forward ? e.b : e.a];
        ++degree[e.a], ++degree[e.b];
    }
    for (const auto& [point, sum] : balance) EXPECT_EQ(sum, 0) << where << " point " << point;
    for (const auto& [point, n] : degree) EXPECT_EQ(n % 2, 0) << where << " point " << point;
    EXPECT_FALSE(balance.empty()) << where;
}

TEST(TrimmedFaces, are_closed_along_their_loops_and_keep_the_bound) {
    TrimmedFaces faces(2026);
    std::map<std::string, int> refused;
    int nasty = 0, cones = 0;
    const int n = wanted("FREIFORM_TRIMMED_FACES", 24);
    for (int i = 0; i < n; ++i) {
        const TrimmedFace f = faces.next();
        const std::string where = std::to_string(i) + " (" + name_of(f.nasty) + ")";
        nasty += f.nasty != Nasty::none, cones += f.cone;
        const double tolerance = 0.02;
        const auto t = tessellate(f.model, {.tolerance = tolerance});
        ASSERT_TRUE(t) << where << ": " << t.error().message;
        if (!t->refused.empty()) {
            ++refused[name_of(f.nasty) + (": " + t->refused[0].reason.message.substr(0, 60))];
            EXPECT_FALSE(t->refused[0].reason.message.empty() || t->refused[0].reason.where.empty()) << where;
            EXPECT_NE(f.nasty, Nasty::none) << where << ": " << t->refused[0].reason.message;
            continue;
        }
        expect_closed_along_loops(t->mesh, where);
        EXPECT_EQ(t->topology.non_manifold_edges + t->topology.misoriented_edges, 0) << where;
        EXPECT_LE(t->error_bound, tolerance) << where;
        EXPECT_LE(sampled_deviation(f.model, *t, 3), t->error_bound + t->boundary_gap) << where;
        double area = 0;
        for (const auto& tri : t->mesh.triangles) {
            const auto uv = [&](std::size_t k) { return t->mesh.vertices[std::size_t(tri[k])].uv; };
            const double part = cross(uv(1) - uv(0), uv(2) - uv(0)) / 2;
            EXPECT_GE(part, 0) << where;
            area += part;
        }
        if (f.polygons) {
            EXPECT_NEAR(area, f.area, 1e-10 * f.size * f.size) << where;
        }
    }
    EXPECT_GE(nasty, n / 5);
    EXPECT_GE(cones, n / 8);
    for (const auto& [what, count] : refused) std::printf("refused %d of %d: %s\n", count, n, what.c_str());
}

}  // namespace
