// Polygons in the parameter plane against boxes and points.
#pragma once
#include <freiform/core/interval.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

// Does the segment meet the box? Conservative: says yes for near misses too.
bool meets(const Box<2>& box, const Vec<2>& p, const Vec<2>& q);

// Closed polygons that are asked about many points: of each point the sides of one row of the plane are
// looked at. Memory: linear in the sides.
class PolygonRows {
public:
    PolygonRows() = default;
    PolygonRows(std::span<const Vec<2>> polygon, std::span<const std::array<int, 2>> segments);
    // Odd-even rule. REQUIRES a point that is away from all segments (no box that holds it meets one).
    bool is_inside(const Vec<2>& x) const;
    // Those that are kept: once for each row that they are in.
    std::size_t sides() const { return sides_.size(); }

private:
    std::size_t row_of(double y) const;

    double lowest_ = 0, scale_ = 0;
    std::vector<std::size_t> first_;  // of each row in sides_, and the end
    std::vector<std::array<Vec<2>, 2>> sides_;
};

}  // namespace freiform
