// Idea. The part becomes a rational spline of the same shape (part_spline_detail.hpp), is met as one, and the
// parameters are carried over: boxes contain what they contained, rounding included.
//
// Why not the equations of quadrics, which lines meet at roots of a quadratic? Splines are met with a proof
// already, kinds and multiplicities included, tori as well, and curves as well as lines.
#include "part_spline_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/intersect/curve_part.hpp>

#include <algorithm>

namespace freiform {

struct IntersectPart::Maps {
    std::array<detail::ParameterArcs, 2> of;
};

Result<IntersectPart> IntersectPart::make(const SurfacePart& part) {
    auto spline = detail::part_spline(part.surface, part.on);
    if (!spline) return std::unexpected(spline.error());
    const auto box = box_of_part(part);
    if (!box) return std::unexpected(box.error());
    return IntersectPart(std::move(spline->surface), std::make_shared<const Maps>(Maps{spline->map}),
                         spline->bound, *box);
}

Result<Intersections<3, 3>> IntersectPart::carried(Result<Intersections<3, 3>> found) const {
    if (!found) return found;
    const auto over = [&](std::array<Interval, 3>& box) {
        for (std::size_t k = 0; k < 2; ++k) box[k + 1] = maps_->of[k].over(box[k + 1]);
    };
    for (Contact<3, 3>& c : found->contacts) {
        for (std::size_t k = 0; k < 2; ++k) c.at[k + 1] = maps_->of[k].at(c.at[k + 1]);
        over(c.box);
        c.gap = 1.01 * (c.gap + search_bound_);
    }
    for (auto& box : found->undecided) over(box);
    sort(found->contacts, {}, [](const auto& c) { return c.at; });
    return found;
}

Result<Intersections<3, 3>> IntersectPart::intersect(const StraightLine& line,
                                                     const IntersectOptions& options) const {
    return carried(lines_.intersect(line, options));
}

Result<Intersections<3, 3>> IntersectPart::intersect(const Curve<Hom<3>>& curve,
                                                     const IntersectOptions& options) const {
    return carried(freiform::intersect(curve, spline_, options));
}

}  // namespace freiform
