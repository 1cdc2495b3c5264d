// What the figures of the gallery are made with: curves from documents, and a panel that is filled step by
// step.
#pragma once
#include <freiform/io/document.hpp>
#include <freiform/io/drawing.hpp>
#include <freiform/spline/bezier.hpp>

#include <stdexcept>

namespace freiform::cli::gallery {

using Plane2 = Vec<2>;
using Points = std::vector<Vec<2>>;

inline constexpr Colour kWhite{1, 1, 1, 1};
inline constexpr Colour kBlue = kPalette[0], kOrange = kPalette[1], kGreen = kPalette[2],
                        kPurple = kPalette[3], kSky = kPalette[4], kOchre = kPalette[5];

// The documents of the gallery are part of the program, so what they ask for cannot be refused.
template <class T>
T sure(Result<T> r) {
    if (!r) throw std::logic_error(text(r.error().where, ": ", r.error().message));
    return std::move(*r);
}

const Shape& shape_in(const Document& document, std::string_view name);
template <class P = Vec<2>>
const Curve<P>& curve_in(const Document& document, std::string_view name) {
    return std::get<Curve<P>>(shape_in(document, name));
}

template <class P>
Curve<P> spline(int degree, std::vector<double> knots, std::vector<P> points) {
    const int n = int(points.size());
    return sure(Curve<P>::make({sure(BSplineBasis::make(degree, std::move(knots)))},
                               Net<1, P>({n}, std::move(points))));
}
template <class P>
Curve<P> bezier(std::vector<P> points, Interval on = {0, 1}) {
    const int n = int(points.size());
    return sure(Curve<P>::make({sure(BSplineBasis::bezier(n - 1, on))}, Net<1, P>({n}, std::move(points))));
}
template <class P>
Points points_of(const Curve<P>& curve) {
    Points out;
    for (const P& c : curve.net().flat()) out.push_back(project(c));
    return out;
}

struct Look {
    Colour colour = kBlue;
    double width = 2.4;
    std::string_view legend;  // a formula
    std::vector<double> dashes;
};
inline Look thin(const Colour& colour, std::string_view legend = "") { return {colour, 1.1, legend, {}}; }
inline Look dashed(const Colour& colour, std::string_view legend = "") {
    return {colour, 1.2, legend, {6, 4}};
}

class Plot {
public:
    explicit Plot(std::string_view name, std::string_view caption = "");

    // The curve with all that the options ask for, in this colour.
    Plot& shape(const Shape& shape, DrawingOptions how, const Colour& colour = kBlue);
    Plot& curve(const Shape& shape, const Look& look = {});
    // Lines and points, with names if there are any: "*P*_1".
    Plot& polygon(const Points& points, const Look& look, const std::vector<std::string>& names = {},
                  bool closed = false);
    Plot& lines(const Points& points, const Look& look, bool closed = false);
    Plot& area(const Points& points, const Colour& colour, double opacity, std::string_view legend = "");
    Plot& dots(const Points& points, const Colour& colour, double radius = 4, bool hollow = false,
               std::string_view legend = "");
    Plot& arrow(const Vec<2>& from, const Vec<2>& to, const Look& look, std::string_view name = "");
    // y = f(x), through n + 1 points.
    Plot& graph(const std::function<double(double)>& f, const Interval& on, const Look& look, int n = 240);
    Plot& path(const std::function<Vec<2>(double)>& f, const Interval& on, const Look& look, int n = 240);
    Plot& note(const Vec<2>& at, std::string_view words, const Vec<2>& toward = {},
               const Colour& colour = kInk, double size = 15);
    Plot& fixed(const Vec<2>& at, std::string_view words, const Colour& colour = kInk, double size = 15);
    Plot& axes(Axes kind, std::string_view x, std::string_view y);
    Plot& window(const Vec<2>& lo, const Vec<2>& hi);
    Plot& stretched();  // scales of both directions may differ
    Plot& share(double of_width);

    Panel panel;

private:
    DrawnGroup& group(std::string role, const Look& look);
};

// Names such as *P*_1 .. *P*_n.
std::vector<std::string> numbered(char letter, int first, std::size_t count);

Figure page(std::string_view title, std::vector<Panel> panels, int columns = 0, int width = 1200,
            int height = 620);

}  // namespace freiform::cli::gallery
