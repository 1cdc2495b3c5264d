// Meshes as the bytes of files of every format.
#pragma once
#include <freiform/io/mesh_file.hpp>

#include <array>
#include <gtest/gtest.h>
#include <string>

namespace freiform::test {

inline constexpr std::array kMeshFormats{MeshFormat::glb, MeshFormat::stl, MeshFormat::obj, MeshFormat::ply};

inline std::string bytes_of(const TriangleMesh& mesh, MeshFormat format) {
    auto r = format == MeshFormat::glb   ? to_glb(mesh)
             : format == MeshFormat::stl ? to_stl(mesh)
             : format == MeshFormat::obj ? to_obj(mesh)
                                         : to_ply(mesh);
    EXPECT_TRUE(r) << (r ? "" : r.error().message);
    return r.value_or("");
}

}  // namespace freiform::test
