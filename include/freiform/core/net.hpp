// Control nets: N-dimensional arrays of coefficients, row-major, the last parameter fastest. A NumPy array of
// shape (n_0, ..., n_{N-1}, D) has the same bytes.
#pragma once
#include <freiform/core/result.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace freiform {

template <std::size_t N>
using Index = std::array<int, N>;

// Number of entries of an array of these extents; -1 if an extent is negative or the product leaves int.
template <std::size_t N>
constexpr long long count_of(const Index<N>& extent) {
    long long n = 1;
    for (int e : extent) {
        if (e < 0) return -1;
        n *= e;
        if (n > 0x7fffffff) return -1;
    }
    return n;
}

// A strided run of coefficients: one row of a net along one axis.
template <class P>
struct Fibre {
    P* first = nullptr;
    int size = 0;
    std::ptrdiff_t stride = 1;

    P& operator[](int i) const { return first[i * stride]; }
};

template <std::size_t N, class P>
struct NetView {
    P* data = nullptr;
    Index<N> extent{};
    std::array<std::ptrdiff_t, N> stride{};

    P& operator()(const Index<N>& at) const {
        std::ptrdiff_t offset = 0;
        for (std::size_t d = 0; d < N; ++d) offset += at[d] * stride[d];
        return data[offset];
    }
    Fibre<P> fibre(int axis, const Index<N>& at) const {
        return {&(*this)(at), extent[std::size_t(axis)], stride[std::size_t(axis)]};
    }
    // The block of extents `size` that begins at `from`.
    NetView window(const Index<N>& from, const Index<N>& size) const {
        return {&(*this)(from), size, stride};
    }
    operator NetView<N, const P>() const { return {data, extent, stride}; }
};

// Calls f(index) for every index inside `extent`, the last component fastest.
template <std::size_t N, class F>
void each_index(const Index<N>& extent, F&& f) {
    for (int e : extent)
        if (e <= 0) return;
    Index<N> at{};
    for (;;) {
        f(std::as_const(at));
        std::size_t d = N;
        while (d > 0 && ++at[d - 1] == extent[d - 1]) at[--d] = 0;
        if (d == 0) return;
    }
}

// Calls f(index) for the first index of every fibre along `axis`.
template <std::size_t N, class F>
void each_fibre(int axis, Index<N> extent, F&& f) {
    extent[std::size_t(axis)] = 1;
    each_index(extent, std::forward<F>(f));
}

template <std::size_t N, class P>
class Net {
public:
    Net() = default;
    // REQUIRES count_of(extent) >= 0. All coefficients are zero.
    explicit Net(const Index<N>& extent) : extent_(extent), data_(std::size_t(count_of(extent))) {}
    // REQUIRES data.size() == count_of(extent); `make` is the checked form.
    Net(const Index<N>& extent, std::vector<P> data) : extent_(extent), data_(std::move(data)) {
        FF_REQUIRE(count_of(extent_) == (long long)(data_.size()));
    }
    static Result<Net> make(const Index<N>& extent, std::vector<P> data) {
        if (count_of(extent) != (long long)(data.size()))
            return refuse(
                RefusalKind::invalid, "net",
                text("extents ask for ", count_of(extent), " coefficients, ", data.size(), " are given"));
        return Net(extent, std::move(data));
    }

    const Index<N>& extent() const { return extent_; }
    NetView<N, P> view() { return {data_.data(), extent_, strides()}; }
    NetView<N, const P> view() const { return {data_.data(), extent_, strides()}; }
    std::span<P> flat() { return data_; }
    std::span<const P> flat() const { return data_; }
    friend bool operator==(const Net&, const Net&) = default;

private:
    std::array<std::ptrdiff_t, N> strides() const {
        std::array<std::ptrdiff_t, N> s{};
        std::ptrdiff_t k = 1;
        for (std::size_t d = N; d-- > 0;) {
            s[d] = k;
            k *= extent_[d];
        }
        return s;
    }
    Index<N> extent_{};
    std::vector<P> data_;
};

}  // namespace freiform
