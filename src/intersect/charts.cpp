// The search for charts; charts_detail.hpp is the essay.
#include "charts_detail.hpp"

#include <freiform/core/sort.hpp>

#include <set>

namespace freiform::detail {

namespace {

constexpr double kPartsOfSphere = 1.0 / 8;
constexpr std::size_t kMostToRefine = 60'000, kMostBeforeCoarse = 4'000;

}  // namespace

Charts::Charts(Sheet& a, Sheet& b, const Sameness& same) : sheets_{&a, &b}, maps_(same.maps) {
    if (same.one_sphere) same_from_ = kPartsOfSphere * std::min(a[0].extent(), b[0].extent());
    for (const SameMap& m : same.maps) {
        regions_.push_back(m.on);
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t k = 0; k < 2; ++k)
                for (const double at : {regions_.back()[side][k].lo, regions_.back()[side][k].hi})
                    sheets_[side]->cut_at(k, at);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = domain(k);
        slack_[k] = 0x1p-42 * std::max(on.length(), std::max(std::abs(on.lo), std::abs(on.hi)));
    }
}

void Charts::search(double nearness, double finest, int max_pairs, double coarse, const IsKnown& is_known) {
    max_pairs_ = max_pairs, nearness_ = nearness;
    nodes_.assign(1, Node{});
    open_.assign(1, 0);
    look_at_all(coarse > nearness ? kMostBeforeCoarse : std::numeric_limits<std::size_t>::max());
    if (!open_.empty()) {
        charts_.clear(), given_up_.clear(), same_.clear(), explained_cells_.clear(), left_.clear();
        nearness_ = coarse;
        nodes_.assign(1, Node{});
        open_.assign(1, 0);
        look_at_all(std::numeric_limits<std::size_t>::max());
    }
    sort(explained_cells_, {}, [](const auto& e) { return e.first; });
    struct Batch {
        std::vector<int> nodes;
        double nearness;
    };
    std::vector<Batch> batches;
    const auto divide = [&](std::vector<int> nodes) {
        for (auto& group : neighbours(std::move(nodes))) batches.push_back({std::move(group), nearness_});
    };
    // What is beside a place where they are the same, at its corners, belongs to it.
    const std::size_t same = same_.size();
    if (same > 0) same_.insert(same_.end(), given_up_.begin(), given_up_.end());
    const std::set<int> known(same_.begin(), same_.begin() + std::ptrdiff_t(same));
    if (same > 0) given_up_.clear();
    for (auto& group : neighbours(std::move(same_)))
        if (std::ranges::any_of(group, [&](int n) { return known.contains(n); }))
            finish(group, true);
        else
            given_up_.insert(given_up_.end(), group.begin(), group.end());
    same_.clear();
    divide(std::move(given_up_));
    while (!batches.empty()) {
        const Batch batch = std::move(batches.back());
        batches.pop_back();
        const bool is_coarse = batch.nearness > nearness;
        const bool is_settled = is_coarse && batch.nodes.size() <= kMostToRefine &&
                                is_known(cluster_of(batch.nodes, false), int(clusters_.size()));
        if (is_settled || batch.nearness <= finest || (!is_coarse && batch.nodes.size() > kMostToRefine)) {
            finish(batch.nodes, false);
            continue;
        }
        const std::size_t charts = charts_.size(), left = left_.size();
        given_up_.clear();
        nearness_ = batch.nearness * 0x1p-4;
        if (is_coarse) nearness_ = std::max(nearness_, nearness);
        for (const int n : batch.nodes) split(n);
        look_at_all(std::numeric_limits<std::size_t>::max());
        sort(explained_cells_, {}, [](const auto& e) { return e.first; });
        // About a point there are always as many; along a curve four times as many, for nothing.
        if (!is_coarse && (left_.size() > left || 2 * given_up_.size() > 5 * batch.nodes.size() + 2000)) {
            for (const int n : batch.nodes) nodes_[std::size_t(n)].left = -1;
            charts_.resize(charts);
            left_.resize(left);
            same_.clear();
            finish(batch.nodes, false);
        } else {
            for (const auto& group : neighbours(std::move(same_))) finish(group, true);
            same_.clear();
            divide(std::move(given_up_));
        }
    }
}

void Charts::look_at_all(std::size_t most_given_up) {
    while (!open_.empty() && given_up_.size() <= most_given_up) {
        const int node = open_.back();
        open_.pop_back();
        if (++looked_at_ <= max_pairs_) {
            look(node);
            continue;
        }
        left_.push_back(nodes_[std::size_t(node)].parts);
    }
}

Cluster Charts::cluster_of(const std::vector<int>& nodes, bool same) const {
    Cluster c;
    c.same = same;
    for (const int n : nodes) {
        const Node& node = nodes_[std::size_t(n)];
        const auto own =
            std::ranges::lower_bound(explained_cells_, n, {}, [](const auto& e) { return e.first; });
        const bool is_explained = own != explained_cells_.end() && own->first == n;
        c.cores.push_back(is_explained ? own->second : core(node.parts));
        if (node.map >= 0 && std::ranges::find(c.maps, node.map) == c.maps.end()) c.maps.push_back(node.map);
    }
    return c;
}

void Charts::finish(const std::vector<int>& nodes, bool same) {
    for (const int n : nodes) nodes_[std::size_t(n)].cluster = int(clusters_.size());
    clusters_.push_back(cluster_of(nodes, same));
}

// Groups of pairs that touch, over a sweep along one parameter.
std::vector<std::vector<int>> Charts::neighbours(std::vector<int> nodes) const {
    std::vector<std::vector<int>> out;
    if (nodes.size() > kMostToRefine) {
        out.push_back(std::move(nodes));
        return out;
    }
    std::vector<std::pair<std::array<Interval, 4>, int>> cells;
    for (const int n : nodes) cells.push_back({core(nodes_[std::size_t(n)].parts), n});
    // Along the parameter that tells most of them apart: with the fewest pairs in the same of many stripes.
    constexpr std::size_t kStripes = 1024;
    std::size_t way = 0;
    double fewest = kInfinity;
    for (std::size_t k = 0; k < 4; ++k) {
        std::array<int, kStripes> in{};
        const Interval on = domain(k);
        for (const auto& c : cells)
            ++in[std::size_t(clamped((c.first[k].lo - on.lo) / on.length() * kStripes, {0, kStripes - 1}))];
        double pairs = 0;
        for (const int n : in) pairs += double(n) * n;
        if (pairs < fewest) fewest = pairs, way = k;
    }
    sort(cells, [&](const auto& a, const auto& b) {
        return std::pair(a.first[way].lo, a.second) < std::pair(b.first[way].lo, b.second);
    });
    std::vector<std::size_t> root(cells.size());
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (std::size_t i = 0; i < cells.size(); ++i) root[i] = i;
    const auto link = [&](std::size_t i, std::size_t j) {
        bool touch = true;
        for (std::size_t k = 0; k < 4; ++k) {
            const Interval p = cells[i].first[k], q = cells[j].first[k], on = domain(k);
            touch = touch && (p.overlaps(q) || (is_cyclic(k) && ((p.lo == on.lo && q.hi == on.hi) ||
                                                                 (q.lo == on.lo && p.hi == on.hi))));
        }
        if (touch) root[find(i)] = find(j);
    };
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::erase_if(active, [&](std::size_t j) { return cells[j].first[way].hi < cells[i].first[way].lo; });
        for (const std::size_t j : active) link(i, j);
        active.push_back(i);
    }
    if (is_cyclic(way)) {
        std::vector<std::size_t> first, last;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (cells[i].first[way].lo == domain(way).lo) first.push_back(i);
            if (cells[i].first[way].hi == domain(way).hi) last.push_back(i);
        }
        for (const std::size_t i : first)
            for (const std::size_t j : last) link(i, j);
    }
    std::vector<int> group(cells.size(), -1);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        int& g = group[find(i)];
        if (g < 0) g = int(out.size()), out.emplace_back();
        out[std::size_t(g)].push_back(cells[i].second);
    }
    return out;
}

bool Charts::has_core_at(PartPair p, const Place4& x) const {
    const auto &a = (*sheets_[0])[p.a].on, &b = (*sheets_[1])[p.b].on;
    for (std::size_t k = 0; k < 4; ++k) {
        const Interval on = k < 2 ? a[k] : b[k - 2];
        const auto is_in = [&](double t) { return on.lo - slack_[k] <= t && t <= on.hi + slack_[k]; };
        if (is_in(x[k])) continue;
        const double period = domain(k).length();
        if (!is_cyclic(k) || !(is_in(x[k] - period) || is_in(x[k] + period))) return false;
    }
    return true;
}

void Charts::leaves_at(const Place4& x, Leaves& out) const {
    out.charts.clear(), out.clusters.clear();
    std::array<int, 512> stack;  // two for each halving
    std::size_t count = 0;
    stack[count++] = 0;
    while (count > 0) {
        const Node& n = nodes_[std::size_t(stack[--count])];
        if (!has_core_at(n.parts, x)) continue;
        if (n.chart >= 0) out.charts.push_back(n.chart);
        if (n.cluster >= 0) out.clusters.push_back(n.cluster);
        if (n.left >= 0) stack[count++] = n.left, stack[count++] = n.left + 1;
    }
}

bool Charts::are_apart(const SheetPart& p, const SheetPart& q) const {
    const double e = 1.01 * (p.error + q.error);
    for (int k = 0; k < 3; ++k)
        if (p.box.lo[k] - q.box.hi[k] > e || q.box.lo[k] - p.box.hi[k] > e) return true;
    return false;
}

// Along the normal of one of them. `near`: together they are no thicker along both than what is asked for.
bool Charts::are_apart_by_slabs(PartPair p, bool& near) const {
    const double e = (*sheets_[0])[p.a].error + (*sheets_[1])[p.b].error;
    const double rounding = 8 * kUnitRoundoff * (sheets_[0]->scale() + sheets_[1]->scale());
    near = true;
    for (std::size_t i = 0; i < 2; ++i) {
        const SheetPart& own = (*sheets_[i])[i == 0 ? p.a : p.b];
        const Sheet& other = *sheets_[1 - i];
        const Vec<3>* h = other.hull(i == 0 ? p.b : p.a);
        Interval range{kInfinity, -kInfinity};
        for (int k = 0; k < other.block(); ++k) {
            const double x = dot(own.normal, h[k]);
            range = {std::min(range.lo, x), std::max(range.hi, x)};
        }
        const double slack = 1.8 * e + rounding;
        if (range.lo - own.slab.hi > slack || own.slab.lo - range.hi > slack) return true;
        const Interval both = freiform::hull(range, own.slab);
        near = near && both.length() <= nearness_ + 4 * slack;
    }
    return false;
}

// B is one-to-one over a part and `with`, which is in its surroundings: parameters there whose points are so
// near to each other are so near. |y - z| <= |Y| |B(y) - B(z)| / (1 - q), as for charts.
std::optional<std::array<double, 2>> Charts::slack_where_one_to_one(std::size_t side, int part,
                                                                    const std::array<Interval, 2>& with,
                                                                    double gap) {
    const SheetPart& p = (*sheets_[side])[part];
    for (std::size_t k = 0; k < 2; ++k) {
        const double reach = Sheet::kMargin * p.on[k].length();
        if (with[k].lo < p.on[k].lo - reach || with[k].hi > p.on[k].hi + reach) return std::nullopt;
    }
    const std::array<double, 2> width{p.on[0].length(), p.on[1].length()};
    const Sheet::Slopes& s = sheets_[side]->slopes(part, true);
    const Vec<3> u = width[0] * s[0].middle(), v = width[1] * s[1].middle();
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
    if (!(det > 0)) return std::nullopt;
    const std::array<Vec<3>, 2> y{(1 / det) * (vv * u - uv * v), (1 / det) * (uu * v - uv * u)};
    std::array<double, 2> slack{};
    double q = 0;
    for (std::size_t r = 0; r < 2; ++r) {
        double sum = 0;
        for (std::size_t k = 0; k < 2; ++k)
            for (int c = 0; c < 3; ++c) sum += std::abs(y[r][c]) * width[k] * s[k].radius()[c];
        q = std::max(q, 1.0001 * sum + 0x1p-40);
    }
    if (!(q < 0.8)) return std::nullopt;
    // The maximum of both in lengths of the part.
    const double most = 1.01 * gap * std::max(norm(y[0]), norm(y[1])) / (1 - q);
    for (std::size_t k = 0; k < 2; ++k) slack[k] = most * width[k];
    return slack;
}

// Do the two come together in this pair only where a map says so? `nothing`: nowhere. Let p be a part of A
// over R, and B one-to-one over q and M(p). If A(x) = B(y), |B(y) - B(Mx)| <= gap, so y is next to M x.
bool Charts::explained(int node, bool& nothing) {
    const PartPair p = nodes_[std::size_t(node)].parts;
    for (std::size_t i = 0; i < maps_.size(); ++i)
        for (std::size_t side = 0; side < 2; ++side) {
            const int own = side == 0 ? p.a : p.b, other = side == 0 ? p.b : p.a;
            const std::array<Interval, 2> on = (*sheets_[side])[own].on;
            bool inside = true;
            for (std::size_t k = 0; k < 2; ++k) {
                const Interval r = regions_[i][side][k];
                const double more = 4 * slack_[2 * side + k];
                inside = inside && r.lo - more <= on[k].lo && on[k].hi <= r.hi + more;
            }
            if (!inside) continue;
            const auto moved = side == 0 ? maps_[i].forth(on) : maps_[i].back(on);
            const double gap = maps_[i].gap + sheets_[0]->inner_error() + sheets_[1]->inner_error();
            const auto slack = slack_where_one_to_one(1 - side, other, moved, 2 * gap);
            if (!slack) continue;
            std::array<Interval, 4> cell = core(p);
            nothing = false;
            for (std::size_t k = 0; k < 2; ++k) {
                const double more = (*slack)[k] + 4 * slack_[2 * (1 - side) + k];
                Interval& c = cell[2 * (1 - side) + k];
                c = {std::max(c.lo, moved[k].lo - more), std::min(c.hi, moved[k].hi + more)};
                nothing = nothing || c.lo > c.hi;
            }
            if (nothing) return true;
            const auto back =
                side == 0 ? maps_[i].back({cell[2], cell[3]}) : maps_[i].forth({cell[0], cell[1]});
            for (std::size_t k = 0; k < 2; ++k) {
                Interval& c = cell[2 * side + k];
                const Interval cut{std::max(c.lo, back[k].lo), std::min(c.hi, back[k].hi)};
                if (cut.lo <= cut.hi) c = cut;
            }
            nodes_[std::size_t(node)].map = int(i);
            explained_cells_.push_back({node, cell});
            return true;
        }
    return false;
}

void Charts::look(int node) {
    const PartPair p = nodes_[std::size_t(node)].parts;
    const SheetPart &a = (*sheets_[0])[p.a], &b = (*sheets_[1])[p.b];
    if (a.is_one_piece() && b.is_one_piece()) {
        if (bool nothing = false; !maps_.empty() && explained(node, nothing)) {
            if (!nothing) same_.push_back(node);
            return;
        }
        if (sheets_[0]->has_piece_of(p.a, *sheets_[1], p.b)) {
            same_.push_back(node);
            return;
        }
        bool near = false;
        if (are_apart_by_slabs(p, near)) return;
        if (same_from_ > 0) {
            if (std::max(a.extent(), b.extent()) <= same_from_)
                same_.push_back(node);
            else
                split(node);
            return;
        }
        const Answer answer = settle(p);
        if (answer == Answer::chart) nodes_[std::size_t(node)].chart = int(charts_.size()) - 1;
        if (answer != Answer::open) return;
        if (near) {
            given_up_.push_back(node);
            return;
        }
    }
    split(node);
}

void Charts::split(int node) {
    const PartPair p = nodes_[std::size_t(node)].parts;
    const SheetPart &a = (*sheets_[0])[p.a], &b = (*sheets_[1])[p.b];
    std::size_t first = a.extent() < b.extent();
    if (a.is_one_piece() != b.is_one_piece()) first = a.is_one_piece();
    for (const std::size_t i : {first, 1 - first}) {
        const int part = i == 0 ? p.a : p.b;
        if (!sheets_[i]->split(part)) continue;
        const int half = (*sheets_[i])[part].left, left = int(nodes_.size());
        nodes_[std::size_t(node)].left = left;
        for (const int h : {half, half + 1}) {
            const PartPair pair = i == 0 ? PartPair{h, p.b} : PartPair{p.a, h};
            if (!are_apart((*sheets_[0])[pair.a], (*sheets_[1])[pair.b])) open_.push_back(int(nodes_.size()));
            nodes_.push_back({pair});
        }
        return;
    }
    given_up_.push_back(node);
}

}  // namespace freiform::detail
