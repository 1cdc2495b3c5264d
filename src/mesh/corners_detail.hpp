// The corners 0, 1, 2 of a triangle, around.
#pragma once

namespace freiform {

constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
constexpr int previous(int i) { return i == 0 ? 2 : i - 1; }

}  // namespace freiform
