// Triangles of a mesh.
in vec3 place, direction, albedo;
flat in float outward;
in vec2 value;
uniform sampler1D map;
uniform vec3 no_value;
out vec4 colour;
void main() {
    vec3 plane = normalize(cross(dFdx(place), dFdy(place)));
    if (dot(plane, view_from(place)) < 0.0) plane = -plane;
    // Texels are in the middle of their cells.
    float at = (clamp(value.x, 0.0, 1.0) * 256.0 + 0.5) / 257.0;
    vec3 paint = value.y > 0.99 ? texture(map, at).rgb : no_value;
    colour = vec4(shaded(place, direction, plane, outward, albedo, vec4(paint, 1.0)), 1.0);
}
