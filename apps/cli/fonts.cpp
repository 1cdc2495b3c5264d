#include "fonts.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/file.hpp>

#include <filesystem>

namespace freiform::cli {

#if FREIFORM_HAS_FONT

Result<Font> read_font(const Context& context, const FontArguments& options) {
    FontOptions how;
    for (std::string_view all : options.axes)
        while (!all.empty()) {
            const std::string_view one = next_part(all, ',');
            const std::size_t equals = one.find('=');
            const auto value =
                equals == one.npos ? std::nullopt : scan_number<double>(one.substr(equals + 1));
            if (!value)
                wrong_usage(text("--axis needs a tag and a value, as in wght=700, found \"", one, "\""));
            how.axes.push_back({std::string(one.substr(0, equals)), *value});
        }
    std::string path = options.font;
    std::error_code none;
    if (path != "-" && !std::filesystem::exists(path, none)) {
        const auto found = font_file(path);
        if (!found) return std::unexpected(found.error());
        path = found->path, how.face = found->face;
    }
    if (options.face) how.face = *options.face;
    auto bytes = read_file(path, context.read_options().max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    auto font = Font::parse(*std::move(bytes), how);
    if (font) return font;
    Refusal r = font.error();
    r.where = text(shown(path), r.where.empty() ? "" : ": ", r.where);
    return std::unexpected(std::move(r));
}

#endif

}  // namespace freiform::cli
