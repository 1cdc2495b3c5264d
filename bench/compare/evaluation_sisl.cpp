// The tasks of evaluation.cpp with SISL. SISL is under the AGPL: this program is for comparison, and never
// shipped.
#include <evaluation_tasks.hpp>
#include <memory>
#include <sisl.h>

namespace {

using namespace freiform::bench;

std::vector<double> homogeneous(const std::vector<double>& points, const std::vector<double>& weights) {
    std::vector<double> h;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) h.push_back(weights[i] * points[3 * i + k]);
        h.push_back(weights[i]);
    }
    return h;
}

// SISL has the first parameter fastest: u and v are exchanged.
SISLSurf* make_surface(SurfaceInput s) {
    auto net = homogeneous(s.points, s.weights);
    return newSurf(s.size, s.size, s.degree + 1, s.degree + 1, s.knots_v.data(), s.knots_u.data(), net.data(),
                   2, 3, 1);
}

// One task for each point of the plots.
void sweep() {
    each_sweep([](int points, int degree, int size) {
        const std::shared_ptr<SISLSurf> surface(make_surface(rough(degree, size)), freeSurf);
        const std::size_t n = std::size_t(points);
        const auto u = std::make_shared<std::vector<double>>(scattered(2001, n));
        const auto v = std::make_shared<std::vector<double>>(scattered(2002, n));
        const auto out = std::make_shared<std::vector<double>>(3 * n);
        task(
            sweep_name("sweep", points, degree, size), n,
            [=] {
                int left1 = 0, left2 = 0, status = 0;
                for (std::size_t i = 0; i < n; ++i) {
                    double at[2] = {(*v)[i], (*u)[i]}, normal[3];
                    s1421(surface.get(), 0, at, &left1, &left2, &(*out)[3 * i], normal, &status);
                }
            },
            [=] { return (*out)[2]; });
    });
}

}  // namespace

int main(int argc, char** argv) {
    auto c = helix();
    auto line = homogeneous(c.points, c.weights);
    SISLSurf* surface = make_surface(hills());
    SISLCurve* curve = newCurve(CurveInput::kSize, 4, c.knots.data(), line.data(), 2, 3, 1);
    if (!surface || !curve) return 1;
    const auto u = scattered(2001), v = scattered(2002), random = scattered(4001), in_order = sorted(random);
    auto axis = grid_axis();
    constexpr std::size_t kPlace = 123456, n = kPoints;
    std::vector<double> out(9 * n), normals(3 * n);
    int left1 = 0, left2 = 0, status = 0;
    bool ok = true;
    task(
        "scattered", n,
        [&] {
            for (std::size_t i = 0; i < n; ++i) {
                double at[2] = {v[i], u[i]}, normal[3];
                s1421(surface, 0, at, &left1, &left2, &out[3 * i], normal, &status);
                ok = ok && status >= 0;
            }
        },
        [&] { return out[3 * kPlace]; });
    task(
        "scattered_d1_normal", n,
        [&] {
            for (std::size_t i = 0; i < n; ++i) {
                double at[2] = {v[i], u[i]}, normal[3];
                s1421(surface, 1, at, &left1, &left2, &out[9 * i], normal, &status);
                const double l =
                    -1 / std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
                for (std::size_t k = 0; k < 3; ++k) normals[3 * i + k] = normal[k] * l;
                ok = ok && status >= 0;
            }
        },
        [&] { return normals[3 * kPlace]; });
    task(
        "grid", n,
        [&] {
            s1506(surface, 0, kGrid, axis.data(), kGrid, axis.data(), out.data(), normals.data(), &status);
            ok = ok && status >= 0;
        },
        [&] { return out[3 * kPlace]; });
    task(
        "grid_normal", n,
        [&] {
            s1506(surface, 1, kGrid, axis.data(), kGrid, axis.data(), out.data(), normals.data(), &status);
            ok = ok && status >= 0;
        },
        [&] { return -normals[3 * kPlace]; });
    const auto along = [&](const char* name, const std::vector<double>& at, int order) {
        const std::size_t size = 3 * std::size_t(order + 1);
        left1 = 0;
        task(
            name, n,
            [&, size, order] {
                for (std::size_t i = 0; i < n; ++i) {
                    s1227(curve, order, at[i], &left1, &out[size * i], &status);
                    ok = ok && status >= 0;
                }
            },
            [&, size] { return out[size * kPlace + size - 3]; });
    };
    along("curve_sorted", in_order, 0);
    along("curve_random", random, 0);
    along("curve_sorted_d2", in_order, 2);
    along("curve_random_d2", random, 2);
    sweep();
    const int failed = run_tasks(argc, argv);
    freeSurf(surface);
    freeCurve(curve);
    return ok ? failed : 1;
}
