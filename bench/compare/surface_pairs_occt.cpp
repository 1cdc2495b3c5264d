// The tasks of surface_pairs.cpp with Open CASCADE. Surfaces are made before the clock starts.
#include <GeomAPI_IntSS.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Curve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <surface_pairs.hpp>

namespace {

struct Knots {
    std::vector<double> at;
    std::vector<int> often;
    explicit Knots(const std::vector<double>& all) {
        for (const double t : all)
            if (!at.empty() && at.back() == t)
                ++often.back();
            else
                at.push_back(t), often.push_back(1);
    }
};

Handle(Geom_BSplineSurface) occt_surface(const freiform::bench::SurfaceInput& s) {
    const int n = s.size;
    TColgp_Array2OfPnt poles(1, n, 1, n);
    TColStd_Array2OfReal weights(1, n, 1, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const std::size_t k = std::size_t(i * n + j);
            poles(i + 1, j + 1) = gp_Pnt(s.points[3 * k], s.points[3 * k + 1], s.points[3 * k + 2]);
            weights(i + 1, j + 1) = s.weights[k];
        }
    const Knots u(s.knots_u), v(s.knots_v);
    const TColStd_Array1OfReal ku(u.at.front(), 1, int(u.at.size())), kv(v.at.front(), 1, int(v.at.size()));
    const TColStd_Array1OfInteger mu(u.often.front(), 1, int(u.at.size())),
        mv(v.often.front(), 1, int(v.at.size()));
    return new Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, 3, 3);
}

}  // namespace

int main() {
    using namespace freiform::bench;
    for (const SurfacePairTask& task : kSurfacePairTasks) {
        std::vector<std::array<Handle(Geom_BSplineSurface), 2>> pairs;
        for (int i = 0; i < kSurfacePairs; ++i) {
            const auto pair = surface_pair(task, i);
            pairs.push_back({occt_surface(pair[0]), occt_surface(pair[1])});
        }
        std::vector<Handle(Geom_Curve)> lines;
        const double seconds = shortest([&] {
            lines.clear();
            for (const auto& [a, b] : pairs) {
                GeomAPI_IntSS meet(a, b, task.tolerance);
                if (meet.IsDone())
                    for (int k = 1; k <= meet.NbLines(); ++k) lines.push_back(meet.Line(k));
            }
        });
        double length = 0;
        for (const Handle(Geom_Curve) & line : lines) {
            const double lo = line->FirstParameter(), hi = line->LastParameter();
            gp_Pnt last = line->Value(lo);
            for (int i = 1; i <= 20000; ++i) {
                const gp_Pnt p = line->Value(lo + (hi - lo) * i / 20000);
                length += last.Distance(p);
                last = p;
            }
        }
        print_surface_task(task, seconds, int(lines.size()), length);
    }
}
