// Coefficients of any kind as plain numbers: for what depends neither on the number of parameters nor on that
// of coordinates, and is therefore compiled once.
#pragma once
#include <freiform/core/hom.hpp>

#include <span>

namespace freiform {

// Tuples of `size` numbers; of rational ones the last is the weight.
struct Tuples {
    std::span<const double> all;
    int size = 1;
    bool rational = false;

    int dim() const { return size - int(rational); }
    std::size_t count() const { return all.size() / std::size_t(size); }
    const double* operator[](std::size_t i) const { return all.data() + i * std::size_t(size); }
    double weight(std::size_t i) const { return rational ? (*this)[i][size - 1] : 1; }
    // Coordinates that a tuple does not have are 0. REQUIRES dim() <= 4.
    Vec<4> numerator(std::size_t i) const;
    Vec<4> point(std::size_t i) const;
};

template <class P>
Tuples tuples(std::span<const P> all) {
    return {numbers(all), P::kCoords, Space<P>::kRational};
}

}  // namespace freiform
