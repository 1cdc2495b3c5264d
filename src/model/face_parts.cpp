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
constexpr std::size_t kClipped = 64;      // chords that run through a part, of which there is a strip

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
                                             const FacePart* of) const {
    FacePart part;
    part.box = box;
    for (const int i : near)
        if (region_.meets(box, std::size_t(i))) part.near.push_back(i);
    part.crossing = !part.near.empty();
    if (!part.crossing && !is_inside(part, of)) return std::nullopt;
    if (of != nullptr && part.near == of->near) part.sides = of->sides;
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

// A box that meets no chord.
bool FaceParts::is_inside(const FacePart& part, const FacePart* of) const {
    if (of != nullptr && !of->crossing) return true;
    const Vec<2> middle = 0.5 * (part.box.lo + part.box.hi);
    if (of != nullptr && of->sides >= 0) {
        const Strip s = strip_of(of->near);
        const double beside = cross(s.along, middle - s.from);
        if (std::abs(beside) > s.width) return (of->sides & (beside > 0 ? 1 : 2)) != 0;
    }
    return region_.is_inside(middle);
}

FaceParts::Strip FaceParts::strip_of(const std::vector<int>& chords) const {
    const auto farthest = [&](const Vec<2>& x) {
        Vec<2> best = x;
        for (const int i : chords)
            for (const Vec<2>& p : region_.chord(std::size_t(i)))
                if (norm(p - x) > norm(best - x)) best = p;
        return best;
    };
    Strip s{farthest(region_.chord(std::size_t(chords[0]))[0]), {}, 0};
    s.along = farthest(s.from) - s.from;
    const auto sizes = [&](const Vec<2>& d) {
        return std::abs(s.along[0] * d[1]) + std::abs(s.along[1] * d[0]);
    };
    const double reach = std::max(sizes(region_.box().lo - s.from), sizes(region_.box().hi - s.from));
    for (const int i : chords) {
        double off = 0;
        for (const Vec<2>& p : region_.chord(std::size_t(i)))
            off = std::max(off, std::abs(cross(s.along, p - s.from)));
        s.width = std::max(s.width, off + sizes(region_.sag(std::size_t(i))));
    }
    // Twice as wide, so that the corners of the region's box, which is as far from its chords as their curves
    // may be, are in it whatever the roundings.
    s.width = 2 * s.width + 1e-15 * reach;
    return s;
}

// What is left of the strip of all chords is wholly inside of the face or outside of it, and so is what is
// right of it: no chord runs through either.
std::optional<FaceParts::Strip> FaceParts::cut_by(FacePart& part) const {
    if (part.near.empty() || part.near.size() > kClipped) return std::nullopt;
    const Strip s = strip_of(part.near);
    if (part.sides >= 0) return s;
    part.sides = 3;
    Vec<2> farthest[2];
    double beside[2] = {s.width, s.width};
    for (const double u : {part.box.lo[0], part.box.hi[0]})
        for (const double v : {part.box.lo[1], part.box.hi[1]})
            for (int side = 0; side < 2; ++side)
                if (const double off = (side == 0 ? 1 : -1) * cross(s.along, Vec<2>{{u, v}} - s.from);
                    off > beside[side])
                    beside[side] = off, farthest[side] = {{u, v}};
    for (int side = 0; side < 2; ++side) {
        const Vec<2>& x = farthest[side];
        const auto meets = [&](int i) { return region_.meets({x, x}, std::size_t(i)); };
        const bool is_there = beside[side] > s.width;
        if (!is_there || (std::ranges::none_of(part.near, meets) && !region_.is_inside(x)))
            part.sides -= 1 + side;
    }
    return s;
}

// Each triangle of the part is the image of one half of the box under a linear map, which takes what is cut
// off the half to what is cut off the triangle.
std::array<ClippedTriangle, 2> FaceParts::clipped(FacePart& part) const {
    const Box<2>& box = part.box;
    const Vec<2> place[4] = {box.lo, {{box.hi[0], box.lo[1]}}, {{box.lo[0], box.hi[1]}}, box.hi};
    constexpr int kTriangles[2][3] = {{0, 1, 3}, {0, 3, 2}};
    std::array<ClippedTriangle, 2> out;
    const auto s = cut_by(part);
    double beside[4] = {0, 0, 0, 0};
    for (int k = 0; s && k < 4; ++k) beside[k] = cross(s->along, place[k] - s->from);
    for (std::size_t t = 0; t < 2; ++t) {
        ClippedTriangle now;
        std::array<double, 6> at{};
        for (const int k : kTriangles[t]) {
            at[std::size_t(now.size)] = beside[k];
            now.add(part.corner[std::size_t(k)]);
        }
        for (int side = 0; s && side < 2; ++side) {
            if (part.sides & (1 + side)) continue;
            // Keeps what is at most `width` on that side.
            const double sign = side == 0 ? 1 : -1;
            ClippedTriangle kept;
            std::array<double, 6> values{};
            const auto add = [&](const Vec<3>& p, double value) {
                values[std::size_t(kept.size)] = value;
                kept.add(p);
            };
            for (int k = 0; k < now.size; ++k) {
                const auto i = std::size_t(k), j = std::size_t((k + 1) % now.size);
                const double a = sign * at[i] - s->width, b = sign * at[j] - s->width;
                if (a <= 0) add(now.corner[i], at[i]);
                if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
                    const double share = a / (a - b);
                    add(now.corner[i] + share * (now.corner[j] - now.corner[i]), sign * s->width);
                }
            }
            now = kept, at = values;
        }
        out[t] = now;
    }
    return out;
}

// Where one side of the strip is in the face and the other one is not, the boundary is between them.
double FaceParts::overhang(FacePart& part) const {
    constexpr double kDiagonal = 1.5;  // of a box, over its longest side, at most
    if (!part.crossing) return 0;
    const double most = kDiagonal * part.size;
    const auto s = cut_by(part);
    if (!s || part.sides == 0 || part.sides == 3) return most;
    const auto d = (*surface_)({part.box.side(0), part.box.side(1)}, 1);
    const double across = 2 * s->width / dot(s->along, s->along),
                 beside = across * (d(1, 0) * std::abs(s->along[1]) + d(0, 1) * std::abs(s->along[0]));
    return std::isfinite(beside) ? std::min(most, beside) : most;
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
    return part_over(box, all, nullptr);
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
            if (auto p = part_over(box, part.near, &part)) {
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
