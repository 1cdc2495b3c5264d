// SVG 1.1 with the layers of Inkscape, which other programs take for groups. Lines and curves are written as
// what they are, so that their control points can be edited; words are text elements. Formulas are one text
// element with a tspan per run; a raised run is moved by dy, and the next one moved back.
//
// Why not `baseline-shift`, which says the same: browsers draw it, but librsvg and Inkscape 1 do not agree on
// it.
#include <freiform/io/paper.hpp>

#include <cmath>
#include <map>
#include <span>

namespace freiform {

namespace {

// Typefaces with serifs and all of the letters used; the last is any.
constexpr std::string_view kFamily = "'Latin Modern Roman','DejaVu Serif','STIX Two Text',Georgia,serif";

std::string xml(std::string_view s) {
    std::string out;
    for (const char c : s) {
        if (c == '&') {
            out += "&amp;";
        } else if (c == '<') {
            out += "&lt;";
        } else if (c == '>') {
            out += "&gt;";
        } else if (c == '"') {
            out += "&quot;";
        } else if (static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n') {
            out += c;  // other control characters do not exist in XML 1.0
        }
    }
    return out;
}

std::string hex(const Colour& c) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string s = "#";
    for (const double x : {c.r, c.g, c.b}) {
        const auto byte = std::size_t(std::lround(255 * x));
        s += kDigits[byte / 16];
        s += kDigits[byte % 16];
    }
    return s;
}

// Names of elements: letters, digits and hyphens, each only once in a file.
class Ids {
public:
    std::string operator()(std::string_view wish) {
        std::string id;
        for (const char c : wish) {
            const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
            if (plain)
                id += c;
            else if (!id.empty() && id.back() != '-')
                id += '-';
        }
        while (!id.empty() && id.back() == '-') id.pop_back();
        if (id.empty() || (id[0] >= '0' && id[0] <= '9')) id = "g" + id;
        const std::string base = id;
        while (used_[id]++ > 0) id = text(base, "-", used_[base]);
        return id;
    }

private:
    std::map<std::string, int> used_;
};

void append(std::string& s, const Vec<2>& p) {
    append_text(s, p[0]);
    s += ' ';
    append_text(s, p[1]);
}

std::string data_of(const DrawnPath& path) {
    constexpr std::array<char, 4> kLetter{'M', 'L', 'Q', 'C'};
    std::string s = "M";
    append(s, path.start);
    for (const DrawnSegment& segment : path.segments) {
        s += kLetter[std::size_t(segment.degree)];
        for (int i = 0; i < segment.degree; ++i) {
            if (i > 0) s += ' ';
            append(s, segment.points[std::size_t(i)]);
        }
    }
    if (path.closed) s += 'Z';
    return s;
}

void add_label(std::string& s, const DrawnLabel& label, const std::string& colour) {
    constexpr std::array<std::string_view, 3> kAnchor{"start", "middle", "end"};
    s += text("<text x=\"", label.at[0], "\" y=\"", label.at[1], "\" font-size=\"", label.size,
              "\" text-anchor=\"", kAnchor[std::size_t(label.anchor)], "\" fill=\"", colour,
              "\" xml:space=\"preserve\"", label.bold ? " font-weight=\"bold\"" : "", ">");
    double low = 0;  // how far below the base line the last run was
    for (const DrawnRun& run : label.text) {
        const double here = run.level * (run.level > 0 ? -0.4 : -0.22) * label.size;
        const std::string move = here == low ? "" : text(" dy=\"", here - low, "\"");
        const std::string style =
            text(run.italic ? " font-style=\"italic\"" : "",
                 run.level == 0 ? "" : text(" font-size=\"", 0.7 * label.size, "\""), move);
        if (style.empty())
            s += xml(run.text);
        else
            s += text("<tspan", style, ">", xml(run.text), "</tspan>");
        low = here;
    }
    s += "</text>\n";
}

void add_group(std::string& s, const DrawnGroup& g, Ids& ids) {
    const std::string colour = hex(g.colour);
    s += text("<g class=\"", xml(g.role), "\" id=\"", ids(g.name + " " + g.role),
              "\" inkscape:groupmode=\"layer\" inkscape:label=\"",
              xml(g.name.empty() ? g.role : text(g.role, " of ", g.name)), "\" fill=\"none\" stroke=\"",
              colour, "\" stroke-width=\"", g.width, "\" stroke-linecap=\"",
              g.dashes.empty() ? "round" : "butt", "\" stroke-linejoin=\"round\"");
    if (!g.dashes.empty()) {
        s += " stroke-dasharray=\"";
        for (std::size_t i = 0; i < g.dashes.size(); ++i) s += text(i > 0 ? "," : "", g.dashes[i]);
        s += '"';
    }
    if (g.fill > 0) s += text(" fill-opacity=\"", g.fill, "\"");
    s += ">\n";
    if (!g.name.empty()) s += text("<title>", xml(g.name), "</title>\n");
    std::string_view part;
    if (g.area) {
        s += text("<path stroke=\"none\" fill=\"", colour, "\" d=\"");
        for (const DrawnPath& path : g.paths) s += data_of(path);
        s += "\"/>\n";
    }
    for (const DrawnPath& path :
         g.area ? std::span<const DrawnPath>() : std::span<const DrawnPath>(g.paths)) {
        if (path.part != part) {
            if (!part.empty()) s += "</g>\n";
            part = path.part;
            if (!part.empty()) s += text("<g id=\"", ids(text(part, " ", g.role)), "\">\n");
        }
        s += text("<path d=\"", data_of(path), "\"");
        if (path.solid)
            s += text(" stroke=\"none\" fill-opacity=\"1\" fill=\"", colour, "\"");
        else if (g.fill > 0)
            s += text(" fill=\"", colour, "\"");
        s += "/>\n";
    }
    if (!part.empty()) s += "</g>\n";
    for (const DrawnDisc& disc : g.discs)
        s += text("<circle cx=\"", disc.centre[0], "\" cy=\"", disc.centre[1], "\" r=\"", disc.radius,
                  "\" fill-opacity=\"1\" ",
                  disc.hollow ? "fill=\"white\"" : text("stroke=\"none\" fill=\"", colour, "\""), "/>\n");
    if (!g.labels.empty()) {
        s += text("<g font-family=\"", kFamily,
                  "\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">\n");
        for (const DrawnLabel& label : g.labels) add_label(s, label, colour);
        s += "</g>\n";
    }
    s += "</g>\n";
}

}  // namespace

std::string to_svg(const Drawing& d) {
    std::string s = text(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"",
        d.width, "\" height=\"", d.height, "\" viewBox=\"0 0 ", d.width, " ", d.height, "\">\n");
    if (!d.title.empty()) s += text("<title>", xml(d.title), "</title>\n");
    s += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    Ids ids;
    std::string layer;
    const auto close = [&] {
        if (!layer.empty()) s += "</g>\n";
    };
    for (const DrawnGroup& g : d.groups) {
        if (g.layer != layer) {
            close();
            layer = g.layer;
            if (!layer.empty())
                s += text("<g id=\"", ids(layer), "\" inkscape:groupmode=\"layer\" inkscape:label=\"",
                          xml(layer), "\">\n");
        }
        add_group(s, g, ids);
    }
    close();
    return s + "</svg>\n";
}

}  // namespace freiform
