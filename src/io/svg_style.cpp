// Lengths, transforms and styles of SVG.
#include "svg_detail.hpp"

#include <freiform/core/scan.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::svg {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\f";

std::string_view stripped(std::string_view s) {
    const std::size_t first = s.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(kBlanks) - first + 1);
}

// A number at the front, which is removed; nothing if there is none.
std::optional<double> take_number(std::string_view& s) {
    std::size_t end = 0;
    const auto digits = [&] {
        const std::size_t first = end;
        while (end < s.size() && s[end] >= '0' && s[end] <= '9') ++end;
        return end > first;
    };
    if (end < s.size() && (s[end] == '-' || s[end] == '+')) ++end;
    bool any = digits();
    if (end < s.size() && s[end] == '.') ++end, any = digits() || any;
    if (!any) return std::nullopt;
    if (end + 1 < s.size() && (s[end] == 'e' || s[end] == 'E')) {
        const std::size_t mantissa = end++;
        if (s[end] == '-' || s[end] == '+') ++end;
        if (!digits()) end = mantissa;  // "1em"
    }
    const auto x = scan_number<double>(s.substr(0, end));
    if (x) s.remove_prefix(end);
    return x;
}

void skip_separator(std::string_view& s) {
    s = s.substr(std::min(s.size(), s.find_first_not_of(kBlanks)));
    if (s.starts_with(','))
        s = s.substr(std::min(s.size(), std::max<std::size_t>(1, s.find_first_not_of(kBlanks, 1))));
}

std::optional<double> unit_of(std::string_view unit, const Metrics& m, Along along) {
    constexpr double kInch = 96;
    const double across = along == Along::x   ? m.width
                          : along == Along::y ? m.height
                                              : std::sqrt((m.width * m.width + m.height * m.height) / 2);
    const std::pair<std::string_view, double> units[] = {
        {"", 1},
        {"px", 1},
        {"in", kInch},
        {"cm", kInch / 2.54},
        {"mm", kInch / 25.4},
        {"q", kInch / 101.6},
        {"pt", kInch / 72},
        {"pc", kInch / 6},
        {"em", m.font},
        {"ex", m.font / 2},
        {"ch", m.font / 2},
        {"ic", m.font},
        {"rem", m.root_font},
        {"%", across / 100},
        {"vw", m.outer_width / 100},
        {"vh", m.outer_height / 100},
        {"vmin", std::min(m.outer_width, m.outer_height) / 100},
        {"vmax", std::max(m.outer_width, m.outer_height) / 100}};
    std::string lower(unit);
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    for (const auto& [name, factor] : units)
        if (name == lower) return factor;
    return std::nullopt;
}

}  // namespace

std::optional<double> length(std::string_view s, const Metrics& metrics, Along along) {
    s = stripped(s);
    const auto x = take_number(s);
    if (!x) return std::nullopt;
    const auto unit = unit_of(stripped(s), metrics, along);
    if (!unit || !std::isfinite(*x * *unit)) return std::nullopt;
    return *x * *unit;
}

std::vector<double> number_list(std::string_view s) {
    std::vector<double> out;
    for (s = stripped(s);; skip_separator(s)) {
        const auto x = take_number(s);
        if (!x) return out;
        out.push_back(*x);
    }
}

std::optional<std::vector<double>> length_list(std::string_view s, const Metrics& metrics, Along along) {
    std::vector<double> out;
    for (s = stripped(s); !s.empty(); skip_separator(s)) {
        const auto x = length(s.substr(0, s.find_first_of(" \t\r\n\f,")), metrics, along);
        if (!x) return std::nullopt;
        out.push_back(*x);
        s = s.substr(std::min(s.size(), s.find_first_of(" \t\r\n\f,")));
    }
    return out;
}

Affinity<2> product(const Affinity<2>& a, const Affinity<2>& b) {
    Affinity<2> out;
    for (std::size_t i = 0; i < 2; ++i) {
        out.offset[int(i)] = a.offset[int(i)];
        for (std::size_t k = 0; k < 2; ++k) {
            out.offset[int(i)] += a.linear[i][k] * b.offset[int(k)];
            for (std::size_t j = 0; j < 2; ++j) out.linear[i][j] += a.linear[i][k] * b.linear[k][j];
        }
    }
    return out;
}

std::optional<Affinity<2>> transform_of(std::string_view s) {
    const auto matrix = [](double a, double b, double c, double d, double e, double f) {
        return Affinity<2>{{{{a, c}, {b, d}}}, {{e, f}}};
    };
    Affinity<2> out = matrix(1, 0, 0, 1, 0, 0);
    for (s = stripped(s); !s.empty(); skip_separator(s)) {
        const std::size_t open = s.find('('), close = s.find(')');
        if (open == std::string_view::npos || close == std::string_view::npos || close < open)
            return std::nullopt;
        const std::string_view name = stripped(s.substr(0, open)),
                               inside = stripped(s.substr(open + 1, close - open - 1));
        const std::vector<double> v = number_list(inside);
        s.remove_prefix(close + 1);
        const double radians = v.empty() ? 0 : v[0] * (std::numbers::pi / 180);
        // Quarter turns are exact.
        const double turn = v.empty() ? 0 : std::fmod(v[0], 360);
        double sine = std::sin(radians), cosine = std::cos(radians);
        if (std::fmod(turn, 90) == 0) sine = std::round(sine), cosine = std::round(cosine);
        Affinity<2> step;
        if (name == "matrix" && v.size() == 6)
            step = matrix(v[0], v[1], v[2], v[3], v[4], v[5]);
        else if (name == "translate" && (v.size() == 1 || v.size() == 2))
            step = matrix(1, 0, 0, 1, v[0], v.size() == 2 ? v[1] : 0);
        else if (name == "scale" && (v.size() == 1 || v.size() == 2))
            step = matrix(v[0], 0, 0, v.back(), 0, 0);
        else if (name == "rotate" && v.size() == 1)
            step = matrix(cosine, sine, -sine, cosine, 0, 0);
        else if (name == "rotate" && v.size() == 3)
            step = matrix(cosine, sine, -sine, cosine, v[1] - cosine * v[1] + sine * v[2],
                          v[2] - sine * v[1] - cosine * v[2]);
        else if (name == "skewX" && v.size() == 1)
            step = matrix(1, 0, std::tan(radians), 1, 0, 0);
        else if (name == "skewY" && v.size() == 1)
            step = matrix(1, std::tan(radians), 0, 1, 0, 0);
        else
            return std::nullopt;
        out = product(out, step);
    }
    return out;
}

std::optional<ViewBox> view_box(std::string_view s) {
    const auto v = number_list(s);
    if (v.size() != 4 || !(v[2] > 0) || !(v[3] > 0)) return std::nullopt;
    return ViewBox{v[0], v[1], v[2], v[3]};
}

Affinity<2> fitted(const ViewBox& box, double width, double height, std::string_view aspect) {
    double sx = width / box.width, sy = height / box.height, x = 0, y = 0;
    if (stripped(aspect) != "none") {
        const bool slice = aspect.find("slice") != std::string_view::npos;
        sx = sy = slice ? std::max(sx, sy) : std::min(sx, sy);
        const auto placed = [&](std::string_view low, std::string_view high, double room) {
            return aspect.find(low) != std::string_view::npos    ? 0
                   : aspect.find(high) != std::string_view::npos ? room
                                                                 : room / 2;
        };
        x = placed("xMin", "xMax", width - sx * box.width);
        y = placed("YMin", "YMax", height - sy * box.height);
    }
    return {{{{sx, 0}, {0, sy}}}, {{x - sx * box.x, y - sy * box.y}}};
}

bool is_geometry(std::string_view property) {
    static constexpr std::string_view kGeometry[] = {"transform", "d",  "x", "y",     "cx",    "cy",
                                                     "rx",        "ry", "r", "width", "height"};
    return std::ranges::find(kGeometry, property) != std::end(kGeometry);
}

Declarations declarations(std::string_view s) {
    Declarations out;
    while (!s.empty()) {
        const std::string_view one = next_part(s, ';');
        const std::size_t colon = one.find(':');
        if (colon == std::string_view::npos) continue;
        std::string_view value = stripped(one.substr(colon + 1));
        if (const std::size_t mark = value.find('!'); mark != std::string_view::npos)
            value = stripped(value.substr(0, mark));
        out.emplace_back(stripped(one.substr(0, colon)), value);
    }
    return out;
}

void StyleSheet::add(std::string_view css) {
    std::string plain;
    for (std::size_t at = 0; at < css.size();) {  // without comments
        const std::size_t open = std::min(css.size(), css.find("/*", at));
        plain += css.substr(at, open - at);
        const std::size_t close = css.find("*/", std::min(css.size(), open + 2));
        at = close == std::string_view::npos ? css.size() : close + 2;
    }
    for (std::string_view rest = plain; !rest.empty();) {
        const std::size_t open = rest.find('{'), close = rest.find('}', std::min(open, rest.size()));
        if (open == std::string_view::npos || close == std::string_view::npos) return;
        const std::string_view inside = rest.substr(open + 1, close - open - 1);
        held_ += std::size_t(std::ranges::count(inside, ';'));
        if (is_full()) return;
        const Declarations all = declarations(inside);
        for (std::string_view selectors = rest.substr(0, open); !selectors.empty();) {
            std::string_view one = stripped(next_part(selectors, ','));
            const int kind = one == "*" ? 0 : one.starts_with('.') ? 2 : one.starts_with('#') ? 3 : 1;
            if (kind > 1) one.remove_prefix(1);
            if (one.empty() || (kind > 0 && one.find_first_of(" .#>+~[:*@") != std::string_view::npos)) {
                ++ignored_;
                continue;
            }
            held_ += 1 + all.size();
            if (is_full()) return;
            auto& to = rules_[kind][std::string(one)];
            to.insert(to.end(), all.begin(), all.end());
        }
        rest.remove_prefix(close + 1);
        rest = stripped(rest);
    }
}

template <class F>
void StyleSheet::each_rule(std::string_view element, std::string_view id, std::string_view classes,
                           F&& f) const {
    const auto take = [&](int kind, std::string_view name) {
        if (const auto it = rules_[kind].find(name); it != rules_[kind].end()) f(it->second);
    };
    take(0, "*");
    take(1, element);
    while (!(classes = stripped(classes)).empty()) {
        const std::size_t end = std::min(classes.size(), classes.find_first_of(kBlanks));
        take(2, classes.substr(0, end));
        classes.remove_prefix(end);
    }
    if (!id.empty()) take(3, id);
}

Declarations StyleSheet::of(std::string_view element, std::string_view id, std::string_view classes) const {
    Declarations out;
    each_rule(element, id, classes,
              [&](const Declarations& rule) { out.insert(out.end(), rule.begin(), rule.end()); });
    return out;
}

std::size_t StyleSheet::cost_of(std::string_view element, std::string_view id,
                                std::string_view classes) const {
    std::size_t cost = 0;
    each_rule(element, id, classes, [&](const Declarations& rule) { cost += 16 * rule.size(); });
    return cost;
}

bool Style::set(std::string_view property, std::string_view value, const Style& parent,
                const Metrics& metrics) {
    value = stripped(value);
    const auto inherit = [&](auto member) {
        if (value == "inherit") this->*member = parent.*member;
        return value == "inherit";
    };
    const auto one_of = [&](auto& to, const auto& names) {
        for (const auto& [name, meaning] : names)
            if (name == value) return to = meaning, true;
        return false;
    };
    constexpr std::size_t kLongestPaint = 1000;  // every shape has its own
    if ((property == "fill" || property == "stroke" || property == "color") && value.size() > kLongestPaint)
        return false;
    if (property == "fill") return inherit(&Style::fill) || (fill = value, !value.empty());
    if (property == "stroke") return inherit(&Style::stroke) || (stroke = value, !value.empty());
    if (property == "color") return inherit(&Style::colour) || (colour = value, !value.empty());
    if (property == "display") return shown = value != "none", true;
    if (property == "visibility") {
        visible = value == "inherit" ? parent.visible : value != "hidden" && value != "collapse";
        return true;
    }
    if (property == "fill-rule") {
        constexpr std::pair<std::string_view, FillRule> kRules[] = {{"nonzero", FillRule::nonzero},
                                                                    {"evenodd", FillRule::evenodd}};
        return inherit(&Style::fill_rule) || one_of(fill_rule, kRules);
    }
    if (property == "stroke-linecap") {
        constexpr std::pair<std::string_view, LineCap> kCaps[] = {
            {"butt", LineCap::butt}, {"round", LineCap::round}, {"square", LineCap::square}};
        if (value == "inherit") return line.cap = parent.line.cap, true;
        return one_of(line.cap, kCaps);
    }
    if (property == "stroke-linejoin") {
        constexpr std::pair<std::string_view, LineJoin> kJoins[] = {{"miter", LineJoin::miter},
                                                                    {"miter-clip", LineJoin::miter_clip},
                                                                    {"round", LineJoin::round},
                                                                    {"bevel", LineJoin::bevel},
                                                                    {"arcs", LineJoin::arcs}};
        if (value == "inherit") return line.join = parent.line.join, true;
        return one_of(line.join, kJoins);
    }
    const bool wide = property == "stroke-width", sharp = property == "stroke-miterlimit",
               offset = property == "stroke-dashoffset", large = property == "font-size";
    if (wide || sharp || offset || large) {
        double StrokeStyle::*const member = wide    ? &StrokeStyle::width
                                            : sharp ? &StrokeStyle::miter_limit
                                                    : &StrokeStyle::dash_offset;
        if (value == "inherit")
            return (large ? font = parent.font : line.*member = parent.line.*member), true;
        Metrics m = metrics;
        m.font = large ? parent.font : font;
        std::optional<double> x;
        if (large && value.ends_with('%')) {
            if (const auto part = scan_number<double>(value.substr(0, value.size() - 1)))
                x = *part / 100 * parent.font;
        } else if (sharp) {
            x = scan_number<double>(value);
        } else {
            x = length(value, m, Along::both);
        }
        if (!x || (!offset && *x < (sharp ? 1 : 0))) return false;
        return (large ? font = *x : line.*member = *x), true;
    }
    if (property == "stroke-dasharray") {
        if (value == "none") return line.dashes.clear(), true;
        if (value == "inherit") return line.dashes = parent.line.dashes, true;
        Metrics m = metrics;
        m.font = font;
        auto dashes = length_list(value, m, Along::both);
        if (!dashes || std::ranges::any_of(*dashes, [](double d) { return d < 0; })) return false;
        if (std::ranges::all_of(*dashes, [](double d) { return d == 0; })) dashes->clear();
        if (dashes->size() % 2) {
            const auto once = *dashes;
            dashes->insert(dashes->end(), once.begin(), once.end());
        }
        line.dashes = std::move(*dashes);
        return true;
    }
    return true;  // says nothing about geometry
}

}  // namespace freiform::svg
