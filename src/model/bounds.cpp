// Idea. How far a model reaches in a direction n: branch and bound over parts of faces and of their
// boundaries (near_parts.cpp), the one that may reach farthest first. Where n . x is largest over a face it
// has a critical point inside, or that is on the boundary. So parts where n . x_u or n . x_v certainly does
// not vanish are done, and boundaries are followed as curves: the bound comes near with the square of the
// parts' size, along edges too. Points that certainly belong to the model (ends of boundary parts, corners of
// parts that are wholly inside) say how far it reaches at least.
//
// Accuracy. face_parts.cpp and face_rim.cpp bound how far a part leaves its corners or chord, rounding
// included; scalar products with coordinate axes are exact.
//
// References. As in query/bounds.cpp, where control points do what parts do here.
#include "near_parts_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/model/bounds.hpp>
#include <freiform/query/checks.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// The reach in a direction n of length 1. `rounding`: of n . x, none along a coordinate axis.
class Reach {
public:
    Reach(const detail::ModelParts& all, const Vec<3>& n, double rounding, double accuracy, int max_parts)
        : all_(all), n_(n), rounding_(rounding), parts_left_(max_parts), opened_(all) {
        for (const NearLeaf& leaf : all.leaves)
            leaf.part >= 0 ? push_part(leaf.face, leaf.part, kInfinity) : push_rim(leaf.rim, kInfinity);
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, {}, &Item::most);
            const Item item = heap_.back();
            heap_.pop_back();
            most_ = item.most;
            if (item.most <= least_ + accuracy || parts_left_-- <= 0) return;
            if (!(item.rim ? open_rim(item) : open_part(item))) return;
        }
        most_ = least_;
    }

    double most() const { return most_ + rounding_; }    // upper bound
    double least() const { return least_ - rounding_; }  // and a lower one

private:
    struct Item {
        double most;
        int face, index;
        bool rim;
    };

    double along(const Vec<3>& x) const { return dot(n_, x); }
    void push(const Item& item, double bound) {
        heap_.push_back(item);
        double& most = heap_.back().most;
        most = std::min(std::isnan(most) ? kInfinity : most, bound);
        std::ranges::push_heap(heap_, {}, &Item::most);
    }
    void push_part(int face, int index, double bound) {
        const FacePart& p = opened_.part(index);
        double most = -kInfinity;
        for (const Vec<3>& x : p.corner) most = std::max(most, along(x));
        if (!p.crossing) least_ = std::max(least_, most - p.rounding);
        push({most + p.beside_corners(), face, index, false}, bound);
    }
    void push_rim(int index, double bound) {
        const FaceRim& r = opened_.rim(index);
        for (int k = 0; k < 2; ++k) {
            const Vec<2>& uv = r.uv[std::size_t(k)];
            const double off = 2 * value_error_bound(all_.model.faces[std::size_t(r.owner)].surface,
                                                     {Interval{uv[0], uv[0]}, Interval{uv[1], uv[1]}});
            least_ = std::max(least_, along(r.end[std::size_t(k)]) - off);
        }
        push({std::max(along(r.end[0]), along(r.end[1])) + r.error, r.owner, index, true}, bound);
    }
    bool open_part(const Item& item) {
        const FaceParts& face = all_.faces[std::size_t(item.face)];
        if (!all_.model.faces[std::size_t(item.face)].loops.empty() &&
            !face.may_be_level(opened_.part(item.index), n_))
            return true;
        return opened_.halve_part(item.face, item.index,
                                  [&](int half) { push_part(item.face, half, item.most); });
    }
    bool open_rim(const Item& item) {
        return opened_.halve_rim(item.index, [&](int half) { push_rim(half, item.most); });
    }

    const detail::ModelParts& all_;
    Vec<3> n_;
    double rounding_;
    int parts_left_;
    double least_ = -kInfinity, most_ = kInfinity;
    std::vector<Item> heap_;
    OpenedParts opened_;
};

}  // namespace

Result<TightBox<3>> tight_box(const Model& model, double accuracy, int max_parts) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    detail::ModelParts all{model};
    if (auto done = all.prepare(); !done) return std::unexpected(done.error());
    TightBox<3> out;
    for (int axis = 0; axis < 3; ++axis) {
        Vec<3> n{};
        n[axis] = 1;
        const Reach up(all, n, 0, accuracy, max_parts), down(all, -1.0 * n, 0, accuracy, max_parts);
        out.box.hi[axis] = up.most();
        out.box.lo[axis] = -down.most();
        out.slack = std::max({out.slack, up.most() - up.least(), down.most() - down.least()});
    }
    return out;
}

Result<OrientedBox<3>> oriented_box(const Model& model, double accuracy, int max_parts) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    detail::ModelParts all{model};
    if (auto done = all.prepare(); !done) return std::unexpected(done.error());
    std::vector<Vec<3>> points;
    double scale = 0;
    for (const FacePart& p : all.parts)
        if (!p.crossing) points.insert(points.end(), p.corner.begin(), p.corner.end());
    for (const FaceRim& r : all.rims) points.insert(points.end(), r.end.begin(), r.end.end());
    for (const NearNode& n : all.nodes) scale = std::max(scale, n.box.scale());
    OrientedBox<3> out;
    out.axes = box_axes(hull_around(points));
    const double rounding =
        16 * kUnitRoundoff * scale;  // 8 of products and sums, |x| up to sqrt(3) of a coordinate
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec<3>& n = out.axes[k];
        const Reach up(all, n, rounding, accuracy, max_parts),
            down(all, -1.0 * n, rounding, accuracy, max_parts);
        out.range[k] = {-down.most(), up.most()};
        out.slack = std::max({out.slack, up.most() - up.least(), down.most() - down.least()});
    }
    return out;
}

}  // namespace freiform
