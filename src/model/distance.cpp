// Idea. Branch and bound over pairs of parts of faces and of boundaries (query/pair_search.hpp). The
// tree of boxes of each model comes first, then its prepared parts (near_parts.cpp), then their halves: a
// part is within its error of the hull of its corners, a part of a boundary within its error of its chord.
// Every pair that is opened offers the points in the middle of its parts, where these are certainly on the
// faces; a pair that is nearer than the best takes its place, and is followed to one where each point is the
// nearest of its model to the other one (nearest.cpp, in turn), unless that was done often for little.
//
// Accuracy. Errors of parts hold rounding; boxes and scalar products: 64 u of the coordinates.
//
// Cost. Some thousand pairs where one pair of places is nearest. Parts through which the boundary of a face
// runs reach beyond it by their size, so that there the bound comes near with the size, not with its square.
#include "near_parts_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/distance.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/query/pair_search.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using detail::PairPart;

constexpr int kPartsToFollow = 2000;  // most are done with a tenth
constexpr int kMostFollowed = 64;
constexpr double kWorth = 0.99;

// The parts of a model as query/pair_search.hpp wants them.
class ModelSide {
public:
    struct Place {
        int node = -1, face = -1;
        int part = -1, rim = -1;  // with a face: one of them, in parts_own_ or rims_
        std::size_t hull = 0, hulls = 0;
    };

    explicit ModelSide(const detail::ModelParts& all) : all_(all) { add_node(0); }

    const std::vector<PairPart<3>>& parts() const { return parts_; }
    std::span<const Vec<3>> hull(int i) const {
        const Place& p = places_[std::size_t(i)];
        return {points_.data() + p.hull, p.hulls};
    }
    const detail::ModelParts& all() const { return all_; }

    bool split(int i) {
        if (parts_[std::size_t(i)].first >= 0) return true;
        const int first = int(parts_.size());
        const Place p = places_[std::size_t(i)];
        if (p.node >= 0 ? !split_node(p) : p.part >= 0 ? !split_part(p) : !split_rim(p)) return false;
        parts_[std::size_t(i)].first = first;
        parts_[std::size_t(i)].end = int(parts_.size());
        return true;
    }
    // A point of the part that is certainly on its face.
    std::optional<ModelNearest> point_of(int i) const {
        const Place& p = places_[std::size_t(i)];
        ModelNearest out;
        out.face = p.face;
        if (p.part >= 0) {
            const FacePart& part = face_parts_[std::size_t(p.part)];
            out.uv = 0.5 * (part.box.lo + part.box.hi);
            if (!all_.faces[std::size_t(p.face)].holds(part, out.uv)) return {};
        } else if (p.rim >= 0) {
            const FaceRim& rim = rims_[std::size_t(p.rim)];
            out.uv = rim.uv[0];
            if (rim.coedge) {
                const Edge& edge = all_.model.edges[std::size_t(rim.coedge->edge)];
                out.edge = rim.coedge->edge, out.t = rim.on.lo;
                if (out.t <= edge.range.lo || edge.degenerate) out.vertex = edge.start;
            }
        } else {
            return {};
        }
        const SurfaceGeometry& surface = all_.model.faces[std::size_t(p.face)].surface;
        const Interval u{out.uv[0], out.uv[0]}, v{out.uv[1], out.uv[1]};
        out.point = all_.faces[std::size_t(p.face)].value(out.uv);
        out.point_error = 2 * value_error_bound(surface, {u, v}) + 64 * kUnitRoundoff * max_abs(out.point);
        return out;
    }

private:
    void add(Place p, std::span<const Vec<3>> hull, double error) {
        p.hull = points_.size();
        p.hulls = hull.size();
        PairPart<3> part;
        for (const Vec<3>& x : hull) part.box.add(x);
        part.slack = std::isnan(error) ? kInfinity : error;
        points_.insert(points_.end(), hull.begin(), hull.end());
        places_.push_back(p);
        parts_.push_back(part);
    }
    void add_node(int i) {
        const Box<3>& box = all_.nodes[std::size_t(i)].box;
        std::array<Vec<3>, 8> corner;
        for (unsigned c = 0; c < 8; ++c)
            for (int k = 0; k < 3; ++k) corner[c][k] = (c >> k & 1 ? box.hi : box.lo)[k];
        Place p;
        p.node = i;
        add(p, corner, 0);
    }
    void add_part(int face, FacePart part) {
        Place p;
        p.face = face;
        p.part = int(face_parts_.size());
        face_parts_.push_back(std::move(part));
        add(p, face_parts_.back().corner, face_parts_.back().beside_corners());
    }
    void add_rim(const FaceRim& rim) {
        Place p;
        p.face = rim.owner;
        p.rim = int(rims_.size());
        rims_.push_back(rim);
        add(p, rim.end, rim.error);
    }
    bool split_node(const Place& p) {
        const NearNode& node = all_.nodes[std::size_t(p.node)];
        if (node.left >= 0) {
            add_node(node.left);
            add_node(node.left + 1);
            return true;
        }
        for (int i = node.begin; i < node.end; ++i) {
            const NearLeaf& leaf = all_.leaves[std::size_t(i)];
            if (leaf.part >= 0)
                add_part(leaf.face, all_.parts[std::size_t(leaf.part)]);
            else
                add_rim(all_.rims[std::size_t(leaf.rim)]);
        }
        return true;
    }
    bool split_part(const Place& p) {
        const FacePart part = face_parts_[std::size_t(p.part)];
        bool can = false;
        for (int k = 0; k < 2; ++k) {
            const double m = part.box.side(k).middle();
            can = can || (part.box.lo[k] < m && m < part.box.hi[k]);
        }
        if (!can) return false;
        // By turns where it is longer, which brings boxes apart, and where it bends more: near a pole only
        // that makes the error fall with the square of the size.
        const bool by_bend = part.halvings % 2 == 0;
        for (FacePart& half : all_.faces[std::size_t(p.face)].halves(part, by_bend))
            add_part(p.face, std::move(half));
        return true;
    }
    bool split_rim(const Place& p) {
        const FaceRim rim = rims_[std::size_t(p.rim)];
        const double middle = rim.on.middle();
        if (!rim.coedge) {  // a jump between two curves: a straight line in the parameters
            const Face& face = all_.model.faces[std::size_t(rim.owner)];
            const Vec<2> m = 0.5 * (rim.uv[0] + rim.uv[1]);
            if (m == rim.uv[0] || m == rim.uv[1]) return false;
            for (const auto& [from, to] : {std::pair(rim.uv[0], m), {m, rim.uv[1]}}) {
                FaceRim half = FaceRim::jump(face, all_.faces[std::size_t(rim.owner)].surface(), from, to);
                half.owner = rim.owner;
                add_rim(half);
            }
            return true;
        }
        if (!(rim.on.lo < middle && middle < rim.on.hi)) return false;
        for (const Interval half : {Interval{rim.on.lo, middle}, Interval{middle, rim.on.hi}})
            add_rim(all_.rim_over(rim.owner, rim.coedge, rim.curve, half));
        return true;
    }

    const detail::ModelParts& all_;
    std::vector<PairPart<3>> parts_;
    std::vector<Place> places_;
    std::vector<Vec<3>> points_;
    std::vector<FacePart> face_parts_;
    std::vector<FaceRim> rims_;
};

struct PairOfModels {
    const ModelNearestQuery &a, &b;
    const ModelSide &side_a, &side_b;
    double accuracy;
    std::array<ModelNearest, 2> best{};
    double least = kInfinity;
    int followed = 0;  // of those that were hardly nearer

    // From x on: the nearest point of b, then that of a to it, and so on while it gets nearer.
    void follow(Vec<3> x) {
        for (int turn = 0; turn < 32; ++turn) {
            const auto y = b.nearest(x, {.accuracy = accuracy / 4, .max_parts = kPartsToFollow});
            if (!y) return;
            const auto z = a.nearest(y->point, {.accuracy = accuracy / 4, .max_parts = kPartsToFollow});
            if (!z) return;
            const double before = least;
            if (z->distance < least) {
                least = z->distance;
                best = {*z, *y};
            }
            if (!(z->distance < before - accuracy / 4)) return;
            x = z->point;
        }
    }
    Vec<3> look(int i, int k) {
        const auto x = side_a.point_of(i), y = side_b.point_of(k);
        if (!x || !y) return {};
        const Vec<3> apart = x->point - y->point;
        if (const double d = norm(apart); d < least) {
            const bool is_worth_it = d < kWorth * least || followed++ < kMostFollowed;
            least = d;
            best = {*x, *y};
            if (is_worth_it) follow(x->point);
        }
        return apart;
    }
};

}  // namespace

Result<ModelDistance> least_distance(const ModelNearestQuery& a, const ModelNearestQuery& b,
                                     const DistanceOptions& options) {
    if (auto ok = detail::check_accuracy(options.accuracy); !ok) return std::unexpected(ok.error());
    if (options.max_pairs < 1) return refuse(RefusalKind::invalid, "max_pairs", "is below 1");
    ModelSide x(a.parts()), y(b.parts());
    double scale = 0;
    for (const auto* all : {&a.parts(), &b.parts()}) scale = std::max(scale, all->nodes[0].box.scale());
    const double rounding = 128 * kUnitRoundoff * scale;
    const double size = a.parts().size + b.parts().size;
    const double accuracy = std::max(options.accuracy > 0 ? options.accuracy : 0x1p-24 * size, 8 * rounding);
    PairOfModels pair{a, b, x, y, accuracy};
    const Box<3>& box = b.parts().nodes[0].box;
    pair.follow(0.5 * box.lo + 0.5 * box.hi);  // somewhere to begin with
    const double lower = detail::least_of_pairs<3>(x, y, accuracy, rounding, options.max_pairs, pair.least,
                                                   [&](int i, int k) { return pair.look(i, k); });
    ModelDistance out;
    out.at = pair.best;
    out.distance = norm(out.at[0].point - out.at[1].point);
    out.point_error = out.at[0].point_error + out.at[1].point_error;
    out.lower_bound = std::min(std::max(lower, 0.0), out.distance);
    for (ModelNearest& n : out.at) n.distance = out.distance, n.lower_bound = out.lower_bound;
    return out;
}

}  // namespace freiform
