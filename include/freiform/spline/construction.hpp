// The construction of de Casteljau and de Boor with all its intermediate points, for any degree and
// dimension, polynomial and rational.
//
//     b_0                          point (r, i) is level r, place i = 0 .. degree - r:
//          (1,0)
//     b_1         (2,0)            (r, i) = (1 - a) (r - 1, i) + a (r - 1, i + 1)
//          (1,1)         (3,0)     a = (u - t_l) / (t_r - t_l),  t_l = knot(s - p + i + r),  t_r = knot(s + i
//          + 1)
//     b_2         (2,1)
//          (1,2)                   The upper edge (r, 0) are the coefficients of the part left of u, the
//          lower
//     b_3                          edge (p - i, i) those of the part right of it (of a B-spline: of the ends
//     of
//                                  the parts where u became a knot of multiplicity p).
//
// A patch of N parameters has a construction along each, and what one makes of the other's points: point (r,
// i) with r = (r_0, ..), i = (i_0, ..) is r_d steps deep along axis d. Levels (r, 0) and (0, s) of a surface
// are the nets of iso-curves' constructions; (r, r) is r steps of bilinear interpolation, each between four
// neighbours:
//
//     (r, r; i, j) = (1-a) (1-b) (r-1, r-1; i, j)   + a (1-b) (r-1, r-1; i+1, j)
//                  + (1-a) b     (r-1, r-1; i, j+1) + a b     (r-1, r-1; i+1, j+1)
//
// Of equal degrees n, after n of these steps one point is left; of degrees m < n, after m a curve along v.
//
// To draw it: for r = 0 .. degree() connect the points of level(r), each through project(); level(0) is the
// control polygon (net) of the piece, point() lies on the curve (surface).
//   auto triangle = de_casteljau(std::span<const Vec<2>>(b), 0.4);
//   for (int r = 0; r <= triangle->degree(); ++r) draw_polyline(triangle->level(r));
//   auto nets = de_boor(surface, {0.4, 0.7});
//   for (int r = 0; r <= nets->degree(0); ++r) draw_net(nets->level({r, r}));
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/patch.hpp>

namespace freiform {

template <std::size_t N, Coefficient P>
class Construction {
public:
    int degree(int axis = 0) const { return degree_[std::size_t(axis)]; }
    double parameter(int axis = 0) const { return component<N>(u_, std::size_t(axis)); }
    // The coefficient of the curve that point (0, 0) is; the others follow it (of a closed curve modulo
    // size()). Of a patch: its index along `axis`.
    int first(int axis = 0) const { return first_[std::size_t(axis)]; }

    // Level r, of extents degree(d) - r_d + 1; its point i. REQUIRES 0 <= r_d <= degree(d).
    NetView<N, const P> level(const Index<N>& r) const {
        Index<N> from, size;
        for (std::size_t d = 0; d < N; ++d)
            from[d] = start(degree_[d], r[d]), size[d] = degree_[d] - r[d] + 1;
        return points_.view().window(from, size);
    }
    const P& operator()(const Index<N>& r, const Index<N>& i) const { return level(r)(i); }
    // Of a curve.
    std::span<const P> level(int r) const requires(N == 1) {
        return flat().subspan(std::size_t(start(degree_[0], r)), std::size_t(degree_[0] - r) + 1);
    }
    const P& operator()(int r, int i) const requires(N == 1) { return level(r)[std::size_t(i)]; }
    std::span<const P> flat() const { return points_.flat(); }  // of a curve: level after level
    const P& point() const { return points_.flat().back(); }

    // The coefficients of the part below (side 0) or above (side 1) the parameter, along each axis.
    Net<N, P> part(const Index<N>& side) const {
        Index<N> extent;
        for (std::size_t d = 0; d < N; ++d) extent[d] = degree_[d] + 1;
        Net<N, P> net(extent);
        each_index(extent, [&](const Index<N>& at) {
            Index<N> r, i{};
            for (std::size_t d = 0; d < N; ++d) {
                r[d] = side[d] == 0 ? at[d] : degree_[d] - at[d];
                if (side[d] != 0) i[d] = at[d];
            }
            net.view()(at) = (*this)(r, i);
        });
        return net;
    }
    std::vector<P> left() const requires(N == 1) { return flat_of(part({0})); }
    std::vector<P> right() const requires(N == 1) { return flat_of(part({1})); }
    // No (homogeneous) coordinate of any point of the construction is off by more.
    double bound() const { return bound_; }

    // So many points are made at most.
    static constexpr long long kMostPoints = 1 << 22;

    // Of the piece over the spans span[d] of bases[d]; coefficient(i) is the one that the piece sees at place
    // i_d = 0 .. degree(d). Refuses, as "at", parameters that are not finite and results that leave the range
    // of double, and (limit) more than kMostPoints.
    template <class B, class F>
    static Result<Construction> make(const std::array<B, N>& bases, const Index<N>& span, const Param<N>& u,
                                     F&& coefficient) {
        Construction c;
        c.u_ = u;
        Index<N> extent;
        for (std::size_t d = 0; d < N; ++d) {
            if (const double x = component<N>(u, d); !std::isfinite(x))
                return refuse(RefusalKind::nonfinite, "at", text(x, " is not a finite number"));
            c.degree_[d] = bases[d].degree();
            c.first_[d] = span[d] - c.degree_[d];
            extent[d] = start(c.degree_[d], c.degree_[d] + 1);
        }
        if (const long long count = count_of(extent); count < 0 || count > kMostPoints)
            return refuse(RefusalKind::limit, "at", text("more than ", kMostPoints, " intermediate points"));
        c.points_ = Net<N, P>(extent);
        Index<N> given;
        for (std::size_t d = 0; d < N; ++d) given[d] = c.degree_[d] + 1;
        each_index(given, [&](const Index<N>& i) { c.points_.view()(i) = coefficient(i); });
        for (std::size_t d = 0; d < N; ++d) {
            c.go_along(int(d), bases[d], span[d], component<N>(u, d), given);
            given[d] = extent[d];
        }
        if (!std::isfinite(c.bound_))
            return refuse(RefusalKind::ill_conditioned, "at", "the construction leaves the range of double");
        return c;
    }

private:
    Construction() = default;
    static int start(int degree, int r) { return r * (degree + 1) - r * (r - 1) / 2; }
    static std::vector<P> flat_of(const Net<1, P>& net) { return {net.flat().begin(), net.flat().end()}; }

    // All levels along `axis`, of each fibre in `given` whose first degree + 1 points are level 0.
    template <class B>
    void go_along(int axis, const B& basis, int span, double u, const Index<N>& given) {
        const int p = degree(axis);
        for (int r = 1; r <= p; ++r) {
            double stretch = 1, size = 0;
            const int from = start(p, r - 1), to = start(p, r);
            bool finite = true;
            for (int i = 0; i <= p - r; ++i) {
                const double tl = basis.knot(span - p + i + r), tr = basis.knot(span + i + 1),
                             width = tr - tl;
                const double keep = (tr - u) / width, move = (u - tl) / width;
                stretch = std::max(stretch, std::abs(keep) + std::abs(move));
                each_fibre(axis, given, [&](const Index<N>& at) {
                    const Fibre<P> f = points_.view().fibre(axis, at);
                    const P &a = f[from + i], &b = f[from + i + 1];
                    size = std::max({size, max_abs(a), max_abs(b)});
                    f[to + i] = keep * a + move * b;
                    finite = finite && is_finite(f[to + i]);
                });
            }
            grow_bound(finite ? size : std::numeric_limits<double>::infinity(), stretch);
        }
    }

    // Exact points x = y + e, |e| <= E, become a x_1 + b x_2; computed is a (1 + d) y_1 + b (1 + d) y_2 with
    // |d| within 5 roundings: two differences, a quotient, a product, a sum. So E grows to s (E + 5 u |y|)
    // with s = |a| + |b| >= 1. Eight roundings instead of five pay for those of s and of this line and for
    // coefficients a, b that underflow; the last term pays for products that do.
    void grow_bound(double size, double stretch) {
        bound_ = stretch * (bound_ + 8 * kUnitRoundoff * size) * (1 + 8 * kUnitRoundoff) +
                 8 * std::numeric_limits<double>::denorm_min();
    }

    Index<N> degree_{}, first_{};
    Param<N> u_{};
    double bound_ = 0;
    // Along each axis: the points of level 0, then those of level 1, ..
    Net<N, P> points_;
};

// de Casteljau: of the Bezier patch on [0, 1] (^N) with these coefficients. Parameters may be any finite
// numbers; outside [0, 1] the points are extrapolated. Refuses no or too many coefficients, and what is not
// finite.
template <std::size_t N, Coefficient P>
Result<Construction<N, P>> de_casteljau(const Net<N, P>& b, const Param<N>& u) {
    std::vector<Bernstein> bases;
    Index<N> span{};
    for (std::size_t d = 0; d < N; ++d) {
        auto basis = Bernstein::make(std::min(b.extent()[d], 1000) - 1);
        if (!basis) return std::unexpected(basis.error());
        span[d] = basis->degree();
        bases.push_back(*basis);
    }
    for (std::size_t i = 0; i < b.flat().size(); ++i)
        if (!is_finite(b.flat()[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "a coordinate is not finite");
    return [&]<std::size_t... D>(std::index_sequence<D...>) {
        return Construction<N, P>::make(std::array{bases[D]...}, span, u,
                                        [&](const Index<N>& i) { return b.view()(i); });
    }
    (std::make_index_sequence<N>{});
}
template <Coefficient P>
Result<Construction<1, P>> de_casteljau(std::span<const P> b, double t) {
    const Index<1> extent{int(std::min<std::size_t>(b.size(), 1000))};
    return de_casteljau(Net<1, P>(extent, {b.begin(), b.begin() + extent[0]}), t);
}

// The same of a patch at u: de Boor's construction in the piece where u lies (of a Bezier patch: de
// Casteljau's). Open ones outside their domain: the first or last piece is continued.
template <std::size_t N, Coefficient P, Basis B>
Result<Construction<N, P>> de_boor(const Patch<N, P, B>& patch, const Param<N>& u) {
    std::array<double, N> inside;
    Index<N> span;
    for (std::size_t d = 0; d < N; ++d) {
        const B& basis = patch.bases()[d];
        inside[d] = component<N>(u, d);
        const bool is_number = std::isfinite(inside[d]);
        if (is_number) inside[d] = basis.wrap(inside[d]);
        span[d] = is_number ? basis.span(inside[d]) : basis.degree();
    }
    Param<N> at;
    if constexpr (N == 1)
        at = inside[0];
    else
        at = inside;
    return Construction<N, P>::make(patch.bases(), span, at, [&](Index<N> i) {
        for (std::size_t d = 0; d < N; ++d) {
            const B& basis = patch.bases()[d];
            i[d] = (span[d] - basis.degree() + i[d]) % basis.size();
        }
        return patch.net().view()(i);
    });
}

}  // namespace freiform
