// The records of pieces and faces (docs/gpu.md).
uniform int pieces, faces;  // where their records begin

vec4 coefficient(int i) { return texel(i); }

struct Piece {
    int first, face;
    ivec2 degree;    // a triangle: its degree and -1
    vec4 map;        // parameter = map.xz + map.yw times the place, or its angle
    vec2 bow;        // 0: the map is linear; > 0: 2 atan(bow (2 s - 1)); < 0: 2 atanh(-bow (2 s - 1))
    float distance;  // of an offset surface from the piece
    bool trimmed;
    vec2 bend;       // see levels_of
};

Piece piece_of(int i) {
    vec4 a = texel(pieces + 4 * i), c = texel(pieces + 4 * i + 2), d = texel(pieces + 4 * i + 3);
    return Piece(int(a.x), int(a.y), ivec2(a.zw), texel(pieces + 4 * i + 1), c.xy, c.z, c.w > 0.5, d.xy);
}

// So many cells in both directions that the triangles are within `deviation` pixels of the surface; the same for
// all pieces of a column or row of a face, so that neighbours have the same points on the side between them.
uniform float density;  // pixels of a unit of the scene, divided by the deviation
vec2 levels_of(Piece p) { return max(ceil(sqrt(p.bend * density)), vec2(1.0)); }

// Position and normal in the scene.
void evaluate(Piece p, vec2 at, out vec3 position, out vec3 normal) {
    Jet j;
    if (p.degree.y < 0) {
        j = triangle_jet(p.first, p.degree.x, at);
        normal = normal_of(j, at);
        if (dot(normal, normal) < 0.5) {
            vec2 inside = mix(at, vec2(1.0 / 3.0), 1.0 / 512.0);
            normal = normal_of(triangle_jet(p.first, p.degree.x, inside), inside);
        }
    } else {
        j = tensor_jet(p.first, p.degree.x, p.degree.y, at);
        normal = normal_of(j, at);
    }
    vec4 face = texel(faces + 3 * p.face);
    position = face.xyz + (j.point + p.distance * normal);
    normal *= face.w;
}
