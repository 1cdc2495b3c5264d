// Bound. On an interval of length h let l be the line between the ends of the parameter curve p, moved into
// the domain of the surface S. p is within h^2 / 8 |p''| of the line between its own ends, in u and in v, and
// moving points into the domain brings none away from l, which lies there. Along l, S is within Q(du, dv) / 8
// of its chord. So the boundary is within
//     e = (d20 du^2 + 2 d11 du dv + d02 dv^2) / 8 + d10 b_u + d01 b_v,   b = |p''| h^2 / 8 + what the ends
//     moved
// of the chord. Kinks of surface and curve add what kink_bound_of says; the bounds of derivatives are taken
// over the box of l made larger by b. An offset by D is nowhere farther than D from its base, so two of its
// places are no farther apart than those of the base and 2 D, whatever is known of normals.
#include "face_rim_detail.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

double moved(const DerivativeBounds<2>& d, const Vec<2>& by) {
    return (by[0] == 0 ? 0 : d(1, 0) * by[0]) + (by[1] == 0 ? 0 : d(0, 1) * by[1]);
}

double moved_at_most(double known, const SurfaceGeometry& surface, const DerivativeQuery<2, 3>& query,
                     const std::array<Interval, 2>& box, const Vec<2>& by) {
    if (query.base() == nullptr) return known;
    const double found =
        moved((*query.base())(box, 1), by) + 2 * std::abs(std::get<OffsetSurface>(surface).distance);
    return known <= found ? known : found;
}

void FaceRim::bound(const Face& face, const DerivativeQuery<2, 3>& surface) {
    Vec<2> bend{};
    if (curve) {
        const double h2 = on.length() * on.length() / 8;
        const auto p = coordinate_bounds(*curve, on);
        const Vec<2> lo = jet<0>(coedge->curve, on.lo).value(), hi = jet<0>(coedge->curve, on.hi).value();
        for (int k = 0; k < 2; ++k)
            bend[k] = h2 * p.coordinate[std::size_t(k)](2) + kink_bound_of(curve->kinks(0), on) +
                      std::max(std::abs(lo[k] - uv[0][k]), std::abs(hi[k] - uv[1][k])) +
                      value_error_bound(coedge->curve, {on});
    }
    std::array<Interval, 2> box;
    Vec<2> side;
    for (int k = 0; k < 2; ++k) {
        side[k] = std::abs(uv[1][k] - uv[0][k]);
        box[std::size_t(k)] = {std::min(uv[0][k], uv[1][k]) - bend[k],
                               std::max(uv[0][k], uv[1][k]) + bend[k]};
    }
    const auto d = surface(box);
    const auto times = [](double a, double b) { return a == 0 || b == 0 ? 0 : a * b; };  // infinite a
    const double flat = (times(d(2, 0), side[0] * side[0]) + 2 * times(d(1, 1), side[0] * side[1]) +
                         times(d(0, 2), side[1] * side[1])) /
                            8 +
                        kink_bound_of(surface.kinks(0), box[0]) + kink_bound_of(surface.kinks(1), box[1]);
    // Without bounds of second derivatives: every point of l is within half of its length of one of its ends.
    const double length = moved(d, side);
    error = (flat < length / 2 ? flat : length / 2) + moved(d, bend);
    error = moved_at_most(error, face.surface, surface, box, 0.5 * side + bend) +
            2 * value_error_bound(face.surface, box);
    error *= 1 + 1e-12;
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
}

FaceRim FaceRim::over(const Face& face, const DerivativeQuery<2, 3>& surface, const Coedge* coedge,
                      const DerivativeQuery<1, 2>* curve, Interval on) {
    FaceRim rim;
    rim.coedge = coedge;
    rim.curve = curve;
    rim.on = on;
    const auto ends = limits(face.surface);
    rim.uv = {clamped(jet<0>(coedge->curve, on.lo).value(), ends),
              clamped(jet<0>(coedge->curve, on.hi).value(), ends)};
    for (std::size_t k = 0; k < 2; ++k) rim.end[k] = jet<0>(face.surface, rim.uv[k].c).value();
    rim.bound(face, surface);
    return rim;
}

FaceRim FaceRim::jump(const Face& face, const DerivativeQuery<2, 3>& surface, const Vec<2>& from,
                      const Vec<2>& to) {
    FaceRim rim;
    rim.uv = {from, to};
    for (std::size_t k = 0; k < 2; ++k) rim.end[k] = jet<0>(face.surface, rim.uv[k].c).value();
    rim.bound(face, surface);
    return rim;
}

}  // namespace freiform
