// How many equal columns and rows the box of a face is cut into before boxes are halved.
//
// Idea: halves alone give 4, 8, 16, .. columns, so that a face that bends evenly gets up to twice as many
// along each axis as it needs, 1.4 times on average. If its box is first cut into 3, 5 or 7 columns, halves
// of these come nearer. Which number is best is tried with the curvature at a few samples: boxes are halved
// as the tree will halve them, and the fewest cells win. Samples decide about the number of triangles only.
// Of a spline the columns may be its pieces: a box in one piece is asked about once, and its bounds are
// sharp, where a box in several has those of each.
//
// Why not cut any box into thirds: cuts of neighbours would not fit each other. Columns of the whole box do.
#include "curvature_tree_detail.hpp"

#include <functional>

namespace freiform {

namespace {

constexpr int kColumnSamples = 3, kPieceSamples = 7;  // along each axis
constexpr std::array<int, 4> kColumnCounts{1, 3, 5, 7};
constexpr double kColumnRoom = 0.97;    // of the tolerance, for what bounds are larger than samples
constexpr double kWorthColumns = 0.95;  // as many cells as with halves alone
constexpr double kWorthPieces = 0.85;   // likewise, where columns are the pieces of a spline
constexpr double kLeastPiece = 0.25;    // of their mean length
constexpr std::size_t kMostPieces = 64;
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
using Columns = std::vector<double>;  // the ends
Columns equal_columns(const Interval& on, int count) {
    Columns out{on.lo};
    for (int k = 1; k < count; ++k) out.push_back(on.lo + on.length() * k / count);
    out.push_back(on.hi);
    return out;
}

// Where a spline's pieces end in the interval; none where these are few, or many, or uneven.
Columns pieces_in(std::span<const double> breaks, const Interval& on) {
    std::size_t count = 1;
    for (const double x : breaks) count += on.lo < x && x < on.hi;
    if (count > kMostPieces) return {};
    const double least = kLeastPiece * on.length() / double(count);
    Columns out{on.lo};
    for (const double x : breaks) {
        if (!(x - on.lo >= least && on.hi - x >= least)) continue;  // a sliver at the end is none by itself
        if (x - out.back() < least) return {};
        out.push_back(x);
    }
    out.push_back(on.hi);
    return out.size() < 3 ? Columns{} : out;
}

class ColumnPlan {
public:
    ColumnPlan(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double tolerance,
               const ConeSeen& cone_seen)
        : surface_(surface), box_(box), tolerance_(tolerance), cone_seen_(cone_seen) {}

    std::array<Columns, 2> best() const {
        const auto samples = samples_of(kColumnSamples);
        std::array<int, 2> counts{1, 1};
        double least = cells(samples, counts) * kWorthColumns;
        if (samples.empty() || !(least >= kFewColumnCells * double(samples.size()))) return {};
        for (const int u : kColumnCounts)
            for (const int v : kColumnCounts)
                if (const double with = cells(samples, {u, v}); with < least) least = with, counts = {u, v};
        const std::array pieces{pieces_in(surface_.breaks(0), box_.side(0)),
                                pieces_in(surface_.breaks(1), box_.side(1))};
        if (pieces[0].empty() || pieces[1].empty() || !are_worth_it(pieces, counts))
            return {equal_columns(box_.side(0), counts[0]), equal_columns(box_.side(1), counts[1])};
        return pieces;
    }

private:
    std::vector<ColumnSample> samples_of(int count) const {
        const Vec<2> size = box_.hi - box_.lo;
        std::vector<ColumnSample> samples;
        for (int i = 0; i < count; ++i)
            for (int k = 0; k < count; ++k) {
                const auto j = jet<2>(surface_.geometry(), {box_.lo[0] + (i + 0.5) / count * size[0],
                                                            box_.lo[1] + (k + 0.5) / count * size[1]});
                ColumnSample s{
                    cone_seen_ ? cone_seen_(j) : seen_at(j, true), {}, norm(j(1, 0)), norm(j(0, 1))};
                if (!(s.a * s.b > 0) || !s.along.is_finite()) continue;
                const Vec<3> m = cross(j(1, 0), j(0, 1)), n = norm(m) > 0 ? unit(m) : Vec<3>{};
                const auto rest = [&](const Vec<3>& x) { return norm(x - dot(n, x) * n); };
                if (!cone_seen_) s.beside = {rest(j(2, 0)), rest(j(1, 1)), rest(j(0, 2))};
                if (error_of(s, size) > kColumnRoom * tolerance_) samples.push_back(s);
            }
        return samples;
    }
    double cells(std::span<const ColumnSample> samples, const std::array<int, 2>& counts) const {
        const Vec<2> size = box_.hi - box_.lo;
        double sum = 0;
        for (const ColumnSample& s : samples)
            sum += cells_of(s, {{size[0] / counts[0], size[1] / counts[1]}}, kColumnRoom * tolerance_) *
                   counts[0] * counts[1];
        return sum;
    }
    // By more samples: where a surface bends differently everywhere, few say little.
    bool are_worth_it(const std::array<Columns, 2>& pieces, const std::array<int, 2>& counts) const {
        const auto samples = samples_of(kPieceSamples);
        return kWorthPieces * cells(samples, {int(pieces[0].size()) - 1, int(pieces[1].size()) - 1}) <=
               cells(samples, counts);
    }

    const DerivativeQuery<2, 3>& surface_;
    Box<2> box_;
    double tolerance_;
    const ConeSeen& cone_seen_;
};

}  // namespace

void CurvatureTree::plan_columns(const DerivativeQuery<2, 3>& surface, double tolerance) {
    Node& root = nodes_[0];
    if (worst_kink(root.box)) return;  // boxes are cut there
    const ConeSeen cone_seen = cone_ ? ConeSeen([&](const auto& j) { return seen_in(j); }) : ConeSeen();
    auto columns = ColumnPlan(surface, root.box, tolerance, cone_seen).best();
    for (std::size_t d = 0; d < 2; ++d) {
        Columns& ends = columns[d];
        if (ends.size() < 3 ||
            std::adjacent_find(ends.begin(), ends.end(), std::greater_equal<>()) != ends.end())
            continue;
        root.columns[d][1] = std::uint8_t(ends.size() - 1);
        columns_[d] = std::move(ends);
    }
}

}  // namespace freiform
