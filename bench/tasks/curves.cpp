// Tasks on one curve: evaluation, splitting, length, flattening.
#include <freiform/path/flatten.hpp>
#include <freiform/query/length.hpp>
#include <freiform/spline/accurate.hpp>

#include <curve_tasks.hpp>

namespace {

using namespace freiform;

template <class P>
int run(const Curve<P>& curve, const bench::SpaceCurve& c) {
    std::vector<Vec<3>> out(c.random.size());
    bool ok = true;
    const auto evaluate = [&](const char* name, const std::vector<double>& at) {
        const double seconds = bench::shortest([&] { ok = ok && curve.evaluate(at, out).has_value(); });
        std::printf("%s %.9g\n", name, seconds / double(at.size()));
    };
    evaluate("evaluate_sorted", c.sorted);
    evaluate("evaluate_random", c.random);
    std::vector<Accurate<Vec<3>>> accurate(c.random.size());
    const double slow = bench::shortest([&] {
        ok = ok &&
             evaluate_accurate<1, P, BSplineBasis>(curve, c.random, std::span<Accurate<Vec<3>>>(accurate));
    });
    std::printf("evaluate_accurate %.9g\n", slow / double(c.random.size()));
    const double cut = c.lo() + 0.4321 * (c.hi() - c.lo());
    std::printf("split %.9g\n", bench::shortest([&] {
                    ok = ok && restrict_to(curve, 0, {c.lo(), cut}) && restrict_to(curve, 0, {cut, c.hi()});
                }));
    Measure measured;
    const double seconds = bench::shortest([&] { measured = length(curve, bench::kLengthTo); });
    const Measure best = length(curve, 0);
    std::printf("length %.9g value=%a bound=%.3g best=%a best_bound=%.3g\n", seconds, measured.value,
                measured.bound, best.value, best.bound);
    for (const auto& [name, method] : {std::pair("flatten", FlattenMethod::adaptive),
                                       std::pair("flatten_uniform", FlattenMethod::uniform)})
        for (const double tolerance : bench::kFlattenTo) {
            auto line = flatten(curve, {.method = method, .tolerance = tolerance});
            const double time =
                bench::shortest([&] { line = flatten(curve, {.method = method, .tolerance = tolerance}); });
            if (!line) return 1;
            std::vector<bench::Point3> points;
            for (const auto& p : line->points) points.push_back(p.c);
            std::printf(
                "%s_%g %.9g segments=%zu strays=%.6g bound=%.6g\n", name, tolerance, time, line->segments(),
                bench::strays(line->parameters, points, [&](double t) { return curve(t).c; }), line->bound);
        }
    return ok ? 0 : 1;
}

}  // namespace

int main() {
    using namespace freiform;
    const auto c = bench::read_space_curve();
    const auto basis = BSplineBasis::make(c.degree, c.knots);
    if (!basis) return 1;
    const int n = int(c.net.size());
    if (c.rational) {
        std::vector<Hom<3>> net;
        for (const auto& p : c.net) net.push_back({p});
        const auto curve = Curve<Hom<3>>::make({*basis}, Net<1, Hom<3>>({n}, net));
        return curve ? run(*curve, c) : 1;
    }
    std::vector<Vec<3>> net;
    for (const auto& p : c.net) net.push_back({{p[0], p[1], p[2]}});
    const auto curve = Curve<Vec<3>>::make({*basis}, Net<1, Vec<3>>({n}, net));
    return curve ? run(*curve, c) : 1;
}
