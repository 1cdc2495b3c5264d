// Quads: cells of a grid of parameter lines.
//
// Idea: a rectangle of parameters has no other parameter line in the disc through its corners. So the
// constrained Delaunay triangulation of the crossings of parameter lines has the sides of all cells that the
// boundary of the face leaves alone, and one diagonal of each: nothing has to be forced. Each half is judged
// as any triangle is, and a cell whose halves both stand is a quad. Where a half does not, or the boundary is
// near, there are triangles.
//
// Method: E bounds the error of the halves of a cell (half of the squared radius about the middle of the
// diagonal, curvature_tree.cpp), E = x + y, x = (M_uu du^2 + M_uv du dv) / 8 and y likewise. Errors fall with
// the square of the width, and cells are fewest where both directions have half of the tolerance, so a strip
// of du asks for sqrt(2 x / tolerance) strips in its place; where y is less than half of the tolerance, it is
// left as it is and x has the rest. The largest demand of the cells of a strip is that of the strip. Lines
// are moved so that strips get equal shares, a few times; then strips that exceed are halved.
//
// Cost: one bound of derivatives for each cell and pass; twice or thrice as many cells as an adaptive mesh
// has where curvature is uneven. Accuracy: none is claimed here. References: [Filip Magedson Markot 1986].
// Why not quads of paired triangles anywhere: they are no parameter lines, which is what such meshes are for.
#include "curvature_tree_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/mesh/grid.hpp>

#include <map>

namespace freiform {

namespace {

constexpr double kStripsAtOnce = 16;  // in the place of one: bounds over wide ones are too large
constexpr double kGridMargin = 1 + 0x1p-12;
constexpr double kOnLine = 1e-6;  // of the width of a strip: rounding of parameter curves

struct CellError {
    double x = 0, y = 0;  // of the tolerance
};

CellError cell_error(const DerivativeQuery<2, 3>& surface, const Box<2>& cell, const FaceDemands& demands,
                     bool smooth) {
    const BoxBending b = bending_of(surface, cell, smooth);
    const Vec<2> size = cell.hi - cell.lo;
    const double kinks =
        kink_bound_of(surface.kinks(0), cell.side(0)) + kink_bound_of(surface.kinks(1), cell.side(1));
    const auto parts = [&](const Curvature& c, double more) {
        const double both = c.uv * size[0] * size[1] / 8 + more / 2;
        return CellError{(c.uu * size[0] * size[0] / 8 + both) / demands.tolerance,
                         (c.vv * size[1] * size[1] / 8 + both) / demands.tolerance};
    };
    CellError out = parts(b.full, kinks);
    const double error = b.full.along(size[0], size[1]) / 8 + kinks;
    bool kinked = false;
    for (int d = 0; d < 2; ++d)
        for (const Kink& k : surface.kinks(d)) kinked |= cell.lo[d] <= k.at && k.at <= cell.hi[d];
    if (const Shift shift = smooth && !kinked ? shift_of(b, error, b.full, 1, false) : Shift{};
        shift.exists) {
        const Curvature seen = b.seen(shift.turn);
        const CellError less = parts(seen, shift.across(0, error));
        if (less.x + less.y < out.x + out.y) out = less;
    }
    // Sides and diagonals that are too long ask for their part likewise.
    const double along[2] = {b.first[0] * size[0], b.first[1] * size[1]};
    const double length = std::hypot(along[0], along[1]) / demands.max_edge;
    if (length * length > out.x + out.y) {
        out.x = std::max(out.x, along[0] * along[0] / (demands.max_edge * demands.max_edge));
        out.y = std::max(out.y, along[1] * along[1] / (demands.max_edge * demands.max_edge));
    }
    for (int d = 0; d < 2; ++d)
        if (along[d] > demands.max_aspect * along[1 - d] && along[d] > demands.tolerance)
            (d == 0 ? out.x : out.y) =
                std::max(d == 0 ? out.x : out.y, std::pow(along[d] / (demands.max_aspect * along[1 - d]), 2));
    return out;
}

}  // namespace

void add_cell_needs(const DerivativeQuery<2, 3>& surface, const GridLines& lines, const FaceDemands& demands,
                    const std::function<bool(const Box<2>&)>& is_outside, StripNeeds& needs) {
    Box<2> box;
    for (std::size_t d = 0; d < 2; ++d) box.lo[int(d)] = lines[d].front(), box.hi[int(d)] = lines[d].back();
    const bool smooth = kinks_are_rounding(surface, box, demands.tolerance);
    for (std::size_t i = 0; i + 1 < lines[0].size(); ++i)
        for (std::size_t k = 0; k + 1 < lines[1].size(); ++k) {
            const Box<2> cell{{{lines[0][i], lines[1][k]}}, {{lines[0][i + 1], lines[1][k + 1]}}};
            if (is_outside(cell)) continue;
            auto [x, y] = cell_error(surface, cell, demands, smooth);
            x *= kGridMargin, y *= kGridMargin;
            if (x + y <= 1) continue;
            const auto at_least = [](double& need, double square) {
                const double root = std::sqrt(square);
                need = std::max(need, root < kStripsAtOnce ? root : kStripsAtOnce);
            };
            if (y > 0.5) at_least(needs[1][k], x > 0.5 ? 2 * y : y / (1 - x));
            if (x > 0.5) at_least(needs[0][i], y > 0.5 ? 2 * x : x / (1 - y));
        }
}

std::vector<double> with_needs_met(std::span<const double> lines, std::span<const double> needs,
                                   std::span<const double> fixed, bool halve) {
    std::vector<double> out{lines[0]};
    for (std::size_t i = 0, f = 1; i + 1 < lines.size(); ++f) {
        std::size_t end = i;
        double sum = 0, most = 0;
        for (; end + 1 < lines.size() && lines[end] < fixed[f]; ++end)
            sum += needs[end], most = std::max(most, needs[end]);
        const auto cut = [&](double at) {
            if (out.back() < at && at < fixed[f]) out.push_back(at);
        };
        if (halve || !(most > 1)) {
            for (std::size_t s = i; s < end; ++s) {
                if (needs[s] > 1) cut(lines[s] + (lines[s + 1] - lines[s]) / 2);
                cut(lines[s + 1]);
            }
        } else {
            const int count = int(std::max(std::ceil(sum * (1 - 1e-9)), double(end - i)));
            double before = 0;
            std::size_t s = i;
            for (int c = 1; c < count; ++c) {
                const double at = sum * c / count;
                while (s + 1 < end && before + needs[s] < at) before += needs[s++];
                const double part = needs[s] > 0 ? std::clamp((at - before) / needs[s], 0.0, 1.0) : 1;
                cut(lines[s] + (lines[s + 1] - lines[s]) * part);
            }
        }
        out.push_back(fixed[f]);
        i = end;
    }
    return out;
}

std::optional<GridLines> grid_lines(const DerivativeQuery<2, 3>& surface, const Box<2>& box,
                                    const FaceDemands& demands,
                                    const std::function<bool(const Box<2>&)>& is_outside, double max_cells) {
    GridLines fixed;
    for (int d = 0; d < 2; ++d) {
        auto& lines = fixed[std::size_t(d)];
        lines.push_back(box.lo[d]);
        for (const Kink& k : surface.kinks(d))
            if (k.at > lines.back() && k.at < box.hi[d]) lines.push_back(k.at);
        if (!(lines.back() < box.hi[d])) return std::nullopt;
        lines.push_back(box.hi[d]);
    }
    GridLines lines = fixed;
    for (int pass = 0; pass < kGridPasses + kGridHalvings; ++pass) {
        if (double(lines[0].size()) * double(lines[1].size()) > max_cells) return std::nullopt;
        StripNeeds needs;
        for (std::size_t d = 0; d < 2; ++d) needs[d].assign(lines[d].size() - 1, 0x1p-10);
        add_cell_needs(surface, lines, demands, is_outside, needs);
        GridLines next;
        for (std::size_t d = 0; d < 2; ++d)
            next[d] = with_needs_met(lines[d], needs[d], fixed[d], pass >= kGridPasses);
        if (next == lines) break;
        lines = std::move(next);
    }
    return lines;
}

namespace {

// The line that the parameter is on, but for rounding; -1 if it is on none.
int line_of(std::span<const double> lines, double x) {
    const auto after = std::lower_bound(lines.begin(), lines.end(), x);
    const auto near = [&](std::ptrdiff_t i) {
        if (i < 0 || i >= std::ssize(lines)) return false;
        double width = kInfinity;
        if (i > 0) width = lines[std::size_t(i)] - lines[std::size_t(i) - 1];
        if (i + 1 < std::ssize(lines))
            width = std::min(width, lines[std::size_t(i) + 1] - lines[std::size_t(i)]);
        return std::abs(x - lines[std::size_t(i)]) <= kOnLine * width;
    };
    const std::ptrdiff_t i = after - lines.begin();
    return near(i) ? int(i) : near(i - 1) ? int(i) - 1 : -1;
}

}  // namespace

int pair_halves(const GridLines& lines, std::span<const Vec<2>> uv, std::span<const int> point,
                std::vector<std::array<int, 3>>& triangles) {
    std::vector<std::array<int, 2>> on(uv.size());
    for (std::size_t i = 0; i < uv.size(); ++i)
        on[i] = {line_of(lines[0], uv[i][0]), line_of(lines[1], uv[i][1])};
    std::vector<char> taken(triangles.size());
    std::map<std::array<int, 2>, std::size_t> half_of;  // by cell
    std::vector<std::array<int, 3>> pairs;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<int, 2> least{}, most{};
        for (std::size_t d = 0; d < 2; ++d) {
            const auto& v = triangles[t];
            const auto at = [&](int k) { return on[std::size_t(v[std::size_t(k)])][d]; };
            least[d] = std::min({at(0), at(1), at(2)}), most[d] = std::max({at(0), at(1), at(2)});
        }
        if (least[0] < 0 || least[1] < 0 || most[0] != least[0] + 1 || most[1] != least[1] + 1) continue;
        const auto [it, first] = half_of.try_emplace(least, t);
        if (first || taken[it->second]) continue;
        // The other half, if both are of one cell, begins at its corner that is not in this one.
        const auto &a = triangles[it->second], &b = triangles[t];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t n = 0; n < 3; ++n)
                if (a[k] == b[(n + 1) % 3] && a[(k + 1) % 3] == b[n]) {
                    const int aside = a[(k + 2) % 3], beyond = b[(n + 2) % 3];
                    const int p = point[std::size_t(aside)];
                    if (p >= 0 && p == point[std::size_t(beyond)]) continue;
                    pairs.push_back({a[(k + 1) % 3], aside, a[k]});
                    pairs.push_back({a[(k + 1) % 3], a[k], beyond});
                    taken[it->second] = taken[t] = 1;
                }
    }
    const int quads = int(pairs.size() / 2);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!taken[t]) pairs.push_back(triangles[t]);
    triangles = std::move(pairs);
    return quads;
}

}  // namespace freiform
