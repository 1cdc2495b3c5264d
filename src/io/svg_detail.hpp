// Reading SVG: styles and lengths.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/io/svg.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::svg {

// What percentages and relative units of lengths refer to.
struct Metrics {
    double width = 100, height = 100;              // of the viewport
    double font = 16, root_font = 16;              // sizes
    double outer_width = 100, outer_height = 100;  // of the outermost viewport
};
enum class Along { x, y, both };

// A number with an optional unit, in user units; nothing if it is anything else.
std::optional<double> length(std::string_view s, const Metrics& metrics, Along along);
// All numbers of a list separated by blanks or commas, up to what is none.
std::vector<double> number_list(std::string_view s);
// A list of lengths; nothing if something is none.
std::optional<std::vector<double>> length_list(std::string_view s, const Metrics& metrics, Along along);
// The value of the attribute `transform`; nothing if it is malformed.
std::optional<Affinity<2>> transform_of(std::string_view s);
Affinity<2> product(const Affinity<2>& outer, const Affinity<2>& inner);

struct ViewBox {
    double x = 0, y = 0, width = 0, height = 0;
};
std::optional<ViewBox> view_box(std::string_view s);
// From the coordinates of the view box to a viewport of this size at the origin.
Affinity<2> fitted(const ViewBox& box, double width, double height, std::string_view aspect);

// Elements that are there to be referred to, or say nothing about geometry.
bool is_silent(std::string_view element);

// The outline of a path or a basic shape whose attributes have these texts (empty where they are absent);
// nothing if the element is neither. What has no meaning is reported; after `most_segments` a path ends.
std::optional<Path> outline(std::string_view element,
                            const std::function<std::string_view(const char*)>& attribute,
                            const Metrics& metrics,
                            const std::function<void(RefusalKind, std::string)>& report,
                            std::size_t most_segments);

using Declarations = std::vector<std::pair<std::string, std::string>>;  // property, value
Declarations declarations(std::string_view s);
bool is_geometry(
    std::string_view property);  // where and how large something is, which style sheets may say too

// Rules of style sheets: for a type, a class or an id.
class StyleSheet {
public:
    // Rules with other selectors are counted and ignored.
    void add(std::string_view css);
    int ignored() const { return ignored_; }
    // Selectors and declarations, each for each, are held up to this number.
    static constexpr std::size_t kMost = 200000;
    bool is_full() const { return held_ > kMost; }
    // How many characters `of` and who goes through its answer look at, roughly.
    std::size_t cost_of(std::string_view element, std::string_view id, std::string_view classes) const;
    // What applies to the element, weakest first.
    Declarations of(std::string_view element, std::string_view id, std::string_view classes) const;

private:
    std::map<std::string, Declarations, std::less<>> rules_[4];  // by "*", type, class, id
    template <class F>
    void each_rule(std::string_view element, std::string_view id, std::string_view classes, F&& f) const;
    int ignored_ = 0;
    std::size_t held_ = 0;
};

// What elements hand on to those inside them.
struct Style {
    std::string fill = "black", stroke = "none", colour = "black";
    FillRule fill_rule = FillRule::nonzero;
    StrokeStyle line;
    double font = 16;
    bool visible = true;
    bool shown = true;  // not handed on: `display`

    // False if the value has no meaning; then nothing changes.
    bool set(std::string_view property, std::string_view value, const Style& parent, const Metrics& metrics);
};

}  // namespace freiform::svg
