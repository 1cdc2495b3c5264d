// The sphere that a spline surface lies on.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <optional>
#include <span>

namespace freiform {

struct FoundSphere {
    Vec<3> centre{};
    double radius = 0;
    double off = 0;  // bound: no point of the surface is farther from the sphere
};

// Least squares through points, four at least and not in one plane; `off` is that of these points. For
// numbers as doubles give them: with no bound.
std::optional<FoundSphere> sphere_through(std::span<const Vec<3>> points);

// How far points of a rational surface are from a sphere, proven.
double off_sphere(const Surface<Hom<3>>& surface, const Vec<3>& centre, double radius);

// The sphere that a rational surface lies on within the tolerance: part of it, or all,
// in any parameters. Nothing for surfaces that leave it by more, or may.
std::optional<FoundSphere> sphere_of(const Surface<Hom<3>>& surface, double tolerance);

}  // namespace freiform
