// Polynomials in power form, Horner's scheme, and forward differences: points at equal parameter steps by
// additions alone.
#pragma once
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace freiform {

// a_0 .. a_p of f(t) = sum a_k t^k from Bezier coefficients on [0, 1]: a_k = C(p, k) times the k-th
// difference at b_0.
template <Coefficient P>
std::vector<P> power_form(std::span<const P> bezier) {
    std::vector<P> a(bezier.begin(), bezier.end());
    const int p = int(a.size()) - 1;
    for (int k = 1; k <= p; ++k)
        for (int i = p; i >= k; --i) a[std::size_t(i)] -= a[std::size_t(i) - 1];
    for (int k = 0; k <= p; ++k) a[std::size_t(k)] *= binomial(p, k);
    return a;
}

// ((a_p t + ..) t + a_1) t + a_0.
template <Coefficient P>
P horner(std::span<const P> a, double t) {
    P sum{};
    for (std::size_t k = a.size(); k-- > 0;) sum = t * sum + a[k];
    return sum;
}

// f(0), f(1/n), f(2/n), ..: value() is the current one, advance() goes to the next with p additions per
// coordinate, p the degree.
//
// The differences at 0 come from the power form: with h = 1/n,
//     D_k = sum_m a_m h^m k! S(m, k),        S(m, k) the Stirling numbers of the second kind,
// which for a cubic a t^3 + b t^2 + c t + d is (d; a h^3 + b h^2 + c h; 6 a h^3 + 2 b h^2; 6 a h^3).
//
// Drift. An error e_k of D_k at the start has grown to C(j, k) e_k in the value after j steps. A step rounds
// the k-th difference by at most u |D_k|, and that grows likewise, so in all by C(j, k + 1) u max |D_k|.
// The magnitudes are at most G_k = sum_{l >= k} C(n, l - k) |D_l|, up to rounding. With e_k from the
// roundings of the sum above and of the power form (each coefficient is a sum of 2^k terms, k + 2 roundings),
//     drift = sum_k C(n, k) e_k + C(n, k + 1) u G_k
// bounds the error of every value up to the n-th in every coordinate. References: [Foley van Dam Feiner
// Hughes 1990, 11.2] for the scheme; the count is ours, in the manner of [Higham 2002, ch. 3].
template <Coefficient P>
class ForwardDifferences {
public:
    // REQUIRES 1 <= steps, 1 <= bezier.size() <= 61.
    ForwardDifferences(std::span<const P> bezier, int steps)
        : d_(bezier.size()), drift_(bound(bezier, steps)) {}

    const P& value() const { return d_[0]; }
    std::span<const P> differences() const { return d_; }
    void advance() {
        for (std::size_t k = 0; k + 1 < d_.size(); ++k) d_[k] += d_[k + 1];
    }
    // Of every coordinate of every value up to the last step: computed less exact. May be infinite.
    const P& drift() const { return drift_; }

private:
    P bound(std::span<const P> bezier, int steps) {
        constexpr double u = std::numeric_limits<double>::epsilon() / 2;
        const int p = int(bezier.size()) - 1;
        const double h = 1.0 / steps;
        const std::vector<P> a = power_form(bezier);
        std::vector<P> off(a.size());  // of D_k
        P largest{};
        for (const P& b : bezier)
            for (int c = 0; c < P::kCoords; ++c) largest[c] = std::max(largest[c], std::abs(b[c]));
        std::vector<double> stirling(std::size_t(p) + 1);  // k! S(m, k) for the current m
        stirling[0] = 1;
        double power = 1;  // h^m
        for (int m = 0; m <= p; ++m) {
            if (m > 0) {
                for (int k = m; k > 0; --k)  // k! S(m, k) = k (k! S(m - 1, k) + (k - 1)! S(m - 1, k - 1))
                    stirling[std::size_t(k)] = k * (stirling[std::size_t(k)] + stirling[std::size_t(k) - 1]);
                stirling[0] = 0;
                power *= h;
            }
            // a_m itself is a sum of 2^m terms of at most C(p, m) |b|.
            const double terms = binomial(p, m) * std::ldexp(1.0, m) * (m + 2);
            for (int k = 0; k <= m; ++k) {
                const double factor = power * stirling[std::size_t(k)];
                for (int c = 0; c < P::kCoords; ++c) {
                    d_[std::size_t(k)][c] += factor * a[std::size_t(m)][c];
                    // h^m: 2 m roundings; Stirling numbers: 2 m; products 2; sum p.
                    off[std::size_t(k)][c] +=
                        factor * u *
                        ((m == 0 ? 0 : terms) * largest[c] +
                         (m == 0 && k == 0 ? p : 4 * m + p + 2) * std::abs(a[std::size_t(m)][c]));
                }
            }
        }
        P sum{};
        for (int k = 0; k <= p; ++k) {
            P g{};
            for (int l = k; l <= p; ++l)
                for (int c = 0; c < P::kCoords; ++c)
                    g[c] +=
                        binomial(steps, l - k) * (std::abs(d_[std::size_t(l)][c]) + off[std::size_t(l)][c]);
            for (int c = 0; c < P::kCoords; ++c) {
                sum[c] += binomial(steps, k) * off[std::size_t(k)][c];
                if (k < p) sum[c] += binomial(steps, k + 1) * u * g[c];
            }
        }
        // 1.01 covers the products of roundings, and those of this sum, as long as steps < 10^13.
        return 1.01 * sum;
    }

    std::vector<P> d_;
    P drift_;
};

}  // namespace freiform
