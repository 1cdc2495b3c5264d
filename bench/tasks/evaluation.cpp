// Many points of one surface and one curve.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <evaluation_inputs.hpp>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace {

using namespace freiform;

template <std::size_t N>
Net<N, Hom<3>> net_of(const Index<N>& extent, const std::vector<double>& points,
                      const std::vector<double>& weights) {
    std::vector<Hom<3>> c;
    for (std::size_t i = 0; i < weights.size(); ++i)
        c.push_back(weighted(Vec<3>{{points[3 * i], points[3 * i + 1], points[3 * i + 2]}}, weights[i]));
    return {extent, std::move(c)};
}

constexpr std::size_t kPlace = 123456;  // of the sample

// Processors that two threads without memory get: their time over that of the clock.
double processors() {
    const auto now = [](clockid_t clock) {
        timespec t{};
        clock_gettime(clock, &t);
        return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
    };
    set_max_threads(2);
    const double clock = now(CLOCK_MONOTONIC), used = now(CLOCK_PROCESS_CPUTIME_ID);
    parallel_for(200, 1, [](std::size_t) {
        volatile double x = 1;
        for (int i = 0; i < 200000; ++i) x = x * 1.0000001;
    });
    return (now(CLOCK_PROCESS_CPUTIME_ID) - used) / (now(CLOCK_MONOTONIC) - clock);
}

// Two constants over all of the points, in whole lines of memory past the caches where the processor can.
void store_past(std::vector<Vec<3>>& out) {
    double* p = out[0].c.data();
    double* const end = p + 3 * out.size();
#if defined(__SSE2__)
    while (reinterpret_cast<std::uintptr_t>(p) % 64 != 0) *p++ = 1;
    for (; p + 8 <= end; p += 8)
        for (int i = 0; i < 8; i += 2) _mm_stream_pd(p + i, _mm_set_pd(2, 1));
    _mm_sfence();
#endif
    while (p < end) *p++ = 1;
}

int run() {
    const auto s = bench::hills();
    const auto c = bench::helix();
    const int n = bench::SurfaceInput::kSize;
    const auto surface =
        Surface<Hom<3>>::make({*BSplineBasis::make(3, s.knots_u), *BSplineBasis::make(3, s.knots_v)},
                              net_of<2>({n, n}, s.points, s.weights));
    const auto curve = Curve<Hom<3>>::make({*BSplineBasis::make(3, c.knots)},
                                           net_of<1>({bench::CurveInput::kSize}, c.points, c.weights));
    if (!surface || !curve) return 1;
    const auto fast = PreparedPatch<2, Hom<3>>::make(*surface);
    const auto quick = PreparedPatch<1, Hom<3>>::make(*curve);
    if (!fast || !quick) return 1;
    const auto u = bench::scattered(2001), v = bench::scattered(2002);
    std::vector<Param<2>> at;
    for (std::size_t i = 0; i < u.size(); ++i) at.push_back({u[i], v[i]});
    const auto axis = bench::grid_axis();
    const std::array<std::span<const double>, 2> axes{axis, axis};

    std::vector<Vec<3>> out(at.size()), normals(at.size());
    std::vector<Jet<2, 1, Vec<3>>> jets(at.size());
    std::vector<Jet<1, 2, Vec<3>>> curve_jets(at.size());
    bool ok = true;
    const auto x = [&] { return out[kPlace][0]; };
    const auto normal_x = [&] { return normals[kPlace][0]; };
    const auto second_x = [&] { return curve_jets[kPlace].d[2][0]; };
    set_max_threads(1);
    bench::task(
        "scattered", [&] { ok = ok && fast->evaluate(at, out); }, x);
    bench::task(
        "scattered_unprepared", [&] { ok = ok && surface->evaluate(at, out); }, x);
    bench::task(
        "scattered_normal", [&] { ok = ok && fast->evaluate(at, out, normals); }, normal_x);
    bench::task(
        "scattered_d1_normal", [&] { ok = ok && fast->evaluate(at, std::span(jets), std::span(normals)); },
        normal_x);
    bench::task(
        "grid", [&] { ok = ok && fast->evaluate_grid(axes, out); }, x);
    bench::task(
        "grid_normal", [&] { ok = ok && fast->evaluate_grid(axes, out, normals); }, normal_x);
    const auto random = bench::scattered(4001), sorted = bench::sorted(random);
    bench::task(
        "curve_sorted", [&] { ok = ok && quick->evaluate(sorted, out); }, x);
    bench::task(
        "curve_random", [&] { ok = ok && quick->evaluate(random, out); }, x);
    bench::task(
        "curve_sorted_d2", [&] { ok = ok && quick->evaluate(sorted, std::span(curve_jets)); }, second_x);
    bench::task(
        "curve_random_d2", [&] { ok = ok && quick->evaluate(random, std::span(curve_jets)); }, second_x);
    bench::task(
        "scattered_one_thread", [&] { ok = ok && fast->evaluate(at, out); }, x, true);
    set_max_threads(2);
    bench::task(
        "scattered_two_threads", [&] { ok = ok && fast->evaluate(at, out); }, x, true);
    std::vector<float> single(3 * at.size());
    set_max_threads(1);
    bench::task(
        "scattered_single_precision", [&] { ok = ok && fast->evaluate(at, std::span(single)); },
        [&] { return single[3 * kPlace]; });
    // How fast memory takes points of three doubles.
    bench::task(
        "store",
        [&] {
            std::fill(out.begin(), out.end(), Vec<3>{{1, 2, 3}});
        },
        x);
    bench::task(
        "store_past", [&] { store_past(out); }, x);
    std::printf("# kernels %s bound %.3g processors %.2f\n", std::string(instruction_set()).c_str(),
                fast->value_error_bound(), processors());
    return ok ? 0 : 1;
}

}  // namespace

int main() { return run(); }
