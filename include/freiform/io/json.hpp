// JSON text [RFC 8259]: a reader for text from anywhere, and a writer. Numbers are doubles, to the last bit
// in both directions; -0 stays -0.
#pragma once
#include <freiform/core/result.hpp>

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::json {

enum class Kind : unsigned char { null, boolean, number, string, array, object };
std::string_view name_of(Kind kind);  // with its article: "a number", "an array"

// How deep arrays and objects may lie within each other in documents.
inline constexpr int kMaxDepth = 64;

struct Node {
    double number = 0;       // of a number; infinite if the text means more than a double holds. 1: true
    std::uint32_t at = 0;    // where its text begins
    std::uint32_t next = 0;  // the node after it and all that it contains
    std::uint32_t size = 0;  // elements, members, or bytes of a string between its quotes
    Kind kind = Kind::null;
    bool escaped = false;  // a string that contains a backslash
};

class Tree;
struct Member;

// A place in a Tree, which must outlive it.
class Value {
public:
    Kind kind() const;
    bool is(Kind k) const { return kind() == k; }
    double number() const;       // REQUIRES is(number); +-infinity where the text leaves the range of double
    bool boolean() const;        // REQUIRES is(boolean)
    std::string string() const;  // REQUIRES is(string)
    std::size_t size() const;    // elements of an array, members of an object
    std::size_t offset() const;  // of its first character in the text

    template <class T>
    class Range;
    Range<Value> elements() const;  // REQUIRES is(array)
    Range<Member> members() const;  // REQUIRES is(object)

private:
    friend class Tree;
    Value(const Tree* tree, std::uint32_t node) : tree_(tree), node_(node) {}
    const Node& node() const;
    const Tree* tree_;
    std::uint32_t node_;
};

struct Member {
    std::string key;
    Value value;
};

// What `parse` makes of a text. The text must outlive it.
class Tree {
public:
    Value root() const { return {this, 0}; }
    std::string_view text() const { return text_; }

private:
    friend class Value;
    friend class Parser;
    explicit Tree(std::string_view text) : text_(text) {}
    std::string_view text_;
    std::vector<Node> nodes_;  // every container before its content
};

// Refuses, with line and column, what is not JSON in UTF-8, a key that appears twice in an object, and what
// is deeper than max_depth (the parser itself does not mind). Memory: at most 24 bytes per byte of text.
// Texts of 4 GiB and more are refused (kind limit).
Result<Tree> parse(std::string_view text, std::size_t max_depth = kMaxDepth);

// "line 3, column 7" of the character at `offset`; columns count characters, from 1.
std::string position(std::string_view text, std::size_t offset);

template <class T>
class Value::Range {
public:
    class Iterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = T;
        using difference_type = std::ptrdiff_t;
        Iterator(const Tree* tree, std::uint32_t node, std::uint32_t left)
            : tree_(tree), node_(node), left_(left) {}
        T operator*() const;
        Iterator& operator++();
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.left_ == b.left_; }

    private:
        const Tree* tree_;
        std::uint32_t node_, left_;
    };
    Iterator begin() const { return {tree_, first_, size_}; }
    Iterator end() const { return {tree_, first_, 0}; }

private:
    friend class Value;
    Range(const Tree* tree, std::uint32_t first, std::uint32_t size)
        : tree_(tree), first_(first), size_(size) {}
    const Tree* tree_;
    std::uint32_t first_, size_;
};
extern template class Value::Range<Value>;
extern template class Value::Range<Member>;

// Builds a text piece by piece; commas come by themselves.
//     w.begin_object().key("degree").value(3).end_object();
class Writer {
public:
    Writer& begin_object() { return open('{'); }
    Writer& end_object() { return close('}'); }
    Writer& begin_array() { return open('['); }
    Writer& end_array() { return close(']'); }
    Writer& key(std::string_view name);
    Writer& value(std::string_view text);  // what is not UTF-8 becomes U+FFFD
    Writer& value(const char* text) { return value(std::string_view(text)); }
    // The shortest text that reads back to the same bits; null if not finite, for which JSON has no text.
    Writer& value(double number);
    template <class T>
    requires std::integral<T> Writer& value(T number) {
        separate();
        append_text(text_, number);
        return *this;
    }
    Writer& null();
    // The next element or member begins a line of its own, indented by this much.
    Writer& new_line(int indent);

    template <class T>
    Writer& field(std::string_view name, const T& content) {
        return key(name).value(content);
    }
    template <class Numbers>
    Writer& array(const Numbers& numbers) {
        begin_array();
        for (const auto& x : numbers) value(x);
        return end_array();
    }

    const std::string& text() const { return text_; }
    std::string take() { return std::move(text_); }

private:
    Writer& open(char c);
    Writer& close(char c);
    void separate();
    std::string text_;
    bool first_ = true;  // nothing stands before the next element
    int indent_ = -1;    // of a line to begin before the next element
};

}  // namespace freiform::json
