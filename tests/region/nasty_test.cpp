// A hundred pairs of paths that are made to be hard, by the laws of Boolean operations.
#include <freiform/region/boolean.hpp>

#include <gtest/gtest.h>
#include <nasty_regions.hpp>
#include <region_laws.hpp>

namespace freiform {
namespace {

using namespace test;

TEST(Combine, a_hundred_nasty_pairs_obey_the_laws_by_both_rules) {
    Random random(9);
    const NastyPairs pairs = nasty_pairs();
    EXPECT_GE(pairs.size(), 100u);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd}) {
            const NastyPair& pair = pairs[i];
            SCOPED_TRACE(text(i, ": ", pair.name, ", ", rule == FillRule::nonzero ? "nonzero" : "evenodd"));
            const auto r =
                break_laws({pair.a, rule}, {pair.b, rule}, random, {.tolerance = pair.tolerance}, 10);
            if (!r) continue;
            ++refused;
            EXPECT_TRUE(may_be_refused(pair)) << r->message;
            EXPECT_EQ(r->kind, RefusalKind::ill_conditioned);
            EXPECT_TRUE(r->where.starts_with("a.subpaths[") || r->where.starts_with("b.subpaths["))
                << r->where;
            EXPECT_NE(r->message.find("near ("), std::string::npos) << r->message;
        }
    EXPECT_LE(refused, 8u);  // of 200
}

}  // namespace
}  // namespace freiform
