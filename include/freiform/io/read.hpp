// Any file that freiform can read, as a document.
#pragma once
#include <freiform/shape.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace freiform {

enum class FileFormat { json, bpt, step, iges, brep, quake3_bsp, quake3_map, svg, obj, bezierview, rhino };
std::string_view name_of(FileFormat format);

// By the ending of a file name; case does not matter.
std::optional<FileFormat> format_of_name(std::string_view file_name);
// By what the content begins with.
std::optional<FileFormat> format_of_content(std::string_view bytes);

// What reads STEP files: the library (docs/step.md), or Open CASCADE in a process of its own.
enum class StepReader { own, occt };

struct ReadOptions {
    std::optional<FileFormat> format;  // else the ending decides, and where it says nothing, the content
    std::uint64_t max_bytes = std::uint64_t(2) << 30;
    StepReader step_reader = StepReader::own;
    bool repair = false;           // StepReadOptions of the library's own reader
    double repair_limit = 0;       // likewise
    double timeout = 0;            // seconds, 0: none; for the program that reads IGES and BREP
    std::uint64_t max_memory = 0;  // bytes, 0: none; likewise, and for models in STEP files
};

// Of OBJ the free-form objects. "-" is standard input. Every refusal begins with the file name: "teapot.bpt:
// line 7". A STEP, IGES or BREP file becomes a document with one model.
Result<Document> read_any(const std::string& path, const ReadOptions& options = {});

}  // namespace freiform
