#include <freiform/core/tuples.hpp>

namespace freiform {

Vec<4> Tuples::numerator(std::size_t i) const {
    Vec<4> x;
    for (int k = 0; k < dim(); ++k) x[k] = (*this)[i][k];
    return x;
}

Vec<4> Tuples::point(std::size_t i) const {
    Vec<4> x = numerator(i);
    if (rational)
        for (int k = 0; k < dim(); ++k) x[k] /= weight(i);
    return x;
}

}  // namespace freiform
