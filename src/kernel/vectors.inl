// Vectors of doubles for the instruction set that the including file is compiled for. Everything is inlined
// and lies in a namespace of that instruction set: no function here may be shared between files of different
// flags, so nothing of the standard library is used.
//
// V: kWidth lanes, for parameters side by side. V4: one coefficient. Compiler vectors; instructions by name
// only where no operator stands for them (estimates of reciprocals, stores past the caches, tests of all
// lanes).

#define FF_INLINE static inline __attribute__((always_inline))
#define FF_BODY __attribute__((always_inline))

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

FF_INLINE V4 load4(const double* p) { return *reinterpret_cast<const V4u*>(p); }
FF_INLINE void store4(double* p, V4 v) { *reinterpret_cast<V4u*>(p) = v; }
FF_INLINE V load(const double* p) { return *reinterpret_cast<const Vu*>(p); }
FF_INLINE void store(double* p, V v) { *reinterpret_cast<Vu*>(p) = v; }
FF_INLINE V4 all4(double x) { return V4{x, x, x, x}; }
#if defined(__AVX512F__)
FF_INLINE V all(double x) { return V{x, x, x, x, x, x, x, x}; }
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

// 1 / w to within 1.2 * 2^-53, relatively. REQUIRES 2^-1000 <= w <= 2^1000. Newton's step squares the error
// of the estimate, 2^-14, twice: the second step adds the rounding of its one sum to 2^-55.
FF_INLINE V reciprocal(V w) {
#if defined(__AVX512F__)
    const __m512d one = _mm512_set1_pd(1);
    __m512d r = _mm512_maskz_rcp14_pd(0xff, (__m512d)w);
    r = _mm512_fmadd_pd(r, _mm512_fnmadd_pd((__m512d)w, r, one), r);
    r = _mm512_fmadd_pd(r, _mm512_fnmadd_pd((__m512d)w, r, one), r);
    return (V)r;
#else
    return all(1) / w;
#endif
}

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
    *reinterpret_cast<V2u*>(p) = __builtin_shufflevector(v, v, 0, 1);
    p[2] = v[2];
}

// kWidth points of three coordinates, one after the other.
FF_INLINE void store_points(double* p, V x, V y, V z) {
#if defined(__AVX512F__)
    const V a = __builtin_shufflevector(x, y, 0, 8, -1, 1, 9, -1, 2, 10);
    const V b = __builtin_shufflevector(x, y, -1, 3, 11, -1, 4, 12, -1, 5);
    const V c = __builtin_shufflevector(x, y, 13, -1, 6, 14, -1, 7, 15, -1);
    store(p, __builtin_shufflevector(a, z, 0, 1, 8, 3, 4, 9, 6, 7));
    store(p + 8, __builtin_shufflevector(b, z, 10, 1, 2, 11, 4, 5, 12, 7));
    store(p + 16, __builtin_shufflevector(c, z, 0, 13, 2, 3, 14, 5, 6, 15));
#else
    const V a = __builtin_shufflevector(x, y, 0, 4, -1, 1), b = __builtin_shufflevector(x, y, 5, -1, 2, 6);
    const V c = __builtin_shufflevector(x, y, -1, 3, 7, -1);
    store(p, __builtin_shufflevector(a, z, 0, 1, 4, 3));
    store(p + 4, __builtin_shufflevector(b, z, 0, 5, 2, 3));
    store(p + 8, __builtin_shufflevector(c, z, 6, 1, 2, 7));
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
FF_INLINE void store_points_apart(double* p, V x, V y, V z, long stride) {
#if defined(__AVX512F__)
    store_four_apart(p, __builtin_shufflevector(x, x, 0, 1, 2, 3), __builtin_shufflevector(y, y, 0, 1, 2, 3),
                     __builtin_shufflevector(z, z, 0, 1, 2, 3), stride);
    store_four_apart(p + 4 * stride, __builtin_shufflevector(x, x, 4, 5, 6, 7),
                     __builtin_shufflevector(y, y, 4, 5, 6, 7), __builtin_shufflevector(z, z, 4, 5, 6, 7),
                     stride);
#else
    store_four_apart(p, x, y, z, stride);
#endif
}

// kWidth points of any dimension, `stride` numbers apart.
FF_INLINE void emit(double* p, const V* x, int dim, long stride) {
    if (dim == 3) {
        if (stride == 3)
            store_points(p, x[0], x[1], x[2]);
        else
            store_points_apart(p, x[0], x[1], x[2], stride);
        return;
    }
    double copy[4][kWidth];  // so that x itself stays in registers
    for (int c = 0; c < 4; ++c) store(copy[c], x[c]);
    for (int i = 0; i < kWidth; ++i)
        for (int c = 0; c < dim; ++c) p[i * stride + c] = copy[c][i];
}
