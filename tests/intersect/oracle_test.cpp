// The intersections of dhermes/bezier's functional tests: parameters, and what kind they are of.
#include "corpus.hpp"
#include "plane_curves.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using nlohmann::json;

// An integer, "3/8" or "0x1.8p-1".
double number_of(const json& j) {
    if (j.is_number()) return j.get<double>();
    const std::string s = j.get<std::string>();
    const std::size_t slash = s.find('/');
    if (slash == std::string::npos) return std::strtod(s.c_str(), nullptr);
    return std::strtod(s.c_str(), nullptr) / std::strtod(s.c_str() + slash + 1, nullptr);
}

// Of two tests, control points such as 1/10 are no doubles, and a contact in exact numbers may be missed, or
// found twice, by a few units in the last place.
bool is_rounded(int id) { return id == 46; }

Plane curve_of(const json& all, const std::string& id) {
    const json& p = all[id]["control_points"];
    std::vector<Vec<2>> net;
    for (std::size_t i = 0; i < p[0].size(); ++i) net.push_back({{number_of(p[0][i]), number_of(p[1][i])}});
    return plane_bezier(std::move(net));
}

TEST(Oracle, all_intersections_of_the_corpus_are_found_and_no_others) {
    FF_CORPUS_OR_SKIP(folder, "oracle/dhermes_bezier");
    std::ifstream pairs_file(folder / "curve_intersections.json"), curves_file(folder / "curves.json");
    const json pairs = json::parse(pairs_file), curves = json::parse(curves_file);
    ASSERT_GT(pairs.size(), 30u);
    for (const json& pair : pairs) {
        const int id = pair["id"];
        const std::string type = pair["type"];
        const PlaneAnswer found = meet(curve_of(curves, pair["curve1"]), curve_of(curves, pair["curve2"]));
        EXPECT_TRUE(found.undecided.empty()) << id;
        EXPECT_TRUE(found.overlaps.empty()) << id;
        const auto& a = pair["curve1_params"];
        const auto& b = pair["curve2_params"];
        if (!is_rounded(id)) EXPECT_EQ(found.contacts.size(), a.size()) << id;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double s = number_of(a[i]), t = number_of(b[i]);
            const auto hit = std::find_if(found.contacts.begin(), found.contacts.end(), [&](const auto& c) {
                return std::abs(c.at[0] - s) < 1e-8 && std::abs(c.at[1] - t) < 1e-8;
            });
            ASSERT_NE(hit, found.contacts.end()) << id << ": " << s << " " << t;
            EXPECT_TRUE(hit->is_proven()) << id;
            const bool end = s == 0 || s == 1 || t == 0 || t == 1;
            const bool tangent = type == "tangent" && !is_rounded(id);
            EXPECT_EQ(name_of(hit->kind), end ? "end" : tangent ? "tangent" : "crossing") << id;
            if (tangent) EXPECT_GE(hit->multiplicity, 2) << id;
        }
    }
}

}  // namespace
}  // namespace freiform::test
