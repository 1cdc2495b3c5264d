// Bound: on a triangle with a right angle and legs along u and v, a surface is within Q(du, dv) / 8 of its
// linear interpolant (curvature_tree.cpp), and kinks add what kink_bound_of says. The bilinear interpolation
// of the corners, in their hull, is nearer: it takes no part in the twist S_uv, so only d20 du^2 / 8 + d02
// dv^2 / 8 remains, which near a pole falls with the square of the size, as the other does not. Computed
// corners are off by at most sqrt(3) value_error_bound, which is added.
#include "face_parts_detail.hpp"
#include "face_rim_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kMaxChords = 4096;  // of one parameter curve

// Where to halve: the kink that adds most, else the middle. On both sides the error falls with the square of
// the size then. `anywhere`: not only in the middle half. Where the surface is torn only one side has its
// corners on the line.
double cut(std::span<const Kink> kinks, Interval on, bool anywhere) {
    double at = on.middle(), most = 0;
    const double least = anywhere ? 0 : on.length() / 4;
    for (const Kink& k : kinks)
        if (const double adds = kink_bound_of(std::span(&k, 1), on);
            adds > most && std::isfinite(k.jump) && std::min(k.at - on.lo, on.hi - k.at) >= least)
            most = adds, at = k.at;
    return at;
}

}  // namespace

Result<FaceParts> FaceParts::make(const Face& face, const std::vector<Edge>& edges, double accuracy) {
    // A first look without demands says how large the face is.
    const auto rough = FaceRegion::rough(face, edges);
    if (!rough) return std::unexpected(rough.error());
    const DerivativeQuery<2, 3> surface(face.surface);
    const auto on = limits(face.surface);
    const auto too_much = [&](const Box<2>& around, const Vec<2>& sag) {
        Box<2> box;
        box.add(clamped(around.lo, on)), box.add(clamped(around.hi, on));
        const auto d = surface({box.side(0), box.side(1)}, 1);
        double most = 0;
        for (int i = 0; i < 2; ++i) {
            const double stretch = i == 0 ? d(1, 0) : d(0, 1);
            const double may =
                std::isfinite(stretch) ? accuracy / stretch : 1e-4 * rough->box().side(i).length();
            if (sag[i] > 0) most = std::max(most, sag[i] / may);
        }
        return most;
    };
    auto region = FaceRegion::make(face, edges, too_much, kMaxChords);
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
    part.rounding = 2 * value_error_bound(face_->surface, {box.side(0), box.side(1)});
    part.hull_error = (d(2, 0) * size[0] * size[0] + d(0, 2) * size[1] * size[1]) / 8 +
                      kink_bound_of(surface_->kinks(0), box.side(0)) +
                      kink_bound_of(surface_->kinks(1), box.side(1)) + part.rounding;
    part.error = part.hull_error + d(1, 1) * size[0] * size[1] / 4;
    part.error *= 1 + 1e-14, part.hull_error *= 1 + 1e-14;
    part.size = moved_at_most(std::max(d(1, 0) * size[0], d(0, 1) * size[1]), face_->surface, *surface_,
                              {box.side(0), box.side(1)}, size);
    for (double* e : {&part.error, &part.hull_error})
        if (std::isnan(*e)) *e = kInfinity;
    for (int k = 0; k < 4; ++k)
        part.corner[std::size_t(k)] = value({{k & 1 ? box.hi[0] : box.lo[0], k & 2 ? box.hi[1] : box.lo[1]}});
    return part;
}

bool FaceParts::holds(const FacePart& part, const Vec<2>& uv) const {
    if (!part.crossing) return true;
    for (const int i : part.near)
        if (region_.meets({uv, uv}, std::size_t(i))) return false;
    return region_.is_inside(uv);
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

std::vector<FacePart> FaceParts::halves(const FacePart& part, bool by_bend) const {
    const Vec<2> size = part.box.hi - part.box.lo;
    const auto d = (*surface_)({part.box.side(0), part.box.side(1)}, by_bend ? 2 : 1);
    double along[2] = {d(1, 0) * size[0], d(0, 1) * size[1]}, kinks[2];
    for (int k = 0; k < 2; ++k) kinks[k] = 8 * kink_bound_of(surface_->kinks(k), part.box.side(k));
    if (const double bend[2] = {d(2, 0) * size[0] * size[0] + kinks[0],
                                d(0, 2) * size[1] * size[1] + kinks[1]};
        by_bend && bend[0] != bend[1])
        along[0] = bend[0], along[1] = bend[1];
    int axis = along[0] >= along[1] ? 0 : 1;
    if (!std::isfinite(along[0]) || !std::isfinite(along[1])) axis = size[0] >= size[1] ? 0 : 1;
    std::vector<FacePart> out;
    for (const int a : {axis, 1 - axis}) {
        const double at = cut(surface_->kinks(a), part.box.side(a), by_bend && 2 * kinks[a] > along[a]);
        if (!(part.box.lo[a] < at && at < part.box.hi[a])) continue;
        for (int half = 0; half < 2; ++half) {
            Box<2> box = part.box;
            (half == 0 ? box.hi : box.lo)[a] = at;
            if (auto p = part_over(box, part.near, !part.crossing)) {
                p->halvings = part.halvings + 1;
                out.push_back(std::move(*p));
            }
        }
        break;
    }
    return out;
}

// Along u, with c the chord between two corners: S_u du is within e = d20 du^2 + d11 du dv of c, since c is a
// mean of it over one side, and n . S_u du within e_n of n . c for any direction n, with the bounds of n . S
// in e_n. S - q is within r of m - q, m the mean of the corners. So with n along m - q, (S - q) . S_u du is
// within |m - q| e_n + r (|c| + e) of (m - q) . c. Not where the first derivatives jump: there the least
// distance needs no critical point.
bool FaceParts::may_have_foot(const FacePart& part, const Vec<3>& q) const {
    for (int axis = 0; axis < 2; ++axis)
        for (const Kink& k : surface_->kinks(axis))
            if (part.box.side(axis).contains(k.at)) return true;
    const Vec<2> size = part.box.hi - part.box.lo;
    const auto d = (*surface_)({part.box.side(0), part.box.side(1)});
    const Vec<3> m = 0.25 * ((part.corner[0] + part.corner[1]) + (part.corner[2] + part.corner[3])) - q;
    double scale = max_abs(q);
    for (const Vec<3>& c : part.corner) scale = std::max(scale, max_abs(c));
    // Coordinates and their sums: a few u of their size.
    const double rounding =
        32 * 0x1p-53 * scale + value_error_bound(face_->surface, {part.box.side(0), part.box.side(1)});
    const double r = (d(1, 0) * size[0] + d(0, 1) * size[1]) / 2 + part.error + 4 * rounding, far = norm(m);
    const Vec<3> chord[2] = {part.corner[1] - part.corner[0], part.corner[2] - part.corner[0]};
    if (!(far > 0)) return true;
    const auto n = surface_->along((1 / far) * m, {part.box.side(0), part.box.side(1)});
    for (int axis = 0; axis < 2; ++axis) {
        const auto bent = [&](const DerivativeBounds<2>& b) {
            const double own = axis == 0 ? b(2, 0) : b(0, 2), s = size[axis];
            return own * s * s + b(1, 1) * size[0] * size[1] + 4 * rounding;
        };
        const double e = bent(d), e_n = bent(n) + 4 * kUnitRoundoff * e;  // n is not quite of length 1
        if (std::abs(dot(m, chord[axis])) > (far * e_n + r * (norm(chord[axis]) + e)) * (1 + 1e-12))
            return false;
    }
    return true;
}

// n . x_u is that of the chord but for the second derivatives of n . x, each times the side that it acts
// along.
bool FaceParts::may_be_level(const FacePart& part, const Vec<3>& n) const {
    for (int axis = 0; axis < 2; ++axis)
        for (const Kink& k : surface_->kinks(axis))
            if (part.box.side(axis).contains(k.at)) return true;
    const Vec<2> size = part.box.hi - part.box.lo;
    const auto bound = surface_->along(n, {part.box.side(0), part.box.side(1)});
    double scale = 0;
    for (const Vec<3>& c : part.corner) scale = std::max(scale, max_abs(c));
    const double rounding = 2 * part.rounding + 32 * kUnitRoundoff * scale;
    const Vec<3> chord[2] = {part.corner[1] - part.corner[0], part.corner[2] - part.corner[0]};
    for (int axis = 0; axis < 2; ++axis) {
        const double own = axis == 0 ? bound(2, 0) : bound(0, 2), s = size[axis];
        const double bent = own * s * s + bound(1, 1) * size[0] * size[1] + rounding;
        if (std::abs(dot(n, chord[axis])) > bent * (1 + 1e-12)) return false;
    }
    return true;
}

}  // namespace freiform
