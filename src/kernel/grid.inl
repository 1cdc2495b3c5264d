// Rows of tensor grids, parameters in the lanes.
//
// Sum factorisation: the outer axes are contracted once for a row, what is left is a curve with (q + 1)
// products a coordinate. A vector of parameters that lies in one span broadcasts the coefficients of it; one
// that lies across spans is the sum over them, with weights 0 for the parameters of the others, so that all
// vectors of the output are full whatever the order of the parameters is.

template <int N, int K, int C>
FF_INLINE void grid_sums(const GridAxis& last, const double* outer, std::size_t row, int part, int parts,
                         V (*s)[4], V* weight) {
    constexpr int kCount = Slots<N, K>::kCount, kEach = N < 3 ? kCount : -1;
    const std::size_t second = row / 2;
    const int p = last.degree;
    // C == 3: there are no weights. C == 5: they are in the second plane.
    each<kEach>(kCount, [&](int k) FF_BODY {
        V x = all(0), y = x, z = x, w = x, u = x;
        const double* b = last.weights + std::size_t(part) * last.stride() +
                          std::size_t(kSlots<N, K>.last[k] * (p + 1) * kWidth);
        for (int i = part; i < part + parts; ++i, b += last.stride()) {
            const double* from =
                outer + std::size_t(kSlots<N, K>.outer[k]) * row + std::size_t(last.part[i].first) * 4;
            for (int j = 0; j <= p; ++j, from += 4) {
                const V f = load(b + j * kWidth);
                x += all(from[0]) * f, y += all(from[1]) * f, z += all(from[2]) * f;
                if (C > 3) w += all(from[3]) * f;
                if (C == 5) u += all(from[second + 3]) * f;
            }
        }
        s[k][0] = x, s[k][1] = y, s[k][2] = z, s[k][3] = w;
        weight[k] = C == 5 ? u : w;
    });
}

template <int N, int K, int C>
__attribute__((noinline)) static void grid_row_of(const Net& net, const GridAxis& last, const double* outer,
                                                  std::size_t row, const Output& out) {
    Sinks<N, K> to;
    open(to, net, out);
    for (int part = 0; part < last.parts;) {
        const int group = last.part[part].group;
        int end = part + 1;
        while (end < last.parts && last.part[end].group == group) ++end;
        V s[Slots<N, K>::kCount][4], weight[Slots<N, K>::kCount];
        grid_sums<N, K, C>(last, outer, row, part, end - part, s, weight);
        if (net.rational) project<N, K>(s, weight);
        finish<N, K>(net, s, last.count - group * kWidth, out, to);
        if (to.collected > 0 && (end == last.parts || (group + 1) * kWidth % kTile == 0)) flush_tile(to);
        part = end;
    }
    close(to, out);
}

// Points of three coordinates: several vectors at once, since each of them is a chain of dependent operations
// that a processor cannot look past.
template <int P, bool Rational>
__attribute__((noinline)) static void grid_points(const GridAxis& last, const double* outer,
                                                  const Output& out) {
    constexpr int kBlock = 2;
    const int p = P >= 0 ? P : last.degree, groups = (last.count + kWidth - 1) / kWidth, parts = last.parts;
    const GridPart* part = last.part;
    const double* weights = last.weights;
    const std::size_t stride = last.stride();
    Sink to;
    to.open(out.jets, out.past);
    for (int group = 0, at = 0; group < groups; group += kBlock) {
        // Most blocks lie in one span: a coefficient is spread over the lanes once for all vectors, and
        // nothing leaves the registers.
        if (at + 1 < parts && part[at + 1].group == group + 1 && part[at + 1].first == part[at].first &&
            (at + 2 == parts || part[at + 2].group != group + 1) && (group + kBlock) * kWidth <= last.count) {
            const double* from = outer + std::size_t(part[at].first) * 4;
            const double *w0 = weights, *w1 = weights + stride;
            V x0 = all(0), y0 = x0, z0 = x0, u0 = x0, x1 = x0, y1 = x0, z1 = x0, u1 = x0, v[3 * kBlock];
            each<P >= 0 ? P + 1 : -1>(p + 1, [&](int j) FF_BODY {
                const V f = load(w0 + j * kWidth), g = load(w1 + j * kWidth);
                const V a = all(from[4 * j]), b = all(from[4 * j + 1]), c = all(from[4 * j + 2]);
                x0 += a * f, y0 += b * f, z0 += c * f;
                x1 += a * g, y1 += b * g, z1 += c * g;
                if constexpr (Rational) {
                    const V d = all(from[4 * j + 3]);
                    u0 += d * f, u1 += d * g;
                }
            });
            if constexpr (Rational) {
                const V r0 = reciprocal(u0), r1 = reciprocal(u1);
                x0 *= r0, y0 *= r0, z0 *= r0, x1 *= r1, y1 *= r1, z1 *= r1;
            }
            interleave(x0, y0, z0, v), interleave(x1, y1, z1, v + 3);
            to.template put_all<3 * kBlock>(v);
            at += kBlock, weights += kBlock * stride;
            continue;
        }
        V s[kBlock][4], w[kBlock], v[3 * kBlock];
        each<kBlock>(kBlock, [&](int q) FF_BODY {
            V x = all(0), y = x, z = x, u = x;
            if (group + q >= groups) u = all(1);
            for (; at < parts && part[at].group == group + q; ++at, weights += stride) {
                const double* from = outer + std::size_t(part[at].first) * 4;
                each<P >= 0 ? P + 1 : -1>(p + 1, [&](int j) FF_BODY {
                    const V f = load(weights + j * kWidth);
                    x += all(from[4 * j]) * f, y += all(from[4 * j + 1]) * f;
                    z += all(from[4 * j + 2]) * f, u += all(from[4 * j + 3]) * f;
                });
            }
            s[q][0] = x, s[q][1] = y, s[q][2] = z, w[q] = u;
        });
        if constexpr (Rational) {
            each<kBlock>(kBlock, [&](int q) FF_BODY {
                const V r = reciprocal(w[q]);
                each<3>(3, [&](int c) FF_BODY { s[q][c] *= r; });
            });
        }
        if ((group + kBlock) * kWidth <= last.count) {
            each<kBlock>(kBlock, [&](int q) FF_BODY { interleave(s[q][0], s[q][1], s[q][2], v + 3 * q); });
            to.template put_all<3 * kBlock>(v);
        } else {
            for (int q = 0; q < kBlock && group + q < groups; ++q)
                put_three(to, s[q], last.count - (group + q) * kWidth);
        }
    }
    to.close();
}

static void grid_row(const Net& net, const GridAxis& last, const double* outer, std::size_t row,
                     const Output& out) {
    if (out.order == 0 && net.axes == 2 && net.dim == 3) {
#if defined(__wasm__)  // modules are to be small
        if (last.degree == 3 && net.rational) return grid_points<3, true>(last, outer, out);
#else
        if (last.degree == 3)
            return net.rational ? grid_points<3, true>(last, outer, out)
                                : grid_points<3, false>(last, outer, out);
#endif
        return net.rational ? grid_points<-1, true>(last, outer, out)
                            : grid_points<-1, false>(last, outer, out);
    }
    const auto with_order = [&]<int N, int C>() {
        if (out.order == 0) return grid_row_of<N, 0, C>(net, last, outer, row, out);
        if (out.order == 1) return grid_row_of<N, 1, C>(net, last, outer, row, out);
        return grid_row_of<N, 2, C>(net, last, outer, row, out);
    };
    if (net.axes == 3 && net.planes() == 2) return with_order.template operator()<3, 5>();
    if (net.axes == 3) return with_order.template operator()<3, 4>();
    if (net.planes() == 2) return with_order.template operator()<2, 5>();
    return with_order.template operator()<2, 4>();
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

static void flush() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

static bool inside(const double* at, std::size_t n, int axes, const double* lo, const double* hi) {
    constexpr std::size_t kAtOnce = 4;  // so that nothing waits for the comparison before
    std::size_t i = 0;
    bool fine = true;
    if (axes < 3) {
        V low = all(lo[0]), high = all(hi[0]);
        for (int k = 1; k < kWidth; k += 2) low[k] = lo[axes - 1], high[k] = hi[axes - 1];
        I ok[kAtOnce];
        each<kAtOnce>(0, [&](int k) FF_BODY { ok[k] = all(0) == all(0); });
        for (; i + kAtOnce * std::size_t(kWidth) <= n; i += kAtOnce * std::size_t(kWidth))
            each<kAtOnce>(0, [&](int k) FF_BODY {
                const V x = load(at + i + k * kWidth);
                ok[k] &= (x >= low) & (x <= high);
            });
        for (; i + std::size_t(kWidth) <= n; i += std::size_t(kWidth)) {
            const V x = load(at + i);
            ok[0] &= (x >= low) & (x <= high);
        }
        fine = all_of(ok[0] & ok[1] & ok[2] & ok[3]);
    }
    for (; i < n; ++i) {
        const std::size_t d = i % std::size_t(axes);
        fine &= (at[i] >= lo[d]) & (at[i] <= hi[d]);
    }
    return fine;
}
