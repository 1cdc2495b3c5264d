// The knots that one piece of a spline depends on, seen from one place.
//
// Away from the seam these are the knots themselves. A closed basis stores the knots of one period unwound on
// both sides, and unwinding rounds: so on the two sides of the seam the same knots have slightly different
// distances from it, and a spline that is smooth there by construction would seem to have jumps. Therefore at
// the seam every knot is taken where it was given, inside the period, and measured from the end of the domain
// that it lies next to; the difference is a `Bounded`, mostly exact.
#pragma once
#include <freiform/basis/bspline.hpp>
#include <freiform/core/bounded.hpp>

#include <vector>

namespace freiform::detail {

// The span that ends at `at`: of two that meet there the lower one.
inline int span_before(const BSplineBasis& basis, double at) {
    int s = basis.span(at);
    while (s > basis.degree() && basis.knot(s) >= at) --s;
    return s;
}

// Models what weights_in_span asks of a basis, for the span it was made for.
class KnotWindow {
public:
    // Of the span at the parameter `at`; at the seam of a closed basis `at` is the lower or upper end.
    KnotWindow(const BSplineBasis& basis, int span, double at, bool seam)
        : degree_(basis.degree()), first_(span - basis.degree() + 1), at_(seam ? 0 : at) {
        for (int i = first_; i <= span + degree_; ++i)
            knots_.push_back(seam ? from_seam(basis, i, at == basis.domain().hi) : Bounded(basis.knot(i)));
    }
    int degree() const { return degree_; }
    const Bounded& knot(int i) const { return knots_[std::size_t(i - first_)]; }
    Bounded at() const { return at_; }  // the parameter, in the coordinate of the knots

private:
    // The distance of knot i from the seam, which is at the upper end of the domain or at the lower one.
    static Bounded from_seam(const BSplineBasis& basis, int i, bool upper) {
        const auto [lo, hi] = basis.domain();
        const int begin = basis.degree(), end = begin + basis.size();
        int turns = 0;  // of the seam from the lower end of the period that the knot is found in
        for (; i > end; ++turns) i -= basis.size();
        for (; i < begin; --turns) i += basis.size();
        if (upper) --turns;
        const Bounded period = Bounded(hi) - Bounded(lo);
        // From the nearer end: one turn less is the distance from the upper end.
        return turns < 0 ? Bounded(basis.knot(i)) - Bounded(hi) + Bounded(turns + 1) * period
                         : Bounded(basis.knot(i)) - Bounded(lo) + Bounded(turns) * period;
    }

    int degree_, first_;
    Bounded at_;
    std::vector<Bounded> knots_;
};

}  // namespace freiform::detail
