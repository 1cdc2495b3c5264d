// A sequence that grows without moving what it has, and takes up another one as it is.
#pragma once
#include <atomic>
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
    // One piece of memory for many chunks, of several sequences and threads: it is asked for and given back
    // at once. Bit by bit that took a tenth of the time where one large face was meshed after the other.
    class Room {
    public:
        explicit Room(std::size_t elements)
            : count_(elements / kChunk + 1), memory_(std::allocator<T>().allocate(count_ * kChunk)) {}
        Room(const Room&) = delete;
        ~Room() { std::allocator<T>().deallocate(memory_, count_ * kChunk); }
        T* next() {  // nothing where no chunk is left
            const std::size_t k = used_++;
            return k < count_ ? memory_ + k * kChunk : nullptr;
        }

    private:
        std::size_t count_;
        T* memory_;
        std::atomic<std::size_t> used_{0};
    };
    // Further chunks are there as long as it has some.
    void use(std::shared_ptr<Room> room) { room_ = std::move(room); }
    const std::shared_ptr<Room>& room() const { return room_; }

    const T& operator[](std::size_t place) const { return chunks_[place / kChunk].get()[place % kChunk]; }
    T& operator[](std::size_t place) { return chunks_[place / kChunk].get()[place % kChunk]; }

    std::size_t add(const T& x) {
        if (end_ == chunks_.size() * kChunk) chunks_.push_back(chunk());
        std::construct_at(&(*this)[end_], x);
        return end_++;
    }
    // What had the place p in the other one has the place p more than the answer. REQUIRES the same room.
    std::size_t take(Chunks&& other) {
        const std::size_t shift = chunks_.size() * kChunk;
        for (auto& c : other.chunks_) chunks_.push_back(std::move(c));
        other.chunks_.clear();
        if (other.end_ > 0) end_ = shift + std::exchange(other.end_, 0);
        return shift;
    }

private:
    struct Free {
        bool is_of_room = false;
        void operator()(T* chunk) const {
            if (!is_of_room) std::allocator<T>().deallocate(chunk, kChunk);
        }
    };
    using Chunk = std::unique_ptr<T, Free>;
    Chunk chunk() const {
        if (T* const p = room_ ? room_->next() : nullptr) return Chunk(p, {true});
        return Chunk(std::allocator<T>().allocate(kChunk));
    }
    std::shared_ptr<Room> room_;
    std::vector<Chunk> chunks_;
    std::size_t end_ = 0;  // behind the last place
};

}  // namespace freiform
