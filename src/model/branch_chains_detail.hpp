// Branches of models as chains.
#pragma once
#include <freiform/model/intersect.hpp>

namespace freiform {

std::vector<BranchChain> chains_of(const std::vector<FaceBranch>& branches,
                                   const std::array<const Model*, 2>& models, double tolerance);

}  // namespace freiform
