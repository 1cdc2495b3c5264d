// The surfaces of a file as one page, for any browser that has WebGL 2: buffers and shaders of the library,
// and a renderer of 150 lines in JavaScript (webgl.html).
//   gpu-webgl teapot.bpt teapot.html
// With two more files, fine.ppm and es.ppm, the same view before magenta, which tests compare the page with:
// of a fine mesh with 2560 x 1920 pixels, and as the library draws it in OpenGL ES with 320 x 240.
#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>

#include <charconv>
#include <iostream>
#include <string>
#include <string_view>

namespace ff = freiform;

namespace {

int refused(const ff::Refusal& r) {
    std::cerr << r.where << ": " << r.message << '\n';
    return 1;
}

// The shortest text that is this float again.
template <class Number>
void append(std::string& out, Number x) {
    char digits[32];
    out.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr).append(",");
}
template <class Numbers>
std::string list(const Numbers& numbers) {
    std::string out = "[";
    for (const auto x : numbers) append(out, x);
    return out + "]";
}
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? "\\n" : std::string(1, c);
    }
    return out + "\"";
}
std::string sources(std::initializer_list<ff::SurfaceShader> stages) {
    std::string out = "[";
    for (const ff::SurfaceShader s : stages)
        out += quoted(ff::shader_source(s, ff::GlslDialect::gles300)) + ",\n";
    return out + "]";
}

// An object of JavaScript with the names of SurfaceBuffers.
std::string script_of(const ff::SurfaceBuffers& b, const ff::View& view) {
    using enum ff::SurfaceShader;
    std::string out = "{\ngrid: " + sources({grid_vertex, surface_fragment}) +
                      ",\nseam: " + sources({seam_vertex, seam_fragment}) + ",\ntexels: new Float32Array([";
    for (const auto& texel : b.texels)
        for (const float x : texel) append(out, x);
    out += "]),\nbends: [";
    for (const auto& bend : b.bends) out += list(bend) + ",";
    out += "],\nseams: [";
    for (const ff::SeamSegment& s : b.seams) {
        out += "[";
        for (const auto& part :
             {s.from, s.to, s.edge_from, s.edge_to, s.normal_from, s.normal_to, s.other_from, s.other_to})
            for (const float x : part) append(out, x);
        for (const auto& colour : {s.colour, s.other_colour})
            for (const std::uint8_t x : colour) append(out, int(x));
        out += "],";
    }
    out += "],\nextent: [";
    for (const ff::Vec<3>& p : b.extent) {
        const ff::Vec<3> q = (1 / b.size) * (p - b.middle);
        out += list(std::array{float(q[0]), float(q[1]), float(q[2])}) + ",";
    }
    out += "],\nedge_tolerance: ";
    append(out, b.edge_tolerance);
    out += " pieces: ";
    append(out, b.pieces);
    out += " faces: ";
    append(out, b.faces);
    out += " view: {azimuth: ";
    append(out, view.azimuth);
    out += " elevation: ";
    append(out, view.elevation);
    return out + "},\n}";
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 && argc != 5) {
        std::cerr << "usage: gpu-webgl FILE PAGE.html [FINE.ppm ES.ppm]\n";
        return 2;
    }
    const auto document = ff::read_any(argv[1]);
    if (!document) return refused(document.error());
    const auto model = ff::scene_of(*document);
    if (!model) return refused(model.error());
    auto buffers =
        ff::surface_buffers(*model, {.edge_tolerance = ff::summary(*model).box.diagonal() / 16000});
    if (!buffers) return refused(buffers.error());
    ff::RenderOptions options;
    options.view = *ff::parse_view("30,20");

    auto page = ff::read_file(FREIFORM_WEBGL_PAGE, 1 << 20);
    if (!page) return refused(page.error());
    const std::string place = "const surfaces = {}";
    page->replace(page->find(place), place.size(), "const surfaces = " + script_of(*buffers, options.view));
    if (auto ok = ff::write_file(argv[2], *page); !ok) return refused(ok.error());
    if (argc == 3) return 0;

    ff::TessellateOptions fine;
    fine.tolerance = ff::summary(*model).box.diagonal() / 20000;
    const auto mesh = ff::tessellate(*model, fine);
    if (!mesh) return refused(mesh.error());
    options.supersampling = 1;
    options.outlines = false;
    options.top = options.bottom = {1, 0, 1, 1};
    const auto write = [&](const char* file, const ff::Result<ff::Image>& image) -> ff::Result<void> {
        if (!image) return std::unexpected(image.error());
        const std::string head =
            "P6\n" + std::to_string(options.width) + " " + std::to_string(options.height) + "\n255\n";
        return ff::write_file(file, head + std::string(image->rgb.begin(), image->rgb.end()));
    };
    options.width = 320, options.height = 240;
    ff::RenderOptions framed = options;
    framed.frame = buffers->extent;
    auto renderer = ff::SurfaceRenderer::make(std::move(*buffers), ff::SurfacePipeline::grid);
    if (!renderer) return refused(renderer.error());
    if (auto ok = write(argv[4], renderer->draw(options)); !ok) return refused(ok.error());
    options = framed;
    options.width = 2560, options.height = 1920;
    if (auto ok = write(argv[3], ff::render(mesh->mesh, options)); !ok) return refused(ok.error());
}
