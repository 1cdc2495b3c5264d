// Which way a closed part faces.
//
// Idea. The integral of p . n over a closed surface is three times what it encloses, negative where its
// normals point inward. Rows of midpoints over the parameters of each face, inside its loops by the odd-even
// rule, tell its sign. Twice as many rows tell whether it can be trusted: walls that are far thinner than
// they are wide may be lost in what midpoints miss, and then nothing is said.
#include "sew_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kRows = 12, kEach = 6;  // midpoints of a row, in each of its parts inside

// The integral over a face, seen from `from`; its sign that of the normal of the surface.
double integral(const Model& m, const Face& f, const Vec<3>& from, int rows, Box<3>& seen) {
    std::vector<Side2> sides;
    Box<2> box;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges)
            for (const Side2& s : sides_along(c.curve, m.edges[std::size_t(c.edge)].range)) {
                sides.push_back(s);
                box.add(s[0]), box.add(s[1]);
            }
    const auto limits_of_surface = limits(f.surface);
    double sum = 0;
    for (int row = 0; row < rows; ++row) {
        const double v = box.lo[1] + (box.hi[1] - box.lo[1]) * (row + 0.5) / rows;
        std::vector<double> at;
        for (const auto& [p, q] : sides)
            if ((p[1] > v) != (q[1] > v)) at.push_back(p[0] + (q[0] - p[0]) * (v - p[1]) / (q[1] - p[1]));
        sort(at.begin(), at.end());
        for (std::size_t k = 0; k + 1 < at.size(); k += 2)
            for (int i = 0; i < kEach * rows / kRows; ++i) {
                const double step = (at[k + 1] - at[k]) / (kEach * rows / kRows);
                const Vec<2> uv = clamped(Vec<2>{{at[k] + (i + 0.5) * step, v}}, limits_of_surface);
                const auto s = jet<1>(f.surface, uv.c);
                const double here = dot(s(0, 0) - from, cross(s(1, 0), s(0, 1))) * step;
                if (std::isfinite(here)) sum += here, seen.add(s(0, 0));
            }
    }
    return sum * (box.hi[1] - box.lo[1]) / rows;
}

}  // namespace

PartFacing facing(const Model& model, std::span<const int> part, std::span<const char> inward) {
    // Seen from a vertex of its: large coordinates would cost digits.
    const Loop& first = model.faces[std::size_t(part.front())].loops.front();
    const Edge& edge = model.edges[std::size_t(first.coedges.front().edge)];
    const Vec<3> from = model.vertices[std::size_t(edge.start)].point;
    PartFacing out;
    double coarse = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Face& f = model.faces[std::size_t(part[i])];
        const double sign = inward[i] ? -1 : 1;
        coarse += sign * integral(model, f, from, kRows, out.box);
        out.sum += sign * integral(model, f, from, 2 * kRows, out.box);
    }
    if (!(std::abs(out.sum - coarse) < std::abs(out.sum) / 2)) out.sum = 0;
    return out;
}

}  // namespace freiform
