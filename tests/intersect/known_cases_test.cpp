// The cases on which other libraries fail, by name, and nasty pairs whose number of roots is exact:
// bench/common/nasty_curves.hpp has them, so that the tables of bench/INTERSECT.md are about the same.
#include "../../bench/common/nasty_curves.hpp"

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

using bench::CurveCase, bench::Verdict;

Result<Curve<Vec<2>>> curve_of(const bench::NastyGrid& g) {
    const int n = int(g.size());
    return Curve<Vec<2>>::make({*BSplineBasis::bezier(n - 1)}, Net<1, Vec<2>>({n}, g));
}
// In both orders and all directions.
void expect_right(CurveCase c) {
    for (int way = 0; way < 8; ++way) {
        if (way % 2 == 0) std::swap(c.a, c.b);
        if (way % 4 == 0) std::reverse(c.a.begin(), c.a.end());
        const auto found = intersect(*curve_of(c.a), *curve_of(c.b));
        ASSERT_TRUE(found.has_value()) << c.kind;
        EXPECT_EQ(bench::judge(c, *found), Verdict::right)
            << c.kind << ", way " << way << ": " << found->contacts.size() << " points of " << c.points
            << ", " << found->overlaps.size() << " overlaps of " << c.overlaps << ", "
            << found->undecided.size() << " open";
    }
}

TEST(KnownCases, fifteen_on_which_others_fail_are_all_right) {
    const auto all = bench::known_hard_cases();
    ASSERT_EQ(all.size(), 15u);
    for (const CurveCase& c : all) {
        SCOPED_TRACE(c.kind);
        if (c.points < 0) {
            const auto refused = curve_of(c.a);
            ASSERT_FALSE(refused.has_value());
            EXPECT_EQ(refused.error().kind, RefusalKind::nonfinite);
            EXPECT_NE(refused.error().where.find("[1]"), std::string::npos) << refused.error().where;
        } else {
            expect_right(c);
        }
    }
}

TEST(KnownCases, nasty_pairs_have_as_many_points_as_exact_arithmetic_counts) {
    bench::NastyCurves nasty(501);
    for (int i = 0; i < 48; ++i) expect_right(nasty.next());
}

TEST(KnownCases, a_wrong_answer_is_judged_wrong) {
    const CurveCase c = bench::known_hard_cases()[1];  // two points
    auto found = *intersect(*curve_of(c.a), *curve_of(c.b));
    ASSERT_EQ(found.contacts.size(), 2u);
    EXPECT_EQ(bench::judge(c, found), Verdict::right);
    auto missed = found;
    missed.contacts.pop_back();
    EXPECT_EQ(bench::judge(c, missed), Verdict::wrong);
    missed.undecided.push_back({Interval{0, 1}, Interval{0, 1}});
    EXPECT_EQ(bench::judge(c, missed), Verdict::open);
    auto doubled = found;
    doubled.contacts.push_back(found.contacts[0]);
    EXPECT_EQ(bench::judge(c, doubled), Verdict::wrong);
    found.overlaps.push_back({});
    EXPECT_EQ(bench::judge(c, found), Verdict::wrong);
}

}  // namespace
}  // namespace freiform::test
