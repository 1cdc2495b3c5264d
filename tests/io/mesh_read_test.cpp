// Meshes that other programs have written, and damaged ones.
#include "support/mesh_bytes.hpp"
#include "support/test_meshes.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace freiform {
namespace {

using test::bytes_of;
using test::kMeshFormats;

Result<TriangleMesh> parse(std::string_view bytes, MeshFormat format) {
    return parse_mesh(bytes, format, "f");
}

TEST(ReadMesh, obj_with_polygons_negative_indices_and_continued_lines) {
    const auto mesh = parse(
        "# c\r\nv 0 0 0\r\nv 1 0 0 1.0\nv 1 1 0\nvt 0 0\nvn 0 0 2\nf 1/1/1 2/1/1 \\\n 3/1/1 4/1/1\n"
        "v +0 1e0 -0.0\ng two\ns off\nusemtl x\nf -4 -1 -2 # tail\n",
        MeshFormat::obj);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 3u);
    EXPECT_EQ(mesh->points.size(), 4u);
    ASSERT_EQ(mesh->parts.size(), 2u);
    EXPECT_EQ(mesh->parts[1].name, "two");
    EXPECT_EQ(mesh->vertices[0].normal, (Vec<3>{{0, 0, 1}}));
}

TEST(ReadMesh, zero_and_minus_zero_are_one_point) {
    const auto mesh = parse("v 0 0 0\nv -0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\nf 2 4 3\n", MeshFormat::obj);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->points.size(), 3u);
    EXPECT_EQ(topology(*mesh).open_edges, 0);
}

TEST(ReadMesh, ply_as_text_with_foreign_elements) {
    const auto mesh = parse(
        "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar int k\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float quality\nproperty float z\n"
        "element face 1\nproperty uchar flag\nproperty list uchar uint vertex_index\nend_header\n"
        "2 7 8\n0 0 9 0\n1 0 9 0\n1 1 9 0\n0 1 9 0\n1 4 0 1 2 3\n",
        MeshFormat::ply);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 2u);
    EXPECT_EQ(mesh->points.size(), 4u);
}

TEST(ReadMesh, stl_as_text) {
    const auto mesh = parse(
        "solid a b\n facet normal nan 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n"
        " vertex 0 1e-400 0\n endloop\n ENDFACET\nendsolid a b\nsolid\nendsolid\n",
        MeshFormat::stl);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->parts[0].name, "a b");
    EXPECT_EQ(mesh->points.size(), 2u);
}

struct Nonsense {
    MeshFormat format;
    const char* bytes;
    const char* where;
};

TEST(ReadMesh, nonsense_is_refused_with_its_place) {
    const Nonsense cases[] = {
        {MeshFormat::stl, "", "f"},
        {MeshFormat::stl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "f:4"},
        {MeshFormat::stl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", "f:4"},
        {MeshFormat::stl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop", "f:5"},
        {MeshFormat::stl, "solid\n", "f:2"},
        {MeshFormat::obj, "v 0 0\n", "f:1"},
        {MeshFormat::obj, "v 0 0 nan\n", "f:1"},
        {MeshFormat::obj, "v 0 0 0\nf 1 2 3\n", "f:2"},
        {MeshFormat::obj, "v 0 0 0\nf 1 0 1\n", "f:2"},
        {MeshFormat::obj, "v 0 0 0\n\nf 1 1 -2\n", "f:3"},
        {MeshFormat::obj, "v 0 0 0\nf 1//1 1//1 1//1\n", "f:2"},
        {MeshFormat::obj, "v 0 0 0\nf 1 1\n", "f:2"},
        {MeshFormat::obj, "v 0 0 0\nf 1 1 99999999999999999999\n", "f:2"},
        {MeshFormat::ply, "plx", "f:1"},
        {MeshFormat::ply, "ply\nformat binary_big_endian 1.0\n", "f:2"},
        {MeshFormat::ply, "ply\nformat ascii 1.0\nproperty float x\n", "f:3"},
        {MeshFormat::ply, "ply\nformat ascii 1.0\nelement vertex -1\n", "f:3"},
        {MeshFormat::ply, "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nend_header\n0",
         "f"},
        {MeshFormat::ply, "ply\nformat ascii 1.0\nelement vertex 1000000000\nend_header\n0", "f"},
        {MeshFormat::ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\nq ", "f:6"},
        {MeshFormat::ply,
         "ply\nformat ascii 1.0\nelement face 1\nproperty list char int vertex_index\nend_header\n-1 ",
         "f:6"},
        {MeshFormat::ply,
         "ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_index\nend_header\n3 0 1 2",
         "f"},
        {MeshFormat::ply,
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nelement face 1\n"
         "property list int int vertex_index\nend_header\n0\n2 0 0",
         "f:9"},
        {MeshFormat::glb, "glTF", "f"},
    };
    for (const Nonsense& c : cases) {
        const auto r = parse(c.bytes, c.format);
        ASSERT_FALSE(r) << c.bytes;
        EXPECT_EQ(r.error().where, c.where) << c.bytes << ": " << r.error().message;
        EXPECT_GT(r.error().message.size(), 10u);
    }
}

std::string glb_of(std::string json, const std::string& binary = "") {
    json.append((4 - json.size() % 4) % 4, ' ');
    std::string out("glTF\2\0\0\0", 8);
    const auto word = [&out](std::size_t w) {
        out.append({char(w), char(w >> 8), char(w >> 16), char(w >> 24)});
    };
    word(20 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
    word(json.size());
    out += "JSON" + json;
    if (binary.empty()) return out;
    word(binary.size());
    return out + std::string("BIN\0", 4) + binary;
}

// A triangle in the x-z plane of glTF, moved by one along x; `change` replaces the first match of a text.
std::string triangle_glb(std::string_view from = "", std::string_view to = "") {
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"mesh":0,"translation":[1,0,0]}],)"
        R"("meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
    if (const auto at = json.find(from); !from.empty() && at != std::string::npos)
        json.replace(at, from.size(), to);
    return glb_of(json, std::string(reinterpret_cast<const char*>(p), sizeof p));
}

TEST(ReadMesh, glb_of_another_program_is_turned_to_z_up) {
    const auto mesh = parse(triangle_glb(), MeshFormat::glb);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->unit, "m");
    EXPECT_EQ(mesh->points, (std::vector<Vec<3>>{{{1, 0, 0}}, {{2, 0, 0}}, {{1, -1, 0}}}));
    const auto mirrored = parse(triangle_glb("[1,0,0]", "[0,0,0],\"scale\":[-1,1,1]"), MeshFormat::glb);
    ASSERT_TRUE(mirrored);
    EXPECT_EQ(mirrored->points_of(0), (std::array{0, 2, 1}));
}

TEST(ReadMesh, damaged_glb_is_refused) {
    const std::pair<const char*, const char*> changes[] = {
        {"\"count\":3", "\"count\":4"},
        {"\"count\":3", "\"count\":-3"},
        {"\"count\":3", "\"count\":1e99"},
        {"\"count\":3", "\"count\":2"},
        {"\"count\":3", "\"count\":18446744073709551615"},
        {"\"byteLength\":36", "\"byteLength\":37"},
        {"\"byteLength\":36", "\"byteLength\":36,\"byteOffset\":4"},
        {"\"byteLength\":36", "\"byteLength\":36,\"byteOffset\":18446744073709551612"},
        {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":1"},
        {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":16"},
        {"\"bufferView\":0", "\"bufferView\":1"},
        {"\"POSITION\":0", "\"POSITION\":7"},
        {"\"POSITION\":0", "\"NORMAL\":0"},
        {"5126", "5123"},
        {"VEC3", "VEC2"},
        {"\"mesh\":0", "\"mesh\":1"},
        {"\"children\":[1]", "\"children\":[0]"},
        {"\"children\":[1]", "\"children\":[1,1]"},
        {"\"children\":[1]", "\"children\":[5]"},
        {"\"children\":[1]", "\"children\":3"},
        {"[1,0,0]", "[1,0]"},
        {"[1,0,0]", "[1,0,1e999]"},
        {"[1,0,0]", "[1,0,\"x\"]"},
        {"\"scene\":0", "\"scene\":\"x\""},
        {"\"primitives\"", "\"primitive\""},
        {"\"buffers\":[{", "\"buffers\":[{\"uri\":\"x\","},
        {"\"asset\":", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\":"},
        {"}]}", "}]}]"},
        {"0}}]", "0},\"mode\":5}]"},
    };
    for (const auto& [from, to] : changes) {
        const auto r = parse(triangle_glb(from, to), MeshFormat::glb);
        EXPECT_FALSE(r) << from << " -> " << to;
        if (!r) {
            EXPECT_TRUE(r.error().where.starts_with("f")) << r.error().where;
        }
    }
    const auto json = parse(glb_of("{\"a\": [1,,2]}"), MeshFormat::glb);
    ASSERT_FALSE(json);
    EXPECT_EQ(json.error().where, "f: JSON, line 1, column 10");
}

TEST(ReadMesh, deeply_nested_json_is_no_danger) {
    EXPECT_FALSE(parse(glb_of(std::string(2'000'000, '[')), MeshFormat::glb));
    std::string nested(200'000, '[');
    EXPECT_TRUE(parse(glb_of("{\"a\":" + nested + std::string(200'000, ']') + "}"), MeshFormat::glb));
}

TEST(ReadMesh, limits_hold) {
    MeshReadOptions options;
    options.max_triangles = 11;
    for (MeshFormat format : kMeshFormats) {
        const auto r = parse_mesh(bytes_of(test::cube(), format), format, "f", options);
        ASSERT_FALSE(r);
        EXPECT_EQ(r.error().kind, RefusalKind::limit);
    }
}

TEST(ReadMesh, damaged_files_are_refused_or_give_a_valid_mesh) {
    std::mt19937 random(11);
    for (MeshFormat format : kMeshFormats) {
        const std::string good = bytes_of(test::cube(), format);
        int refused = 0;
        for (int i = 0; i < 3000; ++i) {
            std::string bytes = good;
            for (unsigned k = 0; k < 1 + random() % 3; ++k) bytes[random() % bytes.size()] = char(random());
            if (random() % 4 == 0) bytes.resize(random() % bytes.size());
            const auto r = parse(bytes, format);
            refused += !r;
            if (r) {
                ASSERT_TRUE(validate(*r)) << validate(*r).error().message;
            }
        }
        EXPECT_GT(refused, 300);
    }
}

}  // namespace
}  // namespace freiform
