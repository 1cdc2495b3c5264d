// Words are runs of letters, so that formulas are set as text that can be searched and edited, not as
// outlines. Their widths are only known to whoever has the typeface; where room has to be found before that,
// widths are those of Times and its relatives, whose letters are between 0.25 and 0.9 of their size wide.
#include <freiform/io/paper.hpp>

namespace freiform {

Vec<2> point_at(const Vec<2>& from, const DrawnSegment& s, double t) {
    std::array<Vec<2>, 4> b{from};
    for (int i = 0; i < s.degree; ++i) b[std::size_t(i) + 1] = s.points[std::size_t(i)];
    for (int r = s.degree; r > 0; --r)
        for (std::size_t i = 0; i < std::size_t(r); ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
    return b[0];
}

namespace {

// Bytes of the UTF-8 character that begins here.
std::size_t letter(std::string_view s) {
    std::size_t n = 1;
    while (n < s.size() && (static_cast<unsigned char>(s[n]) & 0xC0) == 0x80) ++n;
    return n;
}

void append(DrawnText& to, std::string_view s, int level, bool italic) {
    if (s.empty()) return;
    if (!to.empty() && to.back().level == level && to.back().italic == italic)
        to.back().text += s;
    else
        to.push_back({std::string(s), level, italic});
}

// Of the letters of one level: asterisks switch italics.
void append_styled(DrawnText& to, std::string_view s, int level, bool& italic) {
    for (;;) {
        const std::size_t star = s.find('*');
        append(to, s.substr(0, star), level, italic);
        if (star == std::string_view::npos) return;
        italic = !italic;
        s.remove_prefix(star + 1);
    }
}

// Of an index or exponent: small letters are italic.
void append_letters(DrawnText& to, std::string_view s, int level) {
    while (!s.empty()) {
        const std::size_t n = letter(s);
        append(to, s.substr(0, n), level, s[0] >= 'a' && s[0] <= 'z');
        s.remove_prefix(n);
    }
}

}  // namespace

DrawnText formula(std::string_view s) {
    DrawnText text;
    bool italic = false;
    while (!s.empty()) {
        const std::size_t mark = s.find_first_of("_^");
        append_styled(text, s.substr(0, mark), 0, italic);
        if (mark == std::string_view::npos) break;
        const int level = s[mark] == '_' ? -1 : 1;
        s.remove_prefix(mark + 1);
        if (s.empty()) break;
        const std::size_t close = s[0] == '{' ? s.find('}') : std::string_view::npos;
        if (close != std::string_view::npos) {
            append_letters(text, s.substr(1, close - 1), level);
            s.remove_prefix(close + 1);
        } else {
            const std::size_t n = letter(s);
            append_letters(text, s.substr(0, n), level);
            s.remove_prefix(n);
        }
    }
    return text;
}

DrawnText plain_text(std::string_view s) {
    if (s.empty()) return {};
    return {{std::string(s), 0, false}};
}

double width_of(const DrawnText& text, double size) {
    double sum = 0;
    for (const DrawnRun& run : text) {
        double width = 0;
        for (std::string_view rest = run.text; !rest.empty(); rest.remove_prefix(letter(rest))) {
            const char c = rest[0];
            const std::string_view narrow = " .,:;'!|()[]ijltfI", wide = "mwMWOQGD@%";
            width += narrow.find(c) != std::string_view::npos ? 0.36
                     : wide.find(c) != std::string_view::npos ? 0.88
                                                              : 0.62;
        }
        sum += width * (run.level == 0 ? 1 : 0.7);
    }
    return sum * size;
}

}  // namespace freiform
