// STEP files of solids with one round face and others.
#pragma once
#include <freiform/core/result.hpp>

#include <string>
#include <string_view>

namespace freiform::test {

// A file around instances; #1 is the context, in millimetres and degrees.
inline std::string file_of(std::string_view data, std::string_view unit = ".MILLI.,.METRE.") {
    return text("ISO-10303-21;\nHEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');",
                "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;\nDATA;\n",
                "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#5))"
                "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2,#3))REPRESENTATION_CONTEXT('',''));\n"
                "#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(",
                unit,
                "));\n#3=(CONVERSION_BASED_UNIT('DEGREE',#4)NAMED_UNIT(*)PLANE_ANGLE_UNIT());\n"
                "#4=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925),#6);\n"
                "#5=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#2,'','');\n"
                "#6=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n",
                data, "ENDSEC;\nEND-ISO-10303-21;\n");
}

// A face on a surface between edges; instance #30 is the surface.
inline std::string solid_of(std::string_view faces, std::string_view rest) {
    return file_of(
        text("#10=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#11),#1);\n#11=MANIFOLD_SOLID_BREP('part',#12);\n"
             "#12=CLOSED_SHELL('',(",
             faces, "));\n", rest));
}

inline constexpr std::string_view kFrame =
    "#20=CARTESIAN_POINT('',(1.,2.,3.));\n#21=DIRECTION('',(0.,0.,1.));\n#22=DIRECTION('',(1.,0.,0.));\n"
    "#23=AXIS2_PLACEMENT_3D('',#20,#21,#22);\n";

// A disc, a lateral face and perhaps another disc; circles of radius r at heights 0 and h.
inline std::string round_solid(std::string_view surface, double top, bool tip) {
    const auto disc = [](int id, int edge, int plane, const char* sense, const char* same) {
        return text("#", id, "=ADVANCED_FACE('',(#", id + 1, "),#", plane, ",", same, ");\n#", id + 1,
                    "=FACE_OUTER_BOUND('',#", id + 2, ",.T.);\n#", id + 2, "=EDGE_LOOP('',(#", id + 3,
                    "));\n#", id + 3, "=ORIENTED_EDGE('',*,*,#", edge, ",", sense, ");\n");
    };
    const auto circle = [](int id, double z, double r) {
        return text("#", id, "=EDGE_CURVE('',#", id + 1, ",#", id + 1, ",#", id + 3, ",.T.);\n#", id + 1,
                    "=VERTEX_POINT('',#", id + 2, ");\n#", id + 2, "=CARTESIAN_POINT('',(", 1 + r, ",2.,", z,
                    "));\n#", id + 3, "=CIRCLE('',#", id + 4, ",", r, ");\n#", id + 4,
                    "=AXIS2_PLACEMENT_3D('',#", id + 5, ",#21,#22);\n#", id + 5,
                    "=CARTESIAN_POINT('',(1.,2.,", z, "));\n#", id + 6, "=PLANE('',#", id + 4, ");\n");
    };
    std::string rest =
        text(kFrame, "#30=", surface, ";\n", circle(100, 3, 2), disc(40, 100, 106, ".F.", ".F."));
    if (!tip) rest += circle(110, 3 + top, 2) + disc(50, 110, 116, ".T.", ".T.");
    rest += "#60=ADVANCED_FACE('',(#61";
    if (!tip) rest += ",#62";
    rest +=
        "),#30,.T.);\n#61=FACE_BOUND('',#63,.T.);\n#63=EDGE_LOOP('',(#64));\n#64=ORIENTED_EDGE('',*,*,#100,."
        "T.);\n";
    if (!tip)
        rest +=
            "#62=FACE_BOUND('',#65,.T.);\n#65=EDGE_LOOP('',(#66));\n#66=ORIENTED_EDGE('',*,*,#110,.F.);\n";
    return solid_of(tip ? "#40,#60" : "#40,#50,#60", rest);
}

}  // namespace freiform::test
