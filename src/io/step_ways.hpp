// Ways around holes, for seams.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>
#include <optional>
#include <vector>

namespace freiform::step {

// Parameters of a surface that closes, as (x, y): x has the period 1, and the loops between which a seam is
// to run have y from 0 to 1.
struct Strip {
    std::vector<std::array<Vec<2>, 2>> outlines;  // segments of all loops, in one of their periods
    std::vector<Vec<2>> from, to;                 // corners of both loops
    std::optional<double> pole;                   // in place of `to`: this y
};

struct Way {
    std::size_t from = 0, to = 0;  // corners
    std::vector<Vec<2>> inner;     // points between, in the period of the first corner
    Vec<2> end{};                  // likewise: the other corner, or a place at the pole
};

// Empty where none is found.
std::optional<Way> find_way(const Strip& strip);

}  // namespace freiform::step
