// The real roots of a polynomial in Bernstein form: all of them, with their number proven.
//
//     p(t) = sum_i c_i C(n, i) t^i (1 - t)^(n - i),   0 <= t <= 1
//
// Coefficients that are doubles are exact numbers, and so is the answer: what double precision does not
// decide, double-double and then integers do. Coefficients that come out of a computation are known up to an
// `error`; then the answer holds for every polynomial within that distance, and says so where some of them
// have a root and others have none.
//
// Cost: a cubic with one root about 0.3 us; n^2 operations per halving of [0, 1]. A multiple root asks for
// integers: about 15 us for a cubic, milliseconds at degree 25.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>

#include <span>
#include <vector>

namespace freiform {

// Highest degree that roots are searched for.
inline constexpr int kMaxRootDegree = 100;
// Roots that are closer to each other than this may be reported together.
inline constexpr double kRootResolution = 0x1p-52;

// One root, or roots that were not told apart.
struct Root {
    // lo == hi: the root is this number. Otherwise lo < root < hi if is_one, lo <= roots <= hi if not.
    Interval at;
    int least = 1, most = 1;  // so many roots are in `at`, counted with multiplicity
    // `at` has exactly one root, of multiplicity `most`. False: several, or it is not known.
    bool is_one = true;
    // The sign of p between the root before and this one, and between this one and the next; 0 at the ends
    // 0 and 1, and where no sign is certain.
    int before = 0, after = 0;

    bool is_certain() const { return least > 0; }
    friend bool operator==(const Root&, const Root&) = default;
};

enum class RootsKind {
    isolated,       // `roots` has every root
    zero,           // the polynomial is zero everywhere
    possibly_zero,  // zero is one of the polynomials within `error`
};
enum class Arithmetic { plain, doubled, exact };  // double, double-double, integers

struct RealRoots {
    RootsKind kind = RootsKind::isolated;
    std::vector<Root> roots;                 // in increasing order; no two have an inner point in common
    Arithmetic deepest = Arithmetic::plain;  // what it took
};

// The roots in [0, 1] of the polynomial with these Bernstein coefficients, each of which is off by at most
// `error`. Of exact coefficients (error 0), least == most always, a Root with is_one is at most `width` wide
// (>= 0; 0: neighbouring doubles) and one without is at most kRootResolution wide. Otherwise intervals are as
// wide as the error demands. Refuses numbers that are not finite, a negative width or error, no coefficients,
// and degrees above kMaxRootDegree.
//   const auto found = real_roots(std::array{-1.0, 0.5, 2.0}, 1e-12);
Result<RealRoots> real_roots(std::span<const double> coefficients, double width, double error = 0);

// The same for coefficients that are sums of `terms` doubles each, as exact products and scalar products are:
// coefficient i is parts[i terms] + .. + parts[i terms + terms - 1].
Result<RealRoots> real_roots_of_sums(std::span<const double> parts, int terms, double width);

}  // namespace freiform
