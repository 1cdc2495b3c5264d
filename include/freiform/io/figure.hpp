// Figures: panels side by side, each with its own plane, with axes, words and a legend. `arrange` fits them
// into a picture and finds room for the words.
//
//     Figure f;
//     f.panels.push_back(...);
//     std::string svg = to_svg(arrange(f));
#pragma once
#include <freiform/io/paper.hpp>

#include <functional>
#include <optional>
#include <span>

namespace freiform {

// Words that belong to a place. They are put beside it, where they cover least.
struct Note {
    Vec<2> at{};  // in the plane of the panel
    DrawnText text;
    Colour colour = kInk;
    double size = 15;    // pixels
    Vec<2> toward{};     // where they should lie as seen from there (y up); zero: wherever there is room
    double gap = 8;      // pixels between the place and the words
    bool fixed = false;  // centred on the place itself, whatever is there
};

enum class Axes { none, ticks, grid };

struct Panel {
    std::string name;   // of the layer
    DrawnText caption;  // above the panel
    // In the plane of the panel, y up; widths, radii and sizes of letters in pixels. Coordinates are those of
    // the objects divided by 2^exponent.
    std::vector<DrawnGroup> groups;
    std::vector<Note> notes;
    std::optional<Box<2>> window;  // what is shown at least; without one: what is drawn
    bool equal = true;             // one scale for both directions
    Axes axes = Axes::none;
    DrawnText x_name, y_name;  // at the ends of the axes
    double share = 1;          // of the width of the row
    double largest = 1e300;    // pixels per unit at most
    int exponent = 0;
};

struct Figure {
    int width = 1200, height = 900;
    double margin = 0.05;  // of the smaller side
    DrawnText title;
    std::vector<Panel> panels;  // row by row
    int columns = 0;            // 0: all in one row
    bool legend = true;         // of the groups that have one, one entry for each text
};

Drawing arrange(const Figure& figure);

// A box around all that is drawn, and a margin of `by`, the error of polylines. Sharp to 1/100 for curves.
Box<2> box_of(std::span<const DrawnGroup> groups, double by = 0);

// Parts of panels.
DrawnPath line_through(std::span<const Vec<2>> points, bool closed = false);
DrawnPath bezier_path(std::span<const Vec<2>> points);  // of degree 1, 2 or 3
// The polyline through f at n + 1 equal steps.
DrawnPath sampled_path(const std::function<Vec<2>(double)>& f, const Interval& on, int n);
DrawnGroup dots(std::string role, const Colour& colour, std::span<const Vec<2>> at, double radius = 4);

}  // namespace freiform
