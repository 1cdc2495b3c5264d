// Compiled with `TRIANGLES` for triangular pieces.
#ifdef TRIANGLES
layout(triangles, equal_spacing, ccw) in;
#else
layout(quads, equal_spacing, ccw) in;
#endif
patch in int piece_index;
patch in vec4 cell;
uniform mat3 rotation;
uniform mat4 projection;
out vec3 place, direction;
out vec2 at;
flat out int piece_number;
void main() {
#ifdef TRIANGLES
    // Cells beyond the diagonal stand for the triangles between the others, turned by half a turn. Places on the sides
    // of cells are quotients of whole numbers, so that both neighbours have the same bits. Inside, the rings of the
    // hardware lie between such places.
    float n = cell.w, k = cell.z;
    vec2 steps = gl_TessCoord.yz * n;
    if (min(min(gl_TessCoord.x, gl_TessCoord.y), gl_TessCoord.z) == 0.0) steps = round(steps);
    at = (cell.x + cell.y < k ? cell.xy * n + steps : (vec2(k) - cell.xy) * n - steps) / (k * n);
#else
    at = (cell.xy + gl_TessCoord.xy) / cell.zw;
#endif
    piece_number = piece_index;
    vec3 position, normal;
    evaluate(piece_of(piece_index), at, position, normal);
    place = rotation * position;
    direction = rotation * normal;
    gl_Position = projection * vec4(place, 1.0);
}
