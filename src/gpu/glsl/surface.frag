// Samples of a pixel are trimmed one by one where that can be (SAMPLES); else its middle decides, or where less of
// the pixel is covered, a place that is.
in vec3 place, direction;
#ifdef SAMPLES
in vec2 at;
#else
centroid in vec2 at;
#endif
flat in int piece_number;
out vec4 colour;

void main() {
    vec3 plane = normalize(cross(dFdx(place), dFdy(place)));
    if (dot(plane, view_from(place)) < 0.0) plane = -plane;
    Piece p = piece_of(piece_number);
    vec3 albedo = decoded(texel(faces + 3 * p.face + 1).rgb);
    colour = vec4(shaded(place, direction, plane, texel(faces + 3 * p.face + 2).z, albedo, vec4(albedo, 1.0)), 1.0);
#ifdef SAMPLES
    gl_SampleMask[0] = -1;
    if (!p.trimmed) return;
    int mask = 0;
    for (int i = 0; i < max(gl_NumSamples, 1); ++i)
        if (is_inside(p, interpolateAtSample(at, i))) mask |= 1 << i;
    if (mask == 0) discard;
    gl_SampleMask[0] = mask;
#else
    if (p.trimmed && !is_inside(p, at)) discard;
#endif
}
