// The elements of SVG that have an outline, as paths.
#include "svg_detail.hpp"

#include <freiform/core/text.hpp>
#include <freiform/path/path_data.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::svg {

namespace {

Path path_of(Subpath s) {
    Path out;
    out.subpaths.push_back(std::move(s));
    return out;
}

// Its corners rounded by quarters of ellipses; none if a side is not positive.
Path rectangle(const Vec<2>& at, const Vec<2>& size, std::optional<double> rx, std::optional<double> ry) {
    if (!(size[0] > 0) || !(size[1] > 0)) return {};
    if (rx && *rx < 0) rx.reset();
    if (ry && *ry < 0) ry.reset();
    double a = std::min(rx.value_or(ry.value_or(0)), size[0] / 2),
           b = std::min(ry.value_or(rx.value_or(0)), size[1] / 2);
    if (!(a > 0) || !(b > 0)) a = b = 0;
    const Vec<2> end = at + size;
    Subpath s{{{at[0] + a, at[1]}}, {}, true};
    Vec<2> last = s.start;
    const auto line_to = [&](const Vec<2>& p) {
        if (!(p == last)) s.segments.push_back({1, {last, p}, 1});
        last = p;
    };
    const auto corner = [&](const Vec<2>& middle, const Vec<2>& to) {
        if (a > 0) s.segments.push_back({2, {last, middle, to}, std::sqrt(0.5)});
        last = to;
    };
    line_to({{end[0] - a, at[1]}}), corner({{end[0], at[1]}}, {{end[0], at[1] + b}});
    line_to({{end[0], end[1] - b}}), corner(end, {{end[0] - a, end[1]}});
    line_to({{at[0] + a, end[1]}}), corner({{at[0], end[1]}}, {{at[0], end[1] - b}});
    line_to({{at[0], at[1] + b}}), corner(at, s.start);
    line_to(s.start);
    return path_of(std::move(s));
}

// Lines through pairs of numbers, an odd last one apart.
Path polygon(const std::vector<double>& v, bool closed) {
    if (v.size() < 4) return {};
    Subpath s{{{v[0], v[1]}}, {}, closed};
    s.segments.reserve(v.size() / 2);
    for (std::size_t i = 2; i + 1 < v.size(); i += 2)
        s.segments.push_back({1, {Vec<2>{{v[i - 2], v[i - 1]}}, Vec<2>{{v[i], v[i + 1]}}}, 1});
    const Vec<2> last = s.segments.back().back();
    if (closed && !(last == s.start)) s.segments.push_back({1, {last, s.start}, 1});
    return path_of(std::move(s));
}

}  // namespace

bool is_silent(std::string_view element) {
    static constexpr std::string_view kSilent =
        " defs symbol clipPath mask marker pattern linearGradient radialGradient meshgradient hatch filter "
        "title "
        "desc style script metadata view cursor animate animateTransform animateMotion set solidColor "
        "color-profile font font-face glyph ";
    return element.empty() || kSilent.find(text(" ", element, " ")) != kSilent.npos;
}

std::optional<Path> outline(std::string_view element,
                            const std::function<std::string_view(const char*)>& attribute,
                            const Metrics& metrics,
                            const std::function<void(RefusalKind, std::string)>& report,
                            std::size_t most_segments) {
    const auto given = [&](const char* name, Along along) -> std::optional<double> {
        const std::string_view s = attribute(name);
        if (s.empty() || s == "auto") return std::nullopt;
        const auto x = length(s, metrics, along);
        if (!x) report(RefusalKind::invalid, text(name, ": \"", s.substr(0, 40), "\" is no length"));
        return x;
    };
    const auto x = [&](const char* name) { return given(name, Along::x).value_or(0); };
    const auto y = [&](const char* name) { return given(name, Along::y).value_or(0); };
    if (element == "path") {
        PathData data = parse_path_data_up_to(attribute("d"), most_segments);
        if (data.stopped && data.stopped->kind == RefusalKind::limit) {
            report(RefusalKind::limit, data.stopped->message);
            return std::nullopt;
        }
        if (data.stopped)
            report(RefusalKind::unreadable, text("d, ", data.stopped->where, ": ", data.stopped->message,
                                                 "; what comes before is shown"));
        return std::move(data.path);
    }
    if (element == "rect")
        return rectangle({{x("x"), y("y")}}, {{x("width"), y("height")}}, given("rx", Along::x),
                         given("ry", Along::y));
    if (element == "circle" || element == "ellipse") {
        const bool round = element == "circle";
        auto rx = given(round ? "r" : "rx", round ? Along::both : Along::x),
             ry = round ? rx : given("ry", Along::y);
        if (!rx || *rx < 0) rx = ry;
        if (!ry || *ry < 0) ry = rx;
        if (!(rx.value_or(0) > 0) || !(ry.value_or(0) > 0)) return Path();
        return path_of(ellipse({{x("cx"), y("cy")}}, *rx, *ry));
    }
    if (element == "line") {
        const Vec<2> a{{x("x1"), y("y1")}}, b{{x("x2"), y("y2")}};
        return path_of({a, {{1, {a, b}, 1}}, false});
    }
    if (element == "polyline" || element == "polygon")
        return polygon(number_list(attribute("points")), element == "polygon");
    report(RefusalKind::unsupported, "is no element that has a meaning here");
    return std::nullopt;
}

}  // namespace freiform::svg
