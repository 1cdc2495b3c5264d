// Values and derivatives of rational Bezier pieces. REQUIRES Real, Real2 .. Real4 and Real4 coefficient(int).
//
// Neighbouring pieces of a face have the same coefficients along the side between them. There one of the
// Bernstein polynomials is exactly 1 and the others exactly 0, and the sums along the side are the same in both:
// the points are the same bits, so that no crack opens.
struct Jet {
    Real3 point, u, v, uv;
};

const int kMostDegree = 25;

// From the Bernstein polynomials of degree k - 1 to those of degree k.
void raise(int k, Real t, inout Real b[kMostDegree + 1]) {
    Real s = Real(1) - t, carried = Real(0);
    for (int i = 0; i < k; ++i) {
        Real old = b[i];
        b[i] = carried + s * old;
        carried = t * old;
    }
    b[k] = carried;
}

// Those of degree n and their derivatives.
void bernstein(int n, Real t, out Real b[kMostDegree + 1], out Real d[kMostDegree + 1]) {
    b[0] = Real(1);
    d[0] = Real(0);
    if (n == 0) return;
    for (int k = 1; k < n; ++k) raise(k, t, b);
    d[0] = -Real(n) * b[0];
    for (int i = 1; i < n; ++i) d[i] = Real(n) * (b[i - 1] - b[i]);
    d[n] = Real(n) * b[n - 1];
    raise(n, t, b);
}

Jet projected(Real4 h, Real4 hu, Real4 hv, Real4 huv) {
    Jet j;
    j.point = h.xyz / h.w;
    j.u = (hu.xyz - hu.w * j.point) / h.w;
    j.v = (hv.xyz - hv.w * j.point) / h.w;
    j.uv = (huv.xyz - hu.w * j.v - hv.w * j.u - huv.w * j.point) / h.w;
    return j;
}

// Degrees n by m, the first coefficient at `first`, the second parameter fastest.
Jet tensor_jet(int first, int n, int m, Real2 at) {
    Real bu[kMostDegree + 1], du[kMostDegree + 1], bv[kMostDegree + 1], dv[kMostDegree + 1];
    bernstein(n, at.x, bu, du);
    bernstein(m, at.y, bv, dv);
    Real4 h = Real4(0), hu = Real4(0), hv = Real4(0), huv = Real4(0);
    for (int i = 0; i <= n; ++i) {
        Real4 row = Real4(0), slope = Real4(0);
        for (int j = 0; j <= m; ++j) {
            Real4 c = coefficient(first + i * (m + 1) + j);
            row += bv[j] * c;
            slope += dv[j] * c;
        }
        h += bu[i] * row;
        hu += du[i] * row;
        hv += bu[i] * slope;
        huv += du[i] * slope;
    }
    return projected(h, hu, hv, huv);
}

// A triangle of degree n >= 1, its coefficients row after row away from corner 1; at (u, v) = (t2, t3). With
// A_k the sum of B_ijk of degree n - 1 times the coefficients one step towards corner k: f = t1 A_1 + t2 A_2 +
// t3 A_3, f_u = n (A_2 - A_1), f_v = n (A_3 - A_1).
Jet triangle_jet(int first, int n, Real2 at) {
    Real t = Real(1) - at.x - at.y;
    Real p[kMostDegree + 1], x[kMostDegree + 1], y[kMostDegree + 1];
    p[0] = x[0] = y[0] = Real(1);
    for (int i = 1; i < n; ++i) p[i] = t * p[i - 1], x[i] = at.x * x[i - 1], y[i] = at.y * y[i - 1];
    Real4 a = Real4(0), b = Real4(0), c = Real4(0);
    Real rows = Real(1);  // binomial (n - 1, r)
    for (int r = 0; r < n; ++r) {
        Real binomial = Real(1);
        for (int k = 0; k <= r; ++k) {
            Real weight = rows * binomial * x[r - k] * y[k] * p[n - 1 - r];
            int here = r * (r + 1) / 2 + k, next = (r + 1) * (r + 2) / 2 + k;
            a += weight * coefficient(first + here);
            b += weight * coefficient(first + next);
            c += weight * coefficient(first + next + 1);
            binomial = binomial * Real(r - k) / Real(k + 1);
        }
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
