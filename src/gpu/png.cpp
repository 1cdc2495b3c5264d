#include <freiform/gpu/render.hpp>

#include <png.h>

namespace freiform {

Result<std::string> to_png(const Image& image) {
    if (image.width <= 0 || image.height <= 0 ||
        image.rgb.size() != 3 * std::size_t(image.width) * std::size_t(image.height))
        return refuse(RefusalKind::invalid, "image",
                      text(image.rgb.size(), " bytes for ", image.width, " x ", image.height, " pixels"));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(image.width);
    png.height = png_uint_32(image.height);
    png.format = PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = bytes.size();
    const int written = png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr);
    const std::string message = png.message;
    png_image_free(&png);
    if (!written) return refuse(RefusalKind::io, "png", message);
    bytes.resize(size);
    return bytes;
}

}  // namespace freiform
