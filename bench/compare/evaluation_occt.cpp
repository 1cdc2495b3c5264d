// The tasks of evaluation.cpp with Open CASCADE: single values directly, rows and curves through the
// adaptors, which keep the piece they were in.
#include "occt_curve.hpp"

#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <evaluation_tasks.hpp>
#include <memory>

namespace {

using namespace freiform::bench;

gp_Vec normal_of(const gp_Vec& a, const gp_Vec& b) { return a.Crossed(b).Normalized(); }

// One task for each point of the plots.
void sweep() {
    each_sweep([](int points, int degree, int size) {
        const Handle(Geom_BSplineSurface) surface = surface_of(rough(degree, size));
        const std::size_t n = std::size_t(points);
        const auto u = std::make_shared<std::vector<double>>(scattered(2001, n));
        const auto v = std::make_shared<std::vector<double>>(scattered(2002, n));
        const auto out = std::make_shared<std::vector<gp_Pnt>>(n);
        task(
            sweep_name("sweep", points, degree, size), n,
            [=] {
                for (std::size_t i = 0; i < n; ++i) surface->D0((*u)[i], (*v)[i], (*out)[i]);
            },
            [=] { return (*out)[0].Z(); });
    });
}

}  // namespace

int main(int argc, char** argv) {
    const Handle(Geom_BSplineSurface) surface = surface_of(hills());
    const GeomAdaptor_Surface adaptor(surface);
    const auto c = helix();
    std::vector<std::array<double, 4>> net;
    for (std::size_t i = 0; i < c.weights.size(); ++i) {
        const double w = c.weights[i];
        net.push_back({w * c.points[3 * i], w * c.points[3 * i + 1], w * c.points[3 * i + 2], w});
    }
    const GeomAdaptor_Curve curve(bspline(Poles(net), c.knots, 3, true));
    const auto u = scattered(2001), v = scattered(2002), axis = grid_axis();
    const auto random = scattered(4001), in_order = sorted(random);
    constexpr std::size_t kPlace = 123456, n = kPoints;
    std::vector<gp_Pnt> out(n);
    std::vector<gp_Vec> d1(n), d2(n), normals(n);
    const auto x = [&] { return out[kPlace].X(); };
    const auto normal_x = [&] { return normals[kPlace].X(); };
    task(
        "scattered", n,
        [&] {
            for (std::size_t i = 0; i < n; ++i) surface->D0(u[i], v[i], out[i]);
        },
        x);
    task(
        "scattered_d1_normal", n,
        [&] {
            for (std::size_t i = 0; i < n; ++i) {
                surface->D1(u[i], v[i], out[i], d1[i], d2[i]);
                normals[i] = normal_of(d1[i], d2[i]);
            }
        },
        normal_x);
    task(
        "grid", n,
        [&] {
            for (std::size_t i = 0, k = 0; i < axis.size(); ++i)
                for (std::size_t j = 0; j < axis.size(); ++j, ++k) adaptor.D0(axis[i], axis[j], out[k]);
        },
        x);
    task(
        "grid_normal", n,
        [&] {
            for (std::size_t i = 0, k = 0; i < axis.size(); ++i)
                for (std::size_t j = 0; j < axis.size(); ++j, ++k) {
                    adaptor.D1(axis[i], axis[j], out[k], d1[k], d2[k]);
                    normals[k] = normal_of(d1[k], d2[k]);
                }
        },
        normal_x);
    const auto along = [&](const char* name, const std::vector<double>& at) {
        task(
            name, n,
            [&] {
                for (std::size_t i = 0; i < n; ++i) curve.D0(at[i], out[i]);
            },
            x);
    };
    const auto derivatives = [&](const char* name, const std::vector<double>& at) {
        task(
            name, n,
            [&] {
                for (std::size_t i = 0; i < n; ++i) curve.D2(at[i], out[i], d1[i], d2[i]);
            },
            [&] { return d2[kPlace].X(); });
    };
    along("curve_sorted", in_order);
    along("curve_random", random);
    derivatives("curve_sorted_d2", in_order);
    derivatives("curve_random_d2", random);
    sweep();
    return run_tasks(argc, argv);
}
