// The last stage of the root finder: integers. See roots.cpp for the whole.
//
// Idea. Descartes' rule with halving ends if no root is multiple. So multiple roots are divided out first, by
// greatest common divisors of the polynomial with its derivative.
//
// Notation. p = sum s_i t^i (1 - t)^(n-i), s_i = C(n, i) c_i, is (1 - t)^n P(x), P(x) = sum s_i x^i, with
// x = t / (1 - t). Roots in 0 < t < 1 are the positive roots of P, with their multiplicities, so division is
// done on power coefficients s, halving on Bernstein coefficients c.
//
// Method. G_0 = P, G_k = gcd(G_{k-1}, G_{k-1}'), S_k = G_{k-1} / G_k: S_k has as simple roots those of P of
// multiplicity k or more [Yun 1976]. Whether G_1 = 1 is asked first modulo a prime: if the gcd is 1 there,
// and the prime divides no leading coefficient, it is 1. Otherwise the primitive remainder sequence gives it
// [Knuth 1997, 4.6.1].
//   A cell is halved, all S_k together, until S_1 has at most one sign variation V there. V(S_1) = 1 is
// exactly one root inside, V = 0 none (Descartes; zero coefficients are left out). The multiplicity of the
// root is the number of k for which V(S_k) is odd, since V and the number of roots differ by an even number
// and S_k has at most the one root. A root on a common end of two cells is a zero first or last coefficient.
//   Cells of depth 52 that still have several roots are reported as one, but halved on in order to count.
//
// Cost. m adds of integers of L + n depth bits, m = n^2 / 2, per halving; remainder sequences n^2 products of
// integers that grow to 2 n L bits.
#include "poly/roots_detail.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace freiform::detail {

using Coefficients = IntegerPolynomial;

void trim(Coefficients& a) {
    while (!a.empty() && a.back().sign() == 0) a.pop_back();
}

void make_primitive(Coefficients& a) {
    Integer g;
    const Integer one = integer(1);
    for (const Integer& x : a) {
        g = gcd(x, g);
        if (g == one) return;
    }
    if (g.sign() == 0) return;
    for (Integer& x : a) x = divided(x, g).quotient;
}

Coefficients derivative_of(const Coefficients& a) {
    Coefficients d;
    for (std::size_t i = 1; i < a.size(); ++i) d.push_back(a[i] * integer(std::int64_t(i)));
    return d;
}

namespace {

Coefficients binomials(int n) {
    Coefficients row(std::size_t(n) + 1, integer(1));
    for (int i = 1; i <= n; ++i)
        row[std::size_t(i)] = divided(row[std::size_t(i) - 1] * integer(n - i + 1), integer(i)).quotient;
    return row;
}

}  // namespace

Coefficients to_power(const Coefficients& c) {
    const Coefficients row = binomials(int(c.size()) - 1);
    Coefficients s(c.size());
    for (std::size_t i = 0; i < c.size(); ++i) s[i] = c[i] * row[i];
    return s;
}

namespace {

constexpr int kExactDepth = 52;  // of cells that are told apart
constexpr int kDeepest =
    20000;  // halvings while counting, a backstop: the distance of roots is bounded below

// Without the common power of two: all that costs nothing.
void remove_twos(Coefficients& a) {
    int zeros = 0x7fffffff;
    for (const Integer& x : a)
        if (x.sign() != 0) zeros = std::min(zeros, trailing_zeros(x));
    if (zeros == 0 || zeros == 0x7fffffff) return;
    for (Integer& x : a) x = shifted_right(x, zeros);
}

// lc(b)^k a mod b, for some k.
Coefficients pseudo_remainder(Coefficients a, const Coefficients& b) {
    while (a.size() >= b.size()) {
        const Integer lead = a.back();
        const std::size_t shift = a.size() - b.size();
        for (Integer& x : a) x = x * b.back();
        for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] = a[i + shift] - lead * b[i];
        trim(a);
    }
    return a;
}

// Of primitive a, b: primitive.
Coefficients polynomial_gcd(Coefficients a, Coefficients b) {
    if (a.size() < b.size()) std::swap(a, b);
    while (!b.empty()) {
        Coefficients r = pseudo_remainder(std::move(a), b);
        make_primitive(r);
        a = std::move(b);
        b = std::move(r);
    }
    return a;
}

// a / b where b divides a.
Coefficients exact_quotient(Coefficients a, const Coefficients& b) {
    Coefficients q(a.size() - b.size() + 1);
    for (std::size_t k = q.size(); k-- > 0;) {
        q[k] = divided(a[k + b.size() - 1], b.back()).quotient;
        for (std::size_t i = 0; i < b.size(); ++i) a[k + i] = a[k + i] - q[k] * b[i];
    }
    return q;
}

// --- modulo a prime ----------------------------------------------------------------------------------------

constexpr std::uint32_t kPrime = 2147483647;  // 2^31 - 1

std::uint32_t power_mod(std::uint64_t a, std::uint32_t e) {
    std::uint64_t r = 1;
    for (; e > 0; e >>= 1, a = a * a % kPrime)
        if (e & 1) r = r * a % kPrime;
    return std::uint32_t(r);
}

// True: proven to have no multiple roots, complex ones included.
bool is_square_free(const Coefficients& p) {
    std::vector<std::uint64_t> a, b;
    for (const Integer& x : p) a.push_back(residue(x, kPrime));
    if (a.back() == 0 || a.size() < 2) return a.size() < 2;
    for (std::size_t i = 1; i < a.size(); ++i) b.push_back(a[i] * i % kPrime);
    while (!b.empty()) {
        const std::uint64_t inverse = power_mod(b.back(), kPrime - 2);
        while (a.size() >= b.size()) {
            const std::uint64_t f = a.back() * inverse % kPrime;
            const std::size_t shift = a.size() - b.size();
            for (std::size_t i = 0; i < b.size(); ++i)
                a[i + shift] = (a[i + shift] + (kPrime - f) * b[i]) % kPrime;
            while (!a.empty() && a.back() == 0) a.pop_back();
        }
        std::swap(a, b);
    }
    return a.size() == 1;
}

// --- between Bernstein and power coefficients --------------------------------------------------------------

// Up to a positive factor.
Coefficients to_bernstein(const Coefficients& s) {
    const Coefficients row = binomials(int(s.size()) - 1);
    Integer common = integer(1);
    for (const Integer& b : row) common = common * divided(b, gcd(common, b)).quotient;
    Coefficients c(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) c[i] = s[i] * divided(common, row[i]).quotient;
    remove_twos(c);
    return c;
}

// --- cells -------------------------------------------------------------------------------------------------

int variations(const Coefficients& c) {
    int last = 0, count = 0;
    for (const Integer& x : c) {
        const int s = x.sign();
        if (s != 0 && last != 0 && s != last) ++count;
        if (s != 0) last = s;
    }
    return count;
}

// The part of c on [0, x] (first) and [x, 1], x = a / (a + b), up to positive factors.
std::pair<Coefficients, Coefficients> split(Coefficients c, const Integer& a, const Integer& b) {
    const std::size_t n = c.size() - 1;
    const Integer whole = a + b;
    Coefficients left(n + 1);
    left[0] = c[0];
    for (std::size_t r = 1; r <= n; ++r) {
        for (std::size_t i = 0; i + r <= n; ++i) c[i] = b * c[i] + a * c[i + 1];
        left[r] = c[0];
    }
    Integer factor = integer(1);  // left[r] and c[n - r] carry whole^r
    for (std::size_t r = n + 1; r-- > 0;) {
        left[r] = left[r] * factor;
        c[n - r] = c[n - r] * factor;
        factor = factor * whole;
    }
    remove_twos(left);
    remove_twos(c);
    return {std::move(left), std::move(c)};
}
std::pair<Coefficients, Coefficients> halved(Coefficients c) {
    const std::size_t n = c.size() - 1;
    Coefficients left(n + 1);
    left[0] = shifted_left(c[0], int(n));
    for (std::size_t r = 1; r <= n; ++r) {
        for (std::size_t i = 0; i + r <= n; ++i) c[i] = c[i] + c[i + 1];
        left[r] = shifted_left(c[0], int(n - r));
    }
    for (std::size_t i = 0; i <= n; ++i) c[i] = shifted_left(c[i], int(i));
    remove_twos(left);
    remove_twos(c);
    return {std::move(left), std::move(c)};
}

// Some S_1, S_2, .. over one cell.
struct Part {
    std::vector<Coefficients> chain;
    Cell cell;
};

Part on_cell(const std::vector<Coefficients>& chain, const Cell& at) {
    Part part{chain, at};
    const long long whole = 1ll << at.depth;
    for (Coefficients& c : part.chain) {
        if (at.cell > 0) c = split(std::move(c), integer(at.cell), integer(whole - at.cell)).second;
        if (at.cell + 1 < whole) c = split(std::move(c), integer(1), integer(whole - at.cell - 1)).first;
    }
    return part;
}

// Of the one root of S_1 inside the part.
int multiplicity_inside(const Part& part) {
    int m = 0;
    for (const Coefficients& c : part.chain) m += variations(c) % 2;
    return m;
}
// Of the right end: 0 if it is no root.
int multiplicity_at_end(const Part& part) {
    int m = 0;
    for (const Coefficients& c : part.chain) m += c.back().sign() == 0;
    return m;
}

std::pair<Part, Part> halved(const Part& part) {
    std::pair<Part, Part> two;
    // Cells below kExactDepth are only counted; their place is no longer written down.
    const bool deep = part.cell.depth >= kExactDepth;
    two.first.cell = {deep ? 0 : 2 * part.cell.cell, part.cell.depth + 1};
    two.second.cell = {deep ? 0 : 2 * part.cell.cell + 1, part.cell.depth + 1};
    for (const Coefficients& c : part.chain) {
        auto [left, right] = halved(Coefficients(c));
        two.first.chain.push_back(std::move(left));
        two.second.chain.push_back(std::move(right));
    }
    return two;
}

struct Count {
    int distinct = 0, least = 0, most = 0;
};
Count counted(Part whole) {
    Count count;
    std::vector<Part> left;
    left.push_back(std::move(whole));
    while (!left.empty()) {
        const Part part = std::move(left.back());
        left.pop_back();
        const int v = variations(part.chain[0]);
        if (v <= 1 || part.cell.depth >= kDeepest) {
            const int inside = v == 1 ? multiplicity_inside(part) : 0;
            const int end = multiplicity_at_end(part);
            count.distinct += v + (end > 0);
            count.least += inside + end;
            count.most += v <= 1 ? inside + end : int(part.chain[0].size());
            continue;
        }
        auto [a, b] = halved(part);
        left.push_back(std::move(b));
        left.push_back(std::move(a));
    }
    return count;
}

// S_1 in doubles, for Newton's method.
struct Doubles {
    std::vector<double> c;
    Approximate approximate() const { return {c, 0x1p-52}; }
};
Doubles in_doubles(const Coefficients& c) {
    int most = 0;
    for (const Integer& x : c) most = std::max(most, bit_length(x));
    Doubles d;
    for (const Integer& x : c) {
        const Leading l = leading(x);
        d.c.push_back(std::scalbn(l.fraction, std::max(l.exponent - most, -2000)));
    }
    return d;
}

double left_end(const Cell& c) { return std::scalbn(double(c.cell), -c.depth); }
double right_end(const Cell& c) { return std::scalbn(double(c.cell + 1), -c.depth); }

// The sign of c right of its left end.
int first_sign(const Coefficients& c) {
    for (const Integer& x : c)
        if (x.sign() != 0) return x.sign();
    return 0;
}

}  // namespace

int ExactSign::operator()(double t) const {
    if (c_.size() == 1) return c_[0].sign();
    if (t <= 0) return c_.front().sign();
    if (t >= 1) return c_.back().sign();
    // t = a / 2^k
    const Parts w = parts_of(t);
    int zeros = 0;
    while (((w.m >> zeros) & 1) == 0) ++zeros;
    const int k = -w.exponent - zeros;
    const Integer a = integer(w.m >> zeros), b = shifted(1, k) - a;
    Coefficients d = c_;
    for (std::size_t r = 1; r < c_.size(); ++r)
        for (std::size_t i = 0; i + r < c_.size(); ++i) d[i] = b * d[i] + a * d[i + 1];
    return d[0].sign();
}

std::vector<Integer> integer_coefficients(std::span<const double> parts, int terms) {
    int least = 5000;
    for (const double x : parts)
        if (x != 0) {
            const Parts w = parts_of(x);
            least = std::min(least, w.exponent);
        }
    Coefficients c(parts.size() / std::size_t(terms));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i] == 0) continue;
        const Parts w = parts_of(parts[i]);
        Integer& sum = c[i / std::size_t(terms)];
        sum = sum + shifted(w.m, w.exponent - least);
    }
    remove_twos(c);
    return c;
}

std::vector<std::vector<Integer>> multiplicity_chain(const std::vector<Integer>& bernstein) {
    Coefficients g = to_power(bernstein);
    if (is_square_free(g)) return {bernstein};
    make_primitive(g);
    std::vector<Coefficients> chain;
    while (g.size() > 1) {
        Coefficients d = derivative_of(g);
        make_primitive(d);
        Coefficients next = polynomial_gcd(g, d);
        chain.push_back(to_bernstein(exact_quotient(std::move(g), next)));
        g = std::move(next);
    }
    return chain;
}

std::vector<Root> exact_roots(const std::vector<Integer>& bernstein, std::span<const Cell> cells,
                              double width) {
    std::vector<Root> roots;
    // Roots at the ends are leading and trailing zeros; to divide by t is to shift power coefficients.
    Coefficients s = to_power(bernstein);
    int at_zero = 0, at_one = 0;
    while (s[std::size_t(at_zero)].sign() == 0) ++at_zero;
    while (s.back().sign() == 0) s.pop_back(), ++at_one;
    s.erase(s.begin(), s.begin() + at_zero);

    const auto chain = multiplicity_chain(at_zero + at_one > 0 ? to_bernstein(s) : bernstein);
    if (!chain.empty()) {
        const ExactSign sign(chain[0]);
        const Doubles doubles = in_doubles(chain[0]);
        for (const Cell& cell : cells) {
            std::vector<Part> left;
            left.push_back(on_cell(chain, cell));
            while (!left.empty()) {
                const Part part = std::move(left.back());
                left.pop_back();
                const int v = variations(part.chain[0]);
                const Interval at{left_end(part.cell), right_end(part.cell)};
                if (v == 1) {
                    const int m = multiplicity_inside(part);
                    // Both ends may be roots, too, of which at.lo belongs to another cell.
                    const int before = first_sign(part.chain[0]);
                    roots.push_back(
                        {refined(doubles.approximate(), &sign, at, before, width), m, m, true, 0, 0});
                } else if (v > 1 && part.cell.depth < kExactDepth) {
                    auto [a, b] = halved(part);
                    left.push_back(std::move(b));
                    left.push_back(std::move(a));
                    continue;
                } else if (v > 1) {
                    const Count n = counted(part);
                    if (n.most > 0) roots.push_back({at, n.least, n.most, n.distinct == 1, 0, 0});
                    continue;
                }
                if (const int m = multiplicity_at_end(part); m > 0)
                    roots.push_back({{at.hi, at.hi}, m, m, true, 0, 0});
            }
        }
    }
    return roots;
}

std::vector<Root> integer_roots(const std::vector<Integer>& bernstein, double width) {
    std::size_t at_zero = 0, at_one = 0;
    while (bernstein[at_zero].sign() == 0) ++at_zero;
    while (bernstein[bernstein.size() - 1 - at_one].sign() == 0) ++at_one;
    std::vector<Root> roots;
    if (at_zero > 0) roots.push_back({{0, 0}, int(at_zero), int(at_zero), true, 0, 0});
    const Cell whole{};
    for (const Root& r : exact_roots(bernstein, std::span(&whole, 1), width)) roots.push_back(r);
    if (at_one > 0) roots.push_back({{1, 1}, int(at_one), int(at_one), true, 0, 0});
    set_signs(roots, bernstein[at_zero].sign());
    return roots;
}

std::vector<Root> common_roots(std::span<const std::vector<Integer>> bernstein, double width) {
    // Roots at 0 and 1 are factors x^i of the power form and its missing degree, so they are set aside.
    Coefficients g;
    std::size_t at_zero = 0, at_one = 0;
    bool first = true;
    for (const auto& c : bernstein) {
        Coefficients s = to_power(c);
        std::size_t lo = 0, hi = 0;
        while (lo < s.size() && s[lo].sign() == 0) ++lo;
        if (lo == s.size()) continue;
        while (s.back().sign() == 0) s.pop_back(), ++hi;
        s.erase(s.begin(), s.begin() + std::ptrdiff_t(lo));
        make_primitive(s);
        at_zero = first ? lo : std::min(at_zero, lo);
        at_one = first ? hi : std::min(at_one, hi);
        g = first ? std::move(s) : polynomial_gcd(std::move(g), std::move(s));
        first = false;
    }
    g.insert(g.begin(), at_zero, Integer{});
    g.insert(g.end(), at_one, Integer{});
    return integer_roots(to_bernstein(g), width);
}

}  // namespace freiform::detail
