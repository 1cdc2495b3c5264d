// What several questions refuse.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/core/text.hpp>
#include <freiform/core/vec.hpp>

#include <span>

namespace freiform::detail {

inline Result<void> check_accuracy(double accuracy) {
    if (accuracy >= 0) return {};
    return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length >= 0"));
}

// Of questions about many points.
template <int D>
Result<void> check_points(std::span<const Vec<D>> points, double accuracy, int max_parts) {
    if (auto ok = check_accuracy(accuracy); !ok) return ok;
    if (max_parts < 1) return refuse(RefusalKind::invalid, "max_parts", "is below 1");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    return {};
}

}  // namespace freiform::detail
