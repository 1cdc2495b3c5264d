// Documents as SVG and back.
#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/svg.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace freiform {

namespace {

constexpr double kViewMargin = 0.02;  // of the larger side of the box of what is shown

std::string escaped(std::string_view s) {
    std::string out;
    for (const char c : s) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\n')
            out += c;
    }
    return out;
}

// y down, as SVG has it.
Path turned(const Path& path) { return transformed(path, {{{{1, 0}, {0, -1}}}, {}}); }

Box<2> box_of_path(const Path& path) {
    Box<2> box;
    for (const Subpath& s : path.subpaths) {
        box.add(s.start);
        for (const PathSegment& segment : s.segments)
            for (int i = 0; i <= segment.degree; ++i) box.add(segment.points[std::size_t(i)]);
    }
    return box;
}

std::string paint(std::string_view as_written) {
    return as_written.starts_with("url(") ? "#808080" : escaped(as_written);
}

}  // namespace

Document document_of(const SvgPicture& picture) {
    Document out;
    out.unit = picture.unit;
    for (std::size_t i = 0; i < picture.shapes.size(); ++i) {
        const SvgShape& shape = picture.shapes[i];
        const std::string name = shape.id.empty() ? text(shape.element, i + 1) : shape.id;
        int part = 0;
        for (const Subpath& s : shape.path.subpaths) {
            ++part;
            if (s.segments.empty()) continue;
            visit_one(
                [&](auto curve) {
                    out.objects.push_back({part > 1 ? text(name, "/", part) : name, std::move(curve), {}});
                },
                curve_of(s));
        }
    }
    out.left_out = picture.left_out;
    return out;
}

Result<SvgOfDocument> picture_of(const Document& document, double tolerance) {
    SvgOfDocument out;
    out.picture.unit = document.unit;
    Box<2> box;
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
        const Object& o = document.objects[i];
        const std::string label = text("objects[", i, "]");
        auto subpath = visit_one(
            [&](const auto& s) -> Result<SubpathOfCurve> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, Curve<Vec<2>>> || std::same_as<S, Curve<Hom<2>>>)
                    return subpath_of(s, tolerance);
                else
                    return refuse(RefusalKind::unsupported, "",
                                  text("SVG holds plane curves, not a ", type_name(o.shape),
                                       type_name(o.shape) == "curve"     ? " in space"
                                       : type_name(o.shape) == "trimmed" ? " surface"
                                                                         : "",
                                       "; freiform draw makes pictures of everything"));
            },
            o.shape);
        if (!subpath) return refuse_within(label, subpath.error());
        out.bound = std::max(out.bound, subpath->bound);
        SvgShape shape;
        shape.id = o.name, shape.element = "path";
        shape.fill = "none", shape.stroke = "black";
        shape.path.subpaths.push_back(std::move(subpath->subpath));
        const Box<2> own = box_of_path(shape.path);
        box.add(own);
        out.picture.shapes.push_back(std::move(shape));
    }
    if (box.is_empty()) return refuse(RefusalKind::no_answer, "objects", "there is nothing to write");
    const double margin = kViewMargin * std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]);
    for (int k = 0; k < 2; ++k) box.lo[k] -= margin, box.hi[k] += margin;
    out.picture.view = box;
    for (SvgShape& s : out.picture.shapes) s.line.width = margin / 4;
    return out;
}

std::string write_svg(const SvgPicture& picture) {
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"";
    if (!picture.view.is_empty()) {
        const Vec<2> size = picture.view.hi - picture.view.lo;
        const std::string_view unit = picture.unit == "inch" ? "in" : std::string_view(picture.unit);
        const bool physical = unit == "mm" || unit == "cm" || unit == "in";
        out += text(" width=\"", size[0], physical ? unit : "", "\" height=\"", size[1], physical ? unit : "",
                    "\" viewBox=\"", picture.view.lo[0], " ", -picture.view.hi[1], " ", size[0], " ", size[1],
                    "\"");
    }
    out += ">\n";
    std::set<std::string_view> ids;  // what is used twice is called once
    for (const SvgShape& s : picture.shapes) {
        static constexpr std::string_view kCaps[] = {"butt", "round", "square"},
                                          kJoins[] = {"miter", "miter-clip", "round", "bevel", "arcs"};
        out += "<path";
        if (!s.id.empty() && ids.insert(s.id).second) out += text(" id=\"", escaped(s.id), "\"");
        if (s.fill != "black") out += text(" fill=\"", paint(s.fill), "\"");
        if (s.fill_rule == FillRule::evenodd) out += " fill-rule=\"evenodd\"";
        if (s.stroke != "none") {
            out += text(" stroke=\"", paint(s.stroke), "\" stroke-width=\"", s.line.width, "\"");
            if (s.line.cap != LineCap::butt) out += text(" stroke-linecap=\"", kCaps[int(s.line.cap)], "\"");
            if (s.line.join != LineJoin::miter)
                out += text(" stroke-linejoin=\"", kJoins[int(s.line.join)], "\"");
            if (s.line.miter_limit != 4) out += text(" stroke-miterlimit=\"", s.line.miter_limit, "\"");
            for (std::size_t i = 0; i < s.line.dashes.size(); ++i)
                out += text(i == 0 ? " stroke-dasharray=\"" : " ", s.line.dashes[i],
                            i + 1 == s.line.dashes.size() ? "\"" : "");
            if (s.line.dash_offset != 0) out += text(" stroke-dashoffset=\"", s.line.dash_offset, "\"");
        }
        out += text(" d=\"", path_data(turned(s.path)), "\"/>\n");
    }
    return out + "</svg>\n";
}

}  // namespace freiform
