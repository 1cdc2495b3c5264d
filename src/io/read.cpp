#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>

#include <algorithm>

namespace freiform {

namespace {

constexpr std::string_view kKnown = ".json, .bpt, .step (.stp), .iges (.igs), .brep (.brp)";

}  // namespace

std::string_view name_of(FileFormat format) {
    static constexpr std::string_view kNames[] = {"json", "bpt", "step", "iges", "brep"};
    return kNames[int(format)];
}

std::optional<FileFormat> format_of_name(std::string_view name) {
    const std::size_t dot = name.rfind('.'), slash = name.rfind('/');
    if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash))
        return std::nullopt;
    std::string ending(name.substr(dot + 1));
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    if (ending == "json") return FileFormat::json;
    if (ending == "bpt") return FileFormat::bpt;
    if (ending == "step" || ending == "stp" || ending == "p21") return FileFormat::step;
    if (ending == "iges" || ending == "igs") return FileFormat::iges;
    if (ending == "brep" || ending == "brp") return FileFormat::brep;
    return std::nullopt;
}

std::optional<FileFormat> format_of_content(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return std::nullopt;
    const std::string_view s = bytes.substr(first);
    if (s[0] == '{' || s[0] == '[') return FileFormat::json;
    if (s.starts_with("ISO-10303-21")) return FileFormat::step;
    if (s.starts_with("DBRep_DrawableShape") || s.starts_with("CASCADE Topology")) return FileFormat::brep;
    if (bytes.size() > 72 && bytes[72] == 'S' && bytes.find('\n') >= 73) return FileFormat::iges;
    if (s[0] == '#' || (s[0] >= '0' && s[0] <= '9')) return FileFormat::bpt;
    return std::nullopt;
}

Result<Document> read_any(const std::string& path, const ReadOptions& options) {
    const std::string label = path == "-" ? "standard input" : path;
    auto format = options.format ? options.format : format_of_name(path);
    auto bytes = read_file(path, options.max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    if (!format) format = format_of_content(*bytes);
    if (!format)
        return refuse(RefusalKind::unreadable, label,
                      bytes->empty()
                          ? "the file is empty"
                          : text("neither its name nor its content says a format that is known: ", kKnown));
    auto document =
        *format == FileFormat::json ? read_document(*bytes)
        : *format == FileFormat::bpt
            ? read_bpt(*bytes)
            : Result<Document>(refuse(RefusalKind::unavailable, "",
                                      text("this build has no reader for ", name_of(*format), " files")));
    if (!document) {
        Refusal r = document.error();
        r.where = r.where.empty() ? label : text(label, ": ", r.where);
        return std::unexpected(std::move(r));
    }
    return document;
}

}  // namespace freiform
