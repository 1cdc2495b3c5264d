// The tasks of curves.cpp with Open CASCADE, by its own means: the adaptor, which caches the piece it was in.
#include "occt_curve.hpp"

#include <GCPnts_AbscissaPoint.hxx>
#include <GCPnts_QuasiUniformDeflection.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GCPnts_UniformDeflection.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <curve_tasks.hpp>

namespace {

using namespace freiform::bench;

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
    const Handle(Geom_BSplineCurve) curve = bspline(Poles(c.net), c.knots, c.degree, c.rational);
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
