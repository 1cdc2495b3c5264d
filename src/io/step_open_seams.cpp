// Seams of splines that do not quite close.
//
// An edge that a face uses twice, there and back, along a side of its surface is a seam: the file says that
// the opposite side is the same place, also where the two are farther apart than its tolerance. Blends around
// closed edges are like that, whose sections come back to where they began only as well as they were
// computed. Such a surface is taken as closed; how far it is open is what its seam lies beside it, and is
// told as that.
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr double kAlong = 2;  // times what the sides are apart: a seam is that near to one

// The edges that are used twice.
std::vector<int> twice(std::vector<int> used) {
    sort(used);
    std::vector<int> out;
    for (std::size_t i = 0; i + 1 < used.size(); ++i)
        if (used[i] == used[i + 1] && (out.empty() || out.back() != used[i])) out.push_back(used[i]);
    return out;
}

}  // namespace

// `used`: the edges of the face, as often as it uses them.
const Chart& ShapeReader::chart_of(SurfaceMade& made, std::uint32_t surface, const std::vector<int>& used) {
    const Chart& plain = *made.chart;
    double seam = 0;
    const std::vector<int> seams = twice(used);
    for (int axis = 0; axis < 2; ++axis) {
        const double apart = plain.apart(axis);
        if (!std::isfinite(apart) || plain.period(axis) > 0) continue;
        const auto side = plain.iso(axis, plain.whole()[std::size_t(axis)].lo);
        const auto is_along = [&](int edge) {
            const Edge& e = out_.model.edges[std::size_t(edge)];
            if (!e.curve) return false;
            for (int k = 0; k <= 4; ++k) {
                double off = 0;
                parameter_of(*side, jet<0>(*e.curve, e.range.lo + e.range.length() * k / 4).value(), off);
                if (!(off <= kAlong * apart)) return false;
            }
            return true;
        };
        if (side && std::ranges::any_of(seams, is_along)) seam = std::max(seam, apart);
    }
    if (seam == 0) return plain;
    if (!made.seamed) {
        made.seamed = std::make_unique<Chart>(made.surface, tolerance_, seam);
        charts_.emplace(made.seamed.get(), surface);
    }
    return *made.seamed;
}

// Of a face on such a chart.
void ShapeReader::tell_seam(std::uint32_t face, const Chart& chart, const std::vector<int>& used) {
    // Distances of control points bound that of the sides; what computing them is off by is added.
    const double open =
        chart.seam() * (1 + 8 * kUnitRoundoff) + 4 * value_error_bound(chart.surface(), chart.whole());
    report(-1,
           text(f_.label(face), ": its surface does not close at its seam, by up to ", chart.seam(),
                "; the file says at most ", tolerance_),
           open, 0);
    for (const int edge : twice(used)) {
        Edge& e = out_.model.edges[std::size_t(edge)];
        e.tolerance = std::max(e.tolerance, open);
    }
}

}  // namespace freiform::step
