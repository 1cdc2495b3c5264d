// STEP files of one plane face.
#pragma once
#include <freiform/core/result.hpp>

#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::test {

// In millimetres, with the tolerance 1e-4; #7 is the plane z = 0.
inline std::string flat_file(std::string_view data) {
    return text("ISO-10303-21;\nHEADER;FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;\nDATA;\n",
                "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3))"
                "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2))REPRESENTATION_CONTEXT('',''));\n"
                "#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
                "#3=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-4),#2,'','');\n"
                "#5=AXIS2_PLACEMENT_3D('',#6,$,$);\n#6=CARTESIAN_POINT('',(0.,0.,0.));\n#7=PLANE('',#5);\n",
                data, "ENDSEC;\nEND-ISO-10303-21;\n");
}

inline std::string replaced(std::string s, std::string_view what, std::string_view by) {
    const std::size_t at = s.find(what);
    EXPECT_NE(at, s.npos) << what;
    return at == s.npos ? s : s.replace(at, what.size(), by);
}

struct Corner {
    double x, y;
};

// A plane face #12 in the body #10 between corners: points #100.., vertices #200.., lines #300.., edges
// #400.., uses #500..
inline std::string polygon_file(const std::vector<Corner>& corners, std::string_view more = "") {
    std::string s =
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#14=EDGE_LOOP('',(";
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) s += text(i > 0 ? "," : "", "#", 500 + i);
    s += "));\n";
    for (std::size_t i = 0; i < n; ++i) {
        const Corner a = corners[i], b = corners[(i + 1) % n];
        s +=
            text("#", 100 + i, "=CARTESIAN_POINT('',(", a.x, ",", a.y, ",0.));\n#", 200 + i,
                 "=VERTEX_POINT('',#", 100 + i, ");\n#", 300 + i, "=LINE('',#", 100 + i, ",#", 600 + i,
                 ");\n#", 600 + i, "=VECTOR('',#", 700 + i, ",1.);\n#", 700 + i, "=DIRECTION('',(", b.x - a.x,
                 ",", b.y - a.y, ",0.));\n#", 400 + i, "=EDGE_CURVE('',#", 200 + i, ",#", 200 + (i + 1) % n,
                 ",#", 300 + i, ",.T.);\n#", 500 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.T.);\n");
    }
    return flat_file(s += more);
}

}  // namespace freiform::test
