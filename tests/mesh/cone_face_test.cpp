// Triangles of cones: what is said of their distance holds, is not far above it, and cones are known.
#include "mesh/cone_face_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/chord_triangles.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

// About the z-axis, with the apex at the height 3, where v = 6 of a line that is twice as fast.
Revolution cone() {
    return {Line<3>{{{2, 0, 0}}, {{-1.0 / 3, 0, 0.5}}}, {{0, 0, 0}}, {{0, 0, 1}}, SurfaceKind::cone};
}

template <class P>
Surface<P> rows(Random& rng, const Vec<3>& apex, double part, int ruled, double off = 0, double uneven = 0) {
    const auto along = *BSplineBasis::clamped_uniform(3, 6), lines = *BSplineBasis::bezier(1);
    std::vector<Vec<3>> far;
    std::vector<double> weight;
    for (int i = 0; i < 6; ++i) {
        far.push_back({{std::cos(0.5 * i), std::sin(0.5 * i), 0.2 * rng.real(-1, 1)}});
        weight.push_back(rng.real(0.7, 1.4));
    }
    Index<2> extent{6, 6};
    extent[std::size_t(ruled)] = 2;
    Net<2, P> net(extent);
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 2; ++k) {
            const Vec<3> x = far[std::size_t(i)],
                         moved =
                             part == 1 ? x + apex : apex + part * (x - apex) + Vec<3>{{off * i * i, 0, 0}};
            P& to = net.view()(ruled == 1 ? Index<2>{i, k} : Index<2>{k, i});
            if constexpr (std::same_as<P, Hom<3>>)
                to = weighted(k == 1 ? x : moved,
                              weight[std::size_t(i)] * (k == 1 ? 1 : 1 + uneven * (i % 3 - 1)));
            else
                to = k == 1 ? x : moved;
        }
    return must(ruled == 1 ? Surface<P>::make({along, lines}, net) : Surface<P>::make({lines, along}, net));
}

// The same surface with more rows of control points between the first and the last.
template <class P>
Surface<P> in_more_rows(const Surface<P>& s, int ruled, int degree) {
    auto out = must(elevate(s, ruled, degree - 1));
    return must(insert_knots(out, ruled, std::vector{0.2, 0.7, 0.7}));
}
template <class P>
Surface<P> moved(const Surface<P>& s, const Index<2>& at, double by) {
    Net<2, P> net = s.net();
    P& c = net.view()(at);
    c = Space<P>::lift(project(c) + Vec<3>{{0, 0, by}}, Space<P>::weight(c));
    return must(Surface<P>::make({s.basis(0), s.basis(1)}, net));
}

TEST(ConeFace, apexes_are_found_and_what_is_no_cone_is_told_from_one) {
    const auto found = apex_of(cone());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->ruled, 1);
    EXPECT_NEAR(found->at, 6, 1e-14);
    EXPECT_LE(found->slip, 1e-13);
    Revolution skew = cone();
    std::get<Line<3>>(skew.profile).origin[1] = 1e-6;
    EXPECT_NEAR(apex_of(skew)->slip, 1e-6, 1e-12) << "a hyperboloid";
    EXPECT_TRUE(apex_of(skew)->is_true_to(1e-3));
    EXPECT_FALSE(apex_of(skew)->is_true_to(1e-4));
    std::get<Line<3>>(skew.profile).origin[1] = 1e-3;
    EXPECT_NEAR(apex_of(skew)->slip, 1e-3, 1e-12);
    Revolution from_apex = cone();
    std::get<Line<3>>(from_apex.profile).origin = from_apex.origin = {{1, 2, 3}};
    ASSERT_TRUE(apex_of(from_apex));
    EXPECT_EQ(apex_of(from_apex)->at, 0);
    EXPECT_TRUE(apex_of(from_apex)->is_true_to(1e-9));
    Revolution wall = cone();
    std::get<Line<3>>(wall.profile).direction = {{0, 0, 1}};
    EXPECT_FALSE(apex_of(wall)) << "a cylinder";
    Random rng(5);
    for (int ruled : {0, 1})
        for (double part : {0.0, 0.3, 0.999, 1.0, -0.5}) {
            const Vec<3> apex{{0.3, -0.2, 2}};
            for (const SurfaceGeometry& s : {SurfaceGeometry(rows<Vec<3>>(rng, apex, part, ruled)),
                                             SurfaceGeometry(rows<Hom<3>>(rng, apex, part, ruled))}) {
                const auto a = apex_of(s);
                ASSERT_TRUE(a) << part;
                EXPECT_EQ(a->ruled, ruled);
                EXPECT_LE(a->slip, 1e-11);
                if (part == 1) {
                    EXPECT_EQ(a->at, kInfinity);
                } else {
                    EXPECT_NEAR(a->at, part / (part - 1), 1e-9 / (1 - part)) << part;
                }
            }
            EXPECT_FALSE(apex_of(rows<Vec<3>>(rng, apex, part == 1 ? 0.5 : part, ruled, 1e-4))) << part;
        }
    auto uneven = rows<Hom<3>>(rng, {{0, 0, 2}}, 0.5, 1);
    Net<2, Hom<3>> net = uneven.net();
    net.view()(Index<2>{2, 0}) = weighted(project(net.view()(Index<2>{2, 0})), 3.0);
    EXPECT_FALSE(apex_of(must(Surface<Hom<3>>::make({uneven.basis(0), uneven.basis(1)}, net))))
        << "lines that are not even";
}

// The distance of points of the flat triangle from the surface, at the parameters that the essay names.
double sampled(const SurfaceGeometry& surface, const Apex& apex, double far,
               const std::array<Vec<2>, 3>& corner) {
    std::array<Vec<3>, 3> p;
    std::array<double, 3> y;
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = jet<0>(surface, corner[i].c).value();
        y[i] = std::isinf(apex.at) ? 1 : (corner[i][apex.ruled] - apex.at) / (far - apex.at);
    }
    double most = 0;
    const int n = 24;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; i + k <= n; ++k) {
            const double l[3] = {double(i) / n, double(k) / n, double(n - i - k) / n};
            Vec<3> flat{};
            double height = 0, across = 0, line = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                flat += l[c] * p[c];
                height += l[c] * y[c];
                across += l[c] * y[c] * corner[c][1 - apex.ruled];
                line += l[c] * corner[c][apex.ruled];
            }
            if (!(height > 1e-12)) continue;
            std::array<double, 2> at{};
            at[std::size_t(apex.ruled)] = line;
            at[std::size_t(1 - apex.ruled)] = across / height;
            most = std::max(most, norm(jet<0>(surface, at).value() - flat));
        }
    return most;
}

TEST(ConeFace, bounds_hold_and_are_nearly_reached) {
    Random rng(17);
    std::vector<SurfaceGeometry> all{cone()};
    for (double part : {0.0, 0.4, 1.0})
        for (int ruled : {0, 1}) {
            all.push_back(rows<Vec<3>>(rng, {{0.2, 0.1, 2}}, part, ruled));
            all.push_back(rows<Hom<3>>(rng, {{0.2, 0.1, 2}}, part, ruled));
        }
    all.push_back(rows<Vec<3>>(rng, {{0.2, 0.1, 2}}, 0.5, 1, 1e-6));  // as digits of a file may be
    all.push_back(rows<Hom<3>>(rng, {{0.2, 0.1, 2}}, 0.5, 1, 0, 1e-6));
    all.push_back(rows<Hom<3>>(rng, {{0.2, 0.1, 2}}, 1, 1, 0, 1e-6));
    for (const int ruled : {0, 1}) {
        const auto many = in_more_rows(rows<Hom<3>>(rng, {{0.2, 0.1, 2}}, 0.3, ruled), ruled, 3);
        all.push_back(many);
        all.push_back(moved(moved(many, {2, 3}, 1e-5), {1, 1}, -1e-5));
    }
    double best = 0;
    for (const SurfaceGeometry& s : all) {
        const DerivativeQuery<2, 3> query(s);
        const auto apex = apex_of(s);
        ASSERT_TRUE(apex);
        const bool is_turned = std::holds_alternative<Revolution>(s);
        // Of splines all of the domain; of the other one the part below the apex, or above.
        for (int round = 0; round < 300; ++round) {
            const bool above = is_turned && round % 2;
            Box<2> face;
            for (int d = 0; d < 2; ++d) {
                const Interval on = is_turned ? d == 0  ? Interval{0, 6}
                                                : above ? Interval{6, 9}
                                                        : Interval{-2, 6}
                                              : domain(s)[std::size_t(d)];
                face.lo[d] = on.lo, face.hi[d] = on.hi;
            }
            const auto cone = ConeFace::make(*apex, query, face);
            ASSERT_TRUE(cone);
            EXPECT_EQ(cone->across(), 1 - apex->ruled);
            const double wide = std::exp2(-rng.integer(2, 14));
            std::array<Vec<2>, 3> corner;
            Box<2> box;
            const Interval on = face.side(cone->across());
            const double from = rng.real(on.lo, on.hi - wide * on.length());
            for (Vec<2>& c : corner) {
                const Interval lines = face.side(apex->ruled);
                c[apex->ruled] =
                    rng.chance(0.2) ? (rng.chance(0.5) ? lines.lo : lines.hi) : rng.real(lines.lo, lines.hi);
                c[cone->across()] = from + rng.real(0, 1) * wide * on.length();
                box.add(c);
            }
            const double bound = cone->error(cone->bends(query, box), corner);
            const Interval lines = face.side(apex->ruled);
            const double far = lines.hi - apex->at >= apex->at - lines.lo ? lines.hi : lines.lo;
            const double measured = sampled(s, *apex, far, corner);
            EXPECT_LE(measured, bound) << round;
            best = std::max(best, measured / bound);
        }
    }
    EXPECT_GE(best, 0.95);
}

TEST(ConeFace, lines_of_more_control_points_are_lines_if_they_are_as_fast_everywhere) {
    Random rng(8);
    for (const int ruled : {0, 1})
        for (const double part : {0.0, 0.4, 1.0}) {
            const auto few = rows<Hom<3>>(rng, {{0.2, 0.1, 2}}, part, ruled);
            for (const int degree : {1, 2, 4}) {
                const auto many = in_more_rows(few, ruled, degree);
                const auto a = apex_of(few), b = apex_of(many);
                ASSERT_TRUE(a && b) << degree;
                EXPECT_EQ(b->ruled, ruled);
                EXPECT_LE(b->slip, 1e-12);
                if (part < 1) {
                    EXPECT_NEAR(b->at, a->at, 1e-12);
                } else {
                    EXPECT_EQ(b->at, kInfinity);
                }
                Index<2> at{2, 2};
                const auto little = apex_of(moved(many, at, 1e-7));
                ASSERT_TRUE(little);
                EXPECT_GE(little->slip, 2e-7) << "of corners and what they are compared with";
                EXPECT_LE(little->slip, 3e-7);
                EXPECT_FALSE(apex_of(moved(many, at, 1e-3)));
            }
        }
}

TEST(ConeFace, turned_splines_that_are_lines_make_cones) {
    const Vec<3> from{{2, 0, 0}}, to{{0.5, 0, 1}};
    const auto line =
        must(Curve<Vec<3>>::make({must(BSplineBasis::bezier(1, {3, 5}))}, Net<1, Vec<3>>({2}, {from, to})));
    const auto longer = must(insert_knots(must(elevate(line, 0, 2)), 0, std::vector{3.5, 4.0}));
    const auto turned = [](const CurveGeometry<3>& profile) {
        return apex_of(Revolution{profile, {}, {{0, 0, 1}}});
    };
    for (const auto& found : {turned(line), turned(longer), turned(to_rational(longer))}) {
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->at, 3 + 2 * 2 / 1.5, 1e-13);
        EXPECT_LE(found->slip, 1e-12);
    }
    auto net = longer.net();
    net.view()(Index<1>{2}) += Vec<3>{{1e-7, 0, 0}};
    const auto bent = turned(must(Curve<Vec<3>>::make({longer.basis()}, net)));
    ASSERT_TRUE(bent);
    EXPECT_GE(bent->slip, 2e-7);
    net.view()(Index<1>{2}) += Vec<3>{{0.01, 0, 0}};
    EXPECT_FALSE(turned(must(Curve<Vec<3>>::make({longer.basis()}, net))));
    const auto heavy = must(
        Curve<Hom<3>>::make({line.basis()}, Net<1, Hom<3>>({2}, {weighted(from, 1), weighted(to, 1.5)})));
    EXPECT_FALSE(turned(heavy)) << "as fast everywhere";
    const auto wall =
        must(Curve<Vec<3>>::make({line.basis()}, Net<1, Vec<3>>({2}, {from, from + Vec<3>{{0, 0, 1}}})));
    const auto cylinder = apex_of(Revolution{wall, {}, {{0, 0, 1}}}, Box<2>{{{0, 3}}, {{6, 5}}});
    ASSERT_TRUE(cylinder);
    EXPECT_EQ(cylinder->at, kInfinity);
}

TEST(ConeFace, faces_on_both_sides_of_the_apex_and_those_of_straight_lines_are_taken_otherwise) {
    const SurfaceGeometry s = cone();
    const DerivativeQuery<2, 3> query(s);
    const Apex apex = *apex_of(s);
    const auto face = [](double lo, double hi) { return Box<2>{{{0, lo}}, {{6, hi}}}; };
    EXPECT_TRUE(apex_for(s, face(0, 5)));
    EXPECT_TRUE(apex_for(s, face(0, 6)));
    EXPECT_TRUE(apex_for(s, face(0, std::nextafter(6, 7))));
    EXPECT_TRUE(apex_for(s, face(6, 9)));
    EXPECT_FALSE(apex_for(s, face(0, 6.1)));
    const auto beyond = ConeFace::make(apex, query, face(0, 6 + 0x1p-37)),
               before = ConeFace::make(apex, query, face(0, 6));
    ASSERT_TRUE(beyond && before);
    const std::array<Vec<2>, 3> nothing{{{{1, 0}}, {{1, 1}}, {{1, 2}}}};
    const ConeFace::Bends bends{1, 0, {}};
    EXPECT_GT(beyond->error(bends, nothing), before->error(bends, nothing) + 0x1p-38);
    // Edges across bend as much, whatever the slope; not where only their speed changes.
    for (const double slope : {0.05, 0.0}) {
        const SurfaceGeometry flat = Revolution{Line<3>{{{2, 0, 0}}, {{-1, 0, slope}}}, {}, {{0, 0, 1}}};
        EXPECT_TRUE(apex_for(flat, face(0, 1)));
    }
    const Vec<3> top{{0.4, 1, 0}};
    std::vector<Vec<3>> net;
    for (const double x : {0.0, 0.1, 0.2, 1.0})
        net.insert(net.end(), {Vec<3>{{x, 0, 0}}, 0.5 * (Vec<3>{{x, 0, 0}} + top)});
    const SurfaceGeometry hasty = must(Surface<Vec<3>>::make(
        {*BSplineBasis::bezier(3), *BSplineBasis::bezier(1)}, Net<2, Vec<3>>({4, 2}, net)));
    ASSERT_TRUE(apex_of(hasty));
    EXPECT_FALSE(apex_for(hasty, {{{0, 0}}, {{1, 1}}}));
}

Revolution sphere(double radius) {
    const Vec<3> centre{{1, 2, 3}}, up = unit(Vec<3>{{1, 1, 2}}), out = unit(Vec<3>{{1, -1, 0}});
    return {Conic<3>{ConicKind::ellipse, centre, radius * out, radius * up}, centre + 4.0 * up, up,
            SurfaceKind::sphere};
}

// Points of a triangle are as far from the sphere as the centre is nearer to it than the radius.
TEST(ConeFace, bounds_of_spheres_hold_and_are_nearly_reached) {
    Random rng(23);
    const double radius = 2;
    const SurfaceGeometry s = sphere(radius);
    const DerivativeQuery<2, 3> query(s);
    const auto apex = apex_of(s);
    ASSERT_TRUE(apex);
    EXPECT_NEAR(apex->radius, radius, 1e-15);
    EXPECT_LE(apex->slip, 1e-12);
    EXPECT_FALSE(apex->is_true_to(0.3)) << "much of the radius";
    EXPECT_TRUE(apex->is_true_to(0.2));
    EXPECT_TRUE(apex_for(s, {{{0, -kTwoPi / 4}}, {{kTwoPi, kTwoPi / 4}}}));
    EXPECT_FALSE(apex_for(s, {{{0, -1.6}}, {{kTwoPi, 1.5}}})) << "beyond a pole";
    EXPECT_FALSE(apex_for(s, {{{0, 1.6}}, {{kTwoPi, 4.6}}})) << "the other half of the circle";
    const auto face = *ConeFace::make(*apex, query, {});
    const std::array<Vec<2>, 3> beyond{{{{0, 1.5}}, {{1, 1.5}}, {{0.5, 1.7}}}};
    EXPECT_EQ(face.error(face.bends(query, {{{0, 1.5}}, {{1, 1.7}}}), beyond), kInfinity) << "beyond a pole";
    double best = 0;
    for (int round = 0; round < 4000; ++round) {
        const double wide = std::exp2(-rng.real(1, 7));
        const double v = rng.chance(0.3) ? kTwoPi / 4 - wide : rng.real(-kTwoPi / 4, kTwoPi / 4 - wide);
        const double cosine = std::max(0.2, std::cos(v)), tall = wide, broad = std::min(2.0, wide / cosine);
        std::array<Vec<2>, 3> corner;
        Box<2> box;
        for (Vec<2>& c : corner) {
            c = {{rng.real(0, broad), rng.chance(0.2) ? v + tall : rng.real(v, v + tall)}};
            box.add(c);
        }
        const double bound = face.error(face.bends(query, box), corner);
        std::array<Vec<3>, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = jet<0>(s, corner[i].c).value() - Vec<3>{{1, 2, 3}};
        double nearest = radius;
        for (int i = 0; i <= 24; ++i)
            for (int k = 0; i + k <= 24; ++k)
                nearest = std::min(nearest, norm((1.0 / 24) * (double(i) * p[0] + double(k) * p[1] +
                                                               double(24 - i - k) * p[2])));
        EXPECT_LE(radius - nearest, bound + 1e-14) << round;
        best = std::max(best, (radius - nearest) / bound);
    }
    EXPECT_GE(best, 0.95);
    Revolution egg = sphere(radius);
    std::get<Conic<3>>(egg.profile).y *= 1.001;
    EXPECT_FALSE(apex_of(egg));
    Revolution ring = sphere(radius);
    ring.origin += Vec<3>{{0.1, -0.1, 0}};
    EXPECT_FALSE(apex_of(ring));
}

// Whose apex is too far away to be known.
TEST(ConeFace, walls_that_hardly_lean_are_cylinders_in_a_part) {
    const Vec<3> axis{{0, 0, 1}};
    const Box<2> part{{{0, 0}}, {{4, 3}}};
    for (const double lean : {0.0, 1e-15, 1e-9, 1e-4}) {
        const SurfaceGeometry wall = Revolution{Line<3>{{{2, 0, 0}}, {{lean, 0, 1}}}, {}, axis};
        const auto found = apex_for(wall, part);
        ASSERT_TRUE(found) << lean;
        EXPECT_EQ(std::isinf(found->at), lean < 1e-4) << lean;
        EXPECT_LE(found->slip, 3 * lean + 1e-9);
        if (!std::isinf(found->at)) continue;
        const DerivativeQuery<2, 3> query(wall);
        const auto face = ConeFace::make(*found, query, part);
        ASSERT_TRUE(face);
        EXPECT_TRUE(ConeFace::make(*found, query, {{{0, -1.5}}, {{4, 4.5}}}));
        EXPECT_FALSE(ConeFace::make(*found, query, {{{0, -1.6}}, {{4, 3}}})) << "where it leans more";
        EXPECT_FALSE(ConeFace::make(*found, query, {{{0, 0}}, {{4, 4.6}}}));
        const double step = 0.5, bow = 2 * (1 - std::cos(step / 2));
        const double bound = face->error(face->bends(query, {{{1, 0}}, {{1 + step, 3}}}),
                                         {{{{1, 0}}, {{1 + step, 3}}, {{1, 3}}}});
        EXPECT_GE(bound, bow) << lean;
        EXPECT_LE(bound, 1.02 * bow + 4 * found->slip) << lean;
    }
}

TEST(ConeFace, corners_a_hair_beyond_a_pole_count_as_at_it) {
    const SurfaceGeometry s = sphere(2);
    const DerivativeQuery<2, 3> query(s);
    const double pole = kTwoPi / 4, beyond = 1e-9;
    const Box<2> whole{{{0, -pole - beyond}}, {{kTwoPi, pole + beyond}}};
    const auto apex = apex_for(s, whole);
    ASSERT_TRUE(apex);
    EXPECT_FALSE(apex_for(s, {{{0, -pole - 1e-7}}, {{kTwoPi, pole}}}));
    EXPECT_FALSE(ConeFace::make(*apex, query, {{{0, 0}}, {{kTwoPi, pole + 1e-7}}}));
    const auto face = ConeFace::make(*apex, query, whole),
               plain = ConeFace::make(*apex, query, {{{0, -pole}}, {{kTwoPi, pole}}});
    ASSERT_TRUE(face && plain);
    const auto triangle = [&](double top) {
        return std::array<Vec<2>, 3>{{{{0, 1.4}}, {{0.2, 1.4}}, {{0.1, top}}}};
    };
    const auto bound = [&](const ConeFace& f, double top) {
        return f.error(f.bends(query, {{{0, 1.4}}, {{0.2, top}}}), triangle(top));
    };
    // What moves, corner and surface, is less than 2 of the distance from the axis away from the pole.
    EXPECT_GE(bound(*face, pole + beyond), bound(*plain, pole) + 4 * 2 * beyond);
    EXPECT_LE(bound(*face, pole + beyond), bound(*plain, pole) + 6 * 2 * beyond);
}

// A side that is straight between parameters is where `bow` says beside that of flat triangles.
TEST(ConeFace, sides_bow_as_far_as_is_said) {
    const SurfaceGeometry s = cone();
    const DerivativeQuery<2, 3> query(s);
    const auto face = ConeFace::make(*apex_of(s), query, {{{0, 0}}, {{6, 6}}});
    Random rng(3);
    for (int round = 0; round < 200; ++round) {
        const Vec<2> a{{rng.real(0, 6), rng.real(0, 6)}},
            b{{rng.real(0, 6), rng.chance(0.1) ? a[1] : rng.real(0, 6)}};
        const double bow = face->bow(a, b), ya = 6 - a[1], yb = 6 - b[1];
        double most = 0;
        for (int k = 1; k < 200; ++k) {
            const double t = k / 200.0, y = (1 - t) * ya + t * yb;
            most = std::max(
                most, std::abs(((1 - t) * ya * a[0] + t * yb * b[0]) / y - ((1 - t) * a[0] + t * b[0])));
        }
        EXPECT_LE(most, bow * (1 + 1e-12) + 1e-14);
        EXPECT_GE(most, 0.9 * bow - 1e-12);
    }
}

TEST(ConeFace, triangles_are_turned_over_if_their_points_are) {
    const SurfaceGeometry s = cone();
    const DerivativeQuery<2, 3> query(s);
    const auto face = ConeFace::make(*apex_of(s), query, {{{0, 0}}, {{6, 6}}});
    Random rng(9);
    int turned = 0;
    for (int round = 0; round < 500; ++round) {
        std::array<Vec<2>, 3> c;
        for (Vec<2>& p : c) p = {{rng.real(0, 0.3), rng.real(0, 6)}};
        if (cross(c[1] - c[0], c[2] - c[0]) < 0) std::swap(c[1], c[2]);
        std::array<Vec<3>, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = jet<0>(s, c[i].c).value();
        const Vec<3> n = cross(p[1] - p[0], p[2] - p[0]);
        const auto j = jet<1>(s, {0.15, 3});
        const double seen = dot(unit(cross(j.d[1], j.d[2])), n) / norm(n);
        if (std::abs(seen) < 0.8) continue;  // hardly any area, or far from the middle
        EXPECT_EQ(face->is_turned_over(c), seen < 0) << round;
        turned += seen < 0;
    }
    EXPECT_GT(turned, 3);
}

}  // namespace
}  // namespace freiform
