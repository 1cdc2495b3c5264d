#include <freiform/core/text.hpp>

#include <charconv>

namespace freiform {

void append_text(std::string& s, const TextPart& part) {
    char buffer[40];
    const auto number = [&](auto x) {
        s.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr);
    };
    switch (part.kind_) {
        case TextPart::Kind::characters:
            s += part.characters_;
            break;
        case TextPart::Kind::character:
            s += part.character_;
            break;
        case TextPart::Kind::integer:
            number(part.integer_);
            break;
        case TextPart::Kind::natural:
            number(part.natural_);
            break;
        case TextPart::Kind::real:
            number(part.real_);
            break;
        case TextPart::Kind::single:
            number(part.single_);
            break;
    }
}

std::string joined(std::span<const TextPart> parts) {
    std::string s;
    for (const TextPart& part : parts) append_text(s, part);
    return s;
}

}  // namespace freiform
