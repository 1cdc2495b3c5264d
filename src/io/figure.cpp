// Method: the page is divided into a title, rows of cells, and a legend; each cell into a caption, room for
// ticks and the area of the panel. The box of what a panel shows is fitted into its area. Words come last,
// when all that they could cover is in its place.
#include "io/figure_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

Box<2> box_of(std::span<const DrawnGroup> groups, double by) {
    // A curve leaves the box of its points at k / 16 by at most
    // max |second difference of the coefficients| degree (degree - 1) / (8 16^2).
    constexpr int kParts = 16;
    Box<2> box;
    const auto add = [&](const Vec<2>& p, double more) {
        box.add(p - Vec<2>{{more, more}});
        box.add(p + Vec<2>{{more, more}});
    };
    for (const DrawnGroup& g : groups) {
        for (const DrawnPath& path : g.paths) {
            Vec<2> from = path.start;
            add(from, 0);
            for (const DrawnSegment& s : path.segments) {
                const Vec<2>& end = end_of(s);
                if (s.degree == 1) {
                    add(end, by);
                } else {
                    double bend = norm(from - 2 * s.points[0] + s.points[1]);
                    if (s.degree == 3) bend = std::max(bend, norm(s.points[0] - 2 * s.points[1] + end));
                    const double more = bend * s.degree * (s.degree - 1) / (8.0 * kParts * kParts);
                    for (int k = 1; k <= kParts; ++k) add(point_at(from, s, double(k) / kParts), more);
                }
                from = end;
            }
        }
        for (const DrawnDisc& d : g.discs) add(d.centre, 0);
    }
    return box;
}

DrawnPath line_through(std::span<const Vec<2>> points, bool closed) {
    DrawnPath path{points.empty() ? Vec<2>{} : points[0], {}, closed};
    for (std::size_t i = 1; i < points.size(); ++i) path.segments.push_back({1, {points[i]}});
    return path;
}

DrawnPath bezier_path(std::span<const Vec<2>> points) {
    FF_REQUIRE(points.size() >= 2 && points.size() <= 4);
    DrawnPath path{points[0], {{int(points.size()) - 1, {}}}};
    for (std::size_t i = 1; i < points.size(); ++i) path.segments[0].points[i - 1] = points[i];
    return path;
}

DrawnPath sampled_path(const std::function<Vec<2>(double)>& f, const Interval& on, int n) {
    DrawnPath path{f(on.lo), {}};
    for (int i = 1; i <= n; ++i)
        path.segments.push_back({1, {f(i == n ? on.hi : on.lo + on.length() * i / n)}});
    return path;
}

DrawnGroup dots(std::string role, const Colour& colour, std::span<const Vec<2>> at, double radius) {
    DrawnGroup g{"", std::move(role), colour, 1, {}, {}, {}};
    for (const Vec<2>& p : at) g.discs.push_back({p, radius, false});
    return g;
}

namespace figure {
namespace {

constexpr double kTitleRoom = 44, kCaptionRoom = 32, kBetween = 26, kLegendRow = 26, kPointRoom = 6;
constexpr double kNoteRoom = 32, kLegendSample = 30;

struct LegendEntry {
    const DrawnGroup* group;
    double width;  // pixels, sample included
};

// Rows of entries that fit the page.
std::vector<std::vector<LegendEntry>> legend_rows(const Figure& f, double room) {
    std::vector<std::vector<LegendEntry>> rows;
    std::vector<std::string> said;
    double used = 0;
    if (!f.legend) return rows;
    for (const Panel& panel : f.panels)
        for (const DrawnGroup& g : panel.groups) {
            if (g.legend.empty()) continue;
            std::string key;
            for (const DrawnRun& run : g.legend) key += text(run.level, run.text);
            if (std::ranges::find(said, key) != said.end()) continue;
            said.push_back(key);
            const double width = kLegendSample + 8 + width_of(g.legend, kSmallText) + 24;
            if (rows.empty() || used + width > room) rows.emplace_back(), used = 0;
            rows.back().push_back({&g, width});
            used += width;
        }
    return rows;
}

void draw_legend(const std::vector<std::vector<LegendEntry>>& rows, const Box<2>& area, Drawing& d) {
    double y = area.lo[1] + kLegendRow / 2;
    for (const auto& row : rows) {
        double x = 0;
        for (const LegendEntry& e : row) x += e.width;
        x = area.side(0).middle() - x / 2 + 12;
        for (const LegendEntry& e : row) {
            DrawnGroup g = *e.group;
            const bool line = !g.paths.empty() && g.width > 0;
            const bool disc = !g.discs.empty(), hollow = disc && g.discs[0].hollow;
            const double radius = disc ? std::min(g.discs[0].radius, 5.0) : 0;
            g.paths.clear(), g.discs.clear(), g.labels.clear();
            g.name = "", g.role = "legend", g.layer = "legend", g.fill = 0;
            if (line)
                g.paths.push_back(line_through(std::array{Vec<2>{{x, y}}, Vec<2>{{x + kLegendSample, y}}}));
            if (disc) g.discs.push_back({{{x + kLegendSample / 2, y}}, radius, hollow});
            d.groups.push_back(g);
            DrawnGroup words{"", "legend", kInk, 1, {}, {}, {}};
            words.layer = "legend";
            words.labels.push_back(
                {{{x + kLegendSample + 8, y + 0.32 * kSmallText}}, e.group->legend, kSmallText});
            d.groups.push_back(std::move(words));
            x += e.width;
        }
        y += kLegendRow;
    }
}

DrawnGroup words(std::string role, DrawnText text, const Vec<2>& at, double size, bool bold) {
    DrawnGroup g{"", std::move(role), kInk, 1, {}, {}, {}};
    g.labels.push_back({at, std::move(text), size, Anchor::middle, bold});
    return g;
}

Placed placed(const Panel& panel, Box<2> area) {
    if (panel.axes != Axes::none) {
        area.lo[0] += kTickRoom, area.hi[1] -= kTickRoomBelow;
        area.lo[1] += panel.y_name.empty() ? 8 : 26;
        area.hi[0] -= 8;
    }
    const double room = panel.notes.empty() ? 0 : kNoteRoom;
    Box<2> box = box_of(panel.groups);
    for (const Note& n : panel.notes) box.add(n.at);
    if (panel.window) box.add(*panel.window);
    if (box.is_empty()) box.add(Vec<2>{});
    bool has_discs = false;
    for (const DrawnGroup& g : panel.groups) has_discs = has_discs || !g.discs.empty();
    const double rim = room > 0 ? room : has_discs || panel.axes != Axes::none ? kPointRoom : 0;
    Placed p;
    p.area = area;
    for (int i = 0; i < 2; ++i) {
        const double length = box.side(i).length();
        const double pixels = std::max(1.0, area.side(i).length() - 2 * rim);
        p.scale[i] = length > 0 ? std::min(panel.largest, pixels / length) : panel.largest;
    }
    const bool flat_x = box.side(0).length() == 0, flat_y = box.side(1).length() == 0;
    if (flat_x && flat_y) p.scale = {{std::min(1.0, panel.largest), std::min(1.0, panel.largest)}};
    if (panel.equal) {
        const double s = flat_x ? p.scale[1] : flat_y ? p.scale[0] : std::min(p.scale[0], p.scale[1]);
        p.scale = {{s, s}};
    }
    p.origin = {{area.side(0).middle() - p.scale[0] * box.side(0).middle(),
                 area.side(1).middle() + p.scale[1] * box.side(1).middle()}};
    for (int i = 0; i < 2; ++i) {
        const double half =
            (panel.equal ? box.side(i).length() / 2 * p.scale[i] + rim : area.side(i).length() / 2) /
            p.scale[i];
        p.shown.lo[i] = box.side(i).middle() - half;
        p.shown.hi[i] = box.side(i).middle() + half;
    }
    return p;
}

// As large as fits, between two limits.
double caption_size(const DrawnText& caption, const Box<2>& area) {
    return std::clamp(16 * (area.side(0).length() + kBetween / 2) / width_of(caption, 16), 9.0, 16.0);
}

// A triangle at the end of the path, and the line shorter by most of it.
std::optional<DrawnPath> head_of(DrawnPath& path, double width) {
    if (path.segments.empty()) return std::nullopt;
    DrawnSegment& s = path.segments.back();
    const Vec<2> tip = end_of(s);
    const Vec<2> from = s.degree > 1                ? s.points[std::size_t(s.degree - 2)]
                        : path.segments.size() == 1 ? path.start
                                                    : end_of(path.segments[path.segments.size() - 2]);
    const Vec<2> along = unit(tip - from), across{{-along[1], along[0]}};
    if (max_abs(along) == 0) return std::nullopt;
    const double length = 5 + 3 * width;
    const Vec<2> back = tip - length * along;
    if (s.degree == 1 && norm(tip - from) > length) s.points[0] = tip - 0.7 * length * along;
    DrawnPath head = line_through(std::array{tip, back + 0.36 * length * across, tip - 0.75 * length * along,
                                             back - 0.36 * length * across},
                                  true);
    head.solid = true;
    return head;
}

void place_groups(const Panel& panel, const Placed& placed, Drawing& d) {
    for (DrawnGroup g : panel.groups) {
        g.layer = panel.name;
        for (DrawnPath& path : g.paths) {
            path.start = placed(path.start);
            for (DrawnSegment& s : path.segments)
                for (Vec<2>& p : s.points) p = placed(p);
        }
        for (DrawnDisc& disc : g.discs) disc.centre = placed(disc.centre);
        for (DrawnLabel& label : g.labels) label.at = placed(label.at);
        if (g.arrows) {
            std::vector<DrawnPath> heads;
            for (DrawnPath& path : g.paths)
                if (auto head = head_of(path, g.width)) heads.push_back(std::move(*head));
            g.paths.insert(g.paths.end(), heads.begin(), heads.end());
        }
        d.groups.push_back(std::move(g));
    }
}

std::string letters_of(const DrawnText& text) {
    std::string s;
    for (const DrawnRun& run : text) s += run.text;
    return s;
}

// Groups of one layer one after the other, in the order of the first of each.
void gather_layers(std::vector<DrawnGroup>& groups) {
    std::vector<std::string> order;
    for (const DrawnGroup& g : groups)
        if (std::ranges::find(order, g.layer) == order.end()) order.push_back(g.layer);
    std::vector<DrawnGroup> gathered;
    for (const std::string& layer : order)
        for (DrawnGroup& g : groups) {
            if (g.layer != layer) continue;
            gathered.push_back(std::move(g));
            g.layer = layer;  // which was moved away too, and must not be met again as ""
        }
    groups = std::move(gathered);
}

// The cells of the panels, row by row.
std::vector<Box<2>> cells_of(const Figure& f, const Box<2>& page) {
    std::vector<Box<2>> cells;
    const std::size_t n = f.panels.size();
    const std::size_t columns = f.columns > 0 ? std::size_t(f.columns) : std::max<std::size_t>(n, 1);
    const std::size_t rows = (n + columns - 1) / columns;
    const double high = (page.side(1).length() - kBetween * double(rows - 1)) / double(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t first = row * columns, last = std::min(n, first + columns);
        double shares = 0;
        for (std::size_t i = first; i < last; ++i) shares += f.panels[i].share;
        const double wide = page.side(0).length() - kBetween * double(last - first - 1);
        Vec<2> corner{{page.lo[0], page.lo[1] + double(row) * (high + kBetween)}};
        for (std::size_t i = first; i < last; ++i) {
            const double part = wide * f.panels[i].share / shares;
            Box<2> cell;
            cell.add(corner);
            cell.add(corner + Vec<2>{{part, high}});
            cells.push_back(cell);
            corner[0] += part + kBetween;
        }
    }
    return cells;
}

}  // namespace
}  // namespace figure

Drawing arrange(const Figure& f) {
    using namespace figure;
    Drawing d;
    d.width = f.width, d.height = f.height;
    const double margin = f.margin * std::min(f.width, f.height);
    Box<2> page;
    page.add(Vec<2>{{margin, margin}});
    page.add(Vec<2>{{f.width - margin, f.height - margin}});
    d.title = letters_of(f.title);
    if (!f.title.empty()) {
        DrawnGroup title = words("title", f.title, {{f.width / 2.0, page.lo[1] + 18}}, 21, true);
        d.groups.push_back(std::move(title));
        page.lo[1] += kTitleRoom;
    }
    const auto legend = legend_rows(f, page.side(0).length());
    const double legend_height = legend.empty() ? 0 : kLegendRow * double(legend.size()) + 6;
    page.hi[1] -= legend_height;
    if (f.panels.empty()) return d;
    const std::vector<Box<2>> cells = cells_of(f, page);
    std::vector<PlacedNote> notes;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        Box<2> area = cells[i];
        const Panel& panel = f.panels[i];
        if (!panel.caption.empty()) {
            DrawnGroup caption = words("caption", panel.caption, {{area.side(0).middle(), area.lo[1] + 16}},
                                       caption_size(panel.caption, area), false);
            caption.layer = panel.name;
            d.groups.push_back(std::move(caption));
            area.lo[1] += kCaptionRoom;
        }
        const Placed at = placed(panel, area);
        for (DrawnGroup& g : axes_of(panel, at)) d.groups.push_back(std::move(g));
        place_groups(panel, at, d);
        for (const Note& n : panel.notes) {
            notes.push_back({n, area, panel.name});
            notes.back().note.at = at(n.at);
        }
        if (i == 0) {
            d.scale = std::scalbn(at.scale[0], -panel.exponent);
            d.origin = at.origin;
        }
    }
    for (DrawnGroup& g : labels_of(notes, d.groups, f.width, f.height)) d.groups.push_back(std::move(g));
    page.lo[1] = page.hi[1] + 6;
    page.hi[1] += legend_height;
    draw_legend(legend, page, d);
    gather_layers(d.groups);
    return d;
}

}  // namespace freiform
