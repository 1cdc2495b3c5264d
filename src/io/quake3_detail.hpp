// What the two readers of Quake 3 levels share: a grid of control points and the surface that it is.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/shape.hpp>

#include <string>
#include <vector>

namespace freiform::quake3 {

inline constexpr int kMostRows = 1025;  // the engine stops at 31, editors and other engines further up

struct Vertex {
    Vec<3> position{}, normal{};
    Colour colour{};
};

struct Grid {
    int width = 0, height = 0;
    std::vector<Vertex> vertices;  // width x height, the second index fastest

    // Refuses sizes that are even or outside 3 .. kMostRows.
    Result<void> check() const;
    // REQUIRES check() and as many vertices as the size says. The surface of the grid; where the normals
    // point to the other side than S_u x S_v, the width runs backwards.
    Result<Object> object(std::string name, std::string material) const;
};

}  // namespace freiform::quake3
