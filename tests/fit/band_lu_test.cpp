// Band systems against Gaussian elimination on the full matrix, in long double.
#include "fit/band_system_detail.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace freiform {
namespace {

using detail::BandLU;
using detail::BandSystem;
using test::Random;
using Real = long double;

std::vector<Real> full_solution(std::vector<std::vector<Real>> a, std::vector<Real> b) {
    const std::size_t n = b.size();
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t p = i;
        for (std::size_t r = i; r < n; ++r)
            if (std::abs(a[r][i]) > std::abs(a[p][i])) p = r;
        std::swap(a[i], a[p]), std::swap(b[i], b[p]);
        for (std::size_t r = i + 1; r < n; ++r) {
            const Real f = a[r][i] / a[i][i];
            for (std::size_t c = i; c < n; ++c) a[r][c] -= f * a[i][c];
            b[r] -= f * b[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t c = i + 1; c < n; ++c) b[i] -= a[i][c] * b[c];
        b[i] /= a[i][i];
    }
    return b;
}

// Diagonals between `weak` and 1: a weak one makes interchanges necessary.
void compare(Random& random, int n, int below, int above, bool closed, double weak, int width) {
    BandSystem s(n, below, above, closed);
    const std::size_t size = std::size_t(n);
    std::vector<std::vector<Real>> full(size, std::vector<Real>(size));
    for (int i = 0; i < n; ++i)
        for (int j = i - below; j <= i + above; ++j) {
            if (!closed && (j < 0 || j >= n)) continue;
            const double x =
                i == j ? weak * (1.5 + random.real(0, 1)) * (below + above + 1) : random.real(-1, 1);
            s.add(i, j, x);
            full[std::size_t(i)][std::size_t(((j % n) + n) % n)] += x;
        }
    ASSERT_FALSE(s.factor().has_value());
    std::vector<double> x(std::size_t(n * width));
    for (double& v : x) v = random.real(-1, 1);
    const auto b = x;
    s.solve(x.data(), std::size_t(width));
    for (int c = 0; c < width; ++c) {
        std::vector<Real> column;
        for (int i = 0; i < n; ++i) column.push_back(b[std::size_t(i * width + c)]);
        const auto exact = full_solution(full, column);
        Real most = 0;
        for (const Real v : exact) most = std::max(most, std::abs(v));
        for (int i = 0; i < n; ++i)
            ASSERT_NEAR(x[std::size_t(i * width + c)], double(exact[std::size_t(i)]),
                        (weak < 1 ? 1e-9 : 1e-13) * double(most))
                << "n " << n << " band " << below << " " << above << " closed " << closed << " width "
                << width;
    }
}

TEST(BandSystem, solves_what_elimination_on_the_full_matrix_solves) {
    Random random(11);
    for (const auto& [below, above] : {std::pair{1, 1}, {2, 2}, {0, 0}, {1, 2}, {3, 1}, {4, 4}, {0, 3}})
        for (int n : {1, 2, 3, 7, 40})
            for (const bool closed : {false, true})
                for (const double weak : {1.0, 1e-3})
                    for (int width : {1, 3, 4, 5, 7}) {
                        if (weak < 1 && (below == 0 || above == 0 || n < 3 || closed)) continue;
                        compare(random, n, std::min(below, closed ? below : n - 1),
                                std::min(above, closed ? above : n - 1), closed, weak, width);
                    }
}

TEST(BandLU, names_the_row_without_a_pivot) {
    for (int band : {1, 2, 3}) {
        BandLU a(6, band, band);
        for (int i = 0; i < 6; ++i) a.at(i, i) = i == 3 ? 0 : 1;
        const auto bad = a.factor();
        ASSERT_TRUE(bad.has_value());
        EXPECT_EQ(*bad, 3);
    }
}

}  // namespace
}  // namespace freiform
