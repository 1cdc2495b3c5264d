// SVG 1.1 and PDF 1.4. Both have lines and cubic curves; PDF has no quadratic ones, which are elevated:
// c1 = q0 + 2/3 (q1 - q0), c2 = q2 + 2/3 (q1 - q2).
#include <freiform/io/drawing.hpp>

#include <array>
#include <charconv>
#include <cmath>

namespace freiform {

namespace {

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

void append(std::string& s, const Vec<2>& p) {
    append_text(s, p[0]);
    s += ' ';
    append_text(s, p[1]);
}

std::string svg_path(const DrawnPath& path) {
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

// PDF numbers have no exponents; 1/10000 of a pixel.
std::string fixed(double x) {
    std::array<char, 400> buffer;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::fixed, 4);
    return {buffer.data(), end.ptr};
}

std::string fixed(const Vec<2>& p) { return text(fixed(p[0]), " ", fixed(p[1])); }
std::string fixed(const Colour& c) { return text(fixed(c.r), " ", fixed(c.g), " ", fixed(c.b)); }

void pdf_path(std::string& s, const DrawnPath& path) {
    s += text(fixed(path.start), " m\n");
    Vec<2> from = path.start;
    for (const DrawnSegment& segment : path.segments) {
        const auto& [a, b, c] = segment.points;
        if (segment.degree == 1) s += text(fixed(a), " l\n");
        if (segment.degree == 2)
            s += text(fixed(from + (2.0 / 3) * (a - from)), " ", fixed(b + (2.0 / 3) * (a - b)), " ",
                      fixed(b), " c\n");
        if (segment.degree == 3) s += text(fixed(a), " ", fixed(b), " ", fixed(c), " c\n");
        from = segment.points[std::size_t(segment.degree - 1)];
    }
    s += path.closed ? "s\n" : "S\n";
}

// Four cubic arcs, within 3/10000 of the radius of the circle.
void pdf_disc(std::string& s, const DrawnDisc& d) {
    const double r = d.radius, k = 0.5522847498 * r;
    const auto at = [&](double x, double y) { return fixed(d.centre + Vec<2>{{x, y}}); };
    s += text(at(r, 0), " m\n");
    s += text(at(r, k), " ", at(k, r), " ", at(0, r), " c\n");
    s += text(at(-k, r), " ", at(-r, k), " ", at(-r, 0), " c\n");
    s += text(at(-r, -k), " ", at(-k, -r), " ", at(0, -r), " c\n");
    s += text(at(k, -r), " ", at(r, -k), " ", at(r, 0), " c\n", d.hollow ? "b\n" : "f\n");
}

std::string pdf_content(const Drawing& d) {
    std::string s = text("0.75 0 0 -0.75 0 ", fixed(0.75 * d.height), " cm\n1 J 1 j\n");
    for (const DrawnGroup& g : d.groups) {
        const std::string colour = fixed(g.colour);
        s += text(colour, " RG\n", fixed(g.width), " w\n");
        for (const DrawnPath& path : g.paths) pdf_path(s, path);
        for (const DrawnDisc& disc : g.discs) {
            s += disc.hollow ? "1 1 1 rg\n" : text(colour, " rg\n");
            pdf_disc(s, disc);
        }
    }
    return s;
}

}  // namespace

std::string to_svg(const Drawing& d) {
    std::string s =
        text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"",
             d.width, "\" height=\"", d.height, "\" viewBox=\"0 0 ", d.width, " ", d.height, "\">\n");
    s += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (const DrawnGroup& g : d.groups) {
        const std::string colour = hex(g.colour);
        s += text("<g class=\"", xml(g.role), "\" fill=\"none\" stroke=\"", colour, "\" stroke-width=\"",
                  g.width, "\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
        if (!g.name.empty()) s += text("<title>", xml(g.name), "</title>\n");
        for (const DrawnPath& path : g.paths) s += text("<path d=\"", svg_path(path), "\"/>\n");
        for (const DrawnDisc& disc : g.discs)
            s += text("<circle cx=\"", disc.centre[0], "\" cy=\"", disc.centre[1], "\" r=\"", disc.radius,
                      "\" ", disc.hollow ? "fill=\"white\"" : text("stroke=\"none\" fill=\"", colour, "\""),
                      "/>\n");
        s += "</g>\n";
    }
    return s + "</svg>\n";
}

std::string to_pdf(const Drawing& d) {
    const std::string content = pdf_content(d);
    const std::array<std::string, 4> objects{
        "<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        text("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ", fixed(0.75 * d.width), " ",
             fixed(0.75 * d.height), "] /Resources << >> /Contents 4 0 R >>"),
        text("<< /Length ", content.size(), " >>\nstream\n", content, "endstream")};
    std::string s = "%PDF-1.4\n", table = "0000000000 65535 f \n";
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::string offset = text(s.size());
        table += text(std::string(10 - std::min<std::size_t>(10, offset.size()), '0'), offset, " 00000 n \n");
        s += text(i + 1, " 0 obj\n", objects[i], "\nendobj\n");
    }
    const std::size_t xref = s.size();
    return text(s, "xref\n0 ", objects.size() + 1, "\n", table, "trailer\n<< /Size ", objects.size() + 1,
                " /Root 1 0 R >>\nstartxref\n", xref, "\n%%EOF\n");
}

}  // namespace freiform
