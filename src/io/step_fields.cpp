#include "step_fields.hpp"

#include <freiform/core/scan.hpp>

namespace freiform::step {

namespace {

std::string_view kind_in_words(TokenKind kind) {
    constexpr std::string_view kWords[] = {
        "a number", "a string", "an enumeration", "a binary", "a reference",
        "omitted",  "derived",  "a typed value",  "a list",   "something of another file"};
    return kWords[std::size_t(kind)];
}

}  // namespace

Fields::Fields(const File& file, std::uint32_t instance, std::uint32_t list)
    : f_(&file), instance_(instance) {
    each_item(file, list, [&](std::uint32_t k) {
        if (std::size_t(count_) < at_.size()) at_[std::size_t(count_++)] = k;
    });
}

Result<Fields> Fields::of(const File& file, std::uint32_t instance, Type type, int least) {
    const std::uint32_t list = file.part(instance, type);
    if (list == kMissing)
        return refuse(
            RefusalKind::unreadable, file.label(instance),
            text("is not of the type that is expected here (byte ", file.instances[instance].at, ")"));
    Fields fields(file, instance, list);
    if (fields.size() < least)
        return fields.refused(text("has ", fields.size(), " values; at least ", least, " are expected"));
    return fields;
}

std::unexpected<Refusal> Fields::refused(std::string_view message, RefusalKind kind) const {
    return refuse(kind, f_->label(instance_), text(message, " (byte ", f_->instances[instance_].at, ")"));
}

std::unexpected<Refusal> Fields::expected(int i, std::string_view what, std::string_view kind) const {
    if (i < 0 || i >= count_) return refused(text("its ", what, " is missing; ", kind, " is expected"));
    const Token& t = token(i);
    if (t.kind == TokenKind::reference)
        return refused(text("its ", what, " is #", t.size,
                            t.at == kMissing ? ", which is not in the file; " : "; ", kind, " is expected"));
    return refused(text("its ", what, " is ", kind_in_words(t.kind), "; ", kind, " is expected"));
}

bool Fields::is_omitted(int i) const {
    return i < 0 || i >= count_ || token(i).kind == TokenKind::omitted || token(i).kind == TokenKind::derived;
}

Result<double> Fields::number_of(std::uint32_t at, std::string_view what) const {
    if (f_->tokens[at].kind == TokenKind::keyword && f_->tokens[at + 1].size > 0)
        at += 2;  // LENGTH_MEASURE(1.)
    const Token& t = f_->tokens[at];
    if (t.kind != TokenKind::number)
        return refused(text("its ", what, " is ", kind_in_words(t.kind), "; a number is expected"));
    if (const auto x = scan_number<double>(f_->text_of(t))) return *x;
    return refuse(RefusalKind::unreadable, f_->label(instance_),
                  text("its ", what, " is '", f_->text_of(t).substr(0, 40),
                       "', which is no number that a double can hold (byte ", t.at, ")"));
}

Result<double> Fields::number(int i, std::string_view what) const {
    if (i < 0 || i >= count_) return expected(i, what, "a number");
    return number_of(at_[std::size_t(i)], what);
}

Result<int> Fields::integer(int i, std::string_view what) const {
    const auto x = number(i, what);
    if (!x) return std::unexpected(x.error());
    if (*x != std::floor(*x) || std::abs(*x) > 1e9)
        return refused(text("its ", what, " is ", *x, "; a whole number is expected"));
    return int(*x);
}

Result<std::uint32_t> Fields::reference(int i, std::string_view what) const {
    if (!is(i, TokenKind::reference) || token(i).at == kMissing) return expected(i, what, "an instance");
    return token(i).at;
}

Result<std::vector<std::uint32_t>> Fields::references_at(std::uint32_t list, std::string_view what) const {
    std::vector<std::uint32_t> all;
    all.reserve(f_->tokens[list].size);
    std::uint32_t bad = kMissing;
    each_item(*f_, list, [&](std::uint32_t k) {
        const Token& t = f_->tokens[k];
        if (t.kind == TokenKind::keyword) return;  // a typed reference in a SELECT
        if (t.kind != TokenKind::reference || t.at == kMissing)
            bad = k;
        else
            all.push_back(t.at);
    });
    if (bad == kMissing) return all;
    const Token& t = f_->tokens[bad];
    if (t.kind == TokenKind::reference)
        return refused(text("one of its ", what, " is #", t.size, ", which is not in the file"));
    return refused(text("one of its ", what, " is ", kind_in_words(t.kind), "; an instance is expected"));
}

Result<std::vector<std::uint32_t>> Fields::references(int i, std::string_view what) const {
    if (!is(i, TokenKind::list)) return expected(i, what, "a list of instances");
    return references_at(list(i), what);
}

Result<std::vector<double>> Fields::numbers_at(std::uint32_t list, std::string_view what) const {
    std::vector<double> all;
    all.reserve(f_->tokens[list].size);
    std::optional<Refusal> bad;
    each_item(*f_, list, [&](std::uint32_t k) {
        if (bad) return;
        if (const auto x = number_of(k, what))
            all.push_back(*x);
        else
            bad = x.error();
    });
    if (bad) return std::unexpected(*bad);
    return all;
}

Result<std::vector<double>> Fields::numbers(int i, std::string_view what) const {
    if (!is(i, TokenKind::list)) return expected(i, what, "a list of numbers");
    return numbers_at(list(i), what);
}

Result<std::vector<int>> Fields::integers(int i, std::string_view what) const {
    const auto all = numbers(i, what);
    if (!all) return std::unexpected(all.error());
    std::vector<int> whole;
    whole.reserve(all->size());
    for (const double x : *all) {
        if (x != std::floor(x) || std::abs(x) > 1e9)
            return refused(text("one of its ", what, " is ", x, "; a whole number is expected"));
        whole.push_back(int(x));
    }
    return whole;
}

Result<std::vector<std::uint32_t>> Fields::rows(int i, std::string_view what) const {
    if (!is(i, TokenKind::list)) return expected(i, what, "a list of lists");
    std::vector<std::uint32_t> all;
    bool good = true;
    each_item(*f_, list(i), [&](std::uint32_t k) {
        good = good && f_->tokens[k].kind == TokenKind::list;
        all.push_back(k);
    });
    if (!good) return expected(i, what, "a list of lists");
    return all;
}

std::string Fields::string(int i) const {
    return is(i, TokenKind::string) ? decoded(f_->text_of(token(i))) : std::string();
}

std::string_view Fields::enumeration(int i) const {
    return is(i, TokenKind::enumeration) ? f_->text_of(token(i)) : std::string_view();
}

bool Fields::flag(int i, bool otherwise) const {
    const std::string_view e = enumeration(i);
    return e == "T" ? true : e == "F" ? false : otherwise;
}

}  // namespace freiform::step
