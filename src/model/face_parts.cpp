// Bound: on a triangle with a right angle and legs along u and v, a surface is within Q(du, dv) / 8 of its
// linear interpolant (curvature_tree.cpp), and kinks add what kink_bound_of says. Computed corners are off by
// at most sqrt(3) value_error_bound, which is added.
#include "face_parts_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMaxChords = 4096;  // of one parameter curve

}  // namespace

Result<FaceParts> FaceParts::make(const Face& face, const std::vector<Edge>& edges, double accuracy) {
    // A first look without demands says how large the face is, and how far parameters move its points.
    const double any = std::numeric_limits<double>::infinity();
    const auto rough = FaceRegion::make(face, edges, {{any, any}}, 1);
    if (!rough) return std::unexpected(rough.error());
    const DerivativeQuery<2, 3> surface(face.surface);
    const auto d = surface({rough->box().side(0), rough->box().side(1)}, 1);
    Vec<2> sag;
    for (int i = 0; i < 2; ++i) {
        const double stretch = i == 0 ? d(1, 0) : d(0, 1);
        sag[i] =
            stretch > 0 && std::isfinite(stretch) ? accuracy / stretch : 1e-4 * rough->box().side(i).length();
    }
    auto region = FaceRegion::make(face, edges, sag, kMaxChords);
    if (!region) return std::unexpected(region.error());
    return FaceParts(face, std::move(*region));
}

std::optional<FacePart> FaceParts::part_over(const Box<2>& box, const std::vector<int>& near,
                                             bool known_inside) const {
    FacePart part;
    part.box = box;
    for (const int i : near)
        if (region_.meets(box, std::size_t(i))) part.near.push_back(i);
    part.crossing = !part.near.empty();
    if (!part.crossing && !known_inside && !region_.is_inside(0.5 * (box.lo + box.hi))) return std::nullopt;
    const Vec<2> size = box.hi - box.lo;
    const auto d = (*surface_)({box.side(0), box.side(1)});
    part.error =
        (d(2, 0) * size[0] * size[0] + 2 * d(1, 1) * size[0] * size[1] + d(0, 2) * size[1] * size[1]) / 8 +
        kink_bound_of(surface_->kinks(0), box.side(0)) + kink_bound_of(surface_->kinks(1), box.side(1)) +
        2 * value_error_bound(face_->surface, {box.side(0), box.side(1)});
    part.error *= 1 + 1e-14;
    part.size = std::max(d(1, 0) * size[0], d(0, 1) * size[1]);
    if (std::isnan(part.error)) part.error = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k)
        part.corner[std::size_t(k)] = value({{k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1]}});
    return part;
}

std::optional<FacePart> FaceParts::whole() const {
    if (region_.box().is_empty()) return std::nullopt;
    const auto on = limits(face_->surface);
    Box<2> box;
    box.add(clamped(region_.box().lo, on));
    box.add(clamped(region_.box().hi, on));
    std::vector<int> all(region_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
    return part_over(box, all, false);
}

std::vector<FacePart> FaceParts::halves(const FacePart& part) const {
    const Vec<2> size = part.box.hi - part.box.lo;
    const auto d = (*surface_)({part.box.side(0), part.box.side(1)}, 1);
    const double along[2] = {d(1, 0) * size[0], d(0, 1) * size[1]};
    int axis = along[0] >= along[1] ? 0 : 1;
    if (!std::isfinite(along[0]) || !std::isfinite(along[1])) axis = size[0] >= size[1] ? 0 : 1;
    std::vector<FacePart> out;
    for (const int a : {axis, 1 - axis}) {
        const double at = part.box.side(a).middle();
        if (!(part.box.lo[a] < at && at < part.box.hi[a])) continue;
        for (int half = 0; half < 2; ++half) {
            Box<2> box = part.box;
            (half == 0 ? box.hi : box.lo)[a] = at;
            if (auto p = part_over(box, part.near, !part.crossing)) out.push_back(std::move(*p));
        }
        break;
    }
    return out;
}

}  // namespace freiform
