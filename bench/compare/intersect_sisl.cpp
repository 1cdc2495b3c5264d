// The tasks of intersect.cpp with SISL: s1857. SISL is under the AGPL: this program is for comparison, and
// never shipped. Its intersections of surfaces, s1859, do not end on some of the pairs, so they have no row.
#include <cstdlib>
#include <intersect_tasks.hpp>
#include <sisl.h>

namespace {

constexpr double kTo = 1e-9;

SISLCurve* curve_of(const freiform::bench::PlaneSpline& s) {
    std::vector<double> knots = s.knots, net;
    for (const auto& p : s.points) net.insert(net.end(), p.begin(), p.end());
    return newCurve(int(s.points.size()), 4, knots.data(), net.data(), 1, 2, 1);
}

}  // namespace

int main() {
    using namespace freiform::bench;
    for (const IntersectTask& task : kIntersectTasks) {
        const auto pairs = plane_pairs(task.count, task.points, task.seed);
        std::vector<std::array<SISLCurve*, 2>> curves;
        for (const PlanePair& p : pairs) curves.push_back({curve_of(p.curve[0]), curve_of(p.curve[1])});
        std::vector<std::vector<Meeting>> found(pairs.size());
        const double seconds = shortest([&] {
            for (std::size_t i = 0; i < curves.size(); ++i) {
                found[i].clear();
                int points = 0, stretches = 0, status = 0;
                double *a = nullptr, *b = nullptr;
                SISLIntcurve** stretch = nullptr;
                s1857(curves[i][0], curves[i][1], 1e-12, kTo, &points, &a, &b, &stretches, &stretch, &status);
                for (int k = 0; k < points; ++k) found[i].push_back({a[k], b[k]});
                std::free(a), std::free(b);
                if (stretch) freeIntcrvlist(stretch, stretches);
            }
        });
        Judged judged;
        for (std::size_t i = 0; i < pairs.size(); ++i) judged.add(pairs[i].truth, found[i]);
        print_task(task.name, "", seconds / task.count, judged);
        for (const auto& pair : curves) freeCurve(pair[0]), freeCurve(pair[1]);
    }
}
