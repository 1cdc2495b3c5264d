// Truncated power series: c[0] + c[1] t + .. + c[n] t^n + O(t^(n+1)), over any field-like type (double,
// Bounded, DoubleDouble, exact rationals). The calculus of reparametrisation: f o g, the inverse of g, roots
// and quotients of functions, all orders at once.
//
// All series of an operation have the same number of terms. Cost: O(n^2), of `compose` O(n^3), of `inverse`
// O(n^4) operations; n is an order of differentiation, so small. Derivatives are c[k] k!. References:
// [Knuth 1997, 4.7].
#pragma once
#include <freiform/core/result.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace freiform {

template <class T>
using Series = std::vector<T>;

template <class T>
Series<T> multiply(const Series<T>& a, const Series<T>& b) {
    FF_REQUIRE(a.size() == b.size());
    Series<T> c(a.size(), T(0));
    for (std::size_t k = 0; k < c.size(); ++k)
        for (std::size_t i = 0; i <= k; ++i) c[k] += a[i] * b[k - i];
    return c;
}

// REQUIRES b[0] != 0.
template <class T>
Series<T> divide(const Series<T>& a, const Series<T>& b) {
    FF_REQUIRE(a.size() == b.size());
    Series<T> c = a;
    for (std::size_t k = 0; k < c.size(); ++k) {
        for (std::size_t i = 1; i <= k; ++i) c[k] -= b[i] * c[k - i];
        c[k] = c[k] / b[0];
    }
    return c;
}

// REQUIRES a[0] > 0.
template <class T>
Series<T> square_root(const Series<T>& a) {
    using std::sqrt;
    Series<T> c = a;
    if (c.empty()) return c;
    c[0] = sqrt(a[0]);
    const T twice = c[0] + c[0];
    for (std::size_t k = 1; k < c.size(); ++k) {
        for (std::size_t i = 1; i < k; ++i) c[k] -= c[i] * c[k - i];
        c[k] = c[k] / twice;
    }
    return c;
}

// a to the power m / n. REQUIRES a[0] == 1 (not looked at) and n > 0. From a b' = (m / n) a' b with b =
// a^(m/n).
template <class T>
Series<T> power_of(const Series<T>& a, int m, int n) {
    Series<T> b(a.size(), T(0));
    if (b.empty()) return b;
    b[0] = T(1);
    for (std::size_t k = 1; k < b.size(); ++k) {
        for (std::size_t i = 1; i <= k; ++i) b[k] += T(double(i) * (m + n) - double(k) * n) * a[i] * b[k - i];
        b[k] = b[k] / T(double(k) * n);
    }
    return b;
}

// The derivative; its last term, which is not known, is left out.
template <class T>
Series<T> differentiated(const Series<T>& a) {
    Series<T> c;
    for (std::size_t k = 1; k < a.size(); ++k) c.push_back(T(double(k)) * a[k]);
    return c;
}
// The integral from 0, one term longer.
template <class T>
Series<T> integrated(const Series<T>& a) {
    Series<T> c{T(0)};
    for (std::size_t k = 0; k < a.size(); ++k) c.push_back(a[k] / T(double(k + 1)));
    return c;
}

// f(g(t)). REQUIRES g[0] == 0; the constant term of g is not looked at.
template <class T>
Series<T> compose(const Series<T>& f, Series<T> g) {
    FF_REQUIRE(f.size() == g.size());
    Series<T> c(f.size(), T(0));
    if (f.empty()) return c;
    g[0] = T(0);
    for (std::size_t k = f.size(); k-- > 0;) {
        c = multiply(c, g);
        c[0] += f[k];
    }
    return c;
}

// h with g(h(t)) = t. REQUIRES g[0] == 0 (not looked at) and g[1] != 0.
template <class T>
Series<T> inverse(const Series<T>& g) {
    Series<T> h(g.size(), T(0));
    if (g.size() < 2) return h;
    h[1] = T(1) / g[1];
    for (std::size_t k = 2; k < g.size(); ++k) {
        // With h[k] = 0 the composite has some k-th term r; g[1] h[k] has to cancel it.
        Series<T> f(g.begin(), g.begin() + std::ptrdiff_t(k) + 1),
            part(h.begin(), h.begin() + std::ptrdiff_t(k) + 1);
        f[0] = T(0);
        h[k] = -compose(f, part)[k] / g[1];
    }
    return h;
}

// Derivatives f, f', f'', .. to terms f^(k) / k! and back.
template <class T>
Series<T> series_of(std::span<const T> derivatives) {
    Series<T> c(derivatives.begin(), derivatives.end());
    T factorial(1);
    for (std::size_t k = 2; k < c.size(); ++k) {
        factorial *= T(double(k));
        c[k] = c[k] / factorial;
    }
    return c;
}
template <class T>
std::vector<T> derivatives_of(const Series<T>& series) {
    std::vector<T> d = series;
    T factorial(1);
    for (std::size_t k = 2; k < d.size(); ++k) {
        factorial *= T(double(k));
        d[k] *= factorial;
    }
    return d;
}

}  // namespace freiform
