// The commands of the program, with files in memory.
#include "module.hpp"

#include <freiform/io/file.hpp>

#include <program.hpp>
#include <signals.hpp>

namespace freiform::cli {

namespace {
std::string& remarks() {
    static std::string all;
    return all;
}
}  // namespace

void wrong_usage(const std::string& message) { wasm::refuse_to_page("usage", "", message); }

Result<void> emit(const Context& context, std::string_view bytes) {
    return write_file(context.output.empty() ? "-" : context.output, bytes);
}

void enforce(const Context&) {}  // the page ends a worker that takes too long

void remark(std::string_view message) { remarks() += text("freiform: ", message, "\n"); }

}  // namespace freiform::cli

using namespace freiform;
using wasm::reply;

// A file for the next command, or one that it has made.
FF_EXPORT(put_file)
void ff_put_file(const char* name, std::size_t name_size, const char* bytes, std::size_t size) {
    files_in_memory()[{name, name_size}].assign(bytes, size);
}

// Arguments end with a zero each. The answer is the exit code; reply: what is said beside the answer.
FF_EXPORT(command) int ff_command(const char* arguments, std::size_t size) {
    std::vector<std::string> all;
    for (std::string_view rest{arguments, size}; !rest.empty();) {
        all.emplace_back(rest.substr(0, rest.find('\0')));
        rest.remove_prefix(all.back().size() + 1);
    }
    cli::remarks().clear();
    const int code = cli::run(std::move(all));
    reply().text = cli::remarks();
    return code;
}

// reply: the names of all files, a line for each; "-" is standard output.
FF_EXPORT(files) void ff_files() {
    reply().text.clear();
    for (const auto& [name, bytes] : files_in_memory()) reply().text += name + "\n";
}
// reply: the file, which is gone then.
FF_EXPORT(take_file) void ff_take_file(const char* name, std::size_t size) {
    const auto found = files_in_memory().find({name, size});
    reply().text.clear();
    if (found == files_in_memory().end()) return;
    reply().text = std::move(found->second);
    files_in_memory().erase(found);
}
FF_EXPORT(clear_files) void ff_clear_files() { files_in_memory().clear(); }
