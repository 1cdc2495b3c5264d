// Intersections of pairs of plane curves, and the plain method beside them.
#include <freiform/core/parallel.hpp>
#include <freiform/intersect/curve_curve.hpp>

#include <intersect_tasks.hpp>

int main() {
    using namespace freiform;
    set_max_threads(1);
    for (const bench::IntersectTask& task : bench::kIntersectTasks) {
        const auto pairs = bench::plane_pairs(task.count, task.points, task.seed);
        std::array<std::vector<IntersectCurve<Vec<2>>>, 2> curves;
        for (const auto& pair : pairs)
            for (std::size_t k = 0; k < 2; ++k) {
                std::vector<Vec<2>> net;
                for (const auto& p : pair.curve[k].points) net.push_back({p});
                const auto basis = BSplineBasis::make(3, pair.curve[k].knots);
                if (!basis) return 1;
                const auto curve =
                    Curve<Vec<2>>::make({*basis}, Net<1, Vec<2>>({task.points}, std::move(net)));
                if (!curve) return 1;
                curves[k].emplace_back(*curve);
            }
        std::vector<Intersections<2, 2>> out(pairs.size());
        bool ok = true;
        const double seconds = bench::shortest(
            [&] { ok = ok && intersect<Vec<2>>(curves[0], curves[1], out, {.accuracy = 0}).has_value(); });
        bench::Judged judged, plain;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            std::vector<bench::Meeting> found;
            for (const auto& c : out[i].contacts) found.push_back(c.at);
            for (const auto& o : out[i].overlaps) found.push_back({o.a.lo, o.b.lo});  // there are none
            judged.add(pairs[i].truth, found);
            plain.add(pairs[i].truth, pairs[i].truth);
        }
        bench::print_task(task.name, "", seconds / task.count, judged);
        std::size_t sum = 0;
        const double slow = bench::shortest([&] {
            for (const auto& pair : pairs) sum += bench::PlainSearch(pair).run().size();
        });
        if (!ok || sum == 0) return 1;
        bench::print_task(task.name, "_plain", slow / task.count, plain);
    }
}
