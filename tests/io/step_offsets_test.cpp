// Offsets of offset surfaces: distances add up where that is proven.
#include <freiform/io/step_read.hpp>

#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// A surface #30 in a set, trimmed; #21 is its offset by `inner`, #20 that of #21 by `outer`.
std::string twice_offset_file(double inner, double outer, std::string_view surface) {
    return flat_file(
        text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=GEOMETRIC_SET('',(#19));\n"
             "#19=RECTANGULAR_TRIMMED_SURFACE('',#20,0.,1.,0.,1.,.T.,.T.);\n#20=OFFSET_SURFACE('',#21,",
             outer, ",.F.);\n#21=OFFSET_SURFACE('',#30,", inner, ",.F.);\n#30=", surface,
             ";\n#41=CARTESIAN_POINT('',(0.,0.,0.));\n#42=CARTESIAN_POINT('',(0.,1.,0.));\n"
             "#43=CARTESIAN_POINT('',(1.,0.,0.));\n#44=CARTESIAN_POINT('',(1.,1.,1.));\n"
             "#50=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#6,2.,$);\n#51=CYLINDRICAL_SURFACE('',#5,1.)"
             ";\n"));
}
Vec<3> corner_of(const Model& m) { return jet<0>(m.faces.at(0).surface, {0, 0}).value(); }

void expect_refused(double inner, double outer, std::string_view surface) {
    expect_refusal(read_step(twice_offset_file(inner, outer, surface)), RefusalKind::unsupported,
                   "#19 RECTANGULAR_TRIMMED_SURFACE",
                   "#20 OFFSET_SURFACE: is the offset of #21 OFFSET_SURFACE, whose normal is not proven");
}

TEST(StepOffsets, distances_add_up_where_no_offset_turns_the_normal) {
    const auto corner = [](double inner, double outer, std::string_view surface) {
        return corner_of(must(read_step(twice_offset_file(inner, outer, surface))));
    };
    EXPECT_NEAR(norm(corner(-3, 1, "PLANE('',#5)") - Vec<3>{{0, 0, -2}}), 0, 1e-14);
    EXPECT_NEAR(corner(-0.5, 2, "CYLINDRICAL_SURFACE('',#5,1.)")[0], 2.5, 1e-14);
    EXPECT_NEAR(corner(0.5, 2, "SPHERICAL_SURFACE('',#5,1.)")[0], 3.5, 1e-14);
    EXPECT_NEAR(corner(0.5, -0.25, "TOROIDAL_SURFACE('',#5,3.,1.)")[0], 4.25, 1e-14);
    // A cylinder of radius 2 below, made by a replica.
    EXPECT_NEAR(corner(-1.5, 1, "SURFACE_REPLICA('',#51,#50)")[0], 1.5, 1e-14);
}

TEST(StepOffsets, offsets_of_what_turns_the_normal_or_may_are_refused_by_their_number) {
    // The inner one is a cylinder about the same axis whose normal points inward: 2 outward of it is not 1.
    expect_refused(-2, 2.5, "CYLINDRICAL_SURFACE('',#5,1.)");
    expect_refused(-1, 2.5, "CYLINDRICAL_SURFACE('',#5,1.)");
    expect_refused(-2, 2.5, "SPHERICAL_SURFACE('',#5,1.)");
    expect_refused(2, -1.5, "TOROIDAL_SURFACE('',#5,3.,1.)");
    expect_refused(-1.5, 1, "TOROIDAL_SURFACE('',#5,3.,1.)");
    expect_refused(-2.5, 3, "SURFACE_REPLICA('',#51,#50)");
    expect_refused(0.01, 0.01, "BEZIER_SURFACE('',1,1,((#41,#42),(#43,#44)),.UNSPECIFIED.,.F.,.F.,.F.)");
    // One distance of 0 is none.
    const Model m = must(read_step(twice_offset_file(
        0, 0.01, "BEZIER_SURFACE('',1,1,((#41,#42),(#43,#44)),.UNSPECIFIED.,.F.,.F.,.F.)")));
    EXPECT_EQ(m.faces.size(), 1u);
    EXPECT_NEAR(norm(corner_of(m) - Vec<3>{{0, 0, 0.01}}), 0, 1e-14);
}

}  // namespace
}  // namespace freiform::test
