// The Bezier pieces of a curve or surface, scaled, as intersections keep them: never changed once made.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform::detail {

// The least e with all |coordinates| <= 2^e, and all weights <= 2^w.
struct Exponents {
    int point = -1100, weight = 0;
};
template <class P>
Exponents exponents_of(std::span<const P> net) {
    double x = 0, w = 0;
    for (const P& p : net) {
        x = std::max(x, max_abs(Space<P>::project(p)));
        w = std::max(w, std::abs(Space<P>::weight(p)));
    }
    return {x > 0 ? std::ilogb(x) + 1 : -1100, Space<P>::kRational ? std::ilogb(w) + 1 : 0};
}

template <std::size_t N, class P>
struct ArcPieces {
    static constexpr int D = Space<P>::kDim;
    std::array<int, N> degree{}, count{};       // along each axis
    std::array<std::vector<double>, N> breaks;  // of the pieces
    std::array<Interval, N> domain{};
    std::array<bool, N> closed{};
    std::vector<P> points;  // piece by piece, row-major, in the scale of the user
    // Of each number of a piece, coordinates times weight, and of each weight: these have units of their own.
    // 0: exactly those of the object.
    std::vector<double> error, weight_error;
    std::vector<char> jump;  // curves: the curve jumps at the beginning of piece i
    Exponents exponents;

    int block() const {
        int n = 1;
        for (const int d : degree) n *= d + 1;
        return n;
    }
    int pieces() const { return int(error.size()); }
    std::array<Interval, N> box(int piece) const {
        std::array<Interval, N> b;
        for (std::size_t d = N; d-- > 0;) {
            const std::size_t i = std::size_t(piece % count[d]);
            b[d] = {breaks[d][i], breaks[d][i + 1]};
            piece /= count[d];
        }
        return b;
    }
    bool all_exact() const {
        return std::all_of(error.begin(), error.end(), [](double e) { return e == 0; });
    }
};

// Extraction is exact between knots of multiplicity p and more, and leaves (12 p + 8) roundings of the
// largest number elsewhere (derivative_bounds.cpp); of surfaces for each axis.
template <std::size_t N, class P>
ArcPieces<N, P> arc_pieces(const Patch<N, P>& patch) {
    ArcPieces<N, P> out;
    const BezierPieces<N, P> all(patch);
    out.exponents = exponents_of<P>(patch.net().flat());
    for (std::size_t d = 0; d < N; ++d) {
        const BSplineBasis& basis = patch.basis(int(d));
        out.degree[d] = basis.degree();
        out.count[d] = all.extent()[d];
        out.breaks[d] = all.breaks(int(d));
        out.domain[d] = basis.domain();
        out.closed[d] = basis.is_closed();
    }
    each_index(all.extent(), [&](const Index<N>& at) {
        double roundings = 0, most = 0, heaviest = 0;
        const auto net = all.net(at);
        each_index(net.extent, [&](const Index<N>& i) {
            out.points.push_back(net(i));
            for (int k = 0; k < Space<P>::kDim; ++k) most = std::max(most, std::abs(net(i)[k]));
            if (Space<P>::kRational) heaviest = std::max(heaviest, std::abs(Space<P>::weight(net(i))));
        });
        for (std::size_t d = 0; d < N; ++d) {
            const BSplineBasis& basis = patch.basis(int(d));
            const int p = basis.degree(), s = basis.span(all.box(at)[d].lo);
            const Interval on = all.box(at)[d];
            if (p > 0 && (basis.knot(s - p + 1) != on.lo || basis.knot(s + p) != on.hi))
                roundings += 12 * p + 8;
            if (N == 1) out.jump.push_back(at[0] > 0 && basis.multiplicity(on.lo) > p);
        }
        const auto rounded = [&](double x) {
            return roundings == 0 ? 0 : roundings * kUnitRoundoff * x + 0x1p-1060;
        };
        out.error.push_back(rounded(most));
        out.weight_error.push_back(rounded(heaviest));
    });
    return out;
}

}  // namespace freiform::detail
