#include <freiform/core/parallel.hpp>
#include <freiform/spline/evaluate_gathered.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>

namespace freiform {
namespace {

using detail::PreparedNet;
using test::Random;

struct Gathered {
    Patch<2, Hom<3>> patch;
    PreparedNet net;
    std::vector<Param<2>> at;

    static double on(Random& random, const BSplineBasis& basis) {
        return random.real(basis.domain().lo, basis.domain().hi);
    }
    static Gathered make(test::Ends ends, std::size_t points) {
        Random random(71);
        auto patch = test::random_patch<2, Hom<3>>(random, 3, {.ends = ends, .spans = 3});
        auto net = PreparedNet::make(patch.bases(), tuples(patch.net().flat()));
        EXPECT_TRUE(net);
        std::vector<Param<2>> at;
        for (std::size_t i = 0; i < points; ++i)
            at.push_back({on(random, patch.basis(0)), on(random, patch.basis(1))});
        return {patch, *net, at};
    }
    Result<std::vector<Vec<3>>> values(Outside outside) const {
        std::vector<Vec<3>> out(at.size());
        const auto gather = [&](std::size_t first, std::size_t count, double* to) {
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t d = 0; d < 2; ++d) to[2 * i + d] = at[first + i][d];
        };
        const auto done =
            evaluate_gathered(net, at.size(), gather, 0, 1, {numbers(std::span(out)).data()}, outside);
        if (!done) return std::unexpected(done.error());
        return out;
    }
};

TEST(EvaluateGathered, gives_the_same_bits_as_parameters_in_a_row) {
    for (const auto ends : {test::Ends::clamped, test::Ends::closed})
        for (const std::size_t points : {0uz, 1uz, 7uz, 4096uz, 4097uz, 300'000uz}) {
            const Gathered g = Gathered::make(ends, points);
            std::vector<Vec<3>> direct(points);
            ASSERT_TRUE(test::prepared(g.patch).evaluate(g.at, direct));
            const auto gathered = g.values(Outside::refuse);
            ASSERT_TRUE(gathered);
            EXPECT_TRUE(*gathered == direct) << points;
        }
}

TEST(EvaluateGathered, names_the_first_bad_parameter_or_gives_nan_there) {
    Gathered g = Gathered::make(test::Ends::clamped, 100'000);
    for (const std::size_t i : {99'999uz, 70'001uz, 2'500uz}) g.at[i][0] = 1e9;
    const auto refused = g.values(Outside::refuse);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::out_of_domain);
    EXPECT_TRUE(refused.error().where.starts_with("at[2500]")) << refused.error().where;
    const auto nan = g.values(Outside::nan);
    ASSERT_TRUE(nan);
    for (std::size_t i = 0; i < g.at.size(); ++i)
        EXPECT_EQ(std::isnan((*nan)[i][0]), i == 99'999 || i == 70'001 || i == 2'500) << i;
}

}  // namespace
}  // namespace freiform
