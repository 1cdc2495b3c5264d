// The names of entities, and what a table of instances answers about types.
#include "step_part21.hpp"

#include <algorithm>

namespace freiform::step {

namespace {

#define FF_STEP_STRING(name) #name,
constexpr std::string_view kTypeNames[] = {FF_STEP_TYPES(FF_STEP_STRING)};
#undef FF_STEP_STRING
#undef FF_STEP_TYPES
static_assert(std::is_sorted(std::begin(kTypeNames), std::end(kTypeNames)));

}  // namespace

Type type_named(std::string_view name) {
    const auto* at = std::lower_bound(std::begin(kTypeNames), std::end(kTypeNames), name);
    if (at == std::end(kTypeNames) || *at != name) return Type::unknown;
    return Type(at - std::begin(kTypeNames) + 1);
}

std::uint32_t File::part(std::uint32_t i, Type wanted) const {
    const Instance& x = instances[i];
    for (std::uint32_t k = x.first, end = x.first + x.tokens; k + 1 < end; k += 2 + tokens[k + 1].size)
        if (tokens[k].type == wanted) return k + 1;
    return kMissing;
}

std::string File::label(std::uint32_t i) const {
    const Instance& x = instances[i];
    std::string names;
    for (std::uint32_t k = x.first, end = x.first + x.tokens; k + 1 < end; k += 2 + tokens[k + 1].size) {
        if (names.size() > 60) continue;
        if (!names.empty()) names += '&';
        names += text_of(tokens[k]).substr(0, 80);
    }
    return text("#", x.id, " ", names);
}

}  // namespace freiform::step
