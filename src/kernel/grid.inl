// Rows of tensor grids, parameters in the lanes.
//
// Sum factorisation: the outer axes are contracted once for a row, what is left is a curve with (q + 1)
// products a coordinate. A vector of parameters that lies in one span broadcasts the coefficients of it; one
// that lies across spans is the sum over them, with weights 0 for the parameters of the others, so that all
// vectors of the output are full whatever the order of the parameters is.

template <int P, int N, int K, int C>
FF_INLINE void grid_group(const Net& net, const GridAxis& last, const double* outer, std::size_t row,
                          int part, int parts, const Output& out, double* jets, double* normals) {
    constexpr int kCount = Slots<N, K>::kCount, kEach = N < 3 ? kCount : -1;
    const int p = P >= 0 ? P : last.degree;
    // Coordinates, and those to be projected; C == 5: the weight is in the second plane.
    constexpr int kCoords = C == 5 ? 4 : C, kProjected = C == 5 ? 4 : 3;
    const std::size_t second = row / 2 + 3;
    V s[kCount][4], weight[kCount];
    each<kEach>(kCount, [&](int k) FF_BODY {
        weight[k] = all(0);
        for (int c = 0; c < 4; ++c) s[k][c] = all(0);
    });
    for (int i = part; i < part + parts; ++i) {
        const double* w = last.weights + std::size_t(i) * last.stride();
        const double* base = outer + std::size_t(last.part[i].first) * 4;
        each<P >= 0 ? P + 1 : -1>(p + 1, [&](int j) FF_BODY {
            each<kEach>(kCount, [&](int k) FF_BODY {
                const V b = load(w + (kSlots<N, K>.last[k] * (p + 1) + j) * kWidth);
                const double* from = base + std::size_t(kSlots<N, K>.outer[k]) * row + 4 * j;
                each<kCoords>(0, [&](int c) FF_BODY { s[k][c] += all(from[c]) * b; });
                if (C == 5) weight[k] += all(from[second]) * b;
            });
        });
    }
    if (net.rational) {
        if (C < 5) each<kEach>(kCount, [&](int k) FF_BODY { weight[k] = s[k][3]; });
        const V r = reciprocal(weight[0]);
        each<kEach>(kCount, [&](int k) FF_BODY {
            each<kProjected>(0, [&](int c) FF_BODY {
                V v = s[k][c];
                for (int t = 0; t < kSlots<N, K>.terms[k]; ++t) {
                    const auto& term = kSlots<N, K>.term[k][t];
                    v -= all(term.factor) * weight[term.weight] * s[term.rest][c];
                }
                s[k][c] = v * r;
            });
        });
    }
    each<kEach>(kCount, [&](int k) FF_BODY {
        if (k < out.slots) emit(jets + k * net.dim, s[k], net.dim, out.slots * net.dim);
    });
    if constexpr (N == 2 && K > 0) {
        if (!normals) return;
        const V *a = s[1], *b = s[2];
        V n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        const V square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], r = reciprocal_root(square);
        for (int c = 0; c < 3; ++c) n[c] *= r;
        store_points(normals, n[0], n[1], n[2]);
        if (all_inside(square, all(1e-280), all(1e280), true)) return;
        for (int i = 0; i < kWidth; ++i) {
            if (square[i] > 1e-280 && square[i] < 1e280) continue;
            const double u[3] = {a[0][i], a[1][i], a[2][i]}, v[3] = {b[0][i], b[1][i], b[2][i]};
            careful_normal(u, v, normals + 3 * i);
        }
    }
}

template <int P, int N, int K, int C>
__attribute__((noinline)) static void grid_row_of(const Net& net, const GridAxis& last, const double* outer,
                                                  std::size_t row, const Output& out) {
    const int size = out.slots * net.dim;
    for (int part = 0; part < last.parts;) {
        const int group = last.part[part].group;
        int end = part + 1;
        while (end < last.parts && last.part[end].group == group) ++end;
        const int at = group * kWidth, n = last.count - at < kWidth ? last.count - at : kWidth;
        double* jets = out.jets + std::ptrdiff_t(at) * size;
        double* normals = out.normals ? out.normals + std::ptrdiff_t(at) * 3 : nullptr;
        if (n == kWidth) {
            grid_group<P, N, K, C>(net, last, outer, row, part, end - part, out, jets, normals);
        } else {
            double some[kWidth * Slots<N, K>::kCount * 4] = {}, few[kWidth * 3] = {};
            grid_group<P, N, K, C>(net, last, outer, row, part, end - part, out, some,
                                   normals ? few : nullptr);
            for (int i = 0; i < n * size; ++i) jets[i] = some[i];
            for (int i = 0; normals && i < 3 * n; ++i) normals[i] = few[i];
        }
        part = end;
    }
}

static void grid_row(const Net& net, const GridAxis& last, const double* outer, std::size_t row,
                     const Output& out) {
    const bool three = !net.rational && net.dim < 4;  // nothing is in the fourth place
    const auto rare = [&]<int N, int C>() {
        if (out.order == 0) return grid_row_of<-1, N, 0, C>(net, last, outer, row, out);
        if (out.order == 1) return grid_row_of<-1, N, 1, C>(net, last, outer, row, out);
        return grid_row_of<-1, N, 2, C>(net, last, outer, row, out);
    };
    if (net.axes == 3 && net.planes() == 2) return rare.template operator()<3, 5>();
    if (net.axes == 3) return rare.template operator()<3, 4>();
    if (net.planes() == 2) return rare.template operator()<2, 5>();
    with_degree(last.degree, [&]<int P>(Degree<P>) {
        if (out.order == 0 && three) return grid_row_of<P, 2, 0, 3>(net, last, outer, row, out);
        if (out.order == 0) return grid_row_of<P, 2, 0, 4>(net, last, outer, row, out);
        if (out.order == 1) return grid_row_of<P, 2, 1, 4>(net, last, outer, row, out);
        return grid_row_of < P == 3 ? 3 : -1, 2, 2, 4 > (net, last, outer, row, out);
    });
}

static void combine(const double* const* from, const double* w, int terms, double* sum, std::size_t n) {
    std::size_t i = 0;
    for (; i + std::size_t(kWidth) <= n; i += std::size_t(kWidth)) {
        V s = all(0);
        for (int k = 0; k < terms; ++k) s += all(w[k]) * load(from[k] + i);
        store(sum + i, s);
    }
    for (; i < n; i += 4) {  // n is a multiple of 4
        V4 s = all4(0);
        for (int k = 0; k < terms; ++k) s += all4(w[k]) * load4(from[k] + i);
        store4(sum + i, s);
    }
}

static void stream(double* to, const double* from, std::size_t n) {
    std::size_t i = 0;
    for (; i < n && reinterpret_cast<std::size_t>(to + i) % sizeof(V) != 0; ++i) to[i] = from[i];
    for (; i + std::size_t(kWidth) <= n; i += std::size_t(kWidth)) store_past(to + i, load(from + i));
    for (; i < n; ++i) to[i] = from[i];
}

static void flush() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

static bool inside(const double* at, std::size_t n, int axes, const double* lo, const double* hi) {
    std::size_t i = 0;
    I ok = all(0) == all(0);
    if (axes < 3) {
        V low = all(lo[0]), high = all(hi[0]);
        for (int k = 1; k < kWidth; k += 2) low[k] = lo[axes - 1], high[k] = hi[axes - 1];
        for (; i + std::size_t(kWidth) <= n; i += std::size_t(kWidth)) {
            const V x = load(at + i);
            ok &= (x >= low) & (x <= high);
        }
    }
    bool fine = true;
    for (int k = 0; k < kWidth; ++k) fine &= ok[k] != 0;
    for (; i < n; ++i) {
        const std::size_t d = i % std::size_t(axes);
        fine &= (at[i] >= lo[d]) & (at[i] <= hi[d]);
    }
    return fine;
}
