// Segments along edges, by halving.
//
// Faces are drawn each by itself, within the deviation of their surfaces, so that between two of them, or
// beside rounding, a gap of that size may show what is behind. Seams fill it: see surface_renderer.cpp for
// why that suffices.
#include "gpu/rational_pieces_detail.hpp"
#include "gpu/surface_seams_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace freiform {

namespace {

constexpr int kMostHalvings = 10;

// Parameters so near to each other that chords of all curves keep to the tolerance.
std::vector<double> parameters_for(Interval on, int begin, double tolerance,
                                   const std::vector<std::function<Vec<3>(double)>>& curves) {
    struct Part {
        double a, b;
        int depth;
    };
    const auto is_flat = [&](double a, double b) {
        for (const auto& f : curves) {
            const Vec<3> p = f(a), q = f(b);
            for (const double s : {0.25, 0.5, 0.75})
                if (!(norm(f(a + s * (b - a)) - ((1 - s) * p + s * q)) <= tolerance)) return false;
        }
        return true;
    };
    std::vector<Part> stack;
    for (int k = begin; k-- > 0;)
        stack.push_back({on.lo + on.length() * k / begin,
                         k + 1 == begin ? on.hi : on.lo + on.length() * (k + 1) / begin, 0});
    std::vector<double> out{on.lo};
    while (!stack.empty()) {
        const Part p = stack.back();
        stack.pop_back();
        if (p.depth == kMostHalvings || is_flat(p.a, p.b)) {
            out.push_back(p.b);
            continue;
        }
        const double middle = p.a + (p.b - p.a) / 2;
        stack.push_back({middle, p.b, p.depth + 1});
        stack.push_back({p.a, middle, p.depth + 1});
    }
    return out;
}

// The outward normal; at poles that of a place a little inside.
Vec<3> normal_at(const Face& face, const Vec<2>& uv, const Vec<2>& inside) {
    Vec<3> n = normal(face.surface, uv.c);
    if (n == Vec<3>{}) n = normal(face.surface, (uv + 0x1p-10 * (inside - uv)).c);
    return face.reversed ? -n : n;
}

struct Use {
    int face = -1;
    const Coedge* coedge = nullptr;
};

int pieces_of(const Edge& edge, const std::vector<Use>& uses) {
    constexpr int kMost = 256;
    std::size_t n = 1;
    if (edge.curve)
        if (const auto p = rational_pieces(*edge.curve, edge.range)) n = std::max(n, p->size());
    for (const Use& use : uses)
        if (const auto p = rational_pieces(use.coedge->curve, edge.range)) n = std::max(n, p->size());
    return int(std::min(n, std::size_t(kMost)));
}

}  // namespace

std::vector<EdgeSeam> seams_of(const Model& model, double tolerance) {
    std::vector<std::vector<Use>> uses(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (const Loop& loop : model.faces[f].loops)
            for (const Coedge& c : loop.coedges) uses[std::size_t(c.edge)].push_back({int(f), &c});
    std::vector<EdgeSeam> out;
    for (std::size_t e = 0; e < model.edges.size(); ++e) {
        const Edge& edge = model.edges[e];
        if (edge.degenerate || uses[e].empty()) continue;
        std::vector<std::function<Vec<3>(double)>> curves;
        const auto uv_of = [&](const Use& use, double t) {
            const Face& face = model.faces[std::size_t(use.face)];
            return clamped(jet<0>(use.coedge->curve, t).value(), limits(face.surface));
        };
        for (const Use& use : uses[e])
            curves.emplace_back([&, use](double t) {
                return jet<0>(model.faces[std::size_t(use.face)].surface, uv_of(use, t).c).value();
            });
        if (edge.curve) curves.emplace_back([&](double t) { return jet<0>(*edge.curve, t).value(); });
        const auto t = parameters_for(edge.range, pieces_of(edge, uses[e]), tolerance, curves);
        const bool inner =
            std::ranges::all_of(uses[e], [&](const Use& u) { return u.face == uses[e][0].face; });
        const std::size_t first = out.size();
        for (std::size_t i = 0; i < uses[e].size(); ++i) {
            const Face& face = model.faces[std::size_t(uses[e][i].face)];
            const Vec<2> inside =
                uv_of({uses[e][i].face, &face.loops[0].coedges[0]},
                      model.edges[std::size_t(face.loops[0].coedges[0].edge)].range.middle());
            EdgeSeam seam{
                uses[e][i].face, uses[e][i].face, {}, {}, {}, {}, i == 0 && (uses[e].size() == 1 || !inner)};
            for (const double at : t) {
                seam.points.push_back(curves[i](at));
                seam.edge.push_back(edge.curve ? curves.back()(at) : curves[0](at));
                seam.normals.push_back(normal_at(face, uv_of(uses[e][i], at), inside));
            }
            out.push_back(std::move(seam));
        }
        for (std::size_t i = first; i < out.size(); ++i) {
            const auto other = std::find_if(out.begin() + std::ptrdiff_t(first), out.end(),
                                            [&](const EdgeSeam& s) { return s.face != out[i].face; });
            out[i].others = other == out.end() ? out[i].normals : other->normals;
            if (other != out.end()) out[i].other = other->face;
        }
    }
    return out;
}

std::vector<EdgeSeam> seams_of(const SimplexPatch<2, Hom<3>>& triangle, int face, double tolerance) {
    std::vector<EdgeSeam> out;
    for (int edge = 0; edge < 3; ++edge) {
        const auto uv = [edge](double t) {
            return edge == 0 ? Param<2>{1 - t, t} : edge == 1 ? Param<2>{0, 1 - t} : Param<2>{t, 0};
        };
        const auto point = [&](double t) { return triangle(uv(t)); };
        EdgeSeam seam{face, face, {}, {}, {}, {}, true};
        for (const double t : parameters_for({0, 1}, 1, tolerance, {point})) {
            seam.points.push_back(point(t));
            const auto n = normal(triangle, uv(t));
            seam.normals.push_back(n.value_or(Vec<3>{}));
        }
        seam.edge = seam.points, seam.others = seam.normals;
        out.push_back(std::move(seam));
    }
    return out;
}

}  // namespace freiform
