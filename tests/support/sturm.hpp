// Roots counted by Sturm's theorem in exact integers: the reference for the root finder.
#pragma once
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <span>
#include <vector>

namespace freiform::test {

// A number of the form m 2^e, and polynomials over the integers with power coefficients.
using Whole = boost::multiprecision::cpp_int;
using Polynomial = std::vector<Whole>;

inline Whole whole_of(double x, int exponent) {  // x 2^-exponent
    if (x == 0) return 0;
    int e = 0;
    const Whole m(static_cast<long long>(std::ldexp(std::frexp(x, &e), 53)));
    return m << (e - 53 - exponent);
}

inline void trim(Polynomial& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}
inline void make_primitive(Polynomial& p) {
    Whole g = 0;
    for (const Whole& x : p) g = gcd(g, x);
    if (g > 1)
        for (Whole& x : p) x /= g;
}

inline Polynomial power_form(Polynomial c) {  // from Bernstein coefficients
    const std::size_t n = c.size() - 1;
    // Coefficient k is C(n, k) times the k-th difference of the c.
    Whole binomial = 1;
    Polynomial p;
    for (std::size_t k = 0; k <= n; ++k) {
        p.push_back(binomial * c[0]);
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] = c[i + 1] - c[i];
        c.pop_back();
        binomial = binomial * (n - k) / (k + 1);
    }
    trim(p);
    return p;
}

// The polynomial in t with these Bernstein coefficients, each a sum of `terms` doubles, times a positive
// factor.
inline Polynomial power_form(std::span<const double> parts, int terms = 1) {
    const std::size_t n = parts.size() / std::size_t(terms) - 1;
    int least = 2000;
    for (const double x : parts)
        if (x != 0) least = std::min(least, std::ilogb(x) - 53);
    Polynomial c(n + 1);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i] != 0) c[i / std::size_t(terms)] += whole_of(parts[i], least);
    return power_form(std::move(c));
}

inline int sign_at(const Polynomial& p, double t) {
    // t = a / 2^k; sum p_i a^i 2^(k (n - i))
    int e = 0;
    std::frexp(t, &e);
    const int k = t == 0 ? 0 : std::max(0, 53 - e);
    const Whole a = whole_of(t, -k);
    Whole sum = 0;
    for (std::size_t i = p.size(), shift = 0; i-- > 0; shift += std::size_t(k))
        sum = sum * a + (p[i] << shift);
    return sum.sign();
}

class Sturm {
public:
    explicit Sturm(Polynomial p) {
        make_primitive(p);
        Polynomial d;
        for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * i);
        chain_.push_back(std::move(p));
        while (!d.empty()) {
            make_primitive(d);
            Polynomial r = chain_.back();
            chain_.push_back(d);
            while (r.size() >= d.size()) {  // by |leading coefficient|, which keeps signs
                const Whole lead = r.back() * d.back().sign(), scale = abs(d.back());
                const std::size_t shift = r.size() - d.size();
                for (Whole& x : r) x *= scale;
                for (std::size_t i = 0; i < d.size(); ++i) r[i + shift] -= lead * d[i];
                trim(r);
            }
            for (Whole& x : r) x = -x;
            d = std::move(r);
        }
    }
    // Distinct roots in (a, b].
    int distinct(double a, double b) const { return variations(a) - variations(b); }
    const Polynomial& greatest_divisor() const { return chain_.back(); }  // of p and p'
    const Polynomial& polynomial() const { return chain_.front(); }

private:
    // At roots of p, those right of t: p itself counts as zero there, as Sturm's theorem wants for (a, b].
    int variations(double t) const {
        int last = 0, count = 0;
        // At a multiple root all members vanish; they are all multiples of the last.
        for (const Polynomial& p : chain_) {
            const int s = sign_at(p, t);
            if (s != 0 && last != 0 && s != last) ++count;
            if (s != 0) last = s;
        }
        return count;
    }
    std::vector<Polynomial> chain_;
};

// All that is asked about a polynomial: roots in (a, b], distinct and with multiplicity.
class RootCount {
public:
    explicit RootCount(Polynomial p) {
        // Members divided by their greatest common divisor, so that multiple roots at the ends are no
        // exception.
        while (p.size() > 1) {
            Sturm s(p);
            Polynomial g = s.greatest_divisor();
            if (g.size() > 1) {
                parts_.emplace_back(quotient(p, g));
                p = std::move(g);
            } else {
                parts_.push_back(std::move(s));
                break;
            }
        }
    }
    int distinct(double a, double b) const { return parts_.empty() ? 0 : parts_[0].distinct(a, b); }
    int with_multiplicity(double a, double b) const {
        int n = 0;
        for (const Sturm& s : parts_) n += s.distinct(a, b);
        return n;
    }
    int multiplicity_at(double t) const {
        int n = 0;
        for (const Sturm& s : parts_) n += sign_at(s.polynomial(), t) == 0;
        return n;
    }

private:
    // a / b up to a factor, where b divides a.
    static Polynomial quotient(Polynomial a, Polynomial b) {
        make_primitive(a);
        make_primitive(b);
        Polynomial q(a.size() - b.size() + 1);
        for (std::size_t k = q.size(); k-- > 0;) {
            q[k] = a[k + b.size() - 1] / b.back();
            for (std::size_t i = 0; i < b.size(); ++i) a[k + i] -= q[k] * b[i];
        }
        return q;
    }
    std::vector<Sturm> parts_;
};

}  // namespace freiform::test
