// Many points of one surface and one curve.
#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <evaluation_tasks.hpp>
#include <memory>
#include <patches.hpp>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace {

using namespace freiform;

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

// Points scattered over surfaces of any degree and size, prepared and one by one.
void sweep() {
    bench::each_sweep([](int points, int degree, int size) {
        const auto surface = bench::patch_of(bench::rough(degree, size));
        const auto fast = PreparedPatch<2, Hom<3>>::make(surface);
        const auto u = bench::scattered(2001, std::size_t(points)),
                   v = bench::scattered(2002, std::size_t(points));
        const auto at = std::make_shared<std::vector<Param<2>>>();
        for (std::size_t i = 0; i < u.size(); ++i) at->push_back({u[i], v[i]});
        const auto out = std::make_shared<std::vector<Vec<3>>>(at->size());
        const auto z = [out] { return (*out)[0][2]; };
        bench::task(
            bench::sweep_name("sweep", points, degree, size), at->size(),
            [=] {
                if (!fast->evaluate(*at, *out)) std::abort();
            },
            z);
        if (points != 64 && points != 4096) return;
        bench::task(
            bench::sweep_name("one_by_one", points, degree, size), at->size(),
            [=] {
                for (std::size_t i = 0; i < at->size(); ++i) (*out)[i] = surface((*at)[i]);
            },
            z);
    });
}

int run(int argc, char** argv) {
    const auto surface = bench::patch_of(bench::hills());
    const auto curve = bench::patch_of(bench::helix());
    const auto fast = PreparedPatch<2, Hom<3>>::make(surface);
    const auto quick = PreparedPatch<1, Hom<3>>::make(curve);
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
        "scattered", bench::kPoints, [&] { ok = ok && fast->evaluate(at, out); }, x);
    bench::task(
        "scattered_unprepared", bench::kPoints, [&] { ok = ok && surface.evaluate(at, out); }, x);
    bench::task(
        "scattered_normal", bench::kPoints, [&] { ok = ok && fast->evaluate(at, out, normals); }, normal_x);
    bench::task(
        "scattered_d1_normal", bench::kPoints,
        [&] { ok = ok && fast->evaluate(at, std::span(jets), std::span(normals)); }, normal_x);
    bench::task(
        "grid", bench::kPoints, [&] { ok = ok && fast->evaluate_grid(axes, out); }, x);
    bench::task(
        "grid_normal", bench::kPoints, [&] { ok = ok && fast->evaluate_grid(axes, out, normals); }, normal_x);
    const auto random = bench::scattered(4001), sorted = bench::sorted(random);
    bench::task(
        "curve_sorted", bench::kPoints, [&] { ok = ok && quick->evaluate(sorted, out); }, x);
    bench::task(
        "curve_random", bench::kPoints, [&] { ok = ok && quick->evaluate(random, out); }, x);
    bench::task(
        "curve_sorted_d2", bench::kPoints, [&] { ok = ok && quick->evaluate(sorted, std::span(curve_jets)); },
        second_x);
    bench::task(
        "curve_random_d2", bench::kPoints, [&] { ok = ok && quick->evaluate(random, std::span(curve_jets)); },
        second_x);
    bench::task(
        "scattered_one_thread", bench::kPoints, [&] { ok = ok && fast->evaluate(at, out); }, x, true);
    bench::task(
        "scattered_two_threads", bench::kPoints,
        [&] {
            set_max_threads(2);
            ok = ok && fast->evaluate(at, out);
            set_max_threads(1);
        },
        x, true);
    std::vector<float> single(3 * at.size());
    bench::task(
        "scattered_single_precision", bench::kPoints,
        [&] { ok = ok && fast->evaluate(at, std::span(single)); }, [&] { return single[3 * kPlace]; });
    // How fast memory takes points of three doubles.
    bench::task(
        "store", bench::kPoints,
        [&] {
            std::fill(out.begin(), out.end(), Vec<3>{{1, 2, 3}});
        },
        x);
    bench::task(
        "store_past", bench::kPoints, [&] { store_past(out); }, x);
    sweep();
    const double got = processors();
    set_max_threads(1);
    const int failed =
        bench::run_tasks(argc, argv, std::string(instruction_set()), fast->value_error_bound(), got);
    return ok ? failed : 1;
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv); }
