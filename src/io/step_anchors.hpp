// Edition 3: ANCHOR gives names to instances, REFERENCE numbers to what other names stand for.
//
//     ANCHOR;  <name> = #12;  ENDSEC;     REFERENCE;  #20 = <#name>;  ENDSEC;
//
// Then #20 is #12. Only names of the same file are followed.
#pragma once
#include "step_part21.hpp"

#include <algorithm>
#include <functional>
#include <unordered_map>

namespace freiform::step {

class Anchors {
public:
    // Told of a number: what is wrong with it, and the byte where it stands.
    using Tell = std::function<void(RefusalKind, std::uint32_t id, std::size_t at, std::string what)>;

    // One statement of a section that begins at byte `at`, without its semicolon.
    void add_anchor(std::string_view statement, std::size_t at, const Tell& tell);
    void add_reference(std::string_view statement, std::size_t at, const Tell& tell);

    bool has_references() const { return !references_.empty() || !elsewhere_.empty(); }
    // Follows references to instances; `place`: of a number in the table, kMissing if it has none.
    void resolve(const std::function<std::uint32_t(std::uint32_t)>& place, const Tell& tell);
    // After that: the place that a number of a reference stands for; kMissing if it stands for none, which is
    // told if it is of another file. Those that nothing refers to are no loss.
    std::uint32_t place_of(std::uint32_t id, const Tell& tell);

private:
    struct Reference {
        std::uint32_t id;
        std::string_view resource;
        std::size_t at;
    };
    std::unordered_map<std::string_view, std::uint32_t> anchors_;  // kMissing: of what is no instance
    std::vector<Reference> references_;
    std::unordered_map<std::uint32_t, Reference> elsewhere_;  // that are not told yet
    std::unordered_map<std::uint32_t, std::uint32_t> places_;
};

}  // namespace freiform::step
