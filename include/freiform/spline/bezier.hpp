// Bezier pieces of a spline: one net in which every piece is a block of its own, and the algorithms on blocks
// (de Casteljau) that clipping, bounding and subdivision are made of.
#pragma once
#include <freiform/spline/patch.hpp>

#include <vector>

namespace freiform {

template <std::size_t N, class P>
class BezierPieces {
public:
    explicit BezierPieces(const Patch<N, P>& patch);

    Index<N> extent() const;  // number of pieces along each axis
    int degree(int axis) const { return degree_[std::size_t(axis)]; }
    std::array<Interval, N> box(const Index<N>& piece) const;  // its part of the domain
    NetView<N, const P> net(const Index<N>& piece) const;      // its (p_d + 1) x .. coefficients
    const std::vector<double>& breaks(int axis) const { return breaks_[std::size_t(axis)]; }
    Patch<N, P, Bernstein> piece(const Index<N>& index) const;

private:
    Index<N> degree_{};
    std::array<std::vector<double>, N> breaks_;
    Net<N, P> net_;
};

template <std::size_t N, class P>
BezierPieces<N, P> decompose(const Patch<N, P>& patch) {
    return BezierPieces<N, P>(patch);
}

// de Casteljau in place: the coefficients of a Bezier curve on [0, 1] become those of its part on [0, t]
// (keep left) or [t, 1] (keep right). REQUIRES t in [0, 1]. Each coordinate is off by at most split_error(p)
// times its largest absolute value among the coefficients: p steps of 1 - t, a product and a sum, and what
// went wrong before is averaged.
inline constexpr double split_error(int p) { return 1.01 * 3 * p * 0x1p-53; }
template <class P>
void keep_left(Fibre<P> b, double t) {
    for (int r = 1; r < b.size; ++r)
        for (int i = b.size - 1; i >= r; --i) b[i] = (1 - t) * b[i - 1] + t * b[i];
}
template <class P>
void keep_right(Fibre<P> b, double t) {
    for (int r = 1; r < b.size; ++r)
        for (int i = 0; i < b.size - r; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
}

}  // namespace freiform
