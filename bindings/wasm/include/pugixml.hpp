// XML as far as drawings need it, with the names of pugixml, whose compiled library is not there for
// WebAssembly: elements, attributes, text and CDATA of UTF-8; comments, instructions and the document type
// are passed over.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pugi {

enum xml_node_type { node_null, node_document, node_element, node_pcdata };

namespace detail {
struct Attribute {
    const char *name = "", *value = "";
};
struct Node {
    xml_node_type type = node_null;
    const char *name = "", *value = "";
    std::ptrdiff_t offset = -1;
    std::uint32_t parent = 0, first = 0, last = 0, next = 0;  // 0: none
    std::uint32_t attribute = 0, attributes = 0;
};
}  // namespace detail

class xml_attribute {
public:
    explicit xml_attribute(const detail::Attribute* a = nullptr) : a_(a) {}
    explicit operator bool() const { return a_ != nullptr; }
    const char* name() const { return a_ ? a_->name : ""; }
    const char* value() const { return a_ ? a_->value : ""; }

private:
    const detail::Attribute* a_;
};

class xml_document;

class xml_node {
public:
    xml_node() = default;
    xml_node(const xml_document* document, std::uint32_t index) : document_(document), index_(index) {}
    explicit operator bool() const { return index_ != 0; }
    friend bool operator==(const xml_node& a, const xml_node& b) { return a.index_ == b.index_; }

    inline const detail::Node& node() const;
    xml_node_type type() const { return node().type; }
    const char* name() const { return node().name; }
    const char* value() const { return node().value; }
    std::ptrdiff_t offset_debug() const { return node().offset; }
    xml_node parent() const { return {document_, node().parent}; }
    xml_node first_child() const { return {document_, node().first}; }
    xml_node next_sibling() const { return {document_, node().next}; }
    inline std::vector<xml_attribute> attributes() const;
    inline xml_attribute attribute(const char* called) const;
    std::vector<xml_node> children() const {
        std::vector<xml_node> all;
        for (xml_node n = first_child(); n; n = n.next_sibling()) all.push_back(n);
        return all;
    }

private:
    const xml_document* document_ = nullptr;
    std::uint32_t index_ = 0;
};

struct xml_parse_result {
    const char* problem = nullptr;
    std::ptrdiff_t offset = 0;
    explicit operator bool() const { return problem == nullptr; }
    const char* description() const { return problem ? problem : "No error"; }
};

class xml_document {
public:
    // The bytes are copied; names and values are pieces of the copy, each ended by a zero in place of what
    // followed it.
    inline xml_parse_result load_buffer(const void* bytes, std::size_t size);
    xml_node document_element() const {
        for (xml_node n(this, nodes_.empty() ? 0 : nodes_[1].first); n; n = n.next_sibling())
            if (n.type() == node_element) return n;
        return {};
    }

private:
    friend class xml_node;
    class Parser;
    std::string text_;
    std::vector<detail::Node> nodes_;  // [0] is none, [1] the document
    std::vector<detail::Attribute> attributes_;
    std::vector<std::unique_ptr<std::string>> kept_;
};

inline const detail::Node& xml_node::node() const {
    static const detail::Node none;
    return index_ == 0 ? none : document_->nodes_[index_];
}
inline std::vector<xml_attribute> xml_node::attributes() const {
    std::vector<xml_attribute> all;
    for (std::uint32_t i = 0; i < node().attributes; ++i)
        all.emplace_back(&document_->attributes_[node().attribute + i]);
    return all;
}
inline xml_attribute xml_node::attribute(const char* called) const {
    for (const xml_attribute& a : attributes())
        if (std::strcmp(a.name(), called) == 0) return a;
    return xml_attribute();
}

class xml_document::Parser {
public:
    explicit Parser(xml_document& d)
        : d_(d), begin_(d.text_.data()), p_(begin_), end_(begin_ + d.text_.size()) {}

    xml_parse_result parse() {
        if (starts("\xEF\xBB\xBF")) p_ += 3;
        if (std::memchr(begin_, 0, d_.text_.size())) return wrong("a zero byte, as UTF-16 has");
        d_.nodes_ = {{}, {node_document, "", "", 0}};
        while (p_ < end_) {
            const char* problem = *p_ == '<' ? markup() : characters();
            if (problem) return wrong(problem);
        }
        if (open_ != 1) return wrong("Start-end tags mismatch");
        if (!d_.document_element()) return wrong("No document element found");
        return {};
    }

private:
    xml_parse_result wrong(const char* problem) const { return {problem, p_ - begin_}; }
    bool starts(std::string_view s) const {
        return std::string_view(p_, std::size_t(end_ - p_)).starts_with(s);
    }
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
    static bool is_name(char c) {
        return static_cast<unsigned char>(c) >= 0x80 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               (c >= '0' && c <= '9') || c == ':' || c == '_' || c == '-' || c == '.';
    }
    void skip_spaces() {
        while (p_ < end_ && is_space(*p_)) ++p_;
    }
    bool skip_past(std::string_view s) {
        const std::size_t at = std::string_view(p_, std::size_t(end_ - p_)).find(s);
        if (at == std::string_view::npos) return false;
        p_ += at + s.size();
        return true;
    }
    char* name() {
        char* first = p_;
        while (p_ < end_ && is_name(*p_)) ++p_;
        return first;
    }
    // The string has a zero behind its last character.
    static char* after(char* end) {
        *end = 0;
        return end + 1;
    }

    std::uint32_t add(xml_node_type type, std::ptrdiff_t offset) {
        const auto index = std::uint32_t(d_.nodes_.size());
        detail::Node n;
        n.type = type, n.parent = open_, n.offset = offset;
        n.attribute = std::uint32_t(d_.attributes_.size());
        d_.nodes_.push_back(n);
        detail::Node& parent = d_.nodes_[open_];
        (parent.last == 0 ? parent.first : d_.nodes_[parent.last].next) = index;
        parent.last = index;
        return index;
    }

    const char* markup() {
        if (starts("<!--")) return p_ += 4, skip_past("-->") ? nullptr : "Error parsing comment";
        if (starts("<?"))
            return skip_past("?>") ? nullptr : "Error parsing document declaration/processing instruction";
        if (starts("<![CDATA[")) return cdata();
        if (starts("<!")) return document_type();
        if (starts("</")) return end_tag();
        return start_tag();
    }

    const char* document_type() {
        for (int depth = 0; p_ < end_; ++p_) {
            if (*p_ == '"' || *p_ == '\'') {
                const char quote = *p_;
                do ++p_;
                while (p_ < end_ && *p_ != quote);
                if (p_ == end_) break;
            } else if (*p_ == '<' || *p_ == '[') {
                ++depth;
            } else if (*p_ == '>' || *p_ == ']') {
                if (--depth == 0) return ++p_, nullptr;
            }
        }
        return "Error parsing document type declaration";
    }

    const char* cdata() {
        p_ += 9;
        char* first = p_;
        if (!skip_past("]]>")) return "Error parsing CDATA section";
        if (open_ == 1) return "Error parsing CDATA section";
        d_.nodes_[add(node_pcdata, first - begin_)].value = first;
        *lines(first, p_ - 3) = 0;
        return nullptr;
    }

    const char* end_tag() {
        p_ += 2;
        char* first = name();
        const std::string_view called(first, std::size_t(p_ - first));
        if (open_ == 1 || called != d_.nodes_[open_].name) return "Start-end tags mismatch";
        skip_spaces();
        if (p_ == end_ || *p_ != '>') return "Error parsing end element tag";
        ++p_;
        open_ = d_.nodes_[open_].parent;
        return nullptr;
    }

    const char* start_tag() {
        char* first = ++p_;
        name();
        if (p_ == first || p_ == end_) return "Error parsing start element tag";
        const std::uint32_t element = add(node_element, first - begin_);
        d_.nodes_[element].name = first;
        char* name_end = p_;
        for (;;) {
            const bool apart = is_space(*p_);
            skip_spaces();
            if (p_ == end_) return "Error parsing start element tag";
            if (*p_ == '>' || starts("/>")) {
                const bool empty = *p_ == '/';
                p_ += empty ? 2 : 1;
                *name_end = 0;
                if (!empty) open_ = element;
                return nullptr;
            }
            if (!apart) return "Error parsing start element tag";
            detail::Attribute a;
            if (const char* problem = attribute(a)) return problem;
            d_.attributes_.push_back(a);
            ++d_.nodes_[element].attributes;
        }
    }

    const char* attribute(detail::Attribute& a) {
        constexpr const char* kWrong = "Error parsing element attribute";
        char* first = name();
        char* name_end = p_;
        if (p_ == first) return kWrong;
        skip_spaces();
        if (p_ == end_ || *p_ != '=') return kWrong;
        ++p_;
        skip_spaces();
        if (p_ == end_ || (*p_ != '"' && *p_ != '\'')) return kWrong;
        const char quote = *p_++;
        char* value = p_;
        while (p_ < end_ && *p_ != quote) ++p_;
        if (p_ == end_) return kWrong;
        char* value_end = resolved(value, p_);
        for (char* c = value; c < value_end; ++c)
            if (is_space(*c)) *c = ' ';
        *value_end = 0;
        ++p_;
        *name_end = 0;
        a = {first, value};
        return p_ < end_ && !is_space(*p_) && *p_ != '>' && *p_ != '/' ? kWrong : nullptr;
    }

    // What is between tags; text of nothing but blanks is none.
    const char* characters() {
        char* first = p_;
        while (p_ < end_ && *p_ != '<') ++p_;
        if (p_ == end_) return nullptr;  // after the document: passed over
        bool blank = true;
        for (char* c = first; c < p_; ++c) blank = blank && is_space(*c);
        if (blank || open_ == 1) return nullptr;
        // The '<' that follows has still to be read, so there is no room for a zero where nothing became
        // shorter.
        char* last = resolved(first, p_);
        const std::uint32_t text = add(node_pcdata, first - begin_);
        if (last < p_)
            *last = 0;
        else
            first = d_.kept_.emplace_back(std::make_unique<std::string>(first, last))->data();
        d_.nodes_[text].value = first;
        return nullptr;
    }

    // CR LF and CR become LF; the new end.
    static char* lines(char* first, char* last) {
        char* to = first;
        for (char* c = first; c < last; ++c) {
            if (*c == '\r') {
                *to++ = '\n';
                if (c + 1 < last && c[1] == '\n') ++c;
            } else {
                *to++ = *c;
            }
        }
        return to;
    }

    // With entities replaced; the new end.
    static char* resolved(char* first, char* last) {
        last = lines(first, last);
        char* to = first;
        for (char* c = first; c < last;) {
            std::size_t used = 0;
            if (*c == '&') used = entity({c, std::size_t(last - c)}, to);
            if (used == 0)
                *to++ = *c++;
            else
                c += used;
        }
        return to;
    }

    // Writes what the entity means and returns its length; 0 if it is none.
    static std::size_t entity(std::string_view s, char*& to) {
        static constexpr std::pair<std::string_view, char> kNamed[] = {
            {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&apos;", '\''}, {"&quot;", '"'}};
        for (const auto& [name, c] : kNamed)
            if (s.starts_with(name)) return *to++ = c, name.size();
        if (!s.starts_with("&#")) return 0;
        const bool hex = s.size() > 2 && s[2] == 'x';
        std::size_t i = hex ? 3 : 2;
        std::uint32_t code = 0;
        const std::size_t first = i;
        for (; i < s.size() && s[i] != ';'; ++i) {
            const char c = s[i];
            const int digit = c >= '0' && c <= '9'          ? c - '0'
                              : hex && c >= 'a' && c <= 'f' ? c - 'a' + 10
                              : hex && c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                            : -1;
            if (digit < 0) return 0;
            code = code * (hex ? 16 : 10) + std::uint32_t(digit);
            if (code > 0x10FFFF) return 0;
        }
        if (i == s.size() || i == first || code == 0) return 0;
        if (code < 0x80) {
            *to++ = char(code);
        } else if (code < 0x800) {
            *to++ = char(0xC0 | (code >> 6));
            *to++ = char(0x80 | (code & 63));
        } else {
            if (code < 0x10000) {
                *to++ = char(0xE0 | (code >> 12));
            } else {
                *to++ = char(0xF0 | (code >> 18));
                *to++ = char(0x80 | ((code >> 12) & 63));
            }
            *to++ = char(0x80 | ((code >> 6) & 63));
            *to++ = char(0x80 | (code & 63));
        }
        return i + 1;
    }

    xml_document& d_;
    char *begin_, *p_, *end_;
    std::uint32_t open_ = 1;
};

inline xml_parse_result xml_document::load_buffer(const void* bytes, std::size_t size) {
    text_.assign(static_cast<const char*>(bytes), size);
    nodes_.clear(), attributes_.clear(), kept_.clear();
    return Parser(*this).parse();
}

}  // namespace pugi
