// What the parts of `arrange` share. Boxes of pixels have y down.
#pragma once
#include <freiform/io/figure.hpp>

namespace freiform::figure {

// The plane of a panel to pixels.
struct Placed {
    Vec<2> scale{{1, 1}}, origin{};
    Box<2> area;   // of the panel without its axes
    Box<2> shown;  // the part of the plane that fills it

    Vec<2> operator()(const Vec<2>& p) const {
        return {{origin[0] + scale[0] * p[0], origin[1] - scale[1] * p[1]}};
    }
};

inline constexpr double kTickRoom = 46, kTickRoomBelow = 40, kSmallText = 13;

// Grid, axes, ticks and their names.
std::vector<DrawnGroup> axes_of(const Panel& panel, const Placed& placed);

// Finds room for the notes of all panels among `groups` on a page of this size, in this order. `area`: where
// the notes of a panel should stay.
struct PlacedNote {
    Note note;  // `at` in pixels
    Box<2> area;
    std::string layer;
};
std::vector<DrawnGroup> labels_of(std::span<const PlacedNote> notes, std::span<const DrawnGroup> groups,
                                  int width, int height);

}  // namespace freiform::figure
