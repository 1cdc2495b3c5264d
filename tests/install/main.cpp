// What somebody writes who has only the installed headers and libraries: an exact circle, refined, evaluated
// on several threads, and a refusal.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/patch.hpp>

#include <atomic>
#include <cmath>
#include <cstdio>

using namespace freiform;

int main() {
    const std::vector<Vec<2>> corners{{{1, 0}}, {{1, 1}}, {{0, 1}}};
    const std::vector<double> weights{1, std::sqrt(0.5), 1};
    const auto basis = BSplineBasis::bezier(2);
    const auto coefficients = make_rational<2>(corners, weights);
    if (!basis || !coefficients) return 1;
    const auto arc = Curve<Hom<2>>::make({*basis}, Net<1, Hom<2>>({3}, *coefficients));
    if (!arc) return 2;
    const std::vector<double> knots{0.25, 0.5};
    const auto refined = insert_knots(*arc, 0, knots);
    if (!refined || refined->basis().size() != 5) return 3;

    std::atomic<int> wrong{0};
    parallel_for(1000, 10, [&](std::size_t i) {
        const Vec<2> p = (*refined)(double(i) / 999);
        if (std::abs(norm(p) - 1) > 1e-15) ++wrong;
    });
    if (wrong != 0) return 4;

    const auto refusal = BSplineBasis::make(2, {0, 0, 0, 1, 0.5, 1, 1});
    if (refusal || refusal.error().kind != RefusalKind::invalid) return 5;
    std::printf("a quarter circle of 1000 points; refused: %s: %s\n", refusal.error().where.c_str(),
                refusal.error().message.c_str());
    return 0;
}
