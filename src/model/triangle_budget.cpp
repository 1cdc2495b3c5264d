// Method. Curvature and size of every face at samples say how many triangles it needs (face_mesh.hpp).
// Samples cost as much as the mesh of a simple face: many are taken only where few say that it may come near
// the limit; where they are beyond it by far, and as few others at other places too (one may lie where knots
// are a rounding apart), that is enough. The box of a face is that of points on its parameter
// curves, so a face with holes counts as one without. Each chord of the boundary
// has a triangle, too; those of narrow faces have no others.
#include "stand_ins_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/mesh/chord_triangles.hpp>
#include <freiform/mesh/face_mesh.hpp>

#include <cmath>
#include <numeric>

namespace freiform {

namespace {

constexpr double kFarBelow = 16;   // one from few samples below the limit by more than this, too
constexpr double kHopeless = 256;  // above the limit by more than this
constexpr int kFewSamples = 3, kManySamples = 12;
constexpr std::size_t kFacesAtOnce = 8;  // that a thread looks at

// `at`: first and second derivative at a parameter.
template <class F>
double chords_of(F&& at, Interval on, double tolerance) {
    constexpr int kSamples = 8;
    const double h = on.length() / kSamples;
    double sum = 0;
    for (int k = 0; k < kSamples; ++k) {
        const auto [first, second] = at(on.lo + (k + 0.5) * h);
        const double speed = norm(first);
        const Vec<3> bend = speed > 0 ? second - (dot(second, first) / (speed * speed)) * first : second;
        sum += std::sqrt(norm(bend) * h * h / 8 / tolerance);
    }
    return std::isfinite(sum) ? sum : 0;
}

// Of an edge without a curve of its own.
double estimated_chords(const SurfaceGeometry& surface, const CurveGeometry<2>& curve, Interval on,
                        double tolerance) {
    return chords_of(
        [&](double t) {
            const auto p = jet<2>(curve, t);
            const auto s = jet<2>(surface, p.value().c);
            const double u = p.d[1][0], v = p.d[1][1];
            return std::pair(u * s(1, 0) + v * s(0, 1), u * u * s(2, 0) + 2 * u * v * s(1, 1) +
                                                            v * v * s(0, 2) + p.d[2][0] * s(1, 0) +
                                                            p.d[2][1] * s(0, 1));
        },
        on, tolerance);
}

std::vector<double> predicted(const Model& model, const TessellateOptions& options, int samples) {
    std::vector<double> out(model.faces.size()), chords;
    for (const Edge& e : model.edges)
        chords.push_back(std::max(e.curve ? estimated_chords(*e.curve, e.range, options.tolerance) : 0, 1.0));
    for (const Face& face : model.faces)
        for (const Loop& l : face.loops)
            for (const Coedge& c : l.coedges)
                if (const Edge& e = model.edges[std::size_t(c.edge)]; !e.curve && !e.degenerate)
                    chords[std::size_t(c.edge)] =
                        std::max(chords[std::size_t(c.edge)],
                                 estimated_chords(face.surface, c.curve, e.range, options.tolerance));
    parallel_for(model.faces.size(), kFacesAtOnce, [&](std::size_t f) {
        const Face& face = model.faces[f];
        const Box<2> box = sampled_box(model, face);
        double along = 0;
        for (const Loop& l : face.loops)
            for (const Coedge& c : l.coedges) along += chords[std::size_t(c.edge)];
        if (box.is_empty()) return;
        FaceDemands demands{options.tolerance, options.max_edge};
        demands.apex = apex_for(face.surface, box);
        if (demands.apex && !demands.apex->is_true_to(options.tolerance)) demands.apex.reset();
        // Of cones only longest sides ask for points inside.
        const bool is_cone = demands.apex && !(demands.apex->radius > 0) && std::isinf(options.max_edge);
        out[f] = std::max(is_cone ? 0 : estimated_triangles(face.surface, box, demands, samples),
                          along + 2 * double(face.loops.size()) - 4);
    });
    return out;
}

double sum_of(std::span<const double> x) { return std::accumulate(x.begin(), x.end(), 0.0); }

}  // namespace

Box<2> sampled_box(const Model& model, const Face& face) {
    Box<2> box;
    for (const Loop& l : face.loops)
        for (const Coedge& c : l.coedges)
            for (int k = 0; k <= 8; ++k) {
                const Interval on = model.edges[std::size_t(c.edge)].range;
                box.add(jet<0>(c.curve, k == 8 ? on.hi : on.lo + k * (on.length() / 8)).value());
            }
    return box;
}

double estimated_chords(const CurveGeometry<3>& curve, Interval on, double tolerance) {
    if (std::holds_alternative<Line<3>>(curve)) return 0;
    return chords_of(
        [&](double t) {
            const auto j = jet<2>(curve, t);
            return std::pair(j.d[1], j.d[2]);
        },
        on, tolerance);
}

double predicted_triangles(const Model& model, const TessellateOptions& options) {
    const StandIns stand_ins = stand_ins_for(model, options, false);
    return sum_of(predicted(stand_ins.standing ? *stand_ins.standing : model, options, kManySamples));
}

std::vector<double> face_sizes(const Model& model, const TessellateOptions& options) {
    return predicted(model, options, kFewSamples);
}

Result<void> check_budget(const Model& model, const TessellateOptions& options,
                          std::span<const double> sizes) {
    const double limit = double(options.max_triangles), first = sum_of(sizes);
    if (first < limit / kFarBelow) return {};
    double sum = first > kHopeless * limit ? sum_of(predicted(model, options, kFewSamples + 1)) : 0;
    if (!(sum > kHopeless * limit)) sum = predicted_triangles(model, options);
    if (sum <= kFarBeyond * limit) return {};
    return refuse(
        RefusalKind::limit, "max_triangles",
        text("about ", std::ceil(sum), " triangles are needed within ", options.tolerance,
             std::isfinite(options.max_edge) ? text(" with sides of at most ", options.max_edge) : "",
             ", the limit is ", options.max_triangles));
}

}  // namespace freiform
