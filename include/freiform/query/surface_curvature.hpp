// Differential geometry of surfaces: fundamental forms, normals, curvatures, and the normals that poles and
// edges of length zero have as limits. Every number with a proven bound of its error.
//
// Signs: n is the unit normal in the sense of S_u x S_v; a curvature is positive where the surface bends
// towards n. A sphere of radius r whose normal points outwards has both principal curvatures -1/r.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/spline/simplex.hpp>

#include <array>
#include <vector>

namespace freiform {

struct SurfaceCurvature {
    BoundedVec<3> normal;     // of length 1
    Bounded E, F, G;          // first fundamental form: S_u S_u, S_u S_v, S_v S_v
    Bounded L, M, N;          // second: S_uu n, S_uv n, S_vv n
    Bounded gauss, mean;      // 1 / length^2, 1 / length
    Bounded greatest, least;  // principal curvatures, 1 / length; gauss = greatest * least
    // Unit vectors in the tangent plane along which the surface bends by `greatest` and `least`, orthogonal
    // to each other: estimates. Any pair where `umbilic`.
    Vec<3> along_greatest{}, along_least{};
    bool umbilic = false;  // the principal curvatures are equal as far as rounding tells
};

// The curvatures of the surface at uv. Refuses parameters outside the domain, and (ill_conditioned) points
// where S_u and S_v are parallel as far as rounding tells: see limit_normal. At a knot where derivatives
// jump: those of the right side.
//   auto c = surface_curvature(patch, {0.5, 0.5});   // c->gauss.value, c->gauss.bound
template <class P, class B>
requires(Space<P>::kDim == 3) Result<SurfaceCurvature> surface_curvature(const Surface<P, B>& s,
                                                                         const Param<2>& uv);
template <class P>
requires(Space<P>::kDim == 3) Result<SurfaceCurvature> surface_curvature(const SimplexPatch<2, P>& s,
                                                                         const Param<2>& uv);
// From the partial derivatives S, S_u, S_v, S_uu, S_uv, S_vv of any surface.
Result<SurfaceCurvature> surface_curvature(const std::array<BoundedVec<3>, 6>& jet);

struct LimitNormal {
    Vec<3> normal{};   // of length 1
    double bound = 0;  // of |normal - exact|
    int order = 0;     // S_u x S_v vanishes there like the distance to this power; 0 at regular points
};

// The limit of the unit normal at uv, approached from uv + s * direction for s -> 0, s > 0: at regular points
// the normal, whatever the direction; at the pole of a sphere, the apex of a cone or on an edge that is a
// single point, what the surface beside it has. At an apex the limit depends on the direction, at a smooth
// pole it does not.
//
// S_u x S_v and its derivatives are taken for 0 where rounding does not tell them from 0. Refuses
// (ill_conditioned) where none of them up to the order of the polynomial is certain, as on a patch that is
// degenerate everywhere, and directions that are zero or leave the domain at once.
template <class P, class B>
requires(Space<P>::kDim == 3) Result<LimitNormal> limit_normal(const Surface<P, B>& s, const Param<2>& uv,
                                                               const Vec<2>& direction);
// Along the line through uv into the inside of the domain: orthogonal to a side that uv lies on, in a corner
// and at inner points along the diagonal.
template <class P, class B>
requires(Space<P>::kDim == 3) Result<LimitNormal> limit_normal(const Surface<P, B>& s, const Param<2>& uv);

// All partial derivatives at uv up to total order `order`, in graded order, each coordinate with a proven
// bound. REQUIRES uv inside the domain.
template <class P, class B>
requires(Space<P>::kDim == 3) std::vector<BoundedVec<3>> bounded_derivatives(const Surface<P, B>& s,
                                                                             const Param<2>& uv, int order);

}  // namespace freiform
