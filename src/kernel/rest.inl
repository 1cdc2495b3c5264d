// What is left of a block beside a quadratic function, and its differences: RestTask in blocks.hpp, whose
// proof is in spline/block_rest.cpp. Included by blocks_generic.inl.

// `kNarrow`: of at most four columns, all of whose rows are one vector, or two as products. What is beside a
// number is then found by moving lanes: numbers that were just stored one by one are not there yet when they
// are loaded as parts of other vectors, which costs more than all the rest.
template <bool kRational, bool kNarrow>
struct RestOf {
    // Of a coefficient of D = A - w M: coordinates, direction . D, and the weight.
    static constexpr int kAcross = 3, kWeight = 4, kNumbers = kRational ? 5 : 4, kMore = kRational ? 2 : 0;
    static constexpr int kMostVectors = kNarrow ? kRational ? 2 : 1 : lanes_of(kMaxDegree + 3) / 4 + 1,
                         kVectors = kNarrow ? kMostVectors : -1;
#if defined(__wasm__)
    static constexpr bool kWritten = false;  // one after the other in the code: too large for modules
#else
    static constexpr bool kWritten = true;
#endif
    template <int Count, class F>
    static FF_BODY inline void each_of(F f) {
        each<kWritten ? Count : -1>(Count, f);
    }
    struct Row {  // then of differences of such rows
        V4 at[kNumbers][kMostVectors];
    };
    struct Most {
        V4 square = all4(0), across = all4(0), weight = all4(0);
    };

    const RestTask& t;
    RestFound& out;
    const int rows = t.shape.rows, columns = t.shape.columns, lanes = kNarrow ? 4 : t.shape.lanes(),
              count = columns + kMore, vectors = kNarrow ? kMostVectors : lanes_of(count) / 4;
    const std::size_t plane = t.shape.plane();
    V4 largest = all4(0), least = all4(1e308), most = all4(kRational ? 0 : 1);
    Most values = {}, of[kRestDifferences] = {};

    // The numbers that are so many columns further on than those of vector v.
    template <int Columns>
    FF_BODY inline V4 further(const V4* x, int v) const {
        if constexpr (Columns == 0)
            return x[v];
        else if constexpr (!kNarrow)
            return load4(reinterpret_cast<const double*>(x + v) + Columns);
        else {
            const V4 next = v + 1 < kMostVectors ? x[v + 1] : all4(0);
            return __builtin_shufflevector(x[v], next, Columns, Columns + 1, Columns + 2, Columns + 3);
        }
    }
    FF_PART void find_across(Row& row, int v) const {
        row.at[kAcross][v] = all4(t.direction[0]) * row.at[0][v] + all4(t.direction[1]) * row.at[1][v] +
                             all4(t.direction[2]) * row.at[2][v];
    }

    // Row r of A - M without weights.
    FF_PART void subtract_m(int r, Row& row) {
        const double p = rows - 1, s = r / p, bulge = rows > 2 ? s * ((p - r) / (p - 1)) : 0;
        V4 at[3], by_y[3], across_y[3];
        each_of<3>([&](int d) FF_BODY {
            const double below = (1 - s) * t.corner[0][d] + s * t.corner[1][d],
                         above = (1 - s) * t.corner[2][d] + s * t.corner[3][d];
            at[d] = all4(below + bulge * t.bulge[0][d]), by_y[d] = all4(above - below);
            across_y[d] = all4(t.bulge[1][d]);
            if constexpr (!kNarrow) row.at[d][vectors] = all4(0);
        });
        each<kVectors>(vectors, [&](int v) FF_BODY {
            const int k = 4 * v;
            const I4 mask = first_of(columns - k);
            const V4 y = load4(t.linear + k), bulge_y = load4(t.bulges + k);
            each_of<3>([&](int d) FF_BODY {
                const V4 x = load4(t.numbers + std::size_t(d) * plane + std::size_t(r * lanes + k));
                largest = larger(largest, size_of(x));
                row.at[d][v] = kept(x - ((at[d] + y * by_y[d]) + bulge_y * across_y[d]), mask);
            });
            find_across(row, v);
        });
        if constexpr (!kNarrow) row.at[kAcross][vectors] = all4(0);
    }
    // Coefficients k, l of degree 2 of M.
    FF_BODY inline void set_m(double (&m)[3][3][3]) const {
        for (int d = 0; d < 3; ++d)
            for (int k = 0; k < 3; ++k) {
                const double s = k / 2.0, below = (1 - s) * t.corner[0][d] + s * t.corner[1][d],
                             above = (1 - s) * t.corner[2][d] + s * t.corner[3][d],
                             bulge = k == 1 ? t.bulge[0][d] / 2 : 0;
                m[k][0][d] = below + bulge, m[k][2][d] = above + bulge;
                m[k][1][d] = (below + above) / 2 + (bulge + t.bulge[1][d] / 2);
            }
    }

    // Row at of the product A - w M.
    FF_PART void multiply(int at, const double (&m)[3][3][3], Row& row) {
        for (int v = 0; v < vectors + int(!kNarrow); ++v) {
            for (int d = 0; d < 3; ++d) row.at[d][v] = all4(0);
            row.at[kWeight][v] = (V4)((I4)all4(1) & ~first_of(count - 4 * v));
        }
        const int first = at < rows ? 0 : at - rows + 1, last = at < 2 ? at : 2;
        each<kNarrow ? 1 : -1>(lanes / 4, [&](int v) FF_BODY {
            const int k = 4 * v;
            const I4 mask = first_of(columns - k);
            V4 mean[4] = {}, of_m[3][3] = {};
            for (int i = first; i <= last; ++i) {
                const double* const from = t.numbers + (at - i) * lanes + k;
                const V4 share = all4(t.share[0][3 * at + i]), w = load4(from + 3 * plane), part = share * w;
                mean[3] += part;
                each<3>(3, [&](int d) FF_BODY { mean[d] += share * load4(from + std::size_t(d) * plane); });
                each_of<3>([&](int l) FF_BODY {
                    each<3>(3, [&](int d) FF_BODY { of_m[l][d] += part * all4(m[i][l][d]); });
                });
                if (i > first) continue;
                most = larger(most, w);
                least = -larger(-least, -(w + (V4)((I4)all4(1e308) & ~mask)));
                each<3>(3, [&](int d) FF_BODY {
                    largest = larger(largest, size_of(load4(from + std::size_t(d) * plane)));
                });
            }
            each_of<3>([&](int l) FF_BODY {
                const V4 by = load4(t.share[1] + l * t.stride + k);
                each<3>(3, [&](int d) FF_BODY { add(row.at[d] + v, l, by * (mean[d] - of_m[l][d])); });
                add(row.at[kWeight] + v, l, by * mean[3]);
            });
        });
        each<kVectors>(vectors + int(!kNarrow), [&](int v) FF_BODY { find_across(row, v); });
    }
    // To the numbers from column l of this vector on.
    FF_BODY inline void add(V4* to, int l, V4 x) const {
        if constexpr (kNarrow) {
            const V4 none = all4(0);
            to[0] += l == 0   ? x
                     : l == 1 ? __builtin_shufflevector(none, x, 0, 4, 5, 6)
                              : __builtin_shufflevector(none, x, 0, 1, 4, 5);
            if (l == 1) to[1] += __builtin_shufflevector(x, none, 3, 4, 5, 6);
            if (l == 2) to[1] += __builtin_shufflevector(x, none, 2, 3, 4, 5);
        } else {
            double* const p = reinterpret_cast<double*>(to) + l;
            store4(p, load4(p) + x);
        }
    }

    FF_PART void note(Most& m, const V4* x) const {
        m.square = larger(m.square, x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        m.across = larger(m.across, size_of(x[kAcross]));
        if constexpr (kRational) m.weight = larger(m.weight, size_of(x[kWeight]));
    }
    // Differences from column to column, so many times. Those of rows are 0 after the columns.
    template <int Times>
    FF_PART void look(Most& m, const Row& row) const {
        each<kVectors>(vectors, [&](int v) FF_BODY {
            if (kNarrow ? v > 0 && Times == 2 : 4 * v >= count - Times) return;
            V4 x[kNumbers];
            each_of<kNumbers>([&](int d) FF_BODY {
                const V4 *const p = row.at[d], here = p[v];
                x[d] = here;
                if constexpr (Times == 1) x[d] = further<1>(p, v) - here;
                if constexpr (Times == 2) {
                    const V4 next = further<1>(p, v);
                    x[d] = (further<2>(p, v) - next) - (next - here);
                }
                if constexpr (Times > 0) x[d] = kept(x[d], first_of(count - Times - 4 * v));
            });
            note(m, x);
        });
    }
    // Likewise once, of weights alone.
    FF_PART void look_at_weights(Most& m, const Row& row) const {
        each<kVectors>(vectors, [&](int v) FF_BODY {
            const V4* const p = row.at[kWeight];
            m.weight = larger(m.weight, size_of(kept(further<1>(p, v) - p[v], first_of(count - 1 - 4 * v))));
        });
    }
    FF_BODY inline void look_at_quotients(const Row& row) {
        each<kVectors>(vectors, [&](int v) FF_BODY {
            const V4 divide = all4(1) / row.at[kWeight][v];
            V4 x[kNumbers] = {};
            each_of<4>([&](int d) FF_BODY { x[d] = row.at[d][v] * divide; });
            note(values, x);
        });
    }
    FF_PART void subtract(const Row& from, Row& row) const {  // row becomes from - row
        for (int d = 0; d < kNumbers; ++d)
            each<kVectors>(vectors, [&](int v) FF_BODY { row.at[d][v] = from.at[d][v] - row.at[d][v]; });
    }

    void run() {
        Row room[3], *now = room, *before = room + 1, *change = room + 2;
        [[maybe_unused]] double m[3][3][3];
        if constexpr (kRational) set_m(m);
        for (int at = 0; at < rows + kMore; ++at) {
            if constexpr (kRational) {
                multiply(at, m, *now);
                look_at_quotients(*now);
            } else {
                subtract_m(at, *now);
                look<0>(values, *now);
            }
            if constexpr (kRational) look_at_weights(of[1], *now);
            look<2>(of[4], *now);
            if (at > 0) {
                subtract(*now, *before);
                if constexpr (kRational)
                    each<kVectors>(vectors, [&](int v) FF_BODY {
                        of[0].weight = larger(of[0].weight, size_of(before->at[kWeight][v]));
                    });
                look<1>(of[3], *before);
                if (at > 1) {
                    subtract(*before, *change);
                    look<0>(of[2], *change);
                }
            }
            Row* const free = change;
            change = before, before = now, now = free;
        }
        const auto max = [](V4 a, V4 b) FF_BODY { return larger(a, b); };
        double found[4];
        store4(found, over_lanes(values.square, values.across, largest, most, max));
        out.square = found[0], out.across = found[1], out.largest = found[2], out.most_weight = found[3];
        store4(found, over_lanes(-least, most, most, most, max));
        out.least_weight = kRational ? -found[0] : 1;
        for (int k = 0; k < kRestDifferences; ++k)
            store4(out.of[k], over_lanes(of[k].square, of[k].across, of[k].weight, most, max));
    }
};

void rest(const RestTask& t, RestFound& out) {
#if defined(__wasm__)
    const bool is_narrow = false;  // for size
#else
    const bool is_narrow = t.shape.columns <= 4;
    if (is_narrow) t.shape.rational ? RestOf<true, true>{t, out}.run() : RestOf<false, true>{t, out}.run();
#endif
    if (!is_narrow) t.shape.rational ? RestOf<true, false>{t, out}.run() : RestOf<false, false>{t, out}.run();
}
