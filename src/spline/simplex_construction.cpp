// Accuracy of the construction. Exact points x = y + e, |e| <= E, become t1 x_1 + t2 x_2 + t3 x_3; what is
// computed suffers three roundings of each term (a product, two sums), and t1, which is computed from u and
// v, is off by at most u (|1 - u| + |t1|), or by u where a sum u + v was rounded to 1 (simplex.cpp). So E
// grows to s E + 3 u s |y| + u (1 + |1 - u| + |t1|) |y| with s = |t1| + |t2| + |t3|, u = 2^-53. One factor
// for the higher powers and the roundings of the bound itself; products that underflow lose three denormal
// numbers.
//
// Blossoms: a step of the construction for each argument, each with its own barycentric coordinates.
// References: [Ramshaw 1989], [Farin 1986].
#include <freiform/core/constants.hpp>
#include <freiform/spline/simplex_construction.hpp>

#include <cmath>

namespace freiform {

namespace {

// In place: the net of degree m becomes one of degree m - 1. Coordinates one after the other, so this is
// compiled once for all kinds of points.
void step(double* b, int coords, int m, const std::array<double, 3>& t) {
    const double* next = b + coords;  // row r + 1
    for (int r = 0; r < m; ++r, next += coords)
        for (int k = 0; k <= r; ++k)
            for (int c = 0; c < coords; ++c, ++b, ++next)
                *b = t[0] * *b + t[1] * next[0] + t[2] * next[coords];
}

double largest(const double* b, std::size_t count) {
    double size = 0;
    for (std::size_t i = 0; i < count; ++i)
        size = b[i] - b[i] == 0 ? std::max(size, std::abs(b[i])) : std::numeric_limits<double>::infinity();
    return size;
}

double grown(double bound, double size, const Param<2>& u, const std::array<double, 3>& t) {
    const double s = std::max(1.0, std::abs(t[0]) + std::abs(t[1]) + std::abs(t[2]));
    const double moved = 1 + std::abs(1 - u[0]) + std::abs(t[0]);
    return (s * bound + kUnitRoundoff * (3 * s + moved) * size) * (1 + 16 * kUnitRoundoff) +
           4 * std::numeric_limits<double>::denorm_min();
}

template <class P>
std::vector<double> numbers_of(std::span<const P> b) {
    std::vector<double> out;
    out.reserve(b.size() * std::size_t(P::kCoords));
    for (const P& p : b) out.insert(out.end(), p.c.begin(), p.c.end());
    return out;
}
template <class P>
void append(std::vector<P>& to, const double* from, std::size_t points) {
    for (std::size_t i = 0; i < points; ++i) {
        P p;
        for (int c = 0; c < P::kCoords; ++c) p[c] = *from++;
        to.push_back(p);
    }
}

}  // namespace

template <Coefficient P>
Result<TriangleConstruction<P>> de_casteljau(const SimplexPatch<2, P>& s, const Param<2>& u) {
    if (!std::isfinite(u[0]) || !std::isfinite(u[1]))
        return refuse(RefusalKind::nonfinite, "at", text("(", u[0], ", ", u[1], ") is not finite"));
    TriangleConstruction<P> c(s.degree(), u);
    const auto t = s.barycentric(u);
    std::vector<double> b = numbers_of(s.coefficients());
    c.points_.assign(s.coefficients().begin(), s.coefficients().end());
    for (int m = s.degree(); m > 0; --m) {
        const std::size_t now = std::size_t((m + 1) * (m + 2) / 2), next = std::size_t(m * (m + 1) / 2);
        const double size = largest(b.data(), now * std::size_t(P::kCoords));
        step(b.data(), P::kCoords, m, t);
        c.bound_ = grown(c.bound_, size, u, t);
        append(c.points_, b.data(), next);
    }
    if (!std::isfinite(c.bound_) || !is_finite(c.point()))
        return refuse(RefusalKind::ill_conditioned, "at",
                      text("the construction at (", u[0], ", ", u[1], ") leaves the range of double"));
    return c;
}

template <Coefficient P>
P blossom(const SimplexPatch<2, P>& s, std::span<const Param<2>> arguments) {
    FF_REQUIRE(int(arguments.size()) == s.degree());
    std::vector<double> b = numbers_of(s.coefficients());
    int m = s.degree();
    for (const Param<2>& u : arguments) step(b.data(), P::kCoords, m--, s.barycentric(u));
    P out;
    for (int c = 0; c < P::kCoords; ++c) out[c] = b[std::size_t(c)];
    return out;
}

#define FF_SIMPLEX_CONSTRUCTION(P)                                                                     \
    template Result<TriangleConstruction<P>> de_casteljau(const SimplexPatch<2, P>&, const Param<2>&); \
    template P blossom(const SimplexPatch<2, P>&, std::span<const Param<2>>);
FF_SIMPLEX_CONSTRUCTION(Vec<1>)
FF_SIMPLEX_CONSTRUCTION(Vec<2>)
FF_SIMPLEX_CONSTRUCTION(Vec<3>)
FF_SIMPLEX_CONSTRUCTION(Vec<4>)
FF_SIMPLEX_CONSTRUCTION(Hom<1>)
FF_SIMPLEX_CONSTRUCTION(Hom<2>)
FF_SIMPLEX_CONSTRUCTION(Hom<3>)
FF_SIMPLEX_CONSTRUCTION(Hom<4>)
#undef FF_SIMPLEX_CONSTRUCTION

}  // namespace freiform
