// Text goes out as it comes in, with commas and line ends where they belong; numbers in the shortest form
// that reads back to the same bits, and what JSON has no number for as null.
#include <freiform/core/utf8.hpp>
#include <freiform/io/json.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::json {

void Writer::separate() {
    if (!first_) text_ += ',';
    if (indent_ >= 0) {
        text_ += '\n';
        text_.append(std::size_t(indent_), ' ');
        indent_ = -1;
    }
    first_ = false;
}
Writer& Writer::open(char c) {
    separate();
    text_ += c;
    first_ = true;
    return *this;
}
Writer& Writer::close(char c) {
    if (indent_ >= 0) {
        text_ += '\n';
        text_.append(std::size_t(indent_), ' ');
        indent_ = -1;
    }
    text_ += c;
    first_ = false;
    return *this;
}
Writer& Writer::new_line(int indent) {
    indent_ = indent;
    return *this;
}
Writer& Writer::key(std::string_view name) {
    const bool spaced = !first_ && indent_ < 0;
    separate();
    if (spaced) text_ += ' ';
    text_ += '"';
    text_ += name;
    text_ += "\": ";
    first_ = true;
    return *this;
}
Writer& Writer::null() {
    separate();
    text_ += "null";
    return *this;
}
Writer& Writer::value(double number) {
    if (!std::isfinite(number)) return null();
    separate();
    append_text(text_, number);
    return *this;
}
Writer& Writer::value(std::string_view s) {
    separate();
    text_ += '"';
    for (std::size_t i = 0; i < s.size();) {
        const auto c = static_cast<unsigned char>(s[i]);
        const std::size_t length = utf8_length(s.substr(i));
        if (length == 0) {
            text_ += "\xEF\xBF\xBD";
        } else if (c == '"' || c == '\\') {
            text_ += {'\\', char(c)};
        } else if (c == '\n') {
            text_ += "\\n";
        } else if (c == '\t') {
            text_ += "\\t";
        } else if (c < 0x20) {
            text_ += "\\u00";
            text_ += {"0123456789abcdef"[c >> 4], "0123456789abcdef"[c & 15]};
        } else {
            text_ += s.substr(i, length);
        }
        i += std::max<std::size_t>(length, 1);
    }
    text_ += '"';
    return *this;
}

}  // namespace freiform::json
