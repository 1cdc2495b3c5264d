// What kernels are given and give back, as bytes through a pipe: for kernels that run in another program, on
// a processor of another kind. Whatever the width of its words is, on the wire a size takes 8 bytes, an int 4
// and a truth value 1; all processors that this meets are little-endian.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <kernel/evaluate.hpp>
#include <type_traits>
#include <vector>

namespace freiform::test {

enum class Call : std::int32_t { scattered, weights, grid_row, combine, inside };

// f(field) for what is said of a thing besides its arrays.
template <class F>
void each_field(kernel::Span& s, F f) {  // of which the numbers travel with the record
    f(s.coefficients), f(s.first);
}
template <class F>
void each_field(kernel::Axis& a, F f) {
    f(a.degree), f(a.spans), f(a.lanes), f(a.stride), f(a.half);
    f(a.lo), f(a.scale), f(a.buckets), f(a.steps);
}
template <class F>
void each_field(kernel::Net& n, F f) {
    f(n.axes), f(n.dim), f(n.rational), f(n.plane);
    for (int d = 0; d < 3; ++d) f(n.stride[d]), each_field(n.axis[d], f);
}
template <class F>
void each_field(kernel::GridAxis& a, F f) {
    f(a.count), f(a.degree), f(a.width), f(a.order), f(a.parts);
}
// What is to be computed. `out` has the pointers on the side where the kernels are.
struct Request {
    kernel::Output out;
    bool jets = false, normals = false, curvatures = false;
};
inline Request request(const kernel::Output& out) {
    return {out, out.jets != nullptr, out.normals != nullptr, out.curvatures != nullptr};
}
template <class F>
void each_field(Request& r, F f) {
    f(r.out.order), f(r.out.slots), f(r.out.past), f(r.jets), f(r.normals), f(r.curvatures);
}

// Pipes between programs. A broken pipe ends the program: nothing can be tested then.
struct Wire {
    std::FILE* to = nullptr;
    std::FILE* from = nullptr;

    template <class T>
    static constexpr bool kAlike =  // the same bytes everywhere
        std::is_same_v<T, double> || std::is_same_v<T, int> || std::is_same_v<T, char> ||
        std::is_same_v<T, bool> || std::is_same_v<T, Call> || std::is_same_v<T, std::uint64_t> ||
        std::is_same_v<T, kernel::GridPart>;
    template <class T>
    static constexpr bool kSize = std::is_same_v<T, std::size_t> && !kAlike<T>;

    template <class T>
    requires kAlike<T>
    void put(const T* p, std::size_t n) {
        if (n > 0 && std::fwrite(p, sizeof(T), n, to) != n) std::abort();
    }
    template <class T>
    void put(const T& x) {
        if constexpr (kAlike<T>) {
            put(&x, 1);
        } else if constexpr (kSize<T>) {
            put(std::uint64_t(x));
        } else {
            T copy = x;
            each_field(copy, [&](const auto& field) { put(field); });
        }
    }
    template <class T>
    requires kAlike<T>
    void get(T* p, std::size_t n) {
        if (n > 0 && std::fread(p, sizeof(T), n, from) != n) std::abort();
    }
    template <class T>
    void get(T& x) {
        if constexpr (kAlike<T>)
            get(&x, 1);
        else if constexpr (kSize<T>)
            x = T(get<std::uint64_t>());
        else
            each_field(x, [&](auto& field) { get(field); });
    }
    template <class T>
    T get() {
        T x{};
        get(x);
        return x;
    }
    template <class T>
    std::vector<T> get_many(std::size_t n) {
        std::vector<T> x(n);
        get(x.data(), n);
        return x;
    }
};

static_assert(sizeof(int) == 4 && sizeof(bool) == 1 && sizeof(kernel::GridPart) == 8);

inline std::size_t spans_of(const kernel::Axis& axis) { return std::size_t(axis.spans + axis.steps); }
inline std::size_t records_of(const kernel::Axis& axis) { return spans_of(axis) * axis.stride; }
inline kernel::Span& span_of(double* record) { return *reinterpret_cast<kernel::Span*>(record); }

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
