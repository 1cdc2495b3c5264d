// Path data that may be meant to take all memory.
#pragma once
#include <freiform/path/path.hpp>

namespace freiform {

// parse_path_data up to this many segments; what has more is stopped there (limit). An arc is up to four of
// them, and each subpath counts as one more.
PathData parse_path_data_up_to(std::string_view text, std::size_t most_segments);

}  // namespace freiform
