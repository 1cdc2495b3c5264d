// Spans and Bernstein polynomials of a tile of parameters, which lie side by side in the lanes.

struct Local {
    const Span* span[kTile];
    int uniform[kTile / kWidth];  // whether a whole vector of parameters is in one span
    alignas(64) double bernstein[kMaxOrder + 1][(kMaxDegree + 1) * kTile];
};

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

// The spans of a vector of parameters, and their ends. Of most parameters the bucket has one span: then its
// ends are loaded at once, and the few others are looked for afterwards.
FF_INLINE void find(const Axis& axis, V x, const Span** to, V& lo, V& hi, V& inverse) {
    const int last = axis.buckets - 1;
    int place[kWidth];
    Half k = __builtin_convertvector((x - all(axis.lo)) * all(axis.scale), Half);
    *reinterpret_cast<Halfu*>(place) = k < last ? k : Half{} + last;
    asm("" : "+m"(place));  // loaded from there, not taken from a vector lane by lane
    const double* from[kWidth];
    const auto load_ends = [&] FF_BODY {
        for (int i = 0; i < kWidth; ++i) from[i] = &to[i]->lo;
        three_of(from, lo, hi, inverse);
    };
    for (int i = 0; i < kWidth; ++i) to[i] = axis.span + axis.bucket[place[i]];
    load_ends();
    if (all_inside(x, lo, hi, false)) return;
    double at[kWidth];
    store(at, x);
    for (int i = 0; i < kWidth; ++i)
        for (int h = (axis.steps + 1) / 2; h > 0; h /= 2) to[i] += at[i] >= to[i][h - 1].next ? h : 0;
    load_ends();
}

// All Bernstein polynomials of degrees p, p - 1 .. p - order: the recurrence of sums of non-negative numbers.
template <int P>
FF_INLINE void bernstein(int degree, int order, V t, V s, Local& l, int g) {
    const int p = P >= 0 ? P : degree;
    V b[(P >= 0 ? P : kMaxDegree) + 1];
    b[0] = all(1);
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

FF_INLINE bool in_span(const Axis& axis, V x, const Span& s) {
    return all_inside(x, all(s.lo), all(s.hi), &s == axis.span + axis.spans - 1);
}

// n parameters of axis d. look_for_runs: vectors of parameters that share a span are marked.
template <int P>
__attribute__((noinline)) static void locate_of(const Axis& from, const double* at, int axes, int d, int n,
                                                int order, bool look_for_runs, Local& l) {
    const Axis axis = from;  // what is stored cannot change it
    const Span* known = nullptr;
    for (int g = 0; g < n; g += kWidth) {
        const V one = all(1), x = parameters(at + g * axes, axes, d, n - g);
        V lo, hi, inverse;
        bool same = known && in_span(axis, x, *known);
        if (same) {
            l.span[g] = known;
            lo = all(known->lo), hi = all(known->hi), inverse = all(known->inverse);
        } else {
            find(axis, x, l.span + g, lo, hi, inverse);
            if (look_for_runs) {
                known = l.span[g];
                same = in_span(axis, x, *known);
            }
        }
        l.uniform[g / kWidth] = same;
        V t = (x - lo) * inverse, s = (hi - x) * inverse;
        t = t < one ? t : one, s = s < one ? s : one;
        bernstein<P>(axis.degree, order, t, s, l, g);
    }
}
static void locate(const Axis& axis, const double* at, int axes, int d, int n, int order, bool look_for_runs,
                   Local& l) {
    with_degree(axis.degree, [&]<int P>(Degree<P>)
                                 FF_BODY { locate_of<P>(axis, at, axes, d, n, order, look_for_runs, l); });
}
