// Tessellated items of STEP files.
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/step_read.hpp>

#include <cmath>
#include <filesystem>
#include <support/corpus.hpp>
#include <support/refusal.hpp>
#include <support/step_polygons.hpp>
#include <sys/resource.h>

namespace freiform::test {
namespace {

// A tetrahedron: #20 has its four corners; `items` are those of the representation.
std::string triangles_file(std::string_view items, std::string_view more) {
    return flat_file(text("#8=TESSELLATED_SHAPE_REPRESENTATION('',(", items, "),#1);\n",
                          "#20=COORDINATES_LIST('',4,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.)));\n",
                          more));
}
constexpr std::string_view kTetrahedron = "((1,3,2),(1,2,4),(2,3,4),(3,1,4))";

TriangleMesh must_mesh(const std::string& file) {
    auto m = read_step_mesh(file);
    EXPECT_TRUE(m) << m.error().where << ": " << m.error().message;
    return m ? *m : TriangleMesh{};
}
double volume_of(const TriangleMesh& m) {
    double sum = 0;
    for (const auto& t : m.triangles) {
        const auto at = [&](std::size_t k) {
            return m.points[std::size_t(m.vertices[std::size_t(t[k])].point)];
        };
        sum += dot(at(0), cross(at(1), at(2))) / 6;
    }
    return sum;
}
void expect_closed(const TriangleMesh& m) {
    const MeshTopology t = topology(m);
    EXPECT_EQ(t.open_edges, 0);
    EXPECT_EQ(t.misoriented_edges, 0);
}

TEST(StepMesh, a_solid_of_one_face_is_a_closed_mesh_with_its_name_and_unit) {
    const std::string file = triangles_file(
        "#10", text("#10=TESSELLATED_SOLID('s',(#11),$);\n#11=TRIANGULATED_FACE('f',#20,4,(),$,(),",
                    kTetrahedron, ");\n"));
    const TriangleMesh m = must_mesh(file);
    EXPECT_EQ(m.unit, "mm");
    ASSERT_EQ(m.parts.size(), 1u);
    EXPECT_EQ(m.parts[0].name, "f");
    EXPECT_EQ(m.triangles.size(), 4u);
    EXPECT_NEAR(volume_of(m), 1.0 / 6, 1e-15);
    expect_closed(m);
    EXPECT_TRUE(has_only_triangles(file));
    expect_refusal(read_step(file), RefusalKind::no_answer, "file", "triangles (1 tessellated items)");
}

TEST(StepMesh, a_table_of_indices_stands_between_corners_and_coordinates) {
    // The table exchanges two points, and so does the list of corners.
    const TriangleMesh m = must_mesh(triangles_file(
        "#11", "#11=TRIANGULATED_SURFACE_SET('',#20,4,(),(2,1,3,4),((2,3,1),(2,1,4),(1,3,4),(3,2,4)));\n"));
    EXPECT_NEAR(volume_of(m), 1.0 / 6, 1e-15);
    expect_closed(m);
}

TEST(StepMesh, strips_and_fans_keep_their_orientation) {
    // The four sides of the tetrahedron as one strip; as a fan and a triangle.
    const TriangleMesh strip = must_mesh(
        triangles_file("#11", "#11=COMPLEX_TRIANGULATED_FACE('',#20,4,(),$,(),((1,3,2,4,1,3)),());\n"));
    EXPECT_EQ(strip.triangles.size(), 4u);
    EXPECT_NEAR(volume_of(strip), 1.0 / 6, 1e-15);
    expect_closed(strip);
    const TriangleMesh fan = must_mesh(triangles_file(
        "#11", "#11=COMPLEX_TRIANGULATED_SURFACE_SET('',#20,4,(),(),((2,3,4)),((1,3,2,4,3)));\n"));
    EXPECT_NEAR(volume_of(fan), 1.0 / 6, 1e-15);
    expect_closed(fan);
    // A strip that repeats an entry goes on elsewhere.
    const TriangleMesh stitched = must_mesh(
        triangles_file("#11", "#11=COMPLEX_TRIANGULATED_FACE('',#20,4,(),$,(),((1,3,2,2,2,4)),());\n"));
    EXPECT_EQ(stitched.triangles.size(), 1u);
}

TEST(StepMesh, normals_belong_to_the_entries_of_the_table) {
    const TriangleMesh one =
        must_mesh(triangles_file("#11", "#11=TRIANGULATED_FACE('',#20,4,((0.,0.,-2.)),$,(),((1,3,2)));\n"));
    ASSERT_EQ(one.vertices.size(), 3u);
    for (const MeshVertex& v : one.vertices) EXPECT_EQ(v.normal, (Vec<3>{{0, 0, -1}}));
    const TriangleMesh each = must_mesh(triangles_file(
        "#11", "#11=TRIANGULATED_FACE('',#20,3,((1.,0.,0.),(0.,1.,0.),(0.,0.,1.)),$,(1,3,2),((1,2,3)));\n"));
    ASSERT_EQ(each.vertices.size(), 3u);
    for (const MeshVertex& v : each.vertices) {
        const Vec<3>& p = each.points[std::size_t(v.point)];
        const Vec<3> expected = p[1] == 1   ? Vec<3>{{0, 1, 0}}
                                : p[0] == 1 ? Vec<3>{{0, 0, 1}}
                                            : Vec<3>{{1, 0, 0}};
        EXPECT_EQ(v.normal, expected);
    }
}

TEST(StepMesh, mapped_items_put_triangles_where_they_are_and_mirrors_keep_them_outward) {
    const std::string mapped =
        "#9=SHAPE_REPRESENTATION('',(#30,#31),#1);\n#40=REPRESENTATION_MAP(#5,#8);\n"
        "#30=MAPPED_ITEM('',#40,#41);\n#31=MAPPED_ITEM('',#40,#5);\n"
        "#41=AXIS2_PLACEMENT_3D('',#42,$,$);\n#42=CARTESIAN_POINT('',(10.,0.,0.));\n";
    const TriangleMesh m = must_mesh(
        triangles_file("#11", text("#11=TRIANGULATED_FACE('',#20,4,(),$,(),", kTetrahedron, ");\n", mapped)));
    EXPECT_EQ(m.triangles.size(), 8u);
    EXPECT_NEAR(volume_of(m), 2.0 / 6, 1e-12);
    expect_closed(m);
    double most = 0;
    for (const Vec<3>& p : m.points) most = std::max(most, p[0]);
    EXPECT_EQ(most, 11);
    const TriangleMesh mirrored = must_mesh(triangles_file(
        "#11", text("#11=TRIANGULATED_FACE('',#20,4,((0.,0.,1.)),$,(),", kTetrahedron,
                    ");\n#9=SHAPE_REPRESENTATION('',(#30),#1);\n#40=REPRESENTATION_MAP(#5,#8);\n"
                    "#30=MAPPED_ITEM('',#40,#50);\n#51=DIRECTION('',(0.,-1.,0.));\n"
                    "#50=CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,$,#51,#6,2.,$);\n")));
    EXPECT_NEAR(volume_of(mirrored), 8.0 / 6, 1e-12);
    double least = 0;
    for (const Vec<3>& p : mirrored.points) least = std::min(least, p[1]);
    EXPECT_EQ(least, -2);
}

TEST(StepMesh, repositioned_items_are_in_the_frame_that_they_name_and_frames_nest) {
    // Up by 5 in a frame whose z points along x: that is along x.
    const TriangleMesh m = must_mesh(triangles_file(
        "#10", text("#10=(GEOMETRIC_REPRESENTATION_ITEM()REPOSITIONED_TESSELLATED_ITEM(#50)"
                    "REPRESENTATION_ITEM('')TESSELLATED_GEOMETRIC_SET((#12,#13))TESSELLATED_ITEM());\n"
                    "#12=(GEOMETRIC_REPRESENTATION_ITEM()REPOSITIONED_TESSELLATED_ITEM(#60)"
                    "REPRESENTATION_ITEM('')TESSELLATED_GEOMETRIC_SET((#13))TESSELLATED_ITEM());\n"
                    "#50=AXIS2_PLACEMENT_3D('',#6,#51,#52);\n#51=DIRECTION('',(1.,0.,0.));\n"
                    "#52=DIRECTION('',(0.,1.,0.));\n#60=AXIS2_PLACEMENT_3D('',#61,$,$);\n"
                    "#61=CARTESIAN_POINT('',(0.,0.,5.));\n#13=TRIANGULATED_FACE('',#20,4,((0.,0.,1.)),$,(),",
                    kTetrahedron, ");\n")));
    ASSERT_EQ(m.triangles.size(), 8u);
    EXPECT_NEAR(volume_of(m), 2.0 / 6, 1e-14);
    expect_closed(m);
    Box<3> box;
    for (const Vec<3>& p : m.points) box.add(p);
    EXPECT_EQ(box.lo, (Vec<3>{{0, 0, 0}}));
    EXPECT_EQ(box.hi, (Vec<3>{{6, 1, 1}}));
    for (const MeshVertex& v : m.vertices) EXPECT_EQ(v.normal, (Vec<3>{{1, 0, 0}}));
    expect_refusal(
        read_step_mesh(triangles_file("#10",
                                      "#10=(REPOSITIONED_TESSELLATED_ITEM(#20)REPRESENTATION_ITEM('')"
                                      "TESSELLATED_GEOMETRIC_SET(())TESSELLATED_ITEM());\n")),
        RefusalKind::unreadable, "#20 COORDINATES_LIST", "not of the type");
}

TEST(StepMesh, where_there_are_exact_faces_the_triangles_are_counted_and_not_used) {
    const std::string file =
        polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}},
                     text("#19=TESSELLATED_SHAPE_REPRESENTATION('',(#811,#812),#1);\n"
                          "#820=COORDINATES_LIST('',4,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.)));\n"
                          "#811=TRIANGULATED_SURFACE_SET('',#820,4,(),(),",
                          kTetrahedron, ");\n#812=TESSELLATED_SHELL('',(#811),$);\n"));
    const auto m = read_step(file);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_EQ(m->faces.size(), 1u);
    ASSERT_EQ(m->refused.size(), 1u);
    EXPECT_EQ(m->refused[0].where, "file");
    EXPECT_EQ(m->refused[0].message, "2 tessellated items are left out, beside shapes that are exact");
    EXPECT_FALSE(has_only_triangles(file));
}

TEST(StepMesh, what_contradicts_itself_is_refused_by_the_number_of_the_instance) {
    const auto refused = [](std::string_view face, RefusalKind kind, std::string_view where,
                            std::string_view message) {
        expect_refusal(read_step_mesh(triangles_file("#11", face)), kind, where, message);
    };
    constexpr auto kBad = RefusalKind::invalid;
    refused("#11=TRIANGULATED_FACE('',#20,4,(),$,(),((1,2,5)));\n", kBad, "#11 TRIANGULATED_FACE",
            "corners is 5");
    refused("#11=TRIANGULATED_FACE('',#20,4,(),$,(),((0,1,2)));\n", kBad, "#11 TRIANGULATED_FACE",
            "corners is 0");
    refused("#11=TRIANGULATED_FACE('',#20,4,(),$,(),((1,2,2.5)));\n", kBad, "#11 TRIANGULATED_FACE", "2.5");
    refused("#11=TRIANGULATED_FACE('',#20,4,(),$,(),((1,2)));\n", kBad, "#11 TRIANGULATED_FACE", "2 corners");
    refused("#11=TRIANGULATED_FACE('',#20,4,(),$,(),((1,2,3,4)));\n", kBad, "#11 TRIANGULATED_FACE",
            "4 corners");
    refused("#11=TRIANGULATED_FACE('',#20,3,(),$,(),((1,2,3)));\n", kBad, "#11 TRIANGULATED_FACE",
            "says that it has 3 points, and has 4");
    refused("#11=TRIANGULATED_FACE('',#20,3,(),$,(1,2,9),((1,2,3)));\n", kBad, "#11 TRIANGULATED_FACE",
            "indices of points is 9");
    refused("#11=TRIANGULATED_FACE('',#20,3,(),$,(1,2,3),((1,2,4)));\n", kBad, "#11 TRIANGULATED_FACE",
            "from 1 to 3");
    refused("#11=TRIANGULATED_FACE('',#20,4,((0.,0.,1.),(0.,0.,1.)),$,(),((1,2,3)));\n", kBad,
            "#11 TRIANGULATED_FACE", "2 normals for 4 points");
    refused("#11=TRIANGULATED_FACE('',#21,4,(),$,(),((1,2,3)));\n#21=COORDINATES_LIST('',4,((0.,0.,0.)));\n",
            kBad, "#21 COORDINATES_LIST", "says that it has 4 points, and has 1");
    refused(
        "#11=TRIANGULATED_FACE('',#21,1,(),$,(),((1,1,1)));\n#21=COORDINATES_LIST('',1,((0.,1.E999,0.)));\n",
        RefusalKind::unreadable, "#21 COORDINATES_LIST", "no number that a double can hold");
    refused("#11=TRIANGULATED_FACE('',#21,1,(),$,(),((1,1,1)));\n#21=COORDINATES_LIST('',1,((0.,0.)));\n",
            RefusalKind::unreadable, "#21 COORDINATES_LIST", "has 2 numbers");
    refused("#11=TRIANGULATED_FACE('',#99,4,(),$,(),((1,2,3)));\n", RefusalKind::unreadable,
            "#11 TRIANGULATED_FACE", "#99, which is not in the file");
    refused("#11=CUBIC_BEZIER_TRIANGULATED_FACE('',#20,4,(),$,((1,2,3,4,1,2,3,4,1,2)));\n",
            RefusalKind::unsupported, "#11 CUBIC_BEZIER_TRIANGULATED_FACE", "curved triangles");
    refused("#11=TESSELLATED_SHELL('',(#12),$);\n#12=TESSELLATED_SHELL('',(#11),$);\n", kBad,
            "#11 TESSELLATED_SHELL", "contains itself");
    refused("#11=TESSELLATED_CURVE_SET('',#20,((1,2,3)));\n", RefusalKind::no_answer, "file", "no triangles");
}

long peak_kilobytes() {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
}

TEST(StepMesh, sets_that_name_themselves_many_times_take_little_memory) {
    std::string many = "#10";
    for (int i = 0; i < 5000; ++i) many += ",#10";
    const long before = peak_kilobytes();
    expect_refusal(
        read_step_mesh(triangles_file("#10", text("#10=TESSELLATED_GEOMETRIC_SET('',(", many, "));\n"))),
        RefusalKind::invalid, "#10 TESSELLATED_GEOMETRIC_SET", "contains itself");
    expect_refusal(read_step(flat_file(
                       text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=GEOMETRIC_SET('',(", many, "));\n"))),
                   RefusalKind::invalid, "#10 GEOMETRIC_SET", "contains itself");
    EXPECT_LT(peak_kilobytes() - before, 32'000);
}

TEST(StepMesh, limits_hold) {
    const std::string file =
        triangles_file("#11", text("#11=TRIANGULATED_FACE('',#20,4,(),$,(),", kTetrahedron, ");\n"));
    MeshReadOptions three;
    three.max_triangles = 3;
    expect_refusal(read_step_mesh(file, three), RefusalKind::limit, "#11 TRIANGULATED_FACE",
                   "more triangles");
}

TEST(StepMesh, a_file_of_another_program_is_read_by_its_name) {
    FF_CORPUS_OR_SKIP(path, "step_micro/ap242_tessellated_open_solid.stp");
    const auto m = read_mesh(path.string());
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_EQ(m->triangles.size(), 1u);
    EXPECT_EQ(m->points.size(), 3u);
}

}  // namespace
}  // namespace freiform::test
