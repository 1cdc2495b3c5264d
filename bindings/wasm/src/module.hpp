// What the parts of the module share: how answers and refusals leave it.
//
// A function of the interface takes numbers and addresses. Memory for its arguments comes from ff_allocate.
// What it has to say beside numbers stands in `reply()`, which lives until the next call; a refusal is handed
// to the page, which throws it, so that a call that returns has an answer. Between a call and its throw
// nothing of C++ is undone: nothing may be alive then that has to be, but memory.
#pragma once
#include <freiform/core/result.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#define FF_EXPORT(name) extern "C" __attribute__((export_name("ff_" #name)))

namespace freiform::wasm {

struct Reply {
    std::string text;             // JSON
    std::vector<double> numbers;  // in the order that the text says
    std::vector<float> floats;
    std::vector<std::uint32_t> indices;
};
Reply& reply();

[[noreturn]] void refuse_to_page(std::string_view kind, std::string_view where, std::string_view message);
[[noreturn]] inline void refuse_to_page(const Refusal& r) {
    refuse_to_page(name_of(r.kind), r.where, r.message);
}
// Whether to go on.
bool progress(double part);

}  // namespace freiform::wasm

namespace CLI {
class App;
}
namespace freiform::cli {
std::string described(const CLI::App& program);  // all commands with their options, as JSON
}
