// Text from parts, independent of the locale; numbers in the shortest form that reads back to the same bits.
#pragma once
#include <concepts>
#include <span>
#include <string>
#include <string_view>

namespace freiform {

// A part of a text: characters that live elsewhere, or a number. Small enough to be made at every call; what
// is to be done with it is compiled once.
class TextPart {
public:
    TextPart(std::string_view s) : kind_(Kind::characters), characters_(s) {}
    TextPart(const std::string& s) : TextPart(std::string_view(s)) {}
    TextPart(const char* s) : TextPart(std::string_view(s)) {}
    TextPart(char c) : kind_(Kind::character), character_(c) {}
    TextPart(bool b) : TextPart(b ? "true" : "false") {}
    TextPart(double x) : kind_(Kind::real), real_(x) {}
    TextPart(float x) : kind_(Kind::single), single_(x) {}
    template <std::signed_integral T>
    TextPart(T i) : kind_(Kind::integer), integer_(i) {}
    template <std::unsigned_integral T>
    TextPart(T i) : kind_(Kind::natural), natural_(i) {}

    friend void append_text(std::string& s, const TextPart& part);

private:
    enum class Kind : unsigned char { characters, character, integer, natural, real, single };
    Kind kind_;
    union {
        std::string_view characters_;
        char character_;
        long long integer_;
        unsigned long long natural_;
        double real_;
        float single_;
    };
};

void append_text(std::string& s, const TextPart& part);
std::string joined(std::span<const TextPart> parts);

// text("row ", 3, ": ", 0.25)
template <class... Parts>
std::string text(const Parts&... parts) {
    const TextPart list[] = {TextPart(parts)...};
    return joined(list);
}

}  // namespace freiform
