// The values of one instance, asked for by place and kind. What is not there or of another kind is a refusal
// with the instance and its byte.
#pragma once
#include "step_part21.hpp"

#include <array>
#include <vector>

namespace freiform::step {

// The items of a list, one behind the other.
template <class F>
void each_item(const File& f, std::uint32_t list, F&& use) {
    const std::uint32_t end = list + 1 + f.tokens[list].size;
    for (std::uint32_t k = list + 1; k < end;) {
        use(k);
        if (f.tokens[k].kind == TokenKind::keyword) ++k;
        k += f.tokens[k].kind == TokenKind::list ? f.tokens[k].size + 1 : 1;
    }
}

class Fields {
public:
    // `list`: of the part of the instance that is asked.
    Fields(const File& file, std::uint32_t instance, std::uint32_t list);
    // The values of the instance as one of `type`; refuses others, and such with fewer than `least` values.
    static Result<Fields> of(const File& file, std::uint32_t instance, Type type, int least);

    int size() const { return count_; }
    bool is_omitted(int i) const;
    bool is(int i, TokenKind kind) const { return i >= 0 && i < count_ && token(i).kind == kind; }
    Result<double> number(int i, std::string_view what) const;
    Result<int> integer(int i, std::string_view what) const;
    Result<std::uint32_t> reference(int i, std::string_view what) const;
    // No references that lead nowhere.
    Result<std::vector<std::uint32_t>> references(int i, std::string_view what) const;
    Result<std::vector<double>> numbers(int i, std::string_view what) const;
    Result<std::vector<int>> integers(int i, std::string_view what) const;
    // The tokens of the lists of a list.
    Result<std::vector<std::uint32_t>> rows(int i, std::string_view what) const;
    Result<std::vector<std::uint32_t>> references_at(std::uint32_t list, std::string_view what) const;
    Result<std::vector<double>> numbers_at(std::uint32_t list, std::string_view what) const;
    // Empty where it is not given.
    std::string string(int i) const;
    std::string_view enumeration(int i) const;
    // .T. is true, .F. is not, and all else is `otherwise`.
    bool flag(int i, bool otherwise = true) const;
    std::uint32_t list(int i) const { return at_[std::size_t(i)]; }

    std::unexpected<Refusal> refused(std::string_view message,
                                     RefusalKind kind = RefusalKind::unreadable) const;
    std::unexpected<Refusal> expected(int i, std::string_view what, std::string_view kind) const;

private:
    const Token& token(int i) const { return f_->tokens[at_[std::size_t(i)]]; }
    Result<double> number_of(std::uint32_t at, std::string_view what) const;
    const File* f_;
    std::uint32_t instance_;
    int count_ = 0;
    std::array<std::uint32_t, 20> at_{};
};

}  // namespace freiform::step
