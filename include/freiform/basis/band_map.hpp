// Banded linear maps, and the one operation behind refinement, conversion and grid evaluation: applying a map
// along one axis of a net.
#pragma once
#include <freiform/basis/blossom.hpp>
#include <freiform/core/net.hpp>

#include <span>
#include <vector>

namespace freiform {

// Row i has its `width` entries in the columns first[i] .. first[i] + width - 1, taken modulo `cols` (they
// reach beyond `cols` on closed bases only).
struct BandMap {
    int cols = 0, width = 0;
    std::vector<int> first;
    std::vector<double> entry;  // rows() x width

    int rows() const { return int(first.size()); }
    std::span<const double> row(int i) const {
        return std::span(entry).subspan(std::size_t(i) * std::size_t(width), std::size_t(width));
    }

    // Applied to numbers: `in` holds `blocks` times cols runs of `run` numbers, `out` as many times rows()
    // runs.
    void apply(const double* in, double* out, std::size_t run, std::size_t blocks) const;
};

// (I x .. x map x .. x I) net. REQUIRES net.extent()[axis] == map.cols.
template <std::size_t N, Coefficient P>
Net<N, P> along(int axis, const BandMap& map, const Net<N, P>& in) {
    FF_REQUIRE(in.extent()[std::size_t(axis)] == map.cols);
    Index<N> extent = in.extent();
    extent[std::size_t(axis)] = map.rows();
    Net<N, P> out(extent);
    std::size_t blocks = 1, run = std::size_t(P::kCoords);
    for (std::size_t d = 0; d < N; ++d)
        if (d != std::size_t(axis)) (d < std::size_t(axis) ? blocks : run) *= std::size_t(extent[d]);
    map.apply(numbers(in.flat()).data(), numbers(out.flat()).data(), run, blocks);
    return out;
}

// first, then second: row i of the result is row i of second * first. REQUIRES first.rows() == second.cols.
BandMap composed(const BandMap& first, const BandMap& second);

// Row i: the values (order 0) or derivatives of the basis at at[i].
template <Basis B>
BandMap collocation(const B& basis, std::span<const double> at, int order = 0) {
    const int width = basis.degree() + 1;
    BandMap m{basis.size(), width, std::vector<int>(at.size()),
              std::vector<double>(at.size() * std::size_t(width))};
    for (std::size_t i = 0; i < at.size(); ++i)
        m.first[i] = weights(basis, at[i], order, &m.entry[i * std::size_t(width)]);
    return m;
}

}  // namespace freiform
