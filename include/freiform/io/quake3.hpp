// Levels of Quake 3 and of the games made with its engine: compiled (.bsp, IBSP version 46) and as edited
// (.map).
//
// A curved wall is a grid of m x n control points, both odd: (m - 1) / 2 x (n - 1) / 2 biquadratic Bezier
// patches that share their boundary rows. It becomes one surface of degrees 2 x 2 with double inner knots 1,
// 2, ..: the same map, to the bit. u runs along the columns (the width of the grid), v along the rows; S_u x
// S_v points to the side that the level shows.
#pragma once
#include <freiform/shape.hpp>

#include <string_view>

namespace freiform {

// Every patch as a surface, every triangle of the flat and mesh faces as a triangle of degree 1, with the
// name "face 17" (the index in the file), the texture as its material and the colours of its vertices. Shown
// faces only: billboards (flares) have no shape. Normals stored in the file decide which side is the outer
// one. Refuses (unreadable) lumps that leave the file or are no whole number of records, indices that point
// outside, even or too small grids, coordinates that are not finite; the place names the lump and the record.
Result<Document> read_quake3_bsp(std::string_view bytes);

// Every patchDef2 and patchDef3 as a surface with the name "entity 0 brush 3" and its texture as material.
// Brushes made of planes are passed over; a map without any patch is refused (no_answer) and the message
// counts them. Other refusals name the line.
Result<Document> read_quake3_map(std::string_view text);

}  // namespace freiform
