// From rest to rest below ceilings of the speed, with a limit of the jerk.
#pragma once
#include <span>
#include <vector>

namespace freiform::detail {

// Between two places of the way the speed stays below this.
struct SpeedCeiling {
    double from = 0, to = 0, speed = 0;
};
// Constant jerk for some time.
struct JerkPhase {
    double from = 0, duration = 0, speed = 0, acceleration = 0, jerk = 0;
};

// Ceilings follow each other; `acceleration` may be infinite, `jerk` is not. Nothing where they have no
// length, or speeds and times leave the range of double.
std::vector<JerkPhase> motion_below(std::span<const SpeedCeiling> ceilings, double acceleration, double jerk);

}  // namespace freiform::detail
