// A mesh and a view as the graphics card wants them: floats about the middle of the model, a matrix, lines.
#pragma once
#include <freiform/gpu/surfaces.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace freiform {

struct SceneVertex {
    std::array<float, 3> position{};  // in [-1, 1]
    std::array<float, 3> normal{};    // zero: that of the triangle is taken
    std::array<std::uint8_t, 4> colour{};
    std::array<float, 2> field{};  // place on the map; 1 where there is a value, else 0
};

struct SceneLine {
    std::array<float, 3> from{}, to{};
};

struct GpuScene {
    std::vector<SceneVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<SceneLine> outlines, edges;
    std::vector<std::vector<SceneLine>> lines;  // as RenderOptions::lines
    std::array<float, 9> rotation{};            // to right, up, towards the eye; by columns
    std::array<float, 16> projection{};         // of rotated positions, by columns
    float inverse_distance = 0;                 // of the eye from the origin; 0 without perspective
    float pixels = 0;                           // of the picture, of a unit of the scene at the origin
};

// REQUIRES a mesh that `validate` accepts.
GpuScene make_scene(const TriangleMesh& mesh, const RenderOptions& options);
// Camera and lines of the options.
GpuScene make_scene(const SurfaceBuffers& surfaces, const RenderOptions& options);

}  // namespace freiform
