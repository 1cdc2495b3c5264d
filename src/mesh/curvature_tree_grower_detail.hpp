// What grows a tree: curvature_tree_make.cpp, and curvature_tree_parts.cpp for threads.
#pragma once
#include "curvature_tree_detail.hpp"

#include <atomic>
#include <optional>
#include <utility>
#include <vector>

namespace freiform {

// Splits boxes. What it makes of a box depends on that box and the bounds around it alone, so parts of a tree
// can be grown by themselves.
class CurvatureTree::Grower {
public:
    struct Item {
        int node = 0, depth = 0;
        int outer = 0;  // in outers_: of the smallest box around it of which bounds have been found
        std::vector<std::array<int, 2>> near;
        bool inside = false;  // wholly
        int variation = -1;   // over some box around it
    };
    struct Task {
        const DerivativeQuery<2, 3>& surface;
        std::span<const Vec<2>> polygon;
        const FaceDemands& demands;
        std::size_t max_leaves;
        bool blocks = false;
        bool in_parts = false;           // each part of the tree by itself, for threads
        std::size_t expected_nodes = 0;  // of each of them
        std::atomic<std::size_t> leaves{1};
        std::atomic<bool> all_flat{true};  // of the parts that have been summed up
    };

    Grower(CurvatureTree& tree, Task& task, const BoxBending& outer, RepeatedJets& jets)
        : tree_(tree), task_(task), jets_(jets), outers_{{outer}} {}
    // Until there are `enough` boxes to split, or none. The first refusal, if there is one.
    std::optional<Refusal> grow(std::vector<Item>& items, std::size_t enough);
    // Each of them by itself.
    std::optional<Refusal> grow_parts(std::vector<Item> items);
    Refusal too_many_leaves() const {
        return {RefusalKind::limit, "max_triangles",
                text("the tolerance ", task_.demands.tolerance, " needs more than about ",
                     2 * task_.max_leaves, " triangles")};
    }

private:
    bool is_leaf(Node& node, const BoxBending& known);
    void set_lengths(const Jet<2, 2, Vec<3>>& middle, const Vec<2>& size);
    // What is known of a box, and its place in the tree once a leaf has it: neighbours share it.
    struct Outer {
        BoxBending known;
        int slot = -1;
    };
    // Whether all together are not too many. Asked from time to time, as threads that count together wait for
    // each other.
    bool count_leaves() { return (task_.leaves += std::exchange(uncounted_, 0)) <= task_.max_leaves; }
    void stay_whole(Node& node, Outer& outer) {
        if (outer.slot < 0) outer.slot = int(tree_.bendings_.add(outer.known));
        node.slot = outer.slot;
        keep_proof(node);
    }
    void keep_proof(Node& node) {  // of the box that was looked at last
        if (proof_.whole < kInfinity) node.proof = int(tree_.proofs_.add(proof_));
    }
    BoxBending ask(Node& node, const Box<2>& box, const Jet<2, 2, Vec<3>>& middle);
    bool is_block(const Item& item, const Jet<2, 2, Vec<3>>& middle, const BoxBending& around,
                  std::optional<BoxBending>& own);
    std::optional<Refusal> take(const Item& item, std::vector<Item>& items);
    std::optional<Refusal> split(const Item& item, int outer, const Cut& cut, bool inside,
                                 std::vector<Item>& items);
    struct Place {  // where in the tree what a part has begins
        std::size_t nodes = 0, nodes_end = 0, variations = 0, blocks = 0, part_bendings = 0, bendings = 0,
                    proofs = 0, sums = 0;
    };
    void add(std::vector<CurvatureTree>& parts, std::span<const Item> items);
    void put(const CurvatureTree& part, const Item& item, const Place& place);

    CurvatureTree& tree_;
    Task& task_;
    RepeatedJets& jets_;
    std::vector<Outer> outers_;  // what items refer to
    double length_[2] = {};      // of the sides of the box that was looked at last
    std::size_t uncounted_ = 0;  // leaves that the task does not know of
    bool fine_ = false;          // whether its error is small enough
    Proof proof_;                // of that
};

}  // namespace freiform
