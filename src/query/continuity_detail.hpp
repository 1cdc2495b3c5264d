// What the continuity of curves and of surfaces shares: when a jump counts as none, and what options must be.
#pragma once
#include <freiform/query/continuity.hpp>

#include <string_view>

namespace freiform::detail {

// Refuses numbers that are negative or not finite; `orders` is the caller's to check.
Result<void> check_allowances(const ContinuityOptions& options);

std::unexpected<Refusal> out_of_range(std::string_view list, std::size_t order);

// The jump of a derivative of order k that moves a point by `distance` in h.
double worth(double distance, double h, int k);

// The highest order up to which all jumps count as none: those up to bound + allowed(k).
template <class AnyJump, class Allowed>
int order_of(const std::vector<AnyJump>& jumps, Allowed&& allowed) {
    int order = -1;
    for (const AnyJump& j : jumps) {
        if (!(j.size <= j.bound + allowed(order + 1))) break;
        ++order;
    }
    return order;
}

template <class AnyJump>
Result<void> check_finite(const std::vector<AnyJump>& jumps, std::string_view list) {
    for (std::size_t k = 0; k < jumps.size(); ++k)
        if (!std::isfinite(jumps[k].size) || !std::isfinite(jumps[k].bound)) return out_of_range(list, k);
    return {};
}

}  // namespace freiform::detail
