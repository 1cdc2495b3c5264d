// The rows next to an edge, in numbers of 106 bits.
//
// Idea, notation and references: surface_joint.cpp. Every coefficient of a row is a blossom of the polynomial
// on one of the spans that it depends on, the one nearest the middle.
#include "joint_rows_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

using DD = DoubleDouble;
using Poly = Form<DD>;

// A shape function on [x, y], parts of [0, 1].
Poly on_piece(const ShapeFunction& f, DD x, DD y) {
    if (is_zero(f)) return {};
    std::vector<DD> c(f.begin(), f.end());
    const auto steps = [&](DD t, bool left) {
        for (std::size_t r = 1; r < c.size(); ++r)
            if (left)
                for (std::size_t i = c.size() - 1; i >= r; --i) c[i] = (DD(1) - t) * c[i - 1] + t * c[i];
            else
                for (std::size_t i = 0; i + r < c.size(); ++i) c[i] = (DD(1) - t) * c[i] + t * c[i + 1];
    };
    steps(y, true);
    steps(x / y, false);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] *= DD(binomial(int(c.size()) - 1, int(i)));
    return {std::move(c)};
}

// Power series in u whose coefficients are polynomials of t.
using PolySeries = std::vector<Poly>;
PolySeries product(const PolySeries& a, const PolySeries& b) {
    PolySeries c(a.size());
    for (std::size_t m = 0; m < c.size(); ++m)
        for (std::size_t i = 0; i <= m; ++i) c[m] = c[m] + a[i] * b[m - i];
    return c;
}
Poly times(DD factor, Poly f) {
    for (DD& x : f.s) x *= factor;
    return f;
}

// c_0 .. c_k of the neighbour on one piece: [order][coordinate], Bernstein coefficients of degree Q.
std::vector<std::vector<std::vector<DD>>> continued(const EdgePieces& all, std::size_t piece,
                                                    const ShapeFunctions& shape, int degree) {
    const std::size_t k = shape.across.size();
    const DD lo(all.breaks.front()), whole = DD(all.breaks.back()) - lo;
    const DD from = (DD(all.breaks[piece]) - lo) / whole, to = (DD(all.breaks[piece + 1]) - lo) / whole,
             length = DD(all.breaks[piece + 1]) - DD(all.breaks[piece]);
    const auto series = [&](const std::vector<ShapeFunction>& f, Poly first) {
        PolySeries s(k + 1);
        s[0] = std::move(first);
        DD factorial(1);
        for (std::size_t m = 1; m <= std::min(k, f.size()); ++m) {
            factorial *= DD(double(m));
            s[m] = times(DD(1) / factorial, on_piece(f[m - 1], from, to));
        }
        return s;
    };
    const Poly one{{DD(1)}};
    const PolySeries a = series(shape.across, {}), b = series(shape.along, {}), g = series(shape.scale, one);
    std::vector<PolySeries> out(std::size_t(all.coordinates), PolySeries(k + 1));
    PolySeries power_a = series({}, one);  // a^i / i!
    for (std::size_t i = 0; i <= k; ++i) {
        PolySeries power = power_a;  // a^i b^j / (i! j!)
        std::vector<Poly> d = all.d[piece][i];
        for (std::size_t j = 0; i + j <= k; ++j) {
            for (std::size_t c = 0; c < out.size(); ++c)
                for (std::size_t m = 0; m <= k; ++m) out[c][m] = out[c][m] + power[m] * d[c];
            power = product(power, b);
            for (Poly& f : power) f = times(DD(1) / DD(double(j + 1)), f);
            for (Poly& f : d) f = times(DD(1) / length, derivative(f));
        }
        power_a = product(power_a, a);
        for (Poly& f : power_a) f = times(DD(1) / DD(double(i + 1)), f);
    }
    std::vector<std::vector<std::vector<DD>>> c(k + 1);
    for (std::size_t m = 0; m <= k; ++m)
        for (PolySeries& x : out) {
            if (m == 0) x = product(x, g);
            Poly f = x[m].is_zero() ? Poly{{DD(0)}} : x[m];
            f = elevated(std::move(f), degree);
            for (std::size_t i = 0; i < f.s.size(); ++i) f.s[i] = f.s[i] / DD(binomial(degree, int(i)));
            c[m].push_back(std::move(f.s));
        }
    return c;
}

}  // namespace

bool is_zero(const ShapeFunction& f) {
    return std::ranges::all_of(f, [](double x) { return x == 0; });
}

template <class P>
EdgePieces edge_pieces(const Surface<P>& s, SurfaceEdge edge, int k) {
    const BSplineBasis &across = s.basis(edge.axis), &along = s.basis(1 - edge.axis);
    const double at = edge.end == End::end ? across.domain().hi : across.domain().lo;
    const int p = across.degree(), q = along.degree(), span = across.span(at);
    EdgePieces out;
    out.breaks = along.breaks();
    out.coordinates = P::kCoords;
    // rows[order][column][coordinate]
    std::vector<std::vector<std::array<DD, P::kCoords>>> rows(
        std::size_t(k) + 1, std::vector<std::array<DD, P::kCoords>>(std::size_t(along.size())));
    std::vector<DD> w(std::size_t(p) + 1);
    for (int m = 0; m <= std::min(k, p); ++m) {
        weights_in_span(across, span, DD(at), m, w.data());
        const DD sign = edge.end == End::start && m % 2 == 1 ? -1 : 1;
        for (int j = 0; j < along.size(); ++j)
            for (int i = 0; i <= p; ++i) {
                const P& b =
                    s.net().view()(edge.axis == 0 ? Index<2>{span - p + i, j} : Index<2>{j, span - p + i});
                for (int c = 0; c < P::kCoords; ++c)
                    rows[std::size_t(m)][std::size_t(j)][std::size_t(c)] +=
                        sign * w[std::size_t(i)] * DD(b[c]);
            }
    }
    std::vector<DD> args(static_cast<std::size_t>(q)), v(std::size_t(q) + 1);
    for (std::size_t i = 0; i + 1 < out.breaks.size(); ++i) {
        std::vector<std::vector<Poly>> d(
            std::size_t(k) + 1, std::vector<Poly>(P::kCoords, Poly{std::vector<DD>(std::size_t(q) + 1)}));
        const int t = along.span(out.breaks[i]);
        for (int b = 0; b <= q; ++b) {
            for (int r = 0; r < q; ++r) args[std::size_t(r)] = out.breaks[i + (r >= q - b)];
            blossom(along, t, args.data(), v.data());
            for (std::size_t m = 0; m < d.size(); ++m)
                for (int c = 0; c < P::kCoords; ++c) {
                    DD& x = d[m][std::size_t(c)].s[std::size_t(b)];
                    for (int r = 0; r <= q; ++r)
                        x += v[std::size_t(r)] *
                             rows[m][std::size_t((t - q + r) % along.size())][std::size_t(c)];
                    x *= DD(binomial(q, b));
                }
        }
        out.d.push_back(std::move(d));
    }
    return out;
}

std::vector<DD> knots_after(const BSplineBasis& basis, End end, int count) {
    const int p = basis.degree(), last = int(basis.knots().size()) - 1;
    const double at = end == End::start ? basis.knot(0) : basis.knot(last);
    std::vector<DD> x;
    if (basis.is_closed() || at != (end == End::start ? basis.knot(p) : basis.knot(last - p))) return x;
    for (int i = 1; i <= count; ++i)
        x.push_back(end == End::start ? DD(basis.knot(p + i)) - DD(at)
                                      : DD(at) - DD(basis.knot(last - p - i)));
    return x;
}

template <class P>
Result<void> fill_rows(const EdgePieces& previous, const ShapeFunctions& shape, const RowTarget& target,
                       Net<2, P>& net) {
    const auto& [edge, along, n, after, against] = target;
    const int k = int(shape.across.size()), q = along.degree();
    std::vector<std::vector<std::vector<std::vector<DD>>>> pieces;
    for (std::size_t i = 0; i + 1 < previous.breaks.size(); ++i)
        pieces.push_back(continued(previous, i, shape, q));
    const DD lo(previous.breaks.front()), whole = DD(previous.breaks.back()) - lo;
    const Interval on = along.domain();
    const DD width = DD(on.hi) - DD(on.lo);
    // A parameter of the neighbour as one of the surface.
    const auto there = [&](double t) {
        return lo + whole * ((against ? DD(on.hi) - DD(t) : DD(t) - DD(on.lo)) / width);
    };
    for (int j = 0; j < along.size(); ++j) {
        int span = j + q / 2;  // a span that is not empty, near the middle of the support
        for (int away = 0; !(along.knot(span) < along.knot(span + 1) && span >= q && span < along.size());
             ++away)
            span = std::clamp(j + q / 2 + (away % 2 ? away / 2 + 1 : -(away / 2)), j, j + q);
        const double middle =
            there(along.knot(span) + (along.knot(span + 1) - along.knot(span)) / 2).rounded();
        const auto above = std::ranges::upper_bound(previous.breaks, middle);
        const std::size_t piece = std::clamp<std::size_t>(std::size_t(above - previous.breaks.begin()), 1,
                                                          previous.breaks.size() - 1) -
                                  1;
        const DD from(previous.breaks[piece]), length = DD(previous.breaks[piece + 1]) - from;
        std::vector<std::vector<DD>> c(std::size_t(k) + 1, std::vector<DD>(P::kCoords));
        for (int m = 0; m <= k; ++m)
            for (int x = 0; x < P::kCoords; ++x) {
                std::vector<DD> b = pieces[piece][std::size_t(m)][std::size_t(x)];
                for (int r = 1; r <= q; ++r) {
                    const DD t = (there(along.knot(j + r)) - from) / length;
                    for (int i = 0; i + r <= q; ++i)
                        b[std::size_t(i)] = (DD(1) - t) * b[std::size_t(i)] + t * b[std::size_t(i) + 1];
                }
                c[std::size_t(m)][std::size_t(x)] = b[0];
            }
        std::vector<DD> e(std::size_t(k) + 1, DD(0));  // elementary symmetric functions of x_1 .. x_i
        e[0] = 1;
        for (int i = 0; i <= k; ++i) {
            for (int m = i; m > 0; --m)
                e[std::size_t(m)] += e[std::size_t(m - 1)] * after[std::size_t(i - 1)];
            const int row = edge.end == End::start ? i : net.extent()[std::size_t(edge.axis)] - 1 - i;
            P& b = net.view()(edge.axis == 0 ? Index<2>{row, j} : Index<2>{j, row});
            for (int x = 0; x < P::kCoords; ++x) {
                DD sum(0);
                for (int m = 0; m <= i; ++m)
                    sum += c[std::size_t(m)][std::size_t(x)] * e[std::size_t(m)] / DD(binomial(n, m));
                b[x] = sum.rounded();
            }
            if (!is_finite(b))
                return refuse(RefusalKind::ill_conditioned, text("row ", i), "leaves the range of double");
            if (!(Space<P>::weight(b) > 0))
                return refuse(RefusalKind::no_answer, text("row ", i, ", column ", j),
                              text("would have the weight ", Space<P>::weight(b),
                                   ", which is not positive; give `scale`, or take a shorter interval"));
        }
    }
    return {};
}

#define FF_INSTANTIATE_ROWS(P)                                            \
    template EdgePieces edge_pieces(const Surface<P>&, SurfaceEdge, int); \
    template Result<void> fill_rows(const EdgePieces&, const ShapeFunctions&, const RowTarget&, Net<2, P>&);
FF_INSTANTIATE_ROWS(Vec<3>)
FF_INSTANTIATE_ROWS(Hom<3>)
#undef FF_INSTANTIATE_ROWS

}  // namespace freiform::detail
