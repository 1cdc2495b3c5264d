// The neighbour of a surface: rows of control points that join along an edge with C^k or G^k.
//
// Of a neighbour of degree n across whose edge is clamped, the first k + 1 rows are determined, the others
// are free. C^k is the construction for curves (joint.hpp) on every column. For G^k the neighbour continues
// the surface with another parameter,
//     next(u, t) = s(u, t) previous(a(u, t), t + b(u, t)),    a = a1 u + a2 u^2 / 2 + ..,  a1 > 0
// (u from 0 on, away from the edge; previous(0, t) is the edge, its first parameter running outwards), so
//     next_u = a1 previous_u + b1 previous_t,
//     next_uu = a1^2 previous_uu + 2 a1 b1 previous_ut + b1^2 previous_tt + a2 previous_u + b2 previous_t,
// and so on. a1, a2, b1, b2 are functions of t, the shape functions. s is for rational surfaces, in
// homogeneous coordinates, and changes no point; it frees the weights of the rows.
#pragma once
#include <freiform/make/joint.hpp>
#include <freiform/spline/edge.hpp>

namespace freiform {

// A polynomial along the edge: its Bernstein coefficients over the domain, in the direction of the edge of
// the surface that is continued. {c}: constant; {c, d}: linear from c to d; {}: zero.
using ShapeFunction = std::vector<double>;

// of[j - 1] belongs to u^j / j!. The order k is across.size(); `along` and `scale` may be shorter (zero),
// `scale` is for rational surfaces. across[0] has positive coefficients. All {c} and {}: the neighbour has
// the degree of the surface along the edge; a linear across[0] raises it by 1, a linear along[0] does not.
struct ShapeFunctions {
    std::vector<ShapeFunction> across, along = {}, scale = {};

    // C^k: u as it is.
    static ShapeFunctions parametric(int order);
};

// A new neighbour of Bezier form across.
template <class P>
struct NextRows {
    Interval on{0, 1};  // its parameters across
    Net<2, P> free{};   // [row][column]: its rows after the first k + 1; so its degree is k + rows
};

// The basis along the edge of the neighbour: free rows have basis.size() columns. With C^k that of the
// surface. With G^k and shape functions that are not constant, or `along`, breaks have the multiplicities
// that keep what the surface leaves: derivatives along it take k orders of continuity. Refuses (no_answer)
// surfaces whose breaks have none to take, and (unsupported) degrees beyond kMaxDegree.
template <class P>
Result<BSplineBasis> next_basis(const Surface<P>& previous, SurfaceEdge edge, const ShapeFunctions& shape);

// The neighbour: parameter 0 across, starting at the edge; parameter 1 along, as the surface has it. Every
// determined coefficient is the exact one rounded once. Refuses what cannot be, by name: edges on closed
// axes, (next_g) edges that are closed themselves, orders and degrees outside 0..kMaxDegree, free rows of
// another size, and (no_answer) rows whose weights would not be positive.
//   auto b = next_c(a, {0, End::end}, 1, NextRows<Vec<3>>{{0, 1}, rows});
//   auto b = next_g(a, {0, End::end}, {{{1, 2}}, {{0.5}}}, NextRows<Vec<3>>{{0, 1}, rows});
template <class P>
Result<Surface<P>> next_c(const Surface<P>& previous, SurfaceEdge edge, int order, const NextRows<P>& next);
template <class P>
Result<Surface<P>> next_g(const Surface<P>& previous, SurfaceEdge edge, const ShapeFunctions& shape,
                          const NextRows<P>& next);

// An existing neighbour with its first k + 1 rows replaced, so that it joins `previous`; the other rows stay.
// Its degree along the edge is raised and knots are inserted there where that is needed. `against`: its edge
// runs against that of `previous`. Refuses neighbours whose degree across is below k or whose edge is not
// clamped (restrict_to clamps), and what next_g refuses.
//   auto smooth = rejoined(a, {0, End::end}, b, {0, End::start}, false, ShapeFunctions::parametric(1));
template <class P>
Result<Surface<P>> rejoined(const Surface<P>& previous, SurfaceEdge edge, const Surface<P>& neighbour,
                            SurfaceEdge neighbour_edge, bool against, const ShapeFunctions& shape);

}  // namespace freiform
