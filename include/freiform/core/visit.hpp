// What std::visit does, for one variant.
#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace freiform {

// f(the alternative that v holds). The index is compared, where std::visit asks a table of functions: what is
// called can be inlined, and in modules it takes less room. REQUIRES a value in v.
template <std::size_t I = 0, class F, class V>
constexpr decltype(auto) visit_one(F&& f, V&& v) {
    using Variant = std::remove_cvref_t<V>;
    using Alternative = decltype(std::get<I>(std::declval<V>()));
    if constexpr (I + 1 < std::variant_size_v<Variant>)
        if (v.index() != I) return visit_one<I + 1>(std::forward<F>(f), std::forward<V>(v));
    return std::forward<F>(f)(static_cast<Alternative>(*std::get_if<I>(&v)));
}

}  // namespace freiform
