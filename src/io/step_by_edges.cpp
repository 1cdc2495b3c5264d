// Faces by their edges, as those of STEP files that have no parameter curves.
#include "step_shape.hpp"
#include "step_tangles.hpp"

#include <freiform/io/face_by_edges.hpp>

namespace freiform {

namespace {

constexpr double kFollows = 1e-9, kRough = 1e-3;  // of the size of the face
constexpr double kMostBeside = 0.02;  // likewise: what lies further beside the surface is no edge of it

// The extent of points on the edges; nothing if one has no curve.
std::optional<double> extent_of(const Model& model, std::span<const std::vector<EdgeUse>> loops) {
    Box<3> box;
    for (const auto& loop : loops)
        for (const EdgeUse& use : loop) {
            const Edge& e = model.edges[std::size_t(use.edge)];
            if (!e.curve) return std::nullopt;
            for (int i = 0; i <= 8; ++i)
                box.add(jet<0>(*e.curve, e.range.lo + e.range.length() * i / 8).value());
        }
    return box.diagonal();
}

}  // namespace

Result<Face> face_by_edges(Model& model, const SurfaceGeometry& surface,
                           std::span<const std::vector<EdgeUse>> loops, double tolerance) {
    const auto size = extent_of(model, loops);
    if (!size) return refuse(RefusalKind::invalid, "edges", "one of them has no curve in space");
    const step::Chart chart(surface, tolerance);
    const std::size_t edges = model.edges.size(), vertices = model.vertices.size();
    const auto as_before = [&](Refusal why) {
        model.edges.resize(edges), model.vertices.resize(vertices);
        return std::unexpected(std::move(why));
    };
    step::LoopBuilder builder(chart, model, tolerance);
    for (const auto& loop : loops) {
        std::vector<step::Use> uses;
        for (const EdgeUse& use : loop) {
            const Edge& e = model.edges[std::size_t(use.edge)];
            auto t =
                step::trace(chart, *e.curve, e.range, kFollows * *size, std::max(tolerance, kRough * *size));
            if (!t) return as_before(t.error());
            if (!(t->gap <= std::max(tolerance, kMostBeside * *size)))
                return as_before(
                    {RefusalKind::ill_conditioned, text("edges[", use.edge, "]"),
                     text("lies ", t->gap, " beside the surface; the face has a size of ", *size)});
            uses.push_back(step::make_use({use.edge, use.reversed, std::move(t->curve)}, e));
            uses.back().gap = t->gap, uses.back().fitted = t->fitted;
        }
        if (!uses.empty()) builder.add(std::move(uses));
    }
    const auto made = builder.finish();
    if (!made) return as_before(made.error());
    if (step::is_tangled(*made, model, chart))
        return as_before({RefusalKind::invalid, "loops", "the boundary touches itself"});
    Face out;
    Box<2> used;
    for (const auto& uses : *made) {
        Loop& loop = out.loops.emplace_back();
        for (const step::Use& u : uses) {
            loop.coedges.push_back(u.coedge);
            const Interval range = model.edges[std::size_t(u.coedge.edge)].range;
            for (int k = 0; k <= 4; ++k)
                used.add(jet<0>(u.coedge.curve, range.lo + range.length() * k / 4).value());
        }
    }
    out.surface = step::unwound(chart.surface(), chart, used);
    out.tolerance = tolerance;
    return out;
}

}  // namespace freiform
