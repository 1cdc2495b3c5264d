// Graphs of polynomials in Bezier form.
//
// Idea: x itself is a polynomial, so x -> (x, f(x)) is one. Coefficient j of degree n on [l, h] is the
// blossom at n - j times l and j times h. The blossom of x^k is the mean of all products of k of the n
// arguments,
//     sum_i C(j, i) C(n - j, k - i) h^i l^(k - i) / C(n, k).
//
// Accuracy: calculated with bounds (bounded.hpp); by partition of unity the largest one of a coefficient is
// one of the function. Binomials up to degree 25 are exact.
#include <freiform/core/bounded.hpp>
#include <freiform/make/graph.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

Result<Graph> graph(std::span<const double> a, Interval on) {
    if (a.empty()) return refuse(RefusalKind::invalid, "coefficients", "there are none");
    if (a.size() > std::size_t(kMaxDegree) + 1)
        return refuse(RefusalKind::unsupported, "coefficients",
                      text("degree ", a.size() - 1, " is above ", kMaxDegree));
    for (std::size_t k = 0; k < a.size(); ++k)
        if (!std::isfinite(a[k]))
            return refuse(RefusalKind::nonfinite, text("coefficients[", k, "]"),
                          text(a[k], " is not a finite number"));
    const int n = std::max(1, int(a.size()) - 1);  // a constant is a line, too
    auto basis = BSplineBasis::bezier(n, on);
    if (!basis) return std::unexpected(basis.error());
    std::vector<Bounded> low{1}, high{1};
    for (int k = 1; k <= n; ++k) {
        low.push_back(low.back() * Bounded(on.lo));
        high.push_back(high.back() * Bounded(on.hi));
    }
    std::vector<Vec<2>> net;
    double bound = 0;
    for (int j = 0; j <= n; ++j) {
        Bounded y = a[0];
        for (int k = 1; k < int(a.size()); ++k) {
            Bounded sum;
            for (int i = std::max(0, k - (n - j)); i <= std::min(j, k); ++i)
                sum = sum + Bounded(binomial(j, i) * binomial(n - j, k - i)) * high[std::size_t(i)] *
                                low[std::size_t(k - i)];
            if (a[std::size_t(k)] != 0) y = y + Bounded(a[std::size_t(k)]) * (sum / Bounded(binomial(n, k)));
        }
        const Bounded x = (Bounded(n - j) * Bounded(on.lo) + Bounded(j) * Bounded(on.hi)) / Bounded(n);
        const bool end = j == 0 || j == n;
        net.push_back({{j == 0 ? on.lo : j == n ? on.hi : x.value, y.value}});
        bound = std::max(bound, norm(Vec<2>{{end ? 0 : x.bound, y.bound}}));
    }
    if (!std::isfinite(bound))
        return refuse(RefusalKind::ill_conditioned, "coefficients", "powers of x leave the range of double");
    auto curve = Curve<Vec<2>>::make({std::move(*basis)}, Net<1, Vec<2>>({n + 1}, std::move(net)));
    if (!curve) return std::unexpected(curve.error());
    return Graph{std::move(*curve), bound * (1 + 4 * 0x1p-53)};
}

}  // namespace freiform
