// Places where a surface has no triangles because parameters are doubles.
//
// Idea: where weights of one piece differ by many powers of ten the surface goes from one side to the other
// between two neighbouring parameters. All boxes there are too large until none can be halved, and on the
// way to them are more leaves than memory has room for. So before a tree is grown its worst box is looked
// for alone: of each box the half with the larger error, until that keeps the tolerance (then nothing is
// said), or cannot be halved: then it is a leaf of the tree, none of whose triangles keeps the tolerance.
//
// Cost: two bounds for each halving, some hundreds in all; for surfaces with such weights alone. Why not a
// limit of the weights: a light point in the middle of heavy ones does no harm.
#include "curvature_tree_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/segment_box.hpp>

#include <cmath>

namespace freiform {

namespace {

struct WorstBox {
    Box<2> box;
    std::vector<std::array<int, 2>> near;  // segments
    bool inside = false;                   // wholly
    Bending bending;
    double error = 0;
};

}  // namespace

// Nothing, if nothing is known to be in the way.
std::optional<Refusal> CurvatureTree::torn_place(const DerivativeQuery<2, 3>& surface,
                                                 std::span<const Vec<2>> polygon,
                                                 std::span<const std::array<int, 2>> segments,
                                                 double tolerance) const {
    if (!(surface.weight_spread() > kWeightsFarApart)) return std::nullopt;
    const auto look = [&](WorstBox& w) {
        const Vec<2> size = w.box.hi - w.box.lo;
        w.bending = bending_of(surface, w.box, knows_normals_);
        w.error = w.bending.full.along(size[0], size[1]) / 8 + kink_bound(w.box);
        if (std::isnan(w.error)) w.error = kInfinity;
        return !keeps(w.bending, w.box.hi - w.box.lo, meets_kink(w.box), w.error, tolerance);
    };
    const auto half_of = [&](const WorstBox& whole, int axis, double at, bool upper) {
        WorstBox part{whole.box, {}, whole.inside, {}, 0};
        (upper ? part.box.lo : part.box.hi)[axis] = at;
        for (const auto& s : whole.near)
            if (meets(part.box, polygon[std::size_t(s[0])], polygon[std::size_t(s[1])]))
                part.near.push_back(s);
        return part;
    };
    WorstBox worst{nodes_[0].box, {segments.begin(), segments.end()}, false, {}, 0};
    if (!look(worst)) return std::nullopt;
    for (int depth = 0; depth < kMaxTreeDepth; ++depth) {
        const Vec<2> size = worst.box.hi - worst.box.lo;
        const Curvature& c = worst.bending.full;
        const int longer = !(c.uu * size[0] * size[0] < c.vv * size[1] * size[1]) ? 0 : 1;
        auto cut_at = cut(Node{worst.box}, longer);
        if (!cut_at) cut_at = cut(Node{worst.box}, 1 - longer);
        if (!cut_at) break;
        std::optional<WorstBox> next;
        for (const bool upper : {false, true}) {
            WorstBox part = half_of(worst, cut_at->axis, cut_at->at, upper);
            if (part.near.empty() && !part.inside) {
                part.inside = rows_->is_inside(0.5 * (part.box.lo + part.box.hi));
                if (!part.inside) continue;
            }
            if (look(part) && (!next || part.error > next->error)) next = std::move(part);
        }
        if (!next) return std::nullopt;
        worst = std::move(*next);
    }
    return Refusal{RefusalKind::ill_conditioned, text("u = ", worst.box.lo[0], ", v = ", worst.box.lo[1]),
                   text("the weights of the surface differ by a factor of ", surface.weight_spread(),
                        ": between neighbouring parameters it moves by more than the tolerance ", tolerance)};
}

}  // namespace freiform
