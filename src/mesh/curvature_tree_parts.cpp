// Parts of a tree, grown by themselves and put together as they are: what refers to places in a part is
// brought to those that it has in the tree, where it lies.
#include "curvature_tree_grower_detail.hpp"
#include "serial_detail.hpp"

#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <array>
#include <memory>

namespace freiform {

namespace {

// Jets that threads use one after the other: what they keep is worth more than a part of the tree, and takes
// as long to make.
class IdleJets {
public:
    IdleJets(const SurfaceGeometry& surface, std::size_t places) : surface_(surface), places_(places) {}
    ~IdleJets() {
        for (auto& p : idle_) delete p.load();
    }
    std::unique_ptr<RepeatedJets> take() {
        for (auto& p : idle_)
            if (RepeatedJets* jets = p.exchange(nullptr)) return std::unique_ptr<RepeatedJets>(jets);
        return std::make_unique<RepeatedJets>(surface_, places_);
    }
    // Where there is no room for them, they are gone.
    void put(std::unique_ptr<RepeatedJets> jets) {
        for (auto& p : idle_)
            if (RepeatedJets* none = nullptr; p.compare_exchange_strong(none, jets.get())) {
                jets.release();
                return;
            }
    }

private:
    const SurfaceGeometry& surface_;
    std::size_t places_;
    std::array<std::atomic<RepeatedJets*>, 16> idle_{};
};

}  // namespace

std::optional<Refusal> CurvatureTree::Grower::grow_parts(std::vector<Item> items) {
    std::vector<std::optional<Refusal>> bad(items.size());
    // All together need too many leaves, or none of them says so: which one does is chance.
    const auto worst = [&]() -> std::optional<Refusal> {
        for (const bool limit : {true, false})
            for (const auto& b : bad)
                if (b && (!limit || b->kind == RefusalKind::limit)) return b;
        return std::nullopt;
    };
    if (kIsSerialBuild || !task_.in_parts) {
        // Into this tree at once, in the order in which parts are added below.
        for (std::size_t i = 0; i < items.size(); ++i) {
            const BoxBending& outer = outers_[std::size_t(items[i].outer)].known;
            std::vector<Item> own{std::move(items[i])};
            own.front().outer = 0;
            bad[i] = Grower(tree_, task_, outer, jets_).grow(own, 0);
        }
        return worst();
    }
    std::vector<CurvatureTree> parts(items.size());
    IdleJets idle(task_.surface.geometry(), task_.expected_nodes * items.size());
    parallel_for(items.size(), 1, [&](std::size_t i) {
        CurvatureTree& part = parts[i];
        part.knows_normals_ = tree_.knows_normals_;
        part.cone_ = tree_.cone_;
        part.kinks_ = tree_.kinks_;
        part.sharp_ = tree_.sharp_;
        part.columns_ = tree_.columns_;
        part.rows_ = tree_.rows_;
        part.reserve(task_.expected_nodes);
        part.bendings_.use(tree_.bendings_.room());
        part.nodes_.add(tree_.nodes_[std::size_t(items[i].node)]);
        std::vector<Item> own{items[i]};
        own.front().node = own.front().outer = 0;
        if (own.front().variation >= 0) {
            part.variations_.push_back(tree_.variations_[std::size_t(own.front().variation)]);
            own.front().variation = 0;
        }
        auto jets = idle.take();
        bad[i] = Grower(part, task_, outers_[std::size_t(items[i].outer)].known, *jets).grow(own, 0);
        idle.put(std::move(jets));
        if (!bad[i] && !part.sum_up(part.nodes_.end())) task_.all_flat = false;
    });
    if (auto first = worst()) return first;
    add(parts, items);
    return std::nullopt;
}

// Parts that have been grown from the items, as they are, one behind the other.
void CurvatureTree::Grower::add(std::vector<CurvatureTree>& parts, std::span<const Item> items) {
    std::vector<Place> places;
    Place end;
    end.variations = tree_.variations_.size();
    end.blocks = tree_.blocks_.size(), end.part_bendings = tree_.part_bendings_.size();
    for (CurvatureTree& p : parts) {
        end.nodes_end = p.nodes_.end();
        end.nodes = tree_.nodes_.take(std::move(p.nodes_));
        end.nodes_end += end.nodes;
        end.bendings = tree_.bendings_.take(std::move(p.bendings_));
        end.proofs = tree_.proofs_.take(std::move(p.proofs_));
        end.sums = tree_.sums_.take(std::move(p.sums_));
        places.push_back(end);
        end.variations += p.variations_.size(), end.blocks += p.blocks_.size();
        end.part_bendings += p.part_bendings_.size();
    }
    tree_.variations_.resize(end.variations);
    tree_.blocks_.resize(end.blocks);
    tree_.part_bendings_.resize(end.part_bendings);
    parallel_for(parts.size(), 1, [&](std::size_t i) {
        put(parts[i], items[i], places[i]);
        parts[i] = {};
    });
}

// The numbers of its nodes are there already; what they refer to becomes what it is in the tree.
void CurvatureTree::Grower::put(const CurvatureTree& part, const Item& item, const Place& place) {
    const int nodes = int(place.nodes), variations = int(place.variations), blocks = int(place.blocks);
    for (std::size_t k = 0; k < part.blocks_.size(); ++k) {
        Block b = part.blocks_[k];
        b.first_part += int(place.part_bendings);
        tree_.blocks_[place.blocks + k] = b;
    }
    const auto copy = [](const auto& from, auto& to, std::size_t at) {
        std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(at));
    };
    copy(part.part_bendings_, tree_.part_bendings_, place.part_bendings);
    copy(part.variations_, tree_.variations_, place.variations);
    Node& top = tree_.nodes_[std::size_t(item.node)];
    const int parent = top.parent;
    for (std::size_t k = place.nodes; k < place.nodes_end; ++k) {
        Node& n = tree_.nodes_[k];
        n.parent = n.parent == 0 ? item.node : nodes + n.parent;
        if (n.child >= 0) n.child += nodes;
        if (n.variation >= 0) n.variation += variations;
        if (n.block >= 0) n.block += blocks;
        if (n.proof >= 0) n.proof += int(place.proofs);
        if (n.slot >= 0) n.slot += int(n.child < 0 ? place.bendings : place.sums);
    }
    Node& first = tree_.nodes_[place.nodes];  // the item's box: known by its number before
    top = first;
    top.parent = parent;
    first = {};
    first.outside = true;
}

}  // namespace freiform
