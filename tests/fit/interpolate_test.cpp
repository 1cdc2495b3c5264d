#include "fit/spline_system_detail.hpp"
#include "support/curves.hpp"
#include "support/reference.hpp"
#include "support/refusal.hpp"

#include <freiform/fit/interpolate.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::expect_refusal;
using test::must;
using test::Random;
using test::random_points;
using test::Rational;

constexpr SplineEnds kAllEnds[] = {SplineEnds::natural, SplineEnds::clamped, SplineEnds::not_a_knot,
                                   SplineEnds::periodic};

std::vector<double> sites(Random& random, int count) { return test::random_breaks(random, count, false); }

// A curve through random points with these ends; the points and parameters come along.
template <int D>
struct Case {
    std::vector<double> at;
    std::vector<Vec<D>> points, start, end;
    Interpolant<1, D> got;
};
template <int D>
Case<D> random_case(Random& random, int degree, SplineEnds ends, int count, double offset = 0) {
    const int k = ends == SplineEnds::clamped ? degree / 2 : 0;
    const auto n = std::size_t(std::max(count, ends == SplineEnds::not_a_knot ? degree + 1 : 2));
    auto at = sites(random, int(n) + (ends == SplineEnds::periodic));
    auto points = random_points<D>(random, n, offset);
    auto start = random_points<D>(random, std::size_t(k)), end = random_points<D>(random, std::size_t(k));
    auto got = must(interpolate<D>(points, {degree, ends, at}, start, end));
    return {std::move(at), std::move(points), std::move(start), std::move(end), std::move(got)};
}

TEST(Interpolate, goes_through_the_points_within_the_bound) {
    Random random(1);
    double worst = 0;
    for (int degree = 1; degree <= 7; ++degree)
        for (const SplineEnds ends : kAllEnds)
            for (int count : {2, 3, 8}) {
                const auto c = random_case<2>(random, degree, ends, count, count == 8 ? 1e6 : 0);
                for (std::size_t i = 0; i < c.points.size(); ++i) {
                    const auto exact = test::value_of<Rational>(c.got.patch, c.at[i]);
                    const double x = test::gap(c.points[i][0], exact[0]),
                                 y = test::gap(c.points[i][1], exact[1]);
                    ASSERT_LE(std::hypot(x, y), c.got.bound)
                        << degree << " " << name_of(ends) << " " << count;
                    worst = std::max(worst, std::hypot(x, y) / c.got.bound);
                }
                double scale = 0;
                for (const auto& p : c.got.patch.net().flat()) scale = std::max(scale, max_abs(p));
                EXPECT_LT(c.got.bound, 2e-14 * scale) << degree << " " << name_of(ends) << " " << count;
            }
    EXPECT_GT(worst, 0.001);  // the bound is of use
}

TEST(Interpolate, agrees_with_elimination_on_the_full_matrix) {
    Random random(2);
    using Long = long double;
    for (int degree = 1; degree <= 6; ++degree)
        for (const SplineEnds ends : kAllEnds) {
            const auto c = random_case<1>(random, degree, ends, 9);
            const BSplineBasis& basis = c.got.patch.basis();
            const auto n = std::size_t(basis.size());
            std::vector<std::vector<Long>> a;
            const auto row = [&](double at, int order, double value) {
                const auto w = test::cox_de_boor(test::knots_as<Long>(basis), degree, Long(at), order);
                std::vector<Long> r(n + 1);
                for (std::size_t i = 0; i < w.size(); ++i) r[i % n] += w[i];
                r[n] = value;
                a.push_back(std::move(r));
            };
            for (std::size_t i = 0; i < c.points.size(); ++i) row(c.at[i], 0, c.points[i][0]);
            for (int j = 1; j <= degree / 2; ++j) {
                const int order = ends == SplineEnds::clamped ? j : degree / 2 + j;
                if (ends != SplineEnds::clamped && ends != SplineEnds::natural) continue;
                const bool given = ends == SplineEnds::clamped;
                row(c.at.front(), order, given ? c.start[std::size_t(j - 1)][0] : 0);
                row(c.at.back(), order, given ? c.end[std::size_t(j - 1)][0] : 0);
            }
            ASSERT_EQ(a.size(), n) << degree << " " << name_of(ends);
            for (std::size_t i = 0; i < n; ++i) {  // Gauss and Jordan, with column pivots
                std::size_t p = i;
                for (std::size_t r = i; r < n; ++r)
                    if (std::abs(a[r][i]) > std::abs(a[p][i])) p = r;
                std::swap(a[i], a[p]);
                for (std::size_t r = 0; r < n; ++r) {
                    if (r == i) continue;
                    const Long f = a[r][i] / a[i][i];
                    for (std::size_t k = i; k <= n; ++k) a[r][k] -= f * a[i][k];
                }
            }
            Long scale = 0;
            for (std::size_t i = 0; i < n; ++i) scale = std::max(scale, std::abs(a[i][n] / a[i][i]));
            for (std::size_t i = 0; i < n; ++i)
                EXPECT_NEAR(c.got.patch.net().flat()[i][0], double(a[i][n] / a[i][i]),
                            1e-12 * c.got.condition_estimate * double(scale))
                    << degree << " " << name_of(ends) << " " << i;
        }
}

TEST(Interpolate, has_simple_knots_so_all_derivatives_but_the_last_are_continuous) {
    Random random(3);
    for (int degree = 1; degree <= 6; ++degree)
        for (const SplineEnds ends : kAllEnds) {
            const auto c = random_case<3>(random, degree, ends, 9);
            const BSplineBasis& basis = c.got.patch.basis();
            const auto breaks = basis.breaks();
            for (std::size_t i = 1; i + 1 < breaks.size(); ++i) EXPECT_EQ(basis.multiplicity(breaks[i]), 1);
            EXPECT_EQ(basis.is_closed(), ends == SplineEnds::periodic);
            if (degree % 2 == 1) EXPECT_EQ(basis.domain(), (Interval{c.at.front(), c.at.back()}));
        }
}

TEST(Interpolate, natural_ends_have_no_second_derivative) {
    Random random(4);
    for (int degree : {2, 3, 4, 5, 7}) {
        const auto c = random_case<2>(random, degree, SplineEnds::natural, 8);
        const int k = degree / 2;
        for (const double end : {c.at.front(), c.at.back()}) {
            const auto d = c.got.patch.derivatives(end, degree);
            const double h = end == c.at.front() ? c.at[1] - c.at[0] : c.at[7] - c.at[6];
            double scale = 0;
            for (const auto& p : c.got.patch.net().flat()) scale = std::max(scale, max_abs(p));
            for (int j = 1; j <= k; ++j) {
                const int order = k + j;
                EXPECT_LT(norm(d[std::size_t(order)]), 1e-8 * scale * std::pow(h / 2, -order))
                    << degree << " order " << order;
            }
        }
    }
}

TEST(Interpolate, clamped_ends_have_the_derivatives_that_are_given) {
    Random random(5);
    for (int degree : {2, 3, 4, 5}) {
        const auto c = random_case<2>(random, degree, SplineEnds::clamped, 8);
        const auto a = c.got.patch.derivatives(c.at.front(), degree / 2),
                   b = c.got.patch.derivatives(c.at.back(), degree / 2);
        for (int j = 1; j <= degree / 2; ++j) {
            EXPECT_LT(test::distance(a[std::size_t(j)], c.start[std::size_t(j - 1)]), 1e-6);
            EXPECT_LT(test::distance(b[std::size_t(j)], c.end[std::size_t(j - 1)]), 1e-6);
        }
    }
}

TEST(Interpolate, periodic_curves_close_with_all_derivatives_but_the_last) {
    Random random(6);
    for (int degree = 1; degree <= 6; ++degree) {
        std::vector<double> at{0, 1, 1.5, 3, 3.25, 4, 6, 6.5};
        const auto q = random_points<2>(random, 7);
        const auto c = must(interpolate<2>(q, {degree, SplineEnds::periodic, at}));
        const Interval on = c.patch.basis().domain();
        const auto a = c.patch.derivatives(on.lo, degree), b = c.patch.derivatives(on.hi, degree);
        for (int j = 0; j < degree; ++j)
            EXPECT_LT(test::distance(a[std::size_t(j)], b[std::size_t(j)]),
                      1e-10 * (1 + norm(a[std::size_t(j)])))
                << degree << " order " << j;
        EXPECT_GT(test::distance(a[std::size_t(degree)], b[std::size_t(degree)]), 1e-3);
        EXPECT_LT(test::distance(c.patch(at[0]), q[0]), 1e-12);
        EXPECT_LT(test::distance(c.patch(at[7]), q[0]), 1e-12);
    }
}

double polynomial(int degree, double t, int order = 0) {
    double sum = 0;
    for (int i = order; i <= degree; ++i) {
        double f = 1 + i % 3;
        for (int k = 0; k < order; ++k) f *= i - k;
        sum += f * std::pow(t, i - order);
    }
    return sum;
}

TEST(Interpolate, reproduces_polynomials) {
    const std::vector<double> at{-1, -0.75, -0.25, 0, 0.125, 0.5, 0.625, 1};
    for (int degree = 1; degree <= 6; ++degree)
        for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::clamped, SplineEnds::not_a_knot}) {
            // Natural ends reproduce what has none of the derivatives that vanish there.
            const int d = ends == SplineEnds::natural ? std::max(1, degree / 2) : degree;
            std::vector<Vec<1>> q, start, end;
            for (const double t : at) q.push_back({{polynomial(d, t)}});
            for (int j = 1; ends == SplineEnds::clamped && j <= degree / 2; ++j) {
                start.push_back({{polynomial(d, at.front(), j)}});
                end.push_back({{polynomial(d, at.back(), j)}});
            }
            const auto c = must(interpolate<1>(q, {degree, ends, at}, start, end));
            for (double t = -1; t <= 1; t += 0.0625)
                EXPECT_NEAR(c.patch(t)[0], polynomial(d, t), 1e-12)
                    << degree << " " << name_of(ends) << " at " << t;
        }
}

TEST(Interpolate, scales_with_powers_of_two_to_the_bit) {
    Random random(7);
    for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::not_a_knot, SplineEnds::periodic})
        for (const Spacing spacing : {Spacing::uniform, Spacing::chordal, Spacing::centripetal}) {
            const auto q = random_points<2>(random, 9);
            std::vector<Vec<2>> scaled = q;
            for (auto& p : scaled) p *= 0x1p-301;
            const bool closed = ends == SplineEnds::periodic;
            const auto at = must(parameters<2>(q, spacing, closed)),
                       small = must(parameters<2>(scaled, spacing, closed));
            const auto a = must(interpolate<2>(q, {3, ends, at})),
                       b = must(interpolate<2>(scaled, {3, ends, small}));
            for (std::size_t i = 0; i < a.patch.net().flat().size(); ++i)
                EXPECT_EQ(0x1p-301 * a.patch.net().flat()[i], b.patch.net().flat()[i]);
            EXPECT_EQ(a.bound * 0x1p-301, b.bound);
            EXPECT_EQ(a.condition_estimate, b.condition_estimate);
        }
}

TEST(Interpolate, commutes_with_affine_maps) {
    Random random(8);
    const auto map = [](const Vec<2>& p) { return Vec<2>{{2 * p[0] - 3 * p[1] + 5, p[0] + 0.5 * p[1] - 7}}; };
    for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::not_a_knot, SplineEnds::periodic}) {
        const auto c = random_case<2>(random, 3, ends, 10);
        auto q = c.points;
        for (auto& p : q) p = map(p);
        const auto moved = must(interpolate<2>(q, {3, ends, c.at}));
        double scale = 0;
        for (const auto& p : moved.patch.net().flat()) scale = std::max(scale, max_abs(p));
        for (std::size_t i = 0; i < c.got.patch.net().flat().size(); ++i)
            EXPECT_LT(test::distance(moved.patch.net().flat()[i], map(c.got.patch.net().flat()[i])),
                      1e-13 * c.got.condition_estimate * scale);
    }
}

TEST(Interpolate, grids_are_interpolated_along_both_axes_one_after_the_other) {
    Random random(9);
    for (const SplineEnds a : {SplineEnds::natural, SplineEnds::not_a_knot, SplineEnds::periodic})
        for (const SplineEnds b : {SplineEnds::natural, SplineEnds::periodic})
            for (const auto& degrees : {std::pair{3, 3}, {2, 5}}) {
                const Index<2> extent{7, 6};
                const auto grid = test::random_net<2, Vec<3>>(random, extent);
                const auto u = sites(random, 7 + (a == SplineEnds::periodic)),
                           v = sites(random, 6 + (b == SplineEnds::periodic));
                const auto s =
                    must(interpolate<2, 3>(grid, {AxisSpline{degrees.first, a, u}, {degrees.second, b, v}}));
                for (int i = 0; i < 7; ++i)
                    for (int j = 0; j < 6; ++j) {
                        const auto exact =
                            test::value_of<Rational>(s.patch, {u[std::size_t(i)], v[std::size_t(j)]});
                        double sum = 0;
                        for (std::size_t c = 0; c < 3; ++c)
                            sum = std::hypot(sum, test::gap(grid.view()({i, j})[int(c)], exact[c]));
                        ASSERT_LE(sum, s.bound);
                    }
                // The iso-curve through a row of points is the curve through them.
                std::vector<Vec<3>> row;
                for (int j = 0; j < 6; ++j) row.push_back(grid.view()({2, j}));
                const auto curve = must(interpolate<3>(row, {degrees.second, b, v}));
                const auto iso_curve = iso(s.patch, 0, u[2]);
                for (const double t : test::parameters(random, curve.patch.basis(), 5))
                    EXPECT_LT(test::distance(iso_curve(t), curve.patch(t)), 1e-10 * s.condition_estimate);
            }
}

TEST(Interpolate, clamped_grids_take_layers_of_derivatives) {
    // z = u^3 v^3, of which the bicubic clamped interpolant is the surface itself, twists included.
    const std::vector<double> u{0, 0.5, 1}, v{0, 0.25, 0.75, 1};
    Net<2, Vec<1>> layers({5, 6});
    const auto f = [](double t, bool d) { return d ? 3 * t * t : t * t * t; };
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 6; ++j) {
            const double a = u[std::size_t(std::clamp(i - 1, 0, 2))],
                         b = v[std::size_t(std::clamp(j - 1, 0, 3))];
            layers.view()({i, j}) = {{f(a, i == 0 || i == 4) * f(b, j == 0 || j == 5)}};
        }
    const auto s =
        must(interpolate<2, 1>(layers, {AxisSpline{3, SplineEnds::clamped, u}, {3, SplineEnds::clamped, v}}));
    for (double a = 0; a <= 1; a += 0.125)
        for (double b = 0; b <= 1; b += 0.125) EXPECT_NEAR(s.patch(a, b)[0], a * a * a * b * b * b, 1e-14);
    EXPECT_LT(s.bound, 1e-13);
}

TEST(Interpolate, condition_is_the_norm_of_the_inverse) {
    // Two points a long way apart in parameters and two close ones: known to be worse than even steps.
    const std::vector<double> even{0, 1, 2, 3, 4, 5}, uneven{0, 1, 1.001, 2, 3, 4};
    const std::vector<Vec<1>> q(6);
    const double good =
        must(interpolate<1>(q, {3, SplineEnds::periodic, std::vector<double>{0, 1, 2, 3, 4, 5, 6}}))
            .condition_estimate;
    EXPECT_NEAR(good, 3, 1e-12);  // the symbol 1/6 (4 - 2) of the chessboard
    EXPECT_GT(must(interpolate<1>(q, {3, SplineEnds::not_a_knot, uneven})).condition_estimate,
              must(interpolate<1>(q, {3, SplineEnds::not_a_knot, even})).condition_estimate);
}

TEST(Interpolate, periodic_curves_do_not_depend_on_the_point_where_they_begin) {
    Random random(13);
    for (int degree = 1; degree <= 6; ++degree) {
        const std::vector<double> at{0, 1, 1.5, 3, 3.25, 4, 6, 6.5};
        const auto q = random_points<2>(random, 7);
        const auto c = must(interpolate<2>(q, {degree, SplineEnds::periodic, at}));
        std::vector<double> later;
        std::vector<Vec<2>> turned;
        for (std::size_t i = 0; i < 7; ++i)
            turned.push_back(q[(i + 3) % 7]), later.push_back(at[(i + 3) % 7] + (i + 3 >= 7 ? 6.5 : 0));
        later.push_back(at[3] + 6.5);
        const auto again = must(interpolate<2>(turned, {degree, SplineEnds::periodic, later}));
        for (double t = 3; t <= 9.5; t += 0.1875)
            EXPECT_LT(
                test::distance(again.patch(again.patch.basis().wrap(t)), c.patch(c.patch.basis().wrap(t))),
                1e-11)
                << degree << " at " << t;
    }
}

TEST(Interpolate, values_in_bulk_are_those_of_one_site_to_the_bit) {
    Random random(14);
    for (int degree = 1; degree <= 6; ++degree)
        for (const bool closed : {false, true}) {
            const auto basis =
                test::random_basis(random, degree, {closed ? test::Ends::closed : test::Ends::clamped, 40});
            auto sites = basis.breaks();  // runs of simple knots, and places between them
            const auto more = test::parameters(random, basis, 2);
            sites.insert(sites.end(), more.begin(), more.end());
            std::sort(sites.begin(), sites.end());
            if (closed) std::erase(sites, basis.domain().hi);
            const BandMap bulk = detail::values_at(basis, sites);
            std::vector<double> one(std::size_t(degree) + 1);
            for (std::size_t i = 0; i < sites.size(); ++i) {
                EXPECT_EQ(bulk.first[i], weights(basis, sites[i], 0, one.data())) << degree;
                const auto row = bulk.row(int(i));
                EXPECT_TRUE(std::equal(one.begin(), one.end(), row.begin(), row.end()))
                    << degree << " at " << sites[i];
            }
        }
}

TEST(Interpolate, refuses_what_has_no_spline) {
    const std::vector<double> at{0, 1, 2, 3};
    std::vector<Vec<2>> q(4);
    const auto run = [&](AxisSpline a) { return interpolate<2>(q, a); };
    expect_refusal(run({0, SplineEnds::natural, at}), RefusalKind::invalid, "degree", "outside 1..25");
    expect_refusal(run({26, SplineEnds::natural, at}), RefusalKind::unsupported, "degree", "outside");
    expect_refusal(run({3, SplineEnds::periodic, at}), RefusalKind::invalid, "at",
                   "4 parameters, expected 5");
    expect_refusal(run({5, SplineEnds::not_a_knot, at}), RefusalKind::invalid, "points", "need at least 6");
    expect_refusal(run({3, SplineEnds::clamped, at}), RefusalKind::invalid, "start", "take 1");
    const std::vector<double> back{0, 2, 1, 3}, nan{0, 1, std::nan(""), 3};
    expect_refusal(run({3, SplineEnds::natural, back}), RefusalKind::invalid, "at[2]",
                   "does not increase: 2 -> 1");
    expect_refusal(run({3, SplineEnds::natural, nan}), RefusalKind::nonfinite, "at[2]", "not a finite");
    q[3][1] = std::nan("");
    expect_refusal(run({3, SplineEnds::natural, at}), RefusalKind::nonfinite, "points[3]", "not finite");
    q.resize(1);
    expect_refusal(run({3, SplineEnds::natural, std::span(at).first(1)}), RefusalKind::invalid, "points",
                   "1 point;");
    expect_refusal(interpolate<2, 1>(Net<2, Vec<1>>({4, 3}),
                                     {AxisSpline{3, SplineEnds::natural, at}, {3, SplineEnds::natural, at}}),
                   RefusalKind::invalid, "axes[1].at", "4 parameters, expected 3");
}

}  // namespace
}  // namespace freiform
