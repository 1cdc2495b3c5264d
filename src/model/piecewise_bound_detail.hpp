// Bounds of a second derivative piece by piece, and what they say of longer intervals.
#pragma once
#include <freiform/core/interval.hpp>

#include <vector>

namespace freiform {

// Of a function of one parameter, on pieces that follow each other. A short piece on which |f''| is large
// adds to what f may be off a straight line as a kink does, by its integral: less by far than if it were as
// large everywhere.
class PiecewiseBound {
public:
    void add(double end, double most) { pieces_.push_back({end, most}); }
    bool is_empty() const { return pieces_.empty(); }

    // A number M with, h the length of the interval: |f - linear interpolation between its ends| is at most M
    // h^2 / 8, and f' differs from that of the linear function, and between the middle and any other place,
    // by at most M h / 2. For any m, |f''| <= m plus what pieces exceed m by: Green's function of the
    // interpolation is at most h / 4, its derivative at most 1. With m the median by length the sum is
    // smallest. REQUIRES pieces.
    double steady(Interval on) const;

private:
    struct Piece {
        double end, most;
    };
    std::vector<Piece> pieces_;  // the first and the last go on
};

}  // namespace freiform
