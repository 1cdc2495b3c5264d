// Curves with another parameter.
//
// Idea: a joint that is G^k is C^k after a change of parameter of one curve whose first k derivatives at the
// joint are known; farther away it only has to rise. Three kinds of change keep the curve a spline.
//
// Notation: x = t - lo on the curve, 0 <= x <= L; tau the new parameter from 0 to M; a_j = phi^(j) / j!.
//
// Method: linear, knots divided by a_1. Linear over linear, x = a_1 tau / (1 - g tau) with g = a_2 / a_1: for
// the blossom F of a piece, G(tau_1, .., tau_p) = prod (1 - g tau_j) F(x(tau_1), .., x(tau_p)) is symmetric
// and affine in each tau_j, so the coefficient between the knots tau_(i+1) .. tau_(i+p) is the old one times
// prod (1 - g tau_(i+j)) = prod a_1 / (a_1 + g x_(i+j)), on the whole spline. It has its pole beyond L as
// long as a_1 + g L > 0. Polynomial phi = a_1 tau + .. + a_k tau^k: M is where phi = L; accepted if the
// Bernstein coefficients of phi over [0, M] increase, which makes phi rise and keeps it a convex combination.
// Otherwise e tau^(k+1) is added: for each M there is one e with phi(M) = L, and as M falls the linear term
// rules all others, so the coefficients increase in the end (M is halved until they do). The composition is
// de Casteljau's with the Bernstein polynomials 1 - phi / L and phi / L in place of 1 - t and t [DeRose
// 1988].
//
// Accuracy: convex combinations only; each coefficient has a relative error of about 4 p m roundings of the
// largest coefficient of its coordinate (p degree, m degree of phi). An estimate, not a bound. Cost: O(p^3
// m^2).
//
// Why not arc length as the parameter of both curves: no polynomial or rational curve but the line has it.
//
// References: [DeRose 1988], [PT97, 6.4], [Ramshaw 1989].
#include <freiform/query/continuity.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

Result<void> check(std::span<const double> phi, double from) {
    if (phi.size() < 2 || phi.size() > std::size_t(kMaxDegree) + 1)
        return refuse(
            RefusalKind::invalid, "phi",
            text("has ", phi.size(), " numbers, needs the value and 1..", kMaxDegree, " derivatives"));
    for (std::size_t i = 1; i < phi.size(); ++i)
        if (!std::isfinite(phi[i]))
            return refuse(RefusalKind::nonfinite, text("phi[", i, "]"), "is not finite");
    if (!(phi[1] > 0)) return refuse(RefusalKind::invalid, "phi[1]", text(phi[1], " is not positive"));
    if (!std::isfinite(from)) return refuse(RefusalKind::nonfinite, "from", "is not finite");
    return {};
}

// Bernstein coefficients over [0, m] of sum a[j] tau^j.
std::vector<double> bernstein(const std::vector<double>& a, double m) {
    const int n = int(a.size()) - 1;
    std::vector<double> b(a.size());
    for (int i = 0; i <= n; ++i) {
        double power = 1;
        for (int j = 0; j <= i; ++j, power *= m)
            b[std::size_t(i)] += binomial(i, j) / binomial(n, j) * a[std::size_t(j)] * power;
    }
    return b;
}
bool increases(const std::vector<double>& b) {
    return std::adjacent_find(b.begin(), b.end(), [](double x, double y) { return !(x < y); }) == b.end();
}

struct Rise {
    std::vector<double> coefficient;  // of phi over [0, end], from 0 to 1
    double end = 0;
};

double value(const std::vector<double>& a, double t) {
    double v = 0;
    for (std::size_t j = a.size(); j-- > 0;) v = v * t + a[j];
    return v;
}

// phi / L for the terms a (a[0] = 0, a[1] > 0).
std::optional<Rise> rising(std::vector<double> a, double length) {
    const auto normal = [&](double m) -> std::optional<Rise> {
        std::vector<double> b = bernstein(a, m);
        for (double& x : b) x /= length;
        b.front() = 0;
        b.back() = 1;
        return increases(b) ? std::optional(Rise{std::move(b), m}) : std::nullopt;
    };
    // The order that was asked for, if it gets there: phi(lo) < L <= phi(hi) by doubling, then bisection.
    const double start = length / a[1];
    double lo = 0, hi = start;
    for (int i = 0; i < 64 && value(a, hi) < length; ++i) lo = hi, hi *= 2;
    if (value(a, hi) >= length) {
        for (int i = 0; i < 200 && lo < hi; ++i) {
            const double middle = lo + (hi - lo) / 2;
            if (middle <= lo || middle >= hi) break;
            (value(a, middle) < length ? lo : hi) = middle;
        }
        if (auto found = normal(hi)) return found;
    }
    a.push_back(0);
    for (double m = start; m > 0; m /= 2) {
        a.back() = 0;
        double power = 1;
        for (std::size_t j = 1; j < a.size(); ++j) power *= m;
        if (!(power > 0)) break;
        a.back() = (length - value(a, m)) / power;
        if (auto found = normal(m)) return found;
    }
    return std::nullopt;
}

// The Bernstein coefficients of the times_curve of a polynomial and a curve.
template <class P>
std::vector<P> times_curve(const std::vector<double>& a, const std::vector<P>& b) {
    const int m = int(a.size()) - 1, n = int(b.size()) - 1;
    std::vector<P> c(std::size_t(m + n) + 1);
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j)
            c[std::size_t(i + j)] +=
                (binomial(m, i) * binomial(n, j) / binomial(m + n, i + j) * a[std::size_t(i)]) *
                b[std::size_t(j)];
    return c;
}

template <class P>
std::vector<P> composed(std::span<const P> coefficients, const std::vector<double>& phi) {
    std::vector<double> rest;
    for (const double x : phi) rest.push_back(1 - x);
    std::vector<std::vector<P>> b;
    for (const P& p : coefficients) b.push_back({p});
    while (b.size() > 1) {
        for (std::size_t i = 0; i + 1 < b.size(); ++i) {
            auto sum = times_curve(rest, b[i]);
            const auto part = times_curve(phi, b[i + 1]);
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
            b[i] = std::move(sum);
        }
        b.pop_back();
    }
    return std::move(b[0]);
}

template <class P>
Result<Curve<P>> with_knots(const Curve<P>& curve, std::vector<double> knots, std::vector<P> coefficients) {
    auto basis = curve.basis().same_kind(curve.basis().degree(), std::move(knots));
    if (!basis) return refuse_within("reparametrised", basis.error());
    const int n = int(coefficients.size());
    return Curve<P>::make({*std::move(basis)}, Net<1, P>({n}, std::move(coefficients)));
}

}  // namespace

template <class P>
Result<Curve<P>> reparametrised(const Curve<P>& curve, std::span<const double> phi, double from) {
    if (auto ok = check(phi, from); !ok) return std::unexpected(ok.error());
    const auto [lo, hi] = curve.basis().domain();
    const auto net = curve.net().flat();
    if (phi.size() == 2) {
        std::vector<double> knots;
        for (const double t : curve.basis().defining()) knots.push_back(from + (t - lo) / phi[1]);
        return with_knots(curve, std::move(knots), {net.begin(), net.end()});
    }
    if (curve.basis().is_closed() || curve.basis().breaks().size() != 2)
        return refuse(
            RefusalKind::unsupported, "curve",
            "has several pieces; with more than one derivative of phi only a single Bezier piece stays a "
            "spline (reparametrised_rationally takes two derivatives for any spline)");
    const auto piece = restrict_to(curve, 0, {lo, hi});
    if (!piece) return std::unexpected(piece.error());
    std::vector<double> a(phi.begin(), phi.end());
    a[0] = 0;
    double factorial = 1;
    for (std::size_t j = 2; j < a.size(); ++j) a[j] /= factorial *= double(j);
    const auto change = rising(std::move(a), hi - lo);
    if (!change)
        return refuse(RefusalKind::ill_conditioned, "phi",
                      "no rising polynomial with these derivatives was found");
    const int degree = curve.basis().degree() * int(change->coefficient.size() - 1);
    if (degree > kMaxDegree)
        return refuse(RefusalKind::unsupported, "phi",
                      text("the degree would be ", curve.basis().degree(), " x ",
                           change->coefficient.size() - 1, " = ", degree, ", above ", kMaxDegree));
    auto basis = BSplineBasis::bezier(degree, {from, from + change->end});
    if (!basis) return refuse_within("reparametrised", basis.error());
    return Curve<P>::make({*std::move(basis)},
                          Net<1, P>({degree + 1}, composed<P>(piece->net().flat(), change->coefficient)));
}

template <class P>
Result<Curve<Hom<Space<P>::kDim>>> reparametrised_rationally(const Curve<P>& curve, double rate,
                                                             double second, double from) {
    constexpr int D = Space<P>::kDim;
    if (auto ok = check(std::array{0.0, rate, second}, from); !ok) return std::unexpected(ok.error());
    const auto [lo, hi] = curve.basis().domain();
    const auto piece = restrict_to(curve, 0, {lo, hi});
    if (!piece) return std::unexpected(piece.error());
    const double g = second / 2 / rate;
    if (!(rate + g * (hi - lo) > 0))
        return refuse(RefusalKind::no_answer, "phi[2]",
                      text("with phi' = ", rate, " and phi'' = ", second,
                           " the fraction never reaches the end of "
                           "the curve, ",
                           hi - lo, " away"));
    const int p = piece->basis().degree();
    std::vector<double> knots, factor;
    for (const double t : piece->basis().knots()) {
        knots.push_back(from + (t - lo) / (rate + g * (t - lo)));
        factor.push_back(rate / (rate + g * (t - lo)));
    }
    std::vector<Hom<D>> net;
    for (std::size_t i = 0; i < piece->net().flat().size(); ++i) {
        double f = 1;
        for (std::size_t j = 1; j <= std::size_t(p); ++j) f *= factor[i + j];
        const P& q = piece->net().flat()[i];
        Hom<D> h;
        for (int c = 0; c < D; ++c) h[c] = f * q[c];
        h[D] = f * Space<P>::weight(q);
        net.push_back(h);
    }
    auto basis = BSplineBasis::make(p, std::move(knots));
    if (!basis) return refuse_within("reparametrised", basis.error());
    const int n = int(net.size());
    return Curve<Hom<D>>::make({*std::move(basis)}, Net<1, Hom<D>>({n}, std::move(net)));
}

#define FF_INSTANTIATE_REPARAMETRISED(P)                                                                   \
    template Result<Curve<P>> reparametrised(const Curve<P>&, std::span<const double>, double);            \
    template Result<Curve<Hom<Space<P>::kDim>>> reparametrised_rationally(const Curve<P>&, double, double, \
                                                                          double);
FF_INSTANTIATE_REPARAMETRISED(Vec<1>)
FF_INSTANTIATE_REPARAMETRISED(Vec<2>)
FF_INSTANTIATE_REPARAMETRISED(Vec<3>)
FF_INSTANTIATE_REPARAMETRISED(Vec<4>)
FF_INSTANTIATE_REPARAMETRISED(Hom<1>)
FF_INSTANTIATE_REPARAMETRISED(Hom<2>)
FF_INSTANTIATE_REPARAMETRISED(Hom<3>)
FF_INSTANTIATE_REPARAMETRISED(Hom<4>)
#undef FF_INSTANTIATE_REPARAMETRISED

}  // namespace freiform
