#include "gallery/plot.hpp"

#include <algorithm>

namespace freiform::cli::gallery {

namespace {

// Curves are followed for pictures of this size, whatever the panel will have; surfaces, whose lines cost far
// more, for pictures of about the size of a panel.
constexpr int kFineness = 1600, kSurfaceFineness = 600;

}  // namespace

const Shape& shape_in(const Document& document, std::string_view name) {
    const auto found = std::ranges::find(document.objects, name, &Object::name);
    if (found == document.objects.end()) throw std::logic_error(text("no object ", name));
    return found->shape;
}

Plot::Plot(std::string_view name, std::string_view caption) {
    panel.name = name;
    panel.caption = formula(caption);
}

DrawnGroup& Plot::group(std::string role, const Look& look) {
    panel.groups.push_back({"", std::move(role), look.colour, look.width, {}, {}, {}});
    panel.groups.back().dashes = look.dashes;
    panel.groups.back().legend = formula(look.legend);
    return panel.groups.back();
}

Plot& Plot::shape(const Shape& shape, DrawingOptions how, const Colour& colour) {
    Document document;
    document.objects.push_back({"", shape, {}});
    how.width = how.height = type_name(shape) == "curve" ? kFineness : kSurfaceFineness;
    how.palette = {colour};
    std::vector<Refusal> left_out;
    for (Panel& p : sure(panels_of(document, {}, how, left_out))) {
        if (!p.name.empty()) continue;  // further panels
        for (DrawnGroup& g : p.groups) {
            g.name.clear();
            g.legend.clear();
            panel.groups.push_back(std::move(g));
        }
        panel.notes.insert(panel.notes.end(), p.notes.begin(), p.notes.end());
    }
    return *this;
}

Plot& Plot::curve(const Shape& drawn, const Look& look) {
    shape(drawn, {}, look.colour);
    DrawnGroup& g = panel.groups.back();
    g.width = look.width;
    g.dashes = look.dashes;
    g.legend = formula(look.legend);
    return *this;
}

Plot& Plot::polygon(const Points& points, const Look& look, const std::vector<std::string>& names,
                    bool closed) {
    DrawnGroup& g = group("control", look);
    g.paths.push_back(line_through(points, closed));
    for (const Vec<2>& p : points) g.discs.push_back({p, 3.6, false});
    for (std::size_t i = 0; i < std::min(points.size(), names.size()); ++i) {
        const std::size_t n = points.size();
        Vec<2> away{};
        if (i > 0 || closed) away += unit(points[i] - points[(i + n - 1) % n]);
        if (i + 1 < n || closed) away += unit(points[i] - points[(i + 1) % n]);
        note(points[i], names[i], away, mixed(look.colour, kInk, 0.4));
    }
    return *this;
}

Plot& Plot::lines(const Points& points, const Look& look, bool closed) {
    group("lines", look).paths.push_back(line_through(points, closed));
    return *this;
}

Plot& Plot::area(const Points& points, const Colour& colour, double opacity, std::string_view legend) {
    DrawnGroup& g = group("area", {mixed(colour, {1, 1, 1, 1}, 0.3), 0.8, legend, {}});
    g.paths.push_back(line_through(points, true));
    g.fill = opacity;
    return *this;
}

Plot& Plot::dots(const Points& points, const Colour& colour, double radius, bool hollow,
                 std::string_view legend) {
    DrawnGroup& g = group("points", {colour, 1.4, legend, {}});
    for (const Vec<2>& p : points) g.discs.push_back({p, radius, hollow});
    return *this;
}

Plot& Plot::arrow(const Vec<2>& from, const Vec<2>& to, const Look& look, std::string_view name) {
    DrawnGroup& g = group("arrow", look);
    g.paths.push_back(line_through(std::array{from, to}));
    g.arrows = true;
    if (!name.empty()) note(to, name, to - from, look.colour);
    return *this;
}

Plot& Plot::graph(const std::function<double(double)>& f, const Interval& on, const Look& look, int n) {
    return path([&](double x) { return Vec<2>{{x, f(x)}}; }, on, look, n);
}

Plot& Plot::path(const std::function<Vec<2>(double)>& f, const Interval& on, const Look& look, int n) {
    group("graph", look).paths.push_back(sampled_path(f, on, n));
    return *this;
}

Plot& Plot::note(const Vec<2>& at, std::string_view words, const Vec<2>& toward, const Colour& colour,
                 double size) {
    panel.notes.push_back({at, formula(words), colour, size, toward});
    return *this;
}

Plot& Plot::fixed(const Vec<2>& at, std::string_view words, const Colour& colour, double size) {
    note(at, words, {}, colour, size);
    panel.notes.back().fixed = true;
    return *this;
}

Plot& Plot::axes(Axes kind, std::string_view x, std::string_view y) {
    panel.axes = kind;
    panel.x_name = formula(x);
    panel.y_name = formula(y);
    return *this;
}

Plot& Plot::window(const Vec<2>& lo, const Vec<2>& hi) {
    panel.window = Box<2>{lo, hi};
    return *this;
}

Plot& Plot::stretched() {
    panel.equal = false;
    return *this;
}

Plot& Plot::share(double of_width) {
    panel.share = of_width;
    return *this;
}

std::vector<std::string> numbered(char letter, int first, std::size_t count) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(text("*", letter, "*_{", int(i) + first, "}"));
    return names;
}

Figure page(std::string_view title, std::vector<Panel> panels, int columns, int width, int height) {
    Figure f;
    f.width = width, f.height = height;
    f.margin = 0.04;
    f.title = formula(title);
    f.panels = std::move(panels);
    f.columns = columns;
    return f;
}

}  // namespace freiform::cli::gallery
