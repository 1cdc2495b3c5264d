// The same without tessellation stages: instances of a grid of side.x by side.y cells, six vertices each. A piece that
// needs fewer cells has the rest without area.
layout(location = 0) in float instance;  // the piece
uniform ivec2 side;
uniform mat3 rotation;
uniform mat4 projection;
out vec3 place, direction;
centroid out vec2 at;
flat out int piece_number;
void main() {
    piece_number = int(instance);
    Piece p = piece_of(piece_number);
    ivec2 levels = min(ivec2(levels_of(p)), side);
    int cell = gl_VertexID / 6, corner = gl_VertexID - 6 * cell;
    ivec2 low = ivec2(cell / side.y, cell % side.y);
    bool upper = corner > 2;
    if (upper) corner -= 3;
    // (0, 0) (1, 0) (0, 1) and (1, 1) (0, 1) (1, 0)
    ivec2 to = ivec2(corner == 1 ? 1 : 0, corner == 2 ? 1 : 0);
    if (upper) to = 1 - to;
    if (p.degree.y < 0) {
        int n = levels.x;
        bool inside = low.x + low.y + (upper ? 2 : 1) <= n;
        at = inside ? vec2(low + to) / float(n) : vec2(0.0);
    } else {
        at = vec2(min(low + to, levels)) / vec2(levels);
    }
    vec3 position, normal;
    evaluate(p, at, position, normal);
    place = rotation * position;
    direction = rotation * normal;
    gl_Position = projection * vec4(place, 1.0);
}
