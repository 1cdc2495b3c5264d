// Discretisation of edges: where the ends of chords are, and what is prepared for it. How parts share the
// work: edge_parts.cpp.
#include "edge_mesh_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/mesh/face_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr std::size_t kPiecesAtOnce = 16;
constexpr int kClosedParts = 4;   // a closed edge must not collapse to a slit
constexpr double kShort = 0.125;  // of the mean length: pieces that may bend much without mattering much

// Where to cut an interval that seems to need `parts` parts: so that equal ones result if it does.
double first_part(double parts) {
    constexpr double kMost = 1e6;
    const double k = std::max(2.0, std::ceil(parts * (1 + 1e-9)));
    return k < kMost ? std::floor(k / 2) / k : 0.5;
}

// Of both coordinates, over the polynomial or rational pieces of a spline some of which are short. Nothing of
// others, nor of those on closed knots, whose parameters may go around.
std::array<PiecewiseBound, 2> second_by_pieces(const DerivativeQuery<1, 2>& curve) {
    std::array<PiecewiseBound, 2> out;
    visit_one(
        [&](const auto& c) {
            if constexpr (requires { c.net(); }) {
                const auto breaks = c.basis().breaks();
                double shortest = kInfinity;
                for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
                    shortest = std::min(shortest, breaks[k + 1] - breaks[k]);
                const double mean = (breaks.back() - breaks.front()) / double(breaks.size() - 1);
                if (c.basis().is_closed() || !(shortest < kShort * mean)) return;
                for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
                    const auto bounds = coordinate_bounds(curve, {breaks[k], breaks[k + 1]});
                    for (std::size_t i = 0; i < 2; ++i) out[i].add(breaks[k + 1], bounds.coordinate[i](2));
                }
            }
        },
        curve.geometry());
    return out;
}

Refusal too_many(int edge, const EdgeDemands& demands, std::size_t max_segments) {
    return {RefusalKind::limit, "max_triangles",
            text("edge ", edge, " needs more than ", max_segments, " segments within ", demands.tolerance)};
}

}  // namespace

CurveGeometry<1> component_of(const CurveGeometry<2>& curve, int i) {
    return visit_one(
        [&](const auto& c) -> CurveGeometry<1> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<2>>) {
                return Line<1>{{{c.origin[i]}}, {{c.direction[i]}}};
            } else if constexpr (std::same_as<C, Conic<2>>) {
                return Conic<1>{c.kind, {{c.centre[i]}}, {{c.x[i]}}, {{c.y[i]}}};
            } else if constexpr (std::same_as<C, Curve<Vec<2>>>) {
                std::vector<Vec<1>> p;
                for (const auto& q : c.net().flat()) p.push_back({{q[i]}});
                return Curve<Vec<1>>::trusted(c.bases(), Net<1, Vec<1>>(c.net().extent(), std::move(p)));
            } else {
                std::vector<Hom<1>> p;
                for (const auto& q : c.net().flat()) p.push_back({{q[i], q.weight()}});
                return Curve<Hom<1>>::trusted(c.bases(), Net<1, Hom<1>>(c.net().extent(), std::move(p)));
            }
        },
        curve);
}

EdgeMesher::EdgeMesher(const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> faces,
                       std::span<const std::optional<Apex>> apexes)
    : model_(model), faces_(faces), apexes_(apexes), edges_(model.edges.size()) {
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        for (std::size_t l = 0; l < model.faces[f].loops.size(); ++l) {
            const auto& coedges = model.faces[f].loops[l].coedges;
            for (std::size_t c = 0; c < coedges.size(); ++c) {
                auto use = std::make_unique<CoedgeQuery>();
                use->face = int(f), use->loop = int(l), use->index = int(c);
                use->coedge = &coedges[c];
                edges_[std::size_t(coedges[c].edge)].uses.push_back(std::move(use));
            }
        }
    parallel_for(model.edges.size(), 4, [&](std::size_t e) {
        const auto& own = model.edges[e].curve;
        if (own) edges_[e].curve = std::make_unique<ChordCurve>(*own);
        for (auto& use : edges_[e].uses) {
            use->curve = std::make_unique<DerivativeQuery<1, 2>>(use->coedge->curve);
            use->lift = lifted(model.faces[std::size_t(use->face)].surface, use->coedge->curve);
            if (!use->lift) {
                use->second = second_by_pieces(*use->curve);
                continue;
            }
            if (own && use->lift->shift == 0 && use->lift->speed == 1)
                use->twin = distance_of_twins(*own, *use->lift->geometry);
            if (use->twin == kInfinity) use->chords = std::make_unique<ChordCurve>(*use->lift->geometry);
        }
    });
}

Vec<3> EdgeMesher::position(int edge, double t) const {
    const Edge& e = model_.edges[std::size_t(edge)];
    if (e.curve) return jet<0>(*e.curve, t).value();
    const auto& uses = edges_[std::size_t(edge)].uses;
    if (e.degenerate || uses.empty()) return model_.vertices[std::size_t(e.start)].point;
    const auto& use = *uses.front();
    return jet<0>(model_.faces[std::size_t(use.face)].surface, jet<0>(use.coedge->curve, t).value().c)
        .value();
}

void EdgeMesher::forget() {
    for (EdgeMesh& mesh : edges_) {
        mesh.parameters.clear(), mesh.points.clear();
        mesh.bound = 0, mesh.collapsed = false;
        mesh.lengthen();
    }
}

// How many segments the curvature at samples asks for: tells hopeless tolerances before they take time. Only
// an estimate; bounds over long intervals would be far too large for it.
double EdgeMesher::estimate(int edge, Interval on, double tolerance) const {
    const Edge& e = model_.edges[std::size_t(edge)];
    return e.curve ? estimated_chords(*e.curve, on, tolerance) : 0;
}

// Where a part that cannot be halved does not keep the demands, if the worst half of each leads there: see
// curvature_tree_torn.cpp. Asked about edges whose weights are far apart alone.
std::optional<double> EdgeMesher::torn_place(int edge, Interval on, const EdgeDemands& demands) const {
    const EdgeMesh& mesh = edges_[std::size_t(edge)];
    bool apart = mesh.curve && mesh.curve->query().weight_spread() > kWeightsFarApart;
    for (const auto& use : mesh.uses)
        apart = apart || use->curve->weight_spread() > kWeightsFarApart ||
                faces_[std::size_t(use->face)]->weight_spread() > kWeightsFarApart;
    if (!apart) return std::nullopt;
    for (Part worst = part(edge, on.lo, on.hi, demands); !(worst.needs <= 1);) {
        const double middle = worst.a + (worst.b - worst.a) / 2;
        if (!(worst.a < middle && middle < worst.b)) return worst.a;
        const Part lower = part(edge, worst.a, middle, demands), upper = part(edge, middle, worst.b, demands);
        worst = lower.needs > upper.needs ? lower : upper;
    }
    return std::nullopt;
}

// The parts of a smooth piece, as few as will do about, all of which keep the demands.
std::optional<Refusal> EdgeMesher::find_parts(int edge, Interval on, int least, const EdgeDemands& demands,
                                              std::size_t max_segments, std::vector<Part>& out) const {
    const auto too_steep = [&](double at) {
        return Refusal{RefusalKind::ill_conditioned, text("edges[", edge, "]"),
                       text("cannot be brought within ", demands.tolerance, " near parameter ", at)};
    };
    if (const auto torn = torn_place(edge, on, demands)) return too_steep(*torn);
    auto stack = equal_parts(edge, on, least, demands, max_segments);
    std::reverse(stack.begin(), stack.end());
    std::vector<Part> done;
    while (!stack.empty()) {
        const Part p = stack.back();
        stack.pop_back();
        if (p.needs <= 1) {
            done.push_back(p);
            continue;
        }
        const double middle = p.a + (p.b - p.a) * first_part(p.needs);
        if (!(p.a < middle && middle < p.b)) return too_steep(p.a);
        if (done.size() + stack.size() >= max_segments) return too_many(edge, demands, max_segments);
        stack.push_back(part(edge, middle, p.b, demands));
        stack.push_back(part(edge, p.a, middle, demands));
    }
    out = joined(edge, std::move(done), on.length() / least, demands);
    return std::nullopt;
}

Result<void> EdgeMesher::discretise(int edge, const EdgeDemands& demands, std::size_t max_segments) {
    EdgeMesh& mesh = edges_[std::size_t(edge)];
    const Edge& e = model_.edges[std::size_t(edge)];
    const double tolerance = demands.tolerance;
    if (const double needed = estimate(edge, e.range, tolerance); needed > kFarBeyond * double(max_segments))
        return refuse(
            RefusalKind::limit, "max_triangles",
            text("edge ", edge, " needs about ", std::ceil(needed), " segments within ", tolerance));
    for (auto& use : mesh.uses)
        if (use->lift && !use->chords && !use->is_twin(tolerance))
            use->chords = std::make_unique<ChordCurve>(*use->lift->geometry);
    const std::vector<double> must = smooth_pieces(edge, tolerance);
    mesh.parameters = {e.range.lo};
    mesh.bound = 0;
    if (std::isfinite(demands.angle)) mesh.size = size(edge);
    const std::size_t pieces = must.size() - 1;
    const int least = e.start == e.end && !e.degenerate ? std::max(kClosedParts / int(pieces), 1) : 1;
    // By threads, some pieces at a time: what is too much is seen before all of it is there.
    for (std::size_t first = 0; first < pieces; first += kPiecesAtOnce) {
        const std::size_t count = std::min(kPiecesAtOnce, pieces - first);
        std::vector<std::vector<Part>> found(count);
        std::vector<std::optional<Refusal>> refused(count);
        parallel_for(count, 1, [&](std::size_t i) {
            const Interval on{must[first + i], must[first + i + 1]};
            refused[i] = find_parts(edge, on, least, demands, max_segments, found[i]);
        });
        for (std::size_t i = 0; i < count; ++i) {
            if (refused[i]) return std::unexpected(*refused[i]);
            if (mesh.parameters.size() + found[i].size() > max_segments + 1)
                return std::unexpected(too_many(edge, demands, max_segments));
            for (const Part& p : found[i]) {
                mesh.parameters.push_back(p.b);
                mesh.bound = std::max(mesh.bound, p.bound);
            }
        }
    }
    return {};
}

double EdgeMesher::size(int edge) const {
    constexpr int kSamples = 8;
    const Interval on = model_.edges[std::size_t(edge)].range;
    Box<3> box;
    for (int i = 0; i <= kSamples; ++i) box.add(position(edge, on.lo + (double(i) / kSamples) * on.length()));
    return norm(box.hi - box.lo);
}

// The ends of the edge and the kinks of its curves inside, but for those that are rounding. Kinks of two
// curves beside each other are one that was rounded: a vertex at each would be two in one place.
std::vector<double> EdgeMesher::smooth_pieces(int edge, double tolerance) const {
    constexpr double kLittle = 0x1p-20, kOne = 0x1p-40;
    const EdgeMesh& mesh = edges_[std::size_t(edge)];
    const Interval on = model_.edges[std::size_t(edge)].range;
    std::vector<double> must{on.lo, on.hi};
    const auto add = [&](std::span<const Kink> kinks, double stretch) {
        for (const Kink& k : kinks)
            if (!(k.jump * stretch * on.length() <= kLittle * tolerance)) must.push_back(k.at);
    };
    if (mesh.curve) add(mesh.curve->query().kinks(0), 1);
    for (const auto& use : mesh.uses)
        for (const Kink& k : use->curve->kinks(0)) {
            const auto j = jet<1>(faces_[std::size_t(use->face)]->geometry(),
                                  jet<0>(use->coedge->curve, k.at).value().c);
            add(std::span(&k, 1), norm(j.d[1]) + norm(j.d[2]));
        }
    std::erase_if(must, [&](double t) { return !(on.lo <= t && t <= on.hi); });
    sort(must.begin(), must.end());
    std::vector<double> out{must.front()};
    for (const double t : must)
        if (t - out.back() > kOne * on.length()) out.push_back(t);
    if (out.size() > 1) out.pop_back();
    out.push_back(on.hi);
    return out;
}

void EdgeMesher::split(int edge, int index, double part) {
    auto& t = edges_[std::size_t(edge)].parameters;
    const double a = t[std::size_t(index)], b = t[std::size_t(index) + 1], at = a + (b - a) * part;
    if (a < at && at < b) t.insert(t.begin() + index + 1, at);
}

}  // namespace freiform
