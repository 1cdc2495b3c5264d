// Fonts as the commands `text` and `font` name them.
#pragma once
#include "command.hpp"

#include <freiform/font/font.hpp>

namespace freiform::cli {

struct FontArguments {
    std::string font;               // a file, or else a family
    std::vector<std::string> axes;  // "wght=700"
    std::optional<int> face;
};
Result<Font> read_font(const Context& context, const FontArguments& options);

}  // namespace freiform::cli
