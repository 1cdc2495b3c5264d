// Derivatives at one place are found with their weights unrolled: to the last bit what the recurrence says.
#include <freiform/basis/blossom.hpp>
#include <freiform/spline/patch.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

namespace freiform {
namespace {

TEST(SinglePlaces, derivatives_of_a_basis_function_are_its_weights_to_the_last_bit) {
    test::Random random(7);
    for (int p = 1; p <= 14; ++p) {
        std::vector<double> knots(std::size_t(p) + 1, -0.3);
        for (int i = 0; i < 4; ++i) knots.push_back(knots.back() + random.real(0.01, 1));
        knots.insert(knots.end(), std::size_t(p) + 1, knots.back() + 0.7);
        const BSplineBasis basis = test::must(BSplineBasis::make(p, knots));
        for (int k = 0; k < basis.size(); ++k) {
            Net<1, Vec<1>> net({basis.size()});
            net.flat()[std::size_t(k)] = Vec<1>{{1}};
            const auto curve = test::must(Curve<Vec<1>>::make({basis}, std::move(net)));
            for (int i = 0; i < 20; ++i) {
                const double u = random.real(basis.domain().lo, basis.domain().hi);
                const auto found = curve.derivatives(u, 3);
                for (int order = 0; order <= 3; ++order) {
                    std::vector<double> w(std::size_t(p) + 1);
                    const int first = weights(basis, u, order, w.data());
                    const double expected = k >= first && k <= first + p ? w[std::size_t(k - first)] : 0.0;
                    EXPECT_EQ(found[std::size_t(order)][0], expected) << p << " " << order << " at " << u;
                }
            }
        }
    }
}

}  // namespace
}  // namespace freiform
