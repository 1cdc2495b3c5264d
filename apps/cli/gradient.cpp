// gradient: colours along a line or a curve, and gradient meshes.
#include "input.hpp"

#include <freiform/colour/mesh_gradient.hpp>
#include <freiform/query/length.hpp>
#if FREIFORM_HAS_CAIRO
#include <freiform/paint/mesh_gradient.hpp>
#endif

#include <algorithm>
#include <cmath>

namespace freiform::cli {

namespace {

constexpr double kUnseen = 1.0 / 510;  // half a step of eight bits

struct GradientArguments {
    std::vector<std::string> colours;
    std::vector<double> at;
    std::string mesh, along, object, space = "oklab", way = "lines";
    std::optional<int> width;
    bool longer_hue = false;
};

ColourSpace space_named(const std::string& name) {
    for (const ColourSpace s :
         {ColourSpace::srgb, ColourSpace::linear, ColourSpace::oklab, ColourSpace::oklch})
        if (name_of(s) == name) return s;
    return ColourSpace::oklab;
}

Result<Gradient> gradient_of(const GradientArguments& o) {
    std::vector<ColourStop> stops;
    const std::size_t n = o.colours.size();
    for (std::size_t i = 0; i < n; ++i) {
        auto c = colour_named(o.colours[i]);
        if (!c) return refuse_within(text("colours[", i, "]"), c.error());
        stops.push_back({o.at.empty() ? double(i) / double(std::max<std::size_t>(1, n - 1)) : o.at[i], *c});
    }
    using Way = GradientOptions::Way;
    return Gradient::make(stops, {space_named(o.space),
                                  o.way == "smooth" ? Way::smooth
                                  : o.way == "near" ? Way::near
                                                    : Way::lines,
                                  o.longer_hue});
}

double share_of(const Gradient& g, double at) { return (at - g.domain().lo) / g.domain().length(); }

std::string opacity_of(const Colour& c) {
    return c.a < 1 ? text(" stop-opacity=\"", c.a, "\"") : std::string();
}
std::string opaque_hex(Colour c) { return c.a = 1, hex_of(c); }

std::string strip_svg(const Gradient& g, const std::vector<ColourStop>& stops) {
    std::string s =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 10\">\n<linearGradient id=\"g\">\n";
    for (const ColourStop& stop : stops)
        s += text("<stop offset=\"", share_of(g, stop.at), "\" stop-color=\"", opaque_hex(stop.colour), "\"",
                  opacity_of(stop.colour), "/>\n");
    return s + "</linearGradient>\n<rect width=\"100\" height=\"10\" fill=\"url(#g)\"/>\n</svg>\n";
}

std::string strip_css(const Gradient& g, const std::vector<ColourStop>& stops) {
    std::string s = "linear-gradient(90deg";
    for (const ColourStop& stop : stops)
        s += text(", ", hex_of(stop.colour), " ", 100 * share_of(g, stop.at), "%");
    return s + ")\n";
}

std::string stops_json(const std::vector<ColourStop>& stops) {
    json::Writer w;
    w.begin_object().key("stops").begin_array();
    for (const auto& [at, c] : stops)
        w.new_line(1)
            .begin_object()
            .field("at", at)
            .field("colour", hex_of(c))
            .key("rgba")
            .array(std::array{c.r, c.g, c.b, c.a})
            .end_object();
    w.end_array().end_object();
    return w.take() + "\n";
}

Image strip_image(const Gradient& g, int width) {
    Image out{width, std::max(1, width / 10), {}};
    std::vector<unsigned char> row;
    for (int x = 0; x < width; ++x) {
        const Colour c = g(g.domain().lo + g.domain().length() * (x + 0.5) / width);
        for (const double v : {c.r, c.g, c.b})
            row.push_back((unsigned char)std::lround(255 * (c.a * v + 1 - c.a)));
    }
    for (int y = 0; y < out.height; ++y) out.rgb.insert(out.rgb.end(), row.begin(), row.end());
    return out;
}

Result<std::string> png_bytes([[maybe_unused]] const Image& image) {
#if FREIFORM_HAS_CAIRO
    return png_of(image);
#else
    return refuse(RefusalKind::unavailable, "gradient",
                  "this program was built without .png of drawings: install libcairo2-dev and build again");
#endif
}

// The curve in short strokes that overlap, each in the colour of its middle, by arc length.
template <class P>
Result<std::string> along_svg(const Gradient& g, const Curve<P>& curve) {
    const ArcLength<P> length(curve, 0);
    constexpr int kParts = 256, kEach = 4;
    const auto places = length.equal_parts(kParts * kEach);
    if (!places) return std::unexpected(places.error());
    std::vector<Vec<2>> points;
    Box<2> box;
    for (const PlaceAtLength& place : *places) {
        const Vec<2> p = curve(place.parameter);
        points.push_back({{p[0], -p[1]}});
        box.add(points.back());
    }
    const double size = std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]), margin = size / 20;
    std::string s = text(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"", box.lo[0] - margin, " ", box.lo[1] - margin,
        " ", box.hi[0] - box.lo[0] + 2 * margin, " ", box.hi[1] - box.lo[1] + 2 * margin,
        "\">\n<g fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" stroke-width=\"", size / 30,
        "\">\n");
    for (std::size_t i = 0; i < kParts; ++i) {
        const Colour c = g(g.domain().lo + g.domain().length() * (double(i) + 0.5) / kParts);
        s += text("<polyline stroke=\"", opaque_hex(c), "\"",
                  c.a < 1 ? text(" stroke-opacity=\"", c.a, "\"") : std::string(), " points=\"");
        for (std::size_t k = kEach * i; k <= kEach * (i + 1); ++k)
            s += text(points[k][0], ",", points[k][1], " ");
        s += "\"/>\n";
    }
    return s + "</g>\n</svg>\n";
}

// Triangles, each in its mean colour and stroked with it, so that nothing shines through joints.
std::string mesh_svg(std::span<const MeshGradient> meshes, const Box<2>& box) {
    const Vec<2> size = box.hi - box.lo;
    std::string s =
        text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"", box.lo[0], " ", -box.hi[1], " ", size[0],
             " ", size[1], "\">\n<g stroke-width=\"", size[0] / 1000, "\" stroke-linejoin=\"round\">\n");
    for (const MeshGradient& m : meshes) {
        const auto g = m.grid(std::clamp(m.cells_for(1.0 / 128), 24, 48));
        for (int i = 0; i + 1 < g.rows; ++i)
            for (int j = 0; j + 1 < g.columns; ++j) {
                const auto at = [&](int a, int b) {
                    return std::size_t(i + a) * std::size_t(g.columns) + std::size_t(j + b);
                };
                for (const auto& t :
                     {std::array{at(0, 0), at(0, 1), at(1, 1)}, std::array{at(0, 0), at(1, 1), at(1, 0)}}) {
                    Colour c{0, 0, 0, 0};
                    for (const std::size_t k : t)
                        c.r += g.colours[k].r / 3, c.g += g.colours[k].g / 3, c.b += g.colours[k].b / 3,
                            c.a += g.colours[k].a / 3;
                    const std::string ink = opaque_hex(c);
                    s += text("<path fill=\"", ink, "\" stroke=\"", ink, "\"",
                              c.a < 1 ? text(" opacity=\"", c.a, "\"") : std::string(), " d=\"M");
                    for (const std::size_t k : t) s += text(" ", g.points[k][0], ",", -g.points[k][1]);
                    s += "Z\"/>\n";
                }
            }
    }
    return s + "</g>\n</svg>\n";
}

Result<std::vector<MeshGradient>> meshes_of(const Input& input, ColourSpace space) {
    std::vector<MeshGradient> out;
    for (const std::size_t i : input.chosen) {
        const Object& o = input.object(i);
        const auto* surface = std::get_if<Surface<Vec<2>>>(&o.shape);
        if (!surface || o.colours.empty())
            return input.about(
                i, {RefusalKind::unsupported, "",
                    surface ? "it has no colours: one for each control point is expected"
                            : "a polynomial surface in the plane (points of two numbers) is expected"});
        auto mesh = MeshGradient::make(*surface, o.colours, space);
        if (!mesh) return input.about(i, mesh.error());
        out.push_back(*std::move(mesh));
    }
    return out;
}

Result<std::string> mesh_bytes(const GradientArguments& o, const std::string& format,
                               std::span<const MeshGradient> meshes) {
    Box<2> box;
    for (const MeshGradient& m : meshes) {
        const Box<2> own = m.box();
        box.add(own);
    }
    if (format == "svg") return mesh_svg(meshes, box);
    if (format == "pdf") {
#if FREIFORM_HAS_CAIRO
        std::vector<MeshGradient::Piece> all;
        for (const MeshGradient& m : meshes) {
            auto pieces = m.pieces(std::min(32, m.cells_for(kUnseen)));
            if (!pieces) return std::unexpected(pieces.error());
            all.insert(all.end(), pieces->begin(), pieces->end());
        }
        return to_pdf(all, box, 540);
#endif
    }
    const auto image = picture_of(meshes, box, o.width.value_or(800));
    if (!image) return std::unexpected(image.error());
    return png_bytes(*image);
}

Result<void> run_gradient(const Context& context, const GradientArguments& o) {
    const std::size_t dot = context.output.rfind('.');
    const std::string format = !context.to.empty() ? context.to
                               : dot == std::string::npos
                                   ? (o.along.empty() && o.mesh.empty() ? "css" : "svg")
                                   : context.output.substr(dot + 1);
    const bool is_mesh = !o.mesh.empty();
    const auto one_of = [&](std::initializer_list<std::string_view> known) {
        return std::ranges::find(known, std::string_view(format)) != known.end();
    };
    if (!(is_mesh            ? one_of({"png", "svg", "pdf"})
          : !o.along.empty() ? one_of({"svg"})
                             : one_of({"png", "svg", "css", "json"})))
        wrong_usage(
            text("\"", format,
                 "\" is not what this gradient is written as: of colours .png, .svg, .css or .json, along "
                 "a curve .svg, of a mesh .png, .svg or .pdf"));
    if (is_mesh == !o.colours.empty()) wrong_usage("either colours or --mesh are expected");
    Result<std::string> bytes = std::string();
    if (is_mesh) {
        const auto input = read_input(context, o.mesh, o.object);
        if (!input) return std::unexpected(input.error());
        const auto meshes = meshes_of(*input, space_named(o.space));
        if (!meshes) return std::unexpected(meshes.error());
        if (meshes->empty()) return refuse(RefusalKind::no_answer, shown(o.mesh), "there is no surface");
        bytes = mesh_bytes(o, format, *meshes);
    } else {
        if (!o.at.empty() && o.at.size() != o.colours.size())
            wrong_usage("--at needs a place for each colour");
        const auto gradient = gradient_of(o);
        if (!gradient) wrong_usage(text(gradient.error().where, ": ", gradient.error().message));
        const auto stops = gradient->stops_in_srgb(kUnseen);
        if (!stops) return std::unexpected(stops.error());
        if (!o.along.empty()) {
            const auto input = read_input(context, o.along, o.object);
            if (!input) return std::unexpected(input.error());
            if (input->chosen.size() > 1) wrong_usage("one curve is expected; --object chooses it");
            const auto done =
                each_curve(*input, "colour", [&](std::size_t, const auto& curve) -> Result<void> {
                    if constexpr (Space<typename std::remove_cvref_t<decltype(curve)>::Coefficients>::kDim ==
                                  2)
                        bytes = along_svg(*gradient, curve);
                    else
                        bytes = refuse(RefusalKind::unsupported, "", "a plane curve is expected");
                    return bytes ? Result<void>() : std::unexpected(bytes.error());
                });
            if (!done) return done;
        } else {
            bytes = context.json || format == "json" ? stops_json(*stops)
                    : format == "svg"                ? strip_svg(*gradient, *stops)
                    : format == "css"                ? strip_css(*gradient, *stops)
                                      : png_bytes(strip_image(*gradient, o.width.value_or(800)));
        }
    }
    if (!bytes) return std::unexpected(bytes.error());
    return emit(context, *bytes);
}

}  // namespace

void add_gradient(CommandLine& line) {
    const auto options = std::make_shared<GradientArguments>();
    const Command command =
        line.add("gradient", "Colours along a line or a curve, and gradient meshes",
                 "  freiform gradient '#c84018' '#ffe080' '#1060a0' --way smooth -o strip.png\n"
                 "  freiform gradient '#f00' '#00f' --space oklch                 # as CSS\n"
                 "  freiform gradient '#f00' '#00f' --along curve.json -o curve.svg\n"
                 "  freiform gradient --mesh mesh.json -o mesh.png                # or .pdf, .svg\n"
                 "A mesh is a surface with points of two numbers and \"colours\", one for each of them.");
    command.words("COLOURS", options->colours, "Such as #c84018 or #c8401880");
    command.numbers("--at", options->at, "Where they are (default: equally far apart)").shown_as("T,T,..");
    command.word("--space", options->space, "Where colours are mixed")
        .one_of({"srgb", "linear", "oklab", "oklch"});
    command.word("--way", options->way, "Straight, smooth through the colours, or a spline near them")
        .one_of({"lines", "smooth", "near"});
    command.flag("--longer-hue", options->longer_hue, "Of oklch: the longer way round the hues");
    command.word("--along", options->along, "A file with a plane curve that takes the colours");
    command.word("--mesh", options->mesh, "A file with gradient meshes");
    command.count("--width", options->width, 1, 16384, "Of pictures, in pixels (default 800)");
    command.object(options->object);
    command.output("Where it goes (.png, .svg, .pdf, .css, .json)");
    command.limits();
    command.action(options, run_gradient);
}

}  // namespace freiform::cli
