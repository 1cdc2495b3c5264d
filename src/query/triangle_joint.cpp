// Idea. Along the edge everything is a polynomial in Bernstein form, or a quotient of two. A quotient |N| / d
// is at most the largest coefficient of N over the smallest of d (both are means of their coefficients);
// halving the interval makes that sharp, and is repeated where the bound is largest.
//
// Notation. Homogeneous: (X, w) the edge, (A, alpha) the derivative from its beginning towards the opposite
// corner, ' the derivative along it. A w - X alpha is w^2 times the derivative of the point.
//
// Method. Position: (X_a w_b - X_b w_a) / (w_a w_b). C^1: the same for derivatives over w^2. Angle: with the
// normals M_a = E_a' x A, M_b = B x E_b', sin = |M_a x M_b| / (|M_a| |M_b|), and |M| is at least the smallest
// coefficient of M in the direction of the normal in the middle. If sin stays below 1, the angle stays on the
// side of 90 degrees on which it begins.
//
// Accuracy: all numbers carry the bound of their rounding (bounded.hpp).
// References: [Farin 1986], [Farouki & Rajan 1987].
// Why not samples? They miss what lies between; `found` is what they tell.
#include <freiform/core/bounded.hpp>
#include <freiform/query/triangle_joint.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

using Coefficients = std::vector<Bounded>;  // Bernstein coefficients on [0, 1]
using PolyVector = std::array<Coefficients, 3>;

constexpr int kMostPieces = 256;

Bounded choose(int n, int k) {
    const double c = binomial(n, k);
    return {c, c < 0x1p45 ? 0 : c * 0x1p-44};  // beyond, two roundings for each of at most 128 factors
}

Coefficients product(const Coefficients& a, const Coefficients& b) {
    const int m = int(a.size()) - 1, n = int(b.size()) - 1;
    if (m == 0 || n == 0) {
        Coefficients out = m == 0 ? b : a;
        for (Bounded& x : out) x = x * (m == 0 ? a[0] : b[0]);
        return out;
    }
    Coefficients out(std::size_t(m + n + 1));
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j)
            out[std::size_t(i + j)] += choose(m, i) * a[std::size_t(i)] * (choose(n, j) * b[std::size_t(j)]);
    for (int k = 0; k <= m + n; ++k) out[std::size_t(k)] = out[std::size_t(k)] / choose(m + n, k);
    return out;
}
// a - b; degrees are raised where they differ, the sum of all Bernstein polynomials being 1.
Coefficients difference(Coefficients a, Coefficients b) {
    if (a.size() < b.size()) a = product(a, Coefficients(b.size() - a.size() + 1, Bounded(1)));
    if (b.size() < a.size()) b = product(b, Coefficients(a.size() - b.size() + 1, Bounded(1)));
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
}
PolyVector difference(const PolyVector& a, const PolyVector& b) {
    return {difference(a[0], b[0]), difference(a[1], b[1]), difference(a[2], b[2])};
}
PolyVector times(const Coefficients& s, const PolyVector& a) {
    return {product(s, a[0]), product(s, a[1]), product(s, a[2])};
}
PolyVector cross_of(const PolyVector& a, const PolyVector& b) {
    const auto part = [&](std::size_t i, std::size_t j) {
        return difference(product(a[i], b[j]), product(a[j], b[i]));
    };
    return {part(1, 2), part(2, 0), part(0, 1)};
}

// An edge: points X and weights w, and w^2 times the derivatives of the point along the edge and in a
// direction.
struct Side {
    PolyVector x;
    Coefficients w;
    PolyVector along, inward;
};

// n (b_1 - b_0), ..: derivatives of the edge, or with the row beside it.
Coefficients differences(const Coefficients& from, const Coefficients& to, int n, std::size_t shift) {
    Coefficients out;
    for (std::size_t i = 0; i < std::size_t(n); ++i) out.push_back(Bounded(n) * (to[i + shift] - from[i]));
    return out;
}

// The edge from its beginning on, or backwards; the direction is (opposite - start) o + (end - start) e.
template <class P>
Side side_of(const SimplexPatch<2, P>& s, int edge, bool backwards, const Bounded& o, const Bounded& e) {
    const int n = s.degree();
    const auto row = [&](int depth, int coordinate) {
        Coefficients out;
        for (int i = 0; i <= n - depth; ++i) {
            std::array<int, 3> at{};
            at[std::size_t(edge)] = depth;
            at[std::size_t((edge + 1) % 3)] = n - depth - i, at[std::size_t((edge + 2) % 3)] = i;
            out.push_back(s.coefficient(at[1], at[2])[coordinate]);
        }
        if (backwards) std::reverse(out.begin(), out.end());
        return out;
    };
    const auto direction = [&](const Coefficients& own, const Coefficients& beside) {
        Coefficients out = differences(own, beside, n, 0);
        const Coefficients along = differences(own, own, n, 1);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = o * out[i] + e * along[i];
        return out;
    };
    Side out;
    out.w = {Bounded(1)};
    if constexpr (Space<P>::kRational) out.w = row(0, 3);
    for (int c = 0; c < 3; ++c) {
        const auto k = std::size_t(c);
        out.x[k] = row(0, c);
        out.along[k] = differences(out.x[k], out.x[k], n, 1);
        out.inward[k] = direction(out.x[k], row(1, c));
        if constexpr (Space<P>::kRational) {
            out.along[k] =
                difference(product(out.along[k], out.w), product(out.x[k], differences(out.w, out.w, n, 1)));
            out.inward[k] =
                difference(product(out.inward[k], out.w), product(out.x[k], direction(out.w, row(1, 3))));
        }
    }
    return out;
}

double above(const Bounded& b) { return std::abs(b.value) + b.bound; }
double longest(const PolyVector& v) {
    double most = 0;
    for (std::size_t i = 0; i < v[0].size(); ++i)
        most = std::max(most, norm(Vec<3>{{above(v[0][i]), above(v[1][i]), above(v[2][i])}}));
    return most * (1 + 0x1p-48);
}
Vec<3> vector_at(const PolyVector& v, std::size_t i) {
    return {{v[0][i].value, v[1][i].value, v[2][i].value}};
}
// No vector is shorter: not even its part along the middle one. Not positive: nothing is known.
double shortest(const PolyVector& v) {
    const Vec<3> m = unit(vector_at(v, v[0].size() / 2));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < v[0].size(); ++i) {
        const Bounded d = v[0][i] * Bounded(m[0]) + v[1][i] * Bounded(m[1]) + v[2][i] * Bounded(m[2]);
        least = std::min(least, d.value - d.bound);
    }
    return least * (1 - 0x1p-48);  // m is longer than 1 by less than that
}
double smallest(const Coefficients& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Bounded& b : p) least = std::min(least, b.value - b.bound);
    return least;
}

// The halves of polynomials.
void split(const Coefficients& p, Coefficients& low, Coefficients& high) {
    Coefficients b = p;
    high = p;
    low.clear();
    for (std::size_t r = 0; r < p.size(); ++r) {
        low.push_back(b[0]);
        high[p.size() - 1 - r] = b[p.size() - 1 - r];
        for (std::size_t i = 0; i + 1 + r < p.size(); ++i) b[i] = Bounded(0.5) * (b[i] + b[i + 1]);
    }
}

// `rate` gives a bound for a piece, and what was found at its ends.
template <class Rate>
Deviation largest(std::vector<Coefficients> polynomials, Rate&& rate) {
    struct Piece {
        std::vector<Coefficients> p;
        Deviation d;
    };
    std::vector<Piece> pieces{{polynomials, rate(polynomials)}};
    double found = pieces[0].d.found;
    for (;;) {
        const auto worst = std::max_element(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
            return x.d.bound < y.d.bound;
        });
        if (worst->d.bound <= 1.02 * found || int(pieces.size()) >= kMostPieces)
            return {found, worst->d.bound};
        Piece low, high;
        low.p.resize(worst->p.size()), high.p.resize(worst->p.size());
        for (std::size_t i = 0; i < low.p.size(); ++i) split(worst->p[i], low.p[i], high.p[i]);
        low.d = rate(low.p), high.d = rate(high.p);
        found = std::max({found, low.d.found, high.d.found});
        *worst = std::move(low);
        pieces.push_back(std::move(high));
    }
}

// |N| / d
Deviation quotient(const PolyVector& n, const Coefficients& d) {
    return largest({n[0], n[1], n[2], d}, [](const std::vector<Coefficients>& p) {
        const PolyVector v{p[0], p[1], p[2]};
        const double least = smallest(p[3]);
        const std::size_t end = v[0].size() - 1;
        return Deviation{
            std::max(norm(vector_at(v, 0)) / p[3].front().value, norm(vector_at(v, end)) / p[3].back().value),
            least > 0 ? longest(v) / least * (1 + 0x1p-48) : std::numeric_limits<double>::infinity()};
    });
}

Deviation angle_between(const PolyVector& a, const PolyVector& b) {
    const PolyVector c = cross_of(a, b);
    const auto angle_at = [](const PolyVector& x, const PolyVector& y, std::size_t i, std::size_t j) {
        const Vec<3> m = unit(vector_at(x, i)), n = unit(vector_at(y, j));
        return std::atan2(norm(cross(m, n)), dot(m, n));
    };
    const Bounded start = a[0][0] * b[0][0] + a[1][0] * b[1][0] + a[2][0] * b[2][0];
    if (!(start.value > start.bound))
        return {angle_at(a, b, 0, 0), std::numbers::pi};  // beyond 90 degrees, or no normal
    return largest(
        {a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]}, [&](const std::vector<Coefficients>& p) {
            const PolyVector x{p[0], p[1], p[2]}, y{p[3], p[4], p[5]}, z{p[6], p[7], p[8]};
            const double m = shortest(x), n = shortest(y);
            const double sine = m > 0 && n > 0 ? longest(z) / m / n * (1 + 0x1p-48) : 1;
            return Deviation{std::max(angle_at(x, y, 0, 0), angle_at(x, y, x[0].size() - 1, y[0].size() - 1)),
                             sine < 1 ? std::asin(sine) * (1 + 0x1p-48) : std::numbers::pi};
        });
}

Result<void> check_edges(int edge_a, int edge_b, int degree_a, int degree_b) {
    if (edge_a < 0 || edge_a > 2 || edge_b < 0 || edge_b > 2)
        return refuse(RefusalKind::invalid, "edge", text(edge_a, ", ", edge_b, ": edges are 0, 1 or 2"));
    if (degree_a < 1 || degree_b < 1)
        return refuse(RefusalKind::invalid, "degree", "a triangle of degree 0 is a point");
    return {};
}

}  // namespace

template <class P>
requires(Space<P>::kDim == 3) Result<TriangleJoint> triangle_joint(const SimplexPatch<2, P>& a, int edge_a,
                                                                   const SimplexPatch<2, P>& b, int edge_b) {
    if (auto ok = check_edges(edge_a, edge_b, a.degree(), b.degree()); !ok)
        return std::unexpected(ok.error());
    const Side s = side_of(a, edge_a, false, 1, 0), t = side_of(b, edge_b, true, 1, 0);
    return TriangleJoint{quotient(difference(times(t.w, s.x), times(s.w, t.x)), product(s.w, t.w)),
                         angle_between(cross_of(s.along, s.inward), cross_of(t.inward, t.along))};
}

template <class P>
requires(Space<P>::kDim == 3) Result<Deviation> c1_deviation(const SimplexPatch<2, P>& a, int edge_a,
                                                             const SimplexPatch<2, P>& b, int edge_b,
                                                             const Param<2>& apex) {
    if (auto ok = check_edges(edge_a, edge_b, a.degree(), b.degree()); !ok)
        return std::unexpected(ok.error());
    if (!std::isfinite(apex[0]) || !std::isfinite(apex[1]))
        return refuse(RefusalKind::nonfinite, "apex", "is not finite");
    const std::array<Bounded, 3> x{Bounded(1) - apex[0] - apex[1], apex[0], apex[1]};
    const Side s = side_of(a, edge_a, false, x[std::size_t(edge_a)], x[std::size_t((edge_a + 2) % 3)]);
    const Side t = side_of(b, edge_b, true, 1, 0);
    const Coefficients ss = product(s.w, s.w), tt = product(t.w, t.w);
    return quotient(difference(times(tt, s.inward), times(ss, t.inward)), product(ss, tt));
}

#define FF_TRIANGLE_JOINT(P)                                                                                 \
    template Result<TriangleJoint> triangle_joint(const SimplexPatch<2, P>&, int, const SimplexPatch<2, P>&, \
                                                  int);                                                      \
    template Result<Deviation> c1_deviation(const SimplexPatch<2, P>&, int, const SimplexPatch<2, P>&, int,  \
                                            const Param<2>&);
FF_TRIANGLE_JOINT(Vec<3>)
FF_TRIANGLE_JOINT(Hom<3>)
#undef FF_TRIANGLE_JOINT

}  // namespace freiform
