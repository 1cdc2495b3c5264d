// Surfaces through curves: lofting (skinning) through sections, Gordon surfaces through a network.
#pragma once
#include <freiform/fit/interpolate.hpp>
#include <freiform/spline/in_space.hpp>

#include <span>
#include <vector>

namespace freiform {

struct LoftOptions {
    int degree = 3;  // along v; with n sections at most n - 1 is used
    Spacing spacing = Spacing::chordal;
    SplineEnds ends = SplineEnds::natural;  // natural or not_a_knot; of closed lofts neither
    bool closed = false;                    // the last section is followed by the first
};

template <class P>
struct Loft {
    Surface<InSpace<P>> surface;
    std::vector<double> at;  // section i is at v = at[i]
    double bound = 0;        // no point of a section is farther from the surface at the same u and v = at[i]
    // Derivatives along v that are continuous everywhere: C^continuity. Of a single piece, its degree.
    int continuity = 0;
};

// The surface S(u, v) whose curve at v = at[i] is section i, for i = 0, 1, ..; u runs over the domain of the
// first section. Sections may be polynomial or rational, of any degrees and knots, open or closed; they get
// one basis (compatible.hpp), and their control points are interpolated along v, so straight lines of control
// points stay straight. Rational sections are interpolated as homogeneous curves, each divided by the power
// of two that makes its largest weight about 1; where that leads to weights that are not positive, knots are
// inserted (weights.hpp).
//
// Refuses fewer than two sections (closed: three), equal neighbouring sections (unless the spacing is
// uniform), and rational ones between which the surface has a pole.
//   auto hull = loft(std::span<const Curve<Vec<3>>>(frames), {3, Spacing::centripetal});
template <class P>
Result<Loft<P>> loft(std::span<const Curve<P>> sections, const LoftOptions& options = {});

template <class Q>
struct GordonSurface {
    Surface<Q> surface;
    double bound = 0;  // no point of a curve of the network is farther from the surface at its parameters
    double gap = 0;    // where curves should meet, they are not farther apart
};

// The surface through all curves of a network: u_curves[k] is its curve v = at_v[k], v_curves[l] its curve
// u = at_u[l]. Parameters increase, from the lower to the upper end of the domain of the first curve of the
// other family; other domains are mapped to that linearly. Curves have a degree of at least 1; closed ones
// are opened. Between curves the surface is the Boolean sum with cardinal splines of degree 3 (of fewer than
// four curves: 2 or 1) with not-a-knot ends, so networks of bicubic polynomials give these.
//
// Refuses (invalid), saying which two curves, where and by how much, if they meet less closely than
// `tolerance`.
template <int D>
Result<GordonSurface<Vec<3>>> gordon(std::span<const Curve<Vec<D>>> u_curves, std::span<const double> at_v,
                                     std::span<const Curve<Vec<D>>> v_curves, std::span<const double> at_u,
                                     double tolerance);

// The same of rational curves: rational, over the product of their denominators (over_one_denominator in
// make/boolean_sum.hpp), with breaks as knots of the multiplicity of the degree. Refuses as above, and
// (unsupported) networks of so many different denominators that no basis has the degree.
template <int D>
Result<GordonSurface<Hom<3>>> gordon(std::span<const Curve<Hom<D>>> u_curves, std::span<const double> at_v,
                                     std::span<const Curve<Hom<D>>> v_curves, std::span<const double> at_u,
                                     double tolerance);

}  // namespace freiform
