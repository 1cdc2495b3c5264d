// The tasks of intersect.cpp with Open CASCADE. Curves are made before the clock starts.
#include <Geom2dAPI_InterCurveCurve.hxx>
#include <Geom2dInt_GInter.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <IntRes2d_IntersectionPoint.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <intersect_tasks.hpp>

namespace {

Handle(Geom2d_Curve) plane_curve(const freiform::bench::PlaneSpline& s) {
    const int n = int(s.points.size());
    TColgp_Array1OfPnt2d poles(1, n);
    for (int i = 0; i < n; ++i)
        poles(i + 1) = gp_Pnt2d(s.points[std::size_t(i)][0], s.points[std::size_t(i)][1]);
    if (n == 4) return new Geom2d_BezierCurve(poles);
    std::vector<double> at;
    std::vector<int> often;
    for (const double t : s.knots) {
        if (!at.empty() && at.back() == t)
            ++often.back();
        else
            at.push_back(t), often.push_back(1);
    }
    const TColStd_Array1OfReal knots(at.front(), 1, int(at.size()));
    const TColStd_Array1OfInteger multiplicities(often.front(), 1, int(often.size()));
    return new Geom2d_BSplineCurve(poles, knots, multiplicities, 3);
}

}  // namespace

int main() {
    using namespace freiform::bench;
    for (const IntersectTask& task : kIntersectTasks) {
        const auto pairs = plane_pairs(task.count, task.points, task.seed);
        std::vector<std::array<Handle(Geom2d_Curve), 2>> curves;
        for (const PlanePair& p : pairs) curves.push_back({plane_curve(p.curve[0]), plane_curve(p.curve[1])});
        std::vector<std::vector<Meeting>> found(pairs.size());
        const double seconds = shortest([&] {
            for (std::size_t i = 0; i < curves.size(); ++i) {
                found[i].clear();
                Geom2dAPI_InterCurveCurve meet(curves[i][0], curves[i][1], 1e-9);
                for (int k = 1; k <= meet.NbPoints(); ++k) {
                    const IntRes2d_IntersectionPoint& p = meet.Intersector().Point(k);
                    found[i].push_back({p.ParamOnFirst(), p.ParamOnSecond()});
                }
            }
        });
        Judged judged;
        for (std::size_t i = 0; i < pairs.size(); ++i) judged.add(pairs[i].truth, found[i]);
        print_task(task.name, "", seconds / task.count, judged);
    }
}
