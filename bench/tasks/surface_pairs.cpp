// Intersections of pairs of surfaces: branches as splines with a bound, from the control points on.
#include <freiform/core/parallel.hpp>
#include <freiform/intersect/surface_surface.hpp>

#include <surface_pairs.hpp>

namespace {

using namespace freiform;

template <class P>
Surface<P> surface_of(const bench::SurfaceInput& s) {
    std::vector<P> net;
    for (std::size_t i = 0; i < s.weights.size(); ++i)
        net.push_back(
            Space<P>::lift({{s.points[3 * i], s.points[3 * i + 1], s.points[3 * i + 2]}}, s.weights[i]));
    return *Surface<P>::make({*BSplineBasis::make(3, s.knots_u), *BSplineBasis::make(3, s.knots_v)},
                             Net<2, P>({s.size, s.size}, std::move(net)));
}

template <class P>
bool measure(const bench::SurfacePairTask& task) {
    std::vector<std::array<Surface<P>, 2>> pairs;
    for (int i = 0; i < bench::kSurfacePairs; ++i) {
        const auto pair = bench::surface_pair(task, i);
        pairs.push_back({surface_of<P>(pair[0]), surface_of<P>(pair[1])});
    }
    std::vector<SurfaceIntersection> found(pairs.size());
    bool ok = true;
    const double seconds = bench::shortest([&] {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            auto one =
                intersect(pairs[i][0], pairs[i][1], SurfaceIntersectOptions{.tolerance = task.tolerance});
            ok = ok && one && one->nodes.empty() && one->undecided.empty();
            if (one) found[i] = std::move(*one);
        }
    });
    int branches = 0;
    double length = 0;
    for (const SurfaceIntersection& f : found)
        for (const SurfaceBranch& b : f.branches) {
            ++branches;
            const Interval on = b.curve.domain()[0];
            for (int k = 0; k < 20000; ++k)
                length += norm(b.curve(on.lo + on.length() * (k + 1) / 20000) -
                               b.curve(on.lo + on.length() * k / 20000));
        }
    bench::print_surface_task(task, seconds, branches, length);
    return ok;
}

}  // namespace

int main() {
    set_max_threads(1);
    for (const auto& task : bench::kSurfacePairTasks)
        if (!(task.rational ? measure<Hom<3>>(task) : measure<Vec<3>>(task))) return 1;
}
