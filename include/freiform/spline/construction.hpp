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
// To draw it: for r = 0 .. degree() connect the points of level(r), each through project(); level(0) is the
// control polygon of the piece, point() lies on the curve.
//   auto triangle = de_casteljau(std::span<const Vec<2>>(b), 0.4);
//   for (int r = 0; r <= triangle->degree(); ++r) draw_polyline(triangle->level(r));
#pragma once
#include <freiform/spline/patch.hpp>

namespace freiform {

template <Coefficient P>
class Construction {
public:
    int degree() const { return degree_; }
    double parameter() const { return u_; }
    // The coefficient of the curve that point (0, 0) is; the others follow it (of a closed curve modulo
    // size()).
    int first() const { return first_; }
    const P& operator()(int r, int i) const { return points_[start(r) + std::size_t(i)]; }
    std::span<const P> level(int r) const {
        return std::span(points_).subspan(start(r), std::size_t(degree_ - r) + 1);
    }
    std::span<const P> flat() const { return points_; }  // level after level
    const P& point() const { return points_.back(); }
    std::vector<P> left() const {
        std::vector<P> b;
        for (int r = 0; r <= degree_; ++r) b.push_back((*this)(r, 0));
        return b;
    }
    std::vector<P> right() const {
        std::vector<P> b;
        for (int i = 0; i <= degree_; ++i) b.push_back((*this)(degree_ - i, i));
        return b;
    }
    // No (homogeneous) coordinate of any point of the construction is off by more.
    double bound() const { return bound_; }

    // Of the piece of `basis` over `span`; coefficient(i) is the one that the piece sees at place i = 0 ..
    // degree. Refuses, as "at", parameters that are not finite and results that leave the range of double.
    template <class B, class F>
    static Result<Construction> make(const B& basis, int span, double u, F&& coefficient) {
        if (!std::isfinite(u))
            return refuse(RefusalKind::nonfinite, "at", text(u, " is not a finite number"));
        const int p = basis.degree();
        Construction c(p, u, span - p);
        for (int i = 0; i <= p; ++i) c.points_.push_back(coefficient(i));
        for (int r = 1; r <= p; ++r) {
            double stretch = 1;
            for (int i = 0; i <= p - r; ++i) {
                const double tl = basis.knot(span - p + i + r), tr = basis.knot(span + i + 1),
                             width = tr - tl;
                const double keep = (tr - u) / width, move = (u - tl) / width;
                c.points_.push_back(keep * P(c(r - 1, i)) + move * P(c(r - 1, i + 1)));
                stretch = std::max(stretch, std::abs(keep) + std::abs(move));
            }
            c.grow_bound(r, stretch);
        }
        if (!std::isfinite(c.bound_))
            return refuse(RefusalKind::ill_conditioned, "at",
                          text("the construction at ", u, " leaves the range of double"));
        return c;
    }

private:
    Construction(int degree, double u, int first) : degree_(degree), u_(u), first_(first) {
        points_.reserve(std::size_t((degree + 1) * (degree + 2) / 2));
    }
    std::size_t start(int r) const { return std::size_t(r * (degree_ + 1) - r * (r - 1) / 2); }

    // Exact points x = y + e, |e| <= E, become a x_1 + b x_2; computed is a (1 + d) y_1 + b (1 + d) y_2 with
    // |d| within 5 roundings: two differences, a quotient, a product, a sum. So E grows to s (E + 5 u |y|)
    // with s = |a| + |b| >= 1. Eight roundings instead of five pay for those of s and of this line and for
    // coefficients a, b that underflow; the last term pays for products that do.
    void grow_bound(int r, double stretch) {
        constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
        double size = 0;
        for (const P& p : level(r - 1))
            size = is_finite(p) ? std::max(size, max_abs(p)) : std::numeric_limits<double>::infinity();
        bound_ = stretch * (bound_ + 8 * kUnit * size) * (1 + 8 * kUnit) +
                 8 * std::numeric_limits<double>::denorm_min();
        for (const P& p : level(r))
            if (!is_finite(p)) bound_ = std::numeric_limits<double>::infinity();
    }

    int degree_;
    double u_;
    int first_;
    double bound_ = 0;
    std::vector<P> points_;
};

// de Casteljau: of the Bezier curve on [0, 1] with the coefficients b_0 .. b_n. t may be any finite number;
// outside [0, 1] the points are extrapolated. Refuses no or too many coefficients, and what is not finite.
template <Coefficient P>
Result<Construction<P>> de_casteljau(std::span<const P> b, double t) {
    auto basis = Bernstein::make(int(std::min<std::size_t>(b.size(), 1000)) - 1);
    if (!basis) return std::unexpected(basis.error());
    for (std::size_t i = 0; i < b.size(); ++i)
        if (!is_finite(b[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "a coordinate is not finite");
    return Construction<P>::make(*basis, basis->span(t), t, [&](int i) { return b[std::size_t(i)]; });
}

// The same of a curve at u: de Boor's construction in the piece where u lies (of a Bezier curve: de
// Casteljau's). Open curves outside their domain: the first or last piece is continued.
template <Coefficient P, Basis B>
Result<Construction<P>> de_boor(const Curve<P, B>& curve, double u) {
    const B& basis = curve.basis();
    const double inside = basis.wrap(u);
    const int span = std::isfinite(u) ? basis.span(inside) : basis.degree();
    return Construction<P>::make(basis, span, inside, [&](int i) {
        return curve.net().flat()[std::size_t((span - basis.degree() + i) % basis.size())];
    });
}

}  // namespace freiform
