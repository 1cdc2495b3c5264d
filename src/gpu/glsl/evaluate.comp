// Points and normals of one spline surface at many parameters. Everything of it lies in one buffer: `extent` pieces
// with their breaks, and the coefficients of piece after piece. Compiled for float and, with DOUBLE, for double.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Coefficients { Real4 coefficients[]; };
layout(std430, binding = 1) readonly buffer Breaks { Real breaks[]; };
layout(std430, binding = 2) readonly buffer Parameters { Real2 parameters[]; };
layout(std430, binding = 3) writeonly buffer Points { Real points[]; };
layout(std430, binding = 4) writeonly buffer Normals { Real normals[]; };
uniform ivec2 extent, degree;
uniform int count, with_normals;

Real4 coefficient(int i) { return coefficients[i]; }

// The piece of breaks[first .. first + n] that u is in.
int piece_at(int first, int n, Real u) {
    int lo = 0, hi = n;
    while (hi - lo > 1) {
        int middle = (lo + hi) / 2;
        if (breaks[first + middle] <= u)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

void main() {
    int i = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u);
    if (i >= count) return;
    Real2 uv = parameters[i];
    int second = extent.x + 1;
    ivec2 piece = ivec2(piece_at(0, extent.x, uv.x), piece_at(second, extent.y, uv.y));
    Real2 low = Real2(breaks[piece.x], breaks[second + piece.y]);
    Real2 high = Real2(breaks[piece.x + 1], breaks[second + piece.y + 1]);
    Real2 at = (uv - low) / (high - low);
    int first = (piece.x * extent.y + piece.y) * (degree.x + 1) * (degree.y + 1);
    Jet j = tensor_jet(first, degree.x, degree.y, at);
    points[3 * i] = j.point.x;
    points[3 * i + 1] = j.point.y;
    points[3 * i + 2] = j.point.z;
    if (with_normals != 0) {
        Real3 n = normal_of(j, at);
        normals[3 * i] = n.x;
        normals[3 * i + 1] = n.y;
        normals[3 * i + 2] = n.z;
    }
}
