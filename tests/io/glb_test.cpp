// What the validator of the Khronos group says about our glTF files.
#include "support/test_meshes.hpp"

#include <freiform/io/mesh_file.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace freiform {
namespace {

namespace fs = std::filesystem;

std::vector<TriangleMesh> samples() {
    std::vector<TriangleMesh> out{test::cube(), test::torus(40, 20), test::torus(300, 300), TriangleMesh{}};
    out.push_back(test::sphere(12, 20));
    for (MeshVertex& v : out.back().vertices) v.normal = {};
    out.push_back(test::sphere(12, 20));
    for (Vec<3>& p : out.back().points) p = 1e-30 * p + Vec<3>{{1e5, 0, 0}};
    out.push_back(test::torus(40, 20));
    for (Vec<3>& p : out.back().points) p += Vec<3>{{1e6, -1e6, 0}};
    out.push_back(test::cube());
    // Large and small groups in one file, a part that has no triangle left, a name that is no UTF-8.
    TriangleMesh mixed = test::torus(300, 300);
    mixed.parts[0].count = 100;
    mixed.parts.push_back({"\xff\"\n", Colour{0.1, 0.2, 0.3, 0.4}, 100, 179900, 1});
    mixed.triangles.push_back({0, 0, 1});
    mixed.parts.push_back({"lost", Colour{1, 1, 1, 1}, 180000, 1, 2});
    out.push_back(mixed);
    return out;
}

TEST(Glb, khronos_validator_finds_no_error_and_no_warning) {
    const fs::path node = fs::path(__FILE__).parent_path().parent_path() / "node";
    if (!fs::exists(node / "node_modules" / "gltf-validator"))
        GTEST_SKIP() << "no gltf-validator: run `npm ci` in tests/node";
    if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
    std::string folder = (fs::temp_directory_path() / "freiform-glb-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    std::string command = "node '" + (node / "validate_glb.mjs").string() + "'";
    const auto meshes = samples();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const std::string file = text(folder, "/", i, ".glb");
        const auto written = write_mesh(meshes[i], file);
        ASSERT_TRUE(written) << written.error().message;
        command += " '" + file + "'";
    }
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string report;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) report.append(buffer, n);
    const int status = ::pclose(pipe);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << report;
    EXPECT_NE(report.find("1.glb: 0 errors, 0 warnings, 1600 triangles, 800 vertices"), std::string::npos)
        << report;
    fs::remove_all(folder);
}

}  // namespace
}  // namespace freiform
