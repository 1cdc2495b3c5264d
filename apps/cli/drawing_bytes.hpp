// A drawing as a file's bytes: what `draw` and `gallery` write.
#pragma once
#include "command.hpp"

#include <freiform/io/drawing.hpp>

namespace freiform::cli {

// "svg", "pdf" or "png"; refuses the two that need cairo where the program was built without it. `command`
// names who asks.
Result<std::string> drawing_bytes(const Drawing& drawing, const std::string& format,
                                  const std::string& command);

}  // namespace freiform::cli
