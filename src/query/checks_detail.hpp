// What several questions refuse.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/core/text.hpp>

namespace freiform::detail {

inline Result<void> check_accuracy(double accuracy) {
    if (accuracy >= 0) return {};
    return refuse(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length >= 0"));
}

}  // namespace freiform::detail
