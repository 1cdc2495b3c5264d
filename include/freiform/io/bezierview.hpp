// .bv: Bezier patches and polyhedra as the BezierView program reads them, plain numbers between blanks.
//
//     group 1 lid          what follows has the name "lid" (optional)
//     1                    a polyhedron: numbers of points and polygons, the points, and every polygon as
//     8 6 x y z ... 4 0 1 2 3 ...       its number of corners and their indices from 0
//     3 n                  a triangle of degree n: its points row by row, from one side to the corner
//     opposite 4 n                  a patch of degrees n n, 5 m n: of degrees m n: its points, the second
//     index fastest 8 m n                rational: x y z w of each point, where x, y and z are those times w
//     already 9 n k, 10 m n k l    a triangle or patch as 3 and 5, followed by normals of degrees k and l
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/shape.hpp>

#include <string_view>

namespace freiform {

// Patches on [0, 1] x [0, 1] and triangles, in the order of the file. Of polyhedra triangles and quadrangles
// become flat triangles and bilinear patches. Left out, with line and reason: polygons of more corners, and
// normals, which are not those of a surface. Refusals name the line. Memory is proportional to the text.
Result<Document> read_bezierview(std::string_view text);

}  // namespace freiform
