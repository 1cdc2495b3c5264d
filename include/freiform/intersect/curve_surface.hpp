// Where a curve or a line meets a surface: every place, none missed.
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

// All (t, u, v) with C(t) = S(u, v). Outside the boxes of the contacts and of what is undecided there is
// none, and that is proven, rounding included.
//
// Where the curve goes through the surface at an angle, the answer is one proven root. Where it touches, and
// where it passes within rounding of an end or of the boundary, the answer is `possible` or `end` with
// least = 0 and a `gap`. A curve that runs in the surface is `undecided` or `possible` there, box by box.
// Refuses accuracies that are negative or NaN.
//   const auto found = intersect(curve, surface);   // found->contacts[0].at: t, u, v
template <class P>
requires(Space<P>::kDim == 3) Result<Intersections<3, 3>> intersect(const Curve<P>& curve,
                                                                    const Surface<P>& surface,
                                                                    const IntersectOptions& options = {});

struct StraightLine {
    Vec<3> point, direction;
    Interval on{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
};

// Refuses lines that are not finite, whose direction is zero, and intervals without length, as lines[i].
Result<void> check_line(const StraightLine& line, std::size_t i);

// A surface ready to be met by many lines, rays (on.lo = 0) and segments: point + t direction, t in `on`.
template <class P>
class IntersectSurface {
public:
    explicit IntersectSurface(const Surface<P>& surface);
    // at[0] is t. The line is cut where it leaves the box of the control points; the two ends are rounded, so
    // that the answer is that of a line within a few units in the last place. Refuses lines that are not
    // finite, whose direction is zero, and intervals without length; in parallel, of the first such line.
    // REQUIRES spans of one size.
    Result<void> intersect(std::span<const StraightLine> lines, std::span<Intersections<3, 3>> out,
                           const IntersectOptions& options = {}) const;
    Result<Intersections<3, 3>> intersect(const StraightLine& line,
                                          const IntersectOptions& options = {}) const;

private:
    std::shared_ptr<const detail::ArcPieces<2, P>> pieces_;
};

}  // namespace freiform
