// Drawings as PDF and PNG, through cairo.
#pragma once
#include <freiform/core/image.hpp>
#include <freiform/io/paper.hpp>

namespace freiform {

// One page, 96 pixels to the inch; lines stay lines and words words, with their typeface inside the file. The
// same drawing gives the same bytes.
Result<std::string> to_pdf(const Drawing& drawing);

// Smoothed, on white. Refuses (limit) more than 2^26 pixels.
Result<std::string> to_png(const Drawing& drawing);

// The drawing over the picture, which has its size; nothing is put behind it.
Result<void> paint_over(Image& picture, const Drawing& drawing);

}  // namespace freiform
