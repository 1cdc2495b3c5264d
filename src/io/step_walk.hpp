// The places of an assembly: each representation as often as it is used.
#pragma once
#include "step_structure.hpp"

#include <functional>

namespace freiform::step {

struct Place {
    std::uint32_t node = 0;
    Motion at;  // from the coordinates of the node to those of the model
    std::string name;
    std::optional<Colour> colour;
    std::vector<int> layers;
};

inline bool has_items(const Node& n) {
    return !n.items.empty() || !n.replicas.empty() || n.document != kMissing;
}

// The context whose unit the model has: of the first node with items; nullptr if there is none.
const Context* context_of_model(const Structure& structure);

// Calls `use` for each place, in the order of the file; `length`: of the unit of the model. Where products
// have shapes, only those and what they consist of. Refuses an assembly that contains itself (invalid), more
// than `most` places (limit), and what `use` refuses.
Result<void> each_place(const Structure& structure, double length, std::uint64_t most,
                        const std::function<Result<void>(const Place&)>& use);

}  // namespace freiform::step
