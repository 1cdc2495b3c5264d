#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/jet.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;
using test::Rational;

TEST(Jet, orders_are_graded) {
    EXPECT_EQ((jet_orders<1>(3)), (std::vector<Index<1>>{{0}, {1}, {2}, {3}}));
    EXPECT_EQ((jet_orders<2>(2)), (std::vector<Index<2>>{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}));
    EXPECT_EQ((jet_orders<3>(1)), (std::vector<Index<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    for (int k = 0; k <= 8; ++k) {
        EXPECT_EQ(jet_orders<3>(k).size(), jet_size(3, k));
        for (std::size_t i = 0; i < jet_size(3, k); ++i) EXPECT_EQ(jet_slot(jet_orders<3>(k)[i]), i);
    }
    EXPECT_EQ(binomial(25, 12), 5200300);
    EXPECT_EQ(binomial(3, 4), 0);
}

// The recursion of the quotient rule with absolute values throughout: the scale that rounding is measured by.
template <std::size_t N, class P>
std::vector<double> scales(const Patch<N, P>& s, const Param<N>& u, int order) {
    const auto orders = jet_orders<N>(order);
    std::vector<double> a, w, out;
    for (const auto& o : orders) {
        std::array<std::vector<double>, N> b;
        Index<N> extent{};
        for (std::size_t d = 0; d < N; ++d) {
            b[d] = test::cox_de_boor(test::knots_as<double>(s.basis(int(d))), s.basis(int(d)).degree(),
                                     component<N>(u, d), o[d]);
            extent[d] = int(b[d].size());
        }
        double sum = 0, weight = 0;
        each_index(extent, [&](const Index<N>& i) {
            double product = 1;
            Index<N> at{};
            for (std::size_t d = 0; d < N; ++d) {
                product *= std::abs(b[d][std::size_t(i[d])]);
                at[d] = i[d] % s.net().extent()[d];
            }
            sum += product * max_abs(s.net().view()(at));
            weight += product * Space<P>::weight(s.net().view()(at));
        });
        a.push_back(sum);
        w.push_back(weight);
    }
    for (std::size_t i = 0; i < orders.size(); ++i) {
        double v = a[i];
        if (Space<P>::kRational) {
            for (std::size_t j = 1; j < orders.size(); ++j) {
                double c = 1;
                Index<N> rest{};
                for (std::size_t d = 0; d < N; ++d) {
                    rest[d] = orders[i][d] - orders[j][d];
                    c *= binomial(orders[i][d], orders[j][d]);
                }
                if (c > 0) v += c * w[j] * out[jet_slot(rest)];
            }
            v /= w[0];
        }
        out.push_back(v);
    }
    return out;
}

template <std::size_t N, class P>
double worst_ratio(std::uint64_t seed, int degree, int order, int patches) {
    Random random(seed);
    double worst = 0;
    for (int k = 0; k < patches; ++k)
        for (Ends ends : {Ends::clamped, Ends::unclamped, Ends::closed}) {
            const auto s = test::random_patch<N, P>(random, degree, {ends, 2, ends != Ends::closed, true});
            for (const auto& u : test::parameters(random, s, 2)) {
                const auto exact = test::jet_of<Rational>(s, u, order);
                const auto computed = s.derivatives(u, order);
                const auto scale = scales(s, u, order);
                EXPECT_EQ(computed.size(), exact.size());
                for (std::size_t i = 0; i < exact.size(); ++i)
                    for (std::size_t c = 0; c < exact[i].size(); ++c) {
                        const double error = test::gap(computed[i][int(c)], exact[i][c]);
                        if (error > 0) worst = std::max(worst, error / (scale[i] * 0x1p-53));
                    }
            }
        }
    return worst;
}

TEST(Jet, all_partials_agree_with_exact_rational_arithmetic) {
    // In units of 2^-53 of the scale; about 6 roundings for every degree, axis and order.
    EXPECT_LT((worst_ratio<1, Vec<2>>(1, 9, 6, 12)), 100);
    EXPECT_LT((worst_ratio<1, Hom<2>>(2, 9, 6, 8)), 100);
    EXPECT_LT((worst_ratio<2, Vec<3>>(3, 4, 6, 3)), 100);
    EXPECT_LT((worst_ratio<2, Hom<3>>(4, 4, 4, 3)), 100);
    EXPECT_LT((worst_ratio<3, Vec<1>>(5, 2, 4, 2)), 100);
    EXPECT_LT((worst_ratio<3, Hom<3>>(6, 2, 3, 2)), 100);
}

TEST(Jet, derivatives_of_any_order_and_jets_are_the_same_numbers) {
    Random random(7);
    const auto s = test::random_patch<2, Hom<3>>(random, 5, {Ends::clamped, 3});
    for (const auto& u : test::parameters(random, s, 10)) {
        const auto j = s.jet<6>(u);
        for (int order = 0; order <= 9; ++order) {
            const auto d = s.derivatives(u, order);
            ASSERT_EQ(d.size(), jet_size(2, order));
            for (std::size_t i = 0; i < std::min(d.size(), j.d.size()); ++i) EXPECT_EQ(d[i], j.d[i]);
        }
        EXPECT_EQ(j.value(), s(u));
    }
    // Beyond the degree the derivatives of a polynomial are zero, those of a rational map are not.
    const auto line =
        must(Curve<Vec<1>>::make({must(BSplineBasis::bezier(1))}, Net<1, Vec<1>>({2}, {{{1}}, {{3}}})));
    EXPECT_EQ(line.derivatives(0.25, 30).back()[0], 0);
    const auto hyperbola =
        must(Curve<Hom<1>>::make({must(BSplineBasis::bezier(1))}, Net<1, Hom<1>>({2}, {{{1, 1}}, {{1, 2}}})));
    const auto j = hyperbola.jet<4>(0);  // 1 / (1 + t)
    EXPECT_EQ(j(0)[0], 1);
    EXPECT_EQ(j(1)[0], -1);
    EXPECT_EQ(j(2)[0], 2);
    EXPECT_EQ(j(3)[0], -6);
    EXPECT_EQ(j(4)[0], 24);
}

template <std::size_t N, class P>
void expect_differences(std::uint64_t seed) {
    Random random(seed);
    for (int k = 0; k < 6; ++k) {
        const auto s = test::random_patch<N, P>(random, 4, {k % 2 == 0 ? Ends::clamped : Ends::closed, 1});
        for (const auto& u : test::parameters(random, s, 5, false)) {
            const auto j = s.template jet<3>(u);
            for (std::size_t axis = 0; axis < N; ++axis) {
                const auto on = s.domain()[axis];
                const double h = 1e-5 * on.length(), x = component<N>(u, axis);
                if (x - h < on.lo || x + h > on.hi) continue;
                std::array<double, N> a{}, b{};
                for (std::size_t d = 0; d < N; ++d) a[d] = b[d] = component<N>(u, d);
                a[axis] = x - h;
                b[axis] = x + h;
                const double step = b[axis] - a[axis];
                const auto ja = s.template jet<2>(test::to_param<N>(a)),
                           jb = s.template jet<2>(test::to_param<N>(b));
                for (const auto& o : jet_orders<N>(2)) {
                    auto up = o;
                    ++up[axis];
                    double scale = 0;
                    for (const auto& d : s.derivatives(u, 5)) scale = std::max(scale, norm(d));
                    ASSERT_LT(norm((1 / step) * (jb(o) - ja(o)) - j(up)),
                              1e-5 * (scale + 1) * (1 + on.length()))
                        << "N " << N << " axis " << axis;
                }
            }
        }
    }
}

TEST(Jet, partials_are_limits_of_differences_of_partials_of_one_order_less) {
    expect_differences<1, Vec<3>>(11);
    expect_differences<1, Hom<3>>(12);
    expect_differences<2, Vec<3>>(13);
    expect_differences<2, Hom<3>>(14);
    expect_differences<3, Vec<3>>(15);
    expect_differences<3, Hom<3>>(16);
}

// The slow twin: every order by itself.
template <std::size_t N, class P>
std::vector<PointOf<P>> order_by_order(const Patch<N, P>& s, const Param<N>& u, int order) {
    const auto orders = jet_orders<N>(order);
    std::vector<P> h(orders.size());
    for (std::size_t slot = 0; slot < orders.size(); ++slot) {
        std::array<std::array<double, kMaxDegree + 1>, 2> w{};
        Index<2> first{}, count{1, 1};
        w[1][0] = 1;
        for (std::size_t d = 0; d < N; ++d) {
            first[d] = weights(s.basis(int(d)), component<N>(u, d), orders[slot][d], w[d].data());
            count[d] = s.basis(int(d)).degree() + 1;
        }
        for (int i = 0; i < count[0]; ++i) {
            P inner{};
            for (int k = 0; k < count[1]; ++k) {
                Index<N> at{};
                at[0] = (first[0] + i) % s.basis(0).size();
                if constexpr (N == 2) at[1] = (first[1] + k) % s.basis(1).size();
                if constexpr (N == 1)
                    inner = s.net().view()(at);
                else
                    inner += w[1][std::size_t(k)] * s.net().view()(at);
            }
            h[slot] += w[0][std::size_t(i)] * inner;
        }
    }
    std::vector<PointOf<P>> out(orders.size());
    project_jet<N, P>(order, h, out);
    return out;
}

template <std::size_t N, class P>
void expect_twins(Random& random) {
    for (int round = 0; round < 60; ++round) {
        const Ends ends = random.chance(0.3) ? Ends::closed : Ends::clamped;
        const auto s = test::random_patch<N, P>(random, 6, {.ends = ends});
        Param<N> u{};
        const auto on = s.domain();
        if constexpr (N == 1)
            u = random.real(on[0].lo, on[0].hi);
        else
            for (std::size_t d = 0; d < N; ++d) u[d] = random.real(on[d].lo, on[d].hi);
        for (int order = 0; order <= 4; ++order)
            EXPECT_EQ(s.derivatives(u, order), order_by_order(s, u, order)) << order;
    }
}

TEST(Jet, what_orders_share_is_done_once_and_changes_no_bit) {
    Random random(11);
    expect_twins<1, Vec<2>>(random);
    expect_twins<1, Hom<3>>(random);
    expect_twins<2, Vec<3>>(random);
    expect_twins<2, Hom<3>>(random);
}

}  // namespace
}  // namespace freiform
