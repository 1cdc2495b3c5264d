// Colours that change along a parameter: splines in a space of colours.
#pragma once
#include <freiform/colour/colour_map.hpp>
#include <freiform/spline/patch.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace freiform {

// Where colours are mixed. srgb: components as they are stored; linear: amounts of light; oklab: as they are
// seen; oklch: lightness, chroma and hue (radians), so that mixtures stay colourful.
enum class ColourSpace { srgb, linear, oklab, oklch };
std::string_view name_of(ColourSpace space);

// Three coordinates of a colour, of oklch the hue in (-pi, pi]; and the colour with such coordinates. What
// sRGB does not have loses what is outside of it in each component of light: that may change its hue a
// little.
Vec<3> coordinates(const Colour& c, ColourSpace space);
Colour colour_at(const Vec<3>& coordinates, double opacity, ColourSpace space);

struct ColourStop {
    double at = 0;
    Colour colour;
};

struct GradientOptions {
    ColourSpace space = ColourSpace::oklab;
    enum class Way {
        lines,   // straight between the stops
        smooth,  // cubics through the stops, with the tangents of Catmull and Rom
        near,    // the cubic B-spline with the stops as control points: met at both ends only
    } way = Way::lines;
    bool longer_hue = false;  // of oklch: the longer way round the circle of hues
};

// Const and safe to share.
//   const auto g = *Gradient::make(stops, {.space = ColourSpace::oklch});
//   const Colour c = g(0.5);
class Gradient {
public:
    // Stops in order. Refuses, by "stops[i]", none, places that do not increase, components outside [0, 1].
    // A grey between colours has, in oklch, the hue of the stop before it (the first one: of that after it).
    static Result<Gradient> make(std::span<const ColourStop> stops, const GradientOptions& options = {});

    Interval domain() const { return curve_.domain()[0]; }
    ColourSpace space() const { return space_; }
    // Coordinates and opacity over the domain.
    const Curve<Vec<4>>& curve() const { return curve_; }
    // Before the first stop and after the last one their colours; NaN as the first.
    Colour operator()(double t) const;

    // Stops between which straight lines in sRGB (as SVG, CSS and PDF mix them) differ from this by at most
    // `tolerance` in each component, as seen at eight places between them: an estimate. Refuses tolerances
    // that are not positive, (limit) more than 4096 stops.
    Result<std::vector<ColourStop>> stops_in_srgb(double tolerance) const;

private:
    Gradient(Curve<Vec<4>> curve, ColourSpace space) : curve_(std::move(curve)), space_(space) {}
    Curve<Vec<4>> curve_;
    ColourSpace space_;
};

// "#rgb", "#rgba", "#rrggbb", "#rrggbbaa". Refuses others.
Result<Colour> colour_named(std::string_view hex);
// "#rrggbb", and opacity where it is not 1: rounded to 255 steps.
std::string hex_of(const Colour& c);

}  // namespace freiform
