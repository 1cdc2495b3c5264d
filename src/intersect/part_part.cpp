// Intersections of surfaces of models.
//
// Idea. Both become splines of the same shape (part_spline_detail.hpp), and these are intersected. What is
// found over the parameters of the splines is carried over to those of the surfaces: a cubic piece of
// parameters q becomes the cubic with the ends x(q) and the derivatives x'(q) q' there, and the proof is that
// of the surface itself, with its own derivatives. Pieces for which it fails are halved.
//
// Cost. The second proof, where parameters differ; nothing where both surfaces are splines.
//
// Why not the parameters of the splines? Those of the loops of faces are angles, and of loops that were
// carried over instead nothing would be exact.
#include "branch_proof_detail.hpp"
#include "surface_surface_detail.hpp"

#include <freiform/core/text.hpp>

namespace freiform {

namespace {

using namespace detail;

constexpr int kDeepestCarried = 12;
// Of the tolerance, for the search where another proof follows.
constexpr double kForSearch = 0.75;
constexpr double kForOffsets = 1.0 / 32;  // of the tolerance, how near splines are to them

class Carrier {
public:
    Carrier(const std::array<const PartSpline*, 2>& parts, const std::array<const BranchProof*, 2>& proofs,
            const std::array<const SurfacePart*, 2>& own, double tolerance)
        : parts_(parts), proofs_(proofs), own_(own), tolerance_(tolerance) {}

    SurfaceBranch operator()(const SurfaceBranch& b) {
        rows_.clear(), knots_.clear();
        bound_ = {};
        const BezierPieces<1, Vec<3>> space(b.curve);
        const BezierPieces<1, Vec<2>> at_a(b.at_a), at_b(b.at_b);
        const auto& breaks = space.breaks(0);
        for (int i = 0; i + 1 < int(breaks.size()); ++i) {
            Row row;
            for (int k = 0; k < 4; ++k) {
                const std::size_t c = std::size_t(k);
                row.space[c] = space.net({i})({k});
                row.at[0][c] = at_a.net({i})({k}), row.at[1][c] = at_b.net({i})({k});
            }
            add(row, {breaks[std::size_t(i)], breaks[std::size_t(i) + 1]}, 0);
        }
        SurfaceBranch out = spline();
        out.closed = b.closed, out.ends = b.ends;
        out.kind = b.kind, out.node = b.node;
        out.bound_a = bound_[0], out.bound_b = bound_[1];
        return out;
    }
    Vec<2> carried(std::size_t k, const Vec<2>& q) const {
        return {{parts_[k]->map[0].at(q[0]), parts_[k]->map[1].at(q[1])}};
    }

private:
    struct Row {
        CubicArc<Vec<3>> space{};
        std::array<CubicArc<Vec<2>>, 2> at{};
    };

    CubicArc<Vec<2>> carried(std::size_t k, const CubicArc<Vec<2>>& q) const {
        CubicArc<Vec<2>> out = q;
        for (int i = 0; i < 2; ++i) {
            const ParameterArcs& map = parts_[k]->map[std::size_t(i)];
            if (map.is_identity()) continue;
            out[0][i] = map.at(q[0][i]), out[3][i] = map.at(q[3][i]);
            out[1][i] = out[0][i] + map.slope(q[0][i]) * (q[1][i] - q[0][i]);
            out[2][i] = out[3][i] - map.slope(q[3][i]) * (q[3][i] - q[2][i]);
        }
        return out;
    }

    void add(const Row& row, Interval on, int depth) {
        Row own{row.space, {carried(0, row.at[0]), carried(1, row.at[1])}};
        std::array<double, 2> bound{};
        bool proven = true;
        for (std::size_t k = 0; k < 2 && proven; ++k) {
            const auto found = (*proofs_[k])(own.space, own.at[k], tolerance_);
            proven = found.has_value();
            if (proven) bound[k] = *found;
        }
        const double middle = on.middle();
        if (!proven && depth < kDeepestCarried && on.lo < middle && middle < on.hi) {
            const auto space = arc_halves(row.space);
            const auto a = arc_halves(row.at[0]), b = arc_halves(row.at[1]);
            add({space[0], {a[0], b[0]}}, {on.lo, middle}, depth + 1);
            add({space[1], {a[1], b[1]}}, {middle, on.hi}, depth + 1);
            return;
        }
        if (!proven) {  // all of the piece is near where it begins
            double reach = 0;
            for (const Vec<3>& p : own.space) reach = std::max(reach, norm(p - own.space[0]));
            for (std::size_t k = 0; k < 2; ++k) {
                bound[k] =
                    1.01 * (reach + proofs_[k]->off(own.space[0], own.at[k][0]) + spread(k, own.at[k]));
            }
        }
        for (std::size_t k = 0; k < 2; ++k) bound_[k] = std::max(bound_[k], bound[k]);
        rows_.push_back(own);
        if (knots_.empty()) knots_.push_back(on.lo);
        knots_.push_back(on.hi);
    }
    // How far the surface moves while its parameters are in the box of those of a piece.
    double spread(std::size_t k, const CubicArc<Vec<2>>& q) const {
        const DerivativeQuery<2, 3> query(own_[k]->surface);
        std::array<Interval, 2> box{Interval{q[0][0], q[0][0]}, Interval{q[0][1], q[0][1]}};
        for (const Vec<2>& p : q)
            for (int i = 0; i < 2; ++i) box[std::size_t(i)] = hull(box[std::size_t(i)], {p[i], p[i]});
        const auto d = query(box, 1);
        return d(1, 0) * box[0].length() + d(0, 1) * box[1].length();
    }

    template <class V>
    Curve<V> joined(auto&& piece) const {
        std::vector<V> net{piece(rows_[0])[0]};
        std::vector<double> knots(4, knots_[0]);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const auto& p = piece(rows_[i]);
            net.insert(net.end(), {p[1], p[2], p[3]});
            const bool last = i + 1 == rows_.size();
            const bool jump = !last && !(piece(rows_[i + 1])[0] == p[3]);
            if (jump) net.push_back(piece(rows_[i + 1])[0]);
            knots.insert(knots.end(), last || jump ? 4 : 3, knots_[i + 1]);
        }
        const int n = int(net.size());
        return Curve<V>::trusted({*BSplineBasis::make(3, std::move(knots))}, Net<1, V>({n}, std::move(net)));
    }
    SurfaceBranch spline() const {
        return {joined<Vec<3>>([](const Row& r) -> const auto& { return r.space; }),
                joined<Vec<2>>([](const Row& r) -> const auto& { return r.at[0]; }),
                joined<Vec<2>>([](const Row& r) -> const auto& { return r.at[1]; }),
                false,
                {kAtBorder, kAtBorder},
                0,
                0};
    }

    std::array<const PartSpline*, 2> parts_;
    std::array<const BranchProof*, 2> proofs_;
    std::array<const SurfacePart*, 2> own_;
    double tolerance_;
    std::vector<Row> rows_;
    std::vector<double> knots_;
    std::array<double, 2> bound_{};
};

std::array<Interval, 4> carried_box(const std::array<const PartSpline*, 2>& parts,
                                    const std::array<Interval, 4>& box) {
    std::array<Interval, 4> out;
    for (std::size_t k = 0; k < 4; ++k) out[k] = parts[k / 2]->map[k % 2].over(box[k]);
    return out;
}

bool is_same(const PartSpline& part) { return part.map[0].is_identity() && part.map[1].is_identity(); }

}  // namespace

Result<PartIntersection> intersect(const SurfacePart& a, const SurfacePart& b,
                                   const SurfaceIntersectOptions& options) {
    const double near = kForOffsets * options.tolerance;
    const auto spline_a = part_spline(a.surface, a.on, near), spline_b = part_spline(b.surface, b.on, near);
    if (!spline_a) return refuse_within("a", spline_a.error());
    if (!spline_b) return refuse_within("b", spline_b.error());
    const std::array<const PartSpline*, 2> parts{&*spline_a, &*spline_b};
    SurfaceIntersectOptions search = options;
    search.tolerance = kForSearch * options.tolerance;
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not a length > 0"));
    const auto same = sameness(parts, search.tolerance);
    const SurfaceGeometry shape_a = spline_a->surface, shape_b = spline_b->surface;
    auto found = intersect_splines(spline_a->surface, spline_b->surface, shape_a, shape_b, search, same);
    add_overlaps(found, same.maps, parts, options.tolerance);
    PartIntersection out{std::move(found.found), {spline_a->bound, spline_b->bound}};
    const BranchProof proof_a(a.surface, a.on), proof_b(b.surface, b.on);
    Carrier carry(parts, {&proof_a, &proof_b}, {&a, &b}, options.tolerance);
    for (SurfaceBranch& branch : out.branches) branch = carry(branch);
    for (SurfaceNode& n : out.nodes) {
        n.gap = 1.01 * (n.gap + spline_a->bound + spline_b->bound);
        if (is_same(*parts[0]) && is_same(*parts[1])) continue;
        for (auto& cell : n.cells) cell = carried_box(parts, cell);
        const auto box = carried_box(parts, {n.box_a[0], n.box_a[1], n.box_b[0], n.box_b[1]});
        n.box_a = {box[0], box[1]}, n.box_b = {box[2], box[3]};
        n.at_a = carry.carried(0, Vec<2>{n.at_a}).c, n.at_b = carry.carried(1, Vec<2>{n.at_b}).c;
    }
    for (auto& box : out.undecided) box = carried_box(parts, box);
    return out;
}

Result<Box<3>> box_of_part(const SurfacePart& part) {
    if (const auto* offset = std::get_if<OffsetSurface>(&part.surface)) {
        const auto base = box_of_part({*offset->base, part.on});
        if (!base) return base;
        const double reach = std::abs(offset->distance) + 4 * kUnitRoundoff * base->scale();
        return Box<3>{base->lo - Box<3>::filled(reach), base->hi + Box<3>::filled(reach)};
    }
    const auto spline = part_spline(part.surface, part.on);
    if (!spline) return std::unexpected(spline.error());
    Box<3> box;
    for (const Vec<3>& p : points(spline->surface)) box.add(p);
    // Projected points are off by a rounding.
    const double more = spline->bound + 4 * kUnitRoundoff * box.scale();
    return Box<3>{box.lo - Box<3>::filled(more), box.hi + Box<3>::filled(more)};
}

}  // namespace freiform
