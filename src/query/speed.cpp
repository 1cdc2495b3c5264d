#include "query/speed_detail.hpp"

#include <freiform/core/constants.hpp>

#include <numbers>

namespace freiform::detail {

namespace {

// cos(pi i / (2 n)) for i = 0 .. 4 n - 1, for every n that is needed: T_k at the Chebyshev nodes.
constexpr int kMostNodes = 2 * kMostHodograph + 1;
const std::vector<double>& cosines(int n) {
    static const auto tables = [] {
        std::vector<std::vector<double>> all(kMostNodes + 1);
        for (int k = 1; k <= kMostNodes; ++k)
            for (int i = 0; i < 4 * k; ++i)
                all[std::size_t(k)].push_back(std::cos(std::numbers::pi * i / (2 * k)));
        return all;
    }();
    return tables[std::size_t(n)];
}

// The Chebyshev coefficients of a polynomial of degree m < n with these values at the nodes
// cos(pi (2 j + 1) / (2 n)).
void chebyshev(std::span<const double> value, int m, std::span<double> a) {
    const int n = int(value.size());
    const std::vector<double>& c = cosines(n);
    for (int k = 0; k <= m; ++k) {
        double sum = 0;
        for (int j = 0, at = k; j < n; ++j) {  // at: k (2 j + 1) modulo 4 n
            sum += value[std::size_t(j)] * c[std::size_t(at)];
            at += 2 * k;
            at -= at >= 4 * n ? 4 * n : 0;
        }
        a[std::size_t(k)] = (k == 0 ? 1.0 : 2.0) / n * sum;
    }
}

// Bound of |f - a_0| over the ellipse for a polynomial whose coefficients are off by at most `slip`:
// |T_k| <= (rho^k + rho^-k) / 2 there.
double variation_on(std::span<const double> a, double rho, double slip) {
    double sum = 0, up = 1, down = 1;
    for (std::size_t k = 1; k < a.size(); ++k) {
        up *= rho, down /= rho;
        sum += (std::abs(a[k]) + slip) * (up + down) / 2;
    }
    return sum * (1 + 128 * kUnitRoundoff) + slip;
}

constexpr double kRadii[] = {16, 8, 5, 3.5, 2.6, 2, 1.6};

}  // namespace

template <class P>
SpeedBlock<Space<P>::kDim> speed_of(const Chain<P>& chain, int i) {
    constexpr int D = Space<P>::kDim;
    const auto b = chain.piece(i);
    const int p = chain.degree();
    SpeedBlock<D> s;
    if (p == 0) return s;  // all zero
    const double g = 1.01 * chain.roundings() * kUnitRoundoff;
    if (chain.polynomial()) {
        s.m = p - 1;
        for (int k = 0; k < p; ++k)
            s.h[std::size_t(k)] = double(p) * (project(b[std::size_t(k) + 1]) - project(b[std::size_t(k)]));
        // Where pieces are given exactly, a difference of them has one rounding.
        const bool exact = !Space<P>::kRational && chain.roundings() == 0;
        s.h_slip = 2.1 * kUnitRoundoff * s.largest() + (exact ? 0 : 2.1 * p * chain.error(0));
        return s;
    }
    s.m = 2 * p - 2;
    s.p = p;
    s.w_slip = g;
    for (int k = 0; k <= p; ++k) s.w[std::size_t(k)][0] = Space<P>::weight(b[std::size_t(k)]);
    const double off = 2 * chain.error(0);
    for (int k = 0; k <= s.m; ++k) {
        double size = 0, mass = 0;
        for (int lo = std::max(0, k + 1 - p), hi = k + 1 - lo; lo < hi; ++lo, --hi) {
            const double factor = (hi - lo) * (binomial(p, lo) * binomial(p, hi)) / binomial(s.m, k) *
                                  (s.w[std::size_t(lo)][0] * s.w[std::size_t(hi)][0]);
            const Vec<D> leg = factor * (project(b[std::size_t(hi)]) - project(b[std::size_t(lo)]));
            s.h[std::size_t(k)] += leg;
            size += norm(leg);
            mass += factor;
        }
        s.h_slip = std::max(s.h_slip, ((p + 10) * kUnitRoundoff + 2 * g) * size + 1.01 * mass * off);
    }
    return s;
}

template <int D>
Measure crude_length(const SpeedBlock<D>& b) {
    Vec<D> mean{};
    double most = 0;
    for (int i = 0; i <= b.m; ++i) {
        mean += b.h[std::size_t(i)];
        most += norm(b.h[std::size_t(i)]);
    }
    const Interval w = b.weights();
    const double n = b.m + 1, rounding = (b.m + 8) * kUnitRoundoff;
    const double slip = b.h_slip + rounding * most / n;
    const double upper = (most / n + slip) * b.width / (w.lo * w.lo) * (1 + 8 * kUnitRoundoff);
    const double lower =
        std::max(0.0, (norm(mean) / n - slip) * b.width / (w.hi * w.hi) * (1 - 8 * kUnitRoundoff));
    return {(lower + upper) / 2, (upper - lower) / 2 + kUnitRoundoff * upper};
}

template <int D>
Measure gauss_length(const SpeedBlock<D>& b, double wanted) {
    const Measure none{0, std::numeric_limits<double>::infinity()};
    const double largest = b.largest();
    if (!(largest > 0)) return none;
    // q = H . H, of degree 2 m, and W through their values at Chebyshev nodes.
    double value[kMostNodes], q[kMostNodes], w[kMaxDegree + 1];
    const int n = 2 * b.m + 1;
    for (int j = 0; j < n; ++j) {
        const Vec<D> v = b.hodograph(0.5 + 0.5 * cosines(n)[std::size_t(2 * j + 1)]);
        value[j] = dot(v, v);
    }
    chebyshev({value, std::size_t(n)}, 2 * b.m, {q, std::size_t(n)});
    // A value of H is off by its slip, the roundings of the scheme, and 8 u of its node times |H'| <= m
    // max|H|.
    const double h_off = b.h_slip + (3.03 * b.m + 6 + 8 * b.m) * kUnitRoundoff * largest;
    const double q_slip = 2 * ((2 * largest + h_off) * h_off + (D + 4) * kUnitRoundoff * largest * largest) +
                          2 * (n + 8) * kUnitRoundoff * largest * largest;
    double w_slip = 0;
    w[0] = 1;
    if (b.p > 0) {
        for (int j = 0; j <= b.p; ++j)
            value[j] = b.weight(0.5 + 0.5 * cosines(b.p + 1)[std::size_t(2 * j + 1)]);
        chebyshev({value, std::size_t(b.p) + 1}, b.p, {w, std::size_t(b.p) + 1});
        w_slip = 2 * (b.w_slip + (12 * b.p + 24) * kUnitRoundoff) * b.weights().hi;
    }
    const double q0 = q[0], w0 = w[0];
    if (!(q0 > q_slip && w0 > w_slip)) return none;
    const double h0 = std::sqrt(q0);
    const GaussRule* best = nullptr;
    double truncation = 0, variation = 0, radius = 0, lightest = 1;
    for (const double rho : kRadii) {
        const double s = variation_on({q, std::size_t(n)}, rho, q_slip);
        const double t = b.p > 0 ? variation_on({w, std::size_t(b.p) + 1}, rho, w_slip) : 0;
        const double least = w0 - t;
        if (!(s < 0.999 * q0) || !(least > 1e-3 * w0)) continue;
        const auto varied = [&](double by) {
            return by / h0 / (least * least) + h0 * (t * (2 * w0 + t)) / (w0 * w0 * least * least);
        };
        // Below what the slip alone contributes nothing is gained by asking for less.
        const double noise = q_slip * 2 * std::pow(rho, 2 * b.m + 1) / (rho - 1) / h0 / (least * least);
        const double shrink = 64.0 / 30 * b.width / (1 - 1 / (rho * rho)) * (1 + 64 * kUnitRoundoff);
        const double aim =
            std::max(wanted, 4 * shrink * noise * std::pow(rho, -2 * kGaussRules.back().points));
        for (const GaussRule& rule : kGaussRules) {
            if (best && rule.points > best->points) break;
            const double error = shrink * varied(s) * std::pow(rho, -2 * rule.points);
            if (!(error <= aim)) continue;
            if (best && rule.points == best->points && error >= truncation) break;
            best = &rule, truncation = error, variation = varied(s);
            radius = (rho + 1 / rho) / 2, lightest = least;
            break;
        }
    }
    if (!best) return none;
    double sum = 0;
    for (const GaussNode& node : best->half)
        sum += node.weight * (b.speed(0.5 + 0.5 * node.at) + b.speed(0.5 - 0.5 * node.at));
    const double fastest = h0 / (w0 * w0) + variation;
    const double values = (b.h_slip + (3.03 * b.m + 5) * kUnitRoundoff * largest) / (lightest * lightest);
    const double relative = 2 * b.w_slip + (6.06 * b.p + D + best->points + 20) * kUnitRoundoff;
    return {b.width / 2 * sum, truncation + b.width * (values + relative * fastest +
                                                       3 * kUnitRoundoff * variation / (radius - 1))};
}

#define FF_INSTANTIATE(D)                                       \
    template SpeedBlock<D> speed_of(const Chain<Vec<D>>&, int); \
    template SpeedBlock<D> speed_of(const Chain<Hom<D>>&, int); \
    template Measure crude_length(const SpeedBlock<D>&);        \
    template Measure gauss_length(const SpeedBlock<D>&, double);
FF_INSTANTIATE(1)
FF_INSTANTIATE(2)
FF_INSTANTIATE(3)
FF_INSTANTIATE(4)
#undef FF_INSTANTIATE

}  // namespace freiform::detail
