// The rows of a neighbour next to its edge, from the surface that it continues.
#pragma once
#include <freiform/core/double_double.hpp>
#include <freiform/make/surface_joint.hpp>
#include <freiform/poly/form.hpp>

namespace freiform::detail {

// Derivatives of a surface out of its edge as polynomials on the pieces of the edge.
struct EdgePieces {
    std::vector<double> breaks;
    std::vector<std::vector<std::vector<Form<DoubleDouble>>>> d;  // [piece][order][coordinate]
    int coordinates = 0;
};
// Orders 0 .. k. REQUIRES an edge: an axis across that is not closed.
template <class P>
EdgePieces edge_pieces(const Surface<P>& s, SurfaceEdge edge, int k);

// Distances of the first `count` knots after the edge of a clamped basis; nothing where it is not clamped
// there.
std::vector<DoubleDouble> knots_after(const BSplineBasis& basis, End end, int count);

// The edge of a net whose rows are to be written: `along` its basis along the edge, n the degree across,
// `after` the k distances of knots.
struct RowTarget {
    SurfaceEdge edge;
    const BSplineBasis& along;
    int degree = 0;
    std::vector<DoubleDouble> after;
    bool against = false;
};
// Writes the first k + 1 rows. Refuses rows that are not finite and weights that are not positive.
template <class P>
Result<void> fill_rows(const EdgePieces& previous, const ShapeFunctions& shape, const RowTarget& target,
                       Net<2, P>& net);

bool is_zero(const ShapeFunction& f);

}  // namespace freiform::detail
