// The tasks of tasks/nearest.cpp with SISL: s1953 and s1954, which look everywhere, and s1957 and s1958,
// which are quick and promise nothing. SISL is under the AGPL: this program is for comparison, and never
// shipped.
#include <cstdlib>
#include <limits>
#include <nearest_tasks.hpp>
#include <sisl.h>

namespace {

using namespace freiform::bench;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kTo = 1e-6;

std::vector<double> homogeneous(const std::vector<double>& points, const std::vector<double>& weights) {
    std::vector<double> h;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) h.push_back(weights[i] * points[3 * i + k]);
        h.push_back(weights[i]);
    }
    return h;
}

// The nearest of the places and of the starts of the stretches that came back; frees them.
template <std::size_t N, class Task>
std::array<double, N> nearest_of(const Task& task, const Place3& q, int points, double* at, int stretches,
                                 SISLIntcurve** stretch) {
    std::array<double, N> best;
    best.fill(kNone);
    double least = 1e300;
    const auto look = [&](const double* t) {
        std::array<double, N> own;
        for (std::size_t d = 0; d < N; ++d) own[d] = t[N - 1 - d];
        const double x = apart(task.at(own), q);
        if (x < least) least = x, best = own;
    };
    for (int k = 0; k < points; ++k) look(at + N * std::size_t(k));
    for (int k = 0; k < stretches; ++k) look(stretch[k]->epar1);
    std::free(at);
    if (stretch) freeIntcrvlist(stretch, stretches);
    return best;
}

}  // namespace

int main() {
    const auto on_curve = nearest_on_curve();
    auto c = on_curve.input;
    auto line = homogeneous(c.points, c.weights);
    SISLCurve* curve = newCurve(int(c.weights.size()), 4, c.knots.data(), line.data(), 2, 3, 1);
    const auto on_surface = nearest_on_surface();
    auto s = on_surface.input;
    auto net = homogeneous(s.points, s.weights);
    // SISL has the first parameter fastest: u and v are exchanged.
    SISLSurf* surface = newSurf(int(s.knots_v.size()) - 4, int(s.knots_u.size()) - 4, 4, 4, s.knots_v.data(),
                                s.knots_u.data(), net.data(), 2, 3, 1);
    if (!curve || !surface) return 1;
    const auto true_on_curve = on_curve.true_distances(), true_on_surface = on_surface.true_distances();
    on_curve.judge("", true_on_curve, [&](auto& found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            Place3 q = on_curve.queries[i];
            int points = 0, stretches = 0, status = 0;
            double* at = nullptr;
            SISLIntcurve** stretch = nullptr;
            s1953(curve, q.data(), 3, 0.0, kTo, &points, &at, &stretches, &stretch, &status);
            found[i] = nearest_of<1>(on_curve, q, points, at, stretches, stretch);
        }
    });
    on_curve.judge("_quick", true_on_curve, [&](auto& found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            Place3 q = on_curve.queries[i];
            int status = 0;
            double at = 0, distance = 0;
            s1957(curve, q.data(), 3, 0.0, kTo, &at, &distance, &status);
            found[i] = {status >= 0 ? at : kNone};
        }
    });
    on_surface.judge("", true_on_surface, [&](auto& found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            Place3 q = on_surface.queries[i];
            int points = 0, stretches = 0, status = 0;
            double* at = nullptr;
            SISLIntcurve** stretch = nullptr;
            s1954(surface, q.data(), 3, 0.0, kTo, &points, &at, &stretches, &stretch, &status);
            found[i] = nearest_of<2>(on_surface, q, points, at, stretches, stretch);
        }
    });
    on_surface.judge("_quick", true_on_surface, [&](auto& found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
            Place3 q = on_surface.queries[i];
            int status = 0;
            double at[2] = {}, distance = 0;
            s1958(surface, q.data(), 3, 0.0, kTo, at, &distance, &status);
            found[i] = {status >= 0 ? at[1] : kNone, status >= 0 ? at[0] : kNone};
        }
    });
    freeCurve(curve);
    freeSurf(surface);
}
