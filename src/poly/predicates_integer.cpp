// The last stage of the predicates: determinants in integers of any length. Slow, and obviously right; it is
// asked only if the exponents of the coordinates are hundreds of powers of two apart. See predicates.cpp.
#include "poly/predicates_detail.hpp"

#include <freiform/poly/integer.hpp>

#include <algorithm>

namespace freiform::detail {

namespace {

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
