// Curves and surfaces as Open CASCADE has them, from weighted coefficients and knots that may repeat.
#pragma once
#include <Geom_BSplineCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <array>
#include <vector>

namespace freiform::bench {

struct Poles {
    TColgp_Array1OfPnt points;
    TColStd_Array1OfReal weights;

    // Weight times x, y, z, and the weight.
    explicit Poles(const std::vector<std::array<double, 4>>& net)
        : points(1, int(net.size())), weights(1, int(net.size())) {
        for (int i = 1; const auto& p : net) {
            points(i) = gp_Pnt(p[0] / p[3], p[1] / p[3], p[2] / p[3]);
            weights(i++) = p[3];
        }
    }
};

struct Knots {
    std::vector<double> distinct;
    std::vector<int> often;
    explicit Knots(const std::vector<double>& knots) {
        for (const double t : knots) {
            if (!distinct.empty() && distinct.back() == t)
                ++often.back();
            else
                distinct.push_back(t), often.push_back(1);
        }
    }
    TColStd_Array1OfReal at() const { return {distinct.front(), 1, int(distinct.size())}; }
    TColStd_Array1OfInteger multiplicities() const { return {often.front(), 1, int(often.size())}; }
};

inline Handle(Geom_BSplineCurve)
    bspline(const Poles& poles, const std::vector<double>& knots, int degree, bool rational) {
    const Knots k(knots);
    const TColStd_Array1OfReal at = k.at();
    const TColStd_Array1OfInteger multiplicities = k.multiplicities();
    if (rational) return new Geom_BSplineCurve(poles.points, poles.weights, at, multiplicities, degree);
    return new Geom_BSplineCurve(poles.points, at, multiplicities, degree);
}

}  // namespace freiform::bench
