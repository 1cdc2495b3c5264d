// IGES and BREP files, and STEP files where that is wanted, as models, read by a program of its own
// (freiform-occt-import): its library crashes or hangs on a good part of damaged files, and must not take the
// caller along.
#pragma once
#include <freiform/model/model.hpp>

#include <cstddef>
#include <string>

namespace freiform {

struct ImportLimits {
    double seconds = 60;  // of wall clock
    std::size_t memory_bytes = std::size_t(4) << 30;
};

// The model in the file; coordinates in the unit of the file, which Model::unit names. What of the file is
// not in the model stands in Model::refused. Whatever the bytes of the file are, the answer is a model or a
// refusal: unreadable (with the reasons of the reader), limit, no_answer (nothing in it that has a shape),
// io, or unavailable if the program is not installed. It is looked for where the environment variable
// FREIFORM_OCCT_IMPORT says, beside the running program, and where it was installed. Thread-safe.
Result<Model> read_with_occt(const std::string& path, const ImportLimits& limits = {});

}  // namespace freiform
