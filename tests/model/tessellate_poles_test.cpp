// Poles: one point of space is a whole side in the parameter plane, so triangles that are sound there may
// have no area, or be those of the neighbour, in space.
#include "support/solids.hpp"

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// The least of area over squared longest side.
double thinnest(const TriangleMesh& mesh) {
    double least = kInfinity;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.points_of(i);
        const Vec<3>&p = mesh.points[std::size_t(a)], &q = mesh.points[std::size_t(b)],
              &r = mesh.points[std::size_t(c)];
        const double longest = std::max({norm(q - p), norm(r - q), norm(p - r)});
        least = std::min(least, norm(cross(q - p, r - p)) / 2 / (longest * longest));
    }
    return least;
}

// A ball, or the wall of a cone, of faces between meridians at these longitudes, ascending within a turn.
// Meridians are of several edges near the lower pole if they are `cut`.
Model of_sectors(bool ball, std::span<const double> longitudes, bool cut) {
    Model m;
    const auto meridian = [&](double at) -> CurveGeometry<3> {
        const Vec<3> out{{std::cos(at), std::sin(at), 0}}, up{{0, 0, 1}};
        if (ball) return Conic<3>{ConicKind::ellipse, {}, out, up};
        return Line<3>{{}, out + up};
    };
    const auto position = [](const CurveGeometry<3>& c, double t) { return jet<0>(c, t).value(); };
    const Interval v = ball ? Interval{-kPi / 2, kPi / 2} : Interval{0, 1};
    std::vector<double> ends{v.lo};
    if (cut)
        for (const double part : {0.005, 0.01, 0.015, 0.02, 0.03}) ends.push_back(v.lo + part * v.length());
    ends.push_back(v.hi);
    const std::size_t n = longitudes.size(), pieces = ends.size() - 1;
    m.vertices.push_back({position(meridian(0), v.lo), 0});
    if (ball) m.vertices.push_back({position(meridian(0), v.hi), 0});
    std::vector<int> outer;  // the last vertex of each meridian
    for (std::size_t i = 0; i < n; ++i) {
        const auto curve = meridian(longitudes[i]);
        int from = 0;
        for (std::size_t k = 0; k < pieces; ++k) {
            const bool to_pole = ball && k + 1 == pieces;
            const int to = to_pole ? 1 : int(m.vertices.size());
            if (!to_pole) m.vertices.push_back({position(curve, ends[k + 1]), 0});
            m.edges.push_back({curve, false, {ends[k], ends[k + 1]}, from, to, 0, ""});
            from = to;
        }
        outer.push_back(from);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t last = (i + 1) % n;
        const Interval u{longitudes[i], last > 0 ? longitudes[last] : longitudes[0] + 2 * kPi};
        const int pole = int(m.edges.size());
        m.edges.push_back({{}, true, u, 0, 0, 0, ""});
        const Conic<3> rim{ConicKind::ellipse, {{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
        if (ball) m.edges.push_back({{}, true, u, 1, 1, 0, ""});
        if (!ball) m.edges.push_back({rim, false, u, outer[i], outer[last], 0, ""});
        std::vector<Coedge> loop{{pole, false, segment(u, {{u.lo, v.lo}}, {{u.hi, v.lo}})}};
        const auto along = [&](std::size_t which, std::size_t k, double at, bool back) {
            const int edge = int(which * pieces + k);
            const Interval on{ends[k], ends[k + 1]};
            loop.push_back({edge, back, segment(on, {{at, on.lo}}, {{at, on.hi}})});
        };
        for (std::size_t k = 0; k < pieces; ++k) along(last, k, u.hi, false);
        loop.push_back({pole + 1, true, segment(u, {{u.lo, v.hi}}, {{u.hi, v.hi}})});
        for (std::size_t k = pieces; k-- > 0;) along(i, k, u.lo, true);
        Face f;
        f.surface = Revolution{meridian(0), {}, {{0, 0, 1}}, ball ? SurfaceKind::sphere : SurfaceKind::cone};
        f.loops = {{loop}};
        m.faces.push_back(f);
    }
    Shell shell;
    for (std::size_t i = 0; i < n; ++i) shell.faces.push_back({int(i), false});
    shell.closed = ball;
    m.shells = {shell};
    m.bodies = {{{0}, ball, "", {}}};
    return *make_model(std::move(m));
}

TEST(Poles, of_cones_have_no_triangle_without_area) {
    for (const double r : {1.0, 2.0})
        for (const double tolerance : {0.1, 0.03, 0.01})
            for (const bool quads : {false, true}) {
                const auto t = *tessellate(frustum(r, 0, 1), {.tolerance = tolerance, .quads = quads});
                EXPECT_EQ(t.topology.degenerate_triangles, 0) << r << " " << tolerance << " " << quads;
                EXPECT_GT(thinnest(t.mesh), 1e-6) << r << " " << tolerance << " " << quads;
                EXPECT_EQ(t.topology.open_edges + t.topology.non_manifold_edges, 0);
                EXPECT_LE(t.error_bound, tolerance);
            }
}

TEST(Poles, neighbours_there_share_the_edge_between_them_alone) {
    for (const bool ball : {true, false})
        for (const std::vector<double>& longitudes :
             {std::vector{0.0, 1.0}, std::vector{0.5, 1.2, 4.0}, std::vector{0.0, 0.1, 0.3, 3.0}})
            for (const double tolerance : {0.1, 0.03})
                for (const int how : {0, 1, 2, 3}) {
                    const bool quads = how % 2, cut = how / 2;
                    const auto t = *tessellate(of_sectors(ball, longitudes, cut),
                                               {.tolerance = tolerance, .quads = quads});
                    const std::string what =
                        text(ball, " ", longitudes.size(), " ", tolerance, " ", quads, " ", cut);
                    EXPECT_TRUE(t.refused.empty()) << what;
                    EXPECT_EQ(t.topology.non_manifold_edges, 0) << what;
                    EXPECT_EQ(t.topology.degenerate_triangles, 0) << what;
                    EXPECT_GT(thinnest(t.mesh), 1e-6) << what;
                    if (ball) {
                        EXPECT_EQ(t.topology.open_edges, 0) << what;
                    }
                    EXPECT_LE(t.error_bound, tolerance) << what;
                }
}

}  // namespace
