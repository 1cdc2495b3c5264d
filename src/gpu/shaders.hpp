// The programs of the graphics card. Light is added up in linear light and written in sRGB.
#pragma once

namespace freiform {

// A triangle that covers the picture.
inline constexpr const char* kBackgroundVertex = R"(#version 330 core
out float height;
void main() {
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = 0.5 + 0.5 * p.y;
    gl_Position = vec4(p, 0.0, 1.0);
})";
inline constexpr const char* kBackgroundFragment = R"(#version 330 core
uniform vec3 top, bottom;
in float height;
out vec4 colour;
void main() { colour = vec4(mix(bottom, top, height), 1.0); }
)";

inline constexpr const char* kSurfaceVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 paint;
layout(location = 3) in vec2 field;
uniform mat3 rotation;
uniform mat4 projection;
out vec3 place, direction, albedo;
out vec2 value;
void main() {
    value = field;
    place = rotation * position;
    direction = rotation * normal;
    albedo = mix(paint.rgb / 12.92, pow((paint.rgb + 0.055) / 1.055, vec3(2.4)), greaterThan(paint.rgb, vec3(0.04045)));
    gl_Position = projection * vec4(place, 1.0);
})";

// The normal is turned to the side that is seen, judged by the plane of the triangle: orientation plays no
// part, and near a silhouette an interpolated normal may lean away without harm.
inline constexpr const char* kSurfaceFragment = R"(#version 330 core
in vec3 place, direction, albedo;
in vec2 value;
uniform mat3 rotation;
uniform int painting;            // 0: albedo, 1: the map, 2: the normal
uniform sampler1D map;
uniform vec3 no_value;
uniform int isophotes;
uniform vec3 sky;                // up, rotated
uniform float inverse_distance;  // of the eye
uniform int zebra;
out vec4 colour;

vec3 encoded(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

vec3 decoded(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

float faded(float cosine) {
    float t = max(cosine + 0.5, 0.0) / 1.5;
    return t * t;
}

void main() {
    vec3 view = normalize(vec3(0.0, 0.0, 1.0) - inverse_distance * place);
    vec3 plane = normalize(cross(dFdx(place), dFdy(place)));
    if (dot(plane, view) < 0.0) plane = -plane;
    vec3 n = dot(direction, direction) > 0.01 ? normalize(direction) : plane;
    if (dot(n, plane) < 0.0) n = -n;

    // A key from the upper left, a fill from the right, one from the eye, and a sky that is brighter than the floor.
    // Each fades out with a slope of zero: an edge of light would look like a crease of the surface.
    const vec3 kKey = normalize(vec3(-0.45, 0.65, 0.62));
    const vec3 kFill = normalize(vec3(0.80, 0.05, 0.55));
    float light = 0.08 + 0.14 * (0.5 + 0.5 * dot(n, sky)) + 0.60 * faded(dot(n, kKey)) +
                  0.16 * faded(dot(n, kFill)) + 0.14 * max(dot(n, view), 0.0);
    float gloss = 0.10 * pow(max(dot(n, normalize(kKey + view)), 0.0), 60.0);
    vec3 seen = albedo * light + gloss;
    if (painting == 1) {
        // Texels are in the middle of their cells. Light is kept weak: colours are to be compared.
        float at = (clamp(value.x, 0.0, 1.0) * 256.0 + 0.5) / 257.0;
        vec3 paint = value.y > 0.99 ? texture(map, at).rgb : no_value;
        seen = decoded(paint) * mix(1.0, light, 0.45);
    }
    if (painting == 2) {
        vec3 outward = dot(direction, direction) > 0.01 ? normalize(direction) : n;
        seen = decoded(0.5 + 0.5 * transpose(rotation) * outward) * mix(1.0, light, 0.25);
    }
    if (isophotes != 0) {
        float angle = 18.0 * acos(clamp(dot(n, kKey), -1.0, 1.0)) / 3.14159265;
        float change = fwidth(angle), off = abs(fract(angle - 0.5) - 0.5);
        // Where nothing changes, a plane, there is no line.
        if (change > 1e-5) seen = mix(vec3(0.01, 0.012, 0.016), seen, smoothstep(0.9, 1.9, off / change));
    }
    if (zebra != 0) {
        vec3 mirrored = reflect(-view, n);
        float phase = 20.0 * asin(clamp(dot(mirrored, normalize(vec3(0.35, 1.0, 0.0))), -1.0, 1.0)) / 3.14159265;
        float wave = cos(3.14159265 * phase), width = max(fwidth(wave), 1e-4);
        seen = mix(vec3(0.015), vec3(0.9), smoothstep(-width, width, wave)) * (0.55 + 0.45 * light);
    }
    colour = vec4(encoded(seen), 1.0);
}
)";

// A line is a strip of two triangles of `width` pixels, half a width longer than the edge at both ends.
inline constexpr const char* kLineVertex = R"(#version 330 core
layout(location = 0) in vec3 from;
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
inline constexpr const char* kLineFragment = R"(#version 330 core
uniform vec4 ink;
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
