// Bezier blocks, for bounds of derivatives: restriction to a part, and how large differences are. Plain
// arrays in, plain arrays out, compiled once for every instruction set; products and sums are not contracted,
// so that all sets give the same numbers.
#pragma once
#include <cstddef>

namespace freiform::kernel {

inline constexpr int kBlockOrder = 3;       // of differences
inline constexpr int kBlockDirections = 2;  // along which coordinates are looked at at once
inline constexpr int kBlockPlanes = 5;      // numbers of a coefficient: four coordinates and a weight

inline constexpr int kRestDifferences = 5;  // from row to row, column to column, and both twice

inline constexpr int lanes_of(int numbers) { return (numbers + 3) / 4 * 4; }

// Coefficients of a block, numbers of one kind in a plane: `rows` rows of `lanes` numbers, a multiple of 4,
// which are 0 after the columns. Curves have one row. The weights, if there are any, are the last plane.
struct BlockShape {
    int rows = 1, columns = 1, dim = 3;
    bool rational = false;

    int planes() const { return dim + int(rational); }
    int lanes() const { return lanes_of(columns); }
    std::size_t plane() const { return std::size_t(rows) * std::size_t(lanes()); }
};

struct BlockTask {
    BlockShape shape;
    const double* numbers = nullptr;
    double* room = nullptr;  // for twice as many
    double centre[4] = {};
    int top = 2;  // total order
    int directions = 0;
    double direction[kBlockDirections][4] = {};
    // The Bernstein polynomials of degree n at 1/2 begin at `at_half` + n * `half_stride`, with zeros after
    // them; for rational blocks.
    const double* at_half = nullptr;
    std::size_t half_stride = 0;
    bool ruled = false;  // weights are the same in all columns
};

// x: numerators about the centre. For differences of order i from row to row and j from column to column,
// `of[i][j]`: the largest of x . x, of |weight|, of |direction . x|, and if i + j < top the values in the
// middle of the block, coordinates first. Where it is ruled and j > 0 the same of y = x - c_j times the
// difference of weights, c_j the quotient of the difference (0, j) in the middle and its weight; for i = 0
// divided by weights.
struct BlockFound {
    double least_weight, most_weight;
    double largest[4];                // |coordinate|, not about the centre
    double farthest, square;          // x . x, and with x divided by its weight
    double across[kBlockDirections];  // |direction . x| / weight
    struct Difference {
        double most[2 + kBlockDirections];
        double ruled[1 + kBlockDirections + 1];
        double middle[kBlockPlanes + 3];
    } of[kBlockOrder + 1][kBlockOrder + 1];
};

// A block (A, w) of a surface S beside a function M, bilinear in `corner` and with x (1 - x) bulge[0] + y (1
// - y) bulge[1] more: A - w M, which has two degrees more than A if there are weights. For those share[0][3 I
// + k], k < 3, and share[1][l * stride + j] are what a factor of degree 2 has in coefficients I and j + l of
// a product. `linear` and `bulges`: coefficients j of y and y (1 - y). All with zeros after the columns.
// Bulges are 0 along axes of degree 1 where there are no weights.
struct RestTask {
    BlockShape shape;  // of three coordinates
    const double* numbers = nullptr;
    double corner[4][3], bulge[2][3];
    const double* share[2] = {};
    std::ptrdiff_t stride = 0;
    const double *linear = nullptr, *bulges = nullptr;
    double direction[3];
};
struct RestFound {
    double square, across;  // of x . x and |direction . x|, x a coefficient of S - M
    double largest;         // |coordinate| of A
    double least_weight, most_weight;
    // Of differences of A - w M: x . x, |direction . x|, |weight|; of those that are taken once the last
    // alone.
    double of[kRestDifferences][4];
};

// Sums of w[0][a][i] w[1][b][j] * coefficient (i, j) of 4 numbers each, for all a + b <= order, in graded
// order. Indices wrap at the extents. REQUIRES order <= 3.
struct Contraction {
    const double* net = nullptr;
    std::ptrdiff_t stride[2] = {};  // in numbers
    int first[2] = {}, count[2] = {}, extent[2] = {};
    const double* weights[2] = {};  // those of the next order are `weight_stride` further on
    std::ptrdiff_t weight_stride = 0;
    int order = 0;
};

// Coefficients (i, j) of 4 numbers each, i < rows, j < columns, at from + i * row_step + j * column_step.
struct Quadruples {
    const double* from = nullptr;
    std::ptrdiff_t row_step = 0, column_step = 0;
    int rows = 1, columns = 1;
};

struct BlockKernels {
    // A Bezier curve of `count` coefficients of `lanes` numbers each becomes its part on [0, hi], and of this
    // the part on [lo, 1]. 1 and 0: not at all.
    void (*restrict)(double* coefficients, int count, int lanes, double hi, double lo);
    // The same for each column of quadruples, to rows one after the other without gaps.
    void (*restrict_quadruples)(const Quadruples&, double* to, double hi, double lo);
    // To four planes of `rows` rows of lanes_of(columns) numbers.
    void (*arrange_quadruples)(const Quadruples&, double* to);
    void (*differences)(const BlockTask&, BlockFound&);
    void (*contract)(const Contraction&, double* out);
    void (*rest)(const RestTask&, RestFound&);
};

// Those that go with kernels() (evaluate.hpp).
const BlockKernels& block_kernels();

extern const BlockKernels kBaseBlocks;
#if defined(__x86_64__)
extern const BlockKernels kAvx2Blocks;
extern const BlockKernels kAvx512Blocks;
#endif

}  // namespace freiform::kernel
