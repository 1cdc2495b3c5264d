// What figures of surfaces in space are made with.
#pragma once
#include "gallery/plot.hpp"

#include <freiform/mesh/triangle_mesh.hpp>

namespace freiform::cli::gallery {

using Points3 = std::vector<Vec<3>>;
using Surface3 = Surface<Vec<3>>;

// Where a point of space is in a panel that is drawn from there.
class Eye {
public:
    explicit Eye(const View& view = {});
    Vec<2> operator()(const Vec<3>& p) const { return {{dot(right_, p), dot(up_, p)}}; }
    Points operator()(const Points3& points) const;
    // With the third coordinate towards the eye.
    Vec<3> deep(const Vec<3>& p) const { return {{dot(right_, p), dot(up_, p), dot(cross(right_, up_), p)}}; }
    const View& view() const { return view_; }

private:
    View view_;
    Vec<3> right_, up_;
};
// Degrees.
Eye eye_at(double azimuth, double elevation);

// A shape in one colour. Of curves, and of surfaces' edges, width and dashes count where they are given.
struct Shown {
    Shape shape;
    Look look;
};
// All of them together: surfaces hide what is behind them. `how` says isolines and nets.
Plot& together(Plot& plot, const std::vector<Shown>& shown, const Eye& eye, DrawingOptions how = {});

Shape polyline(const Points3& points);
// Many lines as one shape.
Shape segments(const std::vector<std::array<Vec<3>, 2>>& lines);
// The lines of a net of control points.
Shape net_of(const Net<2, Vec<3>>& net);

inline const Surface3& surface_in(const Document& document, std::string_view name) {
    return std::get<Surface3>(shape_in(document, name));
}
Surface3 bezier_surface(const Net<2, Vec<3>>& net);

// The sides of triangles that no triangle hides, in a colour for each part of the mesh.
Plot& triangles_of(Plot& plot, const TriangleMesh& mesh, const Eye& eye, const std::vector<Colour>& colours);

// Dark stripes between lines on which the normal makes angles of 0, `degrees`, 2 `degrees`, .. with `light`:
// they break where tangent planes do and have kinks where curvature jumps. Of surfaces that do not cover
// themselves in the picture.
Plot& stripes(Plot& plot, const Surface3& s, const Eye& eye, const Vec<3>& light, double degrees,
              const Colour& colour);

}  // namespace freiform::cli::gallery
