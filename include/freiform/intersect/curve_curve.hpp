// Where two curves meet: every place, none missed.
#pragma once
#include <freiform/intersect/contact.hpp>
#include <freiform/spline/patch.hpp>

#include <memory>
#include <span>

namespace freiform {

namespace detail {
template <std::size_t N, class P>
struct ArcPieces;
}

// A curve ready to be intersected with others. Immutable, cheap to copy.
template <class P>
class IntersectCurve {
public:
    explicit IntersectCurve(const Curve<P>& curve);
    const detail::ArcPieces<1, P>& pieces() const { return *pieces_; }

private:
    std::shared_ptr<const detail::ArcPieces<1, P>> pieces_;
};

// All pairs of parameters with A(s) = B(t). Outside the boxes of contacts, the overlaps and what is
// undecided there is none, and that is proven, rounding included; beside overlaps, where parts of both curves
// run along each other, it is an estimate.
//
// Plane curves: where they cross at an angle, the answer is one proven root. Where they touch, or run along
// each other, rounding leaves something open; pieces whose coefficients are the given numbers (Bezier
// curves, and splines with inner knots of multiplicity degree) up to a product of degrees of 40 are then
// decided in integers: one proven root with its multiplicity, or none. Otherwise the answer is `possible`.
// Curves in space that are near each other are always decided so, or `possible` with a `gap` that is as small
// as rounding leaves it; multiplicities are those of the image along a coordinate.
//
// Exchanging the curves exchanges the answers and nothing else; coordinates times a power of two change
// nothing but lengths. A curve that is a single point has its whole domain as its box. Refuses accuracies
// that are negative or NaN.
//   const auto found = intersect(a, b);   // found->contacts[0].at
template <class P>
requires(Space<P>::kDim == 2 || Space<P>::kDim == 3) Result < Intersections < Space<P>::kDim,
2 >> intersect(const Curve<P>& a, const Curve<P>& b, const IntersectOptions& options = {});

// Many pairs of prepared curves, in parallel: a[i] with b[i]. REQUIRES spans of one size.
template <class P>
requires(Space<P>::kDim == 2 ||
         Space<P>::kDim == 3) Result<void> intersect(std::span<const IntersectCurve<P>> a,
                                                     std::span<const IntersectCurve<P>> b,
                                                     std::span<Intersections<Space<P>::kDim, 2>> out,
                                                     const IntersectOptions& options = {});

}  // namespace freiform
