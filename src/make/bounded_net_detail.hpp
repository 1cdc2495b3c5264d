// Vectors whose coordinates carry bounds, and rational nets that are rounded from them.
#pragma once
#include "rounding_detail.hpp"

#include <freiform/core/hom.hpp>

#include <vector>

namespace freiform::bounded {

template <int D>
using Vector = std::array<Bounded, std::size_t(D)>;

template <int D>
Vector<D> vector(const Vec<D>& v, double bound = 0) {
    Vector<D> b;
    for (int i = 0; i < D; ++i) b[std::size_t(i)] = {v[i], bound};
    return b;
}
template <std::size_t D>
std::array<Bounded, D> operator+(std::array<Bounded, D> a, const std::array<Bounded, D>& b) {
    for (std::size_t i = 0; i < D; ++i) a[i] = a[i] + b[i];
    return a;
}
template <std::size_t D>
std::array<Bounded, D> operator-(std::array<Bounded, D> a, const std::array<Bounded, D>& b) {
    for (std::size_t i = 0; i < D; ++i) a[i] = a[i] - b[i];
    return a;
}
template <std::size_t D>
std::array<Bounded, D> operator*(const Bounded& s, std::array<Bounded, D> a) {
    for (Bounded& x : a) x = x == Bounded(0) ? x : s * x;
    return a;
}
template <std::size_t D>
Bounded length(const std::array<Bounded, D>& a) {
    return sqrt(dot(a, a));
}

template <int D>
class RoundedNet {
public:
    std::vector<Hom<D>> net;

    void add(const Vector<D>& numerator, const Bounded& weight) {
        Hom<D> h;
        Vec<D> e;
        const double w = weight.value;
        for (int k = 0; k < D; ++k) {
            const Bounded& x = numerator[std::size_t(k)];
            h[k] = x.value, e[k] = x.bound / w;
        }
        h[D] = w;
        net.push_back(h);
        moved_.add(project(h), norm(e), weight.bound / w);
    }
    // Distance of every point from that of the exact net at the same parameter; infinite where rounding
    // leaves nothing of a weight.
    double bound() const { return moved_.value(); }

private:
    detail::MovedBound moved_;
};

}  // namespace freiform::bounded
