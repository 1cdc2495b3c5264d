// Triangles of cones, cylinders and spheres: essay in cone_face.cpp.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/apex.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>
#include <optional>

namespace freiform {

// A part of a cone that is on one side of the apex, or of a sphere.
class ConeFace {
public:
    // Nothing if the box has points on both sides of the apex, or where its slip is not known. A little
    // beyond is on it.
    static std::optional<ConeFace> make(const Apex& apex, const DerivativeQuery<2, 3>& surface,
                                        const Box<2>& face);

    bool is_sphere() const { return apex_.radius > 0; }
    int ruled() const { return apex_.ruled; }
    int across() const { return 1 - apex_.ruled; }
    // Bounds of second derivatives: across, of cones at the far end, of spheres along normals in the box; and
    // along; with those of |S_u| and |S_v|.
    struct Bends {
        double across = 0, along = 0;
        double first[2] = {};
    };
    Bends bends(const DerivativeQuery<2, 3>& surface, const Box<2>& box) const;
    // Bound of the distance between the surface and the triangle of points of the face, but for kinks.
    // `bends`: of its box.
    double error(const Bends& bends, const std::array<Vec<2>, 3>& corner) const;
    // How far the straight side between parameters is from that which the triangle stands for, across.
    double bow(const Vec<2>& from, const Vec<2>& to) const;
    // Whether the triangle in space, developed, turns the other way than its parameters.
    bool is_turned_over(const std::array<Vec<2>, 3>& corner) const;

private:
    // The distance from the apex, as a part of that of the far end; of spheres from the axis, negative beyond
    // it.
    double height(const Vec<2>& p) const;
    double seen_across(double highest) const;
    Apex apex_;
    double far_ = 0, slip_ = 0;
    double beyond_ = 0;  // from the axis of a sphere, the farthest point of the face beyond a pole
    const Revolution* sphere_ = nullptr;
};

// Whether triangles are fewer, and the face is on one side of the apex: not where a cone is nearly a plane.
// Spheres from pole to pole.
bool is_worth_a_cone(const Apex& apex, const SurfaceGeometry& surface, const Box<2>& face);

}  // namespace freiform
