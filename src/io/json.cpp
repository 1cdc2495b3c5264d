// Idea. The text becomes one flat list of nodes, each container before its content and with the index of what
// follows it: no recursion, no pointers, no memory beyond 24 bytes per node, and a node needs at least one
// byte of text.
//
// Why not a parser from elsewhere: an unknown, repeated or misplaced key is to be reported with its line;
// "-0" and numbers beyond the range of double must not change silently; and nothing may be thrown.
#include <freiform/core/decimal.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/utf8.hpp>
#include <freiform/io/json.hpp>

#include <algorithm>
#include <limits>

namespace freiform::json {

std::string_view name_of(Kind kind) {
    switch (kind) {
        case Kind::null:
            return "null";
        case Kind::boolean:
            return "true or false";
        case Kind::number:
            return "a number";
        case Kind::string:
            return "a string";
        case Kind::array:
            return "an array";
        case Kind::object:
            return "an object";
    }
    return "null";
}

std::string position(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, offset);
    const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const auto column = std::count_if(before.begin() + std::ptrdiff_t(start), before.end(),
                                      [](char c) { return (c & 0xC0) != 0x80; }) +
                        1;
    return freiform::text("line ", line, ", column ", column);
}

namespace {

void append_utf8(std::string& s, std::uint32_t c) {
    if (c < 0x80) {
        s += char(c);
    } else if (c < 0x800) {
        s += {char(0xC0 | c >> 6), char(0x80 | (c & 63))};
    } else if (c < 0x10000) {
        s += {char(0xE0 | c >> 12), char(0x80 | (c >> 6 & 63)), char(0x80 | (c & 63))};
    } else {
        s += {char(0xF0 | c >> 18), char(0x80 | (c >> 12 & 63)), char(0x80 | (c >> 6 & 63)),
              char(0x80 | (c & 63))};
    }
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = char(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// Four hexadecimal digits, or -1.
int hex4(std::string_view s) {
    if (s.size() < 4) return -1;
    int x = 0;
    for (int i = 0; i < 4; ++i) {
        const int d = hex_digit(s[std::size_t(i)]);
        if (d < 0) return -1;
        x = x * 16 + d;
    }
    return x;
}

// REQUIRES escapes that the parser has checked.
std::string unescape(std::string_view raw) {
    std::string s;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        if (raw[i] != '\\') {
            s += raw[i];
            continue;
        }
        switch (const char c = raw[++i]) {
            case 'b':
                s += '\b';
                break;
            case 'f':
                s += '\f';
                break;
            case 'n':
                s += '\n';
                break;
            case 'r':
                s += '\r';
                break;
            case 't':
                s += '\t';
                break;
            case 'u': {
                auto x = std::uint32_t(hex4(raw.substr(i + 1)));
                i += 4;
                if (x >= 0xD800 && x < 0xDC00) {
                    x = 0x10000 + ((x - 0xD800) << 10) + (std::uint32_t(hex4(raw.substr(i + 3))) - 0xDC00);
                    i += 6;
                }
                append_utf8(s, x);
                break;
            }
            default:
                s += c;
        }
    }
    return s;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

class Parser {
public:
    Parser(std::string_view text, std::size_t max_depth) : text_(text), max_depth_(max_depth), tree_(text) {}

    Result<Tree> run() {
        if (text_.size() >= std::numeric_limits<std::uint32_t>::max())
            return refuse(RefusalKind::limit, "",
                          freiform::text(text_.size(), " bytes of JSON; the limit is 2^32 - 2"));
        if (text_.starts_with("\xEF\xBB\xBF")) pos_ = 3;
        for (bool more = true; more;) {
            if (auto ok = value(); !ok) return std::unexpected(ok.error());
            const auto next = after_value();
            if (!next) return std::unexpected(next.error());
            more = *next;
        }
        return std::move(tree_);
    }

private:
    std::unexpected<Refusal> fail(std::size_t at, std::string message) const {
        return refuse(RefusalKind::unreadable, position(text_, at), std::move(message));
    }
    std::unexpected<Refusal> unexpected_here(std::string_view expected) const {
        if (pos_ >= text_.size())
            return fail(text_.size(), freiform::text("the text ends where ", expected, " is expected"));
        return fail(pos_, freiform::text("expected ", expected, ", found ", found()));
    }
    // The word or character here, for messages.
    std::string found() const {
        std::size_t n = 0;
        const auto is_word = [](char c) {
            return is_digit(c) || ((c | 0x20) >= 'a' && (c | 0x20) <= 'z') || c == '_';
        };
        while (n < 24 && pos_ + n < text_.size() && is_word(text_[pos_ + n])) ++n;
        if (n > 0) return freiform::text("'", text_.substr(pos_, n), "'");
        return shown_character(text_.substr(pos_));
    }
    bool at(char c) const { return pos_ < text_.size() && text_[pos_] == c; }
    void skip_space() {
        while (at(' ') || at('\n') || at('\r') || at('\t')) ++pos_;
    }
    Node& add(Kind kind) {
        Node n;
        n.kind = kind;
        n.at = std::uint32_t(pos_);
        tree_.nodes_.push_back(n);
        tree_.nodes_.back().next = std::uint32_t(tree_.nodes_.size());
        return tree_.nodes_.back();
    }
    Node& open_node() { return tree_.nodes_[open_.back()]; }
    bool in_object() { return open_node().kind == Kind::object; }

    // Reads on until a value without content has ended: a scalar, or an empty container.
    Result<void> value() {
        for (;;) {
            skip_space();
            if (!open_.empty()) ++open_node().size;
            if (!at('{') && !at('[')) return scalar();
            if (open_.size() == max_depth_)
                return fail(
                    pos_, freiform::text("more than ", max_depth_, " arrays and objects within each other"));
            const bool object = at('{');
            add(object ? Kind::object : Kind::array);
            open_.push_back(std::uint32_t(tree_.nodes_.size() - 1));
            ++pos_;
            skip_space();
            if (at(object ? '}' : ']')) {
                ++pos_;
                open_.pop_back();
                return {};
            }
            if (object)
                if (auto ok = key(); !ok) return ok;
        }
    }

    // Closes what ends here. True: another value follows; false: that was all.
    Result<bool> after_value() {
        for (;;) {
            skip_space();
            if (open_.empty()) {
                if (pos_ < text_.size())
                    return fail(pos_,
                                freiform::text("the document has ended, but more text follows: ", found()));
                return false;
            }
            const bool object = in_object();
            if (at(',')) {
                ++pos_;
                skip_space();
                if (at(']') || at('}'))
                    return fail(pos_, freiform::text("a comma before '", text_[pos_], "'"));
                if (object)
                    if (auto ok = key(); !ok) return std::unexpected(ok.error());
                return true;
            }
            if (!at(object ? '}' : ']')) return unexpected_here(object ? "',' or '}'" : "',' or ']'");
            ++pos_;
            open_node().next = std::uint32_t(tree_.nodes_.size());
            if (object)
                if (auto ok = distinct_keys(open_.back()); !ok) return std::unexpected(ok.error());
            open_.pop_back();
        }
    }

    Result<void> key() {
        if (!at('"')) return unexpected_here("a key in double quotes");
        if (auto ok = string(); !ok) return ok;
        skip_space();
        if (!at(':')) return unexpected_here("':'");
        ++pos_;
        return {};
    }

    Result<void> distinct_keys(std::uint32_t object) {
        struct Key {
            std::string name;
            std::uint32_t at;
        };
        std::vector<Key> keys;
        const auto& nodes = tree_.nodes_;
        for (std::uint32_t i = object + 1; i < nodes[object].next; i = nodes[i + 1].next) {
            const auto raw = text_.substr(nodes[i].at + 1, nodes[i].size);
            keys.push_back({nodes[i].escaped ? unescape(raw) : std::string(raw), nodes[i].at});
        }
        sort(keys.begin(), keys.end(),
             [](const Key& a, const Key& b) { return a.name != b.name ? a.name < b.name : a.at < b.at; });
        const auto twin = std::adjacent_find(keys.begin(), keys.end(),
                                             [](const Key& a, const Key& b) { return a.name == b.name; });
        if (twin != keys.end())
            return fail(twin[1].at,
                        freiform::text("the key \"", twin->name, "\" appears twice in one object"));
        return {};
    }

    Result<void> scalar() {
        if (at('"')) return string();
        if (at('-') || (pos_ < text_.size() && is_digit(text_[pos_]))) return number();
        for (const std::string_view word : {"true", "false", "null"})
            if (text_.substr(pos_).starts_with(word)) {
                Node& n = add(word == "null" ? Kind::null : Kind::boolean);
                n.number = word == "true";
                pos_ += word.size();
                return {};
            }
        return unexpected_here("a value");
    }

    Result<void> number() {
        Node& n = add(Kind::number);
        const std::size_t begin = pos_;
        const auto digits = [&] {
            const std::size_t from = pos_;
            while (pos_ < text_.size() && is_digit(text_[pos_])) ++pos_;
            return pos_ - from;
        };
        if (at('-')) ++pos_;
        if (at('0') && pos_ + 1 < text_.size() && is_digit(text_[pos_ + 1]))
            return fail(begin, "a number does not begin with 0");
        if (digits() == 0) return unexpected_here("a digit");
        if (at('.')) {
            ++pos_;
            if (digits() == 0) return unexpected_here("a digit");
        }
        if (at('e') || at('E')) {
            ++pos_;
            if (at('-') || at('+')) ++pos_;
            if (digits() == 0) return unexpected_here("a digit");
        }
        n.number = scan_real(text_.substr(begin, pos_ - begin)).value;
        return {};
    }

    Result<void> string() {
        Node& n = add(Kind::string);
        const std::size_t begin = ++pos_;
        while (pos_ < text_.size() && text_[pos_] != '"') {
            const auto c = static_cast<unsigned char>(text_[pos_]);
            if (c < 0x20)
                return fail(pos_, freiform::text("byte ", int(c), " in a string; it has to be escaped"));
            std::size_t length = 1;
            if (c == '\\') {
                n.escaped = true;
                length = escape_length();
                if (length == 0) return fail(pos_, "an escape that JSON does not have");
            } else if (c >= 0x80) {
                length = utf8_length(text_.substr(pos_));
                if (length == 0) return fail(pos_, freiform::text("byte ", int(c), " is not UTF-8"));
            }
            pos_ += length;
        }
        if (pos_ >= text_.size()) return fail(begin - 1, "a string that does not end");
        n.size = std::uint32_t(pos_ - begin);
        ++pos_;
        return {};
    }

    std::size_t escape_length() const {
        const std::string_view s = text_.substr(pos_);
        if (s.size() < 2) return 0;
        if (s[1] != 'u') return std::string_view("\"\\/bfnrt").find(s[1]) != std::string_view::npos ? 2 : 0;
        const int x = hex4(s.substr(2));
        if (x < 0 || (x >= 0xDC00 && x < 0xE000)) return 0;
        if (x < 0xD800 || x >= 0xE000) return 6;
        if (s.size() < 12 || s[6] != '\\' || s[7] != 'u') return 0;
        const int low = hex4(s.substr(8));
        return low >= 0xDC00 && low < 0xE000 ? 12 : 0;
    }

    std::string_view text_;
    std::size_t max_depth_;
    Tree tree_;
    std::size_t pos_ = 0;
    std::vector<std::uint32_t> open_;  // the containers that have not ended
};

Result<Tree> parse(std::string_view text, std::size_t max_depth) { return Parser(text, max_depth).run(); }

const Node& Value::node() const { return tree_->nodes_[node_]; }
Kind Value::kind() const { return node().kind; }
double Value::number() const { return node().number; }
bool Value::boolean() const { return node().number != 0; }
std::size_t Value::size() const { return node().size; }
std::size_t Value::offset() const { return node().at; }
std::string Value::string() const {
    const auto raw = tree_->text_.substr(node().at + 1, node().size);
    return node().escaped ? unescape(raw) : std::string(raw);
}
Value::Range<Value> Value::elements() const { return {tree_, node_ + 1, node().size}; }
Value::Range<Member> Value::members() const { return {tree_, node_ + 1, node().size}; }

template <class T>
T Value::Range<T>::Iterator::operator*() const {
    if constexpr (std::same_as<T, Value>)
        return Value(tree_, node_);
    else
        return Member{Value(tree_, node_).string(), Value(tree_, node_ + 1)};
}
template <class T>
typename Value::Range<T>::Iterator& Value::Range<T>::Iterator::operator++() {
    const std::uint32_t last = std::same_as<T, Value> ? node_ : node_ + 1;
    node_ = Value(tree_, last).node().next;
    --left_;
    return *this;
}
template class Value::Range<Value>;
template class Value::Range<Member>;

}  // namespace freiform::json
