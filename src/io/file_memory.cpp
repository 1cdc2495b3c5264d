// Files where there is no disk: a module in a page has only what it was given.
#if defined(__wasm__)
#include <freiform/io/file.hpp>

namespace freiform {

std::map<std::string, std::string>& files_in_memory() {
    static std::map<std::string, std::string> files;
    return files;
}

Result<void> write_file(const std::string& path, std::string_view bytes) {
    if (path.empty() || path.find('\0') != std::string::npos)
        return refuse(RefusalKind::io, path, "not a file name");
    std::string& file = files_in_memory()[path];
    if (path == "-")
        file += bytes;
    else
        file = bytes;
    return {};
}

Result<std::string> read_file(const std::string& path, std::uint64_t max_bytes) {
    const std::string where = path == "-" ? "standard input" : path;
    const auto found = files_in_memory().find(path);
    if (found == files_in_memory().end())
        return refuse(RefusalKind::io, where, "cannot be read: No such file or directory");
    if (found->second.size() > max_bytes)
        return refuse(RefusalKind::limit, where,
                      text("has ", found->second.size(), " bytes, the limit is ", max_bytes));
    std::string bytes = found->second;
    if (path == "-") files_in_memory().erase(found);  // read once, as a pipe is
    return bytes;
}

void remove_unfinished_files() noexcept {}

}  // namespace freiform
#endif
