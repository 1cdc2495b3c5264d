// Files as a whole: read completely, or replaced completely.
#pragma once
#include <freiform/core/result.hpp>

#include <cstdint>
#if defined(__wasm__)
#include <map>
#endif
#include <string>
#include <string_view>

namespace freiform {

// Replaces the file `path` by `bytes`, whole or not at all: after a refusal, and at every moment before
// success, the old file is as it was and nothing else is left beside it. "-" is standard output; pipes and
// devices are written to directly. A link stays a link, an existing file keeps its permissions. Thread-safe.
Result<void> write_file(const std::string& path, std::string_view bytes);

// The bytes of the file, at most `max_bytes`; "-" is standard input. Refuses what is missing, a directory, or
// larger (kind limit; the message names the number needed, where it is known).
Result<std::string> read_file(const std::string& path, std::uint64_t max_bytes);

// Removes the temporary files of every write_file under way; from then on write_file refuses to replace
// files. For signal handlers of a program that is about to exit: async-signal-safe, whichever thread gets the
// signal.
void remove_unfinished_files() noexcept;

#if defined(__wasm__)
// WebAssembly: there are no other files than these, by name; "-" is what is read as standard input and what
// was written to standard output.
std::map<std::string, std::string>& files_in_memory();
#endif

}  // namespace freiform
