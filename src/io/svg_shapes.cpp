// The basic shapes of SVG as paths.
#include "svg_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::svg {

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
    return {{std::move(s)}};
}

Path polygon(const std::vector<double>& v, bool closed) {
    if (v.size() < 4) return {};
    Subpath s{{{v[0], v[1]}}, {}, closed};
    for (std::size_t i = 2; i + 1 < v.size(); i += 2)
        s.segments.push_back({1, {Vec<2>{{v[i - 2], v[i - 1]}}, Vec<2>{{v[i], v[i + 1]}}}, 1});
    const Vec<2> last = s.segments.back().back();
    if (closed && !(last == s.start)) s.segments.push_back({1, {last, s.start}, 1});
    return {{std::move(s)}};
}

}  // namespace freiform::svg
