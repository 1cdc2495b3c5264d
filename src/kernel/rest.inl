// What is left of a block beside a quadratic function, and its differences: RestTask in blocks.hpp, whose
// proof is in spline/block_rest.cpp. Included by blocks_generic.inl.

inline constexpr int kMostRow = lanes_of(kMaxDegree + 3) + 4;

template <bool kRational>
struct RestOf {
    static constexpr int kNumbers = kRational ? 4 : 3, kMore = kRational ? 2 : 0;  // degrees
    struct Row {  // of A - w M, and of w; then of differences of such rows
        double at[kNumbers][kMostRow];
    };
    struct Most {
        V4 square = all4(0), across = all4(0), weight = all4(0);
    };

    const RestTask& t;
    RestFound& out;
    const int rows = t.shape.rows, columns = t.shape.columns, lanes = t.shape.lanes(),
              ends = lanes_of(columns + 2);
    const std::size_t plane = t.shape.plane();
    V4 largest = all4(0), least = all4(1e308), most = all4(kRational ? 0 : 1);
    Most values = {}, of[kRestDifferences] = {};

    // Row r of A - M without weights.
    FF_PART void subtract_m(int r, Row& row) {
        const double p = rows - 1, s = r / p, bulge = rows > 2 ? s * ((p - r) / (p - 1)) : 0;
        V4 at[3], by_y[3], across_y[3];
        each<3>(3, [&](int d) FF_BODY {
            const double below = (1 - s) * t.corner[0][d] + s * t.corner[1][d],
                         above = (1 - s) * t.corner[2][d] + s * t.corner[3][d];
            at[d] = all4(below + bulge * t.bulge[0][d]), by_y[d] = all4(above - below);
            across_y[d] = all4(t.bulge[1][d]);
            store4(row.at[d] + lanes, all4(0));
        });
        for (int k = 0; k < lanes; k += 4) {
            const I4 mask = first_of(columns - k);
            const V4 y = load4(t.linear + k), bulge_y = load4(t.bulges + k);
            each<3>(3, [&](int d) FF_BODY {
                const V4 x = load4(t.numbers + std::size_t(d) * plane + std::size_t(r * lanes + k));
                largest = larger(largest, size_of(x));
                store4(row.at[d] + k, kept(x - ((at[d] + y * by_y[d]) + bulge_y * across_y[d]), mask));
            });
        }
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
        for (int J = 0; J < ends + 4; J += 4) {
            for (int d = 0; d < 3; ++d) store4(row.at[d] + J, all4(0));
            store4(row.at[3] + J, (V4)((I4)all4(1) & ~first_of(columns + 2 - J)));
        }
        const int first = at < rows ? 0 : at - rows + 1, last = at < 2 ? at : 2;
        for (int k = 0; k < lanes; k += 4) {
            const I4 mask = first_of(columns - k);
            V4 mean[4] = {}, of_m[3][3] = {};
            for (int i = first; i <= last; ++i) {
                const double* const from = t.numbers + (at - i) * lanes + k;
                const V4 share = all4(t.share[0][3 * at + i]), w = load4(from + 3 * plane), part = share * w;
                mean[3] += part;
                each<3>(3, [&](int d) FF_BODY { mean[d] += share * load4(from + std::size_t(d) * plane); });
                each<3>(3, [&](int l) FF_BODY {
                    each<3>(3, [&](int d) FF_BODY { of_m[l][d] += part * all4(m[i][l][d]); });
                });
                if (i > first) continue;
                most = larger(most, w);
                least = -larger(-least, -(w + (V4)((I4)all4(1e308) & ~mask)));
                each<3>(3, [&](int d) FF_BODY {
                    largest = larger(largest, size_of(load4(from + std::size_t(d) * plane)));
                });
            }
            each<3>(3, [&](int l) FF_BODY {
                const V4 by = load4(t.share[1] + l * t.stride + k);
                const auto add = [&](double* p, V4 x) FF_BODY { store4(p, load4(p) + by * x); };
                each<3>(3, [&](int d) FF_BODY { add(row.at[d] + k + l, mean[d] - of_m[l][d]); });
                add(row.at[3] + k + l, mean[3]);
            });
        }
    }

    FF_PART void note(Most& m, const V4* x) const {
        m.square = larger(m.square, x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        m.across = larger(m.across, size_of(all4(t.direction[0]) * x[0] + all4(t.direction[1]) * x[1] +
                                            all4(t.direction[2]) * x[2]));
        if constexpr (kRational) m.weight = larger(m.weight, size_of(x[3]));
    }
    // Differences from column to column, so many times.
    template <int Times>
    FF_PART void look(Most& m, const Row& row, int count) const {
        for (int J = 0; J < count - Times; J += 4) {
            const I4 mask = first_of(count - Times - J);
            V4 x[kNumbers];
            each<kNumbers>(kNumbers, [&](int d) FF_BODY {
                const double* const p = row.at[d] + J;
                x[d] = load4(p);
                if (Times == 1) x[d] = load4(p + 1) - x[d];
                if (Times == 2) x[d] = (load4(p + 2) - load4(p + 1)) - (load4(p + 1) - x[d]);
                x[d] = kept(x[d], mask);
            });
            note(m, x);
        }
    }
    FF_BODY inline void look_at_quotients(const Row& row) {
        for (int J = 0; J < ends; J += 4) {
            const V4 divide = all4(1) / load4(row.at[3] + J);
            V4 x[4] = {};
            each<3>(3, [&](int d) FF_BODY { x[d] = load4(row.at[d] + J) * divide; });
            note(values, x);
        }
    }
    FF_PART void subtract(const Row& from, Row& row, int count) const {  // row becomes from - row
        for (int d = 0; d < kNumbers; ++d)
            for (int J = 0; J < count; J += 4)
                store4(row.at[d] + J, load4(from.at[d] + J) - load4(row.at[d] + J));
    }

    void run() {
        Row room[3], *now = room, *before = room + 1, *change = room + 2;
        [[maybe_unused]] double m[3][3][3];
        if constexpr (kRational) set_m(m);
        const int count = columns + kMore;
        for (int at = 0; at < rows + kMore; ++at) {
            if constexpr (kRational) {
                multiply(at, m, *now);
                look_at_quotients(*now);
            } else {
                subtract_m(at, *now);
                look<0>(values, *now, count);
            }
            look<1>(of[1], *now, count);
            look<2>(of[4], *now, count);
            if (at > 0) {
                subtract(*now, *before, count);
                look<0>(of[0], *before, count);
                look<1>(of[3], *before, count);
                if (at > 1) {
                    subtract(*before, *change, count);
                    look<0>(of[2], *change, count);
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
    t.shape.rational ? RestOf<true>{t, out}.run() : RestOf<false>{t, out}.run();
}
