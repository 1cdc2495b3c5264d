// Seeded generators of bases, patches and parameters. The same seed gives the same objects with every
// compiler and standard library: nothing here goes through std::uniform_*_distribution.
#pragma once
#include <freiform/spline/patch.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace freiform::test {

// The value of a result that a test relies on; ends the test program, with the refusal, where there is none.
template <class T>
T must(Result<T> r) {
    if (!r) {
        std::fprintf(stderr, "refused: %s: %s\n", r.error().where.c_str(), r.error().message.c_str());
        std::abort();
    }
    return std::move(*r);
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double real(double lo, double hi) { return lo + (hi - lo) * (double(engine_() >> 11) * 0x1p-53); }
    int integer(int lo, int hi) {
        const auto count = std::uint64_t(std::int64_t(hi) - lo + 1);
        return int(lo + std::int64_t(engine_() % count));
    }
    bool chance(double p) { return real(0, 1) < p; }

private:
    std::mt19937_64 engine_;
};

enum class Ends { clamped, unclamped, closed };

struct BasisOptions {
    Ends ends = Ends::clamped;
    int spans = 3;
    bool jumps = false;   // interior knots of multiplicity p + 1 (open bases only)
    bool dyadic = false;  // knots are multiples of 1/64, so that differences of knots are exact
};

// Increasing numbers, spans of very different lengths.
inline std::vector<double> random_breaks(Random& random, int count, bool dyadic) {
    std::vector<double> b{dyadic ? random.integer(-128, 128) / 64.0 : random.real(-2, 2)};
    while (int(b.size()) < count)
        b.push_back(b.back() + (dyadic ? random.integer(1, 64) / 64.0 : std::exp2(random.real(-8, 1))));
    return b;
}

inline BSplineBasis random_basis(Random& random, int p, const BasisOptions& options) {
    const auto breaks = random_breaks(random, options.spans + 1, options.dyadic);
    std::vector<double> t;
    for (std::size_t i = 0; i < breaks.size(); ++i) {
        const bool inner = i > 0 && i + 1 < breaks.size();
        int m = random.chance(0.5) ? 1 : random.integer(1, std::max(p, 1));
        if (options.jumps && options.ends != Ends::closed && inner && random.chance(0.4)) m = p + 1;
        if (options.ends == Ends::clamped && !inner) m = p + 1;
        if (options.ends == Ends::closed && !inner) m = 1 + (p > 2 && random.chance(0.3));
        if (options.ends == Ends::unclamped && !inner) {
            const int outside = p + 1 - std::min(m, p + 1);
            m = std::min(m, p + 1);
            std::vector<double> more;
            for (int k = 0; k < outside; ++k) {
                const double step = random.chance(0.2) && k > 0 ? 0 : random.integer(1, 64) / 64.0;
                more.push_back((more.empty() ? breaks[i] : more.back()) + (i == 0 ? -step : step));
            }
            if (i == 0) t.assign(more.rbegin(), more.rend());
            t.insert(t.end(), std::size_t(m), breaks[i]);
            if (i > 0) t.insert(t.end(), more.begin(), more.end());
            continue;
        }
        t.insert(t.end(), std::size_t(m), breaks[i]);
    }
    return options.ends == Ends::closed ? must(BSplineBasis::periodic(p, std::move(t)))
                                        : must(BSplineBasis::make(p, std::move(t)));
}

// Coefficients in a box of half-width `size` around `offset`; weights between 2^-spread and 2^spread.
template <class P>
P random_coefficient(Random& random, double size = 1, double offset = 0, double spread = 1.5) {
    Vec<Space<P>::kDim> x;
    for (int i = 0; i < Space<P>::kDim; ++i) x[i] = offset + random.real(-size, size);
    return Space<P>::lift(x, Space<P>::kRational ? std::exp2(random.real(-spread, spread)) : 1);
}

template <std::size_t N, class P>
Net<N, P> random_net(Random& random, const Index<N>& extent, double size = 1, double offset = 0,
                     double spread = 1.5) {
    Net<N, P> net(extent);
    for (P& p : net.flat()) p = random_coefficient<P>(random, size, offset, spread);
    return net;
}

template <std::size_t N, class P>
Patch<N, P> random_patch_on(Random& random, std::array<BSplineBasis, N> bases) {
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = bases[d].size();
    return must(Patch<N, P>::make(std::move(bases), random_net<N, P>(random, extent)));
}

// The first axis has the given ends, the others may be anything.
template <std::size_t N, class P>
Patch<N, P> random_patch(Random& random, int max_degree, BasisOptions options) {
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{[&](std::size_t axis) {
            BasisOptions own = options;
            if (axis > 0 && random.chance(0.5)) own.ends = random.chance(0.5) ? Ends::clamped : Ends::closed;
            own.spans = random.integer(1, options.spans);
            return random_basis(random, random.integer(1, max_degree), own);
        }(I)...};
    }
    (std::make_index_sequence<N>{});
    return random_patch_on<N, P>(random, std::move(bases));
}

// Parameters of a basis: all breaks, their neighbours inside the domain, and some between.
template <class B>
std::vector<double> parameters(Random& random, const B& basis, const std::vector<double>& breaks,
                               int between) {
    const Interval on = basis.domain();
    std::vector<double> u;
    for (double b : breaks)
        for (double x : {std::nextafter(b, on.lo), b, std::nextafter(b, on.hi)})
            if (on.contains(x)) u.push_back(x);
    for (int i = 0; i < between; ++i) u.push_back(std::min(on.hi, random.real(on.lo, on.hi)));
    return u;
}
inline std::vector<double> parameters(Random& random, const BSplineBasis& basis, int between = 5) {
    return parameters(random, basis, basis.breaks(), between);
}

template <std::size_t N>
Param<N> to_param(const std::array<double, N>& u) {
    if constexpr (N == 1)
        return u[0];
    else
        return u;
}

// Random parameters of a patch, some of them on knots and ends.
template <std::size_t N, class P>
std::vector<Param<N>> parameters(Random& random, const Patch<N, P>& patch, int count, bool on_knots = true) {
    std::vector<Param<N>> all;
    for (int i = 0; i < count; ++i) {
        std::array<double, N> u{};
        for (std::size_t d = 0; d < N; ++d) {
            const Interval on = patch.basis(int(d)).domain();
            if (on_knots && random.chance(0.4)) {
                const auto some = parameters(random, patch.basis(int(d)), 0);
                u[d] = some[std::size_t(random.integer(0, int(some.size()) - 1))];
            } else {
                u[d] = std::min(on.hi, random.real(on.lo, on.hi));
            }
        }
        all.push_back(to_param<N>(u));
    }
    return all;
}

template <class V>
double distance(const V& a, const V& b) {
    return norm(a - b);
}

}  // namespace freiform::test
