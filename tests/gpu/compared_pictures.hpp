// Pictures of surfaces against those of meshes, before a background of magenta; surfaces are grey.
#pragma once
#include <freiform/core/image.hpp>

#include <algorithm>
#include <cstdlib>

namespace freiform::test {

// How much of the background is in a pixel.
inline int background(const Image& image, int x, int y) {
    const unsigned char* p = image.pixel(x, y);
    return (p[0] + p[2]) / 2 - p[1];
}

// Cracked: background where the mesh has none around. Different: darker or lighter than everything around in
// the other picture, by more than `by`; not at outlines, where more of a pixel may be covered.
struct ComparedPictures {
    int cracked = 0, different = 0, surface = 0;
};
inline ComparedPictures compared(const Image& gpu, const Image& mesh, int by) {
    ComparedPictures out;
    const auto is_beyond = [&](const Image& a, const Image& b, int x, int y) {
        for (int c = 0; c < 3; ++c) {
            int least = 255, most = 0;
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) {
                    least = std::min(least, int(b.pixel(x + i, y + j)[c]));
                    most = std::max(most, int(b.pixel(x + i, y + j)[c]));
                }
            if (a.pixel(x, y)[c] < least - by || a.pixel(x, y)[c] > most + by) return true;
        }
        return false;
    };
    for (int y = 1; y + 1 < gpu.height; ++y)
        for (int x = 1; x + 1 < gpu.width; ++x) {
            int around = 0;
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) around = std::max(around, background(mesh, x + i, y + j));
            if (around >= 3) continue;
            ++out.surface;
            out.cracked += background(gpu, x, y) > 6;
            out.different += is_beyond(gpu, mesh, x, y) || is_beyond(mesh, gpu, x, y);
        }
    return out;
}

// Averages over squares of n by n pixels.
inline Image reduced(const Image& image, int n) {
    Image out;
    out.width = image.width / n, out.height = image.height / n;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            for (int c = 0; c < 3; ++c) {
                int sum = 0;
                for (int i = 0; i < n * n; ++i) sum += image.pixel(n * x + i % n, n * y + i / n)[c];
                out.rgb.push_back(static_cast<unsigned char>(sum / (n * n)));
            }
    return out;
}

// Pixels with less red, which the background is full of, than everything around in the other picture.
inline int darker(const Image& image, const Image& other, int by) {
    int out = 0;
    for (int y = 1; y + 1 < image.height; ++y)
        for (int x = 1; x + 1 < image.width; ++x) {
            int least = 255;
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) least = std::min(least, int(other.pixel(x + i, y + j)[0]));
            out += image.pixel(x, y)[0] < least - by;
        }
    return out;
}

// Black where they agree.
inline Image difference(const Image& a, const Image& b) {
    Image out = a;
    for (std::size_t i = 0; i < out.rgb.size(); ++i)
        out.rgb[i] = static_cast<unsigned char>(std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    return out;
}

}  // namespace freiform::test
