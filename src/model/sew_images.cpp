// Idea. Trimmed surfaces that were read by themselves have edges of one face, which are nothing but parameter
// curves. Their images in space (make/image_curve.hpp) are exact up to the rounding of control points, and
// only with these can edges be compared. Where an image has too high a degree, a spline of degree 3 follows
// it: Hermite's between nodes, twice as many until edge_gap proves that it is near enough; that bound becomes
// the tolerance of the edge, and an approximation of the model. What has neither stays as it is. An image
// whose control points are one point is a pole: the edge is degenerate from here on, and its two vertices are
// one.
#include "sewer_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/model/edge_gap.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// The largest distance of control points from the first, and of the first from the origin.
std::array<double, 2> spread_of_image(const CurveGeometry<3>& curve) {
    return visit_one(
        [](const auto& c) -> std::array<double, 2> {
            if constexpr (requires { c.net(); }) {
                const Vec<3> first = project(c.net().flat().front());
                double most = 0;
                for (const auto& p : c.net().flat()) most = std::max(most, max_abs(project(p) - first));
                return {most, max_abs(first)};
            }
            return {kInfinity, 0};
        },
        curve);
}

constexpr double kImageShare = 1.0 / 32;  // of the tolerance of sewing
constexpr std::size_t kMostImageNodes = 4096;

struct FollowingImage {
    CurveGeometry<3> curve;
    double bound = 0;
};

// The breaks of the parameter curve, which may have kinks there.
std::vector<double> image_breaks(const CurveGeometry<2>& flat) {
    return visit_one(
        [](const auto& c) -> std::vector<double> {
            if constexpr (requires { c.net(); }) {
                const auto breaks = c.basis().breaks();
                return {breaks.begin(), breaks.end()};
            }
            return {};
        },
        flat);
}

// Through t -> surface(flat(t)) at the nodes, with its derivatives on both sides of them.
CurveGeometry<3> hermite_image(const SurfaceGeometry& surface, const CurveGeometry<2>& flat,
                               std::span<const double> nodes) {
    const auto domain_of_surface = domain(surface);
    const auto place = [&](double t) {
        Vec<2> uv = jet<0>(flat, t).value();
        for (int d = 0; d < 2; ++d) uv[d] = clamped(uv[d], domain_of_surface[std::size_t(d)]);
        return uv;
    };
    const auto slope = [&](double at, double beside) {
        const auto s = jet<1>(surface, place(at).c);
        const Vec<2> d = jet<1>(flat, beside)(1);
        return d[0] * s(1, 0) + d[1] * s(0, 1);
    };
    const auto value = [&](double t) { return jet<0>(surface, place(t).c).value(); };
    std::vector<double> knots{nodes.front()};
    std::vector<Vec<3>> net{value(nodes.front())};
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const double a = nodes[k], b = nodes[k + 1], third = (b - a) / 3;
        knots.insert(knots.end(), 3, a);
        const Vec<3> from = net.back(), to = value(b);
        net.push_back(from + third * slope(a, a));
        net.push_back(to - third * slope(b, std::nextafter(b, a)));
        net.push_back(to);
    }
    knots.insert(knots.end(), 4, nodes.back());
    const int size = int(net.size());
    return Curve<Vec<3>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                  Net<1, Vec<3>>({size}, std::move(net)));
}

std::optional<FollowingImage> following_image(const SurfaceGeometry& surface, const CurveGeometry<2>& flat,
                                              double allowed) {
    std::vector<double> nodes = image_breaks(flat);
    if (nodes.size() < 2) return {};
    const DerivativeQuery<2, 3> query(surface);
    while (nodes.size() <= kMostImageNodes) {
        const CurveGeometry<3> curve = hermite_image(surface, flat, nodes);
        const EdgeGap gap =
            edge_gap(query, flat, curve, {nodes.front(), nodes.back()}, {.target = allowed / 2});
        if (gap.bound <= allowed) return FollowingImage{curve, gap.bound};
        std::vector<double> finer{nodes.front()};
        for (std::size_t k = 1; k < nodes.size(); ++k) {
            finer.push_back(0.5 * (nodes[k - 1] + nodes[k]));
            finer.push_back(nodes[k]);
        }
        nodes = std::move(finer);
    }
    return {};
}

void give_image(Model& m, const SurfaceGeometry& surface, Coedge& c, double allowed) {
    Edge& e = m.edges[std::size_t(c.edge)];
    const auto flat = parameter_spline(c.curve, e.range);
    if (!flat) return;
    auto image = image_curve(surface, *flat);
    if (!image) {
        const auto following = following_image(surface, *flat, allowed);
        if (!following) return;
        image = following->curve;
        e.tolerance = std::max(e.tolerance, following->bound);
        m.approximations.push_back({text("edges[", c.edge, "]"),
                                    "its curve is a spline that follows its parameter curve",
                                    following->bound});
    }
    const auto [size, from] = spread_of_image(*image);
    if (size <= 64 * kUnitRoundoff * from) {
        const int gone = e.end, stays = e.start;
        for (Edge& other : m.edges)
            for (int* v : {&other.start, &other.end})
                if (*v == gone) *v = stays;
        e.degenerate = true;
        return;
    }
    c.curve = *flat, e.range = domain(*flat)[0], e.curve = *std::move(image);
}

}  // namespace

void give_images(Model& m, double tolerance) {
    const auto owners = owners_of(m);
    for (Face& f : m.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) {
                const Edge& e = m.edges[std::size_t(c.edge)];
                if (!e.curve && !e.degenerate && owners[std::size_t(c.edge)].uses == 1)
                    give_image(m, f.surface, c, kImageShare * tolerance);
            }
}

}  // namespace freiform
