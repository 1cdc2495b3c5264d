// Elements that a vector makes without a value: for what is written by several threads afterwards.
#pragma once
#include <memory>
#include <type_traits>
#include <utility>

namespace freiform {

// An allocator: `resize` of its vector touches no memory. What it adds has to be written before it is read.
template <class T>
struct Unfilled : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    template <class U>
    struct rebind {
        using other = Unfilled<U>;
    };
    void construct(T*) {}
    template <class First, class... Args>
    void construct(T* at, First&& first, Args&&... args) {
        std::construct_at(at, std::forward<First>(first), std::forward<Args>(args)...);
    }
};

}  // namespace freiform
