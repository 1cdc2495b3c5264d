// Intersections of two surfaces.
//
// Idea. The curve is covered by charts: boxes of the four parameters in each of which it is proven to be one
// arc (charts_detail.hpp). Everywhere else the surfaces are proven to be apart, or are so near to each other
// and so parallel that the tolerance does not tell how they meet. Branches are followed from chart to chart
// (trace_detail.hpp) and fitted by splines (branch_fit_detail.hpp) whose distance from both surfaces is
// proven (branch_proof_detail.hpp).
//
// Method. Pairs of parts of both surfaces are halved until boxes or slabs along a normal tell them apart, or
// they have a chart. A loop, however small, is in charts like any other branch: none needs a starting point
// that a heuristic finds. Pairs closer than a fraction of the tolerance all over are given up; clusters of
// few of them are looked at again, ever finer, since they are about a place where the surfaces touch, or
// nearly do, and often do not.
//
// Cost. Charts are as long as the angle of the surfaces, divided by how much they bend, allows: some hundreds
// along a branch that goes over a surface, a microsecond or two each; as much again for the proof of the fit.
//
// Accuracy. That nothing is missed holds for the surfaces as they are given: the rounding of extraction,
// halving and evaluation is counted. So do the bounds of branches.
//
// References. [Hohmeyer 1991] and [Sederberg Meyers 1988] stop where normals cannot be parallel, so that
// there are no loops, and begin branches at borders; [Krawczyk 1969] is the test for one zero.
//
// Why not border points of pieces, linked within pieces? Where a branch runs along the border of a piece, or
// touches it, rounding decides how many there are, and branches are lost or doubled. Charts overlap, so no
// border matters but those of the surfaces.
#include "branch_fit_detail.hpp"
#include "ridge_detail.hpp"
#include "surface_surface_detail.hpp"

#include <freiform/core/text.hpp>

#include <map>

namespace freiform {

std::string_view name_of(SurfaceNodeKind kind) {
    switch (kind) {
        case SurfaceNodeKind::touch:
            return "touch";
        case SurfaceNodeKind::crossing:
            return "crossing";
        case SurfaceNodeKind::overlap:
            return "overlap";
        case SurfaceNodeKind::tangent:
            return "tangent";
        case SurfaceNodeKind::along:
            break;
    }
    return "along";
}

std::string_view name_of(SurfaceBranchKind kind) {
    return kind == SurfaceBranchKind::tangent ? "tangent" : "crossing";
}

namespace {

using namespace detail;

// Of the extent of the smaller surface: how near they are in the strips about curves along which they touch,
// where the tolerance would ask for very many parts.
constexpr double kCoarse = 0x1p-15;
constexpr std::size_t kMostUndecided = 64;

Surface<Hom<3>> weighted_net(const Surface<Vec<3>>& s) { return to_rational(s); }
const Surface<Hom<3>>& weighted_net(const Surface<Hom<3>>& s) { return s; }

// (A - B) . A_u, (A - B) . A_v, N . B_s, N . B_t with N = A_u x A_v: all zero where the distance of one
// surface from the other does not change.
std::array<double, 4> parallel_at(const Charts& charts, const Place4& x) {
    const Charts::Value v = charts.value(x);
    const Vec<3> n = unit(cross(v.d[0], v.d[1]));
    return {dot(v.f, v.d[0]), dot(v.f, v.d[1]), dot(n, v.d[2]), dot(n, v.d[3])};
}

// Newton's method with differences for derivatives, from the middle of the cell where the surfaces are
// nearest; where it leads out of the box, that middle.
Place4 nearest_in(const Charts& charts, const Cluster& cluster, const std::array<Interval, 4>& box) {
    Place4 best{};
    double least = kInfinity;
    for (const auto& cell : cluster.cores) {
        Place4 x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = cell[k].middle();
        if (const double off = norm(charts.value(x).f); off < least) least = off, best = x;
    }
    Place4 x = best;
    for (int i = 0; i < 20; ++i) {
        const auto g = parallel_at(charts, x);
        std::array<std::array<double, 5>, 4> m{};  // the system, with its right-hand side
        for (std::size_t k = 0; k < 4; ++k) {
            Place4 y = x;
            const double h = std::max(1e-4 * box[k].length(), 1e-7 * charts.domain(k).length());
            y[k] += x[k] + h <= charts.domain(k).hi ? h : -h;
            const auto gy = parallel_at(charts, y);
            for (std::size_t r = 0; r < 4; ++r) m[r][k] = (gy[r] - g[r]) / (y[k] - x[k]);
        }
        for (std::size_t r = 0; r < 4; ++r) m[r][4] = g[r];
        for (std::size_t k = 0; k < 4; ++k) {
            std::size_t pivot = k;
            for (std::size_t r = k + 1; r < 4; ++r)
                if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
            std::swap(m[k], m[pivot]);
            if (m[k][k] == 0) return best;
            for (std::size_t r = 0; r < 4; ++r)
                if (r != k)
                    for (std::size_t c = 5; c-- > k;) m[r][c] -= m[r][k] / m[k][k] * m[k][c];
        }
        double step = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double d = m[k][4] / m[k][k];
            x[k] -= d;
            step = std::max(step, std::abs(d) / box[k].length());
            if (!(x[k] >= box[k].lo - box[k].length() && x[k] <= box[k].hi + box[k].length())) return best;
            x[k] = clamped(x[k], charts.domain(k));
        }
        if (step < 1e-9) break;
    }
    return x;
}

std::array<Interval, 4> hull_of(const Cluster& cluster) {
    std::array<Interval, 4> box = cluster.cores.front();
    for (const auto& cell : cluster.cores)
        for (std::size_t k = 0; k < 4; ++k) box[k] = hull(box[k], cell[k]);
    return box;
}

Box<3> place_of(const Charts& charts, const Cluster& cluster) {
    Box<3> place;
    for (const auto& cell : cluster.cores)
        for (const double u : {cell[0].lo, cell[0].hi})
            for (const double v : {cell[1].lo, cell[1].hi}) place.add(charts.sheet(0).at(u, v).point);
    return place;
}

// What begins and ends at one node, is no longer than it and does not leave its box is a part of it.
bool is_within_node(const Charts& charts, const Trace& t) {
    if (t.ends[0] < 0 || t.ends[0] != t.ends[1]) return false;
    const Cluster& cluster = charts.clusters()[std::size_t(t.ends[0])];
    const auto box = hull_of(cluster);
    double left = place_of(charts, cluster).diagonal();
    Vec<3> last = charts.sheet(0).at(t.points[0].x[0], t.points[0].x[1]).point;
    for (const TracePoint& p : t.points) {
        for (std::size_t k = 0; k < 4; ++k)
            if (!box[k].contains(p.x[k])) return false;
        const Vec<3> x = charts.sheet(0).at(p.x[0], p.x[1]).point;
        left -= norm(x - last);
        if (left < 0) return false;
        last = x;
    }
    return true;
}

SurfaceNode node_of(const Charts& charts, const Cluster& cluster, int arms, double tolerance) {
    SurfaceNode node;
    const std::array<Interval, 4> box = hull_of(cluster);
    const Place4 x = nearest_in(charts, cluster, box);
    node.box_a = {box[0], box[1]}, node.box_b = {box[2], box[3]};
    node.at_a = {x[0], x[1]}, node.at_b = {x[2], x[3]};
    node.point = charts.sheet(0).at(x[0], x[1]).point;
    node.gap = 1.01 * (norm(charts.value(x).f) + 1.8 * charts.error_at(x));
    node.arms = arms;
    const bool is_point =
        place_of(charts, cluster).diagonal() <= std::max(64 * tolerance, 0x1p-10 * charts.sheet(0).scale());
    node.kind = cluster.same ? SurfaceNodeKind::overlap
                : !is_point  ? SurfaceNodeKind::along
                : arms == 0  ? SurfaceNodeKind::touch
                             : SurfaceNodeKind::crossing;
    node.cells = cluster.cores;
    return node;
}

// The corners of R, counter-clockwise, and those of M(R) in the same order, in the parameters of the parts.
SurfaceOverlap overlap_of(const SameMap& m, const std::array<const PartSpline*, 2>& parts) {
    SurfaceOverlap out;
    out.gap = m.gap;
    for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < 2; ++k)
            out.is_affine =
                out.is_affine && m.side[side].own[k].is_identity() == parts[side]->map[k].is_identity();
    const auto place = [&](std::size_t side, std::size_t k, bool high) {
        const Interval& on = m.on[side][k];
        return parts[side]->map[k].at(high ? on.hi : on.lo);
    };
    for (const int corner : {0, 1, 3, 2}) {
        const std::array<bool, 2> high{(corner & 1) != 0, (corner & 2) != 0};
        out.loop_a.push_back({{place(0, 0, high[0]), place(0, 1, high[1])}});
        const auto in_b = [&](std::size_t k) { return place(1, k, high[m.source(k)] == (m.scale[k] > 0)); };
        out.loop_b.push_back({{in_b(0), in_b(1)}});
    }
    return out;
}

}  // namespace

void detail::add_overlaps(SplineIntersection& to, std::span<const SameMap> maps,
                          const std::array<const PartSpline*, 2>& parts, double tolerance) {
    if (maps.empty() && to.found.nodes.size() == 1)
        if (const auto plane = plane_overlap(*parts[0], *parts[1], tolerance)) {
            SurfaceNode& node = to.found.nodes[0];
            node.kind = SurfaceNodeKind::overlap, node.gap = std::max(node.gap, plane->gap);
            node.overlaps.push_back(*plane);
        }
    for (std::size_t i = 0; i < to.found.nodes.size(); ++i)
        for (const int map : to.maps_of_nodes[i])
            to.found.nodes[i].overlaps.push_back(overlap_of(maps[std::size_t(map)], parts));
}

detail::SplineIntersection detail::intersect_splines(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b,
                                                     const SurfaceGeometry& shape_a,
                                                     const SurfaceGeometry& shape_b,
                                                     const SurfaceIntersectOptions& options,
                                                     const Sameness& same) {
    const double tolerance = options.tolerance;
    Sheet sheet_a(a), sheet_b(b);
    Charts charts(sheet_a, sheet_b, same);
    // Finer, rounding leaves no chart beside a place where the surfaces touch.
    const double finest =
        std::max(0x1p-36 * tolerance, 0x1p8 * (sheet_a.inner_error() + sheet_b.inner_error()));
    const BranchProof proof_a(shape_a, sheet_a), proof_b(shape_b, sheet_b);
    RidgeTracer ridges(charts, {&shape_a, &shape_b}, {&proof_a, &proof_b}, tolerance);
    std::map<int, std::vector<SurfaceBranch>> touching;  // of clusters that are known
    const double coarse = kCoarse * std::min(sheet_a[0].extent(), sheet_b[0].extent());
    charts.search(tolerance, finest, options.max_pairs, coarse, [&](const Cluster& c, int number) {
        auto found = ridges.all(c, number);
        if (!ridges.are_all_of(c, found)) return false;
        touching[number] = std::move(found);
        return true;
    });
    std::vector<Trace> traces = Tracer(charts).all();
    SplineIntersection all;
    SurfaceIntersection& out = all.found;
    std::vector<int> arms(charts.clusters().size());
    for (Trace& t : traces) {
        const std::array<int, 2> ends = t.ends;
        if (is_within_node(charts, t)) continue;
        out.branches.push_back(TraceFit(charts, {&proof_a, &proof_b}, tolerance)(std::move(t)));
        out.branches.back().ends = ends;
        for (const int end : ends)
            if (end >= 0) ++arms[std::size_t(end)];
    }
    for (std::size_t i = 0; i < arms.size(); ++i) {
        const Cluster& cluster = charts.clusters()[i];
        out.nodes.push_back(node_of(charts, cluster, arms[i], tolerance));
        for (const int map : cluster.maps)
            out.nodes.back().gap = std::max(out.nodes.back().gap, same.maps[std::size_t(map)].gap);
        all.maps_of_nodes.push_back(cluster.maps);
        if (out.nodes.back().kind != SurfaceNodeKind::along) continue;
        const auto known = touching.find(int(i));
        for (SurfaceBranch& ridge :
             known == touching.end() ? ridges.all(cluster, int(i)) : std::move(known->second)) {
            ridge.node = int(i);
            for (const int end : ridge.ends) out.nodes.back().arms += end >= 0;
            out.nodes.back().kind = SurfaceNodeKind::tangent;
            out.branches.push_back(std::move(ridge));
        }
    }
    for (const PartPair& p : charts.left()) out.undecided.push_back(charts.core(p));
    if (out.undecided.size() > kMostUndecided) {  // a heap tells no more than its hull
        std::array<Interval, 4> box = out.undecided[0];
        for (const auto& other : out.undecided)
            for (std::size_t k = 0; k < 4; ++k) box[k] = hull(box[k], other[k]);
        out.undecided.assign(1, box);
    }
    return all;
}

template <class P, class Q>
requires(Space<P>::kDim == 3 &&
         Space<Q>::kDim == 3) Result<SurfaceIntersection> intersect(const Surface<P>& a, const Surface<Q>& b,
                                                                    const SurfaceIntersectOptions& options) {
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not a length > 0"));
    const SurfacePart part_a{a, a.domain()}, part_b{b, b.domain()};
    const PartSpline spline_a{weighted_net(a)}, spline_b{weighted_net(b)};
    const auto same = sameness({&spline_a, &spline_b}, options.tolerance);
    auto all =
        intersect_splines(spline_a.surface, spline_b.surface, part_a.surface, part_b.surface, options, same);
    add_overlaps(all, same.maps, {&spline_a, &spline_b}, options.tolerance);
    return std::move(all.found);
}

template Result<SurfaceIntersection> intersect(const Surface<Vec<3>>&, const Surface<Vec<3>>&,
                                               const SurfaceIntersectOptions&);
template Result<SurfaceIntersection> intersect(const Surface<Vec<3>>&, const Surface<Hom<3>>&,
                                               const SurfaceIntersectOptions&);
template Result<SurfaceIntersection> intersect(const Surface<Hom<3>>&, const Surface<Vec<3>>&,
                                               const SurfaceIntersectOptions&);
template Result<SurfaceIntersection> intersect(const Surface<Hom<3>>&, const Surface<Hom<3>>&,
                                               const SurfaceIntersectOptions&);

}  // namespace freiform
