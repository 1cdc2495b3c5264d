// Exact rational arithmetic as the judge of Patch::value_error_bound().
#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/patch.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Ends;
using test::Random;
using test::Rational;

enum class Nets { mixed_signs, one_sign, large_offset, tiny, wild_weights };

template <class P>
void fill(Random& random, Nets kind, std::span<P> net) {
    for (P& p : net) switch (kind) {
            case Nets::mixed_signs:
                p = test::random_coefficient<P>(random);
                break;
            case Nets::one_sign:
                p = test::random_coefficient<P>(random, 0.001, 1, 0.01);
                break;
            case Nets::large_offset:
                p = test::random_coefficient<P>(random, 1, 1e9);
                break;
            case Nets::tiny:
                p = test::random_coefficient<P>(random, 0x1p-1060, 0, 0);
                break;
            case Nets::wild_weights:
                p = test::random_coefficient<P>(random, 1, 0, 27);
                break;
        }
}

template <std::size_t N, class P>
double largest_ratio(int degree, int rounds, int points) {
    Random random(std::uint64_t(degree) * 10 + N);
    double worst = 0;
    for (int k = 0; k < rounds; ++k)
        for (Nets kind :
             {Nets::mixed_signs, Nets::one_sign, Nets::large_offset, Nets::tiny, Nets::wild_weights}) {
            const Ends ends = k % 3 == 0 ? Ends::clamped : k % 3 == 1 ? Ends::unclamped : Ends::closed;
            const test::BasisOptions options{ends, random.integer(1, 3), ends != Ends::closed};
            auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
                return std::array<BSplineBasis, N>{((void)I, test::random_basis(random, degree, options))...};
            }
            (std::make_index_sequence<N>{});
            auto net = test::random_patch_on<N, P>(random, bases).net();
            fill<P>(random, kind, net.flat());
            const auto s = test::must(Patch<N, P>::make(bases, net));
            const double bound = s.value_error_bound();
            EXPECT_TRUE(std::isfinite(bound));
            for (const auto& u : test::parameters(random, s, points)) {
                const auto exact = test::value_of<Rational>(s, u);
                const auto computed = s(u);
                for (std::size_t c = 0; c < exact.size(); ++c) {
                    const double ratio = test::gap(computed[int(c)], exact[c]) / bound;
                    EXPECT_LE(ratio, 1) << "degree " << degree << " net " << int(kind);
                    worst = std::max(worst, ratio);
                }
            }
        }
    return worst;
}

TEST(ValueErrorBound, is_never_exceeded_and_not_far_above_what_happens) {
    std::printf("  largest observed / bound:\n  degree   N=1 Vec  N=1 Hom  N=2 Vec  N=2 Hom  N=3 Vec\n");
    double over_all = 0;
    for (int p : {1, 2, 3, 4, 5, 6, 7, 8, 9, 15, 20, 25}) {
        const int r = p > 9 ? 1 : 3, n = p > 9 ? 3 : 8;
        const double ratios[] = {largest_ratio<1, Vec<2>>(p, r, n), largest_ratio<1, Hom<2>>(p, r, n),
                                 p > 6 ? 0 : largest_ratio<2, Vec<1>>(p, 2, 3),
                                 p > 6 ? 0 : largest_ratio<2, Hom<1>>(p, 2, 2),
                                 p > 4 ? 0 : largest_ratio<3, Vec<1>>(p, 2, 2)};
        std::printf("  %6d", p);
        for (double x : ratios) {
            std::printf("   %6.3f", x);
            over_all = std::max(over_all, x);
        }
        std::printf("\n");
    }
    EXPECT_GE(over_all, 0.05) << "the bound is useless";
}

}  // namespace
}  // namespace freiform
