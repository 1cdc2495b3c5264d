// Numbers of twice the precision: the unevaluated sum of two doubles, about 106 bits. For formulas whose
// result is to be right to the last bit of a double.
//
// Accuracy: each operation has a relative error of at most 2^-100, sums that cancel included, as long as
// nothing overflows or falls below 2^-860. References: [Joldes Muller Popescu 2017].
#pragma once
#include <cmath>

namespace freiform {

struct DoubleDouble {
    double hi = 0, lo = 0;

    constexpr DoubleDouble() = default;
    constexpr DoubleDouble(double x) : hi(x) {}
    constexpr DoubleDouble(double h, double l) : hi(h), lo(l) {}
    constexpr double rounded() const { return hi + lo; }
};

namespace detail {
// a + b without error. REQUIRES |a| >= |b| or a == 0.
constexpr DoubleDouble ordered_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}
constexpr DoubleDouble exact_sum(double a, double b) {
    const double s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
}
inline DoubleDouble exact_product(double a, double b) {
    const double p = a * b;
    return {p, std::fma(a, b, -p)};
}
}  // namespace detail

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = detail::exact_sum(a.hi, b.hi), t = detail::exact_sum(a.lo, b.lo);
    const DoubleDouble u = detail::ordered_sum(s.hi, s.lo + t.hi);
    return detail::ordered_sum(u.hi, u.lo + t.lo);
}
inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = detail::exact_product(a.hi, b.hi);
    return detail::ordered_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.hi / b.hi;
    const DoubleDouble rest = a - DoubleDouble(first) * b;
    const double second = rest.hi / b.hi;
    const DoubleDouble last = rest - DoubleDouble(second) * b;
    const DoubleDouble q = detail::ordered_sum(first, second);
    return q + DoubleDouble(last.hi / b.hi);
}
inline DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) { return a = a + b; }
inline DoubleDouble& operator-=(DoubleDouble& a, const DoubleDouble& b) { return a = a - b; }
inline DoubleDouble& operator*=(DoubleDouble& a, const DoubleDouble& b) { return a = a * b; }
inline DoubleDouble& operator/=(DoubleDouble& a, const DoubleDouble& b) { return a = a / b; }

}  // namespace freiform
