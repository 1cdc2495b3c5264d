// The files of src/gpu/glsl, which the build puts into the library.
#pragma once
#include <string_view>

namespace freiform {

// REQUIRES the name of a file.
std::string_view glsl(std::string_view name);

}  // namespace freiform
