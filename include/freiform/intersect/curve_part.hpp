// Where curves and lines meet a part of a surface of a model, in the surface's own parameters.
#pragma once
#include <freiform/intersect/curve_surface.hpp>
#include <freiform/intersect/surface_surface.hpp>

namespace freiform {

// Const and safe to share between threads.
class IntersectPart {
public:
    // Refuses (unsupported) offsets; boxes without bounds.
    static Result<IntersectPart> make(const SurfacePart& part);

    // As for splines (curve_surface.hpp); contacts are ordered by t. What is proven is so for a rational
    // spline that no point of the part is farther from than `search_bound`.
    Result<Intersections<3, 3>> intersect(const StraightLine& line,
                                          const IntersectOptions& options = {}) const;
    Result<Intersections<3, 3>> intersect(const Curve<Hom<3>>& curve,
                                          const IntersectOptions& options = {}) const;
    double search_bound() const { return search_bound_; }
    const Box<3>& box() const { return box_; }  // contains the part

private:
    struct Maps;
    IntersectPart(Surface<Hom<3>> spline, std::shared_ptr<const Maps> maps, double bound, const Box<3>& box)
        : spline_(std::move(spline)),
          lines_(spline_),
          maps_(std::move(maps)),
          search_bound_(bound),
          box_(box) {}
    Result<Intersections<3, 3>> carried(Result<Intersections<3, 3>> found) const;

    Surface<Hom<3>> spline_;
    IntersectSurface<Hom<3>> lines_;
    std::shared_ptr<const Maps> maps_;
    double search_bound_;
    Box<3> box_;
};

}  // namespace freiform
