// The same interpolants as SciPy's, from tests/data/scipy_splines.py.
#include "support/random.hpp"

#include <freiform/fit/interpolate.hpp>
#include <freiform/fit/local.hpp>

#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace freiform {
namespace {

using test::must;

class Scipy : public testing::Test {
protected:
    void SetUp() override {
        std::ifstream in(std::string(FREIFORM_SOURCE_DIR) + "/tests/data/scipy_splines.txt");
        ASSERT_TRUE(in);
        for (std::string line; std::getline(in, line);) {
            if (line.starts_with('#')) continue;
            std::istringstream s(line);
            std::string name;
            int columns = 0;
            s >> name >> columns;
            for (double x; s >> x;) table_[name].push_back(x);
        }
        for (const char* name : {"points", "rising", "slopes"})
            for (std::size_t i = 0; i < table_[name].size(); i += 2)
                vectors_[name].push_back({{table_[name][i], table_[name][i + 1]}});
    }
    void expect_same(const std::string& name, const Curve<Vec<2>>& c) {
        const auto &t = table_["samples"], &x = table_[name];
        ASSERT_EQ(x.size(), 2 * t.size());
        for (std::size_t i = 0; i < t.size(); ++i)
            for (std::size_t k = 0; k < 2; ++k)
                EXPECT_NEAR(c(t[i])[int(k)], x[2 * i + k], 1e-13) << name << " at " << t[i];
    }
    std::map<std::string, std::vector<double>> table_;
    std::map<std::string, std::vector<Vec<2>>> vectors_;
};

TEST_F(Scipy, cubic_splines_agree) {
    const auto& q = vectors_["points"];
    const auto& s = vectors_["slopes"];
    const auto& at = table_["at"];
    expect_same("natural", must(interpolate<2>(q, {3, SplineEnds::natural, at})).patch);
    expect_same("not-a-knot", must(interpolate<2>(q, {3, SplineEnds::not_a_knot, at})).patch);
    expect_same("clamped", must(interpolate<2>(q, {3, SplineEnds::clamped, at}, std::span(s).first(1),
                                               std::span(s).last(1)))
                               .patch);
    expect_same("periodic",
                must(interpolate<2>(std::span(q).first(q.size() - 1), {3, SplineEnds::periodic, at})).patch);
}

TEST_F(Scipy, other_degrees_agree) {
    const auto& q = vectors_["points"];
    const auto& at = table_["at"];
    expect_same("not-a-knot_2", must(interpolate<2>(q, {2, SplineEnds::not_a_knot, at})).patch);
    expect_same("not-a-knot_5", must(interpolate<2>(q, {5, SplineEnds::not_a_knot, at})).patch);
}

TEST_F(Scipy, local_slopes_agree) {
    const auto& at = table_["at"];
    const auto curve = [&](const std::vector<Vec<2>>& q, LocalSlopes kind) {
        return must(cubic_through<2>(q, must(local_slopes<2>(q, at, kind)), at));
    };
    expect_same("akima", curve(vectors_["points"], LocalSlopes::akima));
    expect_same("monotone", curve(vectors_["rising"], LocalSlopes::monotone));
}

}  // namespace
}  // namespace freiform
