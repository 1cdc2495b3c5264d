#include "cairo_detail.hpp"

#include <freiform/paint/mesh_gradient.hpp>

namespace freiform {

namespace {

// Around the boundary from (u, v) = (0, 0) by (0, 1), with the inner points beside the corners.
void add_patch(cairo_pattern_t* mesh, const MeshGradient::Piece& p) {
    static constexpr int kRound[12][2] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 3}, {2, 3},
                                          {3, 3}, {3, 2}, {3, 1}, {3, 0}, {2, 0}, {1, 0}};
    static constexpr int kInner[4][2] = {{1, 1}, {1, 2}, {2, 2}, {2, 1}},
                         kCorner[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    const auto at = [&](int k) -> const Vec<2>& {
        return p.net[std::size_t(kRound[k % 12][0])][std::size_t(kRound[k % 12][1])];
    };
    cairo_mesh_pattern_begin_patch(mesh);
    cairo_mesh_pattern_move_to(mesh, at(0)[0], at(0)[1]);
    for (int k = 0; k < 12; k += 3)
        cairo_mesh_pattern_curve_to(mesh, at(k + 1)[0], at(k + 1)[1], at(k + 2)[0], at(k + 2)[1],
                                    at(k + 3)[0], at(k + 3)[1]);
    for (unsigned k = 0; k < 4; ++k) {
        const Vec<2>& inner = p.net[std::size_t(kInner[k][0])][std::size_t(kInner[k][1])];
        const Colour& c = p.corner[std::size_t(kCorner[k][0])][std::size_t(kCorner[k][1])];
        cairo_mesh_pattern_set_control_point(mesh, k, inner[0], inner[1]);
        cairo_mesh_pattern_set_corner_color_rgba(mesh, k, c.r, c.g, c.b, c.a);
    }
    cairo_mesh_pattern_end_patch(mesh);
}

}  // namespace

Result<std::string> to_pdf(std::span<const MeshGradient::Piece> pieces, const Box<2>& box,
                           double points_wide) {
    const Vec<2> size = box.hi - box.lo;
    if (!(size[0] > 0 && size[1] > 0 && is_finite(size)))
        return refuse(RefusalKind::invalid, "box", "it has no area");
    const double scale = points_wide / size[0];
    std::string out;
    {
        const detail::Sheet sheet(
            cairo_pdf_surface_create_for_stream(detail::take, &out, points_wide, size[1] * scale),
            cairo_surface_destroy);
        const detail::Pen pen(cairo_create(sheet.get()), cairo_destroy);
        cairo_translate(pen.get(), -box.lo[0] * scale, box.hi[1] * scale);
        cairo_scale(pen.get(), scale, -scale);
        const std::unique_ptr<cairo_pattern_t, decltype(&cairo_pattern_destroy)> mesh(
            cairo_pattern_create_mesh(), cairo_pattern_destroy);
        for (const MeshGradient::Piece& p : pieces) add_patch(mesh.get(), p);
        cairo_set_source(pen.get(), mesh.get());
        cairo_paint(pen.get());
        cairo_surface_finish(sheet.get());
        if (const auto s = cairo_surface_status(sheet.get()); s != CAIRO_STATUS_SUCCESS)
            return refuse(RefusalKind::io, "", text("cairo: ", cairo_status_to_string(s)));
    }
    return out;
}

Result<std::string> png_of(const Image& image) {
    const detail::Sheet sheet(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height),
                              cairo_surface_destroy);
    if (cairo_surface_status(sheet.get()) != CAIRO_STATUS_SUCCESS)
        return refuse(RefusalKind::limit, "",
                      text("no picture of ", image.width, " x ", image.height, " pixels"));
    unsigned char* rows = cairo_image_surface_get_data(sheet.get());
    const int stride = cairo_image_surface_get_stride(sheet.get());
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const unsigned char* from = image.pixel(x, y);
            unsigned char* to = rows + std::ptrdiff_t(y) * stride + 4 * x;
            to[0] = from[2], to[1] = from[1], to[2] = from[0];
        }
    cairo_surface_mark_dirty(sheet.get());
    std::string out;
    if (const auto s = cairo_surface_write_to_png_stream(sheet.get(), detail::take, &out);
        s != CAIRO_STATUS_SUCCESS)
        return refuse(RefusalKind::io, "", text("cairo: ", cairo_status_to_string(s)));
    return out;
}

}  // namespace freiform
