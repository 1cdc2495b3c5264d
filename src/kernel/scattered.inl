// Scattered parameters.
//
// Idea. In a tile of 64 parameters the Bernstein polynomials are computed with parameters side by side in the
// lanes. Then each point by itself, with coordinates (x, y, z, w) side by side: the weights of its span are
// matrix times polynomials, and the (p + 1)^N coefficients are contracted first along the outer axes, then
// along the last, two coefficients in a vector of 512 bits. Last the projection of the tile. On curves, where
// neighbouring parameters often share a span, whole vectors of parameters that do are evaluated side by side.
//
// Every point goes through the same operations wherever it is in the batch, so results do not depend on how
// a batch is cut into pieces.
//
// Why not: grouping the points of a surface by span, with parameters in the lanes throughout, has as many
// products a point and in addition moves every parameter and every point through memory once more, at random.

struct Local {
    double x[kTile], lo[kTile], hi[kTile], inverse[kTile];
    int span[kTile], uniform[kTile / kWidth];  // uniform: of a whole vector of parameters, the span, or -1
    double bernstein[kMaxOrder + 1][(kMaxDegree + 1) * kTile];
};

FF_INLINE int span_of(const Axis& axis, double x) {
    int k = int((x - axis.lo) * axis.scale);
    k = k < axis.buckets ? k : axis.buckets - 1;
    int s = axis.bucket[k];
    for (int h = (axis.steps + 1) / 2; h > 0; h /= 2) s += x >= axis.starts[s + h] ? h : 0;
    return s;
}

// Spans of the first n parameters of the tile; the rest of the last vector repeats the last one.
FF_INLINE void locate(const Axis& axis, Local& l, int n, bool look_for_runs) {
    for (int i = n; i % kWidth != 0; ++i) l.x[i] = l.x[n - 1];
    const Span* spans = axis.span;
    const int* bucket = axis.bucket;
    const double* starts = axis.starts;
    const int last = axis.buckets - 1, steps = axis.steps;
    int known = -1;
    for (int g = 0; g < n; g += kWidth) {
        if (look_for_runs) {
            const V x = load(l.x + g);
            const int guess = known >= 0 ? known : span_of(axis, l.x[g]);
            const Span& s = axis.span[guess];
            const bool same = all_inside(x, all(s.lo), all(s.hi), guess == axis.spans - 1);
            l.uniform[g / kWidth] = same ? guess : -1;
            known = same ? guess : -1;
            if (same) {
                store(l.lo + g, all(s.lo)), store(l.hi + g, all(s.hi)), store(l.inverse + g, all(s.inverse));
                for (int i = g; i < g + kWidth; ++i) l.span[i] = guess;
                continue;
            }
        }
        double place[kWidth];  // span_of() of every lane
        store(place, (load(l.x + g) - all(axis.lo)) * all(axis.scale));
        for (int k = 0; k < kWidth; ++k) {
            const int i = g + k, b = int(place[k]);
            int at = bucket[b < last ? b : last];
            if (steps == 1)
                at += l.x[i] >= starts[at + 1];
            else
                for (int h = (steps + 1) / 2; h > 0; h /= 2) at += l.x[i] >= starts[at + h] ? h : 0;
            const Span& s = spans[at];
            l.span[i] = at, l.lo[i] = s.lo, l.hi[i] = s.hi, l.inverse[i] = s.inverse;
        }
    }
}

// All Bernstein polynomials of degrees p, p - 1 .. p - order of the tile: the recurrence of sums of
// non-negative numbers.
template <int P>
FF_INLINE void bernstein_of(int degree, int order, Local& l, int n) {
    const int p = P >= 0 ? P : degree;
    for (int g = 0; g < n; g += kWidth) {
        const V one = all(1), x = load(l.x + g), inverse = load(l.inverse + g);
        V t = (x - load(l.lo + g)) * inverse, s = (load(l.hi + g) - x) * inverse;
        t = t < one ? t : one, s = s < one ? s : one;
        V b[(P >= 0 ? P : kMaxDegree) + 1];
        b[0] = one;
        const auto keep = [&](int m) FF_BODY {
            if (p - m > order || p - m > kMaxOrder) return;
            double* to = l.bernstein[p - m] + g;
            for (int k = 0; k <= m; ++k) store(to + k * kTile, b[k]);
        };
        keep(0);
        each<P>(p, [&](int lower) FF_BODY {
            const int m = lower + 1;
            b[m] = b[lower] * t;
            for (int k = lower; k > 0; --k) b[k] = b[k] * s + b[k - 1] * t;
            b[0] = b[0] * s;
            keep(m);
        });
    }
}
static void bernstein(const Axis& axis, int order, Local& l, int n) {
    with_degree(axis.degree, [&]<int P>(Degree<P>) { bernstein_of<P>(axis.degree, order, l, n); });
}

// The functions of one point: `groups` vectors of four for each order up to K.
template <int P, int Groups, int K>
FF_INLINE void functions(const Axis& axis, const Local& l, int i, int groups, V4* out) {
    const int p = P >= 0 ? P : axis.degree;
    const double* column = axis.matrix + std::size_t(l.span[i]) * axis.stride;
    each<K + 1>(K + 1, [&](int o) FF_BODY {
        each<Groups>(groups, [&](int v) FF_BODY { out[o * groups + v] = all4(0); });
        const double* b = l.bernstein[o] + i;
        const auto add = [&](int k) FF_BODY {
            if (o > p) return;
            each<Groups>(groups, [&](int v) FF_BODY {
                const V4 term = load4(column + 4 * v);
                V4& sum = out[o * groups + v];
                sum = k == 0 ? term * all4(b[0]) : sum + term * all4(b[k * kTile]);
            });
            column += 4 * groups;
        };
        if constexpr (P >= 0)
            each<P + 1>(P + 1, [&](int k) FF_BODY {
                if (k <= P - o) add(k);
            });
        else
            for (int k = 0; k <= p - o; ++k) add(k);
    });
}

// Sums over the coefficients of one point, 4 * planes numbers for each slot.
template <int P, int K>
FF_INLINE void contract_curve(const Net& net, const Local& l, int i, double* h) {
    V4 f[2 * (K + 1)];
    const int planes = net.planes();
    if (planes == 1)
        functions<P, 1, K>(net.axis[0], l, i, 1, f);
    else
        functions<P, 2, K>(net.axis[0], l, i, 2, f);
    for (int k = 0; k < (K + 1) * planes; ++k) store4(h + 4 * k, f[k]);
}

template <int P, int N, int K>
FF_INLINE void contract(const Net& net, const Local* l, int i, double* h) {
    constexpr int kGroups = P >= 0 ? (P + 4) / 4 : -1,
                  kGroupsAtMost = P >= 0 ? kGroups : (kMaxDegree + 4) / 4;
    constexpr int kVectors = P >= 0 ? (P + kPerVector) / kPerVector : -1;
    constexpr int kVectorsAtMost = 4 * kGroupsAtMost / kPerVector, kCount = Slots<N, K>::kCount;
    const Axis& last = net.axis[N - 1];
    const int p = P >= 0 ? P : last.degree, groups = P >= 0 ? kGroups : last.lanes / 4;
    const int vectors = (p + kPerVector) / kPerVector, planes = net.planes();
    V4 w[(K + 1) * kGroupsAtMost];
    functions<P, kGroups, K>(last, l[N - 1], i, groups, w);
    // Weights of the outer axes: numbers, to be spread one at a time.
    double outer[N - 1][(K + 1) * 4 * kGroupsAtMost];
    int lanes[N - 1];
    for (int d = 0; d < N - 1; ++d) {
        const int some = P >= 0 ? kGroups : net.axis[d].lanes / 4;
        V4 f[(K + 1) * kGroupsAtMost];
        functions<P, kGroups, K>(net.axis[d], l[d], i, some, f);
        each<P >= 0 ? (K + 1) * kGroups : -1>((K + 1) * some,
                                              [&](int k) FF_BODY { store4(outer[d] + 4 * k, f[k]); });
        lanes[d] = 4 * some;
    }
    const double* base = net.coefficients + std::size_t(last.span[l[N - 1].span[i]].first) * 4;
    for (int d = 0; d < N - 1; ++d) base += std::size_t(net.axis[d].span[l[d].span[i]].first) * net.stride[d];
    for (int q = 0; q < planes; ++q, base += net.plane) {
        V sum[Slots<N, K>::kOuter][kVectorsAtMost];
        each<Slots<N, K>::kOuter>(
            0, [&](int o) FF_BODY { each<kVectors>(vectors, [&](int v) FF_BODY { sum[o][v] = all(0); }); });
        if constexpr (N == 2) {
            each<P >= 0 ? P + 1 : -1>(net.axis[0].degree + 1, [&](int r) FF_BODY {
                const double* row = base + std::size_t(r) * net.stride[0];
                each<kVectors>(vectors, [&](int v) FF_BODY {
                    const V c = load(row + v * kWidth);
                    each<K + 1>(0, [&](int o) FF_BODY { sum[o][v] += all(outer[0][o * lanes[0] + r]) * c; });
                });
            });
        } else {
            for (int r = 0; r <= net.axis[0].degree; ++r)
                for (int m = 0; m <= net.axis[1].degree; ++m) {
                    const double* row =
                        base + std::size_t(r) * net.stride[0] + std::size_t(m) * net.stride[1];
                    for (int s = 0; s < kCount; ++s) {
                        if (kSlots<N, K>.last[s] != 0) continue;
                        const V weight = all(outer[0][kSlots<N, K>.a[s] * lanes[0] + r] *
                                             outer[1][kSlots<N, K>.b[s] * lanes[1] + m]);
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
                           total += sum[kSlots<N, K>.outer[s]][v] *
                                    spread(w[kSlots<N, K>.last[s] * groups + j / 4], j % 4 / kPerVector);
                       });
                       store4(h + 4 * (s * planes + q), fold(total));
                   });
    }
}

// Projects the sums of one point (`inverse`: 1 / weight).
template <int N, int K>
FF_INLINE void project(const Net& net, const double* h, double inverse, V4* out) {
    const int size = 4 * net.planes();
    each < N<3 ? Slots<N, K>::kCount : -1>(
               Slots<N, K>::kCount,
               [&](int s) FF_BODY {
                   V4 v = load4(h + s * size);
                   if (net.rational) {
                       for (int t = 0; t < kSlots<N, K>.terms[s]; ++t) {
                           const auto& term = kSlots<N, K>.term[s][t];
                           v -= all4(term.factor * h[term.weight * size + size - 1]) * out[term.rest];
                       }
                       v *= all4(inverse);
                   }
                   out[s] = v;
               });
}

FF_INLINE V4 cross4(V4 a, V4 b) {
    const V4 a1 = __builtin_shufflevector(a, a, 1, 2, 0, 3), b1 = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    const V4 c = a * b1 - a1 * b;
    return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}

// Unit normals of a tile from S_u x S_v (4 numbers each) and its squared length. Where that has left the
// range in which it is good to a few roundings, from S_u and S_v themselves, 8 numbers each.
FF_INLINE void finish_normals(const double* normal, const double* square, const double* tangents, int n,
                              double* out) {
    double inverse[kTile];
    for (int g = 0; g < n; g += kWidth) store(inverse + g, reciprocal_root(load(square + g)));
    for (int i = 0; i < n; ++i) {
        if (square[i] > 1e-280 && square[i] < 1e280)
            store_three(out + 3 * i, load4(normal + 4 * i) * all4(inverse[i]));
        else
            careful_normal(tangents + 8 * i, tangents + 8 * i + 4, out + 3 * i);
    }
}

// Whole vectors of parameters of a curve that share a span, parameters in the lanes. The operations are those
// of a single point.
template <int P, int K>
FF_INLINE void curve_run(const Net& net, const Local& l, int g, const Output& out, double* to) {
    const Axis& axis = net.axis[0];
    const int p = P >= 0 ? P : axis.degree;
    const double* column = axis.matrix + std::size_t(l.uniform[g / kWidth]) * axis.stride;
    V s[K + 1][4], weight[K + 1];
    each<K + 1>(0, [&](int o) FF_BODY {
        V w = all(0);
        for (int c = 0; c < 4; ++c) s[o][c] = all(0);
        each<P >= 0 ? P + 1 : -1>(p + 1, [&](int k) FF_BODY {
            if (k > p - o) return;
            const V b = load(l.bernstein[o] + k * kTile + g);
            for (int c = 0; c < 4; ++c) s[o][c] = k == 0 ? all(column[c]) * b : s[o][c] + all(column[c]) * b;
            if (axis.lanes == 8) w = k == 0 ? all(column[7]) * b : w + all(column[7]) * b;
            column += axis.lanes;
        });
        weight[o] = axis.lanes == 8 ? w : s[o][3];
    });
    if (net.rational) {
        const V r = reciprocal(weight[0]);
        each<K + 1>(0, [&](int o) FF_BODY {
            for (int c = 0; c < 4; ++c) {
                V v = s[o][c];
                for (int t = 0; t < kSlots<1, K>.terms[o]; ++t) {
                    const auto& term = kSlots<1, K>.term[o][t];
                    v -= all(term.factor) * weight[term.weight] * s[term.rest][c];
                }
                s[o][c] = v * r;
            }
        });
    }
    each<K + 1>(0, [&](int o) FF_BODY {
        if (o < out.slots) emit(to + o * net.dim, s[o], net.dim, out.slots * net.dim);
    });
}

template <int N, int K>
FF_INLINE void finish_tile(const Net& net, const double* h, int n, const Output& out, std::size_t from,
                           const char* done) {
    using slots = Slots<N, K>;
    const int size = 4 * net.planes(), dim = net.dim;
    double inverse[kTile], normal[4 * kTile], square[kTile], tangents[8 * kTile];
    if (net.rational) {
        for (int i = 0; i < n; ++i) inverse[i] = h[i * slots::kCount * size + size - 1];
        for (int i = n; i % kWidth != 0; ++i) inverse[i] = 1;
        for (int g = 0; g < n; g += kWidth) store(inverse + g, reciprocal(load(inverse + g)));
    }
    for (int i = 0; i < n; ++i) {
        if (N == 1 && done[i / kWidth]) continue;
        V4 s[slots::kCount];
        project<N, K>(net, h + i * slots::kCount * size, net.rational ? inverse[i] : 1, s);
        double* to = out.jets + (from + std::size_t(i)) * std::size_t(out.slots * dim);
        each <
            N<3 ? slots::kCount : -1>(
                slots::kCount,
                [&](int k) FF_BODY {
                    if (k >= out.slots) return;
                    // A fourth number is overwritten by what comes next.
                    if (dim == 3 && (k + 1 < out.slots || (i + 1 < n && (N > 1 || !done[(i + 1) / kWidth]))))
                        store4(to, s[k]);
                    else if (dim == 3)
                        store_three(to, s[k]);
                    else if (dim == 4)
                        store4(to, s[k]);
                    else
                        for (int c = 0; c < dim; ++c) to[c] = s[k][c];
                    to += dim;
                });
        if constexpr (N == 2 && K > 0) {
            if (!out.normals) continue;
            const V4 c = cross4(s[1], s[2]), d = c * c;
            store4(normal + 4 * i, c);
            square[i] = d[0] + d[1] + d[2];
            store4(tangents + 8 * i, s[1]), store4(tangents + 8 * i + 4, s[2]);
        }
    }
    if constexpr (N == 2 && K > 0) {
        if (!out.normals) return;
        for (int i = n; i % kWidth != 0; ++i) square[i] = 1;
        finish_normals(normal, square, tangents, n, out.normals + 3 * from);
    }
}

template <int P, int N, int K>
__attribute__((noinline)) static void scattered_of(const Net& net, const double* at, std::size_t count,
                                                   const Output& out) {
    using slots = Slots<N, K>;
    const int size = 4 * net.planes();
    Local local[N];
    double h[kTile * slots::kCount * 8];
    char done[kTile / kWidth];
    for (std::size_t from = 0; from < count; from += kTile, at += N * kTile) {
        const int n = int(count - from < std::size_t(kTile) ? count - from : std::size_t(kTile));
        for (int d = 0; d < N; ++d) {
            for (int i = 0; i < n; ++i) local[d].x[i] = at[i * N + d];
            locate(net.axis[d], local[d], n, N == 1);
            bernstein(net.axis[d], K, local[d], n);
        }
        if constexpr (N == 1) {
            for (int g = 0; g < n; g += kWidth) {
                done[g / kWidth] = g + kWidth <= n && local[0].uniform[g / kWidth] >= 0;
                if (done[g / kWidth])
                    curve_run<P, K>(net, local[0], g, out,
                                    out.jets + (from + std::size_t(g)) * std::size_t(out.slots * net.dim));
            }
        }
        bool finished = true;
        for (int i = 0; i < n; ++i) {
            if (N == 1 && done[i / kWidth]) {
                h[i * slots::kCount * size + size - 1] = 1;  // for the reciprocals of the tile
                continue;
            }
            finished = false;
            if constexpr (N == 1)
                contract_curve<P, K>(net, local[0], i, h + i * slots::kCount * size);
            else
                contract<P, N, K>(net, local, i, h + i * slots::kCount * size);
        }
        if (finished) continue;
        finish_tile<N, K>(net, h, n, out, from, done);
    }
}

static void scattered(const Net& net, const double* at, std::size_t n, const Output& out) {
    const auto with_order = [&]<int P, int N>() {
        if (out.order == 0) return scattered_of<P, N, 0>(net, at, n, out);
        if (out.order == 1) return scattered_of<P, N, 1>(net, at, n, out);
        // Second derivatives of surfaces: of the most common degree alone, for the sake of compile time.
        return scattered_of < N == 1 || P == 3 ? P : -1, N, 2 > (net, at, n, out);
    };
    if (net.axes == 3) return with_order.template operator()<-1, 3>();
    const bool equal = net.axes == 1 || net.axis[0].degree == net.axis[1].degree;
    with_degree(equal ? net.axis[0].degree : -1, [&]<int P>(Degree<P>) {
        if (net.axes == 1) return with_order.template operator()<P, 1>();
        return with_order.template operator()<P, 2>();
    });
}

static void weights(const Axis& axis, const double* at, std::size_t count, int order, double* out,
                    int* first) {
    Local l;
    V4 f[(kMaxOrder + 1) * (kMaxDegree + 4) / 4];
    const std::size_t size = std::size_t(order + 1) * std::size_t(axis.lanes);
    for (std::size_t from = 0; from < count; from += kTile) {
        const int n = int(count - from < std::size_t(kTile) ? count - from : std::size_t(kTile));
        for (int i = 0; i < n; ++i) l.x[i] = at[from + std::size_t(i)];
        locate(axis, l, n, false);
        bernstein(axis, kMaxOrder, l, n);
        for (int i = 0; i < n; ++i) {
            functions<-1, -1, kMaxOrder>(axis, l, i, axis.lanes / 4, f);
            double* to = out + (from + std::size_t(i)) * size;
            for (int k = 0; k < (order + 1) * axis.lanes / 4; ++k) store4(to + 4 * k, f[k]);
            first[from + std::size_t(i)] = axis.span[l.span[i]].first;
        }
    }
}
