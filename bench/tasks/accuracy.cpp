// Values of a curve, each with its bounds: value, accurate value, bound of the accurate value, bound of all
// values.
#include <freiform/spline/accurate.hpp>

#include <curve_values.hpp>

namespace {

using namespace freiform;

template <class P, class B>
int answer(const B& basis, const std::vector<P>& net, const std::vector<double>& at) {
    const auto curve = Curve<P, B>::make({basis}, Net<1, P>({int(net.size())}, net));
    if (!curve) {
        std::fprintf(stderr, "%s: %s\n", curve.error().where.c_str(), curve.error().message.c_str());
        return 1;
    }
    std::vector<Vec<1>> plain(at.size());
    std::vector<Accurate<Vec<1>>> accurate(at.size());
    if (!curve->evaluate(at, plain) ||
        !evaluate_accurate<1, P, B>(*curve, at, std::span<Accurate<Vec<1>>>(accurate)))
        return 1;
    const double bound = curve->value_error_bound();
    for (std::size_t i = 0; i < at.size(); ++i)
        std::printf("%a %a %a %a\n", plain[i][0], accurate[i].value[0], accurate[i].bound[0], bound);
    return 0;
}

template <class P>
int answer(const bench::CurveValues& c, const std::vector<P>& net) {
    if (c.is_bezier()) return answer<P, Bernstein>(*Bernstein::make(c.degree), net, c.at);
    const auto basis = BSplineBasis::make(c.degree, c.knots);
    return basis ? answer<P, BSplineBasis>(*basis, net, c.at) : 1;
}

}  // namespace

int main() {
    const auto c = freiform::bench::read_curve();
    std::vector<Vec<1>> polynomial;
    std::vector<Hom<1>> rational;
    for (std::size_t i = 0; i < c.x.size(); ++i) {
        polynomial.push_back({{c.x[i]}});
        rational.push_back({{c.x[i], c.w[i]}});
    }
    return c.rational ? answer(c, rational) : answer(c, polynomial);
}
