// Dyadic numbers on top of integers of any length. Accuracy: exact by construction; a sum shifts the operand
// with the higher exponent to the left, so its cost grows with the distance of exponents.
#include <freiform/poly/exact.hpp>
#include <freiform/poly/integer.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::Integer;

}  // namespace

Exact::Exact(double x) {
    if (x == 0) return;
    const detail::Parts parts = detail::parts_of(x);
    Integer m = detail::integer(parts.m);
    negative_ = m.negative, exponent_ = parts.exponent, limb_ = std::move(m.limb);
}

double Exact::rounded() const {
    const detail::Leading f = detail::leading({negative_, limb_});
    return std::scalbn(f.fraction, f.exponent + exponent_);
}

int Exact::exponent() const {
    return limb_.empty() ? 0 : detail::leading({negative_, limb_}).exponent + exponent_;
}

Exact Exact::scaled(int e) const {
    Exact r = *this;
    if (!limb_.empty()) r.exponent_ += e;
    return r;
}

Exact operator+(const Exact& a, const Exact& b) {
    if (a.limb_.empty()) return b;
    if (b.limb_.empty()) return a;
    const int e = std::min(a.exponent_, b.exponent_);
    const Integer x{a.negative_, a.limb_}, y{b.negative_, b.limb_};
    Integer s = (a.exponent_ > e ? detail::shifted_left(x, a.exponent_ - e) : x) +
                (b.exponent_ > e ? detail::shifted_left(y, b.exponent_ - e) : y);
    Exact r;
    r.negative_ = s.negative, r.exponent_ = e, r.limb_ = std::move(s.limb);
    return r;
}

Exact operator-(const Exact& a, const Exact& b) {
    Exact c = b;
    c.negative_ = !c.negative_ && !c.limb_.empty();
    return a + c;
}

Exact operator*(const Exact& a, const Exact& b) {
    if (a.limb_.empty() || b.limb_.empty()) return {};
    Integer p = Integer{a.negative_, a.limb_} * Integer{b.negative_, b.limb_};
    Exact r;
    r.negative_ = p.negative, r.exponent_ = a.exponent_ + b.exponent_, r.limb_ = std::move(p.limb);
    return r;
}

}  // namespace freiform
