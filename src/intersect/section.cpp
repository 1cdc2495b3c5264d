// Sections of surfaces by planes.
//
// Idea. The height of a point of the surface over the plane, times its weight, is a piecewise polynomial of
// the two parameters. Its zero set is found as chains of cells (level_set.cpp), so nothing is missed and
// nothing is linked by guess; then each chain is followed by splines (section_branch_detail.hpp), each piece
// of which is proven to stay near the branch (section_fit_detail.hpp).
//
// Cost. Nearly all of it is the proof, which looks at about (length / tolerance)^(1/3) parts of each branch.
//
// Accuracy. The function is the exact scalar product at each control point, rounded once: the proof of
// completeness holds with the bound of that rounding, and of knot insertion, in each cell.
//
// References. [Lane Riesenfeld 1981], [Filip Magedson Markot 1986].
//
// Why not curve/plane crossings of isoparametric lines, joined? Loops between two lines are lost.
#include "section_branch_detail.hpp"

#include <freiform/core/text.hpp>

namespace freiform {

std::string_view name_of(SectionNodeKind kind) {
    switch (kind) {
        case SectionNodeKind::touch:
            return "touch";
        case SectionNodeKind::crossing:
            return "crossing";
        case SectionNodeKind::unclear:
            break;
    }
    return "unclear";
}

namespace {

using namespace detail;

Result<void> check_section(const Plane& plane, const SectionOptions& options) {
    if (!is_finite(plane.normal) || !std::isfinite(plane.offset))
        return refuse(RefusalKind::nonfinite, "plane", "has a number that is not finite");
    if (max_abs(plane.normal) == 0) return refuse(RefusalKind::invalid, "plane", "has no normal");
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not a length > 0"));
    return {};
}

template <class P>
std::array<Interval, 2> box_of(const SectionField<P>& field, const std::array<Interval, 2>& places) {
    std::array<Interval, 2> out;
    for (int k = 0; k < 2; ++k) {
        const Interval on = places[std::size_t(k)];
        const int n = field.count(k);
        const double period = field.parameter(k, n) - field.parameter(k, 0);
        // Outwards; whole knots stay.
        const auto at = [&](double x, double by) {
            const double turn = std::floor(x / n) - (x == n),
                         u = field.parameter(k, x - turn * n) + turn * period;
            const double slack = 4 * kUnitRoundoff * std::max(std::abs(u), period);
            return x == std::floor(x) ? u : u + by * slack;
        };
        out[std::size_t(k)] = {at(on.lo, -1), at(on.hi, 1)};
    }
    return out;
}

template <class P>
SectionNode node_of(const SectionField<P>& field, const LevelNode& from) {
    SectionNode node;
    node.box = box_of(field, from.box);
    node.arms = from.arms;
    node.kind = from.bending > 0 && from.arms == 0   ? SectionNodeKind::touch
                : from.bending < 0 && from.arms == 4 ? SectionNodeKind::crossing
                                                     : SectionNodeKind::unclear;
    Param<2> middle;
    for (std::size_t k = 0; k < 2; ++k) {
        const Interval on = field.surface.domain()[k];
        double m = node.box[k].middle();
        if (field.options.cyclic[k] && m >= on.hi) m -= on.length();
        middle[k] = clamped(m, on);
    }
    node.point = field.surface(middle);
    node.gap = 1.04 * from.value / (field.to_function * 0.99 * field.least_weight);
    return node;
}

// A side all of whose control points are one point, but for rounding.
template <class P>
bool is_pole(const SectionField<P>& field, const LevelSide& side) {
    Box<3> box;
    for (int j = int(side.along.lo); j < int(side.along.hi); ++j) {
        const int n = field.count(side.axis), m = field.count(1 - side.axis), own = j % m;
        const int line = side.line == n ? n - 1 : side.line;
        const auto net = field.bezier.net(side.axis == 0 ? Index<2>{line, own} : Index<2>{own, line});
        each_index(net.extent, [&](const Index<2>& at) {
            const std::size_t k = std::size_t(side.axis);
            if (at[k] == (side.line == n ? net.extent[k] - 1 : 0)) box.add(Space<P>::project(net(at)));
        });
    }
    return box.diagonal() <= 64 * kUnitRoundoff * box.scale();
}

// `fit(tolerance)` as near as asked for; where that is not reached, the best of some wider tolerances.
template <class F>
SectionBranch nearest_fit(double tolerance, double rounding, F&& fit) {
    double t = std::max(tolerance, rounding);
    SectionBranch best = fit(t);
    for (int k = 0; k < 6 && best.bound > t; ++k) {
        t *= 64;
        if (t >= best.bound) break;
        if (SectionBranch next = fit(t); next.bound < best.bound) best = std::move(next);
    }
    return best;
}

}  // namespace

template <class P>
requires(Space<P>::kDim == 3) Result<Section> section(const Surface<P>& surface, const Plane& plane,
                                                      const SectionOptions& options) {
    if (auto ok = check_section(plane, options); !ok) return std::unexpected(ok.error());
    SectionField<P> field(surface, plane);
    field.options.max_cells = options.max_cells;
    const LevelSet set = level_set(field.function, field.options);
    Section out;
    double scale = 0;
    for (const P& p : surface.net().flat()) scale = std::max(scale, max_abs(Space<P>::project(p)));
    const auto add = [&](auto&& fit) {
        out.branches.push_back(nearest_fit(options.tolerance, 0x1p-42 * scale, [&](double tolerance) {
            return fit(BranchFit<P>(field, tolerance));
        }));
    };
    for (const LevelBranch& b : set.branches)
        add([&](BranchFit<P>&& fit) { return fit.branch(b, set.cells); });
    for (const LevelSide& s : set.sides)
        if (!is_pole(field, s)) add([&](BranchFit<P>&& fit) { return fit.side(s); });
    for (const LevelNode& n : set.nodes) out.nodes.push_back(node_of(field, n));
    for (const auto& box : set.flat) out.overlaps.push_back(box_of(field, box));
    for (const auto& box : set.undecided) out.undecided.push_back(box_of(field, box));
    return out;
}

template Result<Section> section(const Surface<Vec<3>>&, const Plane&, const SectionOptions&);
template Result<Section> section(const Surface<Hom<3>>&, const Plane&, const SectionOptions&);

}  // namespace freiform
