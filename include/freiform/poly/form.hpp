// Polynomials in scaled Bernstein form: sums, products and derivatives, over numbers of any kind (doubles
// that carry bounds, pairs of doubles, integers).
//
// A polynomial of degree n is kept by s_i = C(n, i) c_i, c_i its Bernstein coefficients; these are the power
// coefficients in x = t / (1 - t), so products are convolutions and all factors are whole numbers. No
// coefficients: the zero polynomial. Cost: O(n^2) for a product. References: [Farouki & Rajan 1987].
#pragma once
#include <freiform/poly/integer.hpp>

#include <concepts>
#include <vector>

namespace freiform::detail {

template <class T>
struct Form {
    std::vector<T> s;

    bool is_zero() const { return s.empty(); }
    int degree() const { return int(s.size()) - 1; }
};

template <class T>
T whole_number(int k) {
    if constexpr (std::same_as<T, Integer>)
        return integer(k);
    else
        return T(double(k));
}

template <class T>
Form<T> operator*(const Form<T>& a, const Form<T>& b) {
    if (a.is_zero() || b.is_zero()) return {};
    Form<T> p{std::vector<T>(a.s.size() + b.s.size() - 1)};
    for (std::size_t i = 0; i < a.s.size(); ++i)
        for (std::size_t j = 0; j < b.s.size(); ++j) p.s[i + j] = p.s[i + j] + a.s[i] * b.s[j];
    return p;
}
// The same polynomial with a higher degree: times (t + (1 - t))^k.
template <class T>
Form<T> elevated(Form<T> a, int degree) {
    while (!a.is_zero() && a.degree() < degree) {
        a.s.push_back(whole_number<T>(0));
        for (std::size_t i = a.s.size() - 1; i > 0; --i) a.s[i] = a.s[i] + a.s[i - 1];
    }
    return a;
}
template <class T>
Form<T> operator+(const Form<T>& a, const Form<T>& b) {
    if (a.is_zero()) return b;
    if (b.is_zero()) return a;
    Form<T> sum = elevated(a, b.degree());
    const Form<T> other = elevated(b, a.degree());
    for (std::size_t i = 0; i < sum.s.size(); ++i) sum.s[i] = sum.s[i] + other.s[i];
    return sum;
}
template <class T>
Form<T> operator-(const Form<T>& a, const Form<T>& b) {
    Form<T> minus = b;
    for (T& x : minus.s) x = whole_number<T>(-1) * x;
    return a + minus;
}
template <class T>
Form<T> operator*(int k, Form<T> a) {
    for (T& x : a.s) x = whole_number<T>(k) * x;
    return a;
}
template <class T>
Form<T> derivative(const Form<T>& a) {
    Form<T> d;
    const int n = a.degree();
    for (int i = 0; i < n; ++i)
        d.s.push_back(whole_number<T>(i + 1) * a.s[std::size_t(i) + 1] -
                      whole_number<T>(n - i) * a.s[std::size_t(i)]);
    return d;
}

}  // namespace freiform::detail
