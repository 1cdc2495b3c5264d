// Polynomials on [0, 1] in Bernstein form, of numbers and of vectors that carry bounds.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/spline/jet.hpp>

#include <concepts>
#include <vector>

namespace freiform::detail {

using BernsteinScalar = std::vector<Bounded>;
using BernsteinVector = std::vector<BoundedVec<3>>;

template <class A, class B, class F>
auto bernstein_product(const std::vector<A>& a, const std::vector<B>& b, F&& times) {
    using C = decltype(times(a[0], b[0]));
    const int p = int(a.size()) - 1, q = int(b.size()) - 1;
    std::vector<C> out(std::size_t(p + q) + 1);
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
            const Bounded w =
                Bounded(binomial(p, i)) * Bounded(binomial(q, j)) / Bounded(binomial(p + q, i + j));
            const C c = times(a[std::size_t(i)], b[std::size_t(j)]);
            C& sum = out[std::size_t(i + j)];
            if constexpr (std::same_as<C, Bounded>)
                sum += w * c;
            else
                for (std::size_t k = 0; k < 3; ++k) sum[k] += w * c[k];
        }
    return out;
}
inline BernsteinScalar scaled_by(const BernsteinScalar& s, const BernsteinScalar& v) {
    return bernstein_product(s, v, [](const Bounded& x, const Bounded& y) { return x * y; });
}
inline BernsteinVector scaled_by(const BernsteinScalar& s, const BernsteinVector& v) {
    return bernstein_product(s, v, [](const Bounded& x, BoundedVec<3> y) {
        for (Bounded& c : y) c = x * c;
        return y;
    });
}
// Of at least this degree.
template <class T>
std::vector<T> elevated(const std::vector<T>& v, std::size_t degree) {
    if (v.size() > degree) return v;
    return scaled_by(BernsteinScalar(degree + 2 - v.size(), Bounded(1)), v);
}

}  // namespace freiform::detail
