// Grids that neighbours agree about.
//
// Idea: lines of a grid must end where the edges of the face have points, and these belong to the neighbours
// too. A face that is a rectangle of parameters, with one edge for each side, ties its opposite edges: they
// get points at the same parts of their length in parameters. Ties go on through the neighbours; edges tied
// together, directly or not, are a class with one set of parts of [0, 1]. A face takes its lines in u from
// one class, those in v from another.
//
// Method: parameters of an edge, from 0 to 1, are those of a side up to their direction, where the parameter
// curve is an affine map; so a tie says "the same" or "turned round". Where both
// follow of one edge (a Möbius band) one is taken, and lines that are not symmetric end between points there:
// such cells become triangles. Segments of every edge of a
// class and cells of every face ask for a number of parts (edge_parts.cpp, grid.cpp), and parts are moved and
// halved until all are content; kinks stay where they are. If after that an edge is not, it keeps the points
// that it had, and its faces have grids of their own inside.
//
// Cost: one bound for each segment and cell in each of some passes. Why not equal numbers of points wherever
// they are: cells would be slanted, and their bounds larger.
#include "matched_grids_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/mesh/grid.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace freiform {

namespace {

constexpr double kSamePart = 1e-9;      // kinks nearer than this are one
constexpr double kSameCorner = 1e-9;    // of the rectangle
constexpr double kMostStripParts = 16;  // in the place of one at a time: bounds over long ones are too large

struct Side {
    int edge = -1;
    bool turned = false;  // the edge's parameter falls where the face's rises
};

struct Rectangle {
    int face = -1;
    Box<2> box;
    std::array<std::array<Side, 2>, 2> sides;  // along u, along v
};

bool is_affine(const CurveGeometry<2>& curve) {
    if (std::holds_alternative<Line<2>>(curve)) return true;
    const auto* spline = std::get_if<Curve<Vec<2>>>(&curve);
    return spline && spline->basis().degree() == 1 && spline->net().flat().size() == 2;
}

std::optional<Rectangle> rectangle_of(const Model& model, int face) {
    const Face& f = model.faces[std::size_t(face)];
    if (f.loops.size() != 1 || f.loops[0].coedges.size() != 4) return std::nullopt;
    Rectangle out;
    out.face = face;
    const auto ends = [&](const Coedge& c) {
        const Interval on = model.edges[std::size_t(c.edge)].range;
        return std::array{jet<0>(c.curve, on.lo).value(), jet<0>(c.curve, on.hi).value()};
    };
    for (const Coedge& c : f.loops[0].coedges)
        for (const Vec<2>& p : ends(c)) out.box.add(p);
    const Vec<2> size = out.box.hi - out.box.lo;
    if (!(size[0] > 0 && size[1] > 0)) return std::nullopt;
    for (const Coedge& c : f.loops[0].coedges) {
        const auto [a, b] = ends(c);
        const auto near = [&](double x, double y, int d) { return std::abs(x - y) <= kSameCorner * size[d]; };
        bool found = false;
        for (int d = 0; d < 2; ++d)
            for (int k = 0; k < 2; ++k) {
                const double at = (k == 0 ? out.box.lo : out.box.hi)[1 - d];
                if (!near(a[1 - d], at, 1 - d) || !near(b[1 - d], at, 1 - d)) continue;
                const bool rises = near(a[d], out.box.lo[d], d) && near(b[d], out.box.hi[d], d),
                           falls = near(b[d], out.box.lo[d], d) && near(a[d], out.box.hi[d], d);
                Side& side = out.sides[std::size_t(d)][std::size_t(k)];
                if (!(rises || falls) || side.edge >= 0 || !is_affine(c.curve)) continue;
                side = {c.edge, falls};
                found = true;
            }
        if (!found) return std::nullopt;
    }
    return out;
}

// Parts of [0, 1] from the other end.
std::vector<double> turned_round(std::vector<double> parts) {
    std::reverse(parts.begin(), parts.end());
    for (double& s : parts) s = 1 - s;
    return parts;
}

std::vector<double> placed(const std::vector<double>& parts, double lo, double hi, bool turned) {
    std::vector<double> out = turned ? turned_round(parts) : parts;
    for (double& s : out) s = lo + s * (hi - lo);
    out.front() = lo, out.back() = hi;
    return out;
}

// Edges tied together, each the same way round as the first of its class, or not.
class Ties {
public:
    explicit Ties(std::size_t edges) : of_(edges) {
        std::iota(of_.begin(), of_.end(), 0), turned_.resize(edges);
    }
    std::pair<int, bool> find(int e) const {
        bool turned = false;
        for (; of_[std::size_t(e)] != e; e = of_[std::size_t(e)]) turned ^= bool(turned_[std::size_t(e)]);
        return {e, turned};
    }
    void tie(int a, int b, bool turned) {
        const auto [x, x_turned] = find(a);
        const auto [y, y_turned] = find(b);
        const bool between = turned ^ x_turned ^ y_turned;
        if (x == y) return;
        of_[std::size_t(y)] = x, turned_[std::size_t(y)] = between;
    }

private:
    std::vector<int> of_;
    std::vector<char> turned_;
};

struct EdgeClass {
    std::vector<Side> edges;
    std::vector<double> fixed{0, 1}, parts, needs;
    std::vector<double> bounds;  // of the edges
    bool keeps = false;          // all of the edges keep their demands

    // Kinks stay; equal parts between them, as many as the finest edge has there.
    void begin(EdgeMesher& mesher) {
        sort(fixed.begin(), fixed.end());
        std::vector<double> kept{0};
        for (const double s : fixed)
            if (s - kept.back() > kSamePart && 1 - s > kSamePart) kept.push_back(s);
        kept.push_back(1);
        fixed = std::move(kept);
        parts = {0};
        for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
            int most = 1;
            for (const Side& side : edges) {
                auto own = mesher.mesh(side.edge).parameters;
                const double lo = own.front(), length = own.back() - lo;
                for (double& t : own) t = (t - lo) / length;
                if (side.turned) own = turned_round(own);
                int count = 1;
                for (const double s : own) count += s > fixed[i] + kSamePart && s < fixed[i + 1] - kSamePart;
                most = std::max(most, count);
            }
            for (int k = 1; k <= most; ++k)
                parts.push_back(k == most ? fixed[i + 1] : fixed[i] + (fixed[i + 1] - fixed[i]) * k / most);
        }
    }
};

class GridMatcher {
public:
    GridMatcher(const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> surfaces,
                EdgeMesher& edges, const EdgeDemands& on_edges, const FaceDemands& on_faces)
        : model_(model),
          surfaces_(surfaces),
          edges_(edges),
          on_edges_(on_edges),
          on_faces_(on_faces),
          ties_(model.edges.size()) {}

    void gather(std::span<const std::optional<Refusal>> refused);
    bool settle(double max_cells);  // false: too many cells
    std::vector<std::optional<GridLines>> take();

private:
    struct Along {  // an axis of a rectangle
        EdgeClass* of;
        bool turned;
    };
    Along along(const Rectangle& r, std::size_t axis) {
        const Side& side = r.sides[axis][0];
        const auto [first, turned] = ties_.find(side.edge);
        return {&classes_[first], turned != side.turned};
    }
    GridLines lines_of(const Rectangle& r) {
        GridLines out;
        for (std::size_t d = 0; d < 2; ++d) {
            const auto [c, turned] = along(r, d);
            out[d] = placed(c->parts, r.box.lo[int(d)], r.box.hi[int(d)], turned);
        }
        return out;
    }
    void ask_edges(EdgeClass& c);
    void ask_faces();

    const Model& model_;
    std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> surfaces_;
    EdgeMesher& edges_;
    const EdgeDemands& on_edges_;
    const FaceDemands& on_faces_;
    Ties ties_;
    std::vector<Rectangle> rectangles_;
    std::map<int, EdgeClass> classes_;
};

void GridMatcher::gather(std::span<const std::optional<Refusal>> refused) {
    for (std::size_t f = 0; f < model_.faces.size(); ++f)
        if (const auto r = refused[f] ? std::nullopt : rectangle_of(model_, int(f))) {
            rectangles_.push_back(*r);
            for (const auto& [a, b] : r->sides) ties_.tie(a.edge, b.edge, a.turned != b.turned);
        }
    for (const Rectangle& r : rectangles_)
        for (std::size_t d = 0; d < 2; ++d) {
            const auto [c, turned] = along(r, d);
            for (const Side& side : r.sides[d])
                if (std::none_of(c->edges.begin(), c->edges.end(),
                                 [&](const Side& o) { return o.edge == side.edge; }))
                    c->edges.push_back({side.edge, ties_.find(side.edge).second});
            for (const Kink& k : surfaces_[std::size_t(r.face)]->kinks(int(d))) {
                const double s = (k.at - r.box.lo[int(d)]) / (r.box.hi[int(d)] - r.box.lo[int(d)]);
                if (s > 0 && s < 1) c->fixed.push_back(turned ? 1 - s : s);
            }
        }
    for (auto& [first, c] : classes_) {
        for (const Side& side : c.edges) {
            const Interval on = model_.edges[std::size_t(side.edge)].range;
            for (const double t : edges_.smooth_pieces(side.edge, on_edges_.tolerance)) {
                const double s = (t - on.lo) / on.length();
                if (s > 0 && s < 1) c.fixed.push_back(side.turned ? 1 - s : s);
            }
        }
        c.begin(edges_);
    }
}

void GridMatcher::ask_edges(EdgeClass& c) {
    c.needs.assign(c.parts.size() - 1, 0x1p-10);
    c.bounds.assign(c.edges.size(), 0);
    c.keeps = true;
    for (std::size_t e = 0; e < c.edges.size(); ++e) {
        const auto [edge, turned] = c.edges[e];
        const Interval on = model_.edges[std::size_t(edge)].range;
        const auto at = placed(c.parts, on.lo, on.hi, turned);
        for (std::size_t i = 0; i + 1 < at.size(); ++i) {
            const auto p = edges_.part(edge, at[i], at[i + 1], on_edges_);
            double& need = c.needs[turned ? at.size() - 2 - i : i];
            need = std::max(need, std::min(p.needs, kMostStripParts));
            c.bounds[e] = std::max(c.bounds[e], p.bound);
            c.keeps = c.keeps && p.needs <= 1;
        }
    }
}

void GridMatcher::ask_faces() {
    std::vector<GridLines> lines;
    for (const Rectangle& r : rectangles_) lines.push_back(lines_of(r));
    std::vector<StripNeeds> needs(rectangles_.size());
    parallel_for(rectangles_.size(), 1, [&](std::size_t i) {
        for (std::size_t d = 0; d < 2; ++d) needs[i][d].assign(lines[i][d].size() - 1, 0.0);
        add_cell_needs(
            *surfaces_[std::size_t(rectangles_[i].face)], lines[i], on_faces_,
            [](const Box<2>&) { return false; }, needs[i]);
    });
    for (std::size_t i = 0; i < rectangles_.size(); ++i)
        for (std::size_t d = 0; d < 2; ++d) {
            const auto [c, turned] = along(rectangles_[i], d);
            const auto& asked = needs[i][d];
            for (std::size_t k = 0; k < asked.size(); ++k) {
                double& need = c->needs[turned ? asked.size() - 1 - k : k];
                need = std::max(need, asked[k]);
            }
        }
}

bool GridMatcher::settle(double max_cells) {
    for (int pass = 0;; ++pass) {
        double cells = 0;
        for (const Rectangle& r : rectangles_)
            cells += double(along(r, 0).of->parts.size()) * double(along(r, 1).of->parts.size());
        if (cells > max_cells) return false;
        for (auto& [first, c] : classes_) ask_edges(c);
        ask_faces();
        if (pass == kGridPasses + kGridHalvings) return true;
        bool changed = false;
        for (auto& [first, c] : classes_) {
            auto next = with_needs_met(c.parts, c.needs, c.fixed, pass >= kGridPasses);
            changed = changed || next != c.parts;
            c.parts = std::move(next);
        }
        if (!changed) return true;
    }
}

std::vector<std::optional<GridLines>> GridMatcher::take() {
    for (const auto& [first, c] : classes_) {
        if (!c.keeps) continue;
        for (std::size_t e = 0; e < c.edges.size(); ++e) {
            EdgeMesh& mesh = edges_.mesh(c.edges[e].edge);
            const Interval on = model_.edges[std::size_t(c.edges[e].edge)].range;
            mesh.parameters = placed(c.parts, on.lo, on.hi, c.edges[e].turned);
            mesh.bound = c.bounds[e];
        }
    }
    std::vector<std::optional<GridLines>> out(model_.faces.size());
    for (const Rectangle& r : rectangles_)
        if (along(r, 0).of->keeps && along(r, 1).of->keeps) out[std::size_t(r.face)] = lines_of(r);
    return out;
}

}  // namespace

std::optional<std::vector<std::optional<GridLines>>> matched_grids(
    const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> surfaces, EdgeMesher& edges,
    const EdgeDemands& on_edges, const FaceDemands& on_faces, std::span<const std::optional<Refusal>> refused,
    double max_cells) {
    GridMatcher matcher(model, surfaces, edges, on_edges, on_faces);
    matcher.gather(refused);
    if (!matcher.settle(max_cells)) return std::nullopt;
    return matcher.take();
}

}  // namespace freiform
