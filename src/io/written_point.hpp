// Control points of rational patches for formats that hold points and weights.
#pragma once
#include <freiform/core/hom.hpp>
#include <freiform/core/vec.hpp>

#include <cmath>
#include <limits>

namespace freiform::detail {

// The x with fl(w x) = h, so that reading gives the same coefficient; the quotient where there is none.
template <int D>
Vec<D> written_point(const Hom<D>& h) {
    Vec<D> p = project(h);
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (int i = 0; i < D; ++i)
        for (const double x : {p[i], std::nextafter(p[i], -kInfinite), std::nextafter(p[i], kInfinite)})
            if (h.weight() * x == h[i]) {
                p[i] = x;
                break;
            }
    return p;
}
template <int D>
Vec<D> written_point(const Vec<D>& p) {
    return p;
}

}  // namespace freiform::detail
