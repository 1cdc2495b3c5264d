#include <freiform/io/bezierview.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/exchange.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/io/quake3.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/rhino_read.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/io/svg.hpp>

#include <algorithm>
#include <strings.h>
#if !defined(__wasm__)
#include <cerrno>
#include <filesystem>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace freiform {

namespace {

#if defined(__wasm__)
constexpr std::string_view kKnown =
    ".json, .bpt, .step (.stp), .iges (.igs), .brep (.brp), .svg, .obj, .bsp, .map";
#else
constexpr std::string_view kKnown =
    ".json, .bpt, .bv, .3dm, .step (.stp), .iges (.igs), .brep (.brp), .svg, .obj, .bsp, .map";
#endif

}  // namespace

std::string_view name_of(FileFormat format) {
    static constexpr std::string_view kNames[] = {"json", "bpt", "step", "iges", "brep", "bsp",
                                                  "map",  "svg", "obj",  "bv",   "3dm"};
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
    if (ending == "bsp") return FileFormat::quake3_bsp;
    if (ending == "map") return FileFormat::quake3_map;
    if (ending == "svg") return FileFormat::svg;
    if (ending == "obj") return FileFormat::obj;
#if !defined(__wasm__)  // the module, which is loaded over a network, does without them
    if (ending == "3dm") return FileFormat::rhino;
    if (ending == "bv") return FileFormat::bezierview;
#endif
    return std::nullopt;
}

std::optional<FileFormat> format_of_content(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return std::nullopt;
    const std::string_view s = bytes.substr(first);
    if (s.starts_with("<svg") || (s.starts_with("<?xml") && s.substr(0, 4096).find("<svg") != s.npos))
        return FileFormat::svg;
#if !defined(__wasm__)
    if (s.starts_with("3D Geometry File Format ")) return FileFormat::rhino;
#endif
    if (s.starts_with("IBSP")) return FileFormat::quake3_bsp;
    if (s[0] == '{' || s[0] == '[') return FileFormat::json;
    if (s.starts_with("ISO-10303-21")) return FileFormat::step;
    if (s.starts_with("DBRep_DrawableShape") || s.starts_with("CASCADE Topology")) return FileFormat::brep;
    if (bytes.size() > 72 && bytes[72] == 'S' && bytes.find('\n') >= 73) return FileFormat::iges;
    if (s[0] == '#' || (s[0] >= '0' && s[0] <= '9')) return FileFormat::bpt;
    return std::nullopt;
}

namespace {

// What the program of its own reads.
bool is_exchange(FileFormat f, const ReadOptions& options) {
    return (f == FileFormat::step && options.step_reader == StepReader::occt) || f == FileFormat::iges ||
           f == FileFormat::brep;
}

Document document_with(Model model) {
    Document document;
    document.unit = model.unit;
    document.objects.push_back({"", std::move(model), {}});
    return document;
}

// The file at a path from the folder of another one, which names it: no pipe or device. Programs that do not
// tell capital letters from small ones write names so, too: where there is none, one that differs in them
// alone.
Result<std::string> read_beside(const std::string& file, const std::string& path, std::uint64_t max_bytes) {
    std::string whole = file.substr(0, file.rfind('/') + 1) + path;
#if !defined(__wasm__)
    namespace fs = std::filesystem;
    std::error_code error;
    if (!fs::exists(whole, error)) {
        const std::size_t name = whole.rfind('/') + 1;
        const std::string folder = name > 0 ? whole.substr(0, name) : "./";
        for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
            if (::strcasecmp(at->path().filename().c_str(), whole.c_str() + name) == 0) {
                whole = at->path().string();
                break;
            }
    }
    if (fs::exists(whole, error) && !fs::is_regular_file(whole, error))
        return refuse(RefusalKind::io, whole, "cannot be read: it is no file with bytes of its own");
#else
    if (!files_in_memory().contains(whole))
        for (const auto& [other, bytes] : files_in_memory())
            if (::strcasecmp(other.c_str(), whole.c_str()) == 0) {
                whole = other;
                break;
            }
#endif
    return read_file(whole, max_bytes);
}

// STEP, and what is read as such; `path`: of the file, whose parts may be in others beside it.
Result<Document> read_model(std::string_view bytes, const std::string& path,
                            [[maybe_unused]] FileFormat format, const ReadOptions& options) {
    StepReadOptions limits;
    if (path != "-")
        limits.open = [&](const std::string& other) { return read_beside(path, other, options.max_bytes); };
    if (options.max_memory > 0) limits.memory_bytes = options.max_memory;
    limits.repair = options.repair, limits.repair_limit = options.repair_limit;
#if defined(__wasm__)
    auto model = read_step(bytes, limits);
#else
    auto model = format == FileFormat::step ? read_step(bytes, limits) : read_3dm(bytes, limits);
#endif
    if (!model) return std::unexpected(model.error());
    return document_with(std::move(*model));
}

Result<Document> import(const std::string& path, const ReadOptions& options) {
    ImportLimits limits;
    if (options.timeout > 0) limits.seconds = options.timeout;
    if (options.max_memory > 0) limits.memory_bytes = std::size_t(options.max_memory);
    auto model = read_with_occt(path, limits);
    if (!model) return std::unexpected(model.error());
    return document_with(std::move(*model));
}

#if defined(__wasm__)

Result<Document> import_bytes(std::string_view, const ReadOptions& options) { return import("", options); }

#else

// The reader of these formats wants a file: one without a name, which is gone when the process is.
Result<Document> import_bytes(std::string_view bytes, const ReadOptions& options) {
    const int fd = ::memfd_create("freiform", MFD_CLOEXEC);
    if (fd < 0) return refuse(RefusalKind::io, "", "standard input cannot be kept in memory");
    const std::string name = text("/proc/", ::getpid(), "/fd/", fd);
    bool kept = true;
    for (std::string_view rest = bytes; kept && !rest.empty();) {
        const ssize_t n = ::write(fd, rest.data(), rest.size());
        kept = n > 0 || (n < 0 && errno == EINTR);
        if (n > 0) rest.remove_prefix(std::size_t(n));
    }
    auto document =
        kept ? import(name, options)
             : Result<Document>(refuse(RefusalKind::io, "", "standard input cannot be kept in memory"));
    ::close(fd);
    if (!document) {
        Refusal r = document.error();
        if (r.where.starts_with(name)) r.where.erase(0, name.size());
        return std::unexpected(std::move(r));
    }
    return document;
}

#endif

Result<Document> read_svg_document(std::string_view bytes) {
    const auto picture = read_svg(bytes);
    if (!picture) return std::unexpected(picture.error());
    return document_of(*picture);
}

// The file as part of the place, once.
Result<Document> within(const std::string& label, Result<Document> document) {
    if (document) return document;
    Refusal r = document.error();
    if (!r.where.starts_with(label)) r.where = r.where.empty() ? label : text(label, ": ", r.where);
    return std::unexpected(std::move(r));
}

}  // namespace

Result<Document> read_any(const std::string& path, const ReadOptions& options) {
    const std::string label = path == "-" ? "standard input" : path;
    auto format = options.format ? options.format : format_of_name(path);
    if (format && is_exchange(*format, options) && path != "-") return within(label, import(path, options));
    auto bytes = read_file(path, options.max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    if (!format) format = format_of_content(*bytes);
    if (!format)
        return refuse(RefusalKind::unreadable, label,
                      bytes->empty()
                          ? "the file is empty"
                          : text("neither its name nor its content says a format that is known: ", kKnown));
    if (is_exchange(*format, options))
        return within(label, path == "-" ? import_bytes(*bytes, options) : import(path, options));
#if !defined(__wasm__)
    if (*format == FileFormat::rhino) return within(label, read_model(*bytes, path, *format, options));
    if (*format == FileFormat::bezierview) return within(label, read_bezierview(*bytes));
#endif
    return within(label, *format == FileFormat::json         ? read_document(*bytes)
                         : *format == FileFormat::quake3_bsp ? read_quake3_bsp(*bytes)
                         : *format == FileFormat::quake3_map ? read_quake3_map(*bytes)
                         : *format == FileFormat::step       ? read_model(*bytes, path, *format, options)
                         : *format == FileFormat::svg        ? read_svg_document(*bytes)
                         : *format == FileFormat::obj        ? read_obj_freeform(*bytes)
                                                             : read_bpt(*bytes));
}

}  // namespace freiform
