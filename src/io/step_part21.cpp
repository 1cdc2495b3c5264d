// Idea. One pass over the bytes. Brackets are kept on a stack of our own; when one closes, the list token
// that was made at its beginning learns how many tokens are in it, so that lists are skipped in one step.
// What follows an error in an instance is skipped to the next semicolon that no string contains.
//
// Cost. Linear; twelve bytes for each token, of which the densest text has one for every second byte.
//
// References: ISO 10303-21:2016, 5 to 14 (anchors: step_anchors.cpp); edition 1 for scopes.
//
// Why not a grammar and a tree: nodes take ten times the memory of the text, and a tree of the depth that a
// file asks for takes the stack along.
#include "step_anchors.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace freiform::step {

namespace {

constexpr std::size_t kMostRefusals = 100;

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_of_word(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || is_digit(c) || c == '_';
}
constexpr bool is_of_number(char c) {
    return is_digit(c) || c == '.' || c == '+' || c == '-' || c == 'E' || c == 'e';
}

class Part21Parser {
public:
    explicit Part21Parser(File& file) : f_(file), s_(file.bytes) {}

    Result<void> run() {
        if (s_.starts_with("\xEF\xBB\xBF")) i_ = 3;
        if (!word("ISO-10303-21") || !sign(';')) return fatal("a STEP file begins with ISO-10303-21;", 0);
        bool data = false;
        for (;;) {
            skip();
            if (i_ >= s_.size()) return fatal("the file ends before END-ISO-10303-21;", s_.size());
            if (word("END-ISO-10303-21")) break;
            if (word("SIGNATURE")) break;
            const std::size_t at = i_;
            if (word("HEADER")) {
                if (auto ok = section(f_.header, false); !ok) return ok;
            } else if (word("DATA")) {
                data = true;
                skip();
                if (i_ < s_.size() && s_[i_] == '(' && !value_list())
                    return fatal("the parameters of a DATA section are damaged", at);
                if (auto ok = section(f_.instances, true); !ok) return ok;
            } else if (word("ANCHOR")) {
                names_section(&Anchors::add_anchor);
            } else if (word("REFERENCE")) {
                names_section(&Anchors::add_reference);
            } else {
                return fatal("HEADER, DATA or END-ISO-10303-21 is expected", at);
            }
        }
        if (!data) return fatal("the file has no DATA section", s_.size());
        resolve();
        if (dropped_ > 0)
            f_.refused.push_back(
                {RefusalKind::unreadable, "file", text("and ", dropped_, " more instances are damaged")});
        return {};
    }

private:
    std::unexpected<Refusal> fatal(std::string_view what, std::size_t at) {
        return refuse(RefusalKind::unreadable, text("byte ", at), std::string(what));
    }
    void complain(std::uint32_t id, std::size_t at, std::string what) {
        complain(RefusalKind::unreadable, id, text(what, " (byte ", at, ")"));
    }
    void complain(RefusalKind kind, std::uint32_t id, std::string what) {
        if (f_.refused.size() < kMostRefusals)
            f_.refused.push_back({kind, text("#", id), std::move(what)});
        else
            ++dropped_;
    }
    // Of anchors and references.
    Anchors::Tell tell_line() {
        return [this](RefusalKind kind, std::uint32_t id, std::size_t at, std::string what) {
            if (f_.refused.size() >= kMostRefusals) return void(++dropped_);
            const auto line = 1 + std::ranges::count(s_.substr(0, at), '\n');
            complain(kind, id, text(what, " (line ", line, ", byte ", at, ")"));
        };
    }

    // Blanks and comments.
    void skip() {
        for (;;) {
            while (i_ < s_.size() && (unsigned char)(s_[i_]) <= ' ') ++i_;
            if (i_ + 1 >= s_.size() || s_[i_] != '/' || s_[i_ + 1] != '*') return;
            const std::size_t end = s_.find("*/", i_ + 2);
            i_ = end == std::string_view::npos ? s_.size() : end + 2;
        }
    }
    bool sign(char c) {
        skip();
        if (i_ >= s_.size() || s_[i_] != c) return false;
        ++i_;
        return true;
    }
    bool word(std::string_view w) {
        skip();
        if (s_.substr(i_, w.size()) != w) return false;
        if (i_ + w.size() < s_.size() && is_of_word(s_[i_ + w.size()])) return false;
        i_ += w.size();
        return true;
    }

    // Behind the next semicolon outside of strings and comments.
    void skip_statement() {
        while (i_ < s_.size()) {
            const char c = s_[i_];
            if (c == ';') {
                ++i_;
                return;
            }
            if (c == '\'' || c == '"') {
                const std::size_t end = s_.find(c, i_ + 1);
                i_ = end == std::string_view::npos ? s_.size() : end + 1;
            } else if (c == '/' && i_ + 1 < s_.size() && s_[i_ + 1] == '*') {
                skip();
            } else {
                ++i_;
            }
        }
    }
    // A name in pointed brackets may contain what is a quote elsewhere.
    void names_section(void (Anchors::*add)(std::string_view, std::size_t, const Anchors::Tell&)) {
        if (!sign(';')) return skip_statement();
        for (const Anchors::Tell tell = tell_line();;) {
            skip();
            if (i_ >= s_.size()) return;
            if (word("ENDSEC")) return skip_statement();
            const std::size_t at = i_, open = s_.find_first_of("<;'\"", i_);
            if (open != std::string_view::npos && s_[open] == '<')
                i_ = std::min(s_.find('>', open), s_.size());
            skip_statement();
            const std::size_t end = s_[i_ - 1] == ';' ? i_ - 1 : i_;
            (anchors_.*add)(s_.substr(at, end - at), at, tell);
        }
    }

    Result<void> section(std::vector<Instance>& into, bool numbered) {
        const std::size_t begin = i_;
        if (!sign(';')) return fatal("a semicolon is expected behind the name of a section", i_);
        std::vector<Instance> scopes;  // edition 1: instances whose own text comes behind those they contain
        for (;;) {
            skip();
            if (i_ >= s_.size())
                return fatal(
                    text("the file ends in the section that begins at byte ", begin, "; ENDSEC is expected"),
                    s_.size());
            if (word("ENDSEC")) {
                if (!sign(';')) return fatal("a semicolon is expected behind ENDSEC", i_);
                if (!scopes.empty()) complain(scopes.back().id, scopes.back().at, "its scope does not end");
                return {};
            }
            Instance x;
            x.at = std::uint32_t(i_);
            if (!scopes.empty() && word("ENDSCOPE")) {
                x = scopes.back();
                scopes.pop_back();
                skip();
                if (i_ < s_.size() && s_[i_] == '/') {
                    const std::size_t end = s_.find('/', i_ + 1);
                    i_ = end == std::string_view::npos ? s_.size() : end + 1;
                }
            } else if (numbered) {
                const std::size_t at = i_;
                if (!instance_number(x.id)) {
                    complain(0, at, "an instance is expected: # and a number below 4294967295");
                    skip_statement();
                    continue;
                }
                if (!sign('=')) {
                    complain(x.id, at, "an equals sign is expected behind its number");
                    skip_statement();
                    continue;
                }
                if (word("&SCOPE")) {
                    scopes.push_back(x);
                    continue;
                }
            }
            read_instance(x, into);
        }
    }

    bool instance_number(std::uint32_t& id) {
        if (s_[i_] != '#') return false;
        ++i_;
        std::uint64_t n = 0;
        std::size_t digits = 0;
        for (; i_ < s_.size() && is_digit(s_[i_]); ++i_, ++digits)
            n = std::min<std::uint64_t>(n * 10 + std::uint64_t(s_[i_] - '0'), kMissing);
        id = std::uint32_t(n);
        return digits > 0 && n < kMissing;
    }

    void read_instance(Instance x, std::vector<Instance>& into) {
        x.first = std::uint32_t(f_.tokens.size());
        skip();
        const bool complex = i_ < s_.size() && s_[i_] == '(';
        bool good = true;
        if (complex) {
            ++i_;
            int parts = 0;
            while (good && !sign(')')) {
                good = keyword() && value_list();
                ++parts;
            }
            good = good && parts > 0;
        } else {
            good = keyword() && value_list();
        }
        const std::size_t end = i_;
        if (!good || !sign(';')) {
            complain(x.id, end, "it is damaged: a name, values in brackets and a semicolon are expected");
            f_.tokens.resize(x.first);
            i_ = std::max(end, std::size_t(x.at));
            skip_statement();
            return;
        }
        x.tokens = std::uint32_t(f_.tokens.size()) - x.first;
        into.push_back(x);
    }

    bool keyword() {
        skip();
        const std::size_t at = i_;
        if (i_ < s_.size() && s_[i_] == '!') ++i_;
        while (i_ < s_.size() && is_of_word(s_[i_])) ++i_;
        if (i_ == at) return false;
        const Type type = type_named(s_.substr(at, i_ - at));
        f_.tokens.push_back({TokenKind::keyword, type, std::uint32_t(at), std::uint32_t(i_ - at)});
        return true;
    }

    void push(TokenKind kind, std::size_t at, std::size_t size) {
        f_.tokens.push_back({kind, Type::unknown, std::uint32_t(at), std::uint32_t(size)});
    }

    // A list with all that is in it.
    bool value_list() {
        if (!sign('(')) return false;
        open_.clear();
        open();
        bool wants_value = false;  // behind a comma
        while (!open_.empty()) {
            skip();
            if (i_ >= s_.size()) return false;
            const char c = s_[i_];
            if (c == ')') {
                if (wants_value) return false;
                ++i_;
                const std::uint32_t list = open_.back();
                open_.pop_back();
                f_.tokens[list].size = std::uint32_t(f_.tokens.size()) - list - 1;
                if (open_.empty()) return true;
            } else if (c == '(') {
                ++i_;
                open();
                wants_value = false;
                continue;
            } else if (is_of_word(c) && !is_digit(c)) {
                if (!keyword() || !sign('(')) return false;
                open();
                wants_value = false;
                continue;
            } else if (!scalar(c)) {
                return false;
            }
            // Behind a value.
            skip();
            if (i_ >= s_.size()) return false;
            wants_value = s_[i_] == ',';
            if (wants_value)
                ++i_;
            else if (s_[i_] != ')')
                return false;
        }
        return true;
    }
    void open() {
        open_.push_back(std::uint32_t(f_.tokens.size()));
        push(TokenKind::list, i_, 0);
    }

    bool scalar(char c) {
        const std::size_t at = i_;
        switch (c) {
            case '$':
            case '*':
                ++i_;
                push(c == '$' ? TokenKind::omitted : TokenKind::derived, at, 1);
                return true;
            case '#': {
                std::uint32_t id = 0;
                if (!instance_number(id)) return false;
                push(TokenKind::reference, kMissing, id);
                return true;
            }
            case '\'':
                for (++i_;;) {
                    const std::size_t end = s_.find('\'', i_);
                    if (end == std::string_view::npos) return false;
                    i_ = end + 1;
                    if (i_ >= s_.size() || s_[i_] != '\'') break;
                    ++i_;
                }
                push(TokenKind::string, at + 1, i_ - at - 2);
                return true;
            case '"': {
                const std::size_t end = s_.find('"', i_ + 1);
                if (end == std::string_view::npos) return false;
                i_ = end + 1;
                push(TokenKind::binary, at + 1, i_ - at - 2);
                return true;
            }
            case '.':
                if (i_ + 1 < s_.size() && is_of_word(s_[i_ + 1]) && !is_digit(s_[i_ + 1])) {
                    for (++i_; i_ < s_.size() && is_of_word(s_[i_]);) ++i_;
                    if (i_ >= s_.size() || s_[i_] != '.') return false;
                    ++i_;
                    push(TokenKind::enumeration, at + 1, i_ - at - 2);
                    return true;
                }
                break;
            case '<':
            case '@': {
                while (i_ < s_.size() && s_[i_] != ',' && s_[i_] != ')' && s_[i_] != ';') ++i_;
                push(TokenKind::external, at, i_ - at);
                return true;
            }
            default:
                break;
        }
        while (i_ < s_.size() && is_of_number(s_[i_])) ++i_;
        push(TokenKind::number, at, i_ - at);
        return i_ > at;
    }

    // Numbers to places in the table. Numbers that are given twice keep their first instance.
    void resolve() {
        const auto& all = f_.instances;
        std::vector<std::uint32_t> order(all.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = std::uint32_t(k);
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            return all[a].id != all[b].id ? all[a].id < all[b].id : a < b;
        };
        if (!std::is_sorted(order.begin(), order.end(), before)) sort(order.begin(), order.end(), before);
        for (std::size_t k = 1; k < order.size(); ++k)
            if (all[order[k]].id == all[order[k - 1]].id)
                complain(all[order[k]].id, all[order[k]].at, "its number is used before");
        // A table where numbers are dense enough, else a search.
        const std::uint32_t last = order.empty() ? 0 : all[order.back()].id;
        const bool dense = last / 8 <= all.size() + 1000;
        std::vector<std::uint32_t> place(dense ? std::size_t(last) + 1 : 0, kMissing);
        if (dense)
            for (std::size_t k = order.size(); k-- > 0;) place[all[order[k]].id] = order[k];
        const auto place_of = [&](std::uint32_t id) {
            if (dense) return id <= last ? place[id] : kMissing;
            const auto at = std::lower_bound(order.begin(), order.end(), id,
                                             [&](std::uint32_t a, std::uint32_t b) { return all[a].id < b; });
            return at != order.end() && all[*at].id == id ? *at : kMissing;
        };
        const Anchors::Tell tell = tell_line();
        anchors_.resolve(place_of, tell);
        for (Token& t : f_.tokens) {
            f_.offset_curves += t.kind == TokenKind::keyword && t.type == Type::OFFSET_CURVE_3D;
            if (t.kind != TokenKind::reference) continue;
            t.at = place_of(t.size);
            if (t.at == kMissing && anchors_.has_references()) t.at = anchors_.place_of(t.size, tell);
        }
    }

    File& f_;
    std::string_view s_;
    std::size_t i_ = 0, dropped_ = 0;
    std::vector<std::uint32_t> open_;
    Anchors anchors_;
};

}  // namespace

Result<File> parse(std::string_view bytes) {
    if (bytes.size() >= std::numeric_limits<std::uint32_t>::max())
        return refuse(RefusalKind::limit, "file",
                      text("has ", bytes.size(), " bytes; at most 4294967294 are read"));
    File file;
    file.bytes = bytes;
    file.tokens.reserve(bytes.size() / 8);
    file.instances.reserve(bytes.size() / 64);
    if (auto ok = Part21Parser(file).run(); !ok) return std::unexpected(ok.error());
    for (const Instance& x : file.header)
        if (file.text_of(file.tokens[x.first]) == "FILE_SCHEMA")
            for (std::uint32_t k = 1; k < x.tokens && file.schema.empty(); ++k)
                if (const Token& t = file.tokens[x.first + k]; t.kind == TokenKind::string)
                    file.schema = decoded(file.text_of(t));
    return file;
}

}  // namespace freiform::step
