// Idea: all of it is blossoming. With F the blossom of the triangle:
// Three surfaces: over a quadrilateral with the corners d_00, d_10, d_01, d_11 the place is bilinear in (s,
// t), so f is a polynomial of degree n in each, and multiaffinity gives its coefficients,
//     p_ij = sum_m  C(i, m) C(n - i, j - m) / C(n, j)  F(d_11^m d_10^(i-m) d_01^(j-m) d_00^(n-i-j+m)):
// of n arguments i are at s = 1 and j at t = 1 in all ways, m of them both. A convex combination; on the
// sides a single term, with the arguments in an order that depends on where they are, so neighbours agree.
// Degenerate surface: row j + k = a of the net is a Bezier curve of degree a in v, raised to degree n.
// Triangles: with f the blossom of the tensor patch in m + m' = N arguments, F(a_1 ..) is the mean of
// f(u of m of the arguments; v of the others) over all choices; for arguments at the corners of the triangle
// these are control points:
//     b_ijk = sum_{a,c} C(j, a) C(k, c) C(i, m - a - (k - c)) / C(N, m)  p_ac
// with a of the j arguments at (1, 0) among the u's and c of the k at (0, 1) among the v's.
//
// Lower degree: with E the elevation, E^T E is solved by Cholesky for what is not a corner. Its condition is
// about the degree. The bound is that of E x - b, whatever x is.
//
// Accuracy: counted as it happens (bounded.hpp). Cost: O(n^5) for three surfaces (n^3 blossoms),
// everything else O(n^4) or less.
//
// References: [Ramshaw 1989], [Goldman & Filip 1987], [Hu 1996], [Farin 1986].
//
// Why not Warren's blending of poles away? It has base points: weights that are zero.
#include "spline/simplex_bounded_detail.hpp"

#include <freiform/basis/bspline.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/simplex_convert.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace simplex {

Place place_of(const Param<2>& u) {
    return {Bounded(1) - Bounded(u[0]) - Bounded(u[1]), Bounded(u[0]), Bounded(u[1])};
}

Flat stepped(const Flat& b, int coords, int m, const Place& t) {
    Flat out(count_for(m - 1) * std::size_t(coords));
    for (int r = 0; r < m; ++r)
        for (int k = 0; k <= r; ++k)
            for (int c = 0; c < coords; ++c) {
                const auto at = [&](int j, int l) {
                    return b[slot(j, l) * std::size_t(coords) + std::size_t(c)];
                };
                out[slot(r - k, k) * std::size_t(coords) + std::size_t(c)] =
                    t[0] * at(r - k, k) + t[1] * at(r - k + 1, k) + t[2] * at(r - k, k + 1);
            }
    return out;
}

Flat elevated(const Flat& b, int coords, int degree) {
    const int n = degree + 1;
    Flat out;
    for (int r = 0; r <= n; ++r)
        for (int k = 0; k <= r; ++k)
            for (int c = 0; c < coords; ++c) {
                const int j = r - k, i = n - r;
                Bounded sum;
                const auto add = [&](int times, int jj, int kk) {
                    if (times > 0)
                        sum += Bounded(times) * b[slot(jj, kk) * std::size_t(coords) + std::size_t(c)];
                };
                add(i, j, k), add(j, j - 1, k), add(k, j, k - 1);
                out.push_back(sum / Bounded(n));
            }
    return out;
}

std::vector<std::size_t> edge_slots(int n, int edge) {
    std::vector<std::size_t> out;
    for (int a = 0; a <= n; ++a)
        out.push_back(edge == 0 ? slot(n - a, a) : edge == 1 ? slot(0, n - a) : slot(a, 0));
    return out;
}

namespace {

Bounded choose(int n, int k) { return k < 0 || k > n ? Bounded() : Bounded(binomial(n, k)); }

// Rows of the degenerate surface.
Flat with_pole(const Flat& b, int coords, int n) {
    Flat out;
    for (int a = 0; a <= n; ++a) {
        for (int j = 0; j <= n; ++j)
            for (int c = 0; c < coords; ++c) {
                Bounded sum;
                for (int k = std::max(0, j - (n - a)); k <= std::min(a, j); ++k) {
                    const Bounded p = b[slot(a - k, k) * std::size_t(coords) + std::size_t(c)];
                    if (a == 0 || a == n)
                        sum = p;
                    else
                        sum += choose(a, k) * choose(n - a, j - k) * p;
                }
                out.push_back(a == 0 || a == n ? sum : sum / choose(n, j));
            }
    }
    return out;
}

// The surface over a quadrilateral: corners d[2 s + t].
Flat over_quadrilateral(const Flat& b, int coords, int n, const std::array<Place, 4>& d) {
    Flat out(std::size_t((n + 1) * (n + 1) * coords));
    if (n == 0) return b;
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    const auto key = [&](std::size_t x) { return std::array{d[x][0].value, d[x][1].value, d[x][2].value}; };
    sort(order.begin(), order.end(), [&](auto x, auto y) { return key(x) < key(y); });
    std::array<int, 4> times{};
    Flat first = b;
    for (int a0 = 0; a0 <= n; ++a0) {
        Flat second = first;
        for (int a1 = 0; a0 + a1 <= n; ++a1) {
            Flat third = second;
            for (int a2 = 0; a0 + a1 + a2 <= n; ++a2) {
                const int a3 = n - a0 - a1 - a2;
                Flat value = third;
                for (int m = a3; m > 0; --m) value = stepped(value, coords, m, d[order[3]]);
                times[order[0]] = a0, times[order[1]] = a1, times[order[2]] = a2, times[order[3]] = a3;
                const int i = times[2] + times[3], j = times[1] + times[3], m = times[3];
                // On a side there is one term; as it is, so that neighbours agree to the bit.
                const Bounded ways = i % n == 0 || j % n == 0
                                         ? Bounded(1)
                                         : choose(i, m) * choose(n - i, j - m) / choose(n, j);
                for (int c = 0; c < coords; ++c)
                    out[std::size_t((i * (n + 1) + j) * coords + c)] += ways * value[std::size_t(c)];
                if (a3 > 0) third = stepped(third, coords, a3, d[order[2]]);
            }
            if (a0 + a1 < n) second = stepped(second, coords, n - a0 - a1, d[order[1]]);
        }
        if (a0 < n) first = stepped(first, coords, n - a0, d[order[0]]);
    }
    return out;
}

// b_ijk of the half with the corners (0, 0), (1, 0), (0, 1), or of the opposite one.
Flat half(const Flat& p, int coords, int m, int n, bool opposite) {
    const int degree = m + n;
    Flat out;
    for (int r = 0; r <= degree; ++r)
        for (int k = 0; k <= r; ++k) {
            const int i = degree - r, j = r - k;
            Flat sum(static_cast<std::size_t>(coords));
            // The same order for both halves, so that they agree along the diagonal.
            for (int x = 0; x <= m; ++x) {
                const int a = opposite ? m - x : x;
                for (int y = 0; y <= n; ++y) {
                    const int q = opposite ? n - y : y;
                    const Bounded ways = choose(j, a) * choose(k, q) * choose(i, m - a - (k - q));
                    if (ways.is_zero()) continue;
                    for (int c = 0; c < coords; ++c)
                        sum[std::size_t(c)] += ways * p[std::size_t((x * (n + 1) + y) * coords + c)];
                }
            }
            for (const Bounded& s : sum) out.push_back(s / choose(degree, m));
        }
    return out;
}

// x with E x near b, in least squares; the corners are those of b.
Flat reduced(const Flat& b, int coords, int n) {
    const std::size_t size = count_for(n - 1), corners[3] = {0, slot(n - 1, 0), slot(0, n - 1)},
                      from[3] = {0, slot(n, 0), slot(0, n)};
    // E: in every row up to three entries.
    std::vector<std::vector<std::pair<std::size_t, double>>> rows;
    for (int r = 0; r <= n; ++r)
        for (int k = 0; k <= r; ++k) {
            auto& row = rows.emplace_back();
            const int j = r - k, i = n - r;
            if (i > 0) row.emplace_back(slot(j, k), double(i) / n);
            if (j > 0) row.emplace_back(slot(j - 1, k), double(j) / n);
            if (k > 0) row.emplace_back(slot(j, k - 1), double(k) / n);
        }
    std::vector<double> normal(size * size), right(size * std::size_t(coords));
    for (std::size_t q = 0; q < rows.size(); ++q)
        for (const auto& [x, fx] : rows[q]) {
            for (const auto& [y, fy] : rows[q]) normal[x * size + y] += fx * fy;
            for (std::size_t c = 0; c < std::size_t(coords); ++c)
                right[x * std::size_t(coords) + c] += fx * b[q * std::size_t(coords) + c].value;
        }
    // Known corners leave the system: their columns go to the right, their rows say x = b.
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t y = 0; y < size; ++y) {
            const double f = std::exchange(normal[y * size + corners[k]], y == corners[k] ? 1.0 : 0.0);
            normal[corners[k] * size + y] = normal[y * size + corners[k]];
            for (std::size_t c = 0; c < std::size_t(coords); ++c) {
                const double known = b[from[k] * std::size_t(coords) + c].value;
                double& to = right[y * std::size_t(coords) + c];
                to = y == corners[k] ? known : to - f * known;
            }
        }
    // Rows of other corners were reduced by this one: set them again.
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < std::size_t(coords); ++c)
            right[corners[k] * std::size_t(coords) + c] = b[from[k] * std::size_t(coords) + c].value;
    for (std::size_t x = 0; x < size; ++x) {  // Cholesky, the lower triangle in place
        for (std::size_t y = 0; y <= x; ++y) {
            double sum = normal[x * size + y];
            for (std::size_t z = 0; z < y; ++z) sum -= normal[x * size + z] * normal[y * size + z];
            normal[x * size + y] = x == y ? std::sqrt(sum) : sum / normal[y * size + y];
        }
    }
    for (std::size_t c = 0; c < std::size_t(coords); ++c) {
        const auto at = [&](std::size_t x) -> double& { return right[x * std::size_t(coords) + c]; };
        for (std::size_t x = 0; x < size; ++x) {
            for (std::size_t y = 0; y < x; ++y) at(x) -= normal[x * size + y] * at(y);
            at(x) /= normal[x * size + x];
        }
        for (std::size_t x = size; x-- > 0;) {
            for (std::size_t y = x + 1; y < size; ++y) at(x) -= normal[y * size + x] * at(y);
            at(x) /= normal[x * size + x];
        }
    }
    return {right.begin(), right.end()};
}

}  // namespace
}  // namespace simplex

namespace {

using namespace simplex;

template <class P>
Surface<P> surface_of(int n, std::vector<P> c) {
    const auto basis = *BSplineBasis::bezier(n);
    return Surface<P>::trusted({basis, basis}, Net<2, P>({n + 1, n + 1}, std::move(c)));
}

std::unexpected<Refusal> no_digits(std::string_view where) {
    return refuse(RefusalKind::ill_conditioned, std::string(where),
                  "rounding leaves nothing of the weights, or the numbers leave the range of double");
}

}  // namespace

template <class P>
Parts<Surface<P>, 1> to_surface(const SimplexPatch<2, P>& s) {
    auto r = rounded<P>(with_pole(flat(s.coefficients()), P::kCoords, s.degree()));
    return {{surface_of(s.degree(), std::move(r.coefficients))}, r.bound};
}

template <class P>
Result<Parts<Surface<P>, 3>> to_three_surfaces(const SimplexPatch<2, P>& s, const Param<2>& centre) {
    const Place middle = place_of(centre);
    for (const Bounded& t : middle)
        if (!(t.value > t.bound))
            return refuse(RefusalKind::out_of_domain, "centre",
                          text("(", centre[0], ", ", centre[1], ") is not inside the triangle"));
    constexpr Place kTriangleCorner[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    kEdgeMiddle[3] = {{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};  // of edge 0, 1, 2
    const Flat b = flat(s.coefficients());
    std::vector<Surface<P>> parts;
    double bound = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        auto r = rounded<P>(over_quadrilateral(
            b, P::kCoords, s.degree(),
            {kTriangleCorner[i], kEdgeMiddle[(i + 1) % 3], kEdgeMiddle[(i + 2) % 3], middle}));
        bound = std::max(bound, r.bound);
        parts.push_back(surface_of(s.degree(), std::move(r.coefficients)));
    }
    if (!std::isfinite(bound)) return no_digits("triangle");
    return Parts<Surface<P>, 3>{{parts[0], parts[1], parts[2]}, bound};
}

template <class P>
Result<Parts<SimplexPatch<2, P>, 2>> to_triangles(const Surface<P, Bernstein>& s) {
    const int m = s.basis(0).degree(), n = s.basis(1).degree();
    if (m + n > kMaxDegree)
        return refuse(RefusalKind::unsupported, "degree",
                      text("triangles of degree ", m, " + ", n, " are above ", kMaxDegree));
    const Flat p = flat(s.net().flat());
    auto lower = rounded<P>(half(p, P::kCoords, m, n, false)),
         upper = rounded<P>(half(p, P::kCoords, m, n, true));
    const double bound = std::max(lower.bound, upper.bound);
    if (!std::isfinite(bound)) return no_digits("surface");
    return Parts<SimplexPatch<2, P>, 2>{{SimplexPatch<2, P>::trusted(m + n, std::move(lower.coefficients)),
                                         SimplexPatch<2, P>::trusted(m + n, std::move(upper.coefficients))},
                                        bound};
}

template <class P>
Result<ReducedTriangle<P>> reduce_degree(const SimplexPatch<2, P>& s, double tolerance) {
    if (!(tolerance >= 0)) return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not >= 0"));
    const int n = s.degree();
    if (n < 2)
        return refuse(RefusalKind::no_answer, "degree",
                      text("a triangle of degree ", n, " has none to lose"));
    const Flat b = flat(s.coefficients()), x = reduced(b, P::kCoords, n);
    auto out = SimplexPatch<2, P>::make(n - 1, rounded<P>(x).coefficients);
    if (!out) return std::unexpected(out.error());
    // b is as near to the elevated net as these bounds say.
    Flat near = elevated(x, P::kCoords, n - 1);
    for (std::size_t i = 0; i < b.size(); ++i)
        near[i].bound = (std::abs(near[i].value - b[i].value) + near[i].bound) * (1 + 0x1p-50);
    const double bound = rounded<P>(near).bound;
    if (!(bound <= tolerance))
        return refuse(RefusalKind::no_answer, "tolerance",
                      text("degree ", n - 1, " comes within ", bound, ", not ", tolerance));
    return ReducedTriangle<P>{std::move(*out), bound};
}

#define FF_SIMPLEX_CONVERT(P)                                                                            \
    template Parts<Surface<P>, 1> to_surface(const SimplexPatch<2, P>&);                                 \
    template Result<Parts<Surface<P>, 3>> to_three_surfaces(const SimplexPatch<2, P>&, const Param<2>&); \
    template Result<Parts<SimplexPatch<2, P>, 2>> to_triangles(const Surface<P, Bernstein>&);            \
    template Result<ReducedTriangle<P>> reduce_degree(const SimplexPatch<2, P>&, double);
FF_SIMPLEX_CONVERT(Vec<1>)
FF_SIMPLEX_CONVERT(Vec<2>)
FF_SIMPLEX_CONVERT(Vec<3>)
FF_SIMPLEX_CONVERT(Vec<4>)
FF_SIMPLEX_CONVERT(Hom<1>)
FF_SIMPLEX_CONVERT(Hom<2>)
FF_SIMPLEX_CONVERT(Hom<3>)
FF_SIMPLEX_CONVERT(Hom<4>)
#undef FF_SIMPLEX_CONVERT

}  // namespace freiform
