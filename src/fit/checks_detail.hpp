// What several ways of fitting refuse.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/core/text.hpp>
#include <freiform/core/vec.hpp>

#include <span>
#include <string_view>

namespace freiform::detail {

template <int D>
Result<void> check_points(std::span<const Vec<D>> points, std::string_view name) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text(name, "[", i, "]"),
                          "has a coordinate that is not finite");
    return {};
}

}  // namespace freiform::detail
