// The values that Open CASCADE gives for a curve.
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <curve_values.hpp>

int main() {
    const auto c = freiform::bench::read_curve();
    const int n = int(c.x.size());
    TColgp_Array1OfPnt poles(1, n);
    TColStd_Array1OfReal weights(1, n);
    for (int i = 0; i < n; ++i) {
        const double w = c.w[std::size_t(i)];
        poles(i + 1) = gp_Pnt(c.x[std::size_t(i)] / w, 0, 0);
        weights(i + 1) = w;
    }
    Handle(Geom_Curve) curve;
    if (c.is_bezier()) {
        curve = c.rational ? new Geom_BezierCurve(poles, weights) : new Geom_BezierCurve(poles);
    } else {
        std::vector<double> distinct;
        std::vector<int> often;
        for (double t : c.knots) {
            if (!distinct.empty() && distinct.back() == t)
                ++often.back();
            else
                distinct.push_back(t), often.push_back(1);
        }
        TColStd_Array1OfReal knots(1, int(distinct.size()));
        TColStd_Array1OfInteger multiplicities(1, int(distinct.size()));
        for (std::size_t i = 0; i < distinct.size(); ++i)
            knots(int(i) + 1) = distinct[i], multiplicities(int(i) + 1) = often[i];
        curve = c.rational ? new Geom_BSplineCurve(poles, weights, knots, multiplicities, c.degree)
                           : new Geom_BSplineCurve(poles, knots, multiplicities, c.degree);
    }
    for (double t : c.at) std::printf("%a\n", curve->Value(t).X());
}
