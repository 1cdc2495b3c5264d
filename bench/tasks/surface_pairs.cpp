// Intersections of pairs of surfaces: branches as splines with a bound, from the control points on.
#include <freiform/core/parallel.hpp>
#include <freiform/intersect/surface_surface.hpp>

#include <chrono>
#include <nasty_pairs.hpp>
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

// One call each, at 1e-6: how long it takes, and what it says.
void measure_nasty() {
    const auto hills = surface_of<Hom<3>>(bench::hills_over(10, 8300, false, 0, 1));
    for (const bench::NastyPair& pair : bench::nasty_pairs(hills)) {
        const auto begin = std::chrono::steady_clock::now();
        const auto found = intersect(pair.a, pair.b, SurfaceIntersectOptions{.tolerance = 1e-6});
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        if (!found) {
            std::printf("nasty:%s failed\n", pair.name.c_str());
            continue;
        }
        int tangent = 0, overlaps = 0, open = int(found->undecided.size()), along = 0, points = 0;
        for (const SurfaceBranch& b : found->branches) tangent += b.kind == SurfaceBranchKind::tangent;
        for (const SurfaceNode& n : found->nodes) {
            overlaps += n.kind == SurfaceNodeKind::overlap, along += n.kind == SurfaceNodeKind::along;
            points += n.kind == SurfaceNodeKind::touch || n.kind == SurfaceNodeKind::crossing;
        }
        std::printf("nasty:%s %.9g crossing=%d tangent=%d points=%d overlaps=%d along=%d undecided=%d\n",
                    pair.name.c_str(), took.count(), int(found->branches.size()) - tangent, tangent, points,
                    overlaps, along, open);
    }
}

}  // namespace

int main() {
    set_max_threads(1);
    for (const auto& task : bench::kSurfacePairTasks)
        if (!(task.rational ? measure<Hom<3>>(task) : measure<Vec<3>>(task))) return 1;
    measure_nasty();
}
