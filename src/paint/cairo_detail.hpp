// What drawings and gradient meshes need of cairo.
#pragma once
#include <cairo-pdf.h>
#include <cairo.h>
#include <memory>
#include <string>

namespace freiform::detail {

using Sheet = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Pen = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

// Bytes from cairo. What it calls is C: nothing may be thrown through it.
inline cairo_status_t take(void* to, const unsigned char* bytes, unsigned n) noexcept {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), n);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace freiform::detail
