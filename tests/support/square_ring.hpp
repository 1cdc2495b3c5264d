// The boundary of a square as four straight cubics, in the order of MeshGradient::coons.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>

namespace freiform::test {

inline std::array<Vec<2>, 12> square_ring() {
    std::array<Vec<2>, 12> p;
    for (int k = 0; k < 3; ++k) {
        const auto at = [&](int side) -> Vec<2>& { return p[std::size_t(3 * side + k)]; };
        at(0) = {{0, double(k)}}, at(1) = {{double(k), 3}};
        at(2) = {{3, 3.0 - k}}, at(3) = {{3.0 - k, 0}};
    }
    return p;
}

}  // namespace freiform::test
