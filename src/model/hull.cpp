// Convex hulls of models.
//
// Idea. A part of a face is near to the hull of some of its points, and the hull of all parts comes near to
// that of the model as parts are halved (query/hull_search.hpp): only those that own a corner which is too
// far away.
//
// Notation. d_uu, d_uv, d_vv, d_u, d_v: bounds of derivatives over a box with the sides U and V.
//
// Bounds. Let x be in the hull of points q of the box, x = sum l q. Then S(x) is within
//     sum l |(q - x)^T S'' (q - x)| / 2 <= (d_uu U^2 + 2 d_uv U V + d_vv V^2) / 8 = e
// of sum l S(q): in a box, the mean square of q_u - x_u is at most U^2 / 4, and that of products U V / 4.
// (Where no boundary runs through the part, the bilinear hull_error of face_parts.cpp, which is less.) The
// part of a face with chords of its boundary in the box is a polygon with corners at ends of the chords as
// clipped by the box, and at corners of the box inside; but for twice what the curves leave their chords by,
// which moves points by so much times d_u and d_v. These corners are as near to the face, so the hull of the
// model is that near to them, too.
//
// Parts that leave their points by more than rounding are within octahedra around these: one with the half
// diagonal r contains a ball of radius r / sqrt(3). Their corners are r away, so the parts that own one are
// halved.
//
// Cost. About 1 / tolerance parts of curved faces, n log n for each round.
//
// Why not the mesh of tessellate(), made larger by its bound? It has as many points inside of the hull as on
// it, and its tolerance is that of every face, not only of those that are outermost.
#include "near_parts_detail.hpp"

#include <freiform/model/bounds.hpp>
#include <freiform/query/hull_search.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kPlain = 0x1p-44;              // of the size: parts that leave their points by no more
constexpr double kOfBall = 1.7320508075688774;  // sqrt(3), rounded up

// The segment within the box, as its ends; nothing where it is outside.
std::optional<std::array<Vec<2>, 2>> clipped(const std::array<Vec<2>, 2>& s, const Box<2>& box) {
    double lo = 0, hi = 1;
    const Vec<2> d = s[1] - s[0];
    for (int k = 0; k < 2; ++k) {
        if (d[k] == 0) {
            if (s[0][k] < box.lo[k] || s[0][k] > box.hi[k]) return std::nullopt;
            continue;
        }
        const double p = (box.lo[k] - s[0][k]) / d[k], q = (box.hi[k] - s[0][k]) / d[k];
        lo = std::max(lo, std::min(p, q)), hi = std::min(hi, std::max(p, q));
    }
    if (!(lo <= hi)) return std::nullopt;
    return std::array{s[0] + lo * d, s[0] + hi * d};
}

// What hull_search.hpp asks of a tree of parts. The first part is all of the model.
class ModelSide {
public:
    ModelSide(const detail::ModelParts& all, double plain) : all_(all), opened_(all), plain_(plain) {
        detail::PairPart<3> root;
        root.box = all.nodes[0].box;
        places_.push_back({});
        parts_.push_back(root);
    }

    const std::vector<detail::PairPart<3>>& parts() const { return parts_; }
    std::span<const Vec<3>> hull(int i) const {
        return {points_.data() + place(i).first, std::size_t(place(i).count)};
    }
    bool is_box(int i) const { return i == 0; }
    double apart(int i, int) const { return place(i).apart; }
    bool split(int i) {
        if (parts_[std::size_t(i)].first >= 0) return true;
        const int first = int(parts_.size());
        if (i == 0) {
            for (const NearLeaf& leaf : all_.leaves)
                if (leaf.part >= 0) add(leaf.face, leaf.part);
        } else {
            const Place own = place(i);
            if (!opened_.halve_part(own.face, own.part, [&](int half) { add(own.face, half); })) return false;
        }
        parts_[std::size_t(i)].first = first;
        parts_[std::size_t(i)].end = int(parts_.size());
        return true;
    }

private:
    struct Place {
        int face = -1, part = -1;
        std::size_t first = 0;
        int count = 0;
        double apart = 0;  // bound: of the points from the face
    };
    const Place& place(int i) const { return places_[std::size_t(i)]; }

    void add(int face, int index) {
        const FacePart& part = opened_.part(index);
        const FaceParts& f = all_.faces[std::size_t(face)];
        Place own{face, index, points_.size(), 0, part.rounding};
        double e = part.hull_error;
        std::vector<Vec<3>> points(part.corner.begin(), part.corner.end());
        if (part.crossing) {
            const auto bent = f.surface()({part.box.side(0), part.box.side(1)});
            const Vec<2> size = part.box.hi - part.box.lo;
            Vec<2> sag{};
            points.clear();
            for (const Vec<2>& uv : corners_of(f, part, sag)) points.push_back(f.value(uv));
            own.apart += bent(1, 0) * sag[0] + bent(0, 1) * sag[1];
            e = (bent(2, 0) * size[0] * size[0] + 2 * bent(1, 1) * size[0] * size[1] +
                 bent(0, 2) * size[1] * size[1]) /
                    8 +
                kink_bound_of(f.surface().kinks(0), part.box.side(0)) +
                kink_bound_of(f.surface().kinks(1), part.box.side(1)) + own.apart;
        }
        // Half of the ways across from the nearest point; second derivatives may have no bounds.
        if (!(e <= part.size)) e = part.size + own.apart;
        e *= 1 + 0x1p-40;
        if (points.empty()) return;
        detail::PairPart<3> out;
        if (e <= plain_) {
            out.slack = e;
            for (const Vec<3>& p : points) take(p, own, out);
        } else {
            const double reach = kOfBall * e;
            for (const Vec<3>& p : points)
                for (int k = 0; k < 6; ++k) {
                    Vec<3> q = p;
                    q[k / 2] += k % 2 ? reach : -reach;
                    take(q, own, out);
                }
            own.apart += reach;
            out.slack = 4 * kUnitRoundoff * out.box.scale();
        }
        places_.push_back(own);
        parts_.push_back(out);
    }
    void take(const Vec<3>& p, Place& own, detail::PairPart<3>& part) {
        points_.push_back(p);
        part.box.add(p);
        ++own.count;
    }
    // Of what the boundary leaves of a box; `sag`: by how much they are off it at most.
    static std::vector<Vec<2>> corners_of(const FaceParts& f, const FacePart& part, Vec<2>& sag) {
        std::vector<Vec<2>> out;
        const FaceRegion& region = f.region();
        const auto add = [&](const Vec<2>& x) {
            if (std::ranges::find(out, x) == out.end()) out.push_back(x);
        };
        for (const int i : part.near) {
            const Vec<2>& own = region.sag(std::size_t(i));
            for (int k = 0; k < 2; ++k) sag[k] = std::max(sag[k], 2 * own[k]);
            const auto ends = clipped(region.chord(std::size_t(i)), {part.box.lo - own, part.box.hi + own});
            if (!ends) continue;
            for (const Vec<2>& x : *ends)
                add({{clamped(x[0], part.box.side(0)), clamped(x[1], part.box.side(1))}});
        }
        for (int k = 0; k < 4; ++k) {
            const Vec<2> x{
                {k & 1 ? part.box.hi[0] : part.box.lo[0], k & 2 ? part.box.hi[1] : part.box.lo[1]}};
            const bool on_chord = std::ranges::any_of(part.near, [&](int i) {
                return region.meets({x, x}, std::size_t(i));
            });
            if (on_chord || region.is_inside(x)) add(x);
        }
        return out;
    }

    const detail::ModelParts& all_;
    OpenedParts opened_;
    double plain_;
    std::vector<detail::PairPart<3>> parts_;
    std::vector<Place> places_;
    std::vector<Vec<3>> points_;
};

}  // namespace

Result<ConvexHull<3>> convex_hull(const Model& model, double tolerance, int max_parts) {
    if (!(tolerance >= 0))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a length >= 0"));
    if (max_parts < 1) return refuse(RefusalKind::invalid, "max_parts", "is below 1");
    detail::ModelParts all{model};
    if (auto done = all.prepare(tolerance > 0 ? tolerance / 16 : kInfinity); !done)
        return std::unexpected(done.error());
    double size = 0;
    for (const NearLeaf& leaf : all.leaves)
        if (!std::isfinite(leaf.box.scale()))
            return refuse(RefusalKind::ill_conditioned, text("faces[", leaf.face, "]"), "has no box");
        else
            size = std::max(size, leaf.box.scale());
    ModelSide side(all, kPlain * size);
    return detail::hull_of_parts<3>(side, tolerance / 2, 32 * kUnitRoundoff * size, max_parts);
}

}  // namespace freiform
