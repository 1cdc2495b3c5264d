// Room for as many numbers as a block has: on the stack where they are few.
#pragma once
#include <cstddef>
#include <type_traits>
#include <vector>

namespace freiform {

template <class T, std::size_t kFew = 64>
class Room {
public:
    // Room for `size` of them, whose values are not set. What was there before may be lost.
    T* of(std::size_t size) {
        if (size <= kFew) return reinterpret_cast<T*>(few_);
        if (more_.size() < size) more_.resize(size);
        return more_.data();
    }

private:
    static_assert(std::is_trivially_copyable_v<T> && (std::is_aggregate_v<T> || std::is_arithmetic_v<T>));
    alignas(T) std::byte few_[kFew * sizeof(T)];  // creates its objects by itself
    std::vector<T> more_;
};

}  // namespace freiform
