// Curves and surfaces as Open CASCADE has them, from weighted coefficients and knots that may repeat.
#pragma once
#include "evaluation_inputs.hpp"

#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
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

inline Handle(Geom_BSplineSurface) surface_of(const SurfaceInput& s) {
    TColgp_Array2OfPnt points(1, s.size, 1, s.size);
    TColStd_Array2OfReal weights(1, s.size, 1, s.size);
    for (int i = 0; i < s.size; ++i)
        for (int j = 0; j < s.size; ++j) {
            const std::size_t at = std::size_t(i * s.size + j);
            const double* p = &s.points[3 * at];
            points.SetValue(i + 1, j + 1, gp_Pnt(p[0], p[1], p[2]));
            weights.SetValue(i + 1, j + 1, s.weights[at]);
        }
    const Knots u(s.knots_u), v(s.knots_v);
    return new Geom_BSplineSurface(points, weights, u.at(), v.at(), u.multiplicities(), v.multiplicities(),
                                   s.degree, s.degree);
}

inline Handle(Geom_BSplineCurve)
    bspline(const Poles& poles, const std::vector<double>& knots, int degree, bool rational) {
    const Knots k(knots);
    const TColStd_Array1OfReal at = k.at();
    const TColStd_Array1OfInteger multiplicities = k.multiplicities();
    if (rational) return new Geom_BSplineCurve(poles.points, poles.weights, at, multiplicities, degree);
    return new Geom_BSplineCurve(poles.points, at, multiplicities, degree);
}

}  // namespace freiform::bench
