// The legend of a picture that is coloured by a number.
#pragma once
#include <freiform/colour/colour_map.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/io/paper.hpp>

#include <optional>

namespace freiform {

struct ColourBar {
    std::optional<MapKind> map;      // none: words only
    Interval range{0, 1};            // as RenderOptions::range
    DrawnText title;                 // above: the quantity and its unit
    std::vector<DrawnText> remarks;  // below
    bool no_value = false;           // explain the colour of what has no value
};

inline constexpr double kColourBarRoom = 150;  // pixels at the right

// At the right side of a picture of this size; nothing else is drawn. Numbers are multiples of 1, 2 or 5
// times a power of ten.
Drawing drawing_of(const ColourBar& bar, int width, int height);

}  // namespace freiform
