// Affine and projective maps of patches. Applied to control points alone they give the mapped patch: affine
// maps because basis functions sum to 1, projective ones because they are linear in homogeneous coordinates.
#pragma once
#include <freiform/spline/weights.hpp>

#include <array>

namespace freiform {

// x -> linear x + offset, from From to To coordinates; linear[i][j]: row i.
template <int To, int From = To>
struct Affinity {
    std::array<std::array<double, std::size_t(From)>, std::size_t(To)> linear{};
    Vec<To> offset{};
};

// (x, w) -> m (x, w): row i < To gives coordinate i times the weight, row To the weight.
template <int To, int From = To>
struct Projectivity {
    std::array<std::array<double, std::size_t(From) + 1>, std::size_t(To) + 1> m{};
};

// Perspective: `x` to the place where the line from `eye` through it meets the plane
// origin + a across + b up, as (a, b). Points on the eye's side that the plane is on get positive weights;
// those in the plane through the eye parallel to it vanish to infinity. Refuses numbers that are not finite,
// axes that are parallel, an eye in the plane (both as far as rounding tells).
Result<Projectivity<2, 3>> perspective(const Vec<3>& eye, const Vec<3>& origin, const Vec<3>& across,
                                       const Vec<3>& up);

template <class S>
struct Transformed {
    S patch;
    double bound = 0;  // distance from the exact image of the given patch under the given map
};

// Refuses (nonfinite, limit, ill_conditioned) maps and images that leave the range of double.
template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Vec<To>>>> transform(const Patch<N, Vec<From>>& patch,
                                                 const Affinity<To, From>& map);
template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Affinity<To, From>& map);

// Knots are inserted where the images of control points have weights that are not positive; refused as
// positive_weights does, with the parameter, where the patch itself reaches the plane that the map sends to
// infinity. Takes rational patches; polynomial ones through to_rational.
//   auto picture = transform(to_rational(curve), *perspective(eye, origin, across, up));
template <std::size_t N, int To, int From>
Result<Transformed<Patch<N, Hom<To>>>> transform(const Patch<N, Hom<From>>& patch,
                                                 const Projectivity<To, From>& map);

}  // namespace freiform
