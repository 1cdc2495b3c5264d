// Vectors of doubles for the instruction set that the including file is compiled for. Everything is inlined
// and lies in a namespace of that instruction set: no function here may be shared between files of different
// flags, so nothing of the standard library is used.
//
// V: kWidth lanes, for parameters side by side. V4: one coefficient. Compiler vectors; instructions by name
// only where no operator stands for them (estimates of reciprocals, stores past the caches, tests of all
// lanes).

#define FF_INLINE static inline __attribute__((always_inline))
#define FF_BODY __attribute__((always_inline))
// Large, and called once for each vector of parameters. In a module, whose size counts, it is there once: 6
// kB of it with gzip, and 7 % of the time of normals.
#if defined(__wasm__)
#define FF_SHARED static __attribute__((noinline))
#define FF_PART __attribute__((noinline))  // likewise, of members
#else
#define FF_SHARED FF_INLINE
#define FF_PART FF_BODY inline
#endif

// f(0) .. f(count - 1): written out one after the other where the number is known when compiling (Count >=
// 0).
template <int Count, class F>
FF_INLINE void each(int count, F f) {
    if constexpr (Count >= 0) [&]<int... I>(std::integer_sequence<int, I...>) FF_BODY {
            (f(I), ...);
        }
    (std::make_integer_sequence<int, Count>{});
    else for (int i = 0; i < count; ++i) f(i);
}

#if defined(__AVX512F__)
inline constexpr int kWidth = 8;
#else
inline constexpr int kWidth = 4;
#endif

typedef double V4 __attribute__((vector_size(32)));
typedef double V4u __attribute__((vector_size(32), aligned(8), may_alias));
typedef double V2u __attribute__((vector_size(16), aligned(8), may_alias));
typedef double V __attribute__((vector_size(8 * kWidth)));
typedef double Vu __attribute__((vector_size(8 * kWidth), aligned(8), may_alias));
typedef long long I __attribute__((vector_size(8 * kWidth)));
typedef long long Iu __attribute__((vector_size(8 * kWidth), aligned(8), may_alias));
typedef int Half __attribute__((vector_size(4 * kWidth)));
typedef int Halfu __attribute__((vector_size(4 * kWidth), aligned(4), may_alias));

FF_INLINE V4 load4(const double* p) { return *reinterpret_cast<const V4u*>(p); }
FF_INLINE void store4(double* p, V4 v) { *reinterpret_cast<V4u*>(p) = v; }
FF_INLINE V load(const double* p) { return *reinterpret_cast<const Vu*>(p); }
FF_INLINE void store(double* p, V v) { *reinterpret_cast<Vu*>(p) = v; }
FF_INLINE V4 all4(double x) { return V4{x, x, x, x}; }
#if defined(__AVX512F__)
FF_INLINE V all(double x) { return V{x, x, x, x, x, x, x, x}; }
FF_INLINE V join(V4 a, V4 b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7); }
FF_INLINE V4 fold(V v) {
    return __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
}
// Weights 2 i and 2 i + 1 of w, each four times.
FF_INLINE V spread(V4 w, int i) {
    return i == 0 ? __builtin_shufflevector(w, w, 0, 0, 0, 0, 1, 1, 1, 1)
                  : __builtin_shufflevector(w, w, 2, 2, 2, 2, 3, 3, 3, 3);
}
#else
FF_INLINE V all(double x) { return all4(x); }
FF_INLINE V4 fold(V v) { return v; }
FF_INLINE V spread(V4 w, int i) {
    return i == 0   ? __builtin_shufflevector(w, w, 0, 0, 0, 0)
           : i == 1 ? __builtin_shufflevector(w, w, 1, 1, 1, 1)
           : i == 2 ? __builtin_shufflevector(w, w, 2, 2, 2, 2)
                    : __builtin_shufflevector(w, w, 3, 3, 3, 3);
}
#endif
inline constexpr int kPerVector = kWidth / 4;  // coefficients in a V

// 1 / w. Not by the estimate of 2^-14 that AVX-512 has and Newton's steps: these take four fused operations
// of the units that everything else waits for, a division hardly any.
FF_INLINE V reciprocal(V w) { return all(1) / w; }

// 1 / sqrt(x) to within 4 * 2^-53, relatively. REQUIRES 2^-1000 <= x <= 2^1000.
FF_INLINE V reciprocal_root(V x) {
#if defined(__AVX512F__)
    const __m512d one = _mm512_set1_pd(1), half = _mm512_set1_pd(0.5);
    __m512d y = _mm512_maskz_rsqrt14_pd(0xff, (__m512d)x);
    for (int i = 0; i < 2; ++i) {
        const __m512d e = _mm512_fnmadd_pd(_mm512_mul_pd((__m512d)x, y), y, one);
        y = _mm512_fmadd_pd(_mm512_mul_pd(y, half), e, y);
    }
    return (V)y;
#elif defined(__AVX2__)
    return all(1) / (V)_mm256_sqrt_pd((__m256d)x);
#else
    V r;
    for (int i = 0; i < kWidth; ++i) r[i] = 1 / __builtin_sqrt(x[i]);
    return r;
#endif
}

FF_INLINE bool all_inside(V x, V lo, V hi, bool with_hi) {
#if defined(__AVX512F__)
    const auto below = with_hi ? _mm512_cmp_pd_mask((__m512d)x, (__m512d)hi, _CMP_LE_OQ)
                               : _mm512_cmp_pd_mask((__m512d)x, (__m512d)hi, _CMP_LT_OQ);
    return (_mm512_cmp_pd_mask((__m512d)x, (__m512d)lo, _CMP_GE_OQ) & below) == 0xff;
#elif defined(__AVX2__)
    const __m256d below = with_hi ? _mm256_cmp_pd((__m256d)x, (__m256d)hi, _CMP_LE_OQ)
                                  : _mm256_cmp_pd((__m256d)x, (__m256d)hi, _CMP_LT_OQ);
    return _mm256_movemask_pd(_mm256_and_pd(below, _mm256_cmp_pd((__m256d)x, (__m256d)lo, _CMP_GE_OQ))) == 15;
#else
    bool ok = true;
    for (int i = 0; i < kWidth; ++i) ok &= (x[i] >= lo[i]) & (with_hi ? x[i] <= hi[i] : x[i] < hi[i]);
    return ok;
#endif
}

// Of lanes that are all ones or all zeros.
FF_INLINE int ones(I mask) {
#if defined(__AVX512F__)
    return __builtin_popcount(_mm512_movepi64_mask((__m512i)mask));
#elif defined(__AVX2__)
    return __builtin_popcount(unsigned(_mm256_movemask_pd((__m256d)mask)));
#else
    int n = 0;
    for (int i = 0; i < kWidth; ++i) n += mask[i] != 0;
    return n;
#endif
}
FF_INLINE bool all_of(I mask) { return ones(mask) == kWidth; }
FF_INLINE bool none_of(I mask) { return ones(mask) == 0; }

// Past the caches. REQUIRES p a multiple of the size of V.
FF_INLINE void store_past(double* p, V v) {
#if defined(__AVX512F__)
    _mm512_stream_pd(p, (__m512d)v);
#elif defined(__AVX2__)
    _mm256_stream_pd(p, (__m256d)v);
#elif defined(__SSE2__)
    _mm_stream_pd(p, __m128d{v[0], v[1]});
    _mm_stream_pd(p + 2, __m128d{v[2], v[3]});
#else
    store(p, v);
#endif
}

FF_INLINE void store_three(double* p, V4 v) {
#if defined(__AVX512F__)
    _mm256_mask_storeu_pd(p, 7, (__m256d)v);
#else
    *reinterpret_cast<V2u*>(p) = __builtin_shufflevector(v, v, 0, 1);
    p[2] = v[2];
#endif
}

// The first three numbers of kWidth places, one in each lane.
FF_INLINE void three_of(const double* const* from, V& x, V& y, V& z) {
#if defined(__AVX512F__)
    const V a = join(load4(from[0]), load4(from[4])), b = join(load4(from[1]), load4(from[5]));
    const V c = join(load4(from[2]), load4(from[6])), d = join(load4(from[3]), load4(from[7]));
    const V ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const V cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    const V ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    const V cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    x = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
    y = __builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13);
    z = __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
#else
    const V a = load4(from[0]), b = load4(from[1]), c = load4(from[2]), d = load4(from[3]);
    const V ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const V ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    x = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    y = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    z = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
#endif
}

// kWidth coefficients, one after the other, to their coordinates side by side.
FF_INLINE void transpose(const double* p, V* s) {
#if defined(__AVX512F__)
    const V a = load(p), b = load(p + 8), c = load(p + 16), d = load(p + 24);
    const V ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const V cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    const V ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    const V cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    s[0] = __builtin_shufflevector(ab, cd, 0, 4, 1, 5, 8, 12, 9, 13);
    s[1] = __builtin_shufflevector(ab1, cd1, 0, 4, 1, 5, 8, 12, 9, 13);
    s[2] = __builtin_shufflevector(ab, cd, 2, 6, 3, 7, 10, 14, 11, 15);
    s[3] = __builtin_shufflevector(ab1, cd1, 2, 6, 3, 7, 10, 14, 11, 15);
#else
    const V a = load(p), b = load(p + 4), c = load(p + 8), d = load(p + 12);
    const V ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const V ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    s[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    s[1] = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    s[2] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    s[3] = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
#endif
}

// kWidth points of three coordinates, one after the other.
FF_INLINE void interleave(V x, V y, V z, V* out) {
#if defined(__AVX512F__)
    const V a = __builtin_shufflevector(x, y, 0, 8, -1, 1, 9, -1, 2, 10);
    const V b = __builtin_shufflevector(x, y, -1, 3, 11, -1, 4, 12, -1, 5);
    const V c = __builtin_shufflevector(x, y, 13, -1, 6, 14, -1, 7, 15, -1);
    out[0] = __builtin_shufflevector(a, z, 0, 1, 8, 3, 4, 9, 6, 7);
    out[1] = __builtin_shufflevector(b, z, 10, 1, 2, 11, 4, 5, 12, 7);
    out[2] = __builtin_shufflevector(c, z, 0, 13, 2, 3, 14, 5, 6, 15);
#else
    const V a = __builtin_shufflevector(x, y, 0, 4, -1, 1), b = __builtin_shufflevector(x, y, 5, -1, 2, 6);
    const V c = __builtin_shufflevector(x, y, -1, 3, 7, -1);
    out[0] = __builtin_shufflevector(a, z, 0, 1, 4, 3);
    out[1] = __builtin_shufflevector(b, z, 0, 5, 2, 3);
    out[2] = __builtin_shufflevector(c, z, 6, 1, 2, 7);
#endif
}

// Four points of three coordinates, `stride` numbers apart.
FF_INLINE void store_four_apart(double* p, V4 x, V4 y, V4 z, long stride) {
    const V4 a = __builtin_shufflevector(x, y, 0, 4, 2, 6), b = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    const V4 c = __builtin_shufflevector(z, z, 0, 0, 2, 2), d = __builtin_shufflevector(z, z, 1, 1, 3, 3);
    store_three(p, __builtin_shufflevector(a, c, 0, 1, 4, 5));
    store_three(p + stride, __builtin_shufflevector(b, d, 0, 1, 4, 5));
    store_three(p + 2 * stride, __builtin_shufflevector(a, c, 2, 3, 6, 7));
    store_three(p + 3 * stride, __builtin_shufflevector(b, d, 2, 3, 6, 7));
}

// kWidth points of any dimension, `stride` numbers apart.
FF_INLINE void emit(double* p, const V* s, int dim, long stride) {
    if (dim == 3) {
#if defined(__AVX512F__)
        const V a = __builtin_shufflevector(s[0], s[1], 0, 8, 2, 10, 4, 12, 6, 14);
        const V b = __builtin_shufflevector(s[0], s[1], 1, 9, 3, 11, 5, 13, 7, 15);
        const V z = s[2];
        const V v[4] = {__builtin_shufflevector(a, z, 0, 1, 8, 8, 4, 5, 12, 12),
                        __builtin_shufflevector(b, z, 0, 1, 9, 9, 4, 5, 13, 13),
                        __builtin_shufflevector(a, z, 2, 3, 10, 10, 6, 7, 14, 14),
                        __builtin_shufflevector(b, z, 2, 3, 11, 11, 6, 7, 15, 15)};
        for (int i = 0; i < 4; ++i) {
            store_three(p + i * stride, __builtin_shufflevector(v[i], v[i], 0, 1, 2, 3));
            store_three(p + (i + 4) * stride, __builtin_shufflevector(v[i], v[i], 4, 5, 6, 7));
        }
#else
        store_four_apart(p, s[0], s[1], s[2], stride);
#endif
        return;
    }
    double copy[4][kWidth];  // so that s itself stays in registers
    for (int c = 0; c < 4; ++c) store(copy[c], s[c]);
    for (int i = 0; i < kWidth; ++i)
        for (int c = 0; c < dim; ++c) p[i * stride + c] = copy[c][i];
}

// Where numbers go, one vector after the other: into memory, or past the caches, for which the vectors are
// shifted to whole lines of it; what is left over at both ends is stored as usual.
struct Sink {
    double* to = nullptr;  // the next number; past: the line that `carry` begins
    bool past = false, begun = false;
    int skew = 0;  // numbers of the first line that are not ours
    V carry = {};

    FF_BODY inline void open(double* p, bool past_the_caches) {
        to = p, past = past_the_caches, begun = false;
        skew = past ? int(reinterpret_cast<std::size_t>(p) / sizeof(double) % std::size_t(kWidth)) : 0;
        carry = all(0);
    }
    FF_BODY inline V shifted(V before, V v) const {
#if defined(__AVX512F__)
        const I lane = {8, 9, 10, 11, 12, 13, 14, 15};
        return (V)_mm512_permutex2var_pd((__m512d)before, (__m512i)(lane - (long long)skew), (__m512d)v);
#else
        return skew == 0   ? v
               : skew == 1 ? __builtin_shufflevector(before, v, 3, 4, 5, 6)
               : skew == 2 ? __builtin_shufflevector(before, v, 2, 3, 4, 5)
                           : __builtin_shufflevector(before, v, 1, 2, 3, 4);
#endif
    }
    FF_BODY inline void put(V v) {
        if (!past) {
            store(to, v);
            to += kWidth;
            return;
        }
        if (begun) {
            store_past(to, shifted(carry, v));
            to += kWidth;
        } else {
            put_first(v);
        }
        carry = v;
    }
    template <int Count>
    FF_BODY inline void put_all(const V* v) {
        if (!past || !begun) {
            each<Count>(Count, [&](int i) FF_BODY { put(v[i]); });
            return;
        }
        V before = carry;
        each<Count>(Count, [&](int i) FF_BODY {
            store_past(to + i * kWidth, shifted(before, v[i]));
            before = v[i];
        });
        carry = before;
        to += Count * kWidth;
    }
    // The first vector, as much of it as lies in the first line.
    void put_first(V v) {
        double some[kWidth];
        store(some, v);
        for (int i = 0; i < kWidth - skew; ++i) *to++ = some[i];
        begun = true;
    }
    // The rest of the last vector. Numbers may follow with put_few(), vectors no more.
    void close() {
        if (!past || !begun) return;
        double some[kWidth];
        store(some, carry);
        for (int i = kWidth - skew; i < kWidth; ++i) *to++ = some[i];
        past = begun = false;
    }
    void put_few(const double* from, long n) {
        close();
        for (long i = 0; i < n; ++i) *to++ = from[i];
    }
};
