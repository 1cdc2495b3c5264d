// From sums of coefficients to points, derivatives and normals, points side by side in the lanes. One code
// for scattered parameters, curves and grids.

// Divides by the weight, of derivatives by the rule for quotients. weight: of each slot.
template <int N, int K>
FF_INLINE void project(V (*s)[4], const V* weight) {
    constexpr int kCount = Slots<N, K>::kCount;
    const V r = reciprocal(weight[0]);
    each < N<3 ? kCount : -1>(
               kCount,
               [&](int k) FF_BODY {
                   each<4>(4, [&](int c) FF_BODY {
                       V v = s[k][c];
                       for (int t = 0; t < kSlots<N, K>.terms[k]; ++t) {
                           const auto& term = kSlots<N, K>.term[k][t];
                           v -= all(term.factor) * weight[term.weight] * s[term.rest][c];
                       }
                       s[k][c] = v * r;
                   });
               });
}

// The unit vectors of a x b.
FF_INLINE void unit_normals(const V* a, const V* b, V* n) {
    n[0] = a[1] * b[2] - a[2] * b[1], n[1] = a[2] * b[0] - a[0] * b[2], n[2] = a[0] * b[1] - a[1] * b[0];
    const V square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], r = reciprocal_root(square);
    for (int c = 0; c < 3; ++c) n[c] *= r;
    if (all_inside(square, all(1e-280), all(1e280), true)) return;
    // The length has left the range in which it is good to a few roundings.
    double u[3][kWidth], v[3][kWidth], out[3][kWidth], length[kWidth];
    for (int c = 0; c < 3; ++c) store(u[c], a[c]), store(v[c], b[c]), store(out[c], n[c]);
    store(length, square);
    for (int i = 0; i < kWidth; ++i) {
        if (length[i] > 1e-280 && length[i] < 1e280) continue;
        const double one[3] = {u[0][i], u[1][i], u[2][i]}, two[3] = {v[0][i], v[1][i], v[2][i]};
        double normal[3];
        careful_normal(one, two, normal);
        for (int c = 0; c < 3; ++c) out[c][i] = normal[c];
    }
    for (int c = 0; c < 3; ++c) n[c] = load(out[c]);
}

// Gaussian and mean curvature from the derivatives up to order 2, which are S, S_u, S_v, S_uu, S_uv, S_vv.
FF_INLINE void curvatures_of(const V (*s)[4], V* out) {
    const V *a = s[1], *b = s[2];
    const auto dot = [](const V* x, const V* y) FF_BODY { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
    const V n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const V square = dot(n, n), r = reciprocal_root(square);
    // Second fundamental form over the area S_u x S_v.
    const V second[3] = {dot(s[3], n) * r * r, dot(s[4], n) * r * r, dot(s[5], n) * r * r};
    out[0] = second[0] * second[2] - second[1] * second[1];
    out[1] =
        (second[0] * dot(b, b) - all(2) * second[1] * dot(a, b) + second[2] * dot(a, a)) * (r * all(0.5));
    if (all_inside(square, all(1e-280), all(1e280), true)) return;
    double jet[5][3][kWidth], some[2][kWidth], length[kWidth];
    for (int k = 0; k < 5; ++k)
        for (int c = 0; c < 3; ++c) store(jet[k][c], s[k + 1][c]);
    for (int k = 0; k < 2; ++k) store(some[k], out[k]);
    store(length, square);
    for (int i = 0; i < kWidth; ++i) {
        if (length[i] > 1e-280 && length[i] < 1e280) continue;
        double one[5][3], result[2];
        for (int k = 0; k < 5; ++k)
            for (int c = 0; c < 3; ++c) one[k][c] = jet[k][c][i];
        careful_curvatures(one, result);
        for (int k = 0; k < 2; ++k) some[k][i] = result[k];
    }
    for (int k = 0; k < 2; ++k) out[k] = load(some[k]);
}

// Two numbers of kWidth points, the first `left` of them.
FF_INLINE void put_two(Sink& sink, const V* s, int left) {
    double some[2 * kWidth], one[2][kWidth];
    for (int k = 0; k < 2; ++k) store(one[k], s[k]);
    for (int i = 0; i < kWidth; ++i)
        for (int k = 0; k < 2; ++k) some[2 * i + k] = one[k][i];
    if (left >= kWidth) {
        for (int k = 0; k < 2; ++k) sink.put(load(some + k * kWidth));
    } else {
        sink.put_few(some, 2 * left);
    }
}

// Three coordinates of kWidth points, the first `left` of them.
FF_INLINE void put_three(Sink& sink, const V* s, int left) {
    V v[3];
    interleave(s[0], s[1], s[2], v);
    if (left >= kWidth) {
        for (int c = 0; c < 3; ++c) sink.put(v[c]);
    } else {
        double some[3 * kWidth];
        for (int c = 0; c < 3; ++c) store(some + c * kWidth, v[c]);
        sink.put_few(some, 3 * left);
    }
}

// Where a batch goes. Of what is not points of three coordinates, a tile is collected and then put.
template <int N, int K>
struct Sinks {
    Sink jets, normals, curvatures;
    bool points = false;
    int collected = 0;
    alignas(64) double some[kTile * Slots<N, K>::kCount * 4];
};
template <int N, int K>
FF_INLINE void open(Sinks<N, K>& to, const Net& net, const Output& out) {
    to.jets.open(out.jets, out.past);
    if (out.normals) to.normals.open(out.normals, out.past);
    if (out.curvatures) to.curvatures.open(out.curvatures, out.past);
    to.points = out.slots == 1 && net.dim == 3;
    to.collected = 0;
}
template <int N, int K>
FF_INLINE void close(Sinks<N, K>& to, const Output& out) {
    to.jets.close();
    if (out.normals) to.normals.close();
    if (out.curvatures) to.curvatures.close();
}
// Puts what was collected.
template <int N, int K>
FF_INLINE void flush_tile(Sinks<N, K>& to) {
    int i = 0;
    for (; i + kWidth <= to.collected; i += kWidth) to.jets.put(load(to.some + i));
    if (i < to.collected) to.jets.put_few(to.some + i, to.collected - i);
    to.collected = 0;
}

// One vector of points, of which `left` are asked for.
template <int N, int K>
FF_SHARED void finish(const Net& net, V (*s)[4], int left, const Output& out, Sinks<N, K>& to) {
    constexpr int kCount = Slots<N, K>::kCount;
    if (to.points) {
        put_three(to.jets, s[0], left);
    } else {
        const int size = out.slots * net.dim;
        const bool straight = !to.jets.past && left >= kWidth;
        double* p = straight ? to.jets.to : to.some + to.collected;
        each < N<3 ? kCount : -1>(
                   kCount,
                   [&](int k) FF_BODY {
                       if (k < out.slots) emit(p + k * net.dim, s[k], net.dim, size);
                   });
        if (straight)
            to.jets.to += kWidth * size;
        else
            to.collected += (left < kWidth ? left : kWidth) * size;
    }
    if constexpr (N == 2 && K > 0) {
        if (out.normals) {
            V n[3];
            unit_normals(s[1], s[2], n);
            put_three(to.normals, n, left);
        }
    }
    if constexpr (N == 2 && K == 2) {
        if (out.curvatures) {
            V k[2];
            curvatures_of(s, k);
            put_two(to.curvatures, k, left);
        }
    }
}

// The sums over the coefficients of one vector of a tile, of which `left` are asked for. h: for each slot and
// plane those of the tile, four numbers each. A single one is spread: memory would make a vector wait for
// what has just been stored in parts.
template <int N, int K>
FF_INLINE void sums_of(const Net& net, const double* h, int g, int left, V (*s)[4], V* weight) {
    constexpr int kCount = Slots<N, K>::kCount;
    const int planes = net.planes();
    each < N<3 ? kCount : -1>(
               kCount,
               [&](int k) FF_BODY {
                   const double* from = h + k * planes * 4 * kTile + 4 * g;
                   if (left == 1) {
                       for (int c = 0; c < 4; ++c) s[k][c] = all(from[c]);
                       weight[k] = all(from[(planes - 1) * 4 * kTile + 3]);
                       return;
                   }
                   transpose(from, s[k]);
                   weight[k] = s[k][3];
                   if (planes == 2) {
                       V second[4];
                       transpose(from + 4 * kTile, second);
                       weight[k] = second[3];
                   }
               });
}

// The same of a curve whose parameters share half a span: the operations are those of a single point.
template <int K>
FF_INLINE void sums_of_run(const Axis& axis, const Local& l, int g, V (*s)[4], V* weight) {
    const int p = axis.degree, lanes = axis.lanes;
    const double* column = l.record[g] + l.columns[g];
    const V r = load(l.ratio + g);
    each<K + 1>(K + 1, [&](int o) FF_BODY {
        V x = all(0), y = x, z = x, w = x, second = x;
        if (o <= p) {
            x = all(column[0]), y = all(column[1]), z = all(column[2]), w = all(column[3]);
            if (lanes == 8) second = all(column[7]);
            column += lanes;
        }
        for (int k = 0; k < p - o; ++k, column += lanes) {
            x = x * r + all(column[0]), y = y * r + all(column[1]), z = z * r + all(column[2]);
            w = w * r + all(column[3]);
            if (lanes == 8) second = second * r + all(column[7]);
        }
        s[o][0] = x, s[o][1] = y, s[o][2] = z, s[o][3] = w;
        weight[o] = lanes == 8 ? second : w;
    });
}

// The factors that the weights of the axes were left without, those of a rational one once it is projected:
// what the values share has cancelled there.
template <int N, int K>
FF_INLINE void put_factors(const Net& net, const Local* l, int g, V (*s)[4]) {
    constexpr int kCount = Slots<N, K>::kCount;
    V inverse[N], scale = all(1);
    for (int d = 0; d < N; ++d) {
        inverse[d] = load(l[d].inverse + g);
        if (!net.rational) scale = d == 0 ? load(l[d].scale + g) : scale * load(l[d].scale + g);
    }
    each < N<3 ? kCount : -1>(
               kCount,
               [&](int k) FF_BODY {
                   if (k == 0 && net.rational) return;
                   V factor = scale;
                   const int order[3] = {N == 3 ? kSlots<N, K>.a[k] : kSlots<N, K>.b[k], kSlots<N, K>.b[k],
                                         kSlots<N, K>.last[k]};
                   for (int d = 0; d < N; ++d)
                       for (int o = 0; o < (d == N - 1 ? order[2] : order[d]); ++o) factor *= inverse[d];
                   each<4>(4, [&](int c) FF_BODY { s[k][c] *= factor; });
               });
}

template <int N, int K>
__attribute__((noinline)) static void finish_tile(const Net& net, const double* h, const Local* l, int n,
                                                  const Output& out, Sinks<N, K>& to) {
    for (int g = 0; g < n; g += kWidth) {
        V s[Slots<N, K>::kCount][4], weight[Slots<N, K>::kCount];
        if (N == 1 && l->uniform[g / kWidth])
            sums_of_run<(N == 1 ? K : 0)>(net.axis[0], *l, g, s, weight);
        else
            sums_of<N, K>(net, h, g, n - g, s, weight);
        if (net.rational) project<N, K>(s, weight);
        if (K > 0 || !net.rational) put_factors<N, K>(net, l, g, s);
        finish<N, K>(net, s, n - g, out, to);
    }
    flush_tile(to);
}
