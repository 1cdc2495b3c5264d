// Are two rational surfaces parts of one sphere? Both are measured against the sphere of the first.
//
// Why not a map between the parameters, as in same_map.cpp? Two spheres whose axes differ have none that
// takes lines u = const to such lines.
#include "same_map_detail.hpp"

#include <freiform/query/sphere_of.hpp>

namespace freiform::detail {

bool are_one_sphere(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b, double tolerance) {
    const auto sphere = sphere_of(a, tolerance);
    return sphere && sphere->off + off_sphere(b, sphere->centre, sphere->radius) <= tolerance;
}

}  // namespace freiform::detail
