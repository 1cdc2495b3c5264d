// What normals that turn make of an interpolation error: essay in bending.cpp.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace freiform {

// The largest of |p| + t (b + c) on a triangle, p and b quadratic and 0 at its corners, t convex, c constant:
// by Bezier points of the four parts that the middles of its sides make, on which t is at most linear.
class TurningError {
public:
    // Along sides opposite the corners second derivatives, eight times what p and b are in the middles.
    std::array<double, 3> along{}, beside{};
    std::array<double, 3> at_corner{}, at_middle{};  // t
    double more = 0;                                 // c

    double together = 0, turned = 0;  // all of it, and t (b + c) alone
    void find() {
        look(inner(along), inner(beside), at_middle);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            look(outer(along, j, k), outer(beside, j, k), {at_corner[i], at_middle[k], at_middle[j]});
        }
    }

private:
    using Points = std::array<double, 6>;  // of a quadratic function: 00, 11, 22, 12, 20, 01

    static Points inner(const std::array<double, 3>& x) {
        const double side = (x[0] + x[1] + x[2]) / 16;
        return {x[0] / 8, x[1] / 8, x[2] / 8, side, side, side};
    }
    // From a corner to the middles opposite k and j.
    static Points outer(const std::array<double, 3>& x, std::size_t j, std::size_t k) {
        return {0, x[k] / 8, x[j] / 8, (x[0] + x[1] + x[2]) / 16, x[j] / 8, x[k] / 8};
    }
    void look(const Points& p, const Points& b, const std::array<double, 3>& t) {
        const auto note = [&](double of_p, double of_b, double of_t) {
            const double turning = of_b + of_t * more;
            turned = std::max(turned, turning), together = std::max(together, std::abs(of_p) + turning);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            note(p[i], t[i] * b[i], t[i]);
            for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
                const std::size_t ij = 6 - i - j;
                note((p[i] + 2 * p[ij]) / 3, (t[j] * b[i] + 2 * t[i] * b[ij]) / 3, (2 * t[i] + t[j]) / 3);
            }
        }
        note((p[3] + p[4] + p[5]) / 3, (t[0] * b[3] + t[1] * b[4] + t[2] * b[5]) / 3,
             (t[0] + t[1] + t[2]) / 3);
    }
};

}  // namespace freiform
