// Pictures of a file's surfaces from four sides, without a window and without a mesh:
//   gpu-offscreen teapot.bpt teapot      writes teapot-iso.png, teapot-front.png, ..
#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>

#include <iostream>

namespace ff = freiform;

static int refused(const ff::Refusal& r) {
    std::cerr << r.where << ": " << r.message << '\n';
    return 1;
}

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: gpu-offscreen FILE NAME\n";
        return 2;
    }
    const auto document = ff::read_any(argv[1]);
    if (!document) return refused(document.error());
    const auto model = ff::scene_of(*document);
    if (!model) return refused(model.error());

    // Everything the card needs, once; edges within a 16000th of the model.
    auto buffers =
        ff::surface_buffers(*model, {.edge_tolerance = ff::summary(*model).box.diagonal() / 16000});
    if (!buffers) return refused(buffers.error());
    auto renderer = ff::SurfaceRenderer::make(std::move(*buffers));
    if (!renderer) return refused(renderer.error());

    // From then on a view is one call; triangles are as fine as its pixels ask for.
    for (const std::string name : {"iso", "front", "top", "right"}) {
        ff::RenderOptions options;
        options.view = *ff::parse_view(name);
        const auto image = renderer->draw(options);
        if (!image) return refused(image.error());
        const auto png = ff::to_png(*image);
        if (!png) return refused(png.error());
        if (auto ok = ff::write_file(std::string(argv[2]) + "-" + name + ".png", *png); !ok)
            return refused(ok.error());
    }
}
