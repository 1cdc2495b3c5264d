// The page that `view` serves: the files of studio/dist, from a folder or from inside of the program.
#pragma once
#include <freiform/core/result.hpp>

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace freiform::cli {

class Page {
public:
    // Without a folder: what the program was built with. Refuses (unavailable) if there is nothing, and (io)
    // a folder without index.html.
    static Result<Page> open(const std::string& folder);

    struct File {
        std::string type;  // "text/html; charset=utf-8"
        std::string bytes;
    };
    // "/assets/index.js"; "/" is "/index.html". Refuses (no_answer) what the page does not have: only files
    // that were there when it was opened, so that no path leads out of the folder.
    Result<File> file(const std::string& path) const;

private:
    std::map<std::string, std::string_view> inside_;  // by path
    std::map<std::string, std::string> on_disk_;      // path to file name
};

// What was put into the program: paths and bytes.
struct EmbeddedFile {
    std::string_view path, bytes;
};
std::span<const EmbeddedFile> embedded_page();

}  // namespace freiform::cli
