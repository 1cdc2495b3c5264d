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

FF_INLINE const double* stepped(const Axis& axis, double x, const double* record, std::size_t step) {
    const double next = span_of(record + (step - axis.stride)).next;
    return record + (-std::size_t(x >= next) & step);
}

// The records of the spans of n parameters, a multiple of kWidth. Buckets side by side, the rest one by one:
// gathers take longer than the loads that they are made of. The first step is always taken, since a branch
// that is sometimes wrong costs more.
__attribute__((noinline)) static void find(const Axis& from, const double* at, int n, const double** to) {
    const Axis axis = from;  // what is stored cannot change it
    const int last = axis.buckets - 1, half = (axis.steps + 1) / 2;
    alignas(64) int bucket[kTile];
    for (int g = 0; g < n; g += kWidth) {
        const Half k = __builtin_convertvector((load(at + g) - all(axis.lo)) * all(axis.scale), Half);
        *reinterpret_cast<Halfu*>(bucket + g) = k < last ? k : Half{} + last;
    }
    const std::size_t step = std::size_t(half) * axis.stride;
    for (int g = 0; g < n; g += kWidth)
        each<kWidth>(0, [&](int i) FF_BODY {
            const double* record = axis.record + std::size_t(axis.bucket[bucket[g + i]]) * Axis::kLine;
            to[g + i] = stepped(axis, at[g + i], record, step);
        });
    for (int h = half / 2; h > 0; h /= 2)
        for (int i = 0; i < n; ++i) to[i] = stepped(axis, at[i], to[i], std::size_t(h) * axis.stride);
}

// The same of one.
FF_INLINE const double* find_one(const Axis& axis, double x) {
    const int bucket = int((x - axis.lo) * axis.scale);
    const double* record =
        axis.record +
        std::size_t(axis.bucket[bucket < axis.buckets ? bucket : axis.buckets - 1]) * Axis::kLine;
    for (int h = (axis.steps + 1) / 2; h > 0; h /= 2)
        record = stepped(axis, x, record, std::size_t(h) * axis.stride);
    return record;
}

FF_INLINE bool in_span(const Axis& axis, V x, const double* record) {
    const Span& s = span_of(record);
    return all_inside(x, all(s.lo), all(s.hi),
                      record == axis.record + std::size_t(axis.spans - 1) * axis.stride);
}

// Where in their spans kWidth parameters are. Returns which of them are nearer to the right end.
template <int P>
FF_INLINE I place(const Axis& axis, V x, V lo, V hi, V inverse, bool scaled, int g, Local& l) {
    const V before = x - lo, after = hi - x;
    const I right = before > after;
    const V near = right ? after : before, far = right ? before : after;
    *reinterpret_cast<Iu*>(l.columns + g) = (right & (long long)axis.half) + (long long)Axis::kLine;
    const V r = reciprocal(far);
    store(l.ratio + g, near * r);
    store(l.inverse + g, r);
    if (scaled) {
        // At the end of a span exactly 1, so that the polynomial is exactly what it is there.
        const V one = all(1), s = near == all(0) ? one : far * inverse;
        V power = one;
        each<P>(axis.degree, [&](int i) FF_BODY { power = i == 0 ? s : power * s; });
        store(l.scale + g, power);
    }
    return right;
}

// A single parameter, in all lanes: memory would make a vector wait for numbers that are stored one by one.
template <int P>
__attribute__((noinline)) static void locate_one(const Axis& axis, double x, bool scaled, Local& l) {
    l.record[0] = find_one(axis, x);
    l.uniform[0] = false;
    const Span& s = span_of(l.record[0]);
    place<P>(axis, all(x), all(s.lo), all(s.hi), all(s.inverse), scaled, 0, l);
}

// n parameters of axis d. look_for_runs: vectors of parameters that share half a span are marked. scaled:
// `scale` is wanted. Several loops: each of them is a long chain of operations that wait for one another, and
// of short chains more fit into what a processor looks ahead.
template <int P>
__attribute__((noinline)) static void locate_of(const Axis& from, const double* at, int axes, int d, int n,
                                                bool look_for_runs, bool scaled, Local& l) {
    const Axis axis = from;  // what is stored cannot change it
    if (!look_for_runs) {
        for (int g = 0; g < n; g += kWidth) store(l.ratio + g, parameters(at + g * axes, axes, d, n - g));
        find(axis, l.ratio, (n + kWidth - 1) / kWidth * kWidth, l.record);
    }
    const double* known = nullptr;
    for (int g = 0; look_for_runs && g < n; g += kWidth) {
        const V x = parameters(at + g * axes, axes, d, n - g);
        store(l.ratio + g, x);
        bool same = known && in_span(axis, x, known);
        if (same) {
            for (int i = 0; i < kWidth; ++i) l.record[g + i] = known;
        } else {
            find(axis, l.ratio + g, kWidth, l.record + g);
            known = l.record[g];
            same = in_span(axis, x, known);
        }
        l.uniform[g / kWidth] = same;
    }
    for (int g = 0; g < n; g += kWidth) {
        V lo, hi, inverse;
        if (look_for_runs && l.uniform[g / kWidth]) {
            const Span& s = span_of(l.record[g]);
            lo = all(s.lo), hi = all(s.hi), inverse = all(s.inverse);
        } else {
            three_of(l.record + g, lo, hi, inverse);
        }
        const I right = place<P>(axis, load(l.ratio + g), lo, hi, inverse, scaled, g, l);
        if (look_for_runs) l.uniform[g / kWidth] &= int(all_of(right) || none_of(right));
    }
}
static void locate(const Axis& axis, const double* at, int axes, int d, int n, bool look_for_runs,
                   bool scaled, Local& l) {
    with_degree(axis.degree, [&]<int P>(Degree<P>) FF_BODY {
        if (n == 1)
            locate_one<P>(axis, at[d], scaled, l);
        else
            locate_of<P>(axis, at, axes, d, n, look_for_runs, scaled, l);
    });
}
