// Integers in limbs of 32 bits, by the methods of school.
//
// Accuracy: exact by construction. Cost: sums O(limbs), products and quotients O(product of the numbers of
// limbs). Division: algorithm D of [Knuth 1997, 4.3.1]: the quotient digit estimated from the two leading
// limbs of a divisor whose highest bit is set is at most 2 too large. gcd: Euclid's algorithm.
//
// Why not a library? They are asked for where doubles cannot decide, and the library depends on nothing.
#include <freiform/poly/integer.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace freiform::detail {

namespace {

using Limbs = std::vector<std::uint32_t>;

void trim(Limbs& limb) {
    while (!limb.empty() && limb.back() == 0) limb.pop_back();
}

bool is_smaller(const Limbs& a, const Limbs& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

Limbs add_sizes(const Limbs& a, const Limbs& b) {
    const std::size_t n = std::max(a.size(), b.size());
    Limbs s(n + 1);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < n; ++i) {
        carry += std::uint64_t(i < a.size() ? a[i] : 0) + (i < b.size() ? b[i] : 0);
        s[i] = std::uint32_t(carry);
        carry >>= 32;
    }
    s[n] = std::uint32_t(carry);
    trim(s);
    return s;
}

// a - b. REQUIRES: a >= b.
Limbs subtract_sizes(Limbs a, const Limbs& b) {
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size() && (i < b.size() || borrow != 0); ++i) {
        std::int64_t d = std::int64_t(a[i]) - (i < b.size() ? b[i] : 0) - borrow;
        borrow = d < 0;
        if (borrow) d += std::int64_t(1) << 32;
        a[i] = std::uint32_t(d);
    }
    trim(a);
    return a;
}

Integer sum(const Integer& a, const Integer& b, bool b_negative) {
    if (a.negative == b_negative) return {a.negative, add_sizes(a.limb, b.limb)};
    if (is_smaller(a.limb, b.limb)) return {b_negative, subtract_sizes(b.limb, a.limb)};
    Integer d{a.negative, subtract_sizes(a.limb, b.limb)};
    d.negative = d.negative && !d.limb.empty();
    return d;
}

Limbs shift_left(const Limbs& a, int bits) {
    if (a.empty()) return {};
    const std::size_t whole = std::size_t(bits / 32);
    const int part = bits % 32;
    Limbs s(a.size() + whole + 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::uint64_t x = std::uint64_t(a[i]) << part;
        s[i + whole] |= std::uint32_t(x);
        s[i + whole + 1] = std::uint32_t(x >> 32);
    }
    trim(s);
    return s;
}

Limbs shift_right(const Limbs& a, int bits) {
    const std::size_t whole = std::size_t(bits / 32);
    const int part = bits % 32;
    if (whole >= a.size()) return {};
    Limbs s(a.size() - whole);
    for (std::size_t i = 0; i < s.size(); ++i) {
        const std::uint64_t x =
            a[i + whole] | (i + whole + 1 < a.size() ? std::uint64_t(a[i + whole + 1]) << 32 : 0);
        s[i] = std::uint32_t(x >> part);
    }
    trim(s);
    return s;
}

// a := a mod d, the result is a / d. d > 0.
Limbs divide_by_limb(Limbs& a, std::uint32_t d) {
    Limbs q(a.size());
    std::uint64_t r = 0;
    for (std::size_t i = a.size(); i-- > 0;) {
        r = (r << 32) | a[i];
        q[i] = std::uint32_t(r / d);
        r %= d;
    }
    a.assign(1, std::uint32_t(r));
    trim(a);
    trim(q);
    return q;
}

// a := a mod b, the result is a / b. b has two limbs or more, a >= b.
Limbs divide_long(Limbs& a, const Limbs& b) {
    const int shift = std::countl_zero(b.back());
    const Limbs v = shift_left(b, shift);
    Limbs u = shift_left(a, shift);
    const std::size_t n = v.size();
    u.resize(a.size() + 1);
    Limbs q(u.size() - n);
    for (std::size_t j = q.size(); j-- > 0;) {
        const std::uint64_t top = (std::uint64_t(u[j + n]) << 32) | u[j + n - 1];
        std::uint64_t digit = top / v[n - 1], rest = top % v[n - 1];
        while (digit >> 32 || digit * v[n - 2] > ((rest << 32) | u[j + n - 2])) {
            --digit;
            rest += v[n - 1];
            if (rest >> 32) break;
        }
        std::int64_t borrow = 0;
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < n; ++i) {
            carry += digit * v[i];
            const std::int64_t d = std::int64_t(u[i + j]) - std::int64_t(carry & 0xffffffffu) - borrow;
            u[i + j] = std::uint32_t(d);
            borrow = d < 0;
            carry >>= 32;
        }
        const std::int64_t d = std::int64_t(u[j + n]) - std::int64_t(carry) - borrow;
        u[j + n] = std::uint32_t(d);
        if (d < 0) {
            --digit;
            std::uint64_t back = 0;
            for (std::size_t i = 0; i < n; ++i) {
                back += std::uint64_t(u[i + j]) + v[i];
                u[i + j] = std::uint32_t(back);
                back >>= 32;
            }
            u[j + n] += std::uint32_t(back);
        }
        q[j] = std::uint32_t(digit);
    }
    trim(u);
    a = shift_right(u, shift);
    trim(q);
    return q;
}

}  // namespace

Integer operator+(const Integer& a, const Integer& b) { return sum(a, b, b.negative); }
Integer operator-(const Integer& a, const Integer& b) { return sum(a, b, !b.negative); }

Integer operator*(const Integer& a, const Integer& b) {
    if (a.limb.empty() || b.limb.empty()) return {};
    Integer p{a.negative != b.negative, Limbs(a.limb.size() + b.limb.size())};
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

Integer negated(Integer a) {
    a.negative = !a.negative && !a.limb.empty();
    return a;
}
Integer shifted_left(const Integer& a, int bits) { return {a.negative, shift_left(a.limb, bits)}; }
Integer shifted_right(const Integer& a, int bits) {
    Integer s{a.negative, shift_right(a.limb, bits)};
    s.negative = s.negative && !s.limb.empty();
    return s;
}

Division divided(const Integer& a, const Integer& b) {
    if (is_smaller(a.limb, b.limb)) return {{}, a};
    Division d{{}, a};
    d.quotient.limb = b.limb.size() == 1 ? divide_by_limb(d.remainder.limb, b.limb[0])
                                         : divide_long(d.remainder.limb, b.limb);
    d.quotient.negative = a.negative != b.negative && !d.quotient.limb.empty();
    d.remainder.negative = a.negative && !d.remainder.limb.empty();
    return d;
}

Integer gcd(Integer a, Integer b) {
    a.negative = b.negative = false;
    while (!b.limb.empty()) {
        Integer r = divided(a, b).remainder;
        a = std::move(b);
        b = std::move(r);
    }
    return a;
}

int bit_length(const Integer& a) {
    return a.limb.empty() ? 0 : int(a.limb.size()) * 32 - std::countl_zero(a.limb.back());
}

int trailing_zeros(const Integer& a) {
    for (std::size_t i = 0; i < a.limb.size(); ++i)
        if (a.limb[i] != 0) return int(i) * 32 + std::countr_zero(a.limb[i]);
    return 0;
}

std::uint32_t residue(const Integer& a, std::uint32_t modulus) {
    std::uint64_t r = 0;
    for (std::size_t i = a.limb.size(); i-- > 0;) r = ((r << 32) | a.limb[i]) % modulus;
    return std::uint32_t(a.negative && r != 0 ? modulus - r : r);
}

Leading leading(const Integer& a) {
    const int bits = bit_length(a);
    if (bits == 0) return {};
    const Integer top = bits > 53 ? shifted_right(a, bits - 53) : a;
    double f = 0;
    for (std::size_t i = top.limb.size(); i-- > 0;) f = f * 0x1p32 + top.limb[i];
    return {std::scalbn(a.negative ? -f : f, -std::min(bits, 53)), bits};
}

Parts parts_of(double x) {
    int e = 0;
    const double f = std::frexp(x, &e);
    return {std::int64_t(std::ldexp(f, 53)), e - 53};
}

Integer shifted(std::int64_t m, int shift) {
    const std::uint64_t size = m < 0 ? 0 - std::uint64_t(m) : std::uint64_t(m);
    Integer r{m < 0, {std::uint32_t(size), std::uint32_t(size >> 32)}};
    trim(r.limb);
    r.limb = shift_left(r.limb, shift);
    return r;
}

}  // namespace freiform::detail
