#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/basis/named.hpp>
#include <freiform/basis/subdivide.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;
using test::Rational;

// The matrix written out, columns of closed bases folded.
std::vector<std::vector<double>> dense(const BandMap& m) {
    std::vector<std::vector<double>> a(std::size_t(m.rows()), std::vector<double>(std::size_t(m.cols)));
    for (int i = 0; i < m.rows(); ++i)
        for (int k = 0; k < m.width; ++k)
            a[std::size_t(i)][std::size_t((m.first[std::size_t(i)] + k) % m.cols)] +=
                m.row(i)[std::size_t(k)];
    return a;
}

void expect_near(const BandMap& a, const BandMap& b, double tolerance) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols, b.cols);
    const auto x = dense(a), y = dense(b);
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x[i].size(); ++j)
            ASSERT_NEAR(x[i][j], y[i][j], tolerance) << i << ", " << j;
}

TEST(R16, uniform_cubic_b_spline_into_two) {
    const BandMap m = uniform_subdivision(3, 4, false);
    ASSERT_EQ(m.rows(), 5);
    const auto a = dense(m);
    for (std::size_t column = 0; column < 5; ++column)
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a[column][i], kUniformBSplineHalves[i][column]);
}

TEST(R16, boehm_is_oslo_with_one_knot) {
    Random random(41);
    int compared = 0;
    for (int p = 0; p <= 9; ++p)
        for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed})
            for (int k = 0; k < 20; ++k) {
                if (p == 0 && ends == Ends::closed) continue;
                const auto b = test::random_basis(random, p, {ends, random.integer(1, 6), false, k % 3 == 0});
                for (double u : test::parameters(random, b, 3)) {
                    const auto oslo = insert_knots(b, std::span(&u, 1));
                    const auto boehm = insert_knot(b, u);
                    ASSERT_EQ(oslo.has_value(), boehm.has_value()) << p << " at " << u;
                    if (!oslo) continue;
                    ASSERT_EQ(oslo->basis, boehm->basis);
                    // Rows without influence in the domain may differ; compare inside: values of the new
                    // basis.
                    for (double x : test::parameters(random, b, 4)) {
                        const BandMap at = collocation(oslo->basis, std::span(&x, 1));
                        expect_near(composed(oslo->map, at), composed(boehm->map, at), 1e-13);
                    }
                    ++compared;
                }
            }
    EXPECT_GT(compared, 2000);
}

TEST(UniformSubdivision, is_the_insertion_of_all_midpoints) {
    for (int p = 0; p <= kMaxDegree; ++p)
        for (int more : {1, 2, 7}) {
            std::vector<double> knots;
            const int n = p + more;
            for (int i = 0; i <= n + p; ++i) knots.push_back(i);
            const auto open = must(BSplineBasis::make(p, knots));
            const auto halved = must(halve_uniform(open));
            // The values of the refined basis times the map are those of the old one.
            for (int k = 0; k <= 8 * more; ++k) {
                const double u = p + k / 8.0;
                const BandMap fine = collocation(halved.basis, std::span(&u, 1)),
                              coarse = collocation(open, std::span(&u, 1));
                expect_near(composed(halved.map, fine), coarse, 1e-15 * (p + 1));
            }
            std::vector<double> middles;
            for (int i = p; i < n; ++i) middles.push_back(i + 0.5);
            const auto inserted = must(insert_knots(open, middles));
            EXPECT_EQ(inserted.basis.domain(), halved.basis.domain());
            EXPECT_EQ(inserted.basis.size(), halved.basis.size());
            if (p == 0) continue;
            std::vector<double> breaks, closed_middles;
            for (int i = 0; i <= n; ++i) breaks.push_back(i);
            for (int i = 0; i < n; ++i) closed_middles.push_back(i + 0.5);
            const auto closed = must(BSplineBasis::periodic(p, breaks));
            const auto twice = must(halve_uniform(closed));
            const auto oslo = must(insert_knots(closed, closed_middles));
            ASSERT_EQ(twice.basis, oslo.basis);
            expect_near(twice.map, oslo.map, 1e-15 * (p + 1));
        }
}

TEST(LaneRiesenfeld, doubling_and_averaging_is_the_matrix_of_uniform_subdivision) {
    Random random(42);
    for (int p = 0; p <= kMaxDegree; ++p)
        for (bool closed : {false, true})
            for (int more : {0, 1, 5}) {
                const int n = closed ? 1 + more : p + 1 + more;
                const auto net = test::random_net<1, Vec<2>>(random, {n});
                const auto by_matrix = along(0, uniform_subdivision(p, n, closed), net);
                const auto by_means = lane_riesenfeld(net.flat(), p, closed);
                ASSERT_EQ(by_means.size(), by_matrix.flat().size());
                for (std::size_t i = 0; i < by_means.size(); ++i)
                    for (int d = 0; d < 2; ++d)
                        ASSERT_NEAR(by_means[i][d], by_matrix.flat()[i][d], 1e-15 * (p + 1))
                            << p << closed << n;
            }
}

TEST(HalveUniform, refuses_knots_that_are_not_uniform_and_says_which) {
    const auto r = halve_uniform(must(BSplineBasis::make(1, {0, 1, 2, 4, 5})));
    ASSERT_FALSE(r.has_value());
    EXPECT_EQ(r.error().kind, RefusalKind::unsupported);
    EXPECT_EQ(r.error().where, "knots[3]");
}

TEST(ExtendTo, continues_the_end_pieces_as_the_polynomials_that_they_are) {
    Random random(43);
    for (int p = 0; p <= 7; ++p)
        for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed})
            for (int k = 0; k < 10; ++k) {
                if (p == 0 && ends == Ends::closed) continue;
                const auto b = test::random_basis(random, p, {ends, random.integer(1, 4), false, true});
                const Interval was = b.domain(),
                               on{was.lo - random.integer(0, 8) / 64.0, was.hi + random.integer(0, 8) / 64.0};
                const auto change = must(extend_to(b, on));
                ASSERT_EQ(change.basis.domain(), on);
                for (int i = 0; i <= 12; ++i) {
                    const double u = i == 12 ? on.hi : on.lo + on.length() * (i / 12.0);
                    const int span = b.span(std::clamp(u, was.lo, was.hi));
                    std::vector<Rational> w(std::size_t(p) + 1);
                    weights_in_span(b, span, Rational(u), 0, w.data());
                    std::vector<Rational> expected(std::size_t(b.size()));
                    for (int j = 0; j <= p; ++j)
                        expected[std::size_t((span - p + j) % b.size())] += w[std::size_t(j)];
                    const auto row =
                        dense(composed(change.map, collocation(change.basis, std::span(&u, 1))))[0];
                    double entries = 1;
                    for (double e : change.map.entry) entries = std::max(entries, std::abs(e));
                    for (std::size_t j = 0; j < row.size(); ++j)
                        ASSERT_LE(test::gap(row[j], expected[j]), 4e-14 * (p + 1) * entries)
                            << p << " at " << u;
                }
            }
    EXPECT_EQ(extend_to(must(BSplineBasis::bezier(2)), {0.5, 2}).error().kind, RefusalKind::out_of_domain);
}

// The largest observed / bound is below 1, and not so small that the bound says nothing.
TEST(ExtendTo, bounds_the_error_of_every_entry) {
    Random random(44);
    double worst = 0;
    for (int p = 1; p <= 9; ++p)
        for (int k = 0; k < 10; ++k) {
            const auto b =
                test::random_basis(random, p, {k % 2 ? Ends::clamped : Ends::unclamped, 3, false, false});
            const Interval was = b.domain();
            const double left = random.real(0, 2), right = random.real(0, 2);
            const auto change = must(extend_to(b, {was.lo - left, was.hi + right}));
            // The first coefficient is the value at the new end, and the last.
            for (const int j : {0, change.basis.size() - 1}) {
                const double u = j == 0 ? change.basis.domain().lo : change.basis.domain().hi;
                const int span = b.span(std::clamp(u, was.lo, was.hi));
                std::vector<Rational> w(std::size_t(p) + 1);
                weights_in_span(b, span, Rational(u), 0, w.data());
                ASSERT_EQ(change.map.first[std::size_t(j)], span - p);
                for (int i = 0; i <= p; ++i) {
                    const std::size_t at = std::size_t(j * change.map.width + i);
                    const double off = test::gap(change.map.entry[at], w[std::size_t(i)]);
                    ASSERT_LE(off, change.entry_bound[at]) << p;
                    if (off > 0) worst = std::max(worst, off / change.entry_bound[at]);
                }
            }
        }
    EXPECT_GT(worst, 0.05);
}

}  // namespace
}  // namespace freiform
