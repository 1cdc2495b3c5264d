#include "page.hpp"

#include <freiform/io/file.hpp>

#include <filesystem>

namespace freiform::cli {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t(64) << 20;  // of a file of the page
constexpr std::size_t kMostFiles = 10000;

std::string_view type_of(std::string_view path) {
    static constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".webmanifest", "application/manifest+json"},
        {".wasm", "application/wasm"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".txt", "text/plain; charset=utf-8"}};
    for (const auto& [ending, type] : kTypes)
        if (path.ends_with(ending)) return type;
    return "application/octet-stream";
}

}  // namespace

Result<Page> Page::open(const std::string& folder) {
    Page page;
    if (folder.empty()) {
        for (const EmbeddedFile& f : embedded_page()) page.inside_.emplace(f.path, f.bytes);
        if (page.inside_.empty())
            return refuse(
                RefusalKind::unavailable, "view",
                "this program was built without its page: run make studio and build again, or say with "
                "--page where studio/dist is");
        return page;
    }
    namespace fs = std::filesystem;
    std::error_code failed;
    for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
         at.increment(failed)) {
        if (at->is_symlink() || !at->is_regular_file()) continue;
        page.on_disk_.emplace("/" + at->path().lexically_relative(folder).generic_string(),
                              at->path().string());
        if (page.on_disk_.size() > kMostFiles)
            return refuse(RefusalKind::limit, folder,
                          text("has more than ", kMostFiles, " files: this is no page"));
    }
    if (failed) return refuse(RefusalKind::io, folder, text("cannot be read: ", failed.message()));
    if (!page.on_disk_.contains("/index.html"))
        return refuse(RefusalKind::io, folder, "there is no index.html in it");
    return page;
}

Result<Page::File> Page::file(const std::string& path) const {
    const std::string name = path == "/" ? "/index.html" : path;
    if (const auto found = inside_.find(name); found != inside_.end())
        return File{std::string(type_of(name)), std::string(found->second)};
    if (const auto found = on_disk_.find(name); found != on_disk_.end()) {
        auto bytes = read_file(found->second, kMostBytes);
        if (!bytes) return std::unexpected(bytes.error());
        return File{std::string(type_of(name)), *std::move(bytes)};
    }
    return refuse(RefusalKind::no_answer, path, "the page has no such file");
}

}  // namespace freiform::cli
