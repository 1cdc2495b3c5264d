// The drawing is walked once for both formats; only the surface that cairo draws on differs.
//
// Why cairo and not a rasteriser and a writer of PDF of our own: words need typefaces, hinting and their
// embedding, which are most of the work of a page, and cairo is everywhere.
#include "cairo_detail.hpp"

#include <freiform/paint/paint.hpp>

#include <cstdint>
#include <cstring>

namespace freiform {

namespace {

constexpr double kPoint = 0.75;  // 1/72 inch in pixels of 1/96 inch, inverted
constexpr const char* kFamily = "DejaVu Serif";
constexpr long long kMostPixels = 1LL << 26;

using detail::Pen;
using detail::Sheet;
using detail::take;

void ink(cairo_t* c, const Colour& colour, double opacity = 1) {
    cairo_set_source_rgba(c, colour.r, colour.g, colour.b, opacity);
}

// PDF and cairo have no quadratic curves: c1 = q0 + 2/3 (q1 - q0), c2 = q2 + 2/3 (q1 - q2).
void trace(cairo_t* c, const DrawnPath& path) {
    cairo_move_to(c, path.start[0], path.start[1]);
    Vec<2> from = path.start;
    for (const DrawnSegment& s : path.segments) {
        const Vec<2>& end = end_of(s);
        if (s.degree == 1) {
            cairo_line_to(c, end[0], end[1]);
        } else {
            const Vec<2> a = s.degree == 3 ? s.points[0] : from + (2.0 / 3) * (s.points[0] - from);
            const Vec<2> b = s.degree == 3 ? s.points[1] : end + (2.0 / 3) * (s.points[0] - end);
            cairo_curve_to(c, a[0], a[1], b[0], b[1], end[0], end[1]);
        }
        from = end;
    }
    if (path.closed) cairo_close_path(c);
}

void draw_path(cairo_t* c, const DrawnGroup& g, const DrawnPath& path) {
    cairo_new_path(c);
    trace(c, path);
    if (path.solid) {
        ink(c, g.colour);
        cairo_fill(c);
        return;
    }
    if (g.fill > 0) {
        ink(c, g.colour, g.fill);
        cairo_fill_preserve(c);
    }
    ink(c, g.colour);
    if (g.width > 0) cairo_stroke(c);
}

void draw_area(cairo_t* c, const DrawnGroup& g) {
    cairo_new_path(c);
    for (const DrawnPath& path : g.paths) trace(c, path);
    ink(c, g.colour);
    cairo_set_fill_rule(c, CAIRO_FILL_RULE_WINDING);
    cairo_fill(c);
}

void draw_disc(cairo_t* c, const DrawnGroup& g, const DrawnDisc& d) {
    constexpr double kTurn = 6.283185307179586;
    cairo_new_path(c);
    cairo_arc(c, d.centre[0], d.centre[1], d.radius, 0, kTurn);
    if (d.hollow)
        cairo_set_source_rgb(c, 1, 1, 1);
    else
        ink(c, g.colour);
    cairo_fill_preserve(c);
    ink(c, g.colour);
    if (d.hollow)
        cairo_stroke(c);
    else
        cairo_new_path(c);
}

void choose_letters(cairo_t* c, const DrawnLabel& label, const DrawnRun& run) {
    cairo_select_font_face(c, kFamily, run.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                           label.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, label.size * (run.level == 0 ? 1 : 0.7));
}

double advance(cairo_t* c, const DrawnLabel& label, const DrawnRun& run) {
    choose_letters(c, label, run);
    cairo_text_extents_t e;
    cairo_text_extents(c, run.text.c_str(), &e);
    return e.x_advance;
}

// First all rims, then all letters, so that no rim covers a neighbour.
void draw_label(cairo_t* c, const DrawnGroup& g, const DrawnLabel& label) {
    double width = 0;
    for (const DrawnRun& run : label.text) width += advance(c, label, run);
    const double begin = label.at[0] - width * (label.anchor == Anchor::start    ? 0
                                                : label.anchor == Anchor::middle ? 0.5
                                                                                 : 1);
    for (const bool rim : {true, false}) {
        double x = begin;
        for (const DrawnRun& run : label.text) {
            const double step = advance(c, label, run);
            cairo_move_to(c, x, label.at[1] + run.level * (run.level > 0 ? -0.4 : -0.22) * label.size);
            if (rim) {
                cairo_text_path(c, run.text.c_str());
                cairo_set_source_rgb(c, 1, 1, 1);
                cairo_set_line_width(c, 3);
                cairo_stroke(c);
            } else {
                ink(c, g.colour);
                cairo_show_text(c, run.text.c_str());
            }
            x += step;
        }
    }
}

void draw_group(cairo_t* c, const DrawnGroup& g) {
    cairo_set_line_width(c, g.width);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(c, g.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(c, g.dashes.data(), int(g.dashes.size()), 0);
    if (g.area)
        draw_area(c, g);
    else
        for (const DrawnPath& path : g.paths) draw_path(c, g, path);
    for (const DrawnDisc& disc : g.discs) draw_disc(c, g, disc);
    cairo_set_dash(c, nullptr, 0, 0);
    for (const DrawnLabel& label : g.labels) draw_label(c, g, label);
}

Result<void> paint(cairo_surface_t* surface, const Drawing& d, double scale, bool over = false) {
    const Pen pen(cairo_create(surface), &cairo_destroy);
    cairo_scale(pen.get(), scale, scale);
    if (!over) {
        cairo_set_source_rgb(pen.get(), 1, 1, 1);
        cairo_paint(pen.get());
    }
    for (const DrawnGroup& g : d.groups) draw_group(pen.get(), g);
    cairo_show_page(pen.get());
    const cairo_status_t status = cairo_status(pen.get());
    if (status == CAIRO_STATUS_SUCCESS) return {};
    return refuse(status == CAIRO_STATUS_NO_MEMORY ? RefusalKind::limit : RefusalKind::io, "cairo",
                  cairo_status_to_string(status));
}

}  // namespace

Result<std::string> to_pdf(const Drawing& d) {
    std::string bytes;
    const Sheet surface(
        cairo_pdf_surface_create_for_stream(take, &bytes, kPoint * d.width, kPoint * d.height),
        &cairo_surface_destroy);
    cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_4);
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, d.title.c_str());
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "freiform");
    // When it was made is left out: the same drawing is the same file.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    if (auto ok = paint(surface.get(), d, kPoint); !ok) return std::unexpected(ok.error());
    cairo_surface_finish(surface.get());
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
        return refuse(RefusalKind::io, "pdf", cairo_status_to_string(status));
    return bytes;
}

Result<std::string> to_png(const Drawing& d) {
    const long long pixels = (long long)(d.width) * d.height;
    if (pixels > kMostPixels)
        return refuse(RefusalKind::limit, "size",
                      text(d.width, " x ", d.height, " are ", pixels, " pixels, at most ", kMostPixels));
    const Sheet surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, d.width, d.height),
                        &cairo_surface_destroy);
    if (auto ok = paint(surface.get(), d, 1); !ok) return std::unexpected(ok.error());
    std::string bytes;
    const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), take, &bytes);
    if (status != CAIRO_STATUS_SUCCESS) return refuse(RefusalKind::io, "png", cairo_status_to_string(status));
    return bytes;
}

Result<void> paint_over(Image& picture, const Drawing& d) {
    const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
    if (picture.width != d.width || picture.height != d.height || picture.rgb.size() != 3 * pixels)
        return refuse(RefusalKind::invalid, "size",
                      text("a drawing of ", d.width, " x ", d.height, " over a picture of ", picture.width,
                           " x ", picture.height));
    const Sheet surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, d.width, d.height),
                        &cairo_surface_destroy);
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
        return refuse(RefusalKind::limit, "cairo", cairo_status_to_string(status));
    unsigned char* const bytes = cairo_image_surface_get_data(surface.get());
    const auto stride = std::size_t(cairo_image_surface_get_stride(surface.get()));
    const auto each = [&](const auto& f) {
        for (std::size_t y = 0; y < std::size_t(d.height); ++y)
            for (std::size_t x = 0; x < std::size_t(d.width); ++x)
                f(picture.rgb.data() + 3 * (y * std::size_t(d.width) + x), bytes + y * stride + 4 * x);
    };
    // A pixel of cairo is a 32-bit number, red above green above blue.
    each([](const unsigned char* rgb, unsigned char* at) {
        const std::uint32_t word = std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
        std::memcpy(at, &word, 4);
    });
    cairo_surface_mark_dirty(surface.get());
    if (auto ok = paint(surface.get(), d, 1, true); !ok) return ok;
    cairo_surface_flush(surface.get());
    each([](unsigned char* rgb, const unsigned char* at) {
        std::uint32_t word = 0;
        std::memcpy(&word, at, 4);
        for (int c = 0; c < 3; ++c) rgb[c] = static_cast<unsigned char>(word >> (16 - 8 * c) & 0xff);
    });
    return {};
}

}  // namespace freiform
