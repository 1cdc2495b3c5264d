#include "support/prepared.hpp"
#include "support/shapes.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

TEST(DerivativeBounds, hold_at_every_point_of_random_boxes) {
    std::mt19937 rng(7);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(3)) {
        const DerivativeQuery<2, 3> query(surface);
        double tightest = 0;
        for (int k = 0; k < 60; ++k) {
            std::array<Interval, 2> box;
            const double part = std::pow(0.5, uniform(rng, 0, 9));
            for (std::size_t d = 0; d < 2; ++d) {
                const double size = part * on[d].length();
                box[d].lo = uniform(rng, on[d].lo, on[d].hi - size);
                box[d].hi = box[d].lo + size;
            }
            const auto bound = query(box);
            for (int i = 0; i < 40; ++i) {
                const Param<2> at{uniform(rng, box[0].lo, box[0].hi), uniform(rng, box[1].lo, box[1].hi)};
                const auto j = jet<2>(surface, at);
                for (std::size_t s = 1; s < 6; ++s) {
                    ASSERT_LE(norm(j.d[s]), bound.d[s] * (1 + 1e-12) + 1e-12) << name << ", derivative " << s;
                    if (part < 0.01 && bound.d[s] > 1e-9)
                        tightest = std::max(tightest, norm(j.d[s]) / bound.d[s]);
                }
            }
        }
        EXPECT_GT(tightest, 0.5) << name << ": the bound is useless";
    }
}

TEST(DerivativeBounds, of_a_small_box_come_near_the_derivatives_there) {
    std::mt19937 rng(8);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(4)) {
        const DerivativeQuery<2, 3> query(surface);
        for (int k = 0; k < 20; ++k) {
            const Param<2> at{uniform(rng, on[0].lo + 0.01, on[0].hi - 0.01),
                              uniform(rng, on[1].lo + 0.01, on[1].hi - 0.01)};
            const double h = 1e-5;
            const auto bound = query({{{at[0], at[0] + h}, {at[1], at[1] + h}}});
            const auto j = jet<2>(surface, {at[0] + h / 2, at[1] + h / 2});
            double size = 0;
            for (std::size_t s = 1; s < 6; ++s) size = std::max(size, norm(j.d[s]));
            // The bound of an offset adds up terms that may cancel: it has the right size, but does not
            // converge.
            const double slack = kind_name(surface) == "offset" ? 2 * size : size / 4 + 1e-2;
            for (std::size_t s = 3; s < 6; ++s)
                EXPECT_LE(bound.d[s], norm(j.d[s]) + slack) << name << ", derivative " << s;
        }
    }
}

// Weights that change along one parameter only: cylinders, cones, and what is neither.
TEST(DerivativeBounds, of_rational_surfaces_with_rulings_hold_and_do_not_mix_what_is_apart) {
    std::mt19937 rng(12);
    for (int round = 0; round < 24; ++round) {
        const int p = 2 + round % 3, q = 1 + round / 3 % 3, ruling = round % 2;
        const bool moved = round % 3 == 0;  // the same curve at all v
        std::vector<Vec<3>> curve;
        std::vector<double> w;
        for (int i = 0; i <= p; ++i) {
            curve.push_back({{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)}});
            w.push_back(uniform(rng, 0.3, 2));
        }
        std::vector<Hom<3>> c;
        const int n[2] = {ruling ? q : p, ruling ? p : q};
        for (int i = 0; i <= n[0]; ++i)
            for (int k = 0; k <= n[1]; ++k) {
                const std::size_t a = std::size_t(ruling ? k : i);
                const double b = ruling ? i : k;
                const double more = moved ? 0 : uniform(rng, -0.3, 0.3);
                c.push_back(Space<Hom<3>>::lift(curve[a] + Vec<3>{{0.5 * b + more, b, 2 * b}}, w[a]));
            }
        const SurfaceGeometry s =
            *Surface<Hom<3>>::make({*BSplineBasis::bezier(n[0]), *BSplineBasis::bezier(n[1])},
                                   Net<2, Hom<3>>({n[0] + 1, n[1] + 1}, c));
        const DerivativeQuery<2, 3> query(s);
        for (int k = 0; k < 12; ++k) {
            std::array<Interval, 2> box;
            for (auto& side : box) {
                const double size = std::pow(0.5, uniform(rng, 0, 9));
                side.lo = uniform(rng, 0, 1 - size), side.hi = side.lo + size;
            }
            const auto bound = query(box, 3);
            if (moved) {
                EXPECT_LE(bound(1, 1), 1e-6 * bound(0, 1)) << round;
            }
            for (int i = 0; i < 20; ++i) {
                const auto at = [&](int d) {
                    return uniform(rng, box[std::size_t(d)].lo, box[std::size_t(d)].hi);
                };
                const auto j = jet<2>(s, {at(0), at(1)});
                for (std::size_t slot = 1; slot < 6; ++slot)
                    ASSERT_LE(norm(j.d[slot]), bound.d[slot] * (1 + 1e-12) + 1e-12) << round << ", " << slot;
            }
            // Third derivatives: what second ones change by.
            const Param<2> lo{box[0].lo, box[1].lo};
            const auto first = jet<2>(s, lo);
            for (int axis = 0; axis < 2; ++axis) {
                Param<2> hi = lo;
                hi[std::size_t(axis)] = box[std::size_t(axis)].hi;
                const auto last = jet<2>(s, hi);
                const double h = box[std::size_t(axis)].length();
                for (int i = 0; i <= 2; ++i)
                    EXPECT_LE(norm(last(2 - i, i) - first(2 - i, i)),
                              h * (axis == 0 ? bound(3 - i, i) : bound(2 - i, i + 1)) * (1 + 1e-9) + 1e-9)
                        << round;
            }
        }
    }
}

TEST(DerivativeBounds, asked_for_both_are_those_asked_for_one_by_one) {
    std::mt19937 rng(10);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(5)) {
        const DerivativeQuery<2, 3> query(surface);
        for (int k = 0; k < 10; ++k) {
            std::array<Interval, 2> box;
            for (std::size_t d = 0; d < 2; ++d) {
                box[d].lo = uniform(rng, on[d].lo, on[d].middle());
                box[d].hi = uniform(rng, on[d].middle(), on[d].hi);
            }
            const Vec<3> n = unit(Vec<3>{{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, 1, 2)}});
            const auto both = query.both(n, box);
            EXPECT_EQ(both.all.d, query(box).d) << name;
            EXPECT_EQ(both.along.d, query.along(n, box).d) << name;
            const Vec<3> other = unit(Vec<3>{{uniform(rng, -1, 1), uniform(rng, 1, 2), uniform(rng, -1, 1)}});
            const auto two = query.along_two({n, other}, box);
            EXPECT_EQ(two[0].d, both.along.d) << name;
            EXPECT_EQ(two[1].d, query.along(other, box).d) << name;
            EXPECT_EQ(query.value_error(box), value_error_bound(surface, box)) << name;
        }
    }
}

TEST(DerivativeBounds, along_vectors_hold_at_every_point_and_are_no_larger_than_those_of_all) {
    std::mt19937 rng(21);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(6)) {
        const DerivativeQuery<2, 3> query(surface);
        for (int k = 0; k < 40; ++k) {
            const Vec<3> n = k % 4 == 0 ? Vec<3>{{0, 1, 0}}
                                        : unit(Vec<3>{{uniform(rng, -1, 1), uniform(rng, -1, 1), 0.1}});
            const double part = std::pow(0.5, uniform(rng, 0, 9));
            std::array<Interval, 2> box;
            for (std::size_t d = 0; d < 2; ++d) {
                box[d].lo = uniform(rng, on[d].lo, on[d].hi - part * on[d].length());
                box[d].hi = box[d].lo + part * on[d].length();
            }
            const auto both = query.both(n, box);
            for (std::size_t s = 1; s < 6; ++s)
                EXPECT_LE(both.along.d[s], both.all.d[s] * (1 + 1e-9) + 1e-9) << name << ", derivative " << s;
            for (int i = 0; i < 30; ++i) {
                const auto j =
                    jet<2>(surface, {uniform(rng, box[0].lo, box[0].hi), uniform(rng, box[1].lo, box[1].hi)});
                for (std::size_t s = 1; s < 6; ++s)
                    ASSERT_LE(std::abs(dot(n, j.d[s])), both.along.d[s] * (1 + 1e-12) + 1e-12)
                        << name << ", derivative " << s;
            }
        }
    }
}

constexpr int kBinomials[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};

TEST(DerivativeBounds, of_blocks_of_every_degree_are_those_of_all_their_differences) {
    std::mt19937 rng(22);
    for (int p = 1; p <= 6; ++p)
        for (int q = 1; q <= 9; ++q) {
            const auto s = random_patch<2, Vec<3>>(rng, {p, q}, 0);
            const auto net = s.net().view();
            const auto found = derivative_bounds<2, Vec<3>>({net.data, net.extent, net.stride}, {1, 1}, 3);
            double factor_u = 1;
            for (int i = 0; i <= 3; factor_u *= p - i, ++i) {
                double factor = factor_u;
                for (int j = 0; i + j <= 3; factor *= q - j, ++j) {
                    if (i + j == 0) continue;
                    double most = 0;
                    for (int a = 0; a + i <= p; ++a)
                        for (int b = 0; b + j <= q; ++b) {
                            Vec<3> sum;  // all signed binomials at once, the slow obvious way
                            for (int k = 0; k <= i; ++k)
                                for (int l = 0; l <= j; ++l)
                                    sum += ((i - k + j - l) % 2 ? -1.0 : 1.0) * kBinomials[i][k] *
                                           kBinomials[j][l] * net({a + k, b + l});
                            most = std::max(most, norm(sum));
                        }
                    const double bound = found(i, j), exact = std::abs(factor) * most;
                    EXPECT_GE(bound, exact * (1 - 1e-14)) << p << " " << q << ": " << i << " " << j;
                    EXPECT_LE(bound, exact * (1 + 1e-9) + 1e-9) << p << " " << q << ": " << i << " " << j;
                }
            }
        }
}

TEST(DerivativeBounds, are_the_same_numbers_with_every_instruction_set) {
    std::vector<std::vector<double>> found;
    with_every_variant([&] {
        std::mt19937 rng(23);
        auto& all = found.emplace_back();
        for (const auto& [name, surface, on] : surfaces_of_every_kind(7)) {
            const DerivativeQuery<2, 3> query(surface);
            for (int k = 0; k < 20; ++k) {
                const std::array<Interval, 2> box{
                    Interval{uniform(rng, on[0].lo, on[0].middle()), uniform(rng, on[0].middle(), on[0].hi)},
                    Interval{uniform(rng, on[1].lo, on[1].middle()), uniform(rng, on[1].middle(), on[1].hi)}};
                const auto both = query.both(unit(Vec<3>{{1, 2, uniform(rng, -1, 1)}}), box, 1 + k % 2);
                all.insert(all.end(), both.all.d.begin(), both.all.d.end());
                all.insert(all.end(), both.along.d.begin(), both.along.d.end());
                const auto j = jet<2>(surface, {box[0].lo, box[1].hi});
                for (const Vec<3>& d : j.d) all.insert(all.end(), d.c.begin(), d.c.end());
            }
        }
    });
    for (const auto& other : found) EXPECT_EQ(other, found[0]);
    if (found.size() == 1) GTEST_SKIP() << "this processor has one instruction set only";
}

TEST(DerivativeBounds, scale_exactly_with_powers_of_two) {
    std::mt19937 rng(9);
    const auto s = random_patch<2, Hom<3>>(rng, {3, 3}, 3);
    for (int k = -300; k <= 300; k += 100) {
        std::vector<Hom<3>> c(s.net().flat().begin(), s.net().flat().end());
        for (auto& p : c)
            for (int i = 0; i < 3; ++i) p[i] = std::ldexp(p[i], k);
        const SurfaceGeometry plain = s,
                              big = *Surface<Hom<3>>::make(s.bases(), Net<2, Hom<3>>(s.net().extent(), c));
        const DerivativeQuery<2, 3> a(plain), b(big);
        const auto x = a(s.domain()), y = b(s.domain());
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(std::ldexp(x.d[i], k), y.d[i]) << k;
    }
}

TEST(DerivativeBounds, kinks_are_found_and_their_jumps_bounded) {
    // z = |x| as a degree 1 spline, and its square where the double knot hides no kink.
    const auto linear = *BSplineBasis::make(1, {-1, -1, 0, 1, 1});
    const auto across = *BSplineBasis::bezier(1);
    const SurfaceGeometry roof = *Surface<Vec<3>>::make(
        {linear, across},
        Net<2, Vec<3>>({3, 2},
                       {{{-1, 0, 1}}, {{-1, 1, 1}}, {{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 1}}, {{1, 1, 1}}}));
    const DerivativeQuery<2, 3> query(roof);
    ASSERT_EQ(query.kinks(0).size(), 1u);
    EXPECT_EQ(query.kinks(0)[0].at, 0);
    EXPECT_GE(query.kinks(0)[0].jump, 2);
    EXPECT_LE(query.kinks(0)[0].jump, 2 + 1e-9);
    EXPECT_TRUE(query.kinks(1).empty());

    // The nine-point circle: double knots, but the same speed on both sides.
    const double w = std::sqrt(0.5);
    std::vector<Hom<3>> c;
    const double xy[9][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (int i = 0; i < 9; ++i) c.push_back(weighted(Vec<3>{{xy[i][0], xy[i][1], 0}}, i % 2 ? w : 1));
    const CurveGeometry<3> round = *Curve<Hom<3>>::make(
        {*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4})}, Net<1, Hom<3>>({9}, c));
    const DerivativeQuery<1, 3> circle_query(round);
    ASSERT_EQ(circle_query.kinks(0).size(), 3u);
    for (const Kink& k : circle_query.kinks(0)) EXPECT_LE(k.jump, 1e-12);
}

TEST(DerivativeBounds, jumps_of_rational_surfaces_are_bounded_and_those_of_round_ones_vanish) {
    std::mt19937 rng(11);
    const auto kinked = *BSplineBasis::make(2, {0, 0, 0, 1, 1, 3, 3, 3});
    double tightest = 0;
    for (int round = 0; round < 50; ++round) {
        std::vector<Hom<3>> c;
        for (int i = 0; i < 20; ++i)
            c.push_back(weighted(Vec<3>{{uniform(rng, 4, 6), uniform(rng, -1, 1), uniform(rng, -1, 1)}},
                                 uniform(rng, 0.3, 2)));
        const SurfaceGeometry s =
            *Surface<Hom<3>>::make({kinked, *BSplineBasis::bezier(3)}, Net<2, Hom<3>>({5, 4}, c));
        const DerivativeQuery<2, 3> query(s);
        ASSERT_EQ(query.kinks(0).size(), 1u);
        double most = 0;
        for (int k = 0; k <= 40; ++k)
            most = std::max(most, norm(jet<1>(s, {std::nextafter(1.0, 2.0), k / 40.0})(1, 0) -
                                       jet<1>(s, {std::nextafter(1.0, 0.0), k / 40.0})(1, 0)));
        EXPECT_LE(most, query.kinks(0)[0].jump * (1 + 1e-12));
        tightest = std::max(tightest, most / query.kinks(0)[0].jump);
    }
    EXPECT_GT(tightest, 0.5);

    // A cone between two circles whose weights differ: smooth, though its homogeneous pieces are not.
    const SurfaceGeometry cone = cone_of_uneven_weights();
    const DerivativeQuery<2, 3> query(cone);
    ASSERT_EQ(query.kinks(0).size(), 1u);
    EXPECT_LE(query.kinks(0)[0].jump, 1e-10);
}

TEST(DerivativeBounds, of_coordinates_of_plane_curves_hold_for_each_by_itself) {
    std::mt19937 rng(8);
    const auto basis = *BSplineBasis::clamped_uniform(3, 7);
    std::vector<Vec<2>> p;
    std::vector<Hom<2>> h;
    for (int i = 0; i < 7; ++i) {
        p.push_back({{uniform(rng, -1, 1), 0.01 * uniform(rng, -1, 1)}});
        h.push_back(weighted(p.back(), uniform(rng, 0.5, 2)));
    }
    const CurveGeometry<2> curves[] = {Line<2>{{{1, 2}}, {{3, 0.5}}},
                                       Conic<2>{ConicKind::ellipse, {{1, 0}}, {{2, 0}}, {{0, 0.1}}},
                                       *Curve<Vec<2>>::make({basis}, Net<1, Vec<2>>({7}, p)),
                                       *Curve<Hom<2>>::make({basis}, Net<1, Hom<2>>({7}, h))};
    for (const auto& curve : curves) {
        const DerivativeQuery<1, 2> query(curve);
        for (int k = 0; k < 40; ++k) {
            const double lo = uniform(rng, 0, 3), hi = lo + uniform(rng, 0.05, 1);
            const PlaneCurveBounds bounds = coordinate_bounds(query, {lo, hi});
            Vec<2> most[3] = {};
            for (int i = 0; i <= 30; ++i) {
                const auto j = jet<2>(curve, lo + (hi - lo) * i / 30);
                for (int order = 1; order <= 2; ++order)
                    for (int c = 0; c < 2; ++c)
                        most[order][c] = std::max(most[order][c], std::abs(j(order)[c]));
            }
            for (int order = 1; order <= 2; ++order) {
                EXPECT_EQ(bounds.both(order), query({Interval{lo, hi}})(order));
                for (int c = 0; c < 2; ++c) {
                    const double bound = bounds.coordinate[std::size_t(c)](order);
                    EXPECT_LE(most[order][c], bound * (1 + 1e-12) + 1e-12) << order << " " << c;
                    EXPECT_LE(bound, bounds.both(order) * (1 + 1e-9) + 1e-9) << order << " " << c;
                }
            }
        }
    }
}

// Over a plane whose parameters run unevenly: an offset bends along its normal no more than that plane does.
TEST(DerivativeBounds, of_offsets_along_the_normal_are_not_those_of_all) {
    const SurfaceGeometry plane = rolling(5, 0);
    const SurfaceGeometry offset = OffsetSurface{std::make_shared<const SurfaceGeometry>(plane), 0.3};
    const DerivativeQuery<2, 3> query(offset);
    const Interval on = domain(plane)[0];
    for (const double part : {0.05, 0.01}) {
        const double size = part * on.length();
        for (int i = 0; i < 10; ++i) {
            const double lo = on.lo + 0.1 * i * (on.length() - size);
            const auto [all, along] =
                query.both({{0, 0, 1}}, {Interval{lo, lo + size}, Interval{lo, lo + size}});
            for (std::size_t s = 3; s < 6; ++s)
                EXPECT_LE(along.d[s], 40 * part * part * all(0, 1)) << part << " " << i;
        }
    }
}

TEST(DerivativeBounds, the_thinnest_piece_is_the_shortest_knot_span) {
    const auto basis = *BSplineBasis::make(2, {0, 0, 0, 1, 1.25, 4, 4, 4});
    const auto spline =
        *Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({5}, std::vector<Vec<3>>(5, Vec<3>{{1, 0, 2}})));
    const CurveGeometry<3> profile = spline;
    EXPECT_EQ((DerivativeQuery<1, 3>(profile).thinnest_piece(0)), 0.25);
    const SurfaceGeometry turned = Revolution{profile, {}, {{0, 0, 1}}},
                          moved = Extrusion{profile, {{0, 1, 0}}},
                          offset = OffsetSurface{std::make_shared<const SurfaceGeometry>(moved), 0.5};
    for (const auto& [surface, along_profile] : {std::pair(&turned, 1), {&moved, 0}, {&offset, 0}}) {
        const DerivativeQuery<2, 3> query(*surface);
        EXPECT_EQ(query.thinnest_piece(along_profile), 0.25);
        EXPECT_EQ(query.thinnest_piece(1 - along_profile), kInfinity);
    }
}

// The bound is at least what one sees, and nearly it where the surface is the same all along the line.
TEST(DerivativeBounds, offsets_have_kinks_where_second_derivatives_of_their_base_jump) {
    std::mt19937 rng(3);
    const auto knots = *BSplineBasis::make(2, {0, 0, 0, 1, 3, 3.5, 3.5, 3.5});
    const auto cubic = *BSplineBasis::make(3, {0, 0, 0, 0, 1, 1, 2, 2, 2, 2});
    for (int i = 0; i < 10; ++i) {
        std::vector<Vec<3>> row, net;
        for (int k = 0; k < 5; ++k) row.push_back({{double(k), 0, uniform(rng, -1, 1)}});
        for (int k = 0; k < 30; ++k) net.push_back({{double(k / 6), double(k % 6), uniform(rng, -0.5, 0.5)}});
        const Curve<Vec<3>> profile = *Curve<Vec<3>>::make({knots}, Net<1, Vec<3>>({5}, row));
        const SurfaceGeometry moved = Extrusion{profile, {{0, 1, 0}}},
                              turned = Revolution{profile, {{0, 0, -5}}, {{1, 0, 0}}},
                              both = *Surface<Vec<3>>::make({knots, cubic}, Net<2, Vec<3>>({5, 6}, net));
        const struct {
            const SurfaceGeometry* base;
            int axis;
            std::vector<double> at;
        } cases[] = {{&moved, 0, {1, 3}}, {&turned, 1, {1, 3}}, {&both, 0, {1, 3}}, {&both, 1, {1}}};
        for (const auto& c : cases) {
            const SurfaceGeometry offset =
                OffsetSurface{std::make_shared<const SurfaceGeometry>(*c.base), -0.7};
            const DerivativeQuery<2, 3> query(offset);
            const auto kinks = query.kinks(c.axis);
            ASSERT_EQ(kinks.size(), c.at.size());
            const Interval line = c.base == &both ? domain(*c.base)[std::size_t(1 - c.axis)] : Interval{0, 1};
            for (std::size_t k = 0; k < kinks.size(); ++k) {
                EXPECT_EQ(kinks[k].at, c.at[k]);
                double most = 0;
                for (int s = 0; s <= 100; ++s) {
                    std::array<double, 2> before, after;
                    before[std::size_t(1 - c.axis)] = after[std::size_t(1 - c.axis)] =
                        line.lo + s / 100.0 * line.length();
                    before[std::size_t(c.axis)] = c.at[k] - 1e-9, after[std::size_t(c.axis)] = c.at[k] + 1e-9;
                    const std::size_t slot = c.axis == 0 ? 1 : 2;
                    most =
                        std::max(most, norm(jet<1>(offset, after).d[slot] - jet<1>(offset, before).d[slot]));
                }
                EXPECT_GE(kinks[k].jump, most * (1 - 1e-6));
                EXPECT_LE(kinks[k].jump, (c.base == &both ? 1.3 : 1.001) * most + 1e-3);
            }
            EXPECT_TRUE(query.kinks(1 - c.axis).empty() || c.base == &both);
        }
    }
}

// Where doubles are far apart the places beside a knot must be so, too.
TEST(DerivativeBounds, kinks_of_offsets_do_not_depend_on_where_parameters_begin) {
    const std::vector<Vec<3>> row{{{0, 0, 0}}, {{1, 0, 0}}, {{2, 0, 2}}, {{3, 0, 0}}};
    const auto jump = [&](double begin, double span) {
        const auto basis = *BSplineBasis::make(
            2, {begin, begin, begin, begin + span, begin + 2 * span, begin + 2 * span, begin + 2 * span});
        const Curve<Vec<3>> profile = *Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({4}, row));
        const SurfaceGeometry offset =
            OffsetSurface{std::make_shared<const SurfaceGeometry>(Extrusion{profile, {{0, 1, 0}}}), 1};
        const DerivativeQuery<2, 3> query(offset);
        const auto kinks = query.kinks(0);
        return kinks.size() == 1 ? kinks[0].jump : -1;
    };
    const double here = jump(0, 1);
    EXPECT_GT(here, 0.1);
    for (const double begin : {0x1p20, 0x1p30, 0x1p36, 0x1p40, 0x1p44}) {
        EXPECT_GE(jump(begin, 1), here * (1 - 1e-6)) << begin;
        EXPECT_LE(jump(begin, 1), 2 * here) << begin;
    }
    EXPECT_GE(jump(0x1p52, 1), here);  // nothing is known: infinite
}

}  // namespace
