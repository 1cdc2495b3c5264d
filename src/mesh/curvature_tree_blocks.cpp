// Leaves that stand for many: where a surface bends about as much everywhere in a box, all of it is cut into
// equal cells.
//
// Idea: most of what a mesh of a large face costs is to bound, insert and judge what is the same a thousand
// times. Away from the boundary a box is cut into equal cells instead, and these become triangles as they are
// (blocks.cpp). Whether that is worth it depends on how evenly the surface bends: samples say how many cells
// are needed, on average, and bounds say how many there would be. Samples decide about the number of
// triangles only; that cells keep the tolerance is proven. Bounds of what is seen along normals are poor over
// a box in which normals turn, so there is one for each part of some cells: from a sample in its middle and
// what third derivatives in the whole box say, as for leaves of large nets (curvature_tree_make.cpp), or from
// control points where these are not continuous, or where there are none.
//
// Cells are halved sides, as leaves are, so that the corners of both are the same where they meet. So other
// leaves away from the boundary are blocks, too, of one cell: they need no triangulation and one proof for
// all triangles. How far away counts by the boundary itself where most leaves are, and by the leaves that
// have some of it where it is near everywhere: what is between the boundary and blocks has few points then,
// and a strip of it takes more triangles than leaves that are left to it would.
#include "curvature_tree_detail.hpp"
#include "parameter_table_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/mesh/segment_box.hpp>

#include <algorithm>

namespace freiform {

namespace {

constexpr double kFewCells = 12, kManyCells = 2048;  // seen: not worth a block, too large for one
constexpr double kWaste = 2;                         // more cells than are seen
constexpr double kEven = 2.5;                        // likewise, once sides are halved
constexpr double kUneven = 3;                        // samples that differ by more: no need for others
constexpr int kMostHalves = 12;                      // of both sides together
constexpr double kPartError = 4;                     // of a part, times the tolerance
constexpr int kPartHalves = 8;                       // likewise, into parts
constexpr double kPartRounding = 1 + 1e-9;           // of the sizes of parts
constexpr double kAlmost = 0.97;                     // of the tolerance: what shifts leave
constexpr int kGroupsOfGrid = 2;                     // each walks past all leaves
constexpr std::size_t kLeavesOfThread = 256;         // that a thread looks at
// The boundary itself counts where it is not near everywhere: of so many leaves (of fewer it always is more)
// it adds that part at most.
constexpr std::size_t kManyLeaves = 256;
constexpr double kFewMore = 0.125;
constexpr double kDeep = 0.6;  // of a leaf: nearer to the boundary it makes slivers

// Cells of a box of this size whose halves are off by the tolerance, nearly: sides are chosen so that the
// derivatives along both count equally, and the better diagonals.
double cells_for(const Curvature& c, const Vec<2>& size, double tolerance) {
    const double mean = std::sqrt(c.uu * c.vv), signs = c.sure_uu * c.sure_vv;
    const double both = signs == 0    ? mean + c.uv
                        : signs < 0   ? std::max(mean / 2, c.uv)
                        : c.uv < mean ? mean - c.uv / 2
                                      : std::max(mean / 2, c.uv - mean);
    return both * size[0] * size[1] / (4 * tolerance);
}

void halve_longer(const Curvature& c, Vec<2>& size, CurvatureTree::Halves& halves) {
    const std::size_t axis = c.uu * size[0] * size[0] >= c.vv * size[1] * size[1] ? 0 : 1;
    size[int(axis)] /= 2, ++halves[axis];
}

// Some cells each; `size` becomes theirs.
CurvatureTree::Halves parts_for(const Curvature& c, Vec<2>& size, double tolerance) {
    CurvatureTree::Halves parts{};
    while (c.error(size) > kPartError * tolerance && parts[0] + parts[1] < kPartHalves)
        halve_longer(c, size, parts);
    return parts;
}

}  // namespace

std::vector<double> halved(const Interval& on, int times) {
    std::vector<double> out{on.lo, on.hi};
    for (int k = 0; k < times; ++k) {
        std::vector<double> finer;
        finer.reserve(2 * out.size());
        for (std::size_t i = 0; i + 1 < out.size(); ++i) {
            finer.push_back(out[i]);
            finer.push_back(Interval{out[i], out[i + 1]}.middle());
        }
        finer.push_back(out.back());
        out = std::move(finer);
    }
    return out;
}

// By samples, their mean; 0 where there are too few or too many, or the surface does not bend evenly, or its
// normals turn so much within a part that bounds would see other things than samples.
double CurvatureTree::cells_seen(RepeatedJets& jets, const Box<2>& box, const Jet<2, 2, Vec<3>>& middle,
                                 double tolerance) const {
    const Vec<2> size = box.hi - box.lo;
    const Curvature bent = seen_in(middle);
    const double here = cells_for(bent, size, tolerance);
    if (!(here >= kFewCells / kWaste) || !(here <= kManyCells)) return 0;
    if (knows_normals_) {
        Vec<2> part = size;
        parts_for(bent, part, tolerance);
        const double turn = std::hypot((bent.uu * part[0] + bent.uv * part[1]) / norm(middle(1, 0)),
                                       (bent.uv * part[0] + bent.vv * part[1]) / norm(middle(0, 1)));
        const Curvature bounded = bent.plus(turn / 2, seen_at(middle, false));
        if (!(cells_for(bounded, size, tolerance) <= kWaste * here)) return 0;
    }
    double most = here, sum = here;
    for (int k = 0; k < 4; ++k) {
        const Vec<2> at{
            {box.lo[0] + (k & 1 ? 0.875 : 0.125) * size[0], box.lo[1] + (k & 2 ? 0.875 : 0.125) * size[1]}};
        const double cells = cells_for(seen_in(jets.at<2>(at.c)), size, tolerance);
        if (!(cells <= kUneven * here) || !(here <= kUneven * cells)) return 0;
        most = std::max(most, cells), sum += cells;
    }
    const double mean = sum / 5;
    return mean >= kFewCells && most <= kWaste * mean ? mean : 0;
}

// What has to be small over a part.
Curvature CurvatureTree::matters_of(const Bending& part) const {
    return part.least > 0 && knows_normals_ ? part.seen(0) : part.full;
}

// Adds what is known of each part of the box, row by row, and finds what holds in all of them; false as soon
// as the box needs more cells than `most`.
bool CurvatureTree::add_parts(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const Halves& halves,
                              const BoxBending& all, const Variation* varies, double most, double tolerance,
                              Curvature& together) {
    const auto lines = std::array{halved(box.side(0), halves[0]), halved(box.side(1), halves[1])};
    for (std::size_t i = 0; i + 1 < lines[0].size(); ++i)
        for (std::size_t j = 0; j + 1 < lines[1].size(); ++j) {
            const Box<2> part{{{lines[0][i], lines[1][j]}}, {{lines[0][i + 1], lines[1][j + 1]}}};
            const auto middle = jet<2>(surface.geometry(), {part.side(0).middle(), part.side(1).middle()});
            Bending found = varies ? bending_from_middle(surface, part, knows_normals_, middle, *varies)
                                   : bending_in(surface, part, knows_normals_, middle);
            found.full.restrict_to(all.full);
            part_bendings_.push_back(found);
            const Curvature matters = matters_of(found);
            if (i + j == 0) together = matters;
            together.include(matters);
            if (!(cells_for(together, box.hi - box.lo, tolerance) <= most)) return false;
        }
    return true;
}

// Makes a block of a leaf, if cells keep the tolerance and are not many more than are seen to be needed.
// `known`: of a box around it; then of the leaf.
bool CurvatureTree::make_block(const DerivativeQuery<2, 3>& surface, int node,
                               const Jet<2, 2, Vec<3>>& middle, double cells, double tolerance,
                               BoxBending& known) {
    const Box<2> box = nodes_[std::size_t(node)].box;
    const Curvature seen = seen_in(middle), before = known.full;
    if (meets_kink(box)) return false;
    const bool is_smooth = !cone_ && surface.is_twice_smooth({box.side(0), box.side(1)});
    Variation varies;
    known = bending_in(surface, box, knows_normals_, middle, is_smooth ? &varies : nullptr);
    known.full.restrict_to(before);
    if (!known.full.is_finite()) return false;

    Halves halves{};
    Vec<2> size = box.hi - box.lo;
    const Halves parts = parts_for(seen, size, tolerance);
    const std::size_t first = part_bendings_.size();
    Curvature matters;
    bool worth = add_parts(surface, box, parts, known, is_smooth ? &varies : nullptr, kWaste * cells,
                           tolerance, matters);
    const auto of_parts = std::span(part_bendings_).subspan(first);

    size = box.hi - box.lo;
    const Vec<2> part =
        kPartRounding * Vec<2>{{std::ldexp(size[0], -parts[0]), std::ldexp(size[1], -parts[1])}};
    const auto is_fine = [&] {
        return std::all_of(of_parts.begin(), of_parts.end(), [&](const Bending& b) {
            double off = matters_of(b).error(size);
            if (b.knows_middle()) off = std::min(off, b.cells_error(part, size, 0));
            return off <= kAlmost * tolerance && keeps_in_cells(b, part, size, tolerance);
        });
    };
    while (worth && !is_fine()) {
        halve_longer(matters, size, halves);
        worth = halves[0] + halves[1] <= kMostHalves;
    }
    for (std::size_t d = 0; d < 2; ++d) halves[d] = std::max(halves[d], parts[d]);
    const bool even = std::ldexp(1.0, halves[0] + halves[1]) <= kEven * cells;
    if (!worth || !even || halves[0] == 0 || halves[1] == 0) {
        part_bendings_.resize(first);
        return false;
    }
    Node& n = nodes_[std::size_t(node)];
    n.block = int(blocks_.size());
    n.flat = known.full.along(size[0], size[1]) / 8 <= tolerance;
    n.slot = int(bendings_.add(known));
    blocks_.push_back({box, halves, parts, int(first), node});
    return true;
}

// What there is of the boundary in leaves: a box around it for each, by their nodes.
class CurvatureTree::Border {
public:
    Border(const CurvatureTree& tree, std::span<const Vec<2>> polygon,
           std::span<const std::array<int, 2>> segments)
        : tree_(tree), leaves_(segments.size()) {
        for (const auto& s : segments) add(polygon[std::size_t(s[0])], polygon[std::size_t(s[1])]);
    }
    // Whether some of it is in this leaf and in the box.
    bool meets(int leaf, const Box<2>& box) const {
        const int at = leaves_.find(key(leaf));
        if (at < 0) return false;
        const Box<2>& b = boxes_[std::size_t(at)];
        return b.lo[0] <= box.hi[0] && box.lo[0] <= b.hi[0] && b.lo[1] <= box.hi[1] && box.lo[1] <= b.hi[1];
    }

private:
    static Vec<2> key(int leaf) { return {{double(leaf), 0}}; }
    void add(const Vec<2>& p, const Vec<2>& q) {
        int stack[2 * kMaxTreeDepth + 4], size = 0;
        stack[size++] = 0;
        while (size > 0) {
            const int at = stack[--size];
            const Node& n = tree_.nodes_[std::size_t(at)];
            if (n.inside || !freiform::meets(n.box, p, q)) continue;
            if (n.child < 0) {
                add(at, n.box, p, q);
                continue;
            }
            stack[size++] = n.child;
            stack[size++] = n.child + 1;
        }
    }
    void add(int leaf, const Box<2>& box, const Vec<2>& p, const Vec<2>& q) {
        const auto number = std::size_t(leaves_.number(key(leaf)));
        if (number == boxes_.size()) boxes_.push_back({});
        double from = 0, to = 1;
        for (int d = 0; d < 2; ++d)
            if (const double way = q[d] - p[d]; way != 0) {
                const double a = (box.lo[d] - p[d]) / way, b = (box.hi[d] - p[d]) / way;
                from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
            }
        for (const double t : {from, to}) boxes_[number].add(p + std::clamp(t, 0.0, 1.0) * (q - p));
    }

    const CurvatureTree& tree_;
    ParameterTable leaves_;  // by their numbers
    std::vector<Box<2>> boxes_;
};

// Whether the boundary is not near: without a border no leaf that has some of it.
bool CurvatureTree::is_deep(int leaf, const Border* border) const {
    const Box<2>& box = nodes_[std::size_t(leaf)].box;
    const Vec<2> margin = kDeep * (box.hi - box.lo);
    const Box<2> around{box.lo - margin, box.hi + margin};
    if (const auto found = grid_.over(around); found && (*found)[3] == 0) return true;
    int place = leaf;
    while (place != 0 && !(nodes_[std::size_t(place)].box.contains(around.lo) &&
                           nodes_[std::size_t(place)].box.contains(around.hi)))
        place = nodes_[std::size_t(place)].parent;
    if (!nodes_[std::size_t(place)].box.contains(around.lo) ||
        !nodes_[std::size_t(place)].box.contains(around.hi))
        return false;
    int stack[2 * kMaxTreeDepth + 4], size = 0;
    stack[size++] = place;
    while (size > 0) {
        const int at = stack[--size];
        const Node& n = nodes_[std::size_t(at)];
        if (n.inside || !has_common_part(n.box, around)) continue;
        if (n.child < 0) {
            if (n.outside || !border || border->meets(at, around)) return false;
            continue;
        }
        stack[size++] = n.child;
        stack[size++] = n.child + 1;
    }
    return true;
}

// The boundary is looked for and the grid planned while leaves are listed. These are marked by who has just
// looked at them.
void CurvatureTree::take_leaves(std::span<const Vec<2>> polygon, std::span<const std::array<int, 2>> segments,
                                bool is_shared) {
    std::vector<int> leaves;
    std::optional<Border> border;
    const auto list = [&] {
        nodes_.each_place([&](std::size_t i) {
            const Node& n = nodes_[i];
            if (n.child >= 0 || n.is_block() || !n.inside || n.has_columns() || meets_kink(n.box)) return;
            leaves.push_back(int(i));
        });
    };
    const auto plan = [&] {
        plan_grid();
        if (nodes_.count() >= kManyLeaves) border.emplace(*this, polygon, segments);
    };
    parallel_for(2, is_shared ? 1 : 2, [&](std::size_t k) { k == 0 ? list() : plan(); });
    const int groups = is_shared ? kGroupsOfGrid : 1;
    parallel_for(std::size_t(groups), 1, [&](std::size_t k) { fill_grid(int(k), groups); });
    std::vector<char> deep(leaves.size());
    const auto look = [&](const Border* at_boundary) {
        parallel_for(leaves.size(), is_shared ? kLeavesOfThread : leaves.size(), [&](std::size_t i) {
            if (deep[i] || !is_deep(leaves[i], at_boundary)) return;
            deep[i] = at_boundary ? 2 : 1;
            if (!at_boundary) nodes_[std::size_t(leaves[i])].block = kOneCell;
        });
    };
    look(nullptr);
    if (leaves.size() >= kManyLeaves) look(&*border);
    const std::size_t away = std::size_t(std::ranges::count(deep, 1)),
                      more = std::size_t(std::ranges::count(deep, 2));
    const bool all = double(more) <= kFewMore * double(leaves.size());
    block_leaves_.reserve(away + (all ? more : 0));
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (deep[i] == 0 || (deep[i] == 2 && !all)) continue;
        if (deep[i] == 2) nodes_[std::size_t(leaves[i])].block = kOneCell;
        block_leaves_.push_back(leaves[i]);
    }
}

}  // namespace freiform
