// A sequence that grows without moving what it has, and takes up another one as it is.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace freiform {

// Places are numbers, given by what adds to the sequence; they need not follow each other.
template <class T, std::size_t kChunk = 64>
class Chunks {
public:
    const T& operator[](std::size_t place) const { return chunks_[place / kChunk][place % kChunk]; }
    T& operator[](std::size_t place) { return chunks_[place / kChunk][place % kChunk]; }

    std::size_t add(const T& x) {
        if (end_ == chunks_.size() * kChunk) chunks_.push_back(std::make_unique<T[]>(kChunk));
        (*this)[end_] = x;
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
    std::vector<std::unique_ptr<T[]>> chunks_;
    std::size_t end_ = 0;  // behind the last place
};

}  // namespace freiform
