// Evaluation of many points: plain arrays in, plain arrays out, compiled once for every instruction set.
//
// This layer knows no bases and no patches. An axis is a table of the spans of one parameter, each with the
// polynomials that are the basis functions there; a net
// is an array of coefficients, four (or eight) numbers each. spline/prepared.cpp fills them in.
#pragma once
#include <cstddef>

namespace freiform::kernel {

inline constexpr int kMaxDegree = 25;  // that of basis/bspline.hpp
inline constexpr int kMaxOrder = 2;    // of derivatives
inline constexpr int kTile = 64;       // points that are worked on at once

// A span [lo, hi]. `inverse` is 1 / (hi - lo); `next` is where the next span begins, infinity after the last
// one. A line of the cache that says where to go from there.
struct __attribute__((may_alias, aligned(64))) Span {
    double lo, hi, inverse, next;
    std::size_t coefficients;  // of the first coefficient, in Net::coefficients; 0 for curves
    int first;                 // its index along the axis
};

// One parameter. Inside a span, with the distances `near` and `far` of x from the nearer and the farther end
// of it (the left one is nearer in the middle), r = near / far in [0, 1], the derivative of order o of the
// `lanes` functions (of a curve: of its coordinates) is
//
//     (far / (hi - lo))^p  far^-o  sum_k  column(o, k)[0 .. lanes)  r^k,      k = 0 .. p - o
//
// of columns that are made for the half of the span that x is in. A record is a Span, the columns of its left
// half, those of its right half; columns of order 0 first, of an order the highest k first.
struct Axis {
    int degree = 0, spans = 0;
    int lanes = 4;                     // a multiple of 4; numbers of a column, the unused ones 0
    const double* record = nullptr;    // spans records of `stride` numbers
    std::size_t stride = 0, half = 0;  // half: numbers of the columns of one half
    // Search. x is in span s or one of the `steps` after it, s = bucket[min(int((x - lo) * scale), buckets -
    // 1)]; steps is 2^k - 1. The spans are followed by `steps` more whose `next` is infinite.
    double lo = 0, scale = 0;
    int buckets = 1, steps = 1;
    const int* bucket = nullptr;  // holds s * stride / kLine

    static constexpr std::size_t kLine = 8;  // numbers in a line of the cache
    int columns(int order) const { return order > degree ? 0 : degree + 1 - order; }
    std::size_t column(int order) const {  // of the first one of an order, in a half
        return std::size_t(lanes) * std::size_t(order == 0   ? 0
                                                : order == 1 ? columns(0)
                                                             : columns(0) + columns(1));
    }
};

// A curve (axes == 1) is its axis alone, the coordinates being the functions. The net of a surface or volume
// is row-major, unwound if closed, its last axis followed by enough zeros to be read in pairs. A coefficient
// takes 4 numbers: up to three coordinates, and in the fourth place the weight or a fourth coordinate. Four
// coordinates and a weight take two of them, `plane` numbers apart: (x y z w), (0 0 0 weight).
struct Net {
    int axes = 1, dim = 3;
    bool rational = false;
    Axis axis[3];
    const double* coefficients = nullptr;
    std::size_t stride[3] = {};  // in numbers, of each axis
    std::size_t plane = 0;

    int planes() const { return dim + int(rational) > 4 ? 2 : 1; }
};

// What to compute: partial derivatives up to total order `order` in graded order, of which `slots` are
// written, dim numbers each; and of surfaces in space, where they are not null, unit normals (order >= 1) and
// Gaussian and mean curvatures, two numbers each (order 2). past: with stores that go past the caches where
// the processor has them; `flush` afterwards.
struct Output {
    int order = 0, slots = 1;
    double* jets = nullptr;
    double* normals = nullptr;
    double* curvatures = nullptr;
    bool past = false;
};

// The last axis of a grid, in groups of `width` parameters. The parameters of a group that are in one span
// form a part of it; the weights of the others are 0 there. weights: for each order up to `order`, each of
// the degree + 1 functions, `width` numbers.
struct GridPart {
    int group, first;
};
struct GridAxis {
    int count = 0, degree = 0, width = 8, order = 0;
    int parts = 0;
    const GridPart* part = nullptr;  // ascending by group
    const double* weights = nullptr;
    std::size_t stride() const {
        return std::size_t(order + 1) * std::size_t(degree + 1) * std::size_t(width);
    }
};

// Everything that is compiled for one instruction set. Parameters must be finite and inside [lo, hi] of the
// axes.
struct Kernels {
    const char* name;
    int width;  // doubles in a vector
    // n parameters, `axes` numbers each.
    void (*scattered)(const Net&, const double* at, std::size_t n, const Output&);
    // The values of the basis functions at n parameters of one axis, for each order: axis.lanes numbers for
    // each parameter and order, and the indices of the first coefficients.
    void (*weights)(const Axis&, const double* at, std::size_t n, int order, double* out, int* first);
    // One row of a grid: `outer` holds, for every order of the outer axes (graded, at most the total order),
    // the coefficients along the last axis after the outer ones are contracted, 4 numbers each, planes one
    // after the other, `row` numbers for each order. Writes last.count points.
    void (*grid_row)(const Net&, const GridAxis& last, const double* outer, std::size_t row, const Output&);
    // sum[0 .. n) = sum_i w[i] * from[i][0 .. n)
    void (*combine)(const double* const* from, const double* w, int terms, double* sum, std::size_t n);
    // Makes what was stored past the caches visible to other threads.
    void (*flush)();
    // Whether all n numbers are inside [lo, hi], of `axes` interleaved intervals.
    bool (*inside)(const double* at, std::size_t n, int axes, const double* lo, const double* hi);
};

// The unit vector of a x b, or zero; for vectors whose product leaves the range of doubles.
void careful_normal(const double* a, const double* b, double* out);
// Gaussian and mean curvature from S_u, S_v, S_uu, S_uv, S_vv, for S_u x S_v that leaves the range of
// doubles; NaN where it is zero.
void careful_curvatures(const double (*jet)[3], double* out);

// Those that were compiled, the plain one first; whether this processor runs them.
struct Variant {
    const Kernels* kernels;
    bool runs_here;
};
int variants(Variant* out, int capacity);
// The best one that runs here, or the one that the environment variable FREIFORM_ISA names, if it runs here.
const Kernels& kernels();
// Others from now on: for tests. REQUIRES that they run here.
void choose(const Kernels& other);

extern const Kernels kBase;
#if defined(__x86_64__)
extern const Kernels kAvx2, kAvx512;
#endif

}  // namespace freiform::kernel
