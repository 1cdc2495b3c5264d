// A picture of pixels.
#pragma once
#include <cstddef>
#include <vector>

namespace freiform {

// Rows from the top, three sRGB bytes per pixel.
struct Image {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;

    const unsigned char* pixel(int x, int y) const {
        return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
    }
};

}  // namespace freiform
