// The tasks of surface_pairs.cpp with Open CASCADE. Surfaces are made before the clock starts.
#include "occt_curve.hpp"

#include <GeomAPI_IntSS.hxx>
#include <Geom_Curve.hxx>
#include <surface_pairs.hpp>

int main() {
    using namespace freiform::bench;
    for (const SurfacePairTask& task : kSurfacePairTasks) {
        std::vector<std::array<Handle(Geom_BSplineSurface), 2>> pairs;
        for (int i = 0; i < kSurfacePairs; ++i) {
            const auto pair = surface_pair(task, i);
            pairs.push_back({freiform::bench::surface_of(pair[0]), freiform::bench::surface_of(pair[1])});
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
