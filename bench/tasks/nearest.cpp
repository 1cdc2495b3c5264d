// Nearest points of a curve and of a surface, with a proof that they are, and as near as 1e-9.
#include <freiform/core/parallel.hpp>
#include <freiform/query/nearest.hpp>

#include <nearest_tasks.hpp>

namespace {

using namespace freiform;

template <std::size_t N, class Input>
bool measure(const bench::NearestTask<Input, N>& task, const std::array<BSplineBasis, N>& bases) {
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = bases[d].size();
    std::vector<Hom<3>> net;
    for (std::size_t i = 0; i < task.input.weights.size(); ++i) {
        const double* p = task.input.points.data() + 3 * i;
        net.push_back(weighted(Vec<3>{{p[0], p[1], p[2]}}, task.input.weights[i]));
    }
    const auto patch = Patch<N, Hom<3>>::make(bases, Net<N, Hom<3>>(extent, std::move(net)));
    if (!patch) return false;
    const auto query = NearestQuery::make(std::array{NearestObject::of(*patch)});
    if (!query) return false;
    std::vector<Vec<3>> points;
    for (const auto& q : task.queries) points.push_back({q});
    std::vector<Nearest<3>> out(points.size());
    const auto truth = task.true_distances();
    bool ok = true;
    for (const double accuracy : {1e-9, 0.0}) {
        task.judge(accuracy > 0 ? "" : "_exact", truth, [&](auto& found) {
            ok = ok && query->template nearest<3>(points, out, {.accuracy = accuracy}).has_value();
            for (std::size_t i = 0; i < out.size(); ++i)
                for (std::size_t d = 0; d < N; ++d) found[i][d] = out[i].at[d];
        });
        for (const auto& n : out) ok = ok && n.lower_bound >= n.distance - 1e-7;
    }
    return ok;
}

}  // namespace

int main() {
    set_max_threads(1);
    const auto curve = bench::nearest_on_curve();
    const auto surface = bench::nearest_on_surface();
    const auto t = BSplineBasis::make(3, curve.input.knots), u = BSplineBasis::make(3, surface.input.knots_u),
               v = BSplineBasis::make(3, surface.input.knots_v);
    return t && u && v && measure<1>(curve, {*t}) && measure<2>(surface, {*u, *v}) ? 0 : 1;
}
