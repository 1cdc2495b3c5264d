// A sequence that takes up another one as it is: what parts have made need not be copied.
#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace freiform {

// Places are numbers, given by what adds to the sequence. They follow each other until another sequence is
// taken up, whose places come behind a gap.
template <class T, std::size_t kLongest = (std::size_t(1) << 24)>
class Segments {
public:
    const T& operator[](std::size_t place) const { return segments_[place / kLongest][place % kLongest]; }
    T& operator[](std::size_t place) { return segments_[place / kLongest][place % kLongest]; }
    // Where the next element will be.
    std::size_t end() const {
        if (segments_.empty()) return 0;
        const std::size_t last = segments_.size() - 1;
        return last * kLongest + segments_[last].size();
    }
    std::size_t count() const {
        std::size_t all = 0;
        for (const auto& s : segments_) all += s.size();
        return all;
    }
    // So many elements will not be moved; REQUIRES an empty sequence.
    void reserve(std::size_t elements) { segments_.emplace_back().reserve(std::min(elements, kLongest)); }
    // May move what the last segment has.
    std::size_t add(const T& x) {
        if (segments_.empty() || segments_.back().size() == kLongest) segments_.emplace_back();
        segments_.back().push_back(x);
        return end() - 1;
    }
    // What had the place p in the other one has the place p more than the answer.
    std::size_t take(Segments&& other) {
        const std::size_t shift = segments_.size() * kLongest;
        for (auto& s : other.segments_) segments_.push_back(std::move(s));
        other.segments_.clear();
        return shift;
    }
    // Calls visit(place) for every element, in the order of their places.
    template <class Visit>
    void each_place(Visit&& visit) const {
        for (std::size_t s = 0; s < segments_.size(); ++s)
            for (std::size_t k = 0; k < segments_[s].size(); ++k) visit(s * kLongest + k);
    }

private:
    std::vector<std::vector<T>> segments_;
};

}  // namespace freiform
