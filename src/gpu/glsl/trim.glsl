// Is a place of a piece inside the loops of its face? Odd-even along a ray in the direction of u.
//
// The loops are cut into curves that are monotone in u and v. A face has bands of equal height in v; each
// lists the curves that meet it. Parameters are those of the box of the face, in [0, 1].
float mapped(float s, float from, float by, float bow) {
    float x = 2.0 * s - 1.0;
    if (bow > 0.0) return from + by * 2.0 * atan(bow * x);
    if (bow < 0.0) {
        float y = -bow * x;
        return from + by * log((1.0 + y) / (1.0 - y));
    }
    return from + by * s;
}

vec2 parameter_of(Piece p, vec2 at) {
    return vec2(mapped(at.x, p.map.x, p.map.y, p.bow.x), mapped(at.y, p.map.z, p.map.w, p.bow.y));
}

// A point of a curve, by the scheme of Horner for Bernstein polynomials.
vec3 curve_point(int first, int degree, float t) {
    float s = 1.0 - t, power = 1.0, binomial = 1.0;
    vec3 sum = texel(first).xyz * s;
    for (int i = 1; i < degree; ++i) {
        power *= t;
        binomial = binomial * float(degree - i + 1) / float(i);
        sum = (sum + power * binomial * texel(first + i).xyz) * s;
    }
    return sum + power * t * texel(first + degree).xyz;
}

// Does the ray from q meet the curve? REQUIRES q.y in its range. The curve is halved until q is beside the box of
// what is left: after as many steps as q has bits less than its distance.
bool is_left_of(vec2 q, int first, int degree) {
    vec3 a = texel(first).xyz, b = texel(first + degree).xyz;
    vec2 low = a.xy / a.z, high = b.xy / b.z;
    float lo = 0.0, hi = 1.0;
    bool rises = low.y < high.y;
    if (degree > 1) {
        for (int k = 0; k < 24; ++k) {
            if (q.x < min(low.x, high.x)) return true;
            if (q.x > max(low.x, high.x)) return false;
            float middle = 0.5 * (lo + hi);
            vec3 h = curve_point(first, degree, middle);
            vec2 m = h.xy / h.z;
            if ((m.y > q.y) == rises)
                hi = middle, high = m;
            else
                lo = middle, low = m;
        }
    }
    return q.x < mix(low.x, high.x, high.y == low.y ? 0.5 : clamp((q.y - low.y) / (high.y - low.y), 0.0, 1.0));
}

bool is_inside(Piece p, vec2 at) {
    // What is drawn is in the box, but for rounding; its sides belong to the face.
    const float kRounding = 2.4e-7;
    vec2 q = clamp(parameter_of(p, clamp(at, 0.0, 1.0)), kRounding, 1.0 - kRounding);
    vec4 trim = texel(faces + 3 * p.face + 2);
    int bands = int(trim.y);
    vec4 band = texel(int(trim.x) + clamp(int(floor(q.y * trim.y)), 0, bands - 1));
    bool inside = false;
    int first = int(band.x), end = first + 2 * int(band.y);
    for (int i = first; i < end; i += 2) {
        vec4 box = texel(i);
        if (q.y < box.z || q.y >= box.w || q.x > box.y) continue;
        if (q.x < box.x) {
            inside = !inside;
        } else {
            vec4 curve = texel(i + 1);
            if (is_left_of(q, int(curve.x), int(curve.y))) inside = !inside;
        }
    }
    return inside;
}
