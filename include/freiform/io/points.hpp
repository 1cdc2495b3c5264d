// Points and other numbers from files that people and programs write: lines of numbers (CSV), or JSON.
#pragma once
#include <freiform/core/net.hpp>
#include <freiform/io/read.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace freiform {

struct NumberLines {
    std::vector<std::vector<double>> row;
    std::vector<std::size_t> line;  // where each row stands, from 1
};

// A row per line, its numbers separated by commas, semicolons, tabs or blanks. Empty lines are skipped, `#`
// begins a comment, and a first line without any number is a heading (NaN, infinity and what is in quotes are
// numbers here). Refuses, with the line, what else is there and numbers that are not finite.
Result<NumberLines> parse_number_lines(std::string_view text);

// Points in one sequence, or rows of points that form a grid (extent[0] rows of extent[1] points).
struct PointTable {
    int coords = 0;  // of each point, 1 to 4
    bool grid = false;
    Index<2> extent{};               // of a sequence: {number of points, 1}
    std::vector<double> values;      // coordinate after coordinate
    std::vector<std::string> place;  // of each point: "line 7" or "[3][0]"
};

// Lines as above; or a JSON array of points, [[x,y], ...], or of rows of points, [[[x,y,z], ...], ...], or an
// object with such an array as `points`. Text that begins with [ or { is JSON. All points have the same
// number of coordinates, all rows the same number of points. Refusals name the line or the index.
Result<PointTable> parse_points(std::string_view text);

// The same from a file; "-" is standard input. Refusals begin with the name of the file.
Result<PointTable> read_points(const std::string& path, const ReadOptions& options = {});
Result<NumberLines> read_number_lines(const std::string& path, const ReadOptions& options = {});

}  // namespace freiform
