// Numbers as colours: maps on which equal steps look equally far apart.
#pragma once
#include <freiform/core/colour.hpp>

#include <array>

namespace freiform {

// The colour space in which distances are roughly those seen: lightness L in [0, 1], a towards red, b
// towards yellow [Ottosson 2020].
struct Oklab {
    double L = 0, a = 0, b = 0;
};
Oklab to_oklab(const Colour& c);
double oklab_distance(const Colour& p, const Colour& q);

// sequential: from dark blue through green to light yellow, for what has no middle. diverging: blue, nearly
// white at 1/2, red, for what has two signs.
enum class MapKind { sequential, diverging };

class ColourMap {
public:
    static constexpr int kSize = 257;  // odd: the middle is an entry

    explicit ColourMap(MapKind kind);
    // t is taken as the nearest number in [0, 1]; NaN gives the colour of 0.
    Colour operator()(double t) const;
    // At equal steps of t.
    const std::array<Colour, kSize>& colours() const { return colours_; }

private:
    std::array<Colour, kSize> colours_{};
};

// For what has no value.
inline constexpr Colour kNoValue{0.62, 0.60, 0.62, 1};

}  // namespace freiform
