// Paths as Python holds them.
#pragma once

#include "handles.hpp"

#include <freiform/path/path.hpp>

namespace freiform::python {

struct PathHandle {
    std::shared_ptr<const Path> path;
};
template <>
struct Wrapped<Path> {
    static py::object object(const Path& p) {
        return in_class("freiform._paths", "Path", PathHandle{std::make_shared<const Path>(p)});
    }
};

}  // namespace freiform::python
