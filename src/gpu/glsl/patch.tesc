layout(vertices = 1) out;
flat in ivec2 piece_and_cell[];
patch out int piece_index;
patch out vec4 cell;   // its place, and how many there are; of a triangle: how many along a side, and their levels
uniform int cells;     // in each direction, of the piece that needs most
uniform float hardware_level;

void main() {
    piece_index = piece_and_cell[0].x;
    Piece p = piece_of(piece_index);
    vec2 levels = levels_of(p), count = min(ceil(levels / hardware_level), vec2(cells));
    vec2 at = vec2(piece_and_cell[0].y % cells, piece_and_cell[0].y / cells);
    levels = ceil(levels / count);
    if (at.x >= count.x || at.y >= count.y) levels = vec2(0.0);  // the cell is culled
    cell = p.degree.y < 0 ? vec4(at, count.x, levels.x) : vec4(at, count);
    gl_TessLevelOuter[0] = gl_TessLevelOuter[2] = levels.y;
    gl_TessLevelOuter[1] = gl_TessLevelOuter[3] = levels.x;
    gl_TessLevelInner[0] = levels.x;
    gl_TessLevelInner[1] = levels.y;
    if (p.degree.y < 0) {
        gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = levels.x;
        gl_TessLevelInner[0] = levels.x;
    }
}
