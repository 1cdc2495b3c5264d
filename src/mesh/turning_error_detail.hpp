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
        const double along_inside = inside(along), beside_inside = inside(beside);
        // Of the part between the middles: at these, between them, and inside of it.
        double all_p = along_inside, all_b = 0, all_t = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const double t = at_middle[i], p = along[i] / 8, b = beside[i] / 8;
            note(p, t * b, t);
            for (const std::size_t other : {j, k})
                note((p + 2 * along_inside) / 3, (at_middle[other] * b + 2 * t * beside_inside) / 3,
                     (2 * t + at_middle[other]) / 3);
            all_b += t * beside_inside / 3, all_t += t / 3;
        }
        note(all_p, all_b, all_t);
        for (std::size_t i = 0; i < 3; ++i) look_from(i);
    }

private:
    // Of quadratic functions: between two middles of sides.
    static double inside(const std::array<double, 3>& x) { return (x[0] + x[1] + x[2]) / 16; }

    void note(double p, double tb, double t) {
        const double turning = tb + t * more;
        turned = std::max(turned, turning), together = std::max(together, std::abs(p) + turning);
    }
    // The part that has this corner, but for what it shares with the one between the middles.
    void look_from(std::size_t i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double t = at_corner[i];
        note(0, 0, t);
        for (const std::size_t side : {k, j}) {
            const double u = at_middle[side], p = along[side] / 8, b = beside[side] / 8;
            note(2 * p / 3, 2 * t * b / 3, (2 * t + u) / 3);
            note(p, (t * b + 2 * u * b) / 3, (t + 2 * u) / 3);
        }
        note((along[k] / 8 + along[j] / 8 + inside(along)) / 3,
             (t * inside(beside) + at_middle[k] * beside[j] / 8 + at_middle[j] * beside[k] / 8) / 3,
             (t + at_middle[j] + at_middle[k]) / 3);
    }
};

}  // namespace freiform
