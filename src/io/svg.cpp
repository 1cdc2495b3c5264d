// Reading SVG.
//
// Idea. The elements are walked from the root; a transform and a style are handed down, shapes become paths,
// and each path is mapped to the coordinates of the outermost view box with y turned up. An element that is
// used is walked again at its place. What cannot be shown is named with its line, the rest is delivered.
//
// Limits. The tree takes some 72 bytes for an element and 48 for an attribute: their number is bounded by
// counting '<' and '=' first, and lines, whose ends are kept. `use` multiplies: nesting ends at kMostNested,
// and an element that is inside itself is not walked again. Small causes may be shown, copied and looked at
// again without end, so three things are counted: elements that are shown; the memory of the picture, with
// the texts that every shape has of its own; and the characters of attributes and declarations that are
// looked at, of which a file may cause ten times as many as it has and kMostAgain more. A path is not read
// beyond what the picture may still take. Entities and document types are not looked at.
#include "svg_detail.hpp"

#include <freiform/core/scan.hpp>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <unordered_map>

namespace freiform {

namespace {

using namespace svg;

constexpr std::size_t kMostMemory = std::size_t(96) << 20, kMostPicture = std::size_t(80) << 20,
                      kMostShown = 1000000, kMostLeftOut = 1000, kMostAgain = std::size_t(8) << 20;
constexpr std::size_t kLongestName = 60;  // of what messages quote
constexpr std::size_t kMostDeclarations = 10000;
constexpr int kMostNested = 200;

std::string_view local_name(std::string_view name) {
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos) return name;
    return name.substr(0, colon) == "svg" ? name.substr(colon + 1) : std::string_view();
}

// What is shown of it may be less than its outline.
constexpr const char* kCuts[] = {"clip-path", "mask"};

// Lengths grow by this under the map.
double growth(const Affinity<2>& m) {
    return std::sqrt(std::abs(m.linear[0][0] * m.linear[1][1] - m.linear[0][1] * m.linear[1][0]));
}

struct SvgState {
    Affinity<2> map;
    Style style;
    Metrics metrics;
    int nested = 0;
};

class SvgReader {
public:
    SvgReader(const pugi::xml_document& xml, std::string_view bytes)
        : xml_(xml), may_look_at_(10 * bytes.size() + kMostAgain) {
        for (std::size_t i = 0; i < bytes.size(); ++i)
            if (bytes[i] == '\n') lines_.push_back(i);
    }

    Result<SvgPicture> read() {
        const pugi::xml_node root = xml_.document_element();
        if (local_name(root.name()) != "svg")
            return refuse(RefusalKind::unreadable, place(root),
                          text("<svg> was expected, not <", root.name(), ">"));
        collect(root);
        if (sheet_.is_full())
            return refuse(RefusalKind::limit, place(root),
                          text("its style sheets say more than ", StyleSheet::kMost, " things"));
        if (sheet_.ignored() > 0)
            leave_out(RefusalKind::unsupported, root,
                      text(sheet_.ignored(),
                           " rules of style sheets with selectors of more than a type, class or id"));
        SvgState state{{{{{1, 0}, {0, -1}}}, {}}, {}, {}, 0};
        outermost(root, state);
        if (unnamed_ > 0)
            out_.left_out.push_back(
                {RefusalKind::limit, "", text("and ", unnamed_, " more that are not named one by one")});
        return stopped_ ? Result<SvgPicture>(std::unexpected(*stopped_)) : std::move(out_);
    }

private:
    std::string place(pugi::xml_node node) const {
        const auto at =
            std::ranges::lower_bound(lines_, std::size_t(std::max<std::ptrdiff_t>(0, node.offset_debug())));
        const std::string_view id = std::string_view(node.attribute("id").value()).substr(0, kLongestName);
        return text("line ", at - lines_.begin() + 1, ": <",
                    std::string_view(node.name()).substr(0, kLongestName), id.empty() ? "" : " id=\"", id,
                    id.empty() ? ">" : "\">");
    }
    // Counts what is looked at; false where it is too much.
    bool look_at(std::size_t characters, pugi::xml_node node) {
        looked_at_ += characters;
        if (looked_at_ > may_look_at_ && !stopped_)
            stopped_ =
                Refusal{RefusalKind::limit, place(node), "what is used again and again would take too long"};
        return !stopped_;
    }
    void leave_out(RefusalKind kind, pugi::xml_node node, std::string why) {
        if (out_.left_out.size() < kMostLeftOut)
            out_.left_out.push_back({kind, place(node), std::move(why)});
        else
            ++unnamed_;
    }

    void collect(pugi::xml_node root) {
        for (pugi::xml_node n = root; n;) {
            if (n.type() == pugi::node_element) {
                if (const std::string_view id = n.attribute("id").value(); !id.empty()) ids_.emplace(id, n);
                if (local_name(n.name()) == "style")
                    for (const pugi::xml_node& part : n.children()) sheet_.add(part.value());
            }
            if (n.first_child()) {
                n = n.first_child();
                continue;
            }
            while (n && n != root && !n.next_sibling()) n = n.parent();
            if (!n || n == root) break;
            n = n.next_sibling();
        }
    }

    void outermost(pugi::xml_node root, SvgState state) {
        const auto box = view_box(root.attribute("viewBox").value());
        Metrics px;
        px.width = px.outer_width = box ? box->width : 100,
        px.height = px.outer_height = box ? box->height : 100;
        const auto size = [&](const char* name, Along along) {
            const std::string_view value = root.attribute(name).value();
            return value.empty() ? std::nullopt : length(value, px, along);
        };
        const auto width = size("width", Along::x), height = size("height", Along::y);
        Metrics& m = state.metrics;
        if (box) {
            m.width = box->width, m.height = box->height;
            out_.view = {{{box->x, -box->y - box->height}}, {{box->x + box->width, -box->y}}};
        } else if (width && height && *width > 0 && *height > 0) {
            m.width = *width, m.height = *height;
            out_.view = {{{0, -*height}}, {{*width, 0}}};
        }
        m.outer_width = m.width, m.outer_height = m.height;
        const std::pair<const char*, double> units[] = {{"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"inch", 96}};
        for (const auto& [name, pixels] : units)
            if (box && width && std::abs(*width / box->width / pixels - 1) < 1e-4) out_.unit = name;
        if (!styled(root, state) || !moved(root, state)) return;
        m.root_font = state.style.font;
        children(root, state);
    }

    // The style of the element in the state; false where it is not shown.
    bool styled(pugi::xml_node node, SvgState& state) {
        const Style parent = state.style;
        Style& style = state.style;
        style.shown = true;
        const auto set = [&](std::string_view property, std::string_view value) {
            if (!style.set(property, value, parent, state.metrics))
                leave_out(RefusalKind::invalid, node,
                          text(property, ": \"", value.substr(0, 40), "\" has no meaning and is ignored"));
        };
        std::size_t characters = 64 + sheet_.cost_of(local_name(node.name()), node.attribute("id").value(),
                                                     node.attribute("class").value());
        for (const pugi::xml_attribute& a : node.attributes())
            characters += 16 + std::string_view(a.value()).size();
        const std::string_view given = node.attribute("style").value();
        characters += 7 * given.size();  // every declaration takes memory
        if (!look_at(characters, node)) return false;
        if (std::size_t(std::ranges::count(given, ';')) > kMostDeclarations) {
            leave_out(RefusalKind::limit, node,
                      text("its style says more than ", kMostDeclarations, " things"));
            return style.shown = false;
        }
        // Lengths in em want the size first.
        const Declarations css = sheet_.of(local_name(node.name()), node.attribute("id").value(),
                                           node.attribute("class").value()),
                           own = declarations(given);
        for (const bool size : {true, false}) {
            const auto wanted = [&](std::string_view property) { return (property == "font-size") == size; };
            for (const pugi::xml_attribute& a : node.attributes())
                if (wanted(a.name())) set(a.name(), a.value());
            for (const Declarations* list : {&css, &own})
                for (const auto& [property, value] : *list) {
                    if (wanted(property)) set(property, value);
                    if (size || !is_geometry(property)) continue;
                    leave_out(RefusalKind::unsupported, node,
                              text("its style sets ", property, ", which is read as an attribute only"));
                    style.shown = false;
                }
            state.metrics.font = style.font;
        }
        return style.shown;
    }

    // The transform of the element in the state; false where it cannot be read.
    bool moved(pugi::xml_node node, SvgState& state) {
        const std::string_view t = node.attribute("transform").value();
        if (t.empty()) return true;
        const auto map = transform_of(t);
        if (!map)
            leave_out(RefusalKind::unreadable, node,
                      text("transform \"", t.substr(0, 60), "\" cannot be read"));
        else
            state.map = product(state.map, *map);
        return map.has_value();
    }

    void children(pugi::xml_node node, const SvgState& state) {
        for (pugi::xml_node n = node.first_child(); n && !stopped_; n = n.next_sibling())
            if (n.type() == pugi::node_element) element(n, state);
    }

    void element(pugi::xml_node node, SvgState state) {
        const std::string_view name = local_name(node.name());
        if (is_silent(name)) return;
        if (++shown_ > kMostShown) {
            stopped_ = Refusal{RefusalKind::limit, place(node),
                               text("more than ", kMostShown, " elements are shown")};
            return;
        }
        if (++state.nested > kMostNested)
            return leave_out(RefusalKind::limit, node,
                             text("elements are nested more than ", kMostNested, " deep"));
        if (!styled(node, state)) return;
        if (!moved(node, state)) return;
        if (name == "g" || name == "a") return children(node, state);
        if (name == "switch") {
            for (pugi::xml_node n = node.first_child(); n; n = n.next_sibling())
                if (n.type() == pugi::node_element && !n.attribute("systemLanguage") &&
                    !n.attribute("requiredExtensions") && !local_name(n.name()).empty())
                    return element(n, state);
            return;
        }
        if (name == "svg") return viewport(node, node, state);
        if (name == "use") return use(node, state);
        if (name == "text" || name == "image" || name == "foreignObject" || name == "video" ||
            name == "audio" || name == "iframe" || name == "canvas")
            return leave_out(
                RefusalKind::unsupported, node,
                name == "text" ? "text has no outlines of its own: make it a path first" : "has no curves");
        shape(node, name, state);
    }

    // A nested svg or a symbol; `size` says how large it is shown.
    void viewport(pugi::xml_node node, pugi::xml_node size, SvgState state) {
        const Metrics outer = state.metrics;
        const auto value = [&](pugi::xml_node from, const char* name, Along along, double otherwise) {
            const std::string_view s = from.attribute(name).value();
            return s.empty() ? otherwise : length(s, outer, along).value_or(otherwise);
        };
        const double width = value(size, "width", Along::x, value(node, "width", Along::x, outer.width)),
                     height = value(size, "height", Along::y, value(node, "height", Along::y, outer.height));
        if (!(width > 0) || !(height > 0)) return;
        const Vec<2> at{{value(node, "x", Along::x, 0), value(node, "y", Along::y, 0)}};
        state.map = product(state.map, {{{{1, 0}, {0, 1}}}, at});
        state.metrics.width = width, state.metrics.height = height;
        if (const auto box = view_box(node.attribute("viewBox").value())) {
            state.map = product(state.map,
                                fitted(*box, width, height, node.attribute("preserveAspectRatio").value()));
            state.metrics.width = box->width, state.metrics.height = box->height;
        }
        children(node, state);
    }

    void use(pugi::xml_node node, SvgState state) {
        std::string_view to = node.attribute("href").value();
        if (to.empty()) to = node.attribute("xlink:href").value();
        const auto target = to.starts_with('#') ? ids_.find(to.substr(1)) : ids_.end();
        if (target == ids_.end())
            return leave_out(RefusalKind::unreadable, node,
                             text("\"", to.substr(0, 60), "\" is no element of this file"));
        const pugi::xml_node found = target->second;
        std::size_t depth = 0;
        for (pugi::xml_node n = node; n; n = n.parent(), ++depth)
            if (n == found) return leave_out(RefusalKind::invalid, node, "refers to what it is inside of");
        if (!look_at(depth + used_.size(), node)) return;
        if (std::ranges::find(used_, found) != used_.end())
            return leave_out(RefusalKind::invalid, node, "refers to itself by way of others");
        const auto value = [&](const char* name, Along along) {
            const std::string_view s = node.attribute(name).value();
            return s.empty() ? 0 : length(s, state.metrics, along).value_or(0);
        };
        state.map = product(state.map, {{{{1, 0}, {0, 1}}}, {{value("x", Along::x), value("y", Along::y)}}});
        used_.push_back(found);
        const std::string_view name = local_name(found.name());
        if (name == "symbol" || name == "svg") {
            if (styled(found, state)) viewport(found, node, state);
        } else {
            element(found, state);
        }
        used_.pop_back();
    }

    void shape(pugi::xml_node node, std::string_view name, const SvgState& state) {
        auto path = outline(
            name,
            [&](const char* attribute) -> std::string_view { return node.attribute(attribute).value(); },
            state.metrics,
            [&](RefusalKind kind, std::string why) {
                if (kind == RefusalKind::limit)
                    stopped_ = Refusal{kind, place(node), std::move(why)};
                else
                    leave_out(kind, node, std::move(why));
            },
            kMostPicture / sizeof(PathSegment));
        if (path) add(node, name, std::move(*path), state);
    }

    void add(pugi::xml_node node, std::string_view name, Path path, const SvgState& state) {
        if (path.subpaths.empty() || !state.style.visible) return;
        SvgShape out{node.attribute("id").value(),
                     std::string(name),
                     transformed(std::move(path), state.map),
                     state.style.fill,
                     state.style.stroke,
                     state.style.fill_rule,
                     state.style.line};
        for (const Subpath& s : out.path.subpaths) {
            bool finite = std::isfinite(s.start[0]) && std::isfinite(s.start[1]);
            for (const PathSegment& segment : s.segments)
                for (int i = 0; i <= segment.degree; ++i)
                    finite = finite && std::isfinite(max_abs(segment.points[std::size_t(i)]));
            if (!finite)
                return leave_out(RefusalKind::nonfinite, node,
                                 "its coordinates are larger than a double holds");
            memory_ += sizeof(Subpath) + s.segments.size() * sizeof(PathSegment);
        }
        memory_ += sizeof(SvgShape) + out.id.size() + out.element.size() + out.fill.size() +
                   out.stroke.size() + sizeof(double) * out.line.dashes.size();
        if (memory_ > kMostPicture) {
            stopped_ = Refusal{RefusalKind::limit, place(node),
                               text("what is shown would take more than ", kMostPicture >> 20, " MiB")};
            return;
        }
        for (const char* cut : kCuts)
            if (const std::string_view by = node.attribute(cut).value(); !by.empty() && by != "none")
                leave_out(RefusalKind::unsupported, node,
                          text(cut, " is not applied: all of its outline is there"));
        const double by = growth(state.map);
        out.line.width *= by, out.line.dash_offset *= by;
        for (double& d : out.line.dashes) d *= by;
        for (std::string* paint : {&out.fill, &out.stroke})
            if (*paint == "currentColor" || *paint == "currentcolor") *paint = state.style.colour;
        out_.shapes.push_back(std::move(out));
    }

    const pugi::xml_document& xml_;
    std::vector<std::size_t> lines_;
    std::unordered_map<std::string_view, pugi::xml_node> ids_;
    StyleSheet sheet_;
    SvgPicture out_;
    std::vector<pugi::xml_node> used_;
    std::size_t shown_ = 0, memory_ = 0, unnamed_ = 0, looked_at_ = 0, may_look_at_ = 0;
    std::optional<Refusal> stopped_;
};

}  // namespace

Result<SvgPicture> read_svg(std::string_view bytes) {
    const std::size_t needed = 72 * std::size_t(std::ranges::count(bytes, '<')) +
                               48 * std::size_t(std::ranges::count(bytes, '=')) +
                               8 * std::size_t(std::ranges::count(bytes, '\n')) + 2 * bytes.size();
    if (needed > kMostMemory)
        return refuse(RefusalKind::limit, "",
                      text("the elements of the file would take about ", needed >> 20, " MiB; the limit is ",
                           kMostMemory >> 20));
    pugi::xml_document xml;
    const pugi::xml_parse_result parsed = xml.load_buffer(bytes.data(), bytes.size());
    if (!parsed) {
        const auto line =
            1 + std::ranges::count(bytes.substr(0, std::size_t(std::max<std::ptrdiff_t>(0, parsed.offset))),
                                   '\n');
        return refuse(RefusalKind::unreadable, text("line ", line),
                      text("this is not XML: ", parsed.description()));
    }
    return SvgReader(xml, bytes).read();
}

}  // namespace freiform
