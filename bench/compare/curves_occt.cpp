// The tasks of curves.cpp with Open CASCADE, by its own means: the adaptor, which caches the piece it was in.
#include <GCPnts_AbscissaPoint.hxx>
#include <GCPnts_QuasiUniformDeflection.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GCPnts_UniformDeflection.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <curve_tasks.hpp>

namespace {

using namespace freiform::bench;

Handle(Geom_BSplineCurve) make(const SpaceCurve& c) {
    const int n = int(c.net.size());
    TColgp_Array1OfPnt poles(1, n);
    TColStd_Array1OfReal weights(1, n);
    for (int i = 0; i < n; ++i) {
        const auto& p = c.net[std::size_t(i)];
        poles(i + 1) = gp_Pnt(p[0] / p[3], p[1] / p[3], p[2] / p[3]);
        weights(i + 1) = p[3];
    }
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
    if (c.rational) return new Geom_BSplineCurve(poles, weights, knots, multiplicities, c.degree);
    return new Geom_BSplineCurve(poles, knots, multiplicities, c.degree);
}

template <class F>
void flatten(const char* name, double tolerance, const GeomAdaptor_Curve& curve, F&& run) {
    std::vector<double> at;
    std::vector<Point3> points;
    const double seconds = shortest([&] { run(at, points); });
    if (at.empty()) {
        std::printf("%s_%g failed\n", name, tolerance);
        return;
    }
    const auto value = [&](double t) {
        const gp_Pnt p = curve.Value(t);
        return Point3{p.X(), p.Y(), p.Z()};
    };
    std::printf("%s_%g %.9g segments=%zu strays=%.6g\n", name, tolerance, seconds, at.size() - 1,
                strays(at, points, value));
}

template <class A>
void take(const A& polyline, std::vector<double>& at, std::vector<Point3>& points) {
    at.clear();
    points.clear();
    for (int i = 1; i <= polyline.NbPoints(); ++i) {
        const gp_Pnt p = polyline.Value(i);
        at.push_back(polyline.Parameter(i));
        points.push_back({p.X(), p.Y(), p.Z()});
    }
}

}  // namespace

int main() {
    const auto c = read_space_curve();
    const Handle(Geom_BSplineCurve) curve = make(c);
    const GeomAdaptor_Curve adaptor(curve);
    std::vector<gp_Pnt> out(c.random.size());
    const auto evaluate = [&](const char* name, const std::vector<double>& at) {
        const double seconds = shortest([&] {
            for (std::size_t i = 0; i < at.size(); ++i) adaptor.D0(at[i], out[i]);
        });
        std::printf("%s %.9g\n", name, seconds / double(at.size()));
    };
    evaluate("evaluate_sorted", c.sorted);
    evaluate("evaluate_random", c.random);
    const double cut = c.lo() + 0.4321 * (c.hi() - c.lo());
    std::printf("split %.9g\n", shortest([&] {
                    const Handle(Geom_BSplineCurve) left = Handle(Geom_BSplineCurve)::DownCast(curve->Copy()),
                                                    right =
                                                        Handle(Geom_BSplineCurve)::DownCast(curve->Copy());
                    left->Segment(c.lo(), cut);
                    right->Segment(cut, c.hi());
                }));
    double length = 0;
    const double seconds = shortest([&] { length = GCPnts_AbscissaPoint::Length(adaptor, kLengthTo); });
    std::printf("length %.9g value=%a\n", seconds, length);
    for (const double tolerance : kFlattenTo) {
        flatten("flatten_quasi", tolerance, adaptor, [&](auto& at, auto& points) {
            const GCPnts_QuasiUniformDeflection line(adaptor, tolerance);
            if (line.IsDone()) take(line, at, points);
        });
        flatten("flatten_uniform", tolerance, adaptor, [&](auto& at, auto& points) {
            const GCPnts_UniformDeflection line(adaptor, tolerance);
            if (line.IsDone()) take(line, at, points);
        });
        flatten("flatten_tangential", tolerance, adaptor, [&](auto& at, auto& points) {
            const GCPnts_TangentialDeflection line(adaptor, 6.3, tolerance);
            take(line, at, points);
        });
    }
}
