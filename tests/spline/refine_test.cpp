#include "support/random.hpp"

#include <freiform/spline/refine.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;

// The distance of two patches at many parameters never exceeds the bound.
template <std::size_t N, class P>
void expect_bound(Random& random, const Patch<N, P>& a, const Reduced<N, P>& r) {
    const double rounding = a.value_error_bound() + r.patch.value_error_bound();
    EXPECT_EQ(a.domain(), r.patch.domain());
    for (const auto& u : test::parameters(random, a, 60))
        ASSERT_LE(norm(a(u) - r.patch(u)), r.bound + 2 * rounding);
}

template <std::size_t N, class P>
void expect_undone(std::uint64_t seed) {
    Random random(seed);
    for (int k = 0; k < 20; ++k) {
        const Ends ends = k % 3 == 0 ? Ends::closed : k % 3 == 1 ? Ends::clamped : Ends::unclamped;
        const auto s = test::random_patch<N, P>(random, N == 1 ? 7 : 3, {ends, 3});
        const int axis = random.integer(0, int(N) - 1);
        const auto [lo, hi] = s.basis(axis).domain();
        std::vector<double> more;
        for (int i = 0; i < 4; ++i) more.push_back(random.real(lo, hi));
        if (s.basis(axis).is_closed() && s.basis(axis).degree() > s.basis(axis).multiplicity(lo))
            more.push_back(k % 2 == 0 || s.basis(axis).defining()[1] == lo ? lo : hi);
        std::sort(more.begin(), more.end());
        const auto fine = must(insert_knots(s, axis, more));
        const auto r = must(remove_knots(fine, axis, 1e-10));
        EXPECT_EQ(r.patch.basis(axis), s.basis(axis)) << "degree " << s.basis(axis).degree() << " case " << k;
        EXPECT_EQ(r.removed, int(more.size()));
        EXPECT_LE(r.bound, 1e-10);
        expect_bound(random, fine, r);
        if (r.patch.basis(axis) != s.basis(axis)) continue;
        for (std::size_t i = 0; i < s.net().flat().size(); ++i)
            ASSERT_LT(norm(r.patch.net().flat()[i] - s.net().flat()[i]), 1e-7);
    }
}

TEST(RemoveKnots, undoes_insertion) {
    expect_undone<1, Vec<2>>(1);
    expect_undone<1, Hom<3>>(2);
    expect_undone<2, Vec<3>>(3);
    expect_undone<2, Hom<2>>(4);
    expect_undone<3, Vec<1>>(5);
}

TEST(RemoveKnots, keeps_its_bound_and_uses_the_tolerance) {
    Random random(6);
    for (int k = 0; k < 12; ++k) {
        const bool closed = k % 2 == 0;
        const int p = 2 + k % 4;
        std::vector<double> t;
        for (int i = 0; i <= 60; ++i) t.push_back(i / 60.0);
        if (!closed)
            for (int i = 0; i < p; ++i) t.insert(t.begin(), 0.0), t.push_back(1.0);
        const auto b = closed ? must(BSplineBasis::periodic(p, t)) : must(BSplineBasis::make(p, t));
        std::vector<Hom<2>> h;
        for (int i = 0; i < b.size(); ++i) {
            const double a = 6.283185307179586 * i / b.size();
            h.push_back(weighted(Vec<2>{{std::cos(a) + 1e-4 * random.real(-1, 1), std::sin(a)}},
                                 1 + 0.1 * std::cos(a)));
        }
        const auto s = must(Curve<Hom<2>>::make({b}, Net<1, Hom<2>>({b.size()}, h)));
        int before = -1;
        for (double tolerance : {0.0, 1e-13, 1e-4, 1e-3, 1e-2, 1e-1}) {
            const auto r = must(remove_knots(s, 0, tolerance));
            EXPECT_LE(r.bound, tolerance);
            EXPECT_GE(r.removed, before);
            EXPECT_EQ(r.removed, s.basis().size() - r.patch.basis().size());
            before = r.removed;
            expect_bound(random, s, r);
            if (tolerance < 1e-12) {
                EXPECT_EQ(r.removed, 0);
            }
            if (tolerance > 0.005) {
                EXPECT_GT(r.removed, 35) << "degree " << p << " tolerance " << tolerance;
            }
            if (!closed) {
                EXPECT_EQ(r.patch.net().flat().front(), s.net().flat().front());
                EXPECT_EQ(r.patch.net().flat().back(), s.net().flat().back());
            }
        }
    }
}

TEST(RemoveKnots, scales_to_the_bit) {
    Random random(7);
    auto s = test::random_patch<1, Hom<2>>(random, 4, {Ends::clamped, 3});
    const double more[] = {s.domain()[0].middle()};
    s = must(insert_knots(s, 0, more));
    const auto r = must(remove_knots(s, 0, 1e-10));
    for (int k : {-300, -7, 300}) {
        auto net = s.net();
        for (auto& p : net.flat())
            for (int c = 0; c < 2; ++c) p[c] = std::scalbn(p[c], k);
        const auto t =
            must(remove_knots(must(Curve<Hom<2>>::make(s.bases(), net)), 0, std::scalbn(1e-10, k)));
        EXPECT_EQ(t.bound, std::scalbn(r.bound, k));
        EXPECT_EQ(t.patch.basis(), r.patch.basis());
        for (std::size_t i = 0; i < r.patch.net().flat().size(); ++i)
            EXPECT_EQ(t.patch.net().flat()[i][0], std::scalbn(r.patch.net().flat()[i][0], k));
    }
}

template <std::size_t N, class P>
void expect_degree_undone(std::uint64_t seed) {
    Random random(seed);
    for (int k = 0; k < 16; ++k) {
        const auto s =
            test::random_patch<N, P>(random, N == 1 ? 7 : 3, {k % 2 == 0 ? Ends::closed : Ends::clamped, 3});
        const auto r = must(reduce_degree(must(elevate(s, 0)), 0, 1e-9));
        EXPECT_EQ(r.patch.basis().size(), s.basis().size());
        EXPECT_EQ(r.patch.basis().multiplicity(s.domain()[0].lo), s.basis().multiplicity(s.domain()[0].lo));
        if (k % 2 == 1) {
            EXPECT_EQ(r.patch.basis(), s.basis());
        }
        EXPECT_EQ(r.removed, 1);
        expect_bound(random, s, r);
    }
}

TEST(ReduceDegree, undoes_elevation) {
    expect_degree_undone<1, Vec<3>>(8);
    expect_degree_undone<1, Hom<2>>(9);
    expect_degree_undone<2, Hom<3>>(10);
}

TEST(ReduceDegree, keeps_its_bound_or_refuses_with_the_distance) {
    Random random(11);
    for (int k = 0; k < 10; ++k) {
        const auto s =
            test::random_patch<1, Hom<2>>(random, 6, {k % 2 == 0 ? Ends::closed : Ends::clamped, 4});
        const auto wide = reduce_degree(s, 0, 1e6);
        if (!wide) {  // weights that are not positive allow no bound
            EXPECT_EQ(wide.error().kind, RefusalKind::no_answer);
            continue;
        }
        EXPECT_EQ(wide->patch.basis().degree(), s.basis().degree() - 1);
        expect_bound(random, s, *wide);
        const auto tight = reduce_degree(s, 0, wide->bound * 0.5);
        ASSERT_FALSE(tight.has_value());
        EXPECT_EQ(tight.error().where, "tolerance");
    }
}

TEST(Reduced, refuses_what_makes_no_sense) {
    Random random(12);
    const auto s = test::random_patch<1, Vec<2>>(random, 3, {Ends::clamped, 3});
    EXPECT_EQ(remove_knots(s, 0, -1).error().where, "tolerance");
    EXPECT_EQ(remove_knots(s, 0, std::numeric_limits<double>::quiet_NaN()).error().kind,
              RefusalKind::nonfinite);
    EXPECT_EQ(reduce_degree(s, 0, std::numeric_limits<double>::infinity()).error().kind,
              RefusalKind::nonfinite);
    const auto steps = test::random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::make(0, {0, 1, 2}))});
    EXPECT_EQ(reduce_degree(steps, 0, 1).error().where, "degree");
    const auto loose =
        test::random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::make(2, {0, 1, 2, 3, 4, 5, 6}))});
    EXPECT_EQ(reduce_degree(loose, 0, 1).error().kind, RefusalKind::unsupported);
}

}  // namespace
}  // namespace freiform
