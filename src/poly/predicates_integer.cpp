// The last stage of the predicates: determinants in integers of any length. Slow, and obviously right; it is
// asked only if the exponents of the coordinates are hundreds of powers of two apart. See predicates.cpp.
#include "poly/predicates_detail.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace freiform::detail {

namespace {

// (-1)^negative * sum of limb[i] * 2^(32 i); the last limb is not zero, and zero has none.
struct Integer {
    bool negative = false;
    std::vector<std::uint32_t> limb;

    int sign() const { return limb.empty() ? 0 : negative ? -1 : 1; }
};

void trim(std::vector<std::uint32_t>& limb) {
    while (!limb.empty() && limb.back() == 0) limb.pop_back();
}

bool is_smaller(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

std::vector<std::uint32_t> add_sizes(const std::vector<std::uint32_t>& a,
                                     const std::vector<std::uint32_t>& b) {
    std::vector<std::uint32_t> s;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        carry += std::uint64_t(i < a.size() ? a[i] : 0) + (i < b.size() ? b[i] : 0);
        s.push_back(std::uint32_t(carry));
        carry >>= 32;
    }
    s.push_back(std::uint32_t(carry));
    trim(s);
    return s;
}

// a - b. REQUIRES: a >= b.
std::vector<std::uint32_t> subtract_sizes(std::vector<std::uint32_t> a, const std::vector<std::uint32_t>& b) {
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::int64_t d = std::int64_t(a[i]) - (i < b.size() ? b[i] : 0) - borrow;
        borrow = d < 0;
        if (borrow) d += std::int64_t(1) << 32;
        a[i] = std::uint32_t(d);
    }
    trim(a);
    return a;
}

Integer operator+(const Integer& a, const Integer& b) {
    if (a.negative == b.negative) return {a.negative, add_sizes(a.limb, b.limb)};
    if (is_smaller(a.limb, b.limb)) return {b.negative, subtract_sizes(b.limb, a.limb)};
    return {a.negative, subtract_sizes(a.limb, b.limb)};
}

Integer operator-(const Integer& a, Integer b) {
    b.negative = !b.negative;
    return a + b;
}

Integer operator*(const Integer& a, const Integer& b) {
    Integer p{a.negative != b.negative, std::vector<std::uint32_t>(a.limb.size() + b.limb.size())};
    for (std::size_t i = 0; i < a.limb.size(); ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.limb.size(); ++j) {
            carry += std::uint64_t(a.limb[i]) * b.limb[j] + p.limb[i + j];
            p.limb[i + j] = std::uint32_t(carry);
            carry >>= 32;
        }
        p.limb[i + b.limb.size()] = std::uint32_t(carry);
    }
    trim(p.limb);
    return p;
}

// x as m * 2^exponent with a whole number |m| < 2^53.
struct Parts {
    std::int64_t m;
    int exponent;
};
Parts parts_of(double x) {
    int e = 0;
    const double f = std::frexp(x, &e);
    return {std::int64_t(std::ldexp(f, 53)), e - 53};
}

// m * 2^shift.
Integer shifted(std::int64_t m, int shift) {
    Integer r{m < 0, std::vector<std::uint32_t>(std::size_t(shift / 32))};
    const std::uint64_t size = std::uint64_t(m < 0 ? -m : m);
    const int bits = shift % 32;
    const std::uint64_t low = (size & 0xffffffffu) << bits;
    const std::uint64_t high = ((size >> 32) << bits) + (low >> 32);
    r.limb.push_back(std::uint32_t(low));
    r.limb.push_back(std::uint32_t(high));
    r.limb.push_back(std::uint32_t(high >> 32));
    trim(r.limb);
    return r;
}

// Differences of the points from the last one, all multiplied by one power of two that makes them whole.
template <std::size_t N>
std::array<std::array<Integer, 2>, N - 1> whole_differences(const PlanePoints<N>& p) {
    int least = 5000;
    for (const Vec<2>& q : p)
        for (const double x : q.c)
            if (x != 0) least = std::min(least, parts_of(x).exponent);
    const auto whole = [&](double x) {
        const Parts w = parts_of(x);
        return x == 0 ? Integer{} : shifted(w.m, w.exponent - least);
    };
    std::array<std::array<Integer, 2>, N - 1> d;
    for (std::size_t i = 0; i + 1 < N; ++i)
        for (std::size_t k = 0; k < 2; ++k) d[i][k] = whole(p[i].c[k]) - whole(p[N - 1].c[k]);
    return d;
}

Integer minor_of(const std::array<Integer, 2>& a, const std::array<Integer, 2>& b) {
    return a[0] * b[1] - a[1] * b[0];
}
Integer lift_of(const std::array<Integer, 2>& a) { return a[0] * a[0] + a[1] * a[1]; }

}  // namespace

int integer_sign(const PlanePoints<3>& p) {
    const auto d = whole_differences(p);
    return minor_of(d[0], d[1]).sign();
}

int integer_sign(const PlanePoints<4>& p) {
    const auto d = whole_differences(p);
    return (lift_of(d[0]) * minor_of(d[1], d[2]) + lift_of(d[1]) * minor_of(d[2], d[0]) +
            lift_of(d[2]) * minor_of(d[0], d[1]))
        .sign();
}

}  // namespace freiform::detail
