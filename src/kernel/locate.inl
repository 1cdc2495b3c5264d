// Spans of a tile of parameters, and where in them the parameters are; they lie side by side in the lanes.

struct Local {
    const double* record[kTile];
    alignas(64) long long columns[kTile];  // where they begin in the record, by the half
    int uniform[kTile / kWidth];           // whether a whole vector of parameters is in half a span
    alignas(64) double ratio[kTile];       // near / far
    alignas(64) double inverse[kTile];     // 1 / far
    alignas(64) double scale[kTile];       // (far / (hi - lo))^degree
};

FF_INLINE const Span& span_of(const double* record) { return *reinterpret_cast<const Span*>(record); }

// kWidth parameters of axis d, or `left` of them and the last one again. They are `axes` numbers apart.
FF_INLINE V parameters(const double* at, int axes, int d, int left) {
    if (left >= kWidth && axes == 1) return load(at);
    if (left >= kWidth && axes == 2) {
        const V a = load(at), b = load(at + kWidth);
#if defined(__AVX512F__)
        return d == 0 ? __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14)
                      : __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
#else
        return d == 0 ? __builtin_shufflevector(a, b, 0, 2, 4, 6) : __builtin_shufflevector(a, b, 1, 3, 5, 7);
#endif
    }
    double x[kWidth];
    for (int i = 0; i < kWidth; ++i) x[i] = at[(i < left ? i : left - 1) * axes + d];
    return load(x);
}

// Whether the spans of a vector of parameters have to be looked for from their buckets on is not asked: the
// first step is always taken, since a branch that is sometimes wrong costs more. `to`: the records.
FF_INLINE void find(const Axis& axis, V x, const double** to) {
    const int last = axis.buckets - 1;
    Half k = __builtin_convertvector((x - all(axis.lo)) * all(axis.scale), Half);
    k = k < last ? k : Half{} + last;
    I at = gather_lines(axis.record, axis.bucket, k);
    const long long stride = (long long)(axis.stride * sizeof(double));
    for (int h = (axis.steps + 1) / 2; h > 0; h /= 2) {
        const V next = gather(at + ((h - 1) * stride + (long long)offsetof(Span, next)));
        at += (x >= next) & (h * stride);
    }
    store_addresses(to, at);
}

FF_INLINE bool in_span(const Axis& axis, V x, const double* record) {
    const Span& s = span_of(record);
    return all_inside(x, all(s.lo), all(s.hi),
                      record == axis.record + std::size_t(axis.spans - 1) * axis.stride);
}

// n parameters of axis d. look_for_runs: vectors of parameters that share half a span are marked. scaled:
// `scale` is wanted. Two loops: each of them is a long chain of operations that wait for one another, and of
// short chains more fit into what a processor looks ahead.
template <int P>
__attribute__((noinline)) static void locate_of(const Axis& from, const double* at, int axes, int d, int n,
                                                bool look_for_runs, bool scaled, Local& l) {
    const Axis axis = from;  // what is stored cannot change it
    const double* known = nullptr;
    for (int g = 0; g < n; g += kWidth) {
        const V x = parameters(at + g * axes, axes, d, n - g);
        store(l.ratio + g, x);
        bool same = known && in_span(axis, x, known);
        if (same) {
            for (int i = 0; i < kWidth; ++i) l.record[g + i] = known;
        } else {
            find(axis, x, l.record + g);
            if (look_for_runs) {
                known = l.record[g];
                same = in_span(axis, x, known);
            }
        }
        l.uniform[g / kWidth] = same;
    }
    for (int g = 0; g < n; g += kWidth) {
        const V x = load(l.ratio + g);
        V lo, hi, inverse;
        if (look_for_runs && l.uniform[g / kWidth]) {
            const Span& s = span_of(l.record[g]);
            lo = all(s.lo), hi = all(s.hi), inverse = all(s.inverse);
        } else {
            three_of(l.record + g, lo, hi, inverse);
        }
        const V before = x - lo, after = hi - x;
        const I right = before > after;
        const V near = right ? after : before, far = right ? before : after;
        *reinterpret_cast<Iu*>(l.columns + g) = (right & (long long)axis.half) + (long long)Axis::kLine;
        const V r = reciprocal(far);
        store(l.ratio + g, near * r);
        store(l.inverse + g, r);
        if (look_for_runs) l.uniform[g / kWidth] &= int(all_of(right) || none_of(right));
        if (!scaled) continue;
        // At the end of a span exactly 1, so that the polynomial is exactly what it is there.
        const V one = all(1), s = near == all(0) ? one : far * inverse;
        V power = one;
        each<P>(axis.degree, [&](int i) FF_BODY { power = i == 0 ? s : power * s; });
        store(l.scale + g, power);
    }
}
static void locate(const Axis& axis, const double* at, int axes, int d, int n, bool look_for_runs,
                   bool scaled, Local& l) {
    with_degree(axis.degree, [&]<int P>(Degree<P>)
                                 FF_BODY { locate_of<P>(axis, at, axes, d, n, look_for_runs, scaled, l); });
}
