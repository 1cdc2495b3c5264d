// Faces are cut until their parts are flat within a part of the size of the model, or there are many of them;
// so are their boundaries. Then a tree of boxes, halved at the median along its longest side.
#include "near_parts_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kBoxRoundings = 64 * 0x1p-53;
constexpr double kFlatEnough = 0.02;        // of the size of the model: how coarse prepared parts may be
constexpr std::size_t kPreparedParts = 48;  // of a face
constexpr std::size_t kPartsToKnow = 4096;  // likewise, where nothing is known of the coarser ones
constexpr double kRegionSag = 1e-5;  // of the size of the model: how well boundaries of regions are known

Box<3> fattened(std::span<const Vec<3>> points, double by) {
    Box<3> box;
    for (const Vec<3>& p : points) box.add(p);
    const double fat = by + kBoxRoundings * box.scale();
    return {box.lo - Box<3>::filled(fat), box.hi + Box<3>::filled(fat)};
}

}  // namespace

void detail::ModelParts::add_parts(int face) {
    const FaceParts& f = faces[std::size_t(face)];
    std::vector<FacePart> own;
    if (auto whole = f.whole()) own.push_back(std::move(*whole));
    while (!own.empty()) {
        const auto worst = std::ranges::max_element(own, {}, &FacePart::error);
        if (!(worst->error > kFlatEnough * size)) break;
        if (own.size() >= (std::isfinite(worst->beside_corners()) ? kPreparedParts : kPartsToKnow)) break;
        const FacePart part = std::move(*worst);
        *worst = std::move(own.back());
        own.pop_back();
        auto halves = f.halves(part);
        for (FacePart& half : halves) own.push_back(std::move(half));
    }
    for (FacePart& p : own) {
        leaves.push_back({face, int(parts.size()), -1, fattened(p.corner, p.beside_corners())});
        parts.push_back(std::move(p));
    }
}

void detail::ModelParts::add_rims(int face) {
    const auto add = [&](const FaceRim& rim) {
        leaves.push_back({face, -1, int(rims.size()), fattened(rim.end, rim.error)});
        rims.push_back(rim);
    };
    for (const Loop& loop : model.faces[std::size_t(face)].loops) {
        std::vector<std::array<Vec<2>, 2>> ends;
        for (const Coedge& c : loop.coedges) {
            const DerivativeQuery<1, 2>* curve = &curves.emplace_back(c.curve);
            const Interval range = model.edges[std::size_t(c.edge)].range;
            std::vector<Interval> stack{range};
            for (std::size_t made = 0; !stack.empty();) {
                const Interval on = stack.back();
                stack.pop_back();
                const FaceRim rim = rim_over(face, &c, curve, on);
                const double middle = on.middle();
                if (rim.error > kFlatEnough * size && made + stack.size() < kPreparedParts &&
                    on.lo < middle && middle < on.hi) {
                    stack.push_back({middle, on.hi});
                    stack.push_back({on.lo, middle});
                    continue;
                }
                add(rim), ++made;
            }
            const FaceRim whole = rim_over(face, &c, curve, range);
            ends.push_back({whole.uv[c.reversed ? 1 : 0], whole.uv[c.reversed ? 0 : 1]});
        }
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const Vec<2> from = ends[i][1], to = ends[(i + 1) % ends.size()][0];
            if (from == to) continue;
            FaceRim jump =
                FaceRim::jump(model.faces[std::size_t(face)], faces[std::size_t(face)].surface(), from, to);
            jump.owner = face;
            add(jump);
        }
    }
}

void detail::ModelParts::build() {
    const auto box_over = [&](int begin, int end) {
        Box<3> box;
        for (int i = begin; i < end; ++i) box.add(leaves[std::size_t(i)].box);
        return box;
    };
    nodes.push_back({box_over(0, int(leaves.size())), 0, int(leaves.size()), -1});
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const int begin = nodes[n].begin, end = nodes[n].end;
        if (end - begin <= 4) continue;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (nodes[n].box.side(k).length() > nodes[n].box.side(axis).length()) axis = k;
        const int middle = begin + (end - begin) / 2;
        std::nth_element(leaves.begin() + begin, leaves.begin() + middle, leaves.begin() + end,
                         [&](const NearLeaf& a, const NearLeaf& b) {
                             const double x = a.box.side(axis).middle(), y = b.box.side(axis).middle();
                             return x != y ? x < y : std::pair(a.part, a.rim) < std::pair(b.part, b.rim);
                         });
        nodes[n].left = int(nodes.size());
        nodes.push_back({box_over(begin, middle), begin, middle, -1});
        nodes.push_back({box_over(middle, end), middle, end, -1});
    }
}

Result<void> detail::ModelParts::prepare(double sag) {
    if (model.faces.empty()) return refuse(RefusalKind::invalid, "model", "has no faces");
    size = summary(model).box.diagonal();
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        auto made = FaceParts::make(model.faces[f], model.edges, std::min(sag, kRegionSag * size));
        if (!made) return refuse_within(text("faces[", f, "]"), made.error());
        faces.push_back(std::move(*made));
    }
    for (int f = 0; f < int(faces.size()); ++f) {
        add_parts(f);
        add_rims(f);
    }
    if (leaves.empty()) return refuse(RefusalKind::invalid, "model", "has faces without points only");
    for (const NearLeaf& leaf : leaves)
        if (std::isnan(leaf.box.lo[0]))
            return refuse(RefusalKind::ill_conditioned, text("faces[", leaf.face, "]"), "has no box");
    build();
    return {};
}

}  // namespace freiform
