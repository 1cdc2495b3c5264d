// Small boxes in any orientation.
#pragma once
#include <freiform/query/hull.hpp>
#include <freiform/query/nearest.hpp>

namespace freiform {

// axes[i] . x is in range[i] for every point x of the object, rounding included: that is what encloses it for
// sure. The axes have length 1 and are orthogonal but for a few roundings.
template <int D>
struct OrientedBox {
    std::array<Vec<D>, D> axes{};
    std::array<Interval, D> range{};
    double slack = 0;  // bound: a box of this orientation could be tighter by at most this on each side

    Vec<D> middle() const {
        Vec<D> m{};
        for (std::size_t k = 0; k < D; ++k) m += range[k].middle() * axes[k];
        return m;
    }
    // Half of the sides, with what the axes fail to be orthogonal: no point of the object is farther from
    // middle() along any of them, however it is computed.
    Vec<D> half() const;
    double volume() const;  // an area in the plane
};

// D = 2 or 3. The orientation is that of least volume among those of facets of a coarse hull, with a side of
// its shadow: in the plane the least of all but for the coarseness, in space a good one (an estimate). The
// range is found with `slack` <= accuracy, as far as rounding and max_parts for each side allow. Refuses an
// accuracy that is negative or NaN. REQUIRES D == object.coordinates().
//   const auto box = oriented_box<3>(query, 1e-6);   // box->axes, box->range
template <int D>
Result<OrientedBox<D>> oriented_box(const NearestQuery& object, double accuracy, int max_parts = 20000);

// Axes along which the box of the hull is small: an estimate; any axes are right.
template <int D>
std::array<Vec<D>, D> box_axes(const ConvexHull<D>& hull);

}  // namespace freiform
