// What kernels are given and give back, as bytes through a pipe: for kernels that run in another program, on
// a processor of another kind with the same layout of data (64 bits, little-endian).
#pragma once
#include <cstdio>
#include <cstdlib>
#include <kernel/evaluate.hpp>
#include <vector>

namespace freiform::test {

enum class Call : int { scattered, weights, grid_row, combine, inside };

// Pipes between programs. A broken pipe ends the program: nothing can be tested then.
struct Wire {
    std::FILE* to = nullptr;
    std::FILE* from = nullptr;

    template <class T>
    void put(const T* p, std::size_t n) {
        if (n > 0 && std::fwrite(p, sizeof(T), n, to) != n) std::abort();
    }
    template <class T>
    void put(const T& x) {
        put(&x, 1);
    }
    template <class T>
    void get(T* p, std::size_t n) {
        if (n > 0 && std::fread(p, sizeof(T), n, from) != n) std::abort();
    }
    template <class T>
    T get() {
        T x;
        get(&x, 1);
        return x;
    }
    template <class T>
    std::vector<T> get_many(std::size_t n) {
        std::vector<T> x(n);
        get(x.data(), n);
        return x;
    }
};

inline std::size_t records_of(const kernel::Axis& axis) {
    return std::size_t(axis.spans + axis.steps) * axis.stride;
}

// Up to the last number that a kernel may read.
inline std::size_t coefficients_of(const kernel::Net& net) {
    if (net.axes == 1) return 0;
    std::size_t last = 0;
    for (int d = 0; d < net.axes; ++d) {
        const kernel::Axis& axis = net.axis[d];
        const auto* s =
            reinterpret_cast<const kernel::Span*>(axis.record + std::size_t(axis.spans - 1) * axis.stride);
        last += s->coefficients + std::size_t(axis.degree) * net.stride[d];
    }
    return net.plane + last + 4 + 8;
}

// Numbers of one point of the jets.
inline std::size_t size_of(const kernel::Net& net, const kernel::Output& out) {
    return std::size_t(out.slots * net.dim);
}

// Tuples of the outer axes of a grid.
inline std::size_t outer_orders(const kernel::Net& net, int order) {
    return std::size_t(net.axes == 2 ? order + 1 : (order + 1) * (order + 2) / 2);
}

}  // namespace freiform::test
