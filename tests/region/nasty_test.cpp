// A hundred pairs of paths that are made to be hard, by the laws of Boolean operations.
#include <freiform/region/boolean.hpp>

#include <cmath>
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
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd}) {
            const NastyPair& pair = pairs[i];
            SCOPED_TRACE(text(i, ": ", pair.name, ", ", rule == FillRule::nonzero ? "nonzero" : "evenodd"));
            const auto r =
                break_laws({pair.a, rule}, {pair.b, rule}, random, {.tolerance = pair.tolerance}, 10);
            EXPECT_FALSE(r) << r->where << ": " << r->message;
        }
}

// Both end in nearly the same cubic: a lens that is a millionth long and thinner than a last bit, and two
// crossings at so small an angle that doubles tell their places up to 1e-9 only.
TEST(Combine, lenses_that_are_thinner_than_numbers_and_longer_than_the_tolerance_are_no_obstacle) {
    const auto hook = [](double from, double to) {
        Path path;
        path.subpaths.emplace_back();
        Subpath& s = path.subpaths[0];
        s.closed = true, s.start = {{51.615, from}};
        s.segments.push_back({3, {s.start, s.start, {{50.485, -54.942}}, {{51.332, to}}}, 1});
        return path;
    };
    const double end = -53.388;
    const Path a = hook(-62.428, end), b = hook(-62.389, std::nextafter(std::nextafter(end, -100.0), -100.0));
    for (const RegionOptions& options :
         {RegionOptions{.tolerance = 1e-9}, RegionOptions{.tolerance = 1e-10}}) {
        std::array<double, 4> areas{};
        for (const RegionOperation o : {RegionOperation::union_of, RegionOperation::intersection,
                                        RegionOperation::difference, RegionOperation::exclusion}) {
            const auto r = combine({a}, {b}, o, options);
            ASSERT_TRUE(r) << r.error().where << " " << r.error().message;
            EXPECT_LE(r->bound, options.tolerance);
            areas[std::size_t(o)] = signed_area(r->path).value;
        }
        EXPECT_NEAR(areas[0] - areas[1], areas[3], 1e-12);
        EXPECT_NEAR(areas[2] + areas[1], -signed_area(a).value, 1e-10);  // clockwise
    }
}

}  // namespace
}  // namespace freiform
