#include "drawing_bytes.hpp"

#if FREIFORM_HAS_CAIRO
#include <freiform/paint/paint.hpp>
#endif

namespace freiform::cli {

Result<std::string> drawing_bytes(const Drawing& drawing, const std::string& format,
                                  [[maybe_unused]] const std::string& command) {
    if (format == "svg") return to_svg(drawing);
#if FREIFORM_HAS_CAIRO
    return format == "pdf" ? to_pdf(drawing) : to_png(drawing);
#else
    return refuse(RefusalKind::unavailable, command,
                  text("this program was built without .", format,
                       " of drawings: install libcairo2-dev and build again, or write .svg"));
#endif
}

}  // namespace freiform::cli
