// The one body of the kernels for blocks. Included by a file for each instruction set, which says its name.
#include "blocks.hpp"
#include "degree.hpp"
#include "evaluate.hpp"

#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace freiform::kernel {
namespace FF_KERNEL {
namespace {
#include "vectors.inl"

typedef long long I4 __attribute__((vector_size(32)));
typedef long long I4u __attribute__((vector_size(32), aligned(8), may_alias));

// The larger ones; `a` where b is not a number.
FF_INLINE V4 larger(V4 a, V4 b) {
#if defined(__AVX__)
    return (V4)_mm256_max_pd((__m256d)b, (__m256d)a);
#elif defined(__SSE2__)
    const __m128d lo = _mm_max_pd(__m128d{b[0], b[1]}, __m128d{a[0], a[1]});
    const __m128d hi = _mm_max_pd(__m128d{b[2], b[3]}, __m128d{a[2], a[3]});
    return V4{lo[0], lo[1], hi[0], hi[1]};
#else
    return a < b ? b : a;
#endif
}
FF_INLINE V4 kept(V4 v, I4 mask) { return (V4)((I4)v & mask); }
FF_INLINE V4 size_of(V4 v) {
    const long long all_but_sign = 0x7fffffffffffffffLL;
    return kept(v, I4{all_but_sign, all_but_sign, all_but_sign, all_but_sign});
}
// Of lanes beside those that count.
FF_INLINE I4 first_of(int count) {
    static constexpr long long kMask[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
    return *reinterpret_cast<const I4u*>(kMask + 4 - (count < 0 ? 0 : count > 4 ? 4 : count));
}

// One number for each of four vectors, of all their lanes.
template <class F>
FF_INLINE V4 over_lanes(V4 a, V4 b, V4 c, V4 d, F f) {
    const V4 ab = f(__builtin_shufflevector(a, b, 0, 4, 2, 6), __builtin_shufflevector(a, b, 1, 5, 3, 7));
    const V4 cd = f(__builtin_shufflevector(c, d, 0, 4, 2, 6), __builtin_shufflevector(c, d, 1, 5, 3, 7));
    return f(__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7));
}

template <int Count>
FF_INLINE void restrict_lanes(const double* from, std::ptrdiff_t from_step, int count, double* to,
                              int to_step, double hi, double lo) {
    const int n = Count > 0 ? Count : count;
    V4 b[Count > 0 ? Count : kMaxDegree + 1];
    for (int i = 0; i < n; ++i) b[i] = load4(from + i * from_step);
    if (hi < 1)
        for (int r = 1; r < n; ++r)
            for (int i = n - 1; i >= r; --i) b[i] = all4(1 - hi) * b[i - 1] + all4(hi) * b[i];
    if (lo > 0)
        for (int r = 1; r < n; ++r)
            for (int i = 0; i < n - r; ++i) b[i] = all4(1 - lo) * b[i] + all4(lo) * b[i + 1];
    for (int i = 0; i < n; ++i) store4(to + i * to_step, b[i]);
}
FF_INLINE void restrict_four(const double* from, std::ptrdiff_t from_step, int count, double* to, int to_step,
                             double hi, double lo) {
    count == 4   ? restrict_lanes<4>(from, from_step, count, to, to_step, hi, lo)
    : count == 3 ? restrict_lanes<3>(from, from_step, count, to, to_step, hi, lo)
                 : restrict_lanes<0>(from, from_step, count, to, to_step, hi, lo);
}

void restrict_all(double* p, int count, int lanes, double hi, double lo) {
    for (int k = 0; k < lanes; k += 4) restrict_four(p + k, lanes, count, p + k, lanes, hi, lo);
}

void restrict_quadruples(const Quadruples& t, double* to, double hi, double lo) {
    for (int k = 0; k < t.columns; ++k)
        restrict_four(t.from + k * t.column_step, t.row_step, t.rows, to + 4 * k, 4 * t.columns, hi, lo);
}

void arrange_quadruples(const Quadruples& t, double* to) {
    const int lanes = lanes_of(t.columns);
    const std::size_t plane = std::size_t(t.rows) * std::size_t(lanes);
    for (int r = 0; r < t.rows; ++r)
        for (int k = 0; k < lanes; k += 4) {
            V4 p[4];
            for (int i = 0; i < 4; ++i)
                p[i] = k + i < t.columns ? load4(t.from + r * t.row_step + (k + i) * t.column_step) : all4(0);
            const V4 ab = __builtin_shufflevector(p[0], p[1], 0, 4, 2, 6),
                     cd = __builtin_shufflevector(p[2], p[3], 0, 4, 2, 6),
                     ab1 = __builtin_shufflevector(p[0], p[1], 1, 5, 3, 7),
                     cd1 = __builtin_shufflevector(p[2], p[3], 1, 5, 3, 7);
            double* const at = to + r * lanes + k;
            store4(at, __builtin_shufflevector(ab, cd, 0, 1, 4, 5));
            store4(at + plane, __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5));
            store4(at + 2 * plane, __builtin_shufflevector(ab, cd, 2, 3, 6, 7));
            store4(at + 3 * plane, __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7));
        }
}

// Dim, Directions: how many, or -1 where that is known only when running.
template <int Dim, bool kRational, int Directions>
struct Differences {
    static constexpr int kPlanes = Dim < 0 ? -1 : Dim + int(kRational);

    const BlockTask& t;
    BlockFound& out;
    const int dim = Dim < 0 ? t.shape.dim : Dim, lanes = t.shape.lanes(), columns = t.shape.columns;
    const int directions = Directions < 0 ? t.directions : Directions;
    const std::size_t plane = t.shape.plane();
    double* const down = t.room;
    double* const work = t.room + std::size_t(dim + int(kRational)) * plane;
    double ruled_centre[kBlockOrder + 1][4] = {};

    template <class F>
    FF_BODY inline void each_plane(F f) const {
        each<kPlanes>(dim + int(kRational), f);
    }
    template <class F>
    FF_BODY inline void each_direction(F f) const {
        each<Directions>(directions, f);
    }
    FF_BODY inline V4 square_of(const V4* x) const {
        V4 sum = x[0] * x[0];
        each < Dim<0 ? -1 : Dim - 1>(
                   dim - 1, [&](int c) FF_BODY { sum += x[c + 1] * x[c + 1]; });
        return sum;
    }
    FF_BODY inline V4 along(int k, const V4* x) const {
        V4 sum = all4(t.direction[k][0]) * x[0];
        each < Dim<0 ? -1 : Dim - 1>(
                   dim - 1, [&](int c) FF_BODY { sum += all4(t.direction[k][c + 1]) * x[c + 1]; });
        return sum;
    }

    // Brings the numerators to the centre.
    FF_BODY inline void begin() const {
        V4 least = all4(1e308), most = all4(kRational ? 0 : 1), far = all4(0), square = all4(0);
        V4 largest[4] = {far, far, far, far}, across[kBlockDirections] = {far, far};
        for (int k = 0; k < lanes; k += 4) {
            const I4 mask = first_of(columns - k);
            // Beside the columns weights are 1, which changes nothing.
            const V4 beside = (V4)((I4)all4(1) & ~mask), above = (V4)((I4)all4(1e308) & ~mask);
            for (std::size_t at = std::size_t(k); at < plane; at += std::size_t(lanes)) {
                V4 w = all4(1), x[kBlockPlanes];
                if constexpr (kRational) {
                    w = x[dim] = load4(t.numbers + std::size_t(dim) * plane + at);
                    store4(down + std::size_t(dim) * plane + at, w);
                    most = larger(most, w);
                    least = -larger(-least, -(w + above));
                    w += beside;
                }
                each<Dim>(dim, [&](int c) FF_BODY {
                    const V4 p = load4(t.numbers + std::size_t(c) * plane + at);
                    largest[c] = larger(largest[c], size_of(p));
                    x[c] = kRational ? p - x[dim] * all4(t.centre[c]) : kept(p - all4(t.centre[c]), mask);
                    store4(down + std::size_t(c) * plane + at, x[c]);
                });
                const V4 sum = square_of(x);
                far = larger(far, sum);
                square = kRational ? larger(square, sum / (w * w)) : far;
                each_direction([&](int i) FF_BODY {
                    const V4 part = size_of(along(i, x));
                    across[i] = larger(across[i], kRational ? part / w : part);
                });
            }
        }
        const auto max = [](V4 a, V4 b) FF_BODY { return larger(a, b); };
        store4(out.largest, over_lanes(largest[0], largest[1], largest[2], largest[3], max));
        double rest[4];
        store4(rest, over_lanes(far, square, across[0], across[1], max));
        out.farthest = rest[0], out.square = rest[1], out.across[0] = rest[2], out.across[1] = rest[3];
        store4(rest, over_lanes(-least, most, far, far, max));
        out.least_weight = kRational ? -rest[0] : 1, out.most_weight = rest[1];
    }

    // Differences along the rows of what `from` holds, j of them altogether, into `work`; none for j = 0.
    template <bool kSubtract, bool kMiddle, bool kRuled>
    FF_BODY inline void look(const double* from, int rows, int i, int j) const {
        V4 most = all4(0), weight = most, aside[kBlockDirections] = {most, most};
        V4 middle[kBlockPlanes] = {most, most, most, most, most};
        V4 ruled = most, ruled_aside[kBlockDirections] = {most, most};
        const double* const row_share = t.at_half + std::size_t(rows - 1) * t.half_stride;
        for (int k = 0; k < lanes; k += 4) {
            const I4 mask = first_of(columns - j - k);
            const V4 share =
                kMiddle ? load4(t.at_half + std::size_t(columns - 1 - j) * t.half_stride + std::size_t(k))
                        : most;
            const double* p = from + k;
            double* q = work + k;
            for (int r = 0; r < rows; ++r, p += lanes, q += lanes) {
                V4 x[kBlockPlanes];
                each_plane([&](int c) FF_BODY {
                    const double* const own = p + std::size_t(c) * plane;
                    x[c] = load4(own);
                    if constexpr (kSubtract) {
                        // Not load4(own + 1): what was just stored would not be there yet.
                        const V4 next = k + 4 < lanes ? load4(own + 4) : x[c];
                        x[c] = kept(__builtin_shufflevector(x[c], next, 1, 2, 3, 4) - x[c], mask);
                    }
                    if (kSubtract) store4(q + std::size_t(c) * plane, x[c]);
                });
                most = larger(most, square_of(x));
                each_direction([&](int d) FF_BODY { aside[d] = larger(aside[d], size_of(along(d, x))); });
                if constexpr (kRational) weight = larger(weight, size_of(x[dim]));
                if constexpr (kMiddle) {
                    const V4 part = all4(row_share[r]) * share;
                    each_plane([&](int c) FF_BODY { middle[c] += part * x[c]; });
                }
                if constexpr (kRuled) {
                    const V4 w = load4(down + std::size_t(dim) * plane + (q - work)),
                             divide = i == 0 ? all4(1) / w : all4(1);
                    each<Dim>(dim, [&](int c) FF_BODY {
                        x[c] = kept((x[c] - w * all4(ruled_centre[j][c])) * divide, mask);
                    });
                    ruled = larger(ruled, square_of(x));
                    each_direction([&](int d) FF_BODY {
                        ruled_aside[d] = larger(ruled_aside[d], size_of(along(d, x)));
                    });
                }
            }
        }
        BlockFound::Difference& found = out.of[i][j];
        const auto max = [](V4 a, V4 b) FF_BODY { return larger(a, b); };
        store4(found.most, over_lanes(most, weight, aside[0], aside[1], max));
        if constexpr (kRuled)
            store4(found.ruled, over_lanes(ruled, ruled_aside[0], ruled_aside[1], all4(0), max));
        if constexpr (kMiddle) {
            const auto sum = [](V4 a, V4 b) FF_BODY { return a + b; };
            store4(found.middle, over_lanes(middle[0], middle[1], middle[2], middle[3], sum));
            if (dim + int(kRational) > 4)
                store4(found.middle + 4, over_lanes(middle[4], all4(0), all4(0), all4(0), sum));
        }
    }

    void run() {
        begin();
        for (int i = 0; i <= t.top && i < t.shape.rows; ++i) {
            const int rows = t.shape.rows - i;
            if (i > 0)
                each_plane([&](int c) FF_BODY {
                    double* const p = down + std::size_t(c) * plane;
                    for (int k = 0; k < rows * lanes; k += 4)
                        store4(p + k, load4(p + k + lanes) - load4(p + k));
                });
            const bool first_middle = kRational && i != t.top;
            first_middle ? look<false, kRational, false>(down, rows, i, 0)
                         : look<false, false, false>(down, rows, i, 0);
            for (int j = 1; i + j <= t.top && j < columns; ++j) {
                const double* const from = j == 1 ? down : work;
                const bool middle = kRational && i + j != t.top;
                if (kRational && t.ruled) {
                    if (i == 0) find_ruled_centre(from, j);
                    middle ? look<true, kRational, kRational>(from, rows, i, j)
                           : look<true, false, kRational>(from, rows, i, j);
                } else {
                    middle ? look<true, kRational, false>(from, rows, i, j)
                           : look<true, false, false>(from, rows, i, j);
                }
            }
        }
    }

    void find_ruled_centre(const double* from, int j) {
        const std::size_t row = std::size_t(t.shape.rows / 2) * std::size_t(lanes),
                          at = row + std::size_t((columns - j) / 2);
        const double w = down[std::size_t(dim) * plane + row];
        for (int c = 0; c < dim; ++c) {
            const double* const p = from + std::size_t(c) * plane + at;
            ruled_centre[j][c] = (p[1] - p[0]) / w;
        }
    }
};

template <int Dim, bool kRational>
FF_INLINE void differences_of(const BlockTask& t, BlockFound& out) {
    constexpr int kNone = Dim > 0 ? 0 : -1, kOne = Dim > 0 ? 1 : -1;
    if (Dim > 0 && t.directions == 0)
        Differences<Dim, kRational, kNone>{t, out}.run();
    else if (Dim > 0 && t.directions == 1)
        Differences<Dim, kRational, kOne>{t, out}.run();
    else
        Differences<Dim, kRational, -1>{t, out}.run();
}

void differences(const BlockTask& t, BlockFound& out) {
    const int dim = t.shape.dim;
#if defined(__wasm__)
    constexpr int kTwo = -1, kThree = -1;  // for size, modules have but one body of each kind
#else
    constexpr int kTwo = 2, kThree = 3;
#endif
    if (t.shape.rational)
        dim == 3 ? differences_of<kThree, true>(t, out) : differences_of<-1, true>(t, out);
    else
        dim == 3   ? differences_of<kThree, false>(t, out)
        : dim == 2 ? differences_of<kTwo, false>(t, out)
                   : differences_of<-1, false>(t, out);
}

#include "rest.inl"

// `Count`: coefficients along both axes that do not wrap, or -1.
template <int Order, int Count>
FF_INLINE void contract_to(const Contraction& t, double* out) {
    constexpr int kSlots = (Order + 1) * (Order + 2) / 2;
    V4 sum[kSlots];
    each<kSlots>(kSlots, [&](int i) FF_BODY { sum[i] = all4(0); });
    int row = t.first[0];
    each<Count>(t.count[0], [&](int k) FF_BODY {
        const double* const from = t.net + row * t.stride[0];
        V4 inner[Order + 1];
        each<Order + 1>(Order + 1, [&](int b) FF_BODY { inner[b] = all4(0); });
        int column = t.first[1];
        each<Count>(t.count[1], [&](int l) FF_BODY {
            const V4 p = load4(from + column * t.stride[1]);
            each<Order + 1>(Order + 1, [&](int b) FF_BODY {
                inner[b] += all4(t.weights[1][b * t.weight_stride + l]) * p;
            });
            if (++column == t.extent[1] && Count < 0) column = 0;
        });
        each<Order + 1>(Order + 1, [&](int b) FF_BODY {
            for (int a = 0; a + b <= Order; ++a)
                sum[(a + b) * (a + b + 1) / 2 + b] += all4(t.weights[0][a * t.weight_stride + k]) * inner[b];
        });
        if (++row == t.extent[0] && Count < 0) row = 0;
    });
    each<kSlots>(kSlots, [&](int i) FF_BODY { store4(out + 4 * i, sum[i]); });
}
template <int Count>
FF_INLINE void contract_all(const Contraction& t, double* out) {
    t.order == 0   ? contract_to<0, Count>(t, out)
    : t.order == 1 ? contract_to<1, Count>(t, out)
    : t.order == 2 ? contract_to<2, Count>(t, out)
                   : contract_to<3, Count>(t, out);
}

void contract(const Contraction& t, double* out) {
#if !defined(__wasm__)  // for size
    constexpr int kUsual = 4;
    const auto is_usual = [&](int d) { return t.count[d] == kUsual && t.first[d] + kUsual <= t.extent[d]; };
    if (is_usual(0) && is_usual(1)) return contract_all<kUsual>(t, out);
#endif
    contract_all<-1>(t, out);
}

}  // namespace
}  // namespace FF_KERNEL

const BlockKernels FF_KERNELS = {FF_KERNEL::restrict_all,       FF_KERNEL::restrict_quadruples,
                                 FF_KERNEL::arrange_quadruples, FF_KERNEL::differences,
                                 FF_KERNEL::contract,           FF_KERNEL::rest};

}  // namespace freiform::kernel
