// What is on a drawing, in pixels: lines, Bezier curves, discs and words, in named groups. SVG comes from
// here; PDF and PNG from paint/paint.hpp.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

inline constexpr Colour kInk{0.13, 0.13, 0.15, 1}, kGrey{0.52, 0.53, 0.55, 1}, kFaint{0.86, 0.87, 0.88, 1};
// Dark enough on white, told apart also by the colour-blind, and in grey print by their lightness.
inline constexpr std::array<Colour, 7> kPalette{{{0.00, 0.33, 0.62, 1},
                                                 {0.80, 0.30, 0.00, 1},
                                                 {0.00, 0.50, 0.36, 1},
                                                 {0.66, 0.27, 0.52, 1},
                                                 {0.18, 0.55, 0.80, 1},
                                                 {0.72, 0.50, 0.00, 1},
                                                 {0.25, 0.25, 0.28, 1}}};

constexpr Colour mixed(const Colour& a, const Colour& b, double t) {
    return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), 1};
}

// A line (1), a quadratic (2) or a cubic Bezier curve (3) that begins where the one before ends.
struct DrawnSegment {
    int degree = 1;
    std::array<Vec<2>, 3> points{};  // the first `degree` of them; the last is the end
};

struct DrawnPath {
    Vec<2> start{};
    std::vector<DrawnSegment> segments;
    bool closed = false;
    bool solid = false;  // filled with the colour of the lines, and without one around it
    std::string
        part{};  // what it belongs to within its group, as a face; neighbours of one part are together
};

struct DrawnDisc {
    Vec<2> centre{};
    double radius = 1;  // pixels
    bool hollow = false;
};

// Some letters of a label. `level`: -1 subscript, 0 on the line, 1 superscript.
struct DrawnRun {
    std::string text;  // UTF-8
    int level = 0;
    bool italic = false;
};
using DrawnText = std::vector<DrawnRun>;

// Reads "*b*_1^{n-1} on [0, 1]": between asterisks italic; _ and ^ set the next letter, or what is in braces,
// low or high, where small letters are italic. For text that is nobody's formula (names of objects):
// plain_text.
DrawnText formula(std::string_view s);
DrawnText plain_text(std::string_view s);
// About as wide as a usual typeface with serifs would be, in pixels; an estimate.
double width_of(const DrawnText& text, double size);

enum class Anchor { start, middle, end };

struct DrawnLabel {
    Vec<2> at{};  // where the base line begins, has its middle, or ends
    DrawnText text;
    double size = 15;  // of the letters, pixels
    Anchor anchor = Anchor::start;
    bool bold = false;
};

// All of one role that one object has.
struct DrawnGroup {
    std::string name;  // the object
    std::string
        role;  // "curve", "isolines", "edges", "control", "knots", "comb", "construction", "point", ...
    Colour colour;
    double width = 1;  // of lines, pixels
    std::vector<DrawnPath> paths;
    std::vector<DrawnDisc> discs;    // drawn after the paths
    std::vector<DrawnLabel> labels;  // after the discs, with a white rim
    std::vector<double> dashes{};    // lengths of lines and gaps, pixels; empty: solid
    double fill = 0;                 // opacity of the inside of the paths
    bool arrows = false;             // at the ends of the paths; `arrange` makes the heads
    DrawnText legend{};              // what `arrange` says of the group in the legend; empty: nothing
    std::string layer{};             // groups of one layer are neighbours
    // The paths are one area by the winding rule (not 0), filled with the colour and without lines around it:
    // letters, whose inner paths are holes.
    bool area = false;
};

// In pixels, the origin at the upper left corner, y down.
struct Drawing {
    int width = 0, height = 0;
    std::vector<DrawnGroup> groups;  // in the order of drawing
    // A point (x, y) of the drawn plane, that of the first panel, is the pixel (origin_x + scale x,
    // origin_y - scale y). The plane is that of the objects where all of them are plane, else that of the
    // view.
    double scale = 1;
    Vec<2> origin{};
    std::vector<Refusal> left_out;  // what could not be drawn
    std::string title;
};

inline const Vec<2>& end_of(const DrawnSegment& s) { return s.points[std::size_t(s.degree - 1)]; }
// The end of what is there of a path.
inline const Vec<2>& end_of(const DrawnPath& path) {
    return path.segments.empty() ? path.start : end_of(path.segments.back());
}
// The Bezier curve from `from` on, at t.
Vec<2> point_at(const Vec<2>& from, const DrawnSegment& s, double t);

// Text that editors of drawings open as such: one layer per panel and group, cubic curves as curves, words as
// words. Every element that can be named has an id of its own.
std::string to_svg(const Drawing& drawing);

}  // namespace freiform
