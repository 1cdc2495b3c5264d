#include "module.hpp"

#include <freiform/spline/prepared.hpp>

#include <cstdarg>
#include <cstdlib>
#include <new>
#include <unistd.h>

namespace freiform::wasm {

namespace {

#define FF_IMPORT(name) __attribute__((import_module("freiform"), import_name(name)))
FF_IMPORT("refuse")
extern "C" void ff_page_refuse(const char* kind, std::size_t kind_size, const char* where,
                               std::size_t where_size, const char* message, std::size_t message_size);
FF_IMPORT("progress") extern "C" int ff_page_progress(double part);
#undef FF_IMPORT

}  // namespace

Reply& reply() {
    static Reply all;
    return all;
}

void refuse_to_page(std::string_view kind, std::string_view where, std::string_view message) {
    ff_page_refuse(kind.data(), kind.size(), where.data(), where.size(), message.data(), message.size());
    std::abort();  // the page has thrown
}

bool progress(double part) { return ff_page_progress(part) != 0; }

}  // namespace freiform::wasm

// The last words of the C++ library, without printf, which nothing else asks for.
namespace {

[[noreturn]] void end_with_words(std::string_view format, va_list words) {
    std::string said;
    for (std::size_t i = 0; i < format.size(); ++i) {
        const bool is_word = format.substr(i, 2) == "%s";
        if (is_word)
            said += va_arg(words, const char*), ++i;
        else
            said += format[i];
    }
    ::write(STDERR_FILENO, said.data(), said.size());
    std::abort();
}

}  // namespace

_LIBCPP_BEGIN_NAMESPACE_STD
void __libcpp_verbose_abort(const char* format, ...) noexcept {
    va_list words;
    va_start(words, format);
    end_with_words(format, words);
}
_LIBCPP_END_NAMESPACE_STD
extern "C" void __abort_message(const char* format, ...) {
    va_list words;
    va_start(words, format);
    end_with_words(format, words);
}

using freiform::wasm::reply;

FF_EXPORT(start) void ff_start() {
    std::set_new_handler([] {
        freiform::wasm::refuse_to_page("limit", "", "more memory is needed than the module can have");
    });
}

FF_EXPORT(allocate) void* ff_allocate(std::size_t bytes) { return ::operator new(bytes); }
FF_EXPORT(release) void ff_release(void* memory) { ::operator delete(memory); }

FF_EXPORT(text) const char* ff_text() { return reply().text.data(); }
FF_EXPORT(text_size) std::size_t ff_text_size() { return reply().text.size(); }
FF_EXPORT(numbers) const double* ff_numbers() { return reply().numbers.data(); }
FF_EXPORT(numbers_size) std::size_t ff_numbers_size() { return reply().numbers.size(); }
FF_EXPORT(floats) const float* ff_floats() { return reply().floats.data(); }
FF_EXPORT(floats_size) std::size_t ff_floats_size() { return reply().floats.size(); }
FF_EXPORT(indices) const std::uint32_t* ff_indices() { return reply().indices.data(); }
FF_EXPORT(indices_size) std::size_t ff_indices_size() { return reply().indices.size(); }

FF_EXPORT(about) void ff_about() {
    reply().text = freiform::text(FREIFORM_VERSION " ", freiform::instruction_set());
}
