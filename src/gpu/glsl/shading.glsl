// Light is added up in linear light and written in sRGB.
uniform mat3 rotation;
uniform int painting;            // 0: albedo, 1: the map, 2: the normal
uniform int isophotes;
uniform vec3 sky;                // up, rotated
uniform float inverse_distance;  // of the eye
uniform int zebra;

vec3 encoded(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(c, vec3(0.0031308))));
}

vec3 decoded(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), vec3(greaterThan(c, vec3(0.04045))));
}

float faded(float cosine) {
    float t = max(cosine + 0.5, 0.0) / 1.5;
    return t * t;
}

vec3 view_from(vec3 place) { return normalize(vec3(0.0, 0.0, 1.0) - inverse_distance * place); }

// `plane`: a normal of the triangle, towards the eye. The normal is turned to its side: orientation plays no part,
// and near a silhouette an interpolated normal may lean away without harm. But where `outward` (1 or -1; 0: not known)
// says which side of a closed surface it is on, it stays: at outlines of saddles triangles are seen from behind, by less
// than a pixel, and would take their light from the wrong side. `paint`: of the map, and 1.
vec3 shaded(vec3 place, vec3 direction, vec3 plane, float outward, vec3 albedo, vec4 paint) {
    vec3 view = view_from(place);
    vec3 n = dot(direction, direction) > 0.01 ? normalize(direction) : plane;
    if (outward != 0.0 && outward * dot(n, view) > -0.5)
        n *= dot(direction, direction) > 0.01 ? outward : 1.0;
    else if (dot(n, plane) < 0.0) n = -n;

    // A key from the upper left, a fill from the right, one from the eye, and a sky that is brighter than the floor.
    // Each fades out with a slope of zero: an edge of light would look like a crease of the surface.
    vec3 key = normalize(vec3(-0.45, 0.65, 0.62)), fill = normalize(vec3(0.80, 0.05, 0.55));
    float light = 0.08 + 0.14 * (0.5 + 0.5 * dot(n, sky)) + 0.60 * faded(dot(n, key)) +
                  0.16 * faded(dot(n, fill)) + 0.14 * max(dot(n, view), 0.0);
    float gloss = 0.10 * pow(max(dot(n, normalize(key + view)), 0.0), 60.0);
    vec3 seen = albedo * light + gloss;
    // Light is kept weak: colours are to be compared.
    if (painting == 1) seen = decoded(paint.rgb) * mix(1.0, light, 0.45);
    if (painting == 2) {
        vec3 outward = dot(direction, direction) > 0.01 ? normalize(direction) : n;
        seen = decoded(0.5 + 0.5 * transpose(rotation) * outward) * mix(1.0, light, 0.25);
    }
    if (isophotes != 0) {
        float angle = 18.0 * acos(clamp(dot(n, key), -1.0, 1.0)) / 3.14159265;
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
    return encoded(seen);
}
