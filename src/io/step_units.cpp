// Units and colours.
#include "step_structure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::step {

namespace {

struct NamedUnit {
    std::string_view word, ours;
    double millimetres;
};
constexpr NamedUnit kLengths[] = {
    {"METRE", "m", 1e3},      {"METER", "m", 1e3},      {"MILLIMETRE", "mm", 1}, {"MILLIMETER", "mm", 1},
    {"CENTIMETRE", "cm", 10}, {"CENTIMETER", "cm", 10}, {"INCH", "inch", 25.4},  {"IN", "inch", 25.4},
    {"INCHES", "inch", 25.4}, {"FOOT", "ft", 304.8},    {"FEET", "ft", 304.8},   {"FT", "ft", 304.8},
    {"YARD", "yd", 914.4},    {"MILE", "mi", 1609344},  {"MI", "mi", 1609344},   {"MIL", "mil", 0.0254},
};

double prefix_of(std::string_view p) {
    constexpr std::pair<std::string_view, double> kPrefixes[] = {
        {"EXA", 1e18},  {"PETA", 1e15},  {"TERA", 1e12},   {"GIGA", 1e9},   {"MEGA", 1e6},   {"KILO", 1e3},
        {"HECTO", 1e2}, {"DECA", 10},    {"DECI", 0.1},    {"CENTI", 0.01}, {"MILLI", 1e-3}, {"MICRO", 1e-6},
        {"NANO", 1e-9}, {"PICO", 1e-12}, {"FEMTO", 1e-15}, {"ATTO", 1e-18}};
    for (const auto& [word, size] : kPrefixes)
        if (word == p) return size;
    return 1;
}

std::string si_word(double metres) {
    constexpr std::pair<double, std::string_view> kWords[] = {
        {1, "m"}, {1e-3, "mm"}, {1e-2, "cm"}, {0.1, "dm"}, {1e3, "km"}, {1e-6, "um"}, {1e-9, "nm"}};
    for (const auto& [size, word] : kWords)
        if (std::abs(metres - size) <= 1e-12 * size) return std::string(word);
    return text(metres, " m");
}

struct UnitSize {
    double size = 1;  // metres, or radians
    std::string word;
};

// Through units that are based on others, up to a few.
std::optional<UnitSize> unit_size(const File& f, std::uint32_t i, bool length) {
    UnitSize out;
    double factor = 1;
    for (int depth = 0; depth < 10; ++depth) {
        if (const std::uint32_t si = f.part(i, Type::SI_UNIT); si != kMissing) {
            const Fields g(f, i, si);
            int k = 0;
            while (k + 2 < g.size()) ++k;  // a simple instance has its dimensions in front
            const double size = prefix_of(g.enumeration(k));
            out.size = factor * size;
            if (out.word.empty()) out.word = length ? si_word(out.size) : "rad";
            return out;
        }
        const std::uint32_t based = f.part(i, Type::CONVERSION_BASED_UNIT);
        if (based == kMissing) return std::nullopt;
        const Fields g(f, i, based);
        if (out.word.empty() && length) {
            std::string upper;
            for (const char c : g.string(g.size() - 2))
                if (c != '\'' && c != ' ' && c != '.') upper += char(c >= 'a' && c <= 'z' ? c - 32 : c);
            for (const NamedUnit& u : kLengths)
                if (u.word == upper) out.word = u.ours;
        }
        const auto measure = g.reference(g.size() - 1, "conversion factor");
        if (!measure) return std::nullopt;
        // (value, unit), in an instance of any of several types
        const Instance& x = f.instances[*measure];
        std::optional<double> value;
        std::uint32_t unit = kMissing;
        for (std::uint32_t k = x.first; k < x.first + x.tokens; ++k) {
            if (f.tokens[k].kind == TokenKind::list && !value) {
                const Fields m(f, *measure, k);
                if (const auto v = m.number(0, "value")) value = *v;
            }
            if (f.tokens[k].kind == TokenKind::reference && unit == kMissing) unit = f.tokens[k].at;
        }
        if (!value || !(*value > 0) || unit == kMissing) return std::nullopt;
        factor *= *value;
        i = unit;
    }
    return std::nullopt;
}

}  // namespace

Context context_of(const File& f, std::uint32_t context) {
    Context out;
    if (const std::uint32_t list = f.part(context, Type::GLOBAL_UNIT_ASSIGNED_CONTEXT); list != kMissing) {
        const Fields g(f, context, list);
        if (const auto units = g.references(g.size() - 1, "units"))
            for (const std::uint32_t u : *units) {
                if (f.is(u, Type::LENGTH_UNIT)) {
                    if (auto size = unit_size(f, u, true)) {
                        out.length = size->size * 1e3;
                        for (const NamedUnit& n : kLengths)
                            if (n.ours == size->word) out.length = n.millimetres;
                        if (size->word.empty()) size->word = text(out.length, " mm");
                        out.unit = size->word;
                    }
                } else if (f.is(u, Type::PLANE_ANGLE_UNIT)) {
                    if (const auto size = unit_size(f, u, false)) out.angle = size->size;
                }
            }
        // Degrees are written with more or fewer digits.
        if (std::abs(out.angle - std::numbers::pi / 180) < 1e-6) out.angle = std::numbers::pi / 180;
    }
    out.tolerance = 1e-7 / out.length;
    if (const std::uint32_t list = f.part(context, Type::GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT);
        list != kMissing) {
        const Fields g(f, context, list);
        if (const auto all = g.references(g.size() - 1, "uncertainty"))
            for (const std::uint32_t u : *all) {
                const Fields m(f, u, f.instances[u].first + 1);
                const auto x = m.number(0, "uncertainty");
                if (x && *x > 0 && *x < 1e3) {
                    out.tolerance = *x;
                    break;
                }
            }
    }
    return out;
}

double largest_uncertainty(const File& f) {
    const GeometryReader geometry(f);
    Box<3> box;
    for (std::uint32_t i = 0; i < f.instances.size(); ++i) {
        if (f.type(i) != Type::VERTEX_POINT) continue;
        const auto at = Fields(f, i, f.instances[i].first + 1).reference(1, "point");
        if (!at) continue;
        if (const auto p = geometry.point(*at); p && max_abs(*p) < 1e100) box.add(*p);
    }
    return box.diagonal() > 0 ? 1e-5 * box.diagonal() : 1e300;
}

namespace {

std::optional<Colour> named_colour(std::string_view name) {
    constexpr std::pair<std::string_view, Colour> kNames[] = {
        {"red", {1, 0, 0, 1}},     {"green", {0, 1, 0, 1}}, {"blue", {0, 0, 1, 1}},  {"yellow", {1, 1, 0, 1}},
        {"magenta", {1, 0, 1, 1}}, {"cyan", {0, 1, 1, 1}},  {"black", {0, 0, 0, 1}}, {"white", {1, 1, 1, 1}}};
    for (const auto& [word, colour] : kNames)
        if (word == name) return colour;
    return std::nullopt;
}

// The colour of a style: the first one on the way down through styles of surfaces, or through those of
// curves. Points have colours of their own, which are passed over.
std::optional<Colour> colour_of_style(const File& f, std::uint32_t style, bool of_curves) {
    std::vector<std::uint32_t> todo{style};
    for (int steps = 0; !todo.empty() && steps < 64; ++steps) {
        const std::uint32_t i = todo.back();
        todo.pop_back();
        const Fields g(f, i, f.instances[i].first + 1);
        if (f.is(i, Type::COLOUR_RGB)) {
            Colour c;
            double* to[] = {&c.r, &c.g, &c.b};
            for (int k = 0; k < 3; ++k) {
                const auto x = g.number(g.size() - 3 + k, "colour");
                if (!x) return std::nullopt;
                *to[k] = std::clamp(*x, 0.0, 1.0);
            }
            return c;
        }
        if (f.is(i, Type::DRAUGHTING_PRE_DEFINED_COLOUR)) return named_colour(g.string(0));
        const std::string_view name = f.text_of(f.tokens[f.instances[i].first]);
        const auto is_any = [&](std::initializer_list<std::string_view> kinds) {
            return std::ranges::any_of(kinds, [&](std::string_view kind) { return name.starts_with(kind); });
        };
        if (name.starts_with("POINT_STYLE") ||
            (of_curves ? is_any({"SURFACE_", "FILL_AREA_"})
                       : is_any({"CURVE_STYLE", "SURFACE_STYLE_BOUNDARY", "SURFACE_STYLE_PARAMETER"})))
            continue;
        const Instance& x = f.instances[i];
        std::vector<std::uint32_t> next;
        for (std::uint32_t k = x.first; k < x.first + x.tokens; ++k)
            if (f.tokens[k].kind == TokenKind::reference && f.tokens[k].at != kMissing)
                next.push_back(f.tokens[k].at);
        todo.insert(todo.end(), next.rbegin(), next.rend());
    }
    return std::nullopt;
}

}  // namespace

Styles styles_of(const File& f) {
    Styles out;
    for (const bool overriding : {false, true})
        for (std::uint32_t i = 0; i < f.instances.size(); ++i) {
            const Type t = overriding ? Type::OVER_RIDING_STYLED_ITEM : Type::STYLED_ITEM;
            if (f.type(i) != t) continue;
            const Fields g(f, i, f.part(i, t));
            const auto styles = g.references(1, "styles");
            const auto item = g.reference(2, "item");
            if (!styles || !item) continue;
            for (const bool of_curves : {false, true}) {
                auto& colours = of_curves ? out.curve_colours : out.colours;
                for (const std::uint32_t s : *styles)
                    if (const auto c = colour_of_style(f, s, of_curves)) {
                        overriding ? void(colours[*item] = *c) : void(colours.emplace(*item, *c));
                        break;
                    }
            }
        }
    return out;
}

}  // namespace freiform::step
