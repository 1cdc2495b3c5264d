// What closes the gap between a face and an edge of it: between a segment of the boundary of the face and that of the
// edge, which mostly are one, and `reach` pixels beyond both. Instances, triangle strips of four vertices.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec3 edge_from;
layout(location = 3) in vec3 edge_to;
layout(location = 4) in vec3 normal_from;
layout(location = 5) in vec3 normal_to;
layout(location = 6) in vec3 other_from;
layout(location = 7) in vec3 other_to;
layout(location = 8) in vec4 paint;
layout(location = 9) in vec4 other_paint;
uniform mat3 rotation;
uniform mat4 projection;
uniform float inverse_distance;
uniform vec2 half_size;  // of the picture, in pixels
uniform float reach, farther, slopes;  // slopes: over so many pixels faces fall away
out vec3 place, direction, albedo;
flat out float outward;

vec2 pixel_of(vec4 p) { return half_size * p.xy / p.w; }

// What the depth of a plane changes by in a pixel, up to planes that are seen nearly edge on.
float slope_of(vec3 n) {
    return length(n.xy) / max(abs(n.z), 0.2) * abs(projection[2].z) / (projection[0].x * half_size.x);
}

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
    vec3 own = rotation * (at_end ? normal_to : normal_from), other = rotation * (at_end ? other_to : other_from);
    vec3 view = vec3(0.0, 0.0, 1.0) - inverse_distance * place;
    // A face that is seen edge on, or from behind, leaves the light to the other.
    bool turned_away = dot(own, view) < min(0.1 * length(view), dot(other, view));
    direction = turned_away ? other : own;
    albedo = turned_away ? other_paint.rgb : paint.rgb;
    outward = round(2.0 * (turned_away ? other_paint.a : paint.a) - 1.0);
    float deeper = farther + slopes * max(slope_of(own), slope_of(other));
    gl_Position = p + p.w * vec4(offset / half_size, deeper, 0.0);
    gl_Position.z = min(gl_Position.z, 0.9999 * gl_Position.w);  // before the far plane
}
