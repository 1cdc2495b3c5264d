// Coons patches.
//
// Idea: a Boolean sum (boolean_sum.hpp) with the functions 1 - v, v, or the four cubic Hermite functions. In
// both cases row k of T is what the functionals "value (and derivative) at the ends" give for curve k.
//
// Method: curves of one direction get one basis, which also holds the functions of that direction: degree 1
// or 3 at least. Elements of T are means of what the two curves say; with differences d of positions the
// boundary v = 0 is u0 + (1-u) d00 / 2 + u d10 / 2, which is nearer to u0 than half of the largest gap.
//
// Accuracy: Bounded throughout. Where all corners agree to the bit and the curves were not changed by their
// common basis, the outer rows of the net are theirs and replace those that were computed; the exact patch
// has them, too, so its bound still holds.
//
// Rational bicubic patches: the derivatives are over one denominator with the boundaries, and their values at
// ends by the quotient rule. Three times the Hermite functions of derivatives have whole Bernstein
// coefficients, so a third goes to the derivatives.
//
// References: [Coons 1967], [Farin 2002, ch. 22].
//
// Why not twists that are made compatible (rational ones, by Gregory)? Such a surface is no spline.
#include <freiform/make/boolean_sum.hpp>
#include <freiform/make/coons.hpp>
#include <freiform/spline/compatible.hpp>

#include <algorithm>
#include <array>

namespace freiform {

namespace {

using Row = std::vector<BoundedVec<3>>;

constexpr const char* kCorner[2][2] = {{"lower u, lower v", "lower u, upper v"},
                                       {"upper u, lower v", "upper u, upper v"}};

// Curves of one direction on one basis, and which of their ends are known to be exact.
struct Direction {
    Compatible<Vec<3>> same;
    std::vector<std::array<bool, 2>> exact;

    const BSplineBasis& basis() const { return same.curves[0].basis(); }
    bool unchanged() const { return same.relative[0] == 0 && same.relative[1] == 0; }
    Row row(std::size_t k) const {
        const auto net = same.curves[k].net().flat();
        double largest = 0;
        for (const Vec<3>& p : net) largest = std::max(largest, max_abs(p));
        Row out;
        for (std::size_t i = 0; i < net.size(); ++i) {
            const bool sure = (i == 0 && exact[k][0]) || (i + 1 == net.size() && exact[k][1]);
            const double e = sure ? 0 : same.relative[k] * largest * (1 + 0x1p-40);
            out.push_back({Bounded(net[i][0], e), {net[i][1], e}, {net[i][2], e}});
        }
        return out;
    }
};

// Curves of one direction on one basis of at least `degree`, in space.
template <int D>
Result<Direction> in_one_basis(std::initializer_list<const Curve<Vec<D>>*> curves, int degree) {
    std::vector<Curve<Vec<3>>> all;
    for (const auto* c : curves) {
        if (c->basis().degree() < 1)
            return refuse(RefusalKind::unsupported, "degree", "a boundary of degree 0 joins nothing");
        auto open = restrict_to(in_space(*c), 0, c->domain()[0]);
        if (!open) return std::unexpected(open.error());
        all.push_back(c->basis().is_closed() ? std::move(*open) : in_space(*c));
    }
    // Something of the degree that the blending functions have.
    const Interval on = all[0].domain()[0];
    const auto basis = BSplineBasis::bezier(degree, on);
    if (!basis) return std::unexpected(basis.error());
    all.push_back(Curve<Vec<3>>::trusted({*basis}, Net<1, Vec<3>>({degree + 1})));
    auto same = compatible(std::span<const Curve<Vec<3>>>(all));
    if (!same) return std::unexpected(same.error());
    // The end of a clamped curve is its last control point, in every basis.
    Direction out{std::move(*same), {}};
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
        const auto was = all[k].net().flat(), is = out.same.curves[k].net().flat();
        const BSplineBasis& b = all[k].basis();
        out.exact.push_back({b.multiplicity(b.domain().lo) > b.degree() && was.front() == is.front(),
                             b.multiplicity(b.domain().hi) > b.degree() && was.back() == is.back()});
    }
    out.same.curves.pop_back();
    out.same.relative.pop_back();
    return out;
}

BoundedVec<3> mean(const BoundedVec<3>& a, const BoundedVec<3>& b) {
    BoundedVec<3> m;
    for (std::size_t i = 0; i < 3; ++i) m[i] = a[i] == b[i] ? a[i] : Bounded(0.5) * (a[i] + b[i]);
    return m;
}
double gap(const BoundedVec<3>& a, const BoundedVec<3>& b) {
    Vec<3> d;
    for (int i = 0; i < 3; ++i) {
        const Bounded x = a[std::size_t(i)] - b[std::size_t(i)];
        d[i] = std::abs(x.value) + x.bound;
    }
    return norm(d) * (1 + 0x1p-48);
}

Bounded length(const BSplineBasis& b) { return Bounded(b.domain().hi) - Bounded(b.domain().lo); }

// The derivative at an end, by a parameter that runs from 0 to 1 over the domain.
BoundedVec<3> end_derivative(const BSplineBasis& b, const Row& row, int end) {
    const int p = b.degree(), n = b.size(), i = end == 0 ? 0 : n - 2;
    const Bounded span = Bounded(b.knot(i + 1 + p)) - Bounded(b.knot(i + 1)),
                  f = Bounded(p) * length(b) / span;
    BoundedVec<3> d;
    for (std::size_t c = 0; c < 3; ++c) d[c] = f * (row[std::size_t(i) + 1][c] - row[std::size_t(i)][c]);
    return d;
}

Result<void> check_gap(const char* what, double found, double allowed, int i, int j) {
    if (found <= allowed) return {};
    return refuse(RefusalKind::invalid, kCorner[i][j],
                  text(what, " differ by ", found, ", more than the tolerance ", allowed));
}

// The same where both are rounded: what rounding explains is granted. Both are to be divided by `scale`.
Result<void> check_gap(const char* what, const BoundedVec<3>& a, const BoundedVec<3>& b, double scale,
                       double allowed, int i, int j) {
    Vec<3> apart, rounding;
    for (std::size_t c = 0; c < 3; ++c)
        apart[int(c)] = a[c].value - b[c].value, rounding[int(c)] = a[c].bound + b[c].bound;
    if (norm(apart) - 2 * norm(rounding) <= allowed * scale) return {};
    return check_gap(what, norm(apart) / scale, allowed, i, j);
}

// The outer rows of the net become those of the boundaries.
void set_boundaries(Surface<Vec<3>>& s, const Direction& u, const Direction& v) {
    const auto net = s.net().view();
    Net<2, Vec<3>> out = s.net();
    const int n = net.extent[0], m = net.extent[1];
    for (int i = 0; i < n; ++i)
        for (int side = 0; side < 2; ++side)
            out.view()({i, side * (m - 1)}) = u.same.curves[std::size_t(side)].net().flat()[std::size_t(i)];
    for (int j = 0; j < m; ++j)
        for (int side = 0; side < 2; ++side)
            out.view()({side * (n - 1), j}) = v.same.curves[std::size_t(side)].net().flat()[std::size_t(j)];
    s = Surface<Vec<3>>::trusted(s.bases(), std::move(out));
}

// h_0 = 1 - 3 x^2 + 2 x^3, h_1 = 3 x^2 - 2 x^3, h_2 = x - 2 x^2 + x^3, h_3 = x^3 - x^2.
std::vector<std::vector<Bounded>> hermite_functions(const BSplineBasis& basis) {
    const auto x = powers_on(basis, 3);
    std::vector<std::vector<Bounded>> h(4);
    for (std::size_t i = 0; i < x[0].size(); ++i) {
        const Bounded smooth = Bounded(3) * x[2][i] - Bounded(2) * x[3][i];
        h[0].push_back(x[0][i] - smooth);
        h[1].push_back(smooth);
        h[2].push_back(x[1][i] - Bounded(2) * x[2][i] + x[3][i]);
        h[3].push_back(x[3][i] - x[2][i]);
    }
    return h;
}

Row times(const Bounded& s, Row r) {
    for (auto& x : r)
        for (Bounded& c : x) c = s * c;
    return r;
}

// Rational curves of one direction, and functions of its parameter given by Bernstein coefficients.
template <int D>
Result<OverOne> over_one(std::initializer_list<const Curve<Hom<D>>*> curves,
                         const std::vector<std::vector<double>>& functions) {
    std::vector<Curve<Hom<3>>> all;
    for (const auto* c : curves) {
        if (c->basis().degree() < 1)
            return refuse(RefusalKind::unsupported, "degree", "a boundary of degree 0 joins nothing");
        all.push_back(in_space(*c));
    }
    std::vector<Curve<Vec<1>>> blends;
    for (const auto& f : functions) {
        const auto basis = BSplineBasis::bezier(int(f.size()) - 1, all[0].domain()[0]);
        if (!basis) return std::unexpected(basis.error());
        Net<1, Vec<1>> net({int(f.size())});
        for (std::size_t i = 0; i < f.size(); ++i) net.flat()[i][0] = f[i];
        blends.push_back(Curve<Vec<1>>::trusted({*basis}, std::move(net)));
    }
    return over_one_denominator(all, blends);
}

BoundedVec<3> end_value(const OverOne& o, std::size_t curve, int side) {
    BoundedVec<3> p = side == 0 ? o.curves[curve].front() : o.curves[curve].back();
    for (Bounded& x : p) x /= side == 0 ? o.denominator.front() : o.denominator.back();
    return p;
}
// (a / w)' = (a' - (a / w) w') / w.
BoundedVec<3> end_derivative(const OverOne& o, std::size_t curve, int side) {
    Row weights;
    for (const Bounded& w : o.denominator) weights.push_back({w, w, w});
    BoundedVec<3> d = end_derivative(o.basis, o.curves[curve], side);
    const BoundedVec<3> p = end_value(o, curve, side), slope = end_derivative(o.basis, weights, side);
    for (std::size_t c = 0; c < 3; ++c)
        d[c] = (d[c] - p[c] * slope[c]) / (side == 0 ? o.denominator.front() : o.denominator.back());
    return d;
}

// What the functionals "value at the lower, upper end, derivative at the lower, upper end" give for curve k.
using Ends = std::array<std::array<BoundedVec<3>, 4>, 4>;
template <class Value, class Derivative>
Ends ends_of(Value&& value, Derivative&& derivative) {
    Ends e;
    for (std::size_t k = 0; k < 4; ++k)
        for (int side = 0; side < 2; ++side) {
            e[k][std::size_t(side)] = value(k, side);
            e[k][std::size_t(side) + 2] = derivative(k, side);
        }
    return e;
}

// T of the essay, and by how much positions, tangents and twists disagree.
struct Corners {
    std::vector<Row> T = std::vector<Row>(4, Row(4));
    std::array<double, 3> gap{};

    template <class Q>
    Result<CoonsPatch<Q>> patch(Result<MadeSurface<Q>> made) const {
        if (!made) return std::unexpected(made.error());
        return CoonsPatch<Q>{std::move(made->surface), made->bound, gap[0], gap[1], gap[2]};
    }
};

// Curves and functionals with an index from 2 on are derivatives by a parameter from 0 to `across_u` or
// `across_v`.
Result<Corners> corners(const Ends& u, const Ends& v, double across_u, double across_v,
                        const CoonsTolerance& tolerance) {
    constexpr const char* kWhat[] = {"positions", "tangents", "twists"};
    const double allowed[] = {tolerance.distance, tolerance.tangent, tolerance.twist};
    Corners out;
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < 4; ++l) {
            const BoundedVec<3>&p = u[k][l], &q = v[l][k];
            const std::size_t order = std::size_t(k >= 2) + std::size_t(l >= 2);
            const double scale = (l >= 2 ? across_u : 1) * (k >= 2 ? across_v : 1);
            if (auto ok = check_gap(kWhat[order], p, q, scale, allowed[order], int(l % 2), int(k % 2)); !ok)
                return std::unexpected(ok.error());
            out.gap[order] = std::max(out.gap[order], gap(p, q) / scale * (1 + 0x1p-48));
            out.T[k][l] = mean(p, q);
        }
    return out;
}

Result<void> check_tolerance(const CoonsTolerance& t) {
    if (t.distance >= 0 && t.tangent >= 0 && t.twist >= 0) return {};
    return refuse(RefusalKind::invalid, "tolerance", "is not a positive number");
}

}  // namespace

template <int D>
Result<CoonsPatch<Vec<3>>> coons(const Curve<Vec<D>>& u0, const Curve<Vec<D>>& u1, const Curve<Vec<D>>& v0,
                                 const Curve<Vec<D>>& v1, double tolerance) {
    const auto u = in_one_basis<D>({&u0, &u1}, 1), v = in_one_basis<D>({&v0, &v1}, 1);
    if (!u) return refuse_within("u0, u1", u.error());
    if (!v) return refuse_within("v0, v1", v.error());
    if (!(tolerance >= 0)) return refuse(RefusalKind::invalid, "tolerance", "is not a distance");
    BlendedFamily a{u->basis(), {}, {}}, b{v->basis(), {}, {}};
    for (std::size_t k = 0; k < 2; ++k) {
        a.curves.push_back(u->row(k));
        b.curves.push_back(v->row(k));
    }
    for (auto* f : {&a, &b}) {
        const auto x = powers_on(f == &a ? b.basis : a.basis, 1);
        f->functions = {x[0], x[1]};
        for (std::size_t i = 0; i < x[0].size(); ++i) f->functions[0][i] -= x[1][i];
    }
    std::vector<std::vector<BoundedVec<3>>> T(2, std::vector<BoundedVec<3>>(2));
    double most = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const auto &row = a.curves[std::size_t(j)], &column = b.curves[std::size_t(i)];
            const auto &p = i == 0 ? row.front() : row.back(), &q = j == 0 ? column.front() : column.back();
            const double g = gap(p, q);
            if (auto ok = check_gap("positions", g, tolerance, i, j); !ok) return std::unexpected(ok.error());
            most = std::max(most, g);
            T[std::size_t(j)][std::size_t(i)] = mean(p, q);
        }
    auto made = boolean_sum(a, b, T);
    if (!made) return std::unexpected(made.error());
    if (most == 0 && u->unchanged() && v->unchanged()) set_boundaries(made->surface, *u, *v);
    return CoonsPatch<Vec<3>>{std::move(made->surface), made->bound, most, 0, 0};
}

template <int D>
Result<CoonsPatch<Hom<3>>> coons(const Curve<Hom<D>>& u0, const Curve<Hom<D>>& u1, const Curve<Hom<D>>& v0,
                                 const Curve<Hom<D>>& v1, double tolerance) {
    if (!(tolerance >= 0)) return refuse(RefusalKind::invalid, "tolerance", "is not a distance");
    const auto u = over_one<D>({&u0, &u1}, {{1, 0}, {0, 1}}), v = over_one<D>({&v0, &v1}, {{1, 0}, {0, 1}});
    if (!u) return refuse_within("u0, u1", u.error());
    if (!v) return refuse_within("v0, v1", v.error());
    std::vector<std::vector<BoundedVec<3>>> T(2, std::vector<BoundedVec<3>>(2));
    double most = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const auto p = end_value(*u, std::size_t(j), i), q = end_value(*v, std::size_t(i), j);
            if (auto ok = check_gap("positions", p, q, 1, tolerance, i, j); !ok)
                return std::unexpected(ok.error());
            most = std::max(most, gap(p, q));
            T[std::size_t(j)][std::size_t(i)] = mean(p, q);
        }
    auto made = boolean_sum(*u, *v, T);
    if (!made) return std::unexpected(made.error());
    return CoonsPatch<Hom<3>>{std::move(made->surface), made->bound, most, 0, 0};
}

template <int D>
Result<CoonsPatch<Vec<3>>> coons_bicubic(const CoonsEdge<Vec<D>>& u0, const CoonsEdge<Vec<D>>& u1,
                                         const CoonsEdge<Vec<D>>& v0, const CoonsEdge<Vec<D>>& v1,
                                         const CoonsTolerance& tolerance) {
    const auto u = in_one_basis<D>({&u0.curve, &u1.curve, &u0.across, &u1.across}, 3);
    const auto v = in_one_basis<D>({&v0.curve, &v1.curve, &v0.across, &v1.across}, 3);
    if (!u) return refuse_within("u0, u1", u.error());
    if (!v) return refuse_within("v0, v1", v.error());
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    BlendedFamily a{u->basis(), {}, {}}, b{v->basis(), {}, {}};
    // Derivatives by parameters from 0 to 1: across u-edges that is v.
    const Bounded in_u = length(a.basis), in_v = length(b.basis);
    for (std::size_t k = 0; k < 4; ++k) {
        const Row p = u->row(k), q = v->row(k);
        a.curves.push_back(k < 2 ? p : times(in_v, p));
        b.curves.push_back(k < 2 ? q : times(in_u, q));
    }
    a.functions = hermite_functions(b.basis);
    b.functions = hermite_functions(a.basis);
    const auto ends = [](const BlendedFamily& f) {
        return ends_of(
            [&](std::size_t k, int side) { return side == 0 ? f.curves[k].front() : f.curves[k].back(); },
            [&](std::size_t k, int side) { return end_derivative(f.basis, f.curves[k], side); });
    };
    const auto at = corners(ends(a), ends(b), in_u.value, in_v.value, tolerance);
    if (!at) return std::unexpected(at.error());
    return at->patch(boolean_sum(a, b, at->T));
}

template <int D>
Result<CoonsPatch<Hom<3>>> coons_bicubic(const CoonsEdge<Hom<D>>& u0, const CoonsEdge<Hom<D>>& u1,
                                         const CoonsEdge<Hom<D>>& v0, const CoonsEdge<Hom<D>>& v1,
                                         const CoonsTolerance& tolerance) {
    if (auto ok = check_tolerance(tolerance); !ok) return std::unexpected(ok.error());
    const std::vector<std::vector<double>> hermite{{1, 1, 0, 0}, {0, 0, 1, 1}, {0, 1, 0, 0}, {0, 0, -1, 0}};
    auto u = over_one<D>({&u0.curve, &u1.curve, &u0.across, &u1.across}, hermite);
    auto v = over_one<D>({&v0.curve, &v1.curve, &v0.across, &v1.across}, hermite);
    if (!u) return refuse_within("u0, u1", u.error());
    if (!v) return refuse_within("v0, v1", v.error());
    // Derivatives by parameters from 0 to 3, as the functions ask for.
    const Bounded third = Bounded(1) / Bounded(3), in_u = third * length(u->basis),
                  in_v = third * length(v->basis);
    for (std::size_t k = 2; k < 4; ++k) {
        u->curves[k] = times(in_v, std::move(u->curves[k]));
        v->curves[k] = times(in_u, std::move(v->curves[k]));
    }
    const auto ends = [&](const OverOne& o) {
        return ends_of([&](std::size_t k, int side) { return end_value(o, k, side); },
                       [&](std::size_t k, int side) {
                           BoundedVec<3> d = end_derivative(o, k, side);
                           for (Bounded& x : d) x = third * x;
                           return d;
                       });
    };
    const auto at = corners(ends(*u), ends(*v), in_u.value, in_v.value, tolerance);
    if (!at) return std::unexpected(at.error());
    return at->patch(boolean_sum(*u, *v, at->T));
}

#define FF_COONS(D)                                                                                       \
    template Result<CoonsPatch<Vec<3>>> coons(const Curve<Vec<D>>&, const Curve<Vec<D>>&,                 \
                                              const Curve<Vec<D>>&, const Curve<Vec<D>>&, double);        \
    template Result<CoonsPatch<Hom<3>>> coons(const Curve<Hom<D>>&, const Curve<Hom<D>>&,                 \
                                              const Curve<Hom<D>>&, const Curve<Hom<D>>&, double);        \
    template Result<CoonsPatch<Vec<3>>> coons_bicubic(const CoonsEdge<Vec<D>>&, const CoonsEdge<Vec<D>>&, \
                                                      const CoonsEdge<Vec<D>>&, const CoonsEdge<Vec<D>>&, \
                                                      const CoonsTolerance&);                             \
    template Result<CoonsPatch<Hom<3>>> coons_bicubic(const CoonsEdge<Hom<D>>&, const CoonsEdge<Hom<D>>&, \
                                                      const CoonsEdge<Hom<D>>&, const CoonsEdge<Hom<D>>&, \
                                                      const CoonsTolerance&);
FF_COONS(2)
FF_COONS(3)
#undef FF_COONS

}  // namespace freiform
