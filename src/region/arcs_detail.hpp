// Segments of paths as the arcs of an arrangement.
#pragma once
#include <freiform/core/hom.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/region/boolean.hpp>

#include <span>

namespace freiform::detail {

// A segment with its coefficients in homogeneous form: as arc_index and intersect take it, these are the
// exact curve. A point of the segment is off from it by at most the rounding of weight * point.
struct RegionArc {
    PathSegment s;
    int operand = 0;
    std::array<std::size_t, 2> place{};  // subpath and segment of its operand
    std::array<double, 4> x{}, y{}, w{};
    Box<2> box;  // contains the exact curve

    bool is_rational() const { return s.degree == 2 && s.weight != 1; }
    std::span<const double> coordinates(const std::array<double, 4>& c) const {
        return std::span(c).first(std::size_t(s.degree) + 1);
    }
    std::span<const double> weights() const {
        return is_rational() ? coordinates(w) : std::span<const double>();
    }
};

// The arcs that bound the regions, each closed subpath a chain of them. What has no length, and the detours
// of segments whose control points lie on one line, bound nothing and are left out. Appends to `out`.
Result<void> add_arcs(const Path& path, int operand, std::vector<RegionArc>& out);
void add_arc(PathSegment s, int operand, const std::array<std::size_t, 2>& place,
             std::vector<RegionArc>& out);
// Pairs of one operand that are the same, one against the other, add nothing to winding numbers, exactly:
// they are taken out.
void cancel_opposite(std::vector<RegionArc>& arcs);
// Control points rounded to multiples of `grid`, a power of two; weights to those of about grid / scale.
PathSegment on_grid(PathSegment s, double grid, double scale);

// The control points in homogeneous form.
std::array<Hom<2>, 4> homogeneous(const PathSegment& s);
Vec<2> point_of(const PathSegment& s, double t);
// A vector along the tangent where that is defined; else zero.
Vec<2> tangent_of(const PathSegment& s, double t);
// The part from t0 to t1 (backwards if t1 < t0), off by at most kPartError times its largest coordinate.
PathSegment part_of(const PathSegment& s, double t0, double t1);
inline constexpr double kPartError = 0x1p-46;
PathSegment reversed(const PathSegment& s);
Box<2> box_of(const PathSegment& s);  // of the control points

// Does the part of the arc over `on` come within `slack` of the box of a and b on both sides of the line ab,
// or near it? No is proven if slack is at least kTouchError times the largest coordinate.
bool may_touch(const RegionArc& arc, Interval on, const Vec<2>& a, const Vec<2>& b, double slack);
inline constexpr double kTouchError = 0x1p-44;

}  // namespace freiform::detail
