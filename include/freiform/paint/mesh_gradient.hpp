// Gradient meshes as PDF, and pictures of pixels as PNG, through cairo.
#pragma once
#include <freiform/colour/mesh_gradient.hpp>
#include <freiform/core/image.hpp>

namespace freiform {

// One page that shows the box, y up, so many points (1/72 inch) wide: shadings of type 7, which keep their
// curves. Refuses boxes without area.
Result<std::string> to_pdf(std::span<const MeshGradient::Piece> pieces, const Box<2>& box,
                           double points_wide);

Result<std::string> png_of(const Image& image);

}  // namespace freiform
