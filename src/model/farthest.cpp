// The point of a model that is farthest from a given one.
//
// Idea. Branch and bound over the parts of faces and boundaries (near_parts.cpp), the one that may reach
// farthest first, as in bounds.cpp. The farthest point of a face is inside it, where the distance has a
// critical point, or on its boundary; so a part without one is done, wherever the boundary runs through it.
//
// Bounds. A part is within its error of the hull of its corners, over which the distance from q is largest at
// a corner: at most the largest |q - corner| + error. A boundary likewise, with the ends of its chord. Points
// found: middles of parts that are certainly on the face, ends of boundary parts.
//
// Accuracy. Distances: 64 u of the coordinates; points carry value_error_bound.
//
// Cost. As of a tight box in one direction. From the centre of a sphere all of it is as far, and the bound
// comes near with the square root of max_parts.
#include "near_parts_detail.hpp"

#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

class FarSearch {
public:
    FarSearch(const detail::ModelParts& all, const Vec<3>& q, const ModelNearestOptions& options)
        : all_(all), q_(q), opened_(all), parts_left_(options.max_parts) {
        double scale = max_abs(q);
        for (const NearNode& n : all.nodes) scale = std::max(scale, n.box.scale());
        rounding_ = 64 * kUnitRoundoff * scale;
        const double accuracy =
            std::max(options.accuracy > 0 ? options.accuracy : 0x1p-30 * all.size, 8 * rounding_);
        for (const NearLeaf& leaf : all.leaves)
            leaf.part >= 0 ? push_part(leaf.face, leaf.part, kInfinity) : push_rim(leaf.rim, kInfinity);
        double proven = 0;
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, {}, &Item::most);
            const Item item = heap_.back();
            heap_.pop_back();
            if (item.most <= best_.distance + accuracy || parts_left_-- <= 0) {
                proven = std::max(proven, item.most);
                break;
            }
            if (!(item.rim ? open_rim(item) : open_part(item))) proven = std::max(proven, item.most);
        }
        best_.upper_bound = std::max(proven, best_.distance + best_.point_error);
    }
    const ModelFarthest& best() const { return best_; }

private:
    struct Item {
        double most;
        int face, index;
        bool rim;
    };

    void push(int face, int index, bool rim, double most, double bound) {
        heap_.push_back({std::min(std::isnan(most) ? kInfinity : most + rounding_, bound), face, index, rim});
        std::ranges::push_heap(heap_, {}, &Item::most);
    }
    void push_part(int face, int index, double bound) {
        const FacePart& p = opened_.part(index);
        double most = 0;
        for (const Vec<3>& x : p.corner) most = std::max(most, norm(x - q_));
        const Vec<2> middle = 0.5 * (p.box.lo + p.box.hi);
        if (all_.faces[std::size_t(face)].holds(p, middle)) take(face, -1, middle);
        push(face, index, false, most + p.beside_corners(), bound);
    }
    void push_rim(int index, double bound) {
        const FaceRim& r = opened_.rim(index);
        for (const Vec<2>& uv : r.uv) take(r.owner, r.coedge ? r.coedge->edge : -1, uv);
        push(r.owner, index, true, std::max(norm(r.end[0] - q_), norm(r.end[1] - q_)) + r.error, bound);
    }
    void take(int face, int edge, const Vec<2>& uv) {
        const Vec<3> x = all_.faces[std::size_t(face)].value(uv);
        const double d = norm(x - q_);
        if (!(d > best_.distance) && best_.face >= 0) return;
        const Interval u{uv[0], uv[0]}, v{uv[1], uv[1]};
        const double error =
            2 * value_error_bound(all_.model.faces[std::size_t(face)].surface, {u, v}) + rounding_;
        best_ = {face, edge, uv, x, d, error, 0};
    }
    bool open_part(const Item& item) {
        const FaceParts& face = all_.faces[std::size_t(item.face)];
        if (!all_.model.faces[std::size_t(item.face)].loops.empty() &&
            !face.may_have_foot(opened_.part(item.index), q_))
            return true;
        return opened_.halve_part(item.face, item.index,
                                  [&](int half) { push_part(item.face, half, item.most); });
    }
    bool open_rim(const Item& item) {
        return opened_.halve_rim(item.index, [&](int half) { push_rim(half, item.most); });
    }

    const detail::ModelParts& all_;
    Vec<3> q_;
    double rounding_ = 0;
    ModelFarthest best_;
    std::vector<Item> heap_;
    OpenedParts opened_;
    int parts_left_;
};

}  // namespace

Result<ModelFarthest> ModelNearestQuery::farthest(const Vec<3>& point,
                                                  const ModelNearestOptions& options) const {
    if (auto ok = detail::check_points<3>(std::span(&point, 1), options.accuracy, options.max_parts); !ok)
        return std::unexpected(ok.error());
    return FarSearch(*prepared_, point, options).best();
}

}  // namespace freiform
