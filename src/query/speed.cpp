#include "query/speed_detail.hpp"

namespace freiform::detail {

namespace {

// sum_k |a_k| r^k for k >= 1.
template <class V>
double tail(std::span<const V> a, double r) {
    double sum = 0;
    for (std::size_t k = a.size(); k-- > 1;) sum = (sum + norm(a[k])) * r;
    return sum;
}

// Taylor coefficients of a Bernstein form about its middle, in z = 2 y - 1: of the right half, where the
// power form begins.
template <class V, std::size_t N>
void taylor(const std::array<V, N>& b, int m, std::array<V, N>& out) {
    std::array<V, N> left = b;
    for (int r = 0; r <= m; ++r) {
        out[std::size_t(m - r)] = left[std::size_t(m)];
        for (int i = m; i > r; --i)
            left[std::size_t(i)] = 0.5 * left[std::size_t(i) - 1] + 0.5 * left[std::size_t(i)];
    }
    for (int k = 1; k <= m; ++k)
        for (int i = m; i >= k; --i) out[std::size_t(i)] -= out[std::size_t(i) - 1];
    for (int k = 1; k <= m; ++k) out[std::size_t(k)] *= binomial(m, k);
}

// sum_k C(m, k) 2^k (m + k + 3) r^k: what the roundings of `taylor` and a slip of the coefficients grow to
// on the disc |z| <= r, for coefficients of size 1 and one rounding.
double growth(int m, double r) {
    double sum = 0, term = 1;
    for (int k = 0; k <= m; ++k) {
        sum += term * (m + k + 3);
        term *= 2 * r * (m - k) / (k + 1);
    }
    return sum;
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
    const double g = 1.01 * chain.roundings() * kUnit;
    if (chain.polynomial()) {
        s.m = p - 1;
        for (int k = 0; k < p; ++k)
            s.h[std::size_t(k)] = double(p) * (project(b[std::size_t(k) + 1]) - project(b[std::size_t(k)]));
        // Where pieces are given exactly, a difference of them has one rounding.
        const bool exact = !Space<P>::kRational && chain.roundings() == 0;
        s.h_slip = 2.1 * kUnit * s.largest() + (exact ? 0 : 2.1 * p * chain.error(0));
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
        s.h_slip = std::max(s.h_slip, ((p + 10) * kUnit + 2 * g) * size + 1.01 * mass * off);
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
    const double n = b.m + 1, rounding = (b.m + 8) * kUnit;
    const double slip = b.h_slip + rounding * most / n;
    const double upper = (most / n + slip) * b.width / (w.lo * w.lo) * (1 + 8 * kUnit);
    const double lower = std::max(0.0, (norm(mean) / n - slip) * b.width / (w.hi * w.hi) * (1 - 8 * kUnit));
    return {(lower + upper) / 2, (upper - lower) / 2 + kUnit * upper};
}

template <int D>
Measure gauss_length(const SpeedBlock<D>& b, double wanted) {
    const Measure none{0, std::numeric_limits<double>::infinity()};
    const double largest = b.largest();
    if (!(largest > 0)) return none;
    std::array<Vec<D>, kMostHodograph + 1> h;
    std::array<Vec<1>, kMaxDegree + 1> w;
    std::array<Vec<1>, 2 * kMostHodograph + 1> q{};  // h . h
    taylor(b.h, b.m, h);
    for (int i = 0; i <= b.m; ++i)
        for (int j = 0; j <= b.m; ++j) q[std::size_t(i + j)][0] += dot(h[std::size_t(i)], h[std::size_t(j)]);
    if (b.p > 0) taylor(b.w, b.p, w);
    const double h0 = norm(h[0]), q0 = q[0][0], w0 = b.p > 0 ? w[0][0] : 1;
    const GaussRule* best = nullptr;
    double truncation = 0, variation = 0, radius = 0, lightest = 1;
    for (const double rho : kRadii) {
        const double r = (rho + 1 / rho) / 2;
        // The speed over the ellipse, less that in the middle.
        const double reach = h0 + tail(std::span<const Vec<D>>(h).first(std::size_t(b.m) + 1), r);
        const double slip = growth(b.m, r) * (b.h_slip + 1.01 * kUnit * largest);
        const double s = tail(std::span<const Vec<1>>(q).first(std::size_t(2 * b.m) + 1), r) +
                         (2 * reach + slip) * slip + (2 * b.m + D + 8) * kUnit * reach * reach;
        if (!(s < 0.999 * q0)) continue;
        double ws = 0;
        if (b.p > 0)
            ws = tail(std::span<const Vec<1>>(w).first(std::size_t(b.p) + 1), r) +
                 growth(b.p, r) * (b.w_slip + 1.01 * kUnit) * b.weights().hi;
        const double least = w0 - ws;
        if (!(least > 1e-3 * w0)) continue;
        const double varied =
            s / h0 / (least * least) + h0 * (ws * (2 * w0 + ws)) / (w0 * w0 * least * least);
        // Below what the slip alone contributes nothing is gained by asking for less.
        const double shrink = 64.0 / 30 * b.width / (1 - 1 / (rho * rho)) * (1 + 64 * kUnit);
        const double aim = std::max(wanted, 4 * shrink * std::pow(rho, -2 * kGaussRules.back().points) *
                                                slip * (2 * reach + slip) / h0);
        for (const GaussRule& rule : kGaussRules) {
            if (best && rule.points > best->points) break;
            const double error = shrink * varied * std::pow(rho, -2 * rule.points);
            if (!(error <= aim)) continue;
            if (best && rule.points == best->points && error >= truncation) break;
            best = &rule, truncation = error, variation = varied, radius = r, lightest = least;
            break;
        }
    }
    if (!best) return none;
    double sum = 0;
    for (const GaussNode& node : best->half)
        sum += node.weight * (b.speed(0.5 + 0.5 * node.at) + b.speed(0.5 - 0.5 * node.at));
    const double fastest = h0 / (w0 * w0) + variation;
    const double values = (b.h_slip + (3.03 * b.m + 5) * kUnit * largest) / (lightest * lightest);
    const double relative = 2 * b.w_slip + (6.06 * b.p + D + best->points + 20) * kUnit;
    return {b.width / 2 * sum,
            truncation + b.width * (values + relative * fastest + 3 * kUnit * variation / (radius - 1))};
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

}  // namespace freiform::detail
