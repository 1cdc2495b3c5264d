// The values that Open CASCADE gives for a curve.
#include "occt_curve.hpp"

#include <Geom_BezierCurve.hxx>
#include <curve_values.hpp>

int main() {
    using namespace freiform::bench;
    const auto c = read_curve();
    std::vector<std::array<double, 4>> net;
    for (std::size_t i = 0; i < c.x.size(); ++i) net.push_back({c.x[i], 0, 0, c.w[i]});
    const Poles poles(net);
    Handle(Geom_Curve) curve;
    if (!c.is_bezier())
        curve = bspline(poles, c.knots, c.degree, c.rational);
    else if (c.rational)
        curve = new Geom_BezierCurve(poles.points, poles.weights);
    else
        curve = new Geom_BezierCurve(poles.points);
    for (double t : c.at) std::printf("%a\n", curve->Value(t).X());
}
