// Evaluation in double-double arithmetic.
//
// Idea. The weights of the recurrence are sums of products of non-negative numbers, so they are accurate to
// the last digit of whatever arithmetic computes them; what cancels is only the last sum, weights times
// coefficients. With 106 bits for both, cancellation of up to 50 bits leaves a double that is right.
//
// Notation. u = 2^-53; p_d degrees; P_i coefficients, w_i weights, A = sum w_i |P_i|; v the double-double
// result.
//
// Method. The same recurrence as everywhere (blossom_step) and the same sum, with DoubleDouble in the place
// of double. The rounded result is v.hi, because |v.lo| is at most half a unit of it; v.lo itself is what
// rounding leaves out. Coefficients and, apart from them, weights are scaled by powers of two to at most 1
// (of what acts at the parameter).
//
// Accuracy. Relative errors of the operations: 3.1 u^2 of a sum, 7 u^2 of a product, 64 u^2 of a quotient,
// unless they underflow [Joldes Muller Popescu 2017, algorithms 6 and 10; core/double_double.hpp]. Knots and
// parameters are doubles, so their differences are exact. A step of the recurrence adds a quotient, a product
// and a sum, less than 75 u^2: 75 p u^2 for a weight. A term is one product more, and there are p further
// sums: with K = sum_d (80 p_d + 8)
//     |v - exact| <= n = K u^2 A (1 + 2^-40) + e.
// e pays for what underflows. All numbers are scaled: coefficients to at most 1, knots so that the span has
// length 1 to 2, which every divisor contains; so what is lost is at most 2^-960 each time, less than 2^20
// times, and e = 2^-900. Rational, numerator and denominator W off by n and d in this sense:
//     |v - exact| <= (n + |v| d) / (|W| - d) + 64 u^2 |v|, infinite if W cannot be told from 0.
// The bound is that plus |v.lo|: computed after the fact, for this value, not for the worst.
//
// Cost. Measured, 10 to 60 times that of evaluate.
//
// References: [Joldes Muller Popescu 2017].
//
// Why not compensated de Casteljau: half the operations, but a fixed form (Bernstein, one parameter), and its
// a posteriori bound is a second pass; here the one recurrence of the library serves all bases, rational and
// not.
#include "patch_detail.hpp"

#include <freiform/core/double_double.hpp>
#include <freiform/spline/accurate.hpp>

#include <cmath>
#include <limits>

namespace freiform {

namespace {

constexpr double kUnit = 0x1p-106;       // u^2
constexpr double kUnderflow = 0x1p-900;  // e
constexpr double kTooSmall = 0x1p-700;   // of a denominator
constexpr double kSlack = 1 + 0x1p-40;
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

// A sum of weights times coefficients and the sum of their sizes, coordinate by coordinate.
constexpr std::size_t kMostNumbers = 5;  // of a coefficient
struct Sum {
    std::array<DoubleDouble, kMostNumbers> value{};
    std::array<double, kMostNumbers> size{};
};

// The coefficients that act: along each axis first index, number, weights.
struct Block {
    Tuples net;
    std::size_t axes = 0;
    Index<3> extent{}, first{}, count{};
    DoubleDouble weight[3][kMaxDegree + 1];

    // The coefficient k[0], k[1] .. of the block.
    std::size_t place(const Index<3>& k) const {
        std::size_t at = 0;
        for (std::size_t d = 0; d < axes; ++d)  // closed bases wrap
            at = at * std::size_t(extent[d]) + std::size_t((first[d] + k[d]) % extent[d]);
        return at;
    }
};

// Coefficients are multiplied by 2^-point, of weights by 2^-weight: in two steps, as 2^-point may be out of
// range.
struct Scale {
    int point, weight, dim;
    std::array<double, 2> of_point{steps(point)}, of_weight{steps(weight)};

    static std::array<double, 2> steps(int e) {
        return {std::ldexp(1.0, -(e / 2)), std::ldexp(1.0, e / 2 - e)};
    }
    double operator()(const double* p, int c) const {
        const auto& f = c == dim ? of_weight : of_point;
        return p[c] * f[0] * f[1];
    }
};

// The weights are those of the knots themselves, but nothing underflows.
template <class B>
struct ScaledKnots {
    const B& basis;
    double scale;
    double knot(int i) const { return basis.knot(i) * scale; }
};
double scale_of(double length) { return std::ldexp(1.0, -std::clamp(std::ilogb(length), -1000, 1000)); }

Scale scale_of(const Block& block) {
    double point = 0, weight = 0;
    Index<3> count = block.count;
    for (std::size_t d = block.axes; d < 3; ++d) count[d] = 1;
    each_index(count, [&](const Index<3>& k) {
        const std::size_t at = block.place(k);
        for (int c = 0; c < block.net.dim(); ++c) point = std::max(point, std::abs(block.net[at][c]));
        weight = std::max(weight, std::abs(block.net.weight(at)));
    });
    const auto exponent = [](double x) { return x > 0 ? std::ilogb(x) + 1 : 0; };
    return {exponent(point), exponent(weight), block.net.dim()};
}

Sum sum_of(const Block& block, const Scale& scale, Index<3>& k, std::size_t d) {
    Sum sum;
    const auto size = std::size_t(block.net.size);
    for (k[d] = 0; k[d] < block.count[d]; ++k[d]) {
        const DoubleDouble& w = block.weight[d][k[d]];
        if (d + 1 == block.axes) {
            const double* p = block.net[block.place(k)];
            for (std::size_t c = 0; c < size; ++c) {
                const double x = scale(p, int(c));
                sum.value[c] = sum.value[c] + w * x;
                sum.size[c] += w.hi * std::abs(x);
            }
        } else {
            const Sum inner = sum_of(block, scale, k, d + 1);
            for (std::size_t c = 0; c < size; ++c) {
                sum.value[c] = sum.value[c] + w * inner.value[c];
                sum.size[c] += w.hi * inner.size[c];
            }
        }
    }
    return sum;
}

// v 2^e as a double, with `rest` 2^e and what rounding adds.
void give(const DoubleDouble& v, double rest, int e, double& value, double& bound) {
    value = std::ldexp(v.hi, e);
    bound = std::ldexp(kSlack * (std::abs(v.lo) + rest), e);
    if (std::abs(value) < std::numeric_limits<double>::min() || bound < std::numeric_limits<double>::min())
        bound += 2 * kDenormal;
    if (!std::isfinite(value) || !std::isfinite(bound)) bound = std::numeric_limits<double>::infinity();
}

// The weights of the basis at u become those of the axis d. Returns their roundings.
template <class B>
double set_weights(Block& block, std::size_t d, const B& basis, double u) {
    const double x = basis.wrap(u);
    const int span = basis.span(x), p = basis.degree();
    block.weight[d][0] = 1.0;
    const ScaledKnots<B> knots{basis, scale_of(basis.knot(span + 1) - basis.knot(span))};
    for (int k = 1; k <= p; ++k) blossom_step(knots, span, k, DoubleDouble(x * knots.scale), block.weight[d]);
    block.extent[d] = basis.size();
    block.first[d] = (span - p) % basis.size();
    block.count[d] = p + 1;
    return 80 * p + 8;
}

// Coordinates of the value of a block; `steps` roundings a weight.
Accurate<Vec<4>> accurate_value(const Block& block, double steps) {
    const Scale scale = scale_of(block);
    Index<3> k{};
    const Sum sum = sum_of(block, scale, k, 0);
    const double unit = steps * kUnit;
    const int dim = block.net.dim();
    Accurate<Vec<4>> out;
    for (int c = 0; c < dim; ++c) {
        const DoubleDouble& s = sum.value[std::size_t(c)];
        const double size = sum.size[std::size_t(c)];
        if (block.net.rational) {
            const DoubleDouble& w = sum.value[std::size_t(dim)];
            const DoubleDouble v = s / w;
            const double off = unit * sum.size[std::size_t(dim)] + kUnderflow;  // of w
            const double least = std::abs(w.hi) - kSlack * off, most = std::abs(v.hi);
            const double rest = least > kTooSmall
                                    ? (unit * size + kUnderflow + most * off) / least + 64 * kUnit * most
                                    : std::numeric_limits<double>::infinity();
            give(v, rest, scale.point - scale.weight, out.value[c], out.bound[c]);
        } else {
            give(s, unit * size + kUnderflow, scale.point, out.value[c], out.bound[c]);
        }
    }
    return out;
}

}  // namespace

template <std::size_t N, Coefficient P, Basis B>
Result<void> evaluate_accurate(const Patch<N, P, B>& patch, std::span<const Param<N>> at,
                               std::span<Accurate<PointOf<P>>> out) {
    FF_REQUIRE(at.size() == out.size());
    Block block;
    block.net = tuples(patch.net().flat());
    block.axes = N;
    for (std::size_t i = 0; i < at.size(); ++i) {
        double steps = 0;
        for (std::size_t d = 0; d < N; ++d) {
            const double x = component<N>(at[i], d);
            const Interval on = patch.basis(int(d)).domain();
            if (!std::isfinite(x) || !(detail::is_closed(patch.basis(int(d))) || on.contains(x)))
                return detail::bad_parameter(x, on, "at", i, N == 1 ? -1 : std::ptrdiff_t(d));
            steps += set_weights(block, d, patch.basis(int(d)), x);
        }
        const Accurate<Vec<4>> found = accurate_value(block, steps);
        for (int c = 0; c < Space<P>::kDim; ++c)
            out[i].value[c] = found.value[c], out[i].bound[c] = found.bound[c];
    }
    return {};
}

#define FF_ACCURATE(N, P, B)                                                                  \
    template Result<void> evaluate_accurate(const Patch<N, P, B>&, std::span<const Param<N>>, \
                                            std::span<Accurate<PointOf<P>>>);
#define FF_ACCURATE_BASES(N, P) FF_ACCURATE(N, P, BSplineBasis) FF_ACCURATE(N, P, Bernstein)
#define FF_ACCURATE_COEFFICIENTS(N, D) FF_ACCURATE_BASES(N, Vec<D>) FF_ACCURATE_BASES(N, Hom<D>)
#define FF_ACCURATE_DIMENSIONS(N)  \
    FF_ACCURATE_COEFFICIENTS(N, 1) \
    FF_ACCURATE_COEFFICIENTS(N, 2) FF_ACCURATE_COEFFICIENTS(N, 3) FF_ACCURATE_COEFFICIENTS(N, 4)
FF_ACCURATE_DIMENSIONS(1)
FF_ACCURATE_DIMENSIONS(2)
FF_ACCURATE_DIMENSIONS(3)
#undef FF_ACCURATE
#undef FF_ACCURATE_BASES
#undef FF_ACCURATE_COEFFICIENTS
#undef FF_ACCURATE_DIMENSIONS

}  // namespace freiform
