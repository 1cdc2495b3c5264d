// STEP files of one representation whose items are not part of any solid.
#pragma once
#include "random.hpp"
#include "refusal.hpp"
#include "step_polygons.hpp"

#include <freiform/io/step_read.hpp>

#include <string>
#include <string_view>

namespace freiform::test {

// The items of one representation; #21 is the direction of z, #22 that of x, #24 that of y, #23 the frame at
// the origin, #30.. are the points (0, 0), (1, 2), (2, 0), (3, 1), (4, 0), (5, -1), (6, 0) of z = 0.
inline std::string item_file(std::string_view items, std::string_view more) {
    std::string s = text("#8=SHAPE_REPRESENTATION('',(", items,
                         "),#1);\n#21=DIRECTION('',(0.,0.,1.));\n#22=DIRECTION('',(1.,0.,0.));\n"
                         "#24=DIRECTION('',(0.,1.,0.));\n#23=AXIS2_PLACEMENT_3D('',#6,#21,#22);\n");
    constexpr double kHeights[] = {0, 2, 0, 1, 0, -1, 0};
    for (int i = 0; i < 7; ++i)
        s += text("#", 30 + i, "=CARTESIAN_POINT('',(", i, ".,", kHeights[i], ".,0.));\n");
    return flat_file(s += more);
}
inline Model items_model(std::string_view items, std::string_view more) {
    const Model m = must(read_step(item_file(items, more)));
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
    return m;
}
// Of the one curve #20, or the one surface #20.
inline Edge only_curve(std::string_view more) {
    const Model m = items_model("#10", text("#10=GEOMETRIC_CURVE_SET('',(#20));\n", more));
    EXPECT_EQ(m.edges.size(), 1u);
    EXPECT_TRUE(m.approximations.empty());
    return m.edges.at(0);
}
inline Face only_surface(std::string_view more) {
    const Model m = items_model("#10", text("#10=GEOMETRIC_SET('',(#20));\n", more));
    EXPECT_EQ(m.faces.size(), 1u);
    return m.faces.at(0);
}
inline void expect_near(const Vec<3>& a, const Vec<3>& b) { EXPECT_NEAR(norm(a - b), 0, 1e-14); }
inline Vec<3> point_at(const Edge& e, double t) { return jet<0>(*e.curve, t).value(); }
inline Vec<3> point_at(const Face& f, double u, double v) { return jet<0>(f.surface, {u, v}).value(); }

}  // namespace freiform::test
