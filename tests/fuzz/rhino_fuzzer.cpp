// Any bytes as a 3DM file: a model whose indices hold, or a refusal that says something.
#include "bytes.hpp"

#include <freiform/io/rhino_read.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace freiform;
    StepReadOptions options;
    options.memory_bytes = 64 << 20;
    options.repair = size % 2 == 1;
    const auto model = read_3dm({reinterpret_cast<const char*>(data), size}, options);
    if (model)
        demand(make_model(*model).has_value());
    else
        demand(!model.error().message.empty());
    return 0;
}
