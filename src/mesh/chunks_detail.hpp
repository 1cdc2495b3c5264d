// A sequence that grows without moving what it has, and takes up another one as it is.
#pragma once
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace freiform {

// Places are numbers, given by what adds to the sequence; they need not follow each other. No memory is
// touched before it is written.
template <class T, std::size_t kChunk = 64>
class Chunks {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    const T& operator[](std::size_t place) const { return chunks_[place / kChunk].get()[place % kChunk]; }
    T& operator[](std::size_t place) { return chunks_[place / kChunk].get()[place % kChunk]; }

    std::size_t add(const T& x) {
        if (end_ == chunks_.size() * kChunk) chunks_.push_back(Chunk(std::allocator<T>().allocate(kChunk)));
        std::construct_at(&(*this)[end_], x);
        return end_++;
    }
    // What had the place p in the other one has the place p more than the answer.
    std::size_t take(Chunks&& other) {
        const std::size_t shift = chunks_.size() * kChunk;
        for (auto& c : other.chunks_) chunks_.push_back(std::move(c));
        other.chunks_.clear();
        if (other.end_ > 0) end_ = shift + std::exchange(other.end_, 0);
        return shift;
    }

private:
    struct Free {
        void operator()(T* chunk) const { std::allocator<T>().deallocate(chunk, kChunk); }
    };
    using Chunk = std::unique_ptr<T, Free>;
    std::vector<Chunk> chunks_;
    std::size_t end_ = 0;  // behind the last place
};

}  // namespace freiform
