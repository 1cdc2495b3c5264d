// Bicubic patches from geometry and two basis matrices.
//
// Idea: a basis function sum c_k t^k has the Bernstein coefficients b_j = sum_k C(j, k) / C(3, k) c_k. These
// of all four functions are a 4 x 4 matrix, and the tensor product of two of them carries the geometry to a
// Bezier net.
//
// Accuracy: all in numbers of 106 bits, rounded at the end; a sum of 16 terms loses less than 2^-94 of the
// sum of their sizes. Cost: 2 x 64 products.
//
// Why not one axis after the other with doubles: the net between would be rounded, and its rounding
// multiplied.
//
// Of any degree: convert_coefficients in basis/polynomial_basis.cpp.
//
// References: [Foley van Dam Feiner & Hughes 1990].
#include <freiform/core/double_double.hpp>
#include <freiform/make/named_surface.hpp>

namespace freiform {

namespace {

using DD = DoubleDouble;
using Weights = std::array<std::array<DD, 4>, 4>;

// [i][j]: Bernstein coefficient j of basis function i.
Weights to_bernstein(const Matrix4& m) {
    Weights b{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k <= j; ++k)  // the coefficient of t^k stands in column 3 - k
                b[i][j] += DD(m[i][3 - k]) * DD(binomial(int(j), int(k))) / DD(binomial(3, int(k)));
    return b;
}

}  // namespace

template <Coefficient P>
Result<Surface<P>> bicubic(const std::array<std::array<P, 4>, 4>& geometry, const Matrix4& along_u,
                           const Matrix4& along_v) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            if (!is_finite(geometry[i][j]))
                return refuse(RefusalKind::nonfinite, text("geometry[", i, "][", j, "]"),
                              "a coordinate is not finite");
    const Weights f = to_bernstein(along_u), g = to_bernstein(along_v);
    Net<2, P> net({4, 4});
    each_index(net.extent(), [&](const Index<2>& at) {
        const std::size_t r = std::size_t(at[0]), s = std::size_t(at[1]);
        for (int c = 0; c < P::kCoords; ++c) {
            DD sum(0);
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < 4; ++j) sum += f[i][r] * g[j][s] * DD(geometry[i][j][c]);
            net.view()(at)[c] = sum.rounded();
        }
    });
    auto basis = BSplineBasis::bezier(3);
    if (!basis) return std::unexpected(basis.error());
    return Surface<P>::make({*basis, *basis}, std::move(net));
}

template <Coefficient P>
std::array<P, 4> curve_of_curves(const std::array<std::array<P, 4>, 4>& geometry, const Matrix4& along_u,
                                 double u) {
    std::array<P, 4> out{};
    for (std::size_t j = 0; j < 4; ++j)
        for (int c = 0; c < P::kCoords; ++c) {
            DD sum(0);
            for (std::size_t i = 0; i < 4; ++i) {
                DD f(0);
                for (std::size_t k = 0; k < 4; ++k) f = f * DD(u) + DD(along_u[i][k]);
                sum += f * DD(geometry[i][j][c]);
            }
            out[j][c] = sum.rounded();
        }
    return out;
}

template <std::size_t N, Coefficient P>
Result<PolynomialPatch<N, P>> from_bases(const std::array<PolynomialBasis, N>& bases,
                                         const Net<N, P>& coefficients, const std::array<Interval, N>& on) {
    std::vector<PolynomialBasis> bernstein;
    std::vector<BSplineBasis> splines;
    for (std::size_t d = 0; d < N; ++d) {
        if (coefficients.extent()[d] != bases[d].size())
            return refuse(RefusalKind::invalid, "coefficients",
                          text(coefficients.extent()[d], " coefficients along axis ", d,
                               " for a basis of degree ", bases[d].degree()));
        auto b = PolynomialBasis::bernstein(bases[d].degree(), on[d]);
        if (!b) return refuse_within(text("on[", d, "]"), b.error());
        auto s = BSplineBasis::bezier(bases[d].degree(), on[d]);
        if (!s) return refuse_within(text("on[", d, "]"), s.error());
        bernstein.push_back(*std::move(b)), splines.push_back(*std::move(s));
    }
    const auto c = convert_coefficients(bases, bernstein, numbers(coefficients.flat()), P::kCoords);
    if (!c) return std::unexpected(c.error());
    Net<N, P> net(coefficients.extent());
    double bound = 0;
    const auto to = numbers(net.flat());
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] = c->values[i].value;
        bound = std::max(bound, c->values[i].bound);
    }
    auto patch = [&]<std::size_t... D>(std::index_sequence<D...>) {
        return Patch<N, P>::make({splines[D]...}, std::move(net));
    }
    (std::make_index_sequence<N>{});
    if (!patch) return std::unexpected(patch.error());
    return PolynomialPatch<N, P>{*std::move(patch), bound, c->condition};
}

#define FF_INSTANTIATE_FROM_BASES(P)                                                                     \
    template Result<PolynomialPatch<1, P>> from_bases(const std::array<PolynomialBasis, 1>&,             \
                                                      const Net<1, P>&, const std::array<Interval, 1>&); \
    template Result<PolynomialPatch<2, P>> from_bases(const std::array<PolynomialBasis, 2>&,             \
                                                      const Net<2, P>&, const std::array<Interval, 2>&); \
    template Result<PolynomialPatch<3, P>> from_bases(const std::array<PolynomialBasis, 3>&,             \
                                                      const Net<3, P>&, const std::array<Interval, 3>&);
#define FF_INSTANTIATE_FROM_BASES_OF(D) FF_INSTANTIATE_FROM_BASES(Vec<D>) FF_INSTANTIATE_FROM_BASES(Hom<D>)
FF_INSTANTIATE_FROM_BASES_OF(1)
FF_INSTANTIATE_FROM_BASES_OF(2)
FF_INSTANTIATE_FROM_BASES_OF(3)
FF_INSTANTIATE_FROM_BASES_OF(4)

#define FF_INSTANTIATE_BICUBIC(P)                                                               \
    template Result<Surface<P>> bicubic(const std::array<std::array<P, 4>, 4>&, const Matrix4&, \
                                        const Matrix4&);                                        \
    template std::array<P, 4> curve_of_curves(const std::array<std::array<P, 4>, 4>&, const Matrix4&, double);
FF_INSTANTIATE_BICUBIC(Vec<1>)
FF_INSTANTIATE_BICUBIC(Vec<2>)
FF_INSTANTIATE_BICUBIC(Vec<3>)
FF_INSTANTIATE_BICUBIC(Vec<4>)
FF_INSTANTIATE_BICUBIC(Hom<1>)
FF_INSTANTIATE_BICUBIC(Hom<2>)
FF_INSTANTIATE_BICUBIC(Hom<3>)
FF_INSTANTIATE_BICUBIC(Hom<4>)
#undef FF_INSTANTIATE_FROM_BASES
#undef FF_INSTANTIATE_FROM_BASES_OF
#undef FF_INSTANTIATE_BICUBIC

}  // namespace freiform
