// What Boost.Math has for curves: values of uniform cubic splines (one for each coordinate; not the same
// curve, but as many pieces), and adaptive quadrature (over the derivative of this library), which gives
// lengths.
#include <freiform/spline/patch.hpp>

#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <curve_tasks.hpp>

namespace {

using namespace freiform;

template <class P>
void length(const Curve<P>& curve) {
    const Interval on = curve.domain()[0];
    double value = 0;
    const auto breaks = curve.basis().breaks();
    const double seconds = bench::shortest([&] {
        value = 0;
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
            value += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
                [&](double t) { return norm(curve.template jet<1>(t).d[1]); }, breaks[i], breaks[i + 1], 15,
                1e-12);
    });
    std::printf("length %.9g value=%a\n", seconds, on.length() > 0 ? value : 0);
}

}  // namespace

int main() {
    using namespace freiform;
    const auto c = bench::read_space_curve();
    const std::size_t n = c.net.size();
    if (c.degree == 3 && !c.rational) {
        using Spline = boost::math::interpolators::cardinal_cubic_b_spline<double>;
        std::vector<Spline> spline;
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<double> y;
            for (std::size_t i = 0; i + 2 < n; ++i) y.push_back(c.net[i][k]);
            spline.emplace_back(y.data(), y.size(), c.lo(), (c.hi() - c.lo()) / double(y.size() - 1));
        }
        std::vector<bench::Point3> out(c.random.size());
        const auto evaluate = [&](const char* name, const std::vector<double>& at) {
            const double seconds = bench::shortest([&] {
                for (std::size_t i = 0; i < at.size(); ++i)
                    for (std::size_t k = 0; k < 3; ++k) out[i][k] = spline[k](at[i]);
            });
            std::printf("%s %.9g\n", name, seconds / double(at.size()));
        };
        evaluate("evaluate_sorted", c.sorted);
        evaluate("evaluate_random", c.random);
    }
    const auto basis = BSplineBasis::make(c.degree, c.knots);
    if (!basis) return 1;
    if (c.rational) {
        std::vector<Hom<3>> net;
        for (const auto& p : c.net) net.push_back({p});
        length(Curve<Hom<3>>::trusted({*basis}, Net<1, Hom<3>>({int(n)}, net)));
    } else {
        std::vector<Vec<3>> net;
        for (const auto& p : c.net) net.push_back({{p[0], p[1], p[2]}});
        length(Curve<Vec<3>>::trusted({*basis}, Net<1, Vec<3>>({int(n)}, net)));
    }
}
