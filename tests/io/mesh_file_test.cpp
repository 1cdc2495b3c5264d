#include "support/mesh_bytes.hpp"
#include "support/test_meshes.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>

namespace freiform {
namespace {

using test::bytes_of;
using test::kMeshFormats;
namespace fs = std::filesystem;

TriangleMesh read_back(const TriangleMesh& mesh, MeshFormat format) {
    auto r = parse_mesh(bytes_of(mesh, format), format, "file");
    EXPECT_TRUE(r) << (r ? "" : text(r.error().where, ": ", r.error().message));
    return r.value_or(TriangleMesh{});
}

bool is_sound(const TriangleMesh& mesh) {
    const MeshTopology t = topology(mesh);
    return validate(mesh) && t.open_edges == 0 && t.non_manifold_edges == 0 && t.misoriented_edges == 0;
}

// The corners of all triangles, in order, as the format rounds them.
std::vector<Vec<3>> corners(const TriangleMesh& mesh, bool as_float) {
    std::vector<Vec<3>> out;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int p : mesh.points_of(t)) {
            Vec<3> x = mesh.points[std::size_t(p)];
            if (as_float)
                for (double& c : x.c) c = float(c);
            out.push_back(x);
        }
    return out;
}

TEST(Units, of_all_readers_are_known_in_metres) {
    const std::pair<const char*, double> units[] = {
        {"mm", 1e-3},           {"Inch", 0.0254}, {"yd", 0.9144},      {"mi", 1609.344},
        {"microinch", 2.54e-8}, {"Mm", 1e6},      {"angstrom", 1e-10}, {"1e-12 m", 1e-12}};
    for (const auto& [word, metres] : units) EXPECT_EQ(metres_per(word), metres) << word;
    for (const char* word : {"", "furlong", " m", "-1 m", "nan m"}) EXPECT_FALSE(metres_per(word)) << word;
}

TEST(MeshFile, every_format_gives_back_the_same_corners_and_a_closed_mesh) {
    for (const TriangleMesh& mesh : {test::torus(40, 20), test::sphere(12, 20), test::cube()})
        for (MeshFormat format : kMeshFormats) {
            const TriangleMesh back = read_back(mesh, format);
            const bool as_float = format == MeshFormat::glb || format == MeshFormat::stl;
            EXPECT_EQ(corners(back, false), corners(mesh, as_float)) << int(format);
            EXPECT_EQ(back.points.size(), mesh.points.size());
            EXPECT_TRUE(is_sound(back)) << int(format);
            EXPECT_EQ(back.unit, "mm");
        }
}

int faces_of_obj(const TriangleMesh& mesh, std::size_t corners) {
    int count = 0;
    const std::string obj = bytes_of(mesh, MeshFormat::obj);
    for (std::size_t at = 0; (at = obj.find("\nf ", at)) != std::string::npos; ++at) {
        const std::string line = obj.substr(at + 1, obj.find('\n', at + 1) - at - 1);
        count += std::size_t(std::count(line.begin(), line.end(), ' ')) == corners;
    }
    return count;
}

TEST(MeshFile, quads_are_kept_where_the_format_has_them_and_give_back_their_halves) {
    TriangleMesh mesh = test::torus(40, 20);
    mesh.parts[0].quads = 790;
    for (MeshFormat format : kMeshFormats) {
        const TriangleMesh back = read_back(mesh, format);
        const bool as_float = format == MeshFormat::glb || format == MeshFormat::stl;
        EXPECT_EQ(corners(back, false), corners(mesh, as_float)) << int(format);
        EXPECT_TRUE(is_sound(back)) << int(format);
    }
    EXPECT_EQ(faces_of_obj(mesh, 4), 790);
    EXPECT_EQ(faces_of_obj(mesh, 3), 20);
    EXPECT_NE(bytes_of(mesh, MeshFormat::ply).find("element face 810\n"), std::string::npos);

    TriangleMesh pinched = mesh;  // a half of two of the quads at this point has no area
    pinched.points[0] = pinched.points[1];
    EXPECT_EQ(faces_of_obj(pinched, 4), 788);
    EXPECT_EQ(faces_of_obj(pinched, 3), 20 + 2) << "the other halves";
    EXPECT_TRUE(read_back(pinched, MeshFormat::ply).triangles.size() == 1600 - 2);

    std::swap(mesh.triangles[4], mesh.triangles[5]);
    ASSERT_FALSE(validate(mesh));
    EXPECT_EQ(validate(mesh).error().where, "parts[0].quads");
    mesh.parts[0].quads = 801;
    EXPECT_FALSE(validate(mesh));
}

TEST(MeshFile, normals_survive_where_the_format_has_them) {
    const TriangleMesh mesh = test::torus(40, 20);
    for (MeshFormat format : {MeshFormat::glb, MeshFormat::obj, MeshFormat::ply}) {
        const TriangleMesh back = read_back(mesh, format);
        ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_LT(norm(back.vertices[std::size_t(back.triangles[t][i])].normal -
                               mesh.vertices[std::size_t(mesh.triangles[t][i])].normal),
                          1e-6);
    }
}

TEST(MeshFile, glb_is_in_metres_with_y_up) {
    std::string bytes = bytes_of(test::cube(), MeshFormat::glb);
    const auto marker = bytes.find("freiform_unit");
    ASSERT_NE(marker, std::string::npos);
    bytes[marker] = 'x';  // now it is a file like any other, and the matrix of its root counts
    const auto back = parse_mesh(bytes, MeshFormat::glb, "file");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->unit, "m");
    auto expected = corners(test::cube(), false);
    for (Vec<3>& p : expected) p *= 1e-3;
    EXPECT_EQ(corners(*back, false), expected);
}

TEST(MeshFile, parts_may_share_vertices) {
    TriangleMesh mesh = test::torus(12, 8);
    mesh.parts[0].count = 50;
    mesh.parts.push_back({"rest", Colour{0, 0, 1, 1}, 50, int(mesh.triangles.size()) - 50, 1});
    for (MeshFormat format : kMeshFormats)
        EXPECT_EQ(corners(read_back(mesh, format), true), corners(mesh, true)) << int(format);
}

TEST(MeshFile, names_and_colours_survive_in_glb_and_obj) {
    const TriangleMesh mesh = test::cube();
    for (MeshFormat format : {MeshFormat::glb, MeshFormat::obj}) {
        const TriangleMesh back = read_back(mesh, format);
        ASSERT_EQ(back.parts.size(), 6u);
        for (std::size_t i = 0; i < 6; ++i) {
            std::string name = mesh.parts[i].name;
            if (format == MeshFormat::obj) std::replace(name.begin(), name.end(), ' ', '_');
            EXPECT_EQ(back.parts[i].name, name);
            ASSERT_EQ(back.parts[i].colour.has_value(), mesh.parts[i].colour.has_value());
            if (!mesh.parts[i].colour) continue;
            const Colour &a = *back.parts[i].colour, &b = *mesh.parts[i].colour;
            EXPECT_LT(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) + std::abs(a.a - b.a),
                      1e-14);
        }
    }
    const TriangleMesh ply = read_back(mesh, MeshFormat::ply);
    ASSERT_EQ(ply.parts.size(), 6u);
    EXPECT_EQ(ply.parts[1].colour, (Colour{0, 0, 1, 1}));
}

TEST(MeshFile, doubles_come_back_bit_for_bit_from_obj_and_ply) {
    std::mt19937_64 random(1);
    TriangleMesh mesh;
    while (mesh.points.size() < 30000) {
        Vec<3> p;
        for (double& x : p.c) do
                x = std::bit_cast<double>(random());
            while (!std::isfinite(x));
        mesh.vertices.push_back({int(mesh.points.size()), {}, {}});
        mesh.points.push_back(p);
    }
    for (int i = 0; i < 30000; i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
    for (MeshFormat format : {MeshFormat::obj, MeshFormat::ply})
        EXPECT_EQ(corners(read_back(mesh, format), false), corners(mesh, false));
}

TEST(MeshFile, collapsed_triangles_are_left_out_and_thin_ones_are_kept) {
    TriangleMesh mesh = test::cube();
    mesh.parts.clear();
    // Between two points that only a double tells apart: rounding closes the slit.
    mesh.points.push_back(mesh.points[1] + Vec<3>{{1e-12, 0, 0}});
    mesh.vertices.push_back({8, {}, {}});
    mesh.triangles.push_back({3, 24, 0});
    mesh.triangles.push_back({1, 1, 2});
    EXPECT_EQ(read_back(mesh, MeshFormat::stl).triangles.size(), 12u);
    EXPECT_EQ(read_back(mesh, MeshFormat::glb).triangles.size(), 12u);
    EXPECT_EQ(read_back(mesh, MeshFormat::obj).triangles.size(), 13u);
    EXPECT_EQ(read_back(mesh, MeshFormat::ply).triangles.size(), 13u);
}

TEST(MeshFile, glb_holds_models_that_floats_would_spoil) {
    const TriangleMesh unit = test::torus(24, 12);
    for (const auto& [shift, scale] : {std::pair(1e7, 1.0), std::pair(0.0, 1e-60), std::pair(0.0, 1e60),
                                       std::pair(-3e30, 1e25), std::pair(0.0, 1e305)}) {
        TriangleMesh mesh = unit;
        for (Vec<3>& p : mesh.points)
            for (double& x : p.c) x = x * scale + shift;
        const TriangleMesh back = read_back(mesh, MeshFormat::glb);
        EXPECT_TRUE(is_sound(back));
        ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
        const auto a = corners(mesh, false), b = corners(back, false);
        for (std::size_t i = 0; i < a.size(); ++i)
            ASSERT_LE(max_abs(a[i] - b[i]), 6 * scale * 0x1p-20) << shift << " " << scale;
    }
}

TEST(MeshFile, stl_refuses_what_a_float_cannot_hold) {
    TriangleMesh mesh = test::cube();
    mesh.points[3][1] = 1e39;
    const auto large = to_stl(mesh);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().kind, RefusalKind::limit);
    EXPECT_EQ(large.error().where, "points[3]");
    for (Vec<3>& p : mesh.points) p *= 1e-80;
    EXPECT_FALSE(to_stl(mesh));
    EXPECT_TRUE(to_ply(mesh));
}

TEST(MeshFile, writers_refuse_a_broken_mesh) {
    TriangleMesh mesh = test::cube();
    mesh.points[3][1] = NAN;
    for (const auto& r : {to_glb(mesh), to_stl(mesh), to_obj(mesh), to_ply(mesh)}) {
        ASSERT_FALSE(r);
        EXPECT_EQ(r.error().kind, RefusalKind::nonfinite);
    }
}

TEST(MeshFile, mesh_without_triangles_is_written_and_read) {
    for (MeshFormat format : kMeshFormats) EXPECT_TRUE(read_back(TriangleMesh{}, format).triangles.empty());
}

TEST(MeshFile, stl_does_not_look_like_text_and_has_the_size_of_its_count) {
    const std::string bytes = bytes_of(test::cube(), MeshFormat::stl);
    EXPECT_EQ(bytes.size(), 84u + 12 * 50);
    EXPECT_FALSE(bytes.starts_with("solid"));
    float n[3];
    std::memcpy(n, bytes.data() + 84, sizeof n);
    EXPECT_EQ(n[2], -1);
}

TEST(MeshFile, endings_choose_the_format) {
    EXPECT_EQ(mesh_format("a.b/x.STL"), MeshFormat::stl);
    EXPECT_EQ(mesh_format("glb"), MeshFormat::glb);
    const auto unknown = mesh_format("x.step");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().kind, RefusalKind::unsupported);
    EXPECT_NE(unknown.error().message.find(".glb, .stl, .obj, .ply"), std::string::npos);
    const std::string path =
        (fs::temp_directory_path() / text("freiform-", std::random_device()(), ".ply")).string();
    ASSERT_TRUE(write_mesh(test::cube(), path));
    EXPECT_EQ(read_mesh(path)->triangles.size(), 12u);
    fs::remove(path);
    EXPECT_FALSE(write_mesh(test::cube(), "-"));
    EXPECT_FALSE(read_mesh("no/such/file.obj"));
}

}  // namespace
}  // namespace freiform
