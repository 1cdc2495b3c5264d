// What closes the gap between a face and an edge of it: between a segment of the boundary of the face and that of the
// edge, which mostly are one, and `reach` pixels beyond both. Instances, triangle strips of four vertices.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec3 edge_from;
layout(location = 3) in vec3 edge_to;
layout(location = 4) in vec3 normal_from;
layout(location = 5) in vec3 normal_to;
layout(location = 6) in vec4 paint;
uniform mat3 rotation;
uniform mat4 projection;
uniform vec2 half_size;  // of the picture, in pixels
uniform float reach, farther;
out vec3 place, direction, albedo;

vec2 pixel_of(vec4 p) { return half_size * p.xy / p.w; }

void main() {
    vec4 a = projection * vec4(rotation * from, 1.0), b = projection * vec4(rotation * to, 1.0);
    vec4 c = projection * vec4(rotation * edge_from, 1.0), d = projection * vec4(rotation * edge_to, 1.0);
    vec2 along = pixel_of(b) - pixel_of(a);
    float size = length(along);
    along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    // The edge lies on one side of the boundary, or on both by less than the reach.
    if (dot(pixel_of(c) + pixel_of(d) - pixel_of(a) - pixel_of(b), across) < 0.0) across = -across;
    bool at_end = gl_VertexID > 1, at_edge = (gl_VertexID & 1) == 1;
    vec4 p = at_edge ? (at_end ? d : c) : (at_end ? b : a);
    vec2 offset = reach * ((at_end ? along : -along) + (at_edge ? across : -across));
    place = rotation * (at_edge ? (at_end ? edge_to : edge_from) : (at_end ? to : from));
    direction = rotation * (at_end ? normal_to : normal_from);
    albedo = paint.rgb;
    gl_Position = p + p.w * vec4(offset / half_size, farther, 0.0);
}
