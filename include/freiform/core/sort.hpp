// Sorting in place; equal elements in any order.
//
//     sort(numbers);   sort(parts, std::greater<>(), &Part::size);   sort(first, last, before);
//
// Cost. O(n log n) comparisons, whatever the order before.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <iterator>
#include <ranges>
#include <utility>

namespace freiform {
namespace detail {

template <class I, class Less>
void sift_down(I heap, std::ptrdiff_t i, std::ptrdiff_t n, const Less& less) {
    for (std::ptrdiff_t child = 2 * i + 1; child < n; i = child, child = 2 * i + 1) {
        if (child + 1 < n && less(heap[child], heap[child + 1])) ++child;
        if (!less(heap[i], heap[child])) return;
        std::swap(heap[i], heap[child]);
    }
}

// Quicksort [Hoare 1962] about the median of three; what is short by insertion, and what does not become
// short after `depth` steps by a heap [Williams 1964]. A fifth of the code of std::sort, of which the web
// module would have 65 instances.
template <class I, class Less>
void small_sort(I first, I last, const Less& less, int depth) {
    while (last - first > 16) {
        const std::ptrdiff_t n = last - first;
        if (depth-- == 0) {
            for (std::ptrdiff_t i = n / 2; i-- > 0;) sift_down(first, i, n, less);
            for (std::ptrdiff_t i = n; i-- > 1;) std::swap(first[0], first[i]), sift_down(first, 0, i, less);
            return;
        }
        // The median comes first; one that is not less than it is last, where the way up ends.
        const I middle = first + n / 2, back = last - 1;
        if (less(*back, *middle)) std::swap(*back, *middle);
        if (less(*middle, *first)) {
            std::swap(*middle, *first);
            if (less(*back, *middle)) std::swap(*back, *middle);
        }
        std::swap(*first, *middle);
        I up = first, down = last;
        for (;;) {
            do ++up;
            while (up < back && less(*up, *first));
            do --down;
            while (down > first && less(*first, *down));
            if (up >= down) break;
            std::swap(*up, *down);
        }
        std::swap(*first, *down);
        const bool left_is_short = down - first < last - down;
        small_sort(left_is_short ? first : down + 1, left_is_short ? down : last, less, depth);
        (left_is_short ? first : last) = left_is_short ? down + 1 : down;
    }
    for (I i = first; i < last; ++i) {
        auto x = std::move(*i);
        I at = i;
        for (; at > first && less(x, at[-1]); --at) *at = std::move(at[-1]);
        *at = std::move(x);
    }
}

struct Sort {
    template <std::random_access_iterator I, class Less = std::less<>, class Key = std::identity>
    constexpr void operator()(I first, I last, Less less = {}, Key key = {}) const {
        const auto before = [&](const auto& a, const auto& b) {
            return bool(std::invoke(less, std::invoke(key, a), std::invoke(key, b)));
        };
#ifdef __wasm__
        small_sort(first, last, before, 2 * int(std::bit_width(std::size_t(last - first))));
#else
        std::sort(first, last, before);
#endif
    }
    template <std::ranges::random_access_range Range, class Less = std::less<>, class Key = std::identity>
    constexpr void operator()(Range&& range, Less less = {}, Key key = {}) const {
        (*this)(std::ranges::begin(range), std::ranges::end(range), std::move(less), std::move(key));
    }
};

}  // namespace detail

inline constexpr detail::Sort sort;

}  // namespace freiform
