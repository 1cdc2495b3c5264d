// Triangles of a cone: essay in cone_face.cpp.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/apex.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>
#include <optional>

namespace freiform {

// A part of a cone that is on one side of the apex.
class ConeFace {
public:
    // Nothing if the box has points on both sides. A little beyond the apex is on it.
    static std::optional<ConeFace> make(const Apex& apex, const DerivativeQuery<2, 3>& surface,
                                        const Box<2>& face);

    int ruled() const { return ruled_; }
    int across() const { return 1 - ruled_; }
    // As long across as the box, at the end of the face that is farther from the apex: where second
    // derivatives across are asked.
    std::array<Interval, 2> far_end(const Box<2>& box) const;
    double bend(const DerivativeBounds<2>& far) const { return across() == 0 ? far(2, 0) : far(0, 2); }
    // Bound of the distance between the cone and the triangle of points of the face, but for kinks, where
    // `bend` bounds second derivatives at the far end of its box.
    double error(double bend, const std::array<Vec<2>, 3>& corner) const;
    // How far the straight side between parameters is from that which the triangle stands for, across.
    double bow(const Vec<2>& from, const Vec<2>& to) const;
    // Whether the triangle in space, developed, turns the other way than its parameters.
    bool is_turned_over(const std::array<Vec<2>, 3>& corner) const;

private:
    // The distance from the apex, as a part of that of the far end.
    double height(const Vec<2>& p) const;
    int ruled_ = 1;
    double at_ = 0, far_ = 0, slip_ = 0;
};

// A little beyond the apex is on both.
bool is_on_one_side(const Apex& apex, const Box<2>& face);

// Whether the surface is curved for its size, as it is not where it is nearly a plane.
bool is_worth_a_cone(const Apex& apex, const SurfaceGeometry& surface, const Box<2>& face);

}  // namespace freiform
