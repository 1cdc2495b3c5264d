// Control points of the next piece.
//
// Idea: the expansion of the previous curve at its end, P(t) = sum p_j t^j, determines that of the next one,
// N(u) = P(psi(u)) with psi the inverse of phi (C^k: psi(u) = u), up to order k; and the expansion of a
// Bezier curve determines its first k + 1 coefficients: with L the length of the interval, n the degree,
//     N_j L^j / C(n, j) = (difference of order j of the coefficients at 0),   b_i = sum_j C(i, j) (..)_j.
// Any degrees, intervals and orders; the formulas for cubics are n = 3, L = 1.
//
// Rational curves: numerator and weight are expansions like any other. The points join as well if the next
// numerator and weight are multiplied by one function; with given weights w_0 .. w_k that function is fixed
// by the expansion of the weight, and the numerator is (expansion of the points) x (expansion of the weight).
//
// Accuracy: everything in numbers of 106 bits, rounded to doubles at the end. So a determined coefficient is
// the exact one rounded once, as long as the cancellation in the formula leaves 53 of those bits, and the
// analysis of continuity, which grants a rounding to every coefficient, must find the joint. Cost: O(degree^2
// k + k^3).
//
// Why not a step-by-step construction (each order from the control points of the order before): roundings
// would pile up with powers of 2 per order, and neighbouring degrees would need formulas of their own.
//
// References: [Farin 2002, 5.5, 11.1], [Barsky & DeRose 1989], [Nielson 1974].
#include <freiform/core/double_double.hpp>
#include <freiform/make/joint.hpp>
#include <freiform/poly/series.hpp>

#include <cmath>

namespace freiform {

namespace {

using Terms = Series<DoubleDouble>;

// Terms of the homogeneous coordinates at the upper end of the curve, orders 0 .. k.
template <class P>
std::vector<Terms> end_expansion(const Curve<P>& curve, int k) {
    const BSplineBasis& basis = curve.basis();
    const double at = basis.domain().hi;
    const int p = basis.degree(), span = basis.span(at);
    std::vector<Terms> x(std::size_t(P::kCoords), Terms(std::size_t(k) + 1));
    std::vector<DoubleDouble> w(std::size_t(p) + 1);
    for (int j = 0; j <= std::min(k, p); ++j) {
        weights_in_span(basis, span, DoubleDouble(at), j, w.data());
        for (int i = 0; i <= p; ++i)
            for (int c = 0; c < P::kCoords; ++c)
                x[std::size_t(c)][std::size_t(j)] +=
                    w[std::size_t(i)] * DoubleDouble(curve.net().flat()[std::size_t(span - p + i)][c]);
    }
    for (Terms& t : x) t = series_of(std::span<const DoubleDouble>(t));
    return x;
}

// Is the derivative of the points 0? That of a quotient: A' w - A w'.
bool stands_still(const std::vector<Terms>& x, bool rational) {
    const std::size_t dimension = x.size() - (rational ? 1 : 0);
    for (std::size_t c = 0; c < dimension; ++c) {
        const DoubleDouble d = rational ? x[c][1] * x.back()[0] - x[c][0] * x.back()[1] : x[c][1];
        if (d.rounded() != 0) return false;
    }
    return true;
}

// The first coefficients of the Bezier form of degree n over an interval of length `length`.
Terms first_coefficients(const Terms& expansion, int n, DoubleDouble length) {
    Terms difference = expansion, b(expansion.size());
    DoubleDouble power(1);
    for (std::size_t j = 0; j < difference.size(); ++j, power *= length)
        difference[j] = difference[j] * power / DoubleDouble(binomial(n, int(j)));
    for (std::size_t i = 0; i < b.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j) b[i] += DoubleDouble(binomial(int(i), int(j))) * difference[j];
    return b;
}
// And back.
Terms expansion_of(const std::vector<double>& coefficients, int n, DoubleDouble length) {
    Terms b(coefficients.begin(), coefficients.end()), e;
    DoubleDouble power(1);
    for (std::size_t j = 0; j < coefficients.size(); ++j, power *= length) {
        e.push_back(b[0] * DoubleDouble(binomial(n, int(j))) / power);
        for (std::size_t i = 0; i + 1 < b.size(); ++i) b[i] = b[i + 1] - b[i];
    }
    return e;
}

template <class P>
Result<void> check(const Curve<P>& previous, std::span<const double> phi, const NextPiece<P>& next) {
    const std::size_t k = phi.size(), n = k + next.free.size();
    if (previous.basis().is_closed())
        return refuse(RefusalKind::no_answer, "previous",
                      "is closed and has no end where another could join");
    if (k > std::size_t(kMaxDegree) || n > std::size_t(kMaxDegree))
        return refuse(RefusalKind::unsupported, "free",
                      text("order ", k, " and ", next.free.size(), " free coefficients make degree ", n,
                           ", outside 0..", kMaxDegree));
    for (std::size_t i = 0; i < k; ++i)
        if (!std::isfinite(phi[i]))
            return refuse(RefusalKind::nonfinite, text("phi[", i, "]"), "is not finite");
    if (k > 0 && !(phi[0] > 0))
        return refuse(RefusalKind::invalid, "phi[0]",
                      text(phi[0], " is not positive: the next curve would turn back"));
    if (!next.weights.empty() && (!Space<P>::kRational || next.weights.size() != k + 1))
        return refuse(RefusalKind::invalid, "weights",
                      Space<P>::kRational ? text("has ", next.weights.size(), " numbers, order ", k,
                                                 " needs ", k + 1, " or none")
                                          : text("are given for a polynomial curve"));
    for (std::size_t i = 0; i < next.weights.size(); ++i)
        if (!(next.weights[i] > 0) || !std::isfinite(next.weights[i]))
            return refuse(RefusalKind::invalid, text("weights[", i, "]"),
                          text(next.weights[i], " is not a positive number"));
    return {};
}

template <class P>
Result<Curve<P>> joined(const Curve<P>& previous, std::span<const double> phi, const NextPiece<P>& next) {
    if (auto ok = check(previous, phi, next); !ok) return std::unexpected(ok.error());
    const int k = int(phi.size()), n = k + int(next.free.size());
    auto basis = BSplineBasis::bezier(n, next.on);
    if (!basis) return refuse_within("on", basis.error());
    const DoubleDouble length = DoubleDouble(next.on.hi) - DoubleDouble(next.on.lo);

    auto x = end_expansion(previous, k);
    Terms change(std::size_t(k) + 1);
    for (std::size_t j = 0; j < phi.size(); ++j) change[j + 1] = phi[j];
    const Terms psi = inverse(series_of(std::span<const DoubleDouble>(change)));
    for (Terms& t : x) t = compose(t, psi);
    if (!next.weights.empty()) {
        const Terms w = expansion_of(next.weights, n, length), old = x.back();
        for (Terms& t : x) t = multiply(divide(t, old), w);
    }
    std::vector<P> b(std::size_t(k) + 1);
    for (int c = 0; c < P::kCoords; ++c) {
        const Terms one = first_coefficients(x[std::size_t(c)], n, length);
        for (std::size_t i = 0; i < b.size(); ++i) b[i][c] = one[i].rounded();
    }
    for (std::size_t i = 0; i < b.size(); ++i) {
        if (!is_finite(b[i]))
            return refuse(RefusalKind::ill_conditioned, text("coefficients[", i, "]"),
                          "leaves the range of double");
        if (!(Space<P>::weight(b[i]) > 0))
            return refuse(RefusalKind::no_answer, text("weights[", i, "]"),
                          text("the homogeneous curve continues with the weight ", Space<P>::weight(b[i]),
                               ", which is not positive; give the first ", k + 1,
                               " weights or take a shorter interval"));
    }
    b.insert(b.end(), next.free.begin(), next.free.end());
    return Curve<P>::make({*std::move(basis)}, Net<1, P>({n + 1}, std::move(b)));
}

}  // namespace

std::vector<double> inverted(std::span<const double> derivatives) {
    FF_REQUIRE(derivatives.empty() || derivatives[0] != 0);
    Terms t{DoubleDouble(0)};
    for (const double d : derivatives) t.push_back(d);
    const auto back = derivatives_of(inverse(series_of(std::span<const DoubleDouble>(t))));
    std::vector<double> out;
    for (std::size_t j = 1; j < back.size(); ++j) out.push_back(back[j].rounded());
    return out;
}

template <class P>
Result<Curve<P>> next_c(const Curve<P>& previous, int order, const NextPiece<P>& next) {
    if (order < 0 || order > kMaxDegree)
        return refuse(RefusalKind::unsupported, "order", text(order, " is outside 0..", kMaxDegree));
    std::vector<double> phi(std::size_t(order), 0.0);
    if (order > 0) phi[0] = 1;
    return joined<P>(previous, phi, next);
}

template <class P>
Result<Curve<P>> next_g(const Curve<P>& previous, std::span<const double> phi, const NextPiece<P>& next) {
    if (!phi.empty() && !previous.basis().is_closed() &&
        stands_still(end_expansion(previous, 1), Space<P>::kRational))
        return refuse(
            RefusalKind::no_answer, "previous",
            "its derivative is 0 at its end; pieces that join there with C^k need not join with G^k");
    return joined<P>(previous, phi, next);
}

template <int D>
Result<Curve<Vec<D>>> next_hermite(const Curve<Vec<D>>& previous, double k, const Vec<D>& p7,
                                   const Vec<D>& r7, Interval on) {
    if (!(k > 0) || !std::isfinite(k))
        return refuse(RefusalKind::invalid, "k", text(k, " is not a positive number"));
    if (!is_finite(p7) || !is_finite(r7))
        return refuse(RefusalKind::nonfinite, is_finite(p7) ? "r7" : "p7", "is not finite");
    const double phi[] = {1 / k};
    return next_g(previous, phi, NextPiece<Vec<D>>{on, {p7 - (on.length() / 3) * r7, p7}});
}

#define FF_INSTANTIATE_JOINT(P)                                                  \
    template Result<Curve<P>> next_c(const Curve<P>&, int, const NextPiece<P>&); \
    template Result<Curve<P>> next_g(const Curve<P>&, std::span<const double>, const NextPiece<P>&);
#define FF_INSTANTIATE_JOINTS(D)                                                                            \
    FF_INSTANTIATE_JOINT(Vec<D>)                                                                            \
    FF_INSTANTIATE_JOINT(Hom<D>)                                                                            \
    template Result<Curve<Vec<D>>> next_hermite(const Curve<Vec<D>>&, double, const Vec<D>&, const Vec<D>&, \
                                                Interval);
FF_INSTANTIATE_JOINTS(1)
FF_INSTANTIATE_JOINTS(2)
FF_INSTANTIATE_JOINTS(3)
FF_INSTANTIATE_JOINTS(4)
#undef FF_INSTANTIATE_JOINT
#undef FF_INSTANTIATE_JOINTS

}  // namespace freiform
