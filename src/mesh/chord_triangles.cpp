// How fine edges have to be for the triangles beside them.
//
// A triangle with the chord as longest side has error at most Q(p(b) - p(a)) / 6 (curvature_tree.cpp: R^2 <=
// longest^2 / 3), or Q / 8 where the surface is curved in one parameter direction only (all such triangles
// are obtuse or right, in the metric of their error). Where triangles find their feet what is seen along
// normals counts instead (bending.cpp), and Q / 7 for developable surfaces, whose triangles reach from one
// edge to another with points that are not opposite each other. This is no part of a bound: the face is
// meshed by bounds of its own, and where it does not come within the tolerance, its edges are made finer
// (EdgeMesher::be_wary in the tessellation of models).
#include "curvature_tree_detail.hpp"

#include <freiform/mesh/chord_triangles.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kFoot = 2;        // with how many times the error triangles are to find their feet
constexpr double kFlat = 0x1p-20;  // product of principal curvatures beside the square of the larger

// Wide enough for first derivatives that are more than rounding.
Box<2> widened_zone(const Box<2>& box, const double (&length)[2], const std::array<Interval, 2>& ends) {
    constexpr double kWidth = 1.0 / 16;
    Box<2> wide = box;
    for (int i = 0; i < 2; ++i) {
        const double own = box.side(i).length() * length[i],
                     least = kWidth * box.side(1 - i).length() * length[1 - i];
        if (!(own < least) || !(length[i] > 0)) continue;
        const Interval end = ends[std::size_t(i)];
        const double more = least / length[i];
        wide.lo[i] = std::min(box.lo[i], std::max(box.lo[i] - more, end.lo));
        wide.hi[i] = std::max(box.hi[i], std::min(box.hi[i] + more, end.hi));
    }
    return wide;
}

double along_normals(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const Vec<2>& chord,
                     double all) {
    const auto j = jet<2>(surface.geometry(), {box.side(0).middle(), box.side(1).middle()});
    const auto ends = limits(surface.geometry());
    const Bending b = bending_of(surface, widened_zone(box, {norm(j.d[1]), norm(j.d[2])}, ends), true,
                                 {{j.d[0], j.d[1], j.d[2]}});
    if (!(b.least > 0)) return all;
    const Vec<2> reach = reach_of(b, kFoot * all);
    const Box<2> around{box.lo - reach, box.hi + reach};
    const Box<2> inside{clamped(around.lo, ends), clamped(around.hi, ends)};
    for (int i = 0; i < 2; ++i)
        if (reach[i] > ends[std::size_t(i)].length()) return all;
    const double reflected = inside.lo != around.lo || inside.hi != around.hi ? 3 : 1;
    const auto near = surface({inside.side(0), inside.side(1)});
    const Curvature there{near(2, 0), near(1, 1), near(0, 2)};
    const Shift shift = shift_of(b, all, there, reflected);
    if (!shift_of(b, kFoot * all, there, reflected).exists) return all;
    const double uu = dot(b.n, j(2, 0)) / (b.a * b.a), uv = dot(b.n, j(1, 1)) / (b.a * b.b),
                 vv = dot(b.n, j(0, 2)) / (b.b * b.b);
    const double most = std::max({std::abs(uu), std::abs(uv), std::abs(vv)});
    const bool developable = std::abs(uu * vv - uv * uv) <= kFlat * most * most;
    const double seen = b.seen(shift.turn).along(chord[0], chord[1]) / (developable ? 7 : 6);
    return std::min(all, shift.across(seen, all));
}

}  // namespace

bool sees_normals(const DerivativeQuery<2, 3>& surface) {
    return surface.kinks(0).empty() && surface.kinks(1).empty();
}

double error_beside(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const DerivativeBounds<2>& over,
                    const Vec<2>& chord, double enough, bool wary) {
    const Curvature second{over(2, 0), over(1, 1), over(0, 2)};
    const bool one_way = second.uv == 0 && (second.uu == 0 || second.vv == 0);
    const double all = second.along(chord[0], chord[1]) / (one_way ? 8 : 6) +
                       kink_bound_of(surface.kinks(0), box.side(0)) +
                       kink_bound_of(surface.kinks(1), box.side(1));
    return all <= enough || wary ? all : along_normals(surface, box, chord, all);
}

}  // namespace freiform
