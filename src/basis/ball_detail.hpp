// Numbers of 512 binary digits that carry a bound of their error: for work done once, such as a change of
// basis, where condition numbers of 1e20 are usual and the answer must still come with a proof.
//
// Notation: a ball (m, e, r) is the set of numbers within r 2^e of m 2^e; the number meant is one of them.
// Method: m is exact as long as it has at most 512 digits; otherwise the lowest are cut off, which adds 1 to
// r. The radius is a double, every formula for it is rounded up by a factor that pays for its few roundings.
// A radius that is not finite says that nothing is known; to_double refuses it.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/poly/integer.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform::detail {

struct Ball {
    static constexpr int kDigits = 512;

    Integer m;
    int e = 0;
    double r = 0;

    Ball() = default;
    explicit Ball(double x) {
        const Parts p = parts_of(x);
        m = integer(p.m), e = p.exponent;
        strip();
    }
    explicit Ball(int k) : m(integer(k)) {}

    Ball& operator+=(const Ball& b) { return *this = *this + b; }
    Ball& operator-=(const Ball& b) { return *this = *this - b; }
    Ball& operator*=(const Ball& b) { return *this = *this * b; }

    static double up(double x) { return x * (1 + 0x1p-48); }
    // At least |m|, in double.
    static double size_of(const Integer& m) {
        const Leading l = leading(m);
        return up(std::scalbn(std::abs(l.fraction), l.exponent));
    }
    // r 2^k, not less.
    static double scaled(double r, int k) { return r == 0 ? 0 : std::max(std::scalbn(r, k), 1e-300); }

    // The same ball, or a larger one, with the exponent `at`.
    Ball moved(int at) const {
        Ball b;
        b.e = at;
        b.r = scaled(r, e - at);
        if (e >= at) {
            b.m = shifted_left(m, e - at);
        } else if (m.sign() != 0) {
            const bool exact = trailing_zeros(m) >= at - e;
            b.m = shifted_right(m, at - e);
            if (!exact) b.r = up(b.r + 1);
        }
        return b;
    }
    // The same ball without the zeros at the end of m.
    void strip() {
        if (const int zeros = trailing_zeros(m); zeros > 0) *this = moved(e + zeros);
        if (m.sign() == 0 && r == 0) e = 0;
    }
    // At most kDigits digits, and none far below the radius (which keeps radii inside the range of double).
    Ball rounded() const {
        const int n = bit_length(m), more = std::isfinite(r) && r >= 0x1p64 ? std::ilogb(r) - 32 : 0;
        const int cut = std::max(n - kDigits, more);
        return cut <= 0 ? *this : moved(e + cut);
    }
    // The exponent above everything in the ball.
    int top() const { return e + std::max(bit_length(m), r > 0 && std::isfinite(r) ? std::ilogb(r) + 2 : 0); }
    int magnitude() const { return e + bit_length(m); }
    bool is_zero() const { return m.sign() == 0 && r == 0; }

    friend Ball operator+(const Ball& a, const Ball& b) {
        if (a.is_zero()) return b;
        if (b.is_zero()) return a;
        // Digits more than 1000 places below the first are cut off before the sum instead of behind it.
        const int at = std::max(std::min(a.e, b.e), std::max(a.top(), b.top()) - 1000);
        const Ball x = a.moved(at), y = b.moved(at);
        Ball s;
        s.m = x.m + y.m, s.e = at, s.r = up(x.r + y.r);
        return s.rounded();
    }
    friend Ball operator-(Ball a) {
        a.m = negated(a.m);
        return a;
    }
    friend Ball operator-(const Ball& a, const Ball& b) { return a + -b; }
    friend Ball operator*(const Ball& a, const Ball& b) {
        Ball p;
        p.m = a.m * b.m, p.e = a.e + b.e;
        if (a.r != 0 || b.r != 0) p.r = up(size_of(a.m) * b.r + size_of(b.m) * a.r + a.r * b.r);
        return p.rounded();
    }
    // A radius that is not finite where b may be 0.
    friend Ball operator/(const Ball& a, const Ball& b) {
        Ball q;
        const double least = (size_of(b.m) * (1 - 0x1p-40) - b.r) * (1 - 0x1p-40);
        if (!(least > 0)) {
            q.r = HUGE_VAL;
            return q;
        }
        // kDigits digits of the quotient, but none far below what the radius of a leaves.
        int k = kDigits + bit_length(b.m) - bit_length(a.m);
        if (a.r > 0 && std::isfinite(a.r)) k = std::min(k, bit_length(b.m) + 64 - std::ilogb(a.r));
        k = std::max(k, 0);
        const Division d = divided(shifted_left(a.m, k), b.m);
        q.m = d.quotient, q.e = a.e - b.e - k;
        // |A/B - a/b| <= (|A - a| + |a/b| |B - b|) / |B|; the quotient cut off is below |a/b| by less than 1.
        if (a.r != 0 || b.r != 0) q.r = up((scaled(a.r, k) + (size_of(q.m) + 1) * b.r) / least);
        if (d.remainder.sign() != 0)
            q.r = up(q.r + 1);
        else if (q.r == 0)
            q.strip();
        return q.rounded();
    }

    // The double next to the middle (0 where the ball contains 0), and a bound of its distance from the
    // number meant.
    std::optional<Bounded> to_double() const {
        if (!(r < 1e300)) return std::nullopt;
        const auto near = [](const Ball& b) {
            const Leading l = leading(b.m);
            return std::scalbn(l.fraction, l.exponent + b.e);
        };
        double x = near(*this);
        if (!std::isfinite(x)) return std::nullopt;
        if (r > 0 && size_of(m) <= r) return Bounded{0, up(scaled(up(size_of(m) + r), e))};
        Ball middle = *this;
        middle.r = 0;
        x += near(middle - Ball(x));
        const Ball rest = middle - Ball(x);
        const double tiny = rest.m.sign() != 0 ? 0x1p-1074 : 0;  // near(rest) may underflow
        const double bound = up(std::abs(near(rest)) + scaled(r, e) + scaled(rest.r, rest.e)) + tiny;
        if (!std::isfinite(x) || !std::isfinite(bound)) return std::nullopt;
        return Bounded{x, bound};
    }
};

}  // namespace freiform::detail
