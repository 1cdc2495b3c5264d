#include "fit/least_squares_detail.hpp"
#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/fit/least_squares.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;
using Real = long double;

struct Problem {
    BSplineBasis basis;
    std::vector<double> at;
    std::vector<Vec<1>> points;
};
Problem problem(Random& random, int degree, Ends ends, int per_span) {
    auto basis = test::random_basis(random, degree, {ends, 5});
    std::vector<double> at;
    const auto breaks = basis.breaks();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (int k = 0; k < per_span; ++k) at.push_back(random.real(breaks[i], breaks[i + 1]));
    std::sort(at.begin(), at.end());
    std::vector<Vec<1>> q;
    for (std::size_t i = 0; i < at.size(); ++i) q.push_back(test::random_coefficient<Vec<1>>(random));
    return {std::move(basis), std::move(at), std::move(q)};
}

// sum w (f - Q)^2 + s int f''^2, exactly, of the given coefficients.
Real objective(const Problem& p, const std::vector<Vec<1>>& net, const LeastSquaresOptions& o) {
    const auto c = must(Curve<Vec<1>>::make({p.basis}, Net<1, Vec<1>>({p.basis.size()}, net)));
    Real sum = 0;
    for (std::size_t i = 0; i < p.at.size(); ++i) {
        const Real r = test::value_of<Real>(c, p.at[i])[0] - p.points[i][0];
        sum += (o.weights.empty() ? 1 : o.weights[i]) * r * r;
    }
    const auto breaks = p.basis.breaks();
    for (std::size_t i = 0; o.smoothing > 0 && i + 1 < breaks.size(); ++i)
        for (int k = 0; k < 400; ++k) {  // midpoint rule
            const double h = (breaks[i + 1] - breaks[i]) / 400,
                         d = c.derivatives(breaks[i] + h * (k + 0.5), 2)[2][0];
            sum += Real(o.smoothing) * h * d * d;
        }
    return sum;
}

TEST(LeastSquares, no_other_curve_on_the_knots_is_closer) {
    Random random(1);
    for (const Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed})
        for (int degree = 1; degree <= 4; ++degree)
            for (const double smoothing : {0.0, 0.01}) {
                const auto p = problem(random, degree, ends, 3 * degree + 2);
                std::vector<double> weights;
                for (std::size_t i = 0; i < p.at.size(); ++i) weights.push_back(random.real(0.5, 2));
                const LeastSquaresOptions o{weights, degree >= 2 ? smoothing : 0};
                const auto f = must(least_squares<1>(p.basis, p.points, p.at, {}, o));
                const std::vector<Vec<1>> net(f.curve.net().flat().begin(), f.curve.net().flat().end());
                const Real least = objective(p, net, o);
                for (std::size_t i = 0; i < net.size(); ++i)
                    for (const double step : {1e-2, -1e-2}) {
                        auto other = net;
                        other[i][0] += step;
                        EXPECT_GE(objective(p, other, o) - least, 0) << degree << " " << i;
                    }
            }
}

TEST(LeastSquares, reproduces_curves_of_the_basis) {
    Random random(2);
    for (const Ends ends : {Ends::clamped, Ends::closed})
        for (int degree = 1; degree <= 5; ++degree) {
            auto p = problem(random, degree, ends, 3 * degree + 2);
            const auto c = test::random_patch_on<1, Vec<1>>(random, {p.basis});
            for (std::size_t i = 0; i < p.at.size(); ++i) p.points[i] = c(p.at[i]);
            const auto f = must(least_squares<1>(p.basis, p.points, p.at));
            for (std::size_t i = 0; i < c.net().flat().size(); ++i)
                EXPECT_NEAR(f.curve.net().flat()[i][0], c.net().flat()[i][0], 1e-7);
            EXPECT_LT(f.report.bound, 1e-9);
        }
}

TEST(LeastSquares, keeps_what_is_to_be_kept) {
    Random random(3);
    for (const Ends ends : {Ends::clamped, Ends::closed})
        for (int degree = 2; degree <= 5; ++degree) {
            const auto p = problem(random, degree, ends, 3 * degree + 2);
            const Interval on = p.basis.domain();
            std::vector<Datum<1>> kept{
                {on.lo, 0, {{random.real(1, 3)}}}, {on.middle(), 0, {{-2}}}, {on.middle(), 1, {{1}}}};
            if (ends == Ends::clamped) kept.push_back({on.hi, 1, {{0.5}}});
            const auto f = must(least_squares<1>(p.basis, p.points, p.at, std::span<const Datum<1>>(kept)));
            for (const auto& k : kept)
                EXPECT_NEAR(f.curve.derivatives(k.at, k.order)[std::size_t(k.order)][0], k.value[0], 1e-8)
                    << degree << " " << k.order;
            if (ends == Ends::clamped) EXPECT_EQ(f.curve(on.lo)[0], kept[0].value[0]);
            EXPECT_LT(f.report.kept_bound, 1e-10);
            EXPECT_LE(std::abs(f.curve(on.middle())[0] + 2), f.report.kept_bound);
            EXPECT_GT(f.report.kept_bound, 0);
        }
}

TEST(LeastSquares, much_smoothing_leaves_a_line) {
    const std::vector<double> at{0, 1, 2, 3, 4, 5};
    std::vector<Vec<1>> q;
    for (const double y : {0.0, 2.0, 1.0, 4.0, 3.0, 5.0}) q.push_back({{y}});
    const auto basis =
        must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}));  // more functions than points
    const auto f = must(least_squares<1>(basis, q, at, {}, {.smoothing = 1e7}));
    // The line of least squares through the six points: 5/14 + 6/7 x has the normal equations by hand.
    const double slope =
        (0 * 0 + 1 * 2 + 2 * 1 + 3 * 4 + 4 * 3 + 5 * 5 - 15 * 15 / 6.0) / (55 - 15 * 15 / 6.0);
    for (double t = 0; t <= 5; t += 0.5) EXPECT_NEAR(f.curve(t)[0], 2.5 + slope * (t - 2.5), 1e-5) << t;
}

TEST(LeastSquares, gauss_quadrature_integrates_polynomials_of_degree_2n_minus_1) {
    for (int n = 1; n <= 20; ++n) {
        const auto q = detail::gauss_legendre(n);
        for (int d = 0; d < 2 * n; ++d) {
            double sum = 0;
            for (std::size_t i = 0; i < q.node.size(); ++i) sum += q.weight[i] * std::pow(q.node[i], d);
            EXPECT_NEAR(sum, d % 2 == 0 ? 2.0 / (d + 1) : 0, 1e-13) << n << " " << d;
        }
    }
}

// Points only at the beginning of every span: normal equations square a condition that is bad already.
TEST(LeastSquares, one_step_of_refinement_gains_digits) {
    Random random(6);
    const auto c = test::random_patch_on<1, Vec<1>>(random, {must(BSplineBasis::clamped_uniform(3, 12))});
    const auto breaks = c.basis().breaks();
    std::vector<double> at, values;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (int k = 0; k < 5; ++k) at.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * 0.02 * k);
    for (const double t : at) values.push_back(c(t)[0]);
    const auto error = [&](bool refined) {
        detail::LeastSquaresSystem system(c.basis(), detail::values_at(c.basis(), at), {}, {}, {});
        EXPECT_FALSE(system.factor());
        std::vector<double> net(12);
        system.solve(values.data(), nullptr, net.data(), 1, refined);
        double most = 0;
        for (std::size_t i = 0; i < 12; ++i) most = std::max(most, std::abs(net[i] - c.net().flat()[i][0]));
        return most;
    };
    EXPECT_LT(error(true), 0.05 * error(false));
    EXPECT_LT(error(true), 1e-6);
}

TEST(LeastSquares, surfaces_are_reproduced_and_measured) {
    Random random(5);
    const auto u = test::random_basis(random, 2, {Ends::clamped, 3}),
               v = test::random_basis(random, 3, {Ends::closed, 4});
    const auto s = test::random_patch_on<2, Vec<3>>(random, {u, v});
    std::array<std::vector<double>, 2> at;
    for (int d = 0; d < 2; ++d) {
        const auto breaks = s.basis(d).breaks();
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
            for (int k = 0; k < 6; ++k)
                at[std::size_t(d)].push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / 6);
    }
    auto grid = must(evaluate_grid(s, {at[0], at[1]}));
    const auto f = must(least_squares<3>({u, v}, grid, {at[0], at[1]}));
    for (std::size_t i = 0; i < s.net().flat().size(); ++i)
        EXPECT_LT(test::distance(f.surface.net().flat()[i], s.net().flat()[i]), 1e-8);
    EXPECT_LT(f.bound, 1e-10);
    grid.view()({3, 4}) += Vec<3>{{0, 0, 1}};
    const auto off = must(least_squares<3>({u, v}, grid, {at[0], at[1]}));
    EXPECT_GE(off.bound, test::distance(off.surface(at[0][3], at[1][4]), grid.view()({3, 4})));
    EXPECT_GT(off.bound, 0.1);
    const auto values = must(evaluate_grid(off.surface, {at[0], at[1]}));
    double squares = 0;
    for (std::size_t i = 0; i < values.flat().size(); ++i)
        squares += std::pow(test::distance(values.flat()[i], grid.flat()[i]), 2);
    EXPECT_NEAR(off.rms_error, std::sqrt(squares / double(values.flat().size())), 1e-13);
}

TEST(LeastSquares, refuses_what_is_not_determined) {
    const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 1, 2, 3, 3, 3}));
    std::vector<Vec<1>> q(6);
    const std::vector<double> gap{0, 0.1, 0.2, 0.3, 0.4, 3}, good{0, 0.5, 1.25, 1.75, 2.5, 3};
    const auto r = least_squares<1>(basis, q, gap);
    ASSERT_FALSE(r);
    EXPECT_EQ(name_of(r.error().kind), name_of(RefusalKind::ill_conditioned));
    EXPECT_EQ(r.error().where, "knots[3]");
    EXPECT_TRUE(least_squares<1>(basis, q, good));
    EXPECT_TRUE(least_squares<1>(basis, q, gap, {}, {.smoothing = 1e-3}));
    const std::vector<Datum<1>> kept{{0, 0, {}}, {0, 1, {}}, {0, 2, {}}, {3, 0, {}}, {3, 1, {}}, {3, 2, {}}};
    EXPECT_EQ(least_squares<1>(basis, q, good, std::span<const Datum<1>>(kept)).error().where, "kept");
    EXPECT_EQ(least_squares<1>(basis, q, std::vector<double>{0, 1, 0.5, 2, 2, 3}).error().where, "at[2]");
    EXPECT_EQ(least_squares<1>(basis, q, good, {}, {.weights = std::vector<double>{1, 1, 0, 1, 1, 1}})
                  .error()
                  .where,
              "weights[2]");
}

}  // namespace
}  // namespace freiform
