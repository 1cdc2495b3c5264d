// Any bytes as a drawing: read or refused; what is read is written and read again.
#include <freiform/io/svg.hpp>

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace freiform;
    const auto picture = read_svg({reinterpret_cast<const char*>(data), size});
    if (!picture) return 0;
    const Document document = document_of(*picture);
    const auto again = read_svg(write_svg(*picture));
    if (!again || again->shapes.size() != picture->shapes.size()) std::abort();
    return document.objects.size() > picture->shapes.size() + size ? (std::abort(), 0) : 0;
}
