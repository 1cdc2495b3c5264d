// Scattered parameters.
//
// Idea. In a tile of 64 parameters the spans are found, and where in them the parameters are, with parameters
// side by side in the lanes (locate.inl). Then each point by itself, with coordinates (x, y, z, w) side by
// side: the weights of its span by Horner's rule, and the (p + 1)^N coefficients are contracted
// first along the outer axes, then along the last, two coefficients in a vector of 512 bits. Last, points
// side by side again, the projection (finish.inl), and the factors that the weights have been left without.
// On curves, where neighbouring parameters often share a span, whole vectors of parameters that do are
// evaluated side by side throughout.
//
// The three loops over a tile keep many points in flight: one point is a chain of dependent operations from
// the search of its span to the quotient, far longer than what a processor looks ahead.
//
// Every point goes through the same operations wherever it is in the batch, so results do not depend on how
// a batch is cut into pieces.
//
// Why not: grouping the points of a surface by span, with parameters in the lanes throughout, has as many
// products a point and in addition moves every parameter and every point through memory once more, at random.

// The functions of one point, without the factors of inverse and scale: `groups` vectors of four for each
// order up to K.
template <int P, int Groups, int K>
FF_INLINE void functions(const Axis& axis, const Local& l, int i, int groups, V4* out) {
    const int p = P >= 0 ? P : axis.degree;
    const double* column = l.record[i] + l.columns[i];
    const V4 r = all4(l.ratio[i]);
    each<K + 1>(K + 1, [&](int o) FF_BODY {
        const auto start = [&] FF_BODY {
            each<Groups>(groups, [&](int v) FF_BODY { out[o * groups + v] = load4(column + 4 * v); });
            column += 4 * groups;
        };
        const auto step = [&] FF_BODY {
            each<Groups>(groups, [&](int v) FF_BODY {
                V4& sum = out[o * groups + v];
                sum = sum * r + load4(column + 4 * v);
            });
            column += 4 * groups;
        };
        if (o > p)
            each<Groups>(groups, [&](int v) FF_BODY { out[o * groups + v] = all4(0); });
        else
            start();
        if constexpr (P >= 0)
            each<P>(P, [&](int k) FF_BODY {
                if (k < P - o) step();
            });
        else
            for (int k = 0; k < p - o; ++k) step();
    });
}

// Sums over the coefficients of one point, 4 numbers for each slot and plane, those of a tile together.
template <int P, int K>
FF_INLINE void contract_curve(const Net& net, const Local& l, int i, double* h) {
    V4 f[2 * (K + 1)];
    const int planes = P >= 0 ? 1 : net.planes();
    if (planes == 1)
        functions<P, 1, K>(net.axis[0], l, i, 1, f);
    else
        functions<P, 2, K>(net.axis[0], l, i, 2, f);
    for (int k = 0; k < (K + 1) * planes; ++k) store4(h + 4 * kTile * k, f[k]);
}

// Lanes of the weights of degree P in one order.
template <int P>
inline constexpr int kLanes = (P + 4) / 4 * 4;

// The functions of a tile: for each point and order kLanes<P> numbers.
template <int P, int K>
__attribute__((noinline)) static void functions_tile(const Axis& axis, const Local& l, int n, double* out) {
    constexpr int kGroups = kLanes<P> / 4;
    V4 f[(K + 1) * kGroups];
    for (int i = 0; i < n; ++i, out += (K + 1) * kLanes<P>) {
        functions<P, kGroups, K>(axis, l, i, kGroups, f);
        each<(K + 1) * kGroups>(0, [&](int k) FF_BODY { store4(out + 4 * k, f[k]); });
    }
}

// The sums of one point from the weights of its axes. The outer ones are loaded one by one: a number from
// memory is spread at no cost, one in a vector takes the unit that everything else is waiting for.
template <int P, int N, int K>
FF_INLINE void contract(const Net& net, const Local* l, int i, const double* const* w, double* h) {
    constexpr int kVectors = P >= 0 ? (P + kPerVector) / kPerVector : -1, kCount = Slots<N, K>::kCount;
    constexpr int kVectorsAtMost = kLanes<(P >= 0 ? P : kMaxDegree)> / kPerVector;
    const Axis& last = net.axis[N - 1];
    const int p = P >= 0 ? P : last.degree;
    const int vectors = (p + kPerVector) / kPerVector, planes = P >= 0 ? 1 : net.planes();
    int lanes[N];
    for (int d = 0; d < N; ++d) lanes[d] = P >= 0 ? kLanes<(P >= 0 ? P : 0)> : net.axis[d].lanes;
    const double* base = net.coefficients;
    for (int d = 0; d < N; ++d) base += span_of(l[d].record[i]).coefficients;
    for (int q = 0; q < planes; ++q, base += net.plane) {
        V sum[Slots<N, K>::kOuter][kVectorsAtMost];
        if constexpr (N == 2) {
            each<P >= 0 ? P + 1 : -1>(net.axis[0].degree + 1, [&](int r) FF_BODY {
                const double* row = base + std::size_t(r) * net.stride[0];
                each<kVectors>(vectors, [&](int v) FF_BODY {
                    const V c = load(row + v * kWidth);
                    each<K + 1>(0, [&](int o) FF_BODY {
                        const V weight = all(w[0][o * lanes[0] + r]);
                        sum[o][v] = r == 0 ? weight * c : sum[o][v] + weight * c;
                    });
                });
            });
        } else {
            each<Slots<N, K>::kOuter>(0, [&](int o) FF_BODY {
                for (int v = 0; v < vectors; ++v) sum[o][v] = all(0);
            });
            for (int r = 0; r <= net.axis[0].degree; ++r)
                for (int m = 0; m <= net.axis[1].degree; ++m) {
                    const double* row =
                        base + std::size_t(r) * net.stride[0] + std::size_t(m) * net.stride[1];
                    for (int s = 0; s < kCount; ++s) {
                        if (kSlots<N, K>.last[s] != 0) continue;
                        const V weight = all(w[0][kSlots<N, K>.a[s] * lanes[0] + r] *
                                             w[1][kSlots<N, K>.b[s] * lanes[1] + m]);
                        for (int v = 0; v < vectors; ++v)
                            sum[kSlots<N, K>.outer[s]][v] += weight * load(row + v * kWidth);
                    }
                }
        }
        each < N<3 ? kCount : -1>(
                   kCount,
                   [&](int s) FF_BODY {
                       V total = all(0);
                       each<kVectors>(vectors, [&](int v) FF_BODY {
                           const int j = v * kPerVector;
                           const V weight =
                               spread(load4(w[N - 1] + kSlots<N, K>.last[s] * lanes[N - 1] + j / 4 * 4),
                                      j % 4 / kPerVector);
                           const V part = sum[kSlots<N, K>.outer[s]][v];
                           total = v == 0 ? part * weight : total + part * weight;
                       });
                       store4(h + 4 * kTile * (s * planes + q), fold(total));
                   });
    }
}

template <int P, int N, int K>
__attribute__((noinline)) static void contract_tile(const Net& from, const Local* l, int n, double* h) {
    const Net net = from;  // what is stored cannot change it
    if constexpr (N == 1) {
        for (int g = 0; g < n; g += kWidth)
            for (int i = g; i < g + kWidth && i < n && !l[0].uniform[g / kWidth]; ++i)
                contract_curve<P, K>(net, l[0], i, h + 4 * i);
    } else if constexpr (P >= 0) {
        constexpr int kSize = (K + 1) * kLanes<P>;
        alignas(64) double w[N][kTile * kSize];
        for (int d = 0; d < N; ++d) functions_tile<P, K>(net.axis[d], l[d], n, w[d]);
        for (int i = 0; i < n; ++i) {
            const double* of_point[N];
            for (int d = 0; d < N; ++d) of_point[d] = w[d] + i * kSize;
            contract<P, N, K>(net, l, i, of_point, h + 4 * i);
        }
    } else {
        V4 f[N][(K + 1) * kLanes<kMaxDegree> / 4];
        const double* w[N];
        for (int d = 0; d < N; ++d) w[d] = reinterpret_cast<const double*>(f[d]);
        for (int i = 0; i < n; ++i) {
            for (int d = 0; d < N; ++d)
                functions<P, -1, K>(net.axis[d], l[d], i, net.axis[d].lanes / 4, f[d]);
            contract<P, N, K>(net, l, i, w, h + 4 * i);
        }
    }
}

// What the lanes behind the last point are computed from; nobody asks for it, but they must hold numbers. (A
// single last one is spread over all of them.)
template <int N, int K>
FF_INLINE void repeat_last(const Net& net, int n, double* h) {
    for (int k = 0; k < Slots<N, K>::kCount * net.planes(); ++k, h += 4 * kTile)
        for (int i = n; i % kWidth != 0; ++i) store4(h + 4 * i, load4(h + 4 * (n - 1)));
}

// Asks for the n numbers that follow some pages later: processors stop fetching ahead where a page ends.
// Behind the end of the parameters this does nothing.
FF_INLINE void fetch_ahead(const double* at, int n) {
    const std::size_t from = reinterpret_cast<std::size_t>(at) + 8 * std::size_t(n) * sizeof(double);
    for (std::size_t i = 0; i < std::size_t(n) * sizeof(double); i += 64)
        __builtin_prefetch(reinterpret_cast<const void*>(from + i));
}

template <int N, int K>
__attribute__((noinline)) static void scattered_of(const Net& net, const double* at, std::size_t count,
                                                   const Output& out) {
    Local local[N];
    alignas(64) double h[kTile * Slots<N, K>::kCount * 8];
    Sinks<N, K> to;
    open(to, net, out);
    const bool plain = net.planes() == 1 && (N == 1 || (N == 2 && net.axis[0].degree == net.axis[1].degree));
    for (std::size_t from = 0; from < count; from += kTile, at += N * kTile) {
        const int n = int(count - from < std::size_t(kTile) ? count - from : std::size_t(kTile));
        if (N > 1 && out.past) fetch_ahead(at, N * kTile);
        for (int d = 0; d < N; ++d) locate(net.axis[d], at, N, d, n, N == 1, !net.rational, local[d]);
        with_degree(plain ? net.axis[0].degree : -1, [&]<int P>(Degree<P>) FF_BODY {
            contract_tile<N == 3 ? -1 : P, N, K>(net, local, n, h);
        });
        if (n % kWidth > 1) repeat_last<N, K>(net, n, h);
        finish_tile<N, K>(net, h, local, n, out, to);
    }
    close(to, out);
}

static void scattered(const Net& net, const double* at, std::size_t n, const Output& out) {
    const auto with_order = [&]<int N>() {
        if (out.order == 0) return scattered_of<N, 0>(net, at, n, out);
        if (out.order == 1) return scattered_of<N, 1>(net, at, n, out);
        return scattered_of<N, 2>(net, at, n, out);
    };
    if (net.axes == 1) return with_order.template operator()<1>();
    if (net.axes == 2) return with_order.template operator()<2>();
    return with_order.template operator()<3>();
}

static void weights(const Axis& axis, const double* at, std::size_t count, int order, double* out,
                    int* first) {
    Local l;
    V4 f[(kMaxOrder + 1) * (kMaxDegree + 4) / 4];
    const std::size_t size = std::size_t(order + 1) * std::size_t(axis.lanes);
    for (std::size_t from = 0; from < count; from += kTile) {
        const int n = int(count - from < std::size_t(kTile) ? count - from : std::size_t(kTile));
        locate(axis, at + from, 1, 0, n, false, true, l);
        for (int i = 0; i < n; ++i) {
            functions<-1, -1, kMaxOrder>(axis, l, i, axis.lanes / 4, f);
            double* to = out + (from + std::size_t(i)) * size;
            double factor = l.scale[i];
            for (int o = 0, k = 0; o <= order; ++o, factor *= l.inverse[i])
                for (int v = 0; v < axis.lanes / 4; ++v, ++k) store4(to + 4 * k, f[k] * all4(factor));
            first[from + std::size_t(i)] = span_of(l.record[i]).first;
        }
    }
}
