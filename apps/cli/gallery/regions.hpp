// What figures of plane regions are made with.
#pragma once
#include "gallery/plot.hpp"

#include <freiform/path/path.hpp>

namespace freiform::cli::gallery {

// The curves of these names, a subpath for each.
Path path_in(const Document& document, std::initializer_list<std::string_view> names);

// The loops of a region as one area with holes, and their outline.
Plot& filled(Plot& plot, const Path& path, const Colour& colour);

}  // namespace freiform::cli::gallery
