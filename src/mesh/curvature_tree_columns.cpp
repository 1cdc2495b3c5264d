// How many equal columns and rows the box of a face is cut into before boxes are halved.
//
// Idea: halves alone give 4, 8, 16, .. columns, so that a face that bends evenly gets up to twice as many
// along each axis as it needs, 1.4 times on average. If its box is first cut into 3, 5 or 7 columns, halves
// of these come nearer. Which number is best is tried with the curvature at a few samples: boxes are halved
// as the tree will halve them, and the fewest cells win. Samples decide about the number of triangles only.
//
// Why not cut any box into thirds: cuts of neighbours would not fit each other. Columns of the whole box do.
#include "curvature_tree_detail.hpp"

#include <functional>

namespace freiform {

namespace {

constexpr int kColumnSamples = 3;  // along each axis
constexpr std::array<int, 4> kColumnCounts{1, 3, 5, 7};
constexpr double kColumnRoom = 0.97;    // of the tolerance, for what bounds are larger than samples
constexpr double kWorthColumns = 0.95;  // as many cells as with halves alone
constexpr double kMostCells = 1e12;
constexpr double kFewColumnCells = 64;  // the boundary, which is halved, decides about fewer

struct ColumnSample {
    Curvature along, beside;
    double a = 0, b = 0;  // lengths of S_u, S_v
};

// What bounds will say of a box of this size around the sample, roughly.
double error_of(const ColumnSample& s, const Vec<2>& size) {
    const double hu = size[0] / 2, hv = size[1] / 2;
    const double turn =
        std::hypot((s.along.uu * hu + s.along.uv * hv) / s.a, (s.along.uv * hu + s.along.vv * hv) / s.b);
    return s.along.plus(turn, s.beside).error(size);
}

double cells_of(const ColumnSample& s, Vec<2> size, double tolerance) {
    double cells = 1;
    while (cells < kMostCells && error_of(s, size) > tolerance) {
        size[s.along.uu * size[0] * size[0] >= s.along.vv * size[1] * size[1] ? 0 : 1] /= 2;
        cells *= 2;
    }
    return cells;
}

// `cone_seen`: of cones, what counts of derivatives.
using ConeSeen = std::function<Curvature(const Jet<2, 2, Vec<3>>&)>;
std::array<int, 2> columns_for(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double tolerance,
                               const ConeSeen& cone_seen) {
    const Vec<2> size = box.hi - box.lo;
    std::vector<ColumnSample> samples;
    for (int i = 0; i < kColumnSamples; ++i)
        for (int k = 0; k < kColumnSamples; ++k) {
            const auto j = jet<2>(surface.geometry(), {box.lo[0] + (i + 0.5) / kColumnSamples * size[0],
                                                       box.lo[1] + (k + 0.5) / kColumnSamples * size[1]});
            ColumnSample s{cone_seen ? cone_seen(j) : seen_at(j, true), {}, norm(j(1, 0)), norm(j(0, 1))};
            if (!(s.a * s.b > 0) || !s.along.is_finite()) continue;
            const Vec<3> m = cross(j(1, 0), j(0, 1)), n = norm(m) > 0 ? unit(m) : Vec<3>{};
            const auto rest = [&](const Vec<3>& x) { return norm(x - dot(n, x) * n); };
            if (!cone_seen) s.beside = {rest(j(2, 0)), rest(j(1, 1)), rest(j(0, 2))};
            if (error_of(s, size) > kColumnRoom * tolerance) samples.push_back(s);
        }
    std::array<int, 2> best{1, 1};
    if (samples.empty()) return best;
    const auto cells_with = [&](int u, int v) {
        double sum = 0;
        for (const ColumnSample& s : samples)
            sum += cells_of(s, {{size[0] / u, size[1] / v}}, kColumnRoom * tolerance) * u * v;
        return sum;
    };
    double least = cells_with(1, 1) * kWorthColumns;
    if (!(least >= kFewColumnCells * double(samples.size()))) return best;
    for (const int u : kColumnCounts)
        for (const int v : kColumnCounts)
            if (const double cells = cells_with(u, v); cells < least) least = cells, best = {u, v};
    return best;
}

}  // namespace

void CurvatureTree::plan_columns(const DerivativeQuery<2, 3>& surface, double tolerance) {
    Node& root = nodes_[0];
    if (worst_kink(root.box)) return;  // boxes are cut there
    const auto counts = columns_for(surface, root.box, tolerance,
                                    cone_ ? ConeSeen([&](const auto& j) { return seen_in(j); }) : ConeSeen());
    for (std::size_t d = 0; d < 2; ++d) {
        if (counts[d] == 1) continue;
        const Interval on = root.box.side(int(d));
        std::vector<double> ends{on.lo};
        for (int k = 1; k < counts[d]; ++k) ends.push_back(on.lo + on.length() * k / counts[d]);
        ends.push_back(on.hi);
        if (std::adjacent_find(ends.begin(), ends.end(), std::greater_equal<>()) != ends.end()) continue;
        columns_[d] = std::move(ends);
        root.columns[d][1] = std::uint8_t(counts[d]);
    }
}

}  // namespace freiform
