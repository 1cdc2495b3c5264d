// bench-interpolate [--repetitions N]: interpolation of the points that compare/interpolate_scipy.py has as
// well.
#include "report_fields.hpp"

#include <freiform/fit/interpolate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>

namespace {

using namespace freiform;
using namespace freiform::bench;

// splitmix64, so that every language makes the same points.
struct Noise {
    std::uint64_t state;
    double next() {
        std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
};

std::vector<Vec<3>> curve_points(int n) {
    Noise noise{9001};
    std::vector<Vec<3>> q;
    for (int i = 0; i < n; ++i) {
        const double s = i / (n - 1.0), turn = 4 * std::numbers::pi * s;
        Vec<3> p{{std::cos(turn) * (1 + 0.3 * std::sin(40 * s)), std::sin(turn), 2 * s}};
        for (int c = 0; c < 3; ++c) p[c] += 0.002 * (noise.next() - 0.5);
        q.push_back(p);
    }
    return q;
}
Net<2, Vec<3>> grid_points(int n) {
    Noise noise{9002};
    Net<2, Vec<3>> q({n, n});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = i / (n - 1.0), y = j / (n - 1.0);
            q.view()({i, j}) = {
                {x, y, 0.15 * std::sin(6 * x) * std::cos(5 * y) + 0.02 * (noise.next() - 0.5)}};
        }
    return q;
}

template <class F>
void measured(json::Writer& w, const std::string& name, int repetitions, F&& job) {
    double bound = 0;
    std::vector<double> ms;
    for (const Seconds& s : repeat(repetitions, 3, [&] { bound = job(); })) ms.push_back(1e3 * s.processor);
    w.key(name).begin_object().key("processor_ms").array(ms).field("bound", bound).end_object();
}

}  // namespace

int main(int count, char** values) {
    int repetitions = 15;
    if (count == 3 && std::string_view(values[1]) == "--repetitions")
        repetitions = int(number(values[2]).value_or(15));
    json::Writer w;
    w.begin_object();
    for (const int n : {1000, 10000, 100000}) {
        const auto q = curve_points(n);
        const auto at = parameters<3>(q, Spacing::chordal);
        for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::not_a_knot})
            measured(w, text("curve ", n, " ", name_of(ends)), repetitions, [&] {
                return interpolate<3>(q, {3, ends, *at})->bound;
            });
    }
    for (const int n : {50, 100, 200}) {
        const auto q = grid_points(n);
        std::vector<double> at;
        for (int i = 0; i < n; ++i) at.push_back(i / (n - 1.0));
        const AxisSpline axis{3, SplineEnds::not_a_knot, at};
        measured(w, text("grid ", n), repetitions, [&] { return interpolate<2, 3>(q, {axis, axis})->bound; });
    }
    w.end_object();
    std::cout << w.text() << std::endl;
    return 0;
}
