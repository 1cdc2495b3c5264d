// Programs of the graphics card that are short, without their version lines; others are in glsl/.
#pragma once

namespace freiform {

// A triangle that covers the picture.
inline constexpr const char* kBackgroundVertex = R"(out float height;
void main() {
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = 0.5 + 0.5 * p.y;
    gl_Position = vec4(p, 0.0, 1.0);
})";
inline constexpr const char* kBackgroundFragment = R"(uniform vec3 top, bottom;
in float height;
out vec4 colour;
void main() { colour = vec4(mix(bottom, top, height), 1.0); }
)";

inline constexpr const char* kSurfaceVertex = R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 paint;
layout(location = 3) in vec2 field;
uniform mat3 rotation;
uniform mat4 projection;
out vec3 place, direction, albedo;
flat out float outward;
out vec2 value;
void main() {
    value = field;
    outward = round(2.0 * paint.a - 1.0);
    place = rotation * position;
    direction = rotation * normal;
    albedo = mix(paint.rgb / 12.92, pow((paint.rgb + 0.055) / 1.055, vec3(2.4)), vec3(greaterThan(paint.rgb, vec3(0.04045))));
    gl_Position = projection * vec4(place, 1.0);
})";

// A line is a strip of two triangles of `width` pixels, half a width longer than the edge at both ends.
inline constexpr const char* kLineVertex = R"(layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform mat3 rotation;
uniform mat4 projection;
uniform vec2 half_size;  // of the picture, in pixels
uniform float width, nearer;
out vec3 across;  // place along and beside the line, and its length; pixels
void main() {
    vec4 a = projection * vec4(rotation * from, 1.0), b = projection * vec4(rotation * to, 1.0);
    vec2 along = half_size * (b.xy / b.w - a.xy / a.w);
    float size = length(along);
    along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
    bool at_end = gl_VertexID > 1;
    vec2 offset = (at_end ? 0.5 : -0.5) * along + (gl_VertexID % 2 == 0 ? 0.5 : -0.5) * vec2(-along.y, along.x);
    vec4 p = at_end ? b : a;
    across = vec3(at_end ? size + 0.5 * width : -0.5 * width, gl_VertexID % 2 == 0 ? 0.5 * width : -0.5 * width, size);
    gl_Position = p + p.w * vec4(width * offset / half_size, -nearer, 0.0);
})";
inline constexpr const char* kLineFragment = R"(uniform vec4 ink;
uniform float width;
uniform int round_ends;
in vec3 across;
out vec4 colour;
void main() {
    float beyond = max(max(-across.x, across.x - across.z), 0.0);
    if (round_ends != 0 && 4.0 * (beyond * beyond + across.y * across.y) > width * width) discard;
    colour = ink;
}
)";

}  // namespace freiform
