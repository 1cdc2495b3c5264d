// What fuzzers make of the bytes that they are given.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

inline void demand(bool holds) {
    if (!holds) std::abort();
}

struct Bytes {
    const std::uint8_t* at;
    std::size_t left;
    int next() { return left == 0 ? 0 : (--left, *at++); }
    // Any double.
    double any() {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | std::uint64_t(next());
        double x;
        std::memcpy(&x, &bits, 8);
        return x;
    }
};
