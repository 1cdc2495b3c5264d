// The values that SISL gives for a curve. SISL is under the AGPL: this program is for comparison, and never
// shipped.
#include <curve_values.hpp>
#include <sisl.h>

int main() {
    const auto c = freiform::bench::read_curve();
    const int n = int(c.x.size());
    std::vector<double> knots = c.knots, coefficients;
    for (std::size_t i = 0; i < c.x.size(); ++i) {
        coefficients.push_back(c.x[i]);
        if (c.rational) coefficients.push_back(c.w[i]);
    }
    SISLCurve* curve = newCurve(n, c.degree + 1, knots.data(), coefficients.data(), c.rational ? 2 : 1, 1, 1);
    if (!curve) return 1;
    int left = 0;
    for (double t : c.at) {
        double value[1];
        int status = 0;
        s1221(curve, 0, t, &left, value, &status);
        if (status < 0) return 1;
        std::printf("%a\n", value[0]);
    }
    freeCurve(curve);
}
