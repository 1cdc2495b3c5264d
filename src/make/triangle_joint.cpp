// Idea. C^k: the new coefficients in distance r from the edge are the blossom at r times the apex and n - r
// corners of the edge, so they are the edge of level r of de Casteljau's construction at the apex.
// G^1: B = -lambda A + gamma E' has degree n if A and E' have n - 1; the row beside the edge is the
// (elevated) edge plus B / (n + 1). In homogeneous coefficients the same: tangent planes are spanned by E, E'
// and A. Point normals: an edge begins in the tangent plane, at the point a third of the way projected onto
// it; the inner point makes quadratics exact: b_111 = e + (e - v) / 2, e the mean of the six, v that of the
// corners. The normal in the middle of an edge is the sum of both reflected at the plane across the edge.
//
// Accuracy of C^k: that of the construction (its bound); where degrees were elevated before, 5 roundings of
// the largest coefficient each, stretched by the construction as every error is.
//
// References: [Farin 1986], [Farin 1982], [Vlachos & Peters & Boyd & Mitchell 2001].
//
// Why not factors of higher degree, or a free one at B? Linear ones are what the ends of the edge determine,
// and keep the degree down.
#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/make/triangle_joint.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

std::unexpected<Refusal> invalid_joint(std::string where, std::string message) {
    return refuse(RefusalKind::invalid, std::move(where), std::move(message));
}

// Row `row` from the edge on, from its beginning to its end: places of the net of degree n.
std::vector<std::size_t> row_slots(int n, int edge, int row) {
    std::vector<std::size_t> out;
    for (int i = 0; i <= n - row; ++i) {
        std::array<int, 3> at{};
        at[std::size_t(edge)] = row;
        at[std::size_t((edge + 1) % 3)] = n - row - i, at[std::size_t((edge + 2) % 3)] = i;
        out.push_back(SimplexPatch<2, Vec<1>>::slot(at[1], at[2]));
    }
    return out;
}

// n with (n - order)(n - order + 1) / 2 = free; -1: none.
int degree_for(std::size_t free, int order) {
    for (int m = 0; m <= kMaxDegree + 1; ++m)
        if (std::size_t(m * (m + 1) / 2) == free) return m + order;
    return -1;
}

Result<void> check_edge(int edge) {
    if (edge < 0 || edge > 2) return invalid_joint("edge", text(edge, " is not 0, 1 or 2"));
    return {};
}

// The patch with these rows beside its edge 0, which run from its corner 3 to its corner 2.
template <class P>
Result<SimplexPatch<2, P>> with_rows(int n, std::vector<P> free, const std::vector<std::vector<P>>& rows) {
    free.resize(std::size_t((n + 1) * (n + 2) / 2));
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const auto at = row_slots(n, 0, int(r));
        for (std::size_t i = 0; i < at.size(); ++i) free[at[at.size() - 1 - i]] = rows[r][i];
    }
    return SimplexPatch<2, P>::make(n, std::move(free));
}

template <class P>
double largest(const SimplexPatch<2, P>& s) {
    double size = 0;
    for (const P& p : s.coefficients()) size = std::max(size, max_abs(p));
    return size;
}

}  // namespace

template <class P>
Result<JoinedTriangle<P>> next_c(const SimplexPatch<2, P>& s, int edge, int order, const Param<2>& apex,
                                 std::vector<P> free) {
    if (auto ok = check_edge(edge); !ok) return std::unexpected(ok.error());
    if (order < 0 || order > kMaxDegree)
        return invalid_joint("order", text(order, " is outside 0..", kMaxDegree));
    const Bounded t[3] = {Bounded(1) - apex[0] - apex[1], apex[0], apex[1]};
    const Bounded& side = t[std::size_t(edge)];
    if (!(side.excludes_zero() && side.value < 0))
        return invalid_joint("apex", text("(", apex[0], ", ", apex[1], ") is not beyond edge ", edge));
    const int n = degree_for(free.size(), order);
    if (n < std::max(s.degree(), order) || n > kMaxDegree)
        return invalid_joint("free", text(free.size(), " coefficients leave no triangle of a degree from ",
                                          std::max(s.degree(), order), " to ", kMaxDegree));
    auto raised = s;
    for (int m = s.degree(); m < n; ++m) raised = *elevate(raised);
    const auto all = de_casteljau(raised, apex);
    if (!all) return refuse_within("apex", all.error());
    std::vector<std::vector<P>> rows;
    for (int r = 0; r <= order; ++r) {
        auto& row = rows.emplace_back();
        for (const std::size_t i : row_slots(n - r, edge, 0)) row.push_back(all->level(r)[i]);
    }
    const double stretch = std::abs(t[0].value) + std::abs(t[1].value) + std::abs(t[2].value);
    const double elevation = (n - s.degree()) * 5.1 * kUnitRoundoff * largest(s);
    auto patch = with_rows(n, std::move(free), rows);
    if (!patch) return std::unexpected(patch.error());
    return JoinedTriangle<P>{std::move(*patch),
                             all->bound() + elevation * std::pow(stretch, order) * (1 + 0x1p-40)};
}

template <class P>
Result<SimplexPatch<2, P>> next_g1(const SimplexPatch<2, P>& s, int edge, const TangentChange& change,
                                   std::vector<P> free) {
    if (auto ok = check_edge(edge); !ok) return std::unexpected(ok.error());
    const int n = s.degree();
    if (n < 1 || n >= kMaxDegree) return invalid_joint("degree", text(n, " is outside 1..", kMaxDegree - 1));
    for (const double l : change.lambda)
        if (!(l > 0)) return invalid_joint("lambda", text(l, " is not positive"));
    for (const double g : change.gamma)
        if (!std::isfinite(g)) return refuse(RefusalKind::nonfinite, "gamma", text(g, " is no number"));
    if (free.size() != std::size_t((n + 1) * n / 2))
        return invalid_joint("free", text(free.size(), " coefficients, ", (n + 1) * n / 2, " are free"));
    const auto b = s.coefficients();
    std::vector<P> edge_points, raised, across, along;  // E, E elevated, A / n, E' / n
    for (const std::size_t i : row_slots(n, edge, 0)) edge_points.push_back(b[i]);
    const auto inner = row_slots(n, edge, 1);
    for (std::size_t i = 0; i < inner.size(); ++i) {
        across.push_back(b[inner[i]] - edge_points[i]);
        along.push_back(edge_points[i + 1] - edge_points[i]);
    }
    for (int i = 0; i <= n + 1; ++i) {
        P sum{};
        if (i > 0) sum += double(i) / (n + 1) * edge_points[std::size_t(i - 1)];
        if (i <= n) sum += double(n + 1 - i) / (n + 1) * edge_points[std::size_t(i)];
        raised.push_back(sum);
    }
    // Coefficient i of a linear function times one of degree n - 1 is ((n - i) f_0 d_i + i f_1 d_(i-1)) / n.
    std::vector<P> beside;
    for (int i = 0; i <= n; ++i) {
        P sum{};
        const auto add = [&](int weight, std::size_t end, int at) {
            if (weight > 0)
                sum += double(weight) * (change.gamma[end] * along[std::size_t(at)] -
                                         change.lambda[end] * across[std::size_t(at)]);
        };
        add(n - i, 0, i), add(i, 1, i - 1);
        beside.push_back(raised[std::size_t(i)] + 1.0 / (n + 1) * sum);
    }
    return with_rows(n + 1, std::move(free), {raised, beside});
}

Result<PointNormalTriangle> point_normal_triangle(const std::array<Vec<3>, 3>& points,
                                                  const std::array<Vec<3>, 3>& normals) {
    std::array<Vec<3>, 3> n;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "is no point");
        if (!is_finite(normals[i]))
            return refuse(RefusalKind::nonfinite, text("normals[", i, "]"), "is no vector");
        if (max_abs(normals[i]) == 0) return invalid_joint(text("normals[", i, "]"), "is zero");
        n[i] = unit(normals[i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (points[i] == points[(i + 1) % 3])
            return invalid_joint(text("points[", (i + 1) % 3, "]"), "is the same point as the one before");
    // A third of the way from i to j, moved into the tangent plane at i.
    const auto third = [&](std::size_t i, std::size_t j) {
        return (1.0 / 3) * (2.0 * points[i] + points[j] - dot(points[j] - points[i], n[i]) * n[i]);
    };
    // The sum of both normals, mirrored at the plane across the edge: the same bits from either end.
    const auto between = [&](std::size_t i, std::size_t j) {
        const Vec<3> d = unit(points[j] - points[i]), sum = n[i] + n[j], h = sum - 2 * dot(d, sum) * d;
        return max_abs(h) == 0 ? sum : unit(h);
    };
    const Vec<3> b210 = third(0, 1), b201 = third(0, 2), b120 = third(1, 0), b021 = third(1, 2),
                 b102 = third(2, 0), b012 = third(2, 1);
    const Vec<3> e = (1.0 / 6) * (b210 + b201 + b120 + b021 + b102 + b012),
                 v = (1.0 / 3) * (points[0] + points[1] + points[2]);
    auto patch = SimplexPatch<2, Vec<3>>::make(
        3, {points[0], b210, b201, b120, e + 0.5 * (e - v), b102, points[1], b021, b012, points[2]});
    if (!patch) return std::unexpected(patch.error());
    auto shading =
        SimplexPatch<2, Vec<3>>::make(2, {n[0], between(0, 1), between(0, 2), n[1], between(1, 2), n[2]});
    if (!shading) return std::unexpected(shading.error());
    return PointNormalTriangle{std::move(*patch), std::move(*shading)};
}

#define FF_TRIANGLE_JOINT(P)                                                                          \
    template Result<JoinedTriangle<P>> next_c(const SimplexPatch<2, P>&, int, int, const Param<2>&,   \
                                              std::vector<P>);                                        \
    template Result<SimplexPatch<2, P>> next_g1(const SimplexPatch<2, P>&, int, const TangentChange&, \
                                                std::vector<P>);
FF_TRIANGLE_JOINT(Vec<1>)
FF_TRIANGLE_JOINT(Vec<3>)
FF_TRIANGLE_JOINT(Hom<3>)
#undef FF_TRIANGLE_JOINT

}  // namespace freiform
