// Numbers that every layer needs.
#pragma once
#include <limits>
#include <numbers>

namespace freiform {

// The unit roundoff u of doubles, 2^-53: what is rounded to nearest is off by at most u times its size, away
// from underflow.
inline constexpr double kUnitRoundoff = 0x1p-53;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kTwoPi = 2 * std::numbers::pi;

}  // namespace freiform
