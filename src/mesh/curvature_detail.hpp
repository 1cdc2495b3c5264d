// What is known of how a surface bends over a part of the plane: bounds, functions beside it, and what they
// make of the error of triangles.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform {

// Bounds of the second derivatives (of |S_uu|, |S_uv|, |S_vv|, or of a coordinate).
struct Curvature {
    double uu = 0, uv = 0, vv = 0;
    // Of a coordinate: what S_uu and S_vv are at least, if positive; at most, if negative. 0: signs are not
    // known.
    double sure_uu = 0, sure_vv = 0;

    void include(const Curvature& o) {
        uu = std::max(uu, o.uu);
        uv = std::max(uv, o.uv);
        vv = std::max(vv, o.vv);
        sure_uu = nearer(sure_uu, o.sure_uu), sure_vv = nearer(sure_vv, o.sure_vv);
    }
    void restrict_to(const Curvature& o) {
        uu = std::min(uu, o.uu);
        uv = std::min(uv, o.uv);
        vv = std::min(vv, o.vv);
    }
    Curvature plus(double factor, const Curvature& o) const {
        return {uu + factor * o.uu, uv + factor * o.uv, vv + factor * o.vv, less(sure_uu, factor * o.uu),
                less(sure_vv, factor * o.vv)};
    }
    // Nearer to 0 by so much.
    static double less(double sure, double by) {
        return sure > 0 ? std::max(0.0, sure - by) : std::min(0.0, sure + by);
    }
    bool is_saddle() const { return (sure_uu > 0 && sure_vv < 0) || (sure_uu < 0 && sure_vv > 0); }
    // Of a saddle: the interpolation error is at most the larger of uu du^2 / 8 and vv dv^2 / 8 of these
    // (curvature_tree.cpp).
    Curvature apart() const {
        return {uu + uv * (uv / std::abs(sure_vv)), 0, vv + uv * (uv / std::abs(sure_uu))};
    }
    // Bound of the interpolation error in the halves of a box with these sides.
    double error(const Vec<2>& size) const {
        const double together = along(size[0], size[1]) / 8;
        if (!is_saddle()) return together;
        const Curvature a = apart();
        return std::min(together, std::max(a.uu * size[0] * size[0], a.vv * size[1] * size[1]) / 8);
    }
    bool is_finite() const { return std::isfinite(uu + uv + vv); }
    // Bound of |D^2 S (d, d)| for d = (du, dv).
    double along(double du, double dv) const {
        return uu * du * du + 2 * uv * std::abs(du * dv) + vv * dv * dv;
    }
    // Of two that are sure: what is sure of both.
    static double nearer(double a, double b) {
        return a > 0 && b > 0 ? std::min(a, b) : a < 0 && b < 0 ? std::max(a, b) : 0;
    }
};

// The second derivatives at one place, along the normal if there is one and it is asked for.
Curvature seen_at(const Jet<2, 2, Vec<3>>& j, bool along_normal);

// Bound of the distance between S and its linear interpolant at the corners of the triangle, on the triangle,
// from second derivatives that `c` bounds there. See the essay in curvature_tree.cpp.
double linear_interpolation_bound(const Curvature& c, const Vec<2>& a, const Vec<2>& b, const Vec<2>& d);

// A quadratic function: its second derivatives, with their signs.
struct Quadratic {
    double uu = 0, uv = 0, vv = 0;
    // Bound of the distance from its linear interpolant on the triangle, sharp but for rounding.
    double error(const std::array<Vec<2>, 3>& corner) const;
    // Of the diagonals of a box of this size the one on which it differs less from its interpolant: whether
    // that is the one from the lower corner to the upper one.
    bool prefers_rising(const Vec<2>& size) const {
        return (uu * size[0] * size[0] + vv * size[1] * size[1]) * uv <= 0;
    }
    double halves_error(const Vec<2>& size) const;  // with that diagonal
    double fan_error(const Vec<2>& size) const;     // of triangles of its sides and its centre
};
// What sum l_i l_j s_ij / 2, for barycentric coordinates l, is at most, for s_ij of the sides. `slip`: what
// they are off by.
double largest_of_sides(std::array<double, 3> s, double slip);
// Of the quadratic function with these second derivatives uu, uv, vv in space: bound of the distance from its
// linear interpolant on the triangle. `slip`: what squares of sides are off by.
double quadratic_error(const std::array<Vec<3>, 3>& second, const std::array<Vec<2>, 3>& corner, double slip);
// Hardly more than its longest side.
bool is_thin(const std::array<Vec<2>, 3>& corner);
// A half of the box.
inline std::array<Vec<2>, 3> half_of(const Box<2>& box, bool rising) {
    const Vec<2> right{{box.hi[0], box.lo[1]}};
    return rising ? std::array{box.lo, right, box.hi}
                  : std::array{right, box.hi, Vec<2>{{box.lo[0], box.hi[1]}}};
}

inline constexpr double kMostTurn = 0.5;  // sine of what normals may turn by within a box
inline constexpr double kChord = 1.06;    // chord over sine of angles with such sines

// What is known of S over a part of the plane: essay in bending.cpp, with its notation.
struct Bending {
    Curvature full;       // of S
    Curvature across;     // of n . S
    Curvature beside;     // of S less its part along n
    Vec<3> n{};           // of length 1
    double tilt = 0;      // |N - n| is at most this
    double a = 0, b = 0;  // what makes parameters lengths
    double least = 0;     // |DS d| is at least this times |(a du, b dv)|; 0: nothing is known
    // Of a box: the second derivatives of n . S in its middle, infinite if they are not known, what they are
    // off by at most, and bounds of the third ones in all of the box: uuu, uuv, uvv, vvv.
    struct Middle {
        Vec<2> at{};
        Quadratic second{kInfinity, 0, 0};
        std::array<double, 3> off{};
        std::array<double, 4> third{};
        // The same of S.
        std::array<Vec<3>, 3> whole_second{};
        std::array<double, 3> whole_off{};
        std::array<double, 4> whole_third{};
        std::array<double, 3> whole_size{};  // lengths of whole_second
    } middle = {};
    // Of a box with the function that has these second derivatives and is S at its corners, or at those of
    // the triangle that this is asked of: bounds of the rest, |S - it| and |n . (S - it)|, in all of the box.
    // Infinite where they are not known.
    struct Fit {
        Box<2> box{};
        double whole = kInfinity, along = kInfinity;
        bool of_triangle = false;
        bool exists() const { return whole < kInfinity; }
    } fit = {};

    void include(const Bending& o);
    // Of what is seen along normals that are within `turn` of some here.
    Curvature seen(double turn) const { return seen_along(tilt + turn); }
    // The same along vectors of length 1 that are within `apart` of n.
    Curvature seen_along(double apart) const;
    // Bound of the interpolation error of what is seen along normals that are within `turn` of the one below,
    // in the halves of a cell of the box that this is of.
    double seen_error(const Box<2>& cell, double turn) const;
    // The same of the halves of the cell on both sides of the better diagonal, and of one triangle in it.
    // REQUIRES knows_middle().
    // No effort is made for less than `enough`, nor where that is out of reach; 0: as small as it can be
    // said.
    double halves_error(const Box<2>& cell, double turn, double enough) const;
    double triangle_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn,
                          double enough) const;
    // Of all of the interpolation error in the triangle. REQUIRES knows_middle().
    double whole_error(const Box<2>& cell, const std::array<Vec<2>, 3>& corner) const;
    double whole_halves_error(const Box<2>& cell) const;
    // About what triangles beside a cell of this size will be said to be off by, where they are hardly more
    // than one of its sides: of all of the error or along n. REQUIRES knows_middle().
    double sides_error(const Vec<2>& cell, bool along_normal) const {
        const auto& q = middle.whole_second;
        const double u = along_normal ? std::abs(dot(n, q[0])) : norm(q[0]),
                     v = along_normal ? std::abs(dot(n, q[2])) : norm(q[2]);
        const double rest = !fit.exists() ? 0 : along_normal ? fit.along + tilt * fit.whole : fit.whole;
        return std::max(u * cell[0] * cell[0], v * cell[1] * cell[1]) / 8 + 2 * rest;
    }
    bool prefers_rising(const Vec<2>& cell) const {
        return !knows_middle() || middle.second.prefers_rising(cell);
    }
    // Of halves of cells of this size anywhere in the box, which has the size `box`, and of triangles of
    // their sides and centres. REQUIRES knows_middle().
    double cells_error(const Vec<2>& box, const Vec<2>& cell, double turn) const;
    bool knows_middle() const { return middle.second.uu < kInfinity; }

private:
    struct Rest;
    double turned(double du, double dv) const;
    Rest rest_in(const Box<2>& cell, double turn) const;
    double fit_error(const std::array<Vec<2>, 3>& corner, double turn, double most, double times,
                     double enough) const;
    double of_part(const Box<2>& cell, const std::array<Vec<2>, 3>& corner, double turn, double most,
                   double u, double v, double times, double enough) const;
    double steady_error(const Rest& rest, const Curvature& seen) const;
};

// Of S over the box, with bounds of |S_u| and |S_v|. `knows_normals`: false leaves all else unknown.
// `middle`: derivatives in the middle of the box.
struct BoxBending : Bending {
    double first[2] = {};
};
// What second derivatives vary by within a box where they are continuous: bounds of |S_uuu|, |S_uuv|,
// |S_uvv|, |S_vvv| and of those of n . S.
struct Variation {
    Vec<3> n{};
    std::array<double, 4> all{}, along{};
};
// Finds `variation`, too, if it is asked for. REQUIRES surface.is_twice_smooth(box) then.
BoxBending bending_of(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                      const Jet<2, 2, Vec<3>>& middle, Variation* variation = nullptr);
// The same of a spline by a quadratic function, which is S at its corners, or at those of a triangle.
struct TriangleOn {
    std::array<Vec<2>, 3> uv;
    std::array<Vec<3>, 3> at;
};
// Worth it where the box has few pieces, and is not so small that all would be rounding.
bool is_fitted(const DerivativeQuery<2, 3>& surface, const Box<2>& box);
// A box around that is not too small, if the spline goes on there.
Box<2> room_for_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box);
BoxBending bending_by_fit(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                          const Jet<2, 2, Vec<3>>& middle, const TriangleOn* triangle = nullptr);
// The same from what is seen in the middle, by the variation over some box around.
BoxBending bending_from_middle(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals,
                               const Jet<2, 2, Vec<3>>& middle, const Variation& variation);
inline BoxBending bending_of(const DerivativeQuery<2, 3>& surface, const Box<2>& box, bool knows_normals) {
    return bending_of(surface, box, knows_normals,
                      jet<2>(surface.geometry(), {box.side(0).middle(), box.side(1).middle()}));
}

// What bends make of lengths, but for a factor of `at` alone: all that shift_of asks of those around.
inline double bend_of_lengths(const Bending& at, const Curvature& around) {
    return around.uv * (at.a * at.b) + std::max(around.uu * (at.b * at.b), around.vv * (at.a * at.a));
}
// How points of the mesh find their feet on S.
struct Shift {
    bool exists = false;
    double q = 0, far = 1, turn = 0;  // the normal turns by at most so much on the way
    // Bounds of the distance from the foot, where `seen` bounds the interpolation error along normals, and of
    // the distance from places on the way there.
    double across(double seen, double e) const;
    double left_of(double tolerance, double e) const;  // for `seen`, about
    double way(double e) const;
};
// e: bound of the whole interpolation error. `near`: bounds as far around as reach_of says; `reflected`: 3 if
// the surface ends there, else 1. `is_deep`: no side is on the boundary of the face.
Vec<2> reach_of(const Bending& at, double e);
Shift shift_of(const Bending& at, double e, const Curvature& near, double reflected, bool is_deep);

// Whether a kink adds less to the error of linear interpolation over a box with such a side than anybody
// sees: arcs written with double knots, say, which are smooth but for the digits of the file. What it adds is
// in every bound all the same (CurvatureTree::kink_bound), and triangles at it are judged by all of their
// error (bending.cpp).
bool is_rounding(const Kink& kink, double side, double tolerance);
bool kinks_are_rounding(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double tolerance);

}  // namespace freiform
