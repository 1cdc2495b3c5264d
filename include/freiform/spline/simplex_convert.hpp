// Triangles to tensor patches and back, halves, fewer degrees: every result with a bound.
#pragma once
#include <freiform/spline/simplex.hpp>

namespace freiform {

// `bound`: no point of the parts is farther from the point of the given patch at the same place of its
// domain; what rounding moved.
template <class S, std::size_t Count>
struct Parts {
    std::array<S, Count> parts;
    double bound = 0;
};

// The same surface of degree n x n over (u, v), at the place (1 - u, u (1 - v), u v) of the triangle: the
// side u = 0 is corner 1, a pole; the sides v = 0, u = 1, v = 1 are the edges 2, 0, 1 with their coefficients
// to the bit.
template <class P>
Parts<Surface<P>, 1> to_surface(const SimplexPatch<2, P>& s);

// Three patches of degree n x n without poles, around a point of the inside. Patch i has corner i + 1 at
// (0, 0), the middle of the edge to the next corner at (1, 0), `centre` at (1, 1), the middle of the edge to
// the one before at (0, 1); on it the place in the triangle is bilinear [Hu 1996]. Neighbours have the same
// coefficients along the side between them. Refuses centres that are not inside.
template <class P>
Result<Parts<Surface<P>, 3>> to_three_surfaces(const SimplexPatch<2, P>& s,
                                               const Param<2>& centre = {1.0 / 3, 1.0 / 3});

// A patch of degree m x n, cut along the diagonal from (1, 0) to (0, 1), as two triangles of degree m + n:
// the corners 1, 2, 3 are (0, 0), (1, 0), (0, 1) and (1, 1), (0, 1), (1, 0) [Goldman & Filip 1987]. They have
// the same coefficients along the diagonal. Refuses m + n > kMaxDegree.
template <class P>
Result<Parts<SimplexPatch<2, P>, 2>> to_triangles(const Surface<P, Bernstein>& s);

// The same patch with weights 1, exact.
template <int D>
SimplexPatch<2, Hom<D>> to_rational(const SimplexPatch<2, Vec<D>>& s) {
    std::vector<Hom<D>> net;
    for (const Vec<D>& x : s.coefficients()) net.push_back(weighted(x, 1.0));
    return SimplexPatch<2, Hom<D>>::trusted(s.degree(), std::move(net));
}

// restrict_to for corners in barycentric coordinates, which add up to 1 as far as doubles do.
template <class P>
SimplexPatch<2, P> restrict_to(const SimplexPatch<2, P>& s,
                               const std::array<std::array<double, 3>, 3>& corners);

// The two parts on the sides of the line from the corner opposite of `edge` (0, 1, 2) to the place `at` in
// (0, 1) of that edge. The first keeps the corner where the edge begins. REQUIRES at inside.
template <class P>
std::array<SimplexPatch<2, P>, 2> split_edge(const SimplexPatch<2, P>& s, int edge, double at) {
    const std::size_t from = std::size_t((edge + 1) % 3), to = std::size_t((edge + 2) % 3);
    std::array<std::array<double, 3>, 3> low{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, high = low;
    std::array<double, 3> cut{};
    cut[from] = 1 - at, cut[to] = at;
    low[to] = cut, high[from] = cut;
    return {restrict_to(s, low), restrict_to(s, high)};
}

// The same triangle with corners 2 and 3 exchanged: the normal turns over.
template <class P>
SimplexPatch<2, P> reversed(const SimplexPatch<2, P>& s) {
    std::vector<P> b;
    for (int row = 0; row <= s.degree(); ++row)
        for (int k = 0; k <= row; ++k) b.push_back(s.coefficient(k, row - k));
    return SimplexPatch<2, P>::trusted(s.degree(), std::move(b));
}

template <class P>
struct ReducedTriangle {
    SimplexPatch<2, P> patch;
    double bound = 0;  // no point is farther from the given patch at the same parameters
};
// The degree less one, as near as least squares of the coefficients make it; corners stay to the bit. Undoes
// an elevation. Refuses with no_answer, and the distance that was reached, where the tolerance (a distance in
// model units) does not allow it, and degree 0 and 1.
template <class P>
Result<ReducedTriangle<P>> reduce_degree(const SimplexPatch<2, P>& s, double tolerance);

}  // namespace freiform
