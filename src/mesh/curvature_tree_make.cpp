// How the tree of curvature_tree.cpp is made: by halving boxes.
//
// Cost. What bounds over a small box cost is mostly the restriction of control points to it, which are many
// where degrees are high. But a second derivative over the box is at most what it is in the middle, and half
// the sides of the box times third derivatives, for which bounds over something longer will do. So where
// control points are many, they are asked about boxes of some leaves, and leaves by one sample each; and
// where that is too much for a leaf, of its own box, so that no leaf is halved for want of a better bound.
//
// Splines of few numbers are asked about as they are beside a quadratic function (bending.cpp), which says
// more for as much; not over many pieces, where bounds are far from everything anyway.
//
// Threads. A face that threads share has its tree begun breadth first, until there are enough boxes; each
// of these is then grown by itself. Where it is cut does not depend on the number of threads.
//
// Accuracy. The sample is off by roundings for which DerivativeQuery::second_rounding has a bound. Why not
// for small pieces: with 16 control points of four numbers the sample costs as much as the bound.
#include "curvature_tree_grower_detail.hpp"
#include "serial_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/segment_box.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace freiform {

namespace {

constexpr double kLittleTilt = 0.25;
constexpr std::size_t kPartsOfTree = 64;
constexpr double kLeavesAtOnce = 16;
constexpr std::size_t kLeavesCounted = 256;  // at once
constexpr double kNodesOfTriangle = 1.5;     // expected
constexpr double kMostNodes = 1 << 20;       // expected: 80 MiB
constexpr std::size_t kManyNodes = 1 << 13;  // likewise
// Of a node: about twice as many as there are, as what is not touched costs nothing, and as allocators keep
// about as much for the next face as the largest piece that they were given back. At most 60 MiB.
constexpr double kBendingsOfNode = 0.5, kMostBendings = 1 << 17;
constexpr double kSmallPart = 0x1p-9;  // of a piece: there bounds of derivatives lose little
constexpr long long kFewNumbers = 96;  // of a piece: asking them is as cheap as a sample

std::size_t expected_nodes(const FaceDemands& demands) {
    const double nodes = kNodesOfTriangle * demands.expected_triangles;
    return std::size_t(nodes < kMostNodes ? nodes : kMostNodes);
}

// The axis along which a box of this size is to be cut: where the curvature asks for it, else the longer one.
int longer_side(const Curvature& c, const Vec<2>& size, const double (&length)[2]) {
    const double by_u = c.uu * size[0] * size[0], by_v = c.vv * size[1] * size[1],
                 by_both = c.uv * size[0] * size[1];
    if (by_both > std::max(by_u, by_v)) return length[0] >= length[1] ? 0 : 1;
    return by_u >= by_v ? 0 : 1;
}

// Of halves of a box of this size, by what is seen along the normal in the middle: of the better ones.
double least_error(const Curvature& seen, const Jet<2, 2, Vec<3>>& middle, const Vec<2>& size) {
    const Vec<3> m = cross(middle(1, 0), middle(0, 1));
    if (!(norm(m) > 0)) return seen.error(size);
    return Quadratic{seen.sure_uu, std::copysign(seen.uv, dot(m, middle(1, 1))), seen.sure_vv}.halves_error(
        size);
}

}  // namespace

// What is known of the box decides; whether it is fine, and whether it stays whole.
bool CurvatureTree::Grower::is_leaf(Node& node, const BoxBending& known) {
    const double tolerance = task_.demands.tolerance;
    const Box<2>& box = node.box;
    const Vec<2> size = box.hi - box.lo;
    const double error = known.full.along(size[0], size[1]) / 8 + tree_.kink_bound(box);
    for (int d = 0; d < 2; ++d) length_[d] = known.first[d] * size[d];
    const double longer = std::max(length_[0], length_[1]), shorter = std::min(length_[0], length_[1]);
    const bool round = longer <= task_.demands.max_aspect * shorter || longer <= tolerance;
    proof_ = {};
    fine_ = tree_.accept(node, known, error, tolerance, proof_);
    return fine_ && longer <= task_.demands.max_edge && round;
}

// Of sides as long as the middle says.
void CurvatureTree::Grower::set_lengths(const Jet<2, 2, Vec<3>>& middle, const Vec<2>& size) {
    for (int d = 0; d < 2; ++d) length_[d] = norm(middle.d[std::size_t(d + 1)]) * size[d];
}

// Control points. What holds for the whole holds for a part: of very small boxes rounding would make the
// bound larger.
BoxBending CurvatureTree::Grower::ask(Node& node, const Box<2>& box, const Jet<2, 2, Vec<3>>& middle) {
    const bool varies = tree_.varies(task_.surface, box);
    Variation variation;
    const bool knows_normals = tree_.knows_normals_ && !tree_.is_sharp_inside(box);
    BoxBending out =
        tree_.bending_in(task_.surface, box, knows_normals, middle, varies ? &variation : nullptr);
    if (varies) {
        node.variation = int(tree_.variations_.size());
        tree_.variations_.push_back(variation);
    }
    return out;
}

// Whether the box, which is inside, is a leaf that stands for many. Finds what is known of it, if that is
// asked.
bool CurvatureTree::Grower::is_block(const Item& item, const Jet<2, 2, Vec<3>>& middle,
                                     const BoxBending& around, std::optional<BoxBending>& own) {
    const double tolerance = task_.demands.tolerance;
    const Box<2> box = tree_.nodes_[std::size_t(item.node)].box;
    const double cells = tree_.cells_seen(jets_, box, middle, tolerance);
    if (!(cells > 0)) return false;
    own = around;
    if (!tree_.make_block(task_.surface, item.node, middle, cells, tolerance, *own)) return false;
    const auto& halves = tree_.blocks_.back().halves;
    uncounted_ += (std::size_t(1) << (halves[0] + halves[1])) - 1;
    return true;
}

std::optional<Refusal> CurvatureTree::Grower::take(const Item& item, std::vector<Item>& items) {
    const double tolerance = task_.demands.tolerance;
    Node& node = tree_.nodes_[std::size_t(item.node)];
    const Box<2> box = node.box;
    const Vec<2> size = box.hi - box.lo;
    bool inside = item.inside;
    if (item.near.empty() && !inside) {
        inside = tree_.rows_->is_inside(0.5 * (box.lo + box.hi));
        node.outside = !inside;
        if (node.outside) return std::nullopt;
    }
    node.variation = item.variation;
    node.inside = inside;
    // Bounds of a larger box do for this one where they are hardly larger: not where normals turn.
    Outer& shared = outers_[std::size_t(item.outer)];
    const BoxBending& around = shared.known;
    if (around.least > 0 && around.tilt <= kLittleTilt && is_leaf(node, around)) {
        stay_whole(node, shared);
        return std::nullopt;
    }
    // What is seen in the middle is no more than the bounds. Where it is too much already, as in all but the
    // last boxes, they need not be found.
    const auto middle = jets_.at<2>({box.side(0).middle(), box.side(1).middle()});
    const Curvature seen = tree_.seen_in(middle);
    set_lengths(middle, size);
    const bool may_be_halved = tree_.knows_normals_ && !node.has_columns();
    const double asked = may_be_halved ? least_error(seen, middle, size) : seen.error(size);
    std::optional<Cut> cut;
    if (asked > tolerance && item.depth < kMaxTreeDepth)
        cut = tree_.cut(node, longer_side(seen, size, length_));
    // Where control points are many, they are asked about boxes of some leaves, and within these the middle
    // and what varies tell.
    std::optional<BoxBending> of_block;  // large: what is known of a box is copied as rarely as can be
    const bool may_be_block = task_.blocks && inside && cut && !node.has_columns();
    if (may_be_block && is_block(item, middle, around, of_block)) return std::nullopt;
    const bool asks = !cut || (asked <= kLeavesAtOnce * tolerance && tree_.varies(task_.surface, box));
    if (item.variation < 0 && !asks) {
        if (of_block) outers_.emplace_back(*of_block);
        return split(item, of_block ? int(outers_.size()) - 1 : item.outer, *cut, inside, items);
    }
    BoxBending outer = item.variation >= 0
                           ? bending_from_middle(task_.surface, box, tree_.knows_normals_, middle,
                                                 tree_.variations_[std::size_t(item.variation)])
                           : ask(node, box, middle);
    outer.full.restrict_to(of_block ? of_block->full : around.full);
    if (!cut) {
        bool whole = is_leaf(node, outer) || !(size[0] > 0) || !(size[1] > 0);
        if (!whole && item.variation >= 0) {
            const Curvature before = outer.full;
            outer = ask(node, box, middle);
            outer.full.restrict_to(before);
            whole = is_leaf(node, outer);
        }
        const double error = outer.full.along(size[0], size[1]);
        if (!whole && item.depth == kMaxTreeDepth) {
            whole = std::isfinite(error);
            if (!whole)
                return Refusal{RefusalKind::ill_conditioned, text("u = ", box.lo[0], ", v = ", box.lo[1]),
                               "the surface has no bounded curvature here"};
        }
        if (!whole) {
            // Beside kinks all of the error is asked for.
            const bool beside_kinks = tree_.is_sharp() && tree_.meets_kink(box);
            const Curvature matters = outer.least > 0 && !beside_kinks ? outer.seen(0) : outer.full;
            if (!std::isfinite(error)) set_lengths(middle, size);  // bounds of which say nothing
            const int axis = fine_ || !std::isfinite(error) ? int(length_[0] < length_[1])
                                                            : longer_side(matters, size, length_);
            cut = tree_.cut(node, axis);
        }
        if (!cut) {  // also where there is no double between the ends
            node.slot = int(tree_.bendings_.add(outer));
            keep_proof(node);
            return std::nullopt;
        }
    }
    outers_.emplace_back(outer);
    return split(item, int(outers_.size()) - 1, *cut, inside, items);
}

std::optional<Refusal> CurvatureTree::Grower::split(const Item& item, int outer, const Cut& cut, bool inside,
                                                    std::vector<Item>& items) {
    if (++uncounted_ >= kLeavesCounted && !count_leaves()) return too_many_leaves();
    const Box<2> box = tree_.nodes_[std::size_t(item.node)].box;
    const int child = int(tree_.nodes_.end()), variation = tree_.nodes_[std::size_t(item.node)].variation;
    tree_.nodes_[std::size_t(item.node)].child = child;
    Box<2> part[2] = {box, box};
    part[0].hi[cut.axis] = part[1].lo[cut.axis] = cut.at;
    const auto columns = tree_.nodes_[std::size_t(item.node)].columns;
    for (const int half : {0, 1}) {
        Node n{part[half], item.node};
        n.columns = columns;
        if (cut.column > 0) n.columns[std::size_t(cut.axis)][half == 0 ? 1 : 0] = std::uint8_t(cut.column);
        tree_.nodes_.add(n);
    }
    for (const int half : {1, 0}) {
        items.push_back({child + half, item.depth + 1, outer, {}, inside, variation});
        for (const auto& s : item.near)
            if (meets(part[half], task_.polygon[std::size_t(s[0])], task_.polygon[std::size_t(s[1])]))
                items.back().near.push_back(s);
    }
    return std::nullopt;
}

std::optional<Refusal> CurvatureTree::Grower::grow(std::vector<Item>& items, std::size_t enough) {
    const bool all = enough == 0;  // depth first then: less to remember
    while (!items.empty() && (all || items.size() < enough)) {
        const auto next = all ? items.end() - 1 : items.begin();
        const Item item = std::move(*next);
        items.erase(next);
        if (all)  // others are of boxes that are done
            outers_.erase(outers_.begin() + item.outer + 1, outers_.end());
        if (auto bad = take(item, items)) return bad;
    }
    if (!count_leaves()) return too_many_leaves();
    return std::nullopt;
}

void CurvatureTree::reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    sums_.reserve(nodes / 2);
}

bool CurvatureTree::sum_up(std::size_t end) {
    bool all_flat = true;
    for (std::size_t i = end; i-- > 0;)  // children come after their parents
        if (auto& n = nodes_[i]; n.child >= 0) {
            const Node &a = nodes_[std::size_t(n.child)], &b = nodes_[std::size_t(n.child) + 1];
            n.outside = a.outside && b.outside;
            if (n.outside) continue;
            Curvature both = full(a.outside ? b : a);
            if (!a.outside && !b.outside) both.include(full(b));
            n.slot = int(sums_.add(both));
            n.whole = a.whole && b.whole;
        } else if (!n.outside) {
            all_flat = all_flat && n.flat;
            n.whole = true;
        }
    return all_flat;
}

bool CurvatureTree::varies(const DerivativeQuery<2, 3>& surface, const Box<2>& box) const {
    return !cone_ && surface.piece_numbers() > kFewNumbers &&
           surface.is_twice_smooth({box.side(0), box.side(1)});
}

Curvature CurvatureTree::seen_in(const Jet<2, 2, Vec<3>>& middle) const {
    const Curvature all = seen_at(middle, knows_normals_);
    if (!cone_) return all;
    // What is seen along normals is all that counts of spheres.
    return {cone_->is_sphere() ? seen_at(middle, true).uu : all.uu, 0, all.vv};
}

BoxBending CurvatureTree::bending_in(const DerivativeQuery<2, 3>& surface, const Box<2>& box,
                                     bool knows_normals, const Jet<2, 2, Vec<3>>& middle,
                                     Variation* variation) const {
    const Vec<2> size = box.hi - box.lo;
    const bool is_small =
        size[0] * size[1] < kSmallPart * (surface.thinnest_piece(0) * surface.thinnest_piece(1));
    if (!cone_) {
        const bool fits = !variation && !is_small && is_fitted(surface, box);
        BoxBending out = fits ? bending_by_fit(surface, box, knows_normals, middle)
                              : bending_of(surface, box, knows_normals, middle, variation);
        if (fits && !out.full.is_finite()) out = bending_of(surface, box, knows_normals, middle, variation);
        return out;
    }
    const ConeFace::Bends bends = cone_->bends(surface, box);
    BoxBending out;
    out.full = cone_->across() == 0 ? Curvature{bends.across, 0, bends.along}
                                    : Curvature{bends.along, 0, bends.across};
    out.first[0] = bends.first[0], out.first[1] = bends.first[1];
    return out;
}

Result<CurvatureTree> CurvatureTree::make(const DerivativeQuery<2, 3>& surface,
                                          std::span<const Vec<2>> polygon,
                                          std::span<const std::array<int, 2>> segments,
                                          const FaceDemands& demands, std::size_t max_leaves, Ways ways) {
    CurvatureTree tree;
    tree.knows_normals_ = ways.knows_normals;
    tree.cone_ = ways.cone;
    const PolygonRows rows(polygon, segments);
    tree.rows_ = &rows;
    for (std::size_t d = 0; d < 2; ++d)
        tree.kinks_[d].assign(surface.kinks(int(d)).begin(), surface.kinks(int(d)).end());
    Box<2> root;
    for (const Vec<2>& p : polygon) root.add(p);
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : tree.kinks_[std::size_t(d)])
            if (!is_rounding(k, (root.hi - root.lo)[d], demands.tolerance))
                tree.sharp_[std::size_t(d)].push_back(k.at);
    const std::size_t nodes = expected_nodes(demands);
    if (demands.is_shared && is_serial()) tree.reserve(nodes);
    if (demands.is_shared && !kIsSerialBuild && nodes >= kManyNodes)
        tree.bendings_.use(std::make_shared<Chunks<Bending>::Room>(
            std::size_t(std::min(kBendingsOfNode * double(nodes), kMostBendings))));
    tree.nodes_.add({root, 0});
    if (!tree.cone_ || tree.cone_->is_sphere()) tree.plan_columns(surface, demands.tolerance);
    if (auto torn = tree.torn_place(surface, polygon, segments, demands.tolerance))
        return std::unexpected(*torn);
    BoxBending any;
    any.full = {kInfinity, kInfinity, kInfinity};
    any.first[0] = any.first[1] = kInfinity;
    // Parts of a tree are made by themselves for threads alone. Asked once: others may change their number.
    Grower::Task task{surface,
                      polygon,
                      demands,
                      max_leaves,
                      ways.blocks,
                      demands.is_shared && !is_serial(),
                      nodes / kPartsOfTree};
    RepeatedJets jets(surface.geometry(), nodes);
    Grower grower(tree, task, any, jets);
    std::vector<Grower::Item> items{{0, 0, 0, {segments.begin(), segments.end()}}};
    auto bad = grower.grow(items, demands.is_shared ? kPartsOfTree : 0);
    const std::size_t top = tree.nodes_.end();
    if (!bad && demands.is_shared) bad = grower.grow_parts(std::move(items));
    if (bad) return std::unexpected(*bad);
    if (tree.sum_up(task.in_parts ? top : tree.nodes_.end()) && task.all_flat) tree.knows_normals_ = false;
    tree.rows_ = nullptr;
    if (ways.blocks)
        tree.take_leaves(polygon, segments, demands.is_shared);
    else
        tree.plan_grid(), tree.fill_grid(0, 1);
    tree.find_corners();
    return tree;
}

}  // namespace freiform
