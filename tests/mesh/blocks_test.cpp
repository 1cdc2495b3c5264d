// Cells of blocks and the triangles around them are one mesh that keeps the bound.
#include "mesh/blocks_detail.hpp"
#include "mesh/filler_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/mesh/face_mesh.hpp>

#include <ctime>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace freiform {
namespace {

using test::must;
using test::Random;

// Smooth in [0, n - degree]^2, or with kinks on some lines.
template <class P>
SurfaceGeometry hill(Random& random, int degree, bool kinks) {
    constexpr int kSize = 9;
    std::vector<double> knots(std::size_t(degree) + 1, 0.0);
    for (int i = 1; i < kSize - degree; ++i) knots.push_back(kinks && i == 3 ? 2.0 : double(i));
    knots.insert(knots.end(), std::size_t(degree) + 1, double(kSize - degree));
    const auto basis = must(BSplineBasis::make(degree, knots));
    const double bend = random.real(0.2, 0.8), lean = random.real(-0.3, 0.3), rough = random.real(0, 0.002);
    std::vector<P> c;
    for (int i = 0; i < kSize; ++i)
        for (int k = 0; k < kSize; ++k) {
            const double x = i / 3.0, y = k / 3.0;
            const Vec<3> p{{x, y + lean * x, bend * std::sin(x) * std::cos(y) + rough * random.real(-1, 1)}};
            if constexpr (Space<P>::kRational)
                c.push_back(weighted(p, std::exp2(random.real(-0.1, 0.1))));
            else
                c.push_back(p);
        }
    return must(Surface<P>::make({basis, basis}, Net<2, P>({kSize, kSize}, std::move(c))));
}

// A square, with corners on all knots, and two round holes if they are asked for.
FaceBoundary square_of(int knots, bool holes = true) {
    const double side = knots;
    FaceBoundary out;
    const auto add = [&](const std::vector<Vec<2>>& ring) {
        const int first = int(out.uv.size()), n = int(ring.size());
        for (int i = 0; i < n; ++i) {
            out.uv.push_back(ring[std::size_t(i)]);
            out.point.push_back(first + i);
            out.segments.push_back({first + i, first + (i + 1) % n});
        }
    };
    std::vector<Vec<2>> square;
    for (int s = 0; s < 4; ++s)
        for (int k = 0; k < 32 * knots; ++k) {
            const double t = k / 32.0;
            square.push_back(s == 0   ? Vec<2>{{t, 0}}
                             : s == 1 ? Vec<2>{{side, t}}
                             : s == 2 ? Vec<2>{{side - t, side}}
                                      : Vec<2>{{0, side - t}});
        }
    add(square);
    if (!holes) return out;
    for (const Vec<2>& centre : {Vec<2>{{0.3 * side, 0.4 * side}}, Vec<2>{{0.75 * side, 0.7 * side}}}) {
        std::vector<Vec<2>> ring;
        for (int k = 0; k < 128; ++k) {
            const double a = -2 * std::numbers::pi * k / 128;
            ring.push_back(centre + 0.07 * side * Vec<2>{{std::cos(a), std::sin(a)}});
        }
        add(ring);
    }
    return out;
}

double twice_area(const std::vector<Vec<2>>& uv, const std::array<int, 3>& t) {
    const Vec<2>&a = uv[std::size_t(t[0])], &b = uv[std::size_t(t[1])], &c = uv[std::size_t(t[2])];
    return cross(b - a, c - a);
}

// Every side is that of two triangles that run through it in both directions, or of the boundary.
void expect_covers_once(const FaceMesh& mesh, const FaceBoundary& boundary) {
    double expected = 0, area = 0;
    for (const auto& [a, b] : boundary.segments)
        expected += cross(boundary.uv[std::size_t(a)], boundary.uv[std::size_t(b)]);
    std::map<std::array<int, 2>, int> sides;
    for (const auto& t : mesh.triangles) {
        EXPECT_GT(twice_area(mesh.uv, t), 0);
        area += twice_area(mesh.uv, t);
        for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    }
    EXPECT_NEAR(area, expected, 1e-12 * expected);
    std::size_t once = 0;
    for (const auto& [side, count] : sides) {
        EXPECT_EQ(count, 1);
        once += !sides.contains({side[1], side[0]});
    }
    EXPECT_EQ(once, boundary.segments.size());
    for (const auto& s : boundary.segments) EXPECT_TRUE(sides.contains(s));
}

// The largest distance between samples inside triangles and the nearest point of the surface around.
double sampled_distance(const SurfaceGeometry& s, const FaceMesh& mesh) {
    double most = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 7) {
        const auto& t = mesh.triangles[i];
        const auto uv = [&](std::size_t k) { return mesh.uv[std::size_t(t[k])]; };
        for (const auto& l :
             {std::array{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}}) {
            Vec<2> x{};
            Vec<3> p{};
            for (std::size_t k = 0; k < 3; ++k) x += l[k] * uv(k), p += l[k] * jet<0>(s, uv(k).c).value();
            for (int step = 0; step < 4; ++step) {  // to the foot, by Gauss and Newton
                const auto j = jet<1>(s, x.c);
                const Vec<3> d = p - j.value();
                const double uu = dot(j.d[1], j.d[1]), u_v = dot(j.d[1], j.d[2]), vv = dot(j.d[2], j.d[2]),
                             du = dot(d, j.d[1]), dv = dot(d, j.d[2]), det = uu * vv - u_v * u_v;
                x += Vec<2>{{(vv * du - u_v * dv) / det, (uu * dv - u_v * du) / det}};
            }
            most = std::max(most, norm(p - jet<0>(s, x.c).value()));
        }
    }
    return most;
}

SurfaceGeometry steep_hills(Random& random) {
    const auto basis = must(BSplineBasis::clamped_uniform(3, 9));
    std::vector<Hom<3>> c;
    for (int i = 0; i < 81; ++i)
        c.push_back(weighted(Vec<3>{{(i / 9) / 3.0, (i % 9) / 3.0, random.real(-0.6, 0.6)}},
                             std::exp2(random.real(-0.3, 0.3))));
    return must(Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({9, 9}, std::move(c))));
}

// Refusals, too: sides of the boundary may be too long for the tolerance. Whether there are triangles.
bool expect_same_for_any_threads(const SurfaceGeometry& s, double tolerance) {
    const DerivativeQuery<2, 3> surface(s);
    const FaceBoundary boundary = square_of(6);
    const FaceDemands demands{.tolerance = tolerance, .is_shared = true};
    set_max_threads(1);
    const auto one = mesh_face(surface, boundary, demands, 1'000'000);
    set_max_threads(2);
    const auto two = mesh_face(surface, boundary, demands, 1'000'000);
    set_max_threads(0);
    EXPECT_EQ(one.has_value(), two.has_value());
    if (!one && !two) EXPECT_EQ(one.error().message, two.error().message);
    if (!one || !two) return false;
    EXPECT_EQ(one->uv, two->uv);
    EXPECT_EQ(one->triangles, two->triangles);
    EXPECT_EQ(one->bound, two->bound);
    expect_covers_once(*one, boundary);
    return true;
}

TEST(Blocks, and_what_is_around_them_cover_a_face_once_within_the_bound) {
    Random random(11);
    int with_blocks = 0;
    for (int round = 0; round < 24; ++round) {
        const int degree = 2 + round % 3;
        const bool kinks = round % 4 == 3 && degree == 2;
        const SurfaceGeometry s =
            round % 2 ? hill<Vec<3>>(random, degree, kinks) : hill<Hom<3>>(random, degree, kinks);
        const DerivativeQuery<2, 3> surface(s);
        const FaceBoundary boundary = square_of(9 - degree, !kinks);
        const FaceDemands demands{.tolerance = std::exp2(random.real(-13.5, -11))};
        const auto mesh = must(mesh_face(surface, boundary, demands, 1'000'000));
        EXPECT_LE(mesh.bound, demands.tolerance);
        expect_covers_once(mesh, boundary);
        const double found = sampled_distance(s, mesh);
        EXPECT_LE(found, mesh.bound) << round;
        EXPECT_GE(found, 0.25 * mesh.bound) << round;
        const auto tree = must(
            CurvatureTree::make(surface, boundary.uv, boundary.segments, demands, 1'000'000, {true, true}));
        with_blocks += tree.block_count() > 0;
    }
    EXPECT_GT(with_blocks, 16);
}

// Where a tolerance is coarse for a steep surface, feet cannot be proven: leaves do without.
TEST(Blocks, of_steep_hills_do_without_feet) {
    Random random(14);
    int leaves = 0, plain = 0, counted_on = 0;
    for (int round = 0; round < 12; ++round) {
        const SurfaceGeometry s = steep_hills(random);
        const DerivativeQuery<2, 3> surface(s);
        const FaceBoundary boundary = square_of(6, round % 2 == 0);
        const FaceDemands demands{.tolerance = std::exp2(random.real(-7.5, -5))};
        const auto mesh = must(mesh_face(surface, boundary, demands, 1'000'000));
        EXPECT_LE(mesh.bound, demands.tolerance);
        expect_covers_once(mesh, boundary);
        EXPECT_LE(sampled_distance(s, mesh), mesh.bound) << round;
        for (const double tolerance :
             {demands.tolerance, demands.tolerance / 32}) {  // fine: feet are counted on
            const auto tree = must(CurvatureTree::make(surface, boundary.uv, boundary.segments,
                                                       {.tolerance = tolerance}, 1'000'000, {true, true}));
            for (std::size_t i = 0; i < tree.block_count(); ++i) leaves += tree.block(i).first_part < 0;
            const Judge judge(tree, surface, {boundary.uv.front(), {{6, 6}}}, tolerance);
            BlockOutline told;
            const auto blocks = mesh_blocks(tree, judge, tolerance, true, {},
                                            {[] {}, [&](const BlockOutline& o) { told = o; }});
            const BlockOutline& outline = blocks.outline;
            EXPECT_EQ(told.sides, outline.sides);
            ASSERT_EQ(outline.plain.size(), outline.points.size());
            for (std::size_t i = 0; i < outline.plain.size(); ++i) {
                plain += outline.plain[i];
                counted_on += outline.needs_foot[i];
                EXPECT_FALSE(outline.plain[i] && outline.needs_foot[i]);
            }
            // Around a place to avoid there are none, and what they had are corners.
            const std::size_t some = std::size_t(blocks.triangles[blocks.triangles.size() / 2][0]),
                              on_outline = outline.points.size();
            const Vec<2> place = some < on_outline ? outline.points[some] : blocks.points[some - on_outline];
            const auto less = mesh_blocks(tree, judge, tolerance, false, std::vector<Vec<2>>{place},
                                          {[] {}, [](const BlockOutline&) {}});
            EXPECT_LT(less.triangles.size(), blocks.triangles.size());
            EXPECT_GT(less.outline.corners.size(), outline.corners.size());
            for (const auto& p : less.outline.points) EXPECT_NE(p, place);
            for (const auto& p : less.points) EXPECT_NE(p, place);
        }
    }
    EXPECT_GT(leaves, 2000);
    EXPECT_GT(plain, 200);
    EXPECT_GT(counted_on, 20);
}

double wave(double x) { return 0.4 * std::sin(0.02 * x * x); }

// z = wave(x + sign y): parameter lines do not run along the waves, but one diagonal of cells does.
SurfaceGeometry slanted_waves(double sign) {
    constexpr int kSize = 12;
    const auto basis = must(BSplineBasis::clamped_uniform(3, kSize));
    const auto at = [&](int i) {
        const std::size_t k = std::size_t(i);
        return (basis.knots()[k + 1] + basis.knots()[k + 2] + basis.knots()[k + 3]) / 3;
    };
    std::vector<Vec<3>> c;
    for (int i = 0; i < kSize; ++i)
        for (int k = 0; k < kSize; ++k) c.push_back({{at(i), at(k), wave(at(i) + sign * at(k))}});
    return must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({kSize, kSize}, std::move(c))));
}

// Triangles that cannot be done without: halves of squares whose sides have this error.
double triangles_of_waves(double sign, double tolerance) {
    constexpr double kStep = 1.0 / 32;
    double sum = 0;
    for (double x = kStep / 2; x < 9; x += kStep)
        for (double y = kStep / 2; y < 9; y += kStep) {
            const double z = x + sign * y;
            const double bend = (wave(z + kStep) - 2 * wave(z) + wave(z - kStep)) / (kStep * kStep);
            sum += kStep * kStep * std::abs(bend) / (4 * tolerance);
        }
    return sum;
}

TEST(Blocks, are_halved_along_waves_and_meet_in_the_middle_beside_finer_ones) {
    int centres = 0;
    for (const double sign : {1.0, -1.0}) {
        const SurfaceGeometry s = slanted_waves(sign);
        const DerivativeQuery<2, 3> surface(s);
        const FaceBoundary boundary = square_of(9, false);
        const FaceDemands demands{.tolerance = std::ldexp(sign > 0 ? 1.0 : 0.6, -13)};
        const auto mesh = must(mesh_face(surface, boundary, demands, 1'000'000));
        EXPECT_LE(mesh.bound, demands.tolerance);
        expect_covers_once(mesh, boundary);
        const double found = sampled_distance(s, mesh);
        EXPECT_LE(found, mesh.bound);
        EXPECT_GE(found, 0.7 * mesh.bound);
        const double least = triangles_of_waves(sign, demands.tolerance);
        EXPECT_LE(double(mesh.triangles.size()), 2.2 * least + 3 * double(boundary.segments.size()));

        const auto tree = must(
            CurvatureTree::make(surface, boundary.uv, boundary.segments, demands, 1'000'000, {true, true}));
        const Judge judge(tree, surface, {{{0, 0}}, {{9, 9}}}, demands.tolerance);
        const BlockMesh blocks =
            mesh_blocks(tree, judge, demands.tolerance, false, {}, {[] {}, [](const BlockOutline&) {}});
        std::vector<Vec<2>> points = blocks.outline.points;
        points.insert(points.end(), blocks.points.begin(), blocks.points.end());
        int falling = 0, rising = 0;
        for (const auto& t : blocks.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec<2> d = points[std::size_t(t[(k + 1) % 3])] - points[std::size_t(t[k])];
                falling += d[0] * d[1]<0, rising += d[0] * d[1]> 0;
            }
        EXPECT_GT(sign > 0 ? falling : rising, 3 * (sign > 0 ? rising : falling));
        for (std::size_t i = 0; i < tree.block_count(); ++i)
            if (const auto b = tree.block(i); b.first_part < 0) {
                const Vec<2> middle{{b.box.side(0).middle(), b.box.side(1).middle()}};
                centres += std::find(points.begin(), points.end(), middle) != points.end();
            }
    }
    EXPECT_GT(centres, 20);
}

TEST(Blocks, take_no_more_triangles_than_leaves_would_by_much) {
    Random random(12);
    for (int round = 0; round < 6; ++round) {
        const SurfaceGeometry s = hill<Hom<3>>(random, 3, false);
        const DerivativeQuery<2, 3> surface(s);
        const FaceBoundary boundary = square_of(6);
        const FaceDemands demands{.tolerance = 2e-4};
        const auto by_blocks = must(mesh_face(surface, boundary, demands, 1'000'000));
        // Shapes are asked for, though any will do: then there are none.
        FaceDemands shaped = demands;
        shaped.max_aspect = 1e9;
        const auto by_leaves = must(mesh_face(surface, boundary, shaped, 1'000'000));
        EXPECT_NE(by_blocks.triangles.size(), by_leaves.triangles.size());
        EXPECT_LE(double(by_blocks.triangles.size()), 1.25 * double(by_leaves.triangles.size()));
    }
}

// Of the corners of leaves that are no blocks those that are farther from the boundary than a leaf and a
// half.
double part_of_far_corners(const SurfaceGeometry& geometry, const Box<2>& face, double tolerance) {
    const DerivativeQuery<2, 3> surface(geometry);
    const std::vector<Vec<2>> polygon{
        face.lo, {{face.hi[0], face.lo[1]}}, face.hi, {{face.lo[0], face.hi[1]}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const auto tree = must(
        CurvatureTree::make(surface, polygon, segments, {.tolerance = tolerance}, 1'000'000, {true, true}));
    double far = 0;
    for (const auto& c : tree.corners()) {
        double nearest = kInfinity;
        for (int d = 0; d < 2; ++d)
            nearest = std::min(nearest, std::min(c.at[d] - face.lo[d], face.hi[d] - c.at[d]) / c.leaf[d]);
        far += nearest > 1.5;
    }
    return far / double(tree.corners().size());
}

// Leaves beside those at the boundary are blocks where they are few of all, and left to what is around blocks
// where they are many.
TEST(Blocks, begin_beside_the_leaves_at_the_boundary) {
    Random random(37);
    const SurfaceGeometry s = hill<Vec<3>>(random, 3, false);
    EXPECT_LT(part_of_far_corners(s, {{{0.5, 0.5}}, {{5.5, 5.5}}}, 1e-6), 0.05);
    EXPECT_GT(part_of_far_corners(s, {{{0.5, 0.5}}, {{5.5, 5.5}}}, 1e-3), 0.2);
    EXPECT_GT(part_of_far_corners(s, {{{0.5, 2.5}}, {{5.5, 2.6}}}, 1e-7), 0.2);
}

TEST(Blocks, are_the_same_for_any_number_of_threads) {
    Random random(13);
    const SurfaceGeometry s = hill<Hom<3>>(random, 3, false);
    EXPECT_TRUE(expect_same_for_any_threads(s, 1e-4));
    EXPECT_TRUE(expect_same_for_any_threads(s, 1e-2));
    // Around these many triangles turn out to do without feet, after others have been judged by all threads.
    int meshed = 0;
    for (int round = 0; round < 6; ++round) {
        const SurfaceGeometry steep = steep_hills(random);
        meshed += expect_same_for_any_threads(steep, std::exp2(random.real(-10, -5)));
    }
    EXPECT_GE(meshed, 4);
}

// Triangles of blocks may count on feet that those beside them would do without, as at poles: that is told
// before more points are tried.
TEST(Blocks, that_count_on_feet_stop_triangles_beside_them_from_doing_without) {
    const Conic<3> meridian{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 0, 1}}};
    const SurfaceGeometry s = Revolution{meridian, {}, {{0, 0, 1}}, SurfaceKind::sphere};
    const DerivativeQuery<2, 3> surface(s);
    constexpr double kTop = std::numbers::pi / 2;  // the pole
    std::vector<Vec<2>> polygon;
    for (int k = 0; k < 24; ++k) polygon.push_back({{k / 24.0, 0.5}});
    for (int k = 0; k < 24; ++k) polygon.push_back({{1, 0.5 + (kTop - 0.5) * k / 24}});
    for (int k = 24; k > 0; --k) polygon.push_back({{k / 24.0, kTop}});
    for (int k = 24; k > 0; --k) polygon.push_back({{0, 0.5 + (kTop - 0.5) * k / 24}});
    std::vector<std::array<int, 2>> segments;
    std::vector<Triangulation::Segment> sides;
    Box<2> box;
    for (int k = 0; k < 96; ++k) {
        segments.push_back({k, (k + 1) % 96});
        sides.push_back({k, (k + 1) % 96});
        box.add(polygon[std::size_t(k)]);
    }
    const FaceDemands demands{.tolerance = 1e-3};
    const auto tree = must(CurvatureTree::make(surface, polygon, segments, demands, 100'000));
    const Judge judge(tree, surface, box, demands.tolerance);
    for (const bool count_on_feet : {false, true}) {
        auto t = must(Triangulation::make(polygon, sides));
        Filler filler(t, tree, judge, surface, {{1, 1}}, demands);
        filler.keep_feet(0, std::vector<char>(polygon.size(), count_on_feet), {});
        filler.insert_corners(tree.corners());
        EXPECT_EQ(filler.refine(100'000), !count_on_feet);
        EXPECT_EQ(filler.is_stuck(), count_on_feet);
    }
}

// Sides of the boundary are given. Beside one that is too long others were halved as long as doubles allow,
// near 0 a thousand times, with predicates in hundreds of digits.
TEST(Blocks, sides_that_are_too_long_are_told_soon) {
    const SurfaceGeometry arch = must(Surface<Vec<3>>::make(
        {BSplineBasis::bezier(1).value(), BSplineBasis::bezier(2).value()},
        Net<2, Vec<3>>({2, 3},
                       {{{0, 0, 0}}, {{0, 1, 2}}, {{0, 2, 0}}, {{3, 0, 0}}, {{3, 1, 2}}, {{3, 2, 0}}})));
    const DerivativeQuery<2, 3> surface(arch);
    FaceBoundary boundary;
    boundary.uv = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    boundary.point = {0, 1, 2, 3};
    boundary.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const std::clock_t start = std::clock();
    const auto mesh = mesh_face(surface, boundary, {.tolerance = 0.01}, 1'000'000);
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 2);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().kind, RefusalKind::not_converged);
    EXPECT_NE(mesh.error().message.find("keeps the bound"), std::string::npos) << mesh.error().message;
}

}  // namespace
}  // namespace freiform
