#include "support/random.hpp"
#include "support/refusal.hpp"

#include <freiform/basis/bspline.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::expect_refusal;
using test::must;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(BSplineBasis, refuses_what_is_no_basis_and_says_where) {
    using K = RefusalKind;
    expect_refusal(BSplineBasis::make(-1, {0, 1}), K::invalid, "degree");
    expect_refusal(BSplineBasis::make(26, std::vector<double>(54, 0.0)), K::unsupported, "degree");
    expect_refusal(BSplineBasis::make(3, {0, 0, 0, 1, 1, 1}), K::invalid, "knots");
    expect_refusal(BSplineBasis::make(1, {0, 0, kNan, 1, 1}), K::nonfinite, "knots[2]");
    expect_refusal(BSplineBasis::make(1, {0, 0, 1, kInf}), K::nonfinite, "knots[3]");
    expect_refusal(BSplineBasis::make(1, {0, 1, 0.5, 2}), K::invalid, "knots[2]");
    expect_refusal(BSplineBasis::make(1, {-1e308, -1e308, 1e308, 1e308}), K::nonfinite, "knots");
    expect_refusal(BSplineBasis::make(1, {0, 1, 1, 2}), K::invalid, "knots");
    expect_refusal(BSplineBasis::make(1, {0, 0, 1, 1, 1, 2, 2}), K::invalid, "knots[2]");
    expect_refusal(BSplineBasis::make(2, {0, 0, 0, 0, 1, 1, 1}), K::invalid, "knots[0]");
    EXPECT_TRUE(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}).has_value());
    EXPECT_TRUE(BSplineBasis::make(0, {0, 1}).has_value());
    EXPECT_TRUE(BSplineBasis::bezier(25).has_value());
    expect_refusal(BSplineBasis::bezier(26), K::unsupported, "degree");
    expect_refusal(BSplineBasis::bezier(2, {1, 1}), K::invalid, "interval");
    expect_refusal(BSplineBasis::bezier(2, {0, kNan}), K::nonfinite, "interval");
    expect_refusal(BSplineBasis::clamped_uniform(3, 3), K::invalid, "size");
    expect_refusal(BSplineBasis::clamped_uniform(3, std::numeric_limits<int>::max()), K::limit, "size");
    expect_refusal(Bernstein::make(-1), K::invalid, "degree");
    expect_refusal(Bernstein::make(26), K::unsupported, "degree");
    expect_refusal(Bernstein::make(1, {0, kInf}), K::nonfinite, "interval");
    expect_refusal(Bernstein::make(1, {1, 0}), K::invalid, "interval");
}

TEST(BSplineBasis, refuses_closed_bases_that_are_not_closed_or_not_continuous) {
    using K = RefusalKind;
    expect_refusal(BSplineBasis::periodic(-1, {0, 1}), K::invalid, "degree");
    expect_refusal(BSplineBasis::periodic(26, {0, 1}), K::unsupported, "degree");
    expect_refusal(BSplineBasis::periodic(2, {0}), K::invalid, "breaks");
    expect_refusal(BSplineBasis::periodic(2, {0, kNan, 1}), K::nonfinite, "breaks[1]");
    expect_refusal(BSplineBasis::periodic(2, {0, 2, 1}), K::invalid, "breaks[2]");
    expect_refusal(BSplineBasis::periodic(2, {0, 1, 1, 1, 2}), K::invalid, "breaks[1]");
    expect_refusal(BSplineBasis::periodic(2, {0, 0, 1, 1}), K::invalid,
                   "breaks[0]");  // three times at the seam
    expect_refusal(BSplineBasis::periodic(2, {1, 1}), K::invalid, "knots");
    expect_refusal(BSplineBasis::periodic(3, {-1e308, 0, 7e307}), K::nonfinite, "breaks");
    EXPECT_TRUE(BSplineBasis::periodic(2, {0, 0, 1}).has_value());
    EXPECT_TRUE(BSplineBasis::periodic(25, {0, 1}).has_value());
    EXPECT_TRUE(BSplineBasis::periodic(0, {0, 1, 2}).has_value());
}

TEST(BSplineBasis, span_is_the_half_open_span_and_the_last_one_is_closed) {
    test::Random random(1);
    for (int p = 0; p <= 9; ++p)
        for (auto ends : {test::Ends::clamped, test::Ends::unclamped, test::Ends::closed})
            for (int k = 0; k < 20; ++k) {
                if (p == 0 && ends == test::Ends::closed) continue;
                const auto b =
                    test::random_basis(random, p, {ends, random.integer(1, 6), ends != test::Ends::closed});
                const auto [lo, hi] = b.domain();
                for (double u : test::parameters(random, b)) {
                    const int s = b.span(u);
                    ASSERT_LT(b.knot(s), b.knot(s + 1));
                    if (u == hi)
                        ASSERT_EQ(b.knot(s + 1), hi);
                    else
                        ASSERT_TRUE(b.knot(s) <= u && u < b.knot(s + 1)) << "p " << p << " u " << u;
                }
                EXPECT_EQ(b.knot(b.span(lo - 1)), lo);
                EXPECT_EQ(b.knot(b.span(hi + 1) + 1), hi);
            }
}

TEST(BSplineBasis, a_closed_basis_repeats_its_breaks_with_the_period) {
    const auto b = must(BSplineBasis::periodic(3, {0, 1, 1, 2.5, 4}));
    EXPECT_EQ(b.size(), 4);
    EXPECT_EQ(std::vector<double>(b.knots().begin(), b.knots().end()),
              (std::vector<double>{-3, -3, -1.5, 0, 1, 1, 2.5, 4, 5, 5, 6.5}));
    EXPECT_EQ(b.multiplicity(1), 2);
    EXPECT_EQ(b.multiplicity(0), 1);
    EXPECT_EQ(b.multiplicity(4), 1);
    EXPECT_EQ(b.breaks(), (std::vector<double>{0, 1, 2.5, 4}));
    // One break only: every coefficient is the same one.
    const auto one = must(BSplineBasis::periodic(2, {0, 1}));
    EXPECT_EQ(one.size(), 1);
    EXPECT_EQ(std::vector<double>(one.knots().begin(), one.knots().end()),
              (std::vector<double>{-2, -1, 0, 1, 2, 3}));
}

TEST(BSplineBasis, unwinding_keeps_the_multiplicity_of_the_seam) {
    // 0.1 + (0.7 - 0.1) is not 0.7: the second of the two knots at the seam must still be moved onto the
    // first.
    for (const std::vector<double>& breaks :
         {std::vector{0.1, 0.1, 0.35, 0.7}, std::vector{0.1, 0.35, 0.7, 0.7}}) {
        const auto b = must(BSplineBasis::periodic(3, breaks));
        for (double end : {0.1, 0.7}) {
            EXPECT_EQ(b.multiplicity(end), 2);
            EXPECT_EQ(std::count(b.knots().begin(), b.knots().end(), end), 2) << end;
        }
    }
}

TEST(BSplineBasis, wrap_moves_into_the_domain_by_whole_periods) {
    const auto b = must(BSplineBasis::periodic(3, {1, 2, 4, 5}));
    for (double u : {1.0, 1.25, 3.0, 5.0}) EXPECT_EQ(b.wrap(u), u);
    EXPECT_EQ(b.wrap(5.5), 1.5);
    EXPECT_EQ(b.wrap(0.5), 4.5);
    EXPECT_EQ(b.wrap(1 - 400.0), 1);
    EXPECT_EQ(b.wrap(3 + 4096.0), 3);
    const auto wide = must(BSplineBasis::periodic(1, {-2e307, 0, 2e307}));
    for (double u : {1.7e308, -1.7e308}) EXPECT_TRUE(wide.domain().contains(wide.wrap(u)));
    const auto open = must(BSplineBasis::bezier(3));
    EXPECT_EQ(open.wrap(17), 17);
}

TEST(BSplineBasis, same_kind_makes_a_basis_from_what_another_was_made_from) {
    test::Random random(2);
    for (auto ends : {test::Ends::clamped, test::Ends::unclamped, test::Ends::closed})
        for (int p = 1; p <= 9; ++p) {
            const auto b = test::random_basis(random, p, {ends, 4});
            EXPECT_EQ(b, must(b.same_kind(p, {b.defining().begin(), b.defining().end()})));
            EXPECT_EQ(b.is_closed(), ends == test::Ends::closed);
        }
    EXPECT_TRUE(must(BSplineBasis::periodic(0, {0, 1, 2})).is_closed());
}

}  // namespace
}  // namespace freiform
