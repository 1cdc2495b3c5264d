// Values and derivatives of rational Bezier pieces. REQUIRES Real, Real2 .. Real4 and Real4 coefficient(int).
//
// By the scheme of Horner for Bernstein polynomials: s = 1 - t, from sum to s sum + binomial t^i c_i. Nothing is kept in
// arrays, which cards and compilers of shaders are slow with.
//
// Neighbouring pieces of a face have the same coefficients along the side between them. There t is exactly 0 or 1, so
// that the sum is its first coefficient plus zeros, or zero plus its last one, whose binomial is put as 1: the points
// are the same bits, and no crack opens.
struct Jet {
    Real3 point, u, v, uv;
};

Jet projected(Real4 h, Real4 hu, Real4 hv, Real4 huv) {
    Jet j;
    j.point = h.xyz / h.w;
    j.u = (hu.xyz - hu.w * j.point) / h.w;
    j.v = (hv.xyz - hv.w * j.point) / h.w;
    j.uv = (huv.xyz - hu.w * j.v - hv.w * j.u - huv.w * j.point) / h.w;
    return j;
}

// Degrees n by m, the first coefficient at `first`, the second parameter fastest. Derivatives are sums of degree one
// less of differences.
Jet tensor_jet(int first, int n, int m, Real2 at) {
    Real2 s = Real2(1) - at;
    Real4 h = Real4(0), hu = Real4(0), hv = Real4(0), huv = Real4(0), last_row = Real4(0), last_slope = Real4(0);
    Real power = Real(1), binomial = Real(1), lower = Real(0);
    for (int i = 0; i <= n; ++i) {
        Real4 row = Real4(0), slope = Real4(0), last = Real4(0);
        Real p = Real(1), b = Real(1), q = Real(0);  // q: the factor of the difference of c and the one before
        for (int j = 0; j <= m; ++j) {
            Real4 c = coefficient(first + i * (m + 1) + j);
            row = s.y * row + (j == m ? p : p * b) * c;
            slope = s.y * slope + q * (c - last);
            last = c;
            q = j == m - 1 ? p : p * b * Real(m - j) / Real(m);
            b = b * Real(m - j) / Real(j + 1);
            p *= at.y;
        }
        slope *= Real(m);
        Real factor = i == n ? power : power * binomial;
        h = s.x * h + factor * row;
        hv = s.x * hv + factor * slope;
        hu = s.x * hu + lower * (row - last_row);
        huv = s.x * huv + lower * (slope - last_slope);
        last_row = row;
        last_slope = slope;
        lower = i == n - 1 ? power : power * binomial * Real(n - i) / Real(n);
        binomial = binomial * Real(n - i) / Real(i + 1);
        power *= at.x;
    }
    return projected(h, Real(n) * hu, hv, Real(n) * huv);
}

// A triangle of degree n >= 1, its coefficients row after row away from corner 1; at (u, v) = (t2, t3). With
// A_k the sum of B_ijk of degree n - 1 times the coefficients one step towards corner k: f = t1 A_1 + t2 A_2 +
// t3 A_3, f_u = n (A_2 - A_1), f_v = n (A_3 - A_1).
Jet triangle_jet(int first, int n, Real2 at) {
    Real t = Real(1) - at.x - at.y;
    Real4 a = Real4(0), b = Real4(0), c = Real4(0);
    Real rows = Real(1);  // binomial (n - 1, r)
    for (int r = 0; r < n; ++r) {
        Real4 row_a = Real4(0), row_b = Real4(0), row_c = Real4(0);
        Real binomial = Real(1), power = Real(1);
        for (int k = 0; k <= r; ++k) {
            int here = first + r * (r + 1) / 2 + k, next = here + r + 1;
            Real factor = binomial * power;
            row_a = at.x * row_a + factor * coefficient(here);
            row_b = at.x * row_b + factor * coefficient(next);
            row_c = at.x * row_c + factor * coefficient(next + 1);
            binomial = binomial * Real(r - k) / Real(k + 1);
            power *= at.y;
        }
        a = t * a + rows * row_a;
        b = t * b + rows * row_b;
        c = t * c + rows * row_c;
        rows = rows * Real(n - 1 - r) / Real(r + 1);
    }
    return projected(t * a + at.x * b + at.y * c, Real(n) * (b - a), Real(n) * (c - a), Real4(0));
}

Real3 direction_of(Real3 x) {
    Real most = max(max(abs(x.x), abs(x.y)), abs(x.z));
    return most > Real(0) ? normalize(x / most) : Real3(0);
}

// The unit normal; zero where there is none. At a pole, where S_u vanishes along v = 0, it is v S_uv nearby, so
// that the limit of the normal is that of S_uv x S_v.
Real3 normal_of(Jet j, Real2 at) {
    const Real kPole = Real(1e-8);  // squared: of what S_u changes by along the whole piece
    Real3 a = j.u, b = j.v;
    if (dot(a, a) < kPole * dot(j.uv, j.uv))
        a = at.y < Real(0.5) ? j.uv : -j.uv;
    else if (dot(b, b) < kPole * dot(j.uv, j.uv))
        b = at.x < Real(0.5) ? j.uv : -j.uv;
    Real3 n = cross(direction_of(a), direction_of(b));
    return dot(n, n) > Real(1e-12) ? normalize(n) : Real3(0);
}
