// Coefficient spaces: what a coefficient is (Vec or Hom) and what it projects to. The only place of the
// library that knows what "rational" means.
#pragma once
#include <freiform/core/vec.hpp>

namespace freiform {

// A weighted point in homogeneous coordinates (w x, w). Deliberately not convertible to Vec<D + 1>.
template <int D>
struct Hom {
    static constexpr int kCoords = D + 1;
    std::array<double, std::size_t(D) + 1> c{};

    constexpr double& operator[](int i) { return c[std::size_t(i)]; }
    constexpr double operator[](int i) const { return c[std::size_t(i)]; }
    constexpr double weight() const { return c[std::size_t(D)]; }
    friend constexpr bool operator==(const Hom&, const Hom&) = default;
};

// The homogeneous form of the point x with weight w.
template <int D>
constexpr Hom<D> weighted(const Vec<D>& x, double w) {
    Hom<D> h;
    for (int i = 0; i < D; ++i) h[i] = w * x[i];
    h[D] = w;
    return h;
}

template <class P>
struct Space;

template <int D>
struct Space<Vec<D>> {
    static constexpr bool kRational = false;
    static constexpr int kDim = D;
    using Point = Vec<D>;
    static constexpr Point project(const Vec<D>& p) { return p; }
    static constexpr double weight(const Vec<D>&) { return 1; }
    static constexpr Vec<D> lift(const Vec<D>& x, double) { return x; }
};

template <int D>
struct Space<Hom<D>> {
    static constexpr bool kRational = true;
    static constexpr int kDim = D;
    using Point = Vec<D>;
    static constexpr Point project(const Hom<D>& p) {
        Point x;
        for (int i = 0; i < D; ++i) x[i] = p[i] / p.weight();
        return x;
    }
    static constexpr double weight(const Hom<D>& p) { return p.weight(); }
    static constexpr Hom<D> lift(const Vec<D>& x, double w) { return weighted(x, w); }
};

template <class P>
using PointOf = typename Space<P>::Point;

template <Coefficient P>
constexpr PointOf<P> project(const P& p) {
    return Space<P>::project(p);
}

}  // namespace freiform
