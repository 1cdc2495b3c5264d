// Convex hulls of models.
//
// Idea. The model is near to the hull H of points on it: the corners of parts of its faces. A part that
// leaves its corners by no more than H is deep there is inside of H, and stays so, since H only grows; other
// ones are halved until they leave their corners by no more than a fraction of the tolerance. H made larger
// by that contains all.
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
// Cost. About 1 / tolerance parts of curved faces, and each round the product of those that are open with
// the facets of H.
//
// Why not the mesh of tessellate(), made larger by its bound? It has as many points inside of the hull as on
// it, and its tolerance is that of every face, not only of those that are outermost.
#include "near_parts_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/model/bounds.hpp>
#include <freiform/query/hull_search.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kOfTolerance = 1.0 / 8;  // that parts may leave their points by, at first
constexpr int kMostShares = 8;            // halvings of that, where H is thin and grows by more

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

class ModelHull {
public:
    explicit ModelHull(const detail::ModelParts& all) : all_(all), opened_(all) {
        for (const NearLeaf& leaf : all.leaves) {
            size_ = std::max(size_, leaf.box.scale());
            if (leaf.part >= 0) add(leaf.face, leaf.part);
        }
        grid_ = size_ > 0 ? std::scalbn(1.0, std::ilogb(size_) - 45) : 1;  // as in hull_search.hpp
    }

    ConvexHull<3> within(double tolerance, int max_parts) {
        double share = std::max(kOfTolerance * tolerance, 4 * grid_);
        for (int shares = 0;;) {
            const detail::PointHull<3> hull = hull_of_points();
            drop_hidden(hull);
            if (int(leaves_.size()) < max_parts && halve_above(share)) continue;
            double most = 0;
            for (const Leaf& leaf : leaves_) most = std::max(most, leaf.leaves_by);
            const double off = most + off_model_ + grid_;
            ConvexHull<3> out = detail::grown<3>(points_, hull, off);
            out.slack = (out.slack + off_model_ + grid_) * (1 + 0x1p-40);
            if (out.slack <= tolerance || ++shares > kMostShares || int(leaves_.size()) >= max_parts ||
                !(most > 8 * grid_))
                return out;
            share = std::max(most / 2, 4 * grid_);
        }
    }

private:
    struct Leaf {
        int face = -1, part = -1;
        std::vector<Vec<3>> corners;
        double leaves_by = 0;  // bound: how far the part is from the hull of its corners
    };

    void add(int face, int index) {
        const FacePart& part = opened_.part(index);
        const FaceParts& f = all_.faces[std::size_t(face)];
        Leaf own{face, index, {part.corner.begin(), part.corner.end()}, part.hull_error};
        double off = part.rounding;
        if (part.crossing) {
            const auto bent = f.surface()({part.box.side(0), part.box.side(1)});
            const Vec<2> size = part.box.hi - part.box.lo;
            Vec<2> sag{};
            own.corners.clear();
            const auto corners = corners_of(f, part, sag);
            for (const Vec<2>& uv : corners) own.corners.push_back(f.value(uv));
            double beside = moved(bent, sag);
            if (f.surface().base() != nullptr) {  // there it may be much less than over all of the part
                beside = 0;
                for (const Vec<2>& uv : corners)
                    beside = std::max(beside, moved(f.surface()({Interval{uv[0] - sag[0], uv[0] + sag[0]},
                                                                 Interval{uv[1] - sag[1], uv[1] + sag[1]}},
                                                                1),
                                                    sag));
            }
            off += beside <= 2 * part.size ? beside : 2 * part.size;
            own.leaves_by = (bent(2, 0) * size[0] * size[0] + 2 * bent(1, 1) * size[0] * size[1] +
                             bent(0, 2) * size[1] * size[1]) /
                                8 +
                            kink_bound_of(f.surface().kinks(0), part.box.side(0)) +
                            kink_bound_of(f.surface().kinks(1), part.box.side(1)) + off;
        }
        // Second derivatives may have no bounds: no point of the box is farther from a corner than both
        // sides.
        if (!(own.leaves_by <= 2 * part.size)) own.leaves_by = 2 * part.size + off;
        own.leaves_by *= 1 + 0x1p-40;
        if (own.corners.empty()) return;
        off_model_ = std::max(off_model_, off);
        points_.insert(points_.end(), own.corners.begin(), own.corners.end());
        leaves_.push_back(std::move(own));
    }
    // Of the corners of H and of the points that came since, each once, on the grid.
    detail::PointHull<3> hull_of_points() {
        std::size_t at = 0;
        std::erase_if(points_, [&](const Vec<3>&) { return at < inner_.size() && inner_[at++]; });
        for (Vec<3>& p : points_)
            for (int k = 0; k < 3; ++k) p[k] = std::nearbyint(p[k] / grid_) * grid_;
        sort(points_, {}, &Vec<3>::c);
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        detail::PointHull<3> hull(points_);
        inner_.assign(hull.facets.empty() ? 0 : points_.size(), true);
        for (const auto& f : hull.facets)
            for (const auto i : f) inner_[std::size_t(i)] = false;
        return hull;
    }
    void drop_hidden(const detail::PointHull<3>& hull) {
        if (hull.facets.empty()) return;
        struct Facet {
            Vec<3> n;
            double at;
        };
        std::vector<Facet> facets;
        for (const auto& f : hull.facets) {
            const Vec<3>& a = points_[std::size_t(f[0])];
            const Vec<3> n = unit(cross(points_[std::size_t(f[1])] - a, points_[std::size_t(f[2])] - a));
            facets.push_back({n, std::min({dot(n, a), dot(n, points_[std::size_t(f[1])]),
                                           dot(n, points_[std::size_t(f[2])])})});
        }
        const double rounding = 2 * grid_ + 32 * kUnitRoundoff * size_;
        std::size_t last = 0;  // the facet that kept the leaf before: often it keeps its neighbour
        std::erase_if(leaves_, [&](const Leaf& leaf) {
            const double depth = leaf.leaves_by + rounding;
            const auto is_behind = [&](const Facet& f) {
                return std::ranges::all_of(leaf.corners,
                                           [&](const Vec<3>& x) { return dot(f.n, x) <= f.at - depth; });
            };
            if (!is_behind(facets[last])) return false;
            const auto before = std::ranges::find_if_not(facets, is_behind);
            if (before == facets.end()) return true;
            last = std::size_t(before - facets.begin());
            return false;
        });
    }
    bool halve_above(double share) {
        std::vector<Leaf> whole;
        std::swap(whole, leaves_);
        bool any = false;
        for (Leaf& leaf : whole) {
            const bool done =
                leaf.leaves_by > share &&
                opened_.halve_part(leaf.face, leaf.part, [&](int half) { add(leaf.face, half); });
            any = any || done;
            if (!done) leaves_.push_back(std::move(leaf));
        }
        return any;
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
    double size_ = 0, grid_ = 0;
    double off_model_ = 0;  // bound: of the points, from the model
    std::vector<Leaf> leaves_;
    std::vector<Vec<3>> points_;
    std::vector<char> inner_;  // of those that H was made of: inside of it
};

}  // namespace

Result<ConvexHull<3>> convex_hull(const Model& model, double tolerance, int max_parts) {
    if (!(tolerance >= 0))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a length >= 0"));
    if (max_parts < 1) return refuse(RefusalKind::invalid, "max_parts", "is below 1");
    detail::ModelParts all{model};
    if (auto done = all.prepare(tolerance > 0 ? tolerance / 16 : kInfinity); !done)
        return std::unexpected(done.error());
    for (const NearLeaf& leaf : all.leaves)
        if (!std::isfinite(leaf.box.scale()))
            return refuse(RefusalKind::ill_conditioned, text("faces[", leaf.face, "]"), "has no box");
    return ModelHull(all).within(tolerance, max_parts);
}

}  // namespace freiform
