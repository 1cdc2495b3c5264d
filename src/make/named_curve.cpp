// The named schemes as splines.
//
// Idea: a scheme that interpolates is Hermite's with a rule for the tangents; all others are a change of
// basis. So there is one construction of a cubic spline (hermite_spline) and one of a polynomial
// (from_basis).
//
// Method: tangents of Kochanek-Bartels are a weighted sum of the differences to both neighbours, with
// different weights on arriving and on leaving (named.hpp); cardinal and Catmull-Rom splines are special
// settings. Inner knots of a C1 spline are double, and the Bezier points between two segments are no
// coefficients then. Closed curves are made open, with the first point repeated, because their seam has a
// double or triple knot like all others: the first and the last coefficient are then one.
//
// Accuracy: control points carry 4 roundings of the largest of |P|, |h R / 3| (Hermite), of sums of such
// (tangents), or one rounding (from_basis, see polynomial_basis.cpp; a curve is a convex combination of its
// control points, so their bound is one of the curve).
//
// References: [Catmull & Rom 1974], [Kochanek & Bartels 1984].
//
// Why not matrices G M: they give the coefficients of powers of t, which no later step wants.
#include <freiform/make/named_curve.hpp>
#include <freiform/make/named_surface.hpp>

#include <cmath>

namespace freiform {

namespace {

template <class P>
Result<void> check_finite(std::span<const P> list, std::string_view name) {
    for (std::size_t i = 0; i < list.size(); ++i)
        if (!is_finite(list[i]))
            return refuse(RefusalKind::nonfinite, text(name, "[", i, "]"), "a coordinate is not finite");
    return {};
}

template <class P>
Result<Curve<P>> curve_on(Result<BSplineBasis> basis, std::vector<P> net, std::string_view where) {
    if (!basis) return std::unexpected(basis.error());
    const int n = int(net.size());
    auto curve = Curve<P>::make({std::move(*basis)}, Net<1, P>({n}, std::move(net)));
    if (!curve) return refuse(curve.error().kind, std::string(where), curve.error().message);
    return curve;
}

Result<std::vector<double>> checked_parameters(std::span<const double> given, std::size_t n) {
    std::vector<double> t(given.begin(), given.end());
    for (std::size_t i = 0; given.empty() && i < n; ++i) t.push_back(double(i));
    if (t.size() != n)
        return refuse(RefusalKind::invalid, "parameters", text(t.size(), " parameters for ", n, " points"));
    for (std::size_t i = 0; i < n; ++i) {
        if (!std::isfinite(t[i]) || !std::isfinite(t[i] - t[0]))
            return refuse(RefusalKind::nonfinite, text("parameters[", i, "]"),
                          text(t[i], " or its distance from the first is not finite"));
        if (i > 0 && !(t[i - 1] < t[i]))
            return refuse(RefusalKind::invalid, text("parameters[", i, "]"),
                          text("does not increase: ", t[i - 1], " -> ", t[i]));
    }
    return t;
}

}  // namespace

template <Coefficient P>
Result<Curve<P>> hermite_spline(std::span<const P> points, std::span<const P> tangents,
                                std::span<const double> parameters, std::span<const P> leaving) {
    const std::size_t n = points.size();
    if (n < 2) return refuse(RefusalKind::invalid, "points", text(n, " points; at least 2 are expected"));
    if (tangents.size() != n || (!leaving.empty() && leaving.size() != n))
        return refuse(
            RefusalKind::invalid, tangents.size() != n ? "tangents" : "leaving",
            text(tangents.size() != n ? tangents.size() : leaving.size(), " tangents for ", n, " points"));
    for (const auto& [list, name] :
         {std::pair{points, "points"}, {tangents, "tangents"}, {leaving, "leaving"}})
        if (auto ok = check_finite(list, name); !ok) return std::unexpected(ok.error());
    const auto t = checked_parameters(parameters, n);
    if (!t) return std::unexpected(t.error());
    const std::span<const P> out = leaving.empty() ? tangents : leaving;
    std::vector<double> knots(4, t->front());
    std::vector<P> net{points[0]};
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double h = (*t)[i + 1] - (*t)[i];
        const bool last = i + 2 == n, smooth = !last && out[i + 1] == tangents[i + 1];
        net.push_back(points[i] + (h / 3) * out[i]);
        net.push_back(points[i + 1] - (h / 3) * tangents[i + 1]);
        if (!smooth) net.push_back(points[i + 1]);
        knots.insert(knots.end(), last ? 4 : smooth ? 2 : 3, (*t)[i + 1]);
    }
    auto curve = curve_on(BSplineBasis::make(3, std::move(knots)), std::move(net), "tangents");
    if (!curve && curve.error().kind == RefusalKind::nonfinite)
        return refuse(RefusalKind::nonfinite, "tangents",
                      "point and tangent together leave the range of double");
    return curve;
}

template <Coefficient P>
Result<Curve<P>> hermite(const P& p1, const P& p4, const P& r1, const P& r4) {
    const P points[] = {p1, p4}, tangents[] = {r1, r4};
    return hermite_spline<P>(points, tangents);
}

template <Coefficient P>
Result<Curve<P>> kochanek_bartels(std::span<const P> points, std::span<const TensionContinuityBias> settings,
                                  Ring ring) {
    const std::size_t n = points.size();
    const bool closed = ring == Ring::closed;
    if (n < (closed ? 3 : 4))
        return refuse(RefusalKind::invalid, "points",
                      text(n, " points; at least ", closed ? 3 : 4, " are expected"));
    if (settings.size() != n && settings.size() != 1)
        return refuse(RefusalKind::invalid, "settings",
                      text(settings.size(), " settings for ", n, " points; one or ", n, " are expected"));
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (!std::isfinite(settings[i].tension) || !std::isfinite(settings[i].continuity) ||
            !std::isfinite(settings[i].bias))
            return refuse(RefusalKind::nonfinite, text("settings[", i, "]"), "a setting is not finite");
    if (auto ok = check_finite(points, "points"); !ok) return std::unexpected(ok.error());
    std::vector<P> through, in, out;
    const std::size_t first = closed ? 0 : 1, count = closed ? n + 1 : n - 2;
    for (std::size_t k = first; k < first + count; ++k) {
        const std::size_t i = k % n;
        const TensionContinuityBias& s = settings[settings.size() == 1 ? 0 : i];
        const P before = points[i] - points[(i + n - 1) % n], after = points[(i + 1) % n] - points[i];
        const TangentWeights a = arriving(s), b = leaving(s);
        through.push_back(points[i]);
        in.push_back(a.before * before + a.after * after);
        out.push_back(b.before * before + b.after * after);
    }
    return hermite_spline<P>(through, in, {}, out);
}

template <Coefficient P>
Result<Curve<P>> cardinal(std::span<const P> points, double tension, Ring ring) {
    if (!std::isfinite(tension))
        return refuse(RefusalKind::nonfinite, "tension", text(tension, " is not a finite number"));
    const TensionContinuityBias setting{tension, 0, 0};
    return kochanek_bartels(points, std::span(&setting, 1), ring);
}

template <Coefficient P>
Result<Curve<P>> catmull_rom(std::span<const P> points, Ring ring) {
    return cardinal(points, 0, ring);
}

template <Coefficient P>
Result<Curve<P>> uniform_b_spline(std::span<const P> points, int degree, Ring ring) {
    const bool closed = ring == Ring::closed;
    if (degree < 0 || degree > kMaxDegree)
        return refuse(RefusalKind::unsupported, "degree",
                      text("degree ", degree, " is outside [0, ", kMaxDegree, "]"));
    const int least = closed ? 1 : degree + 1;
    if (points.size() < std::size_t(least) || points.size() > 0x3fffffff)
        return refuse(
            RefusalKind::invalid, "points",
            text(points.size(), " control points; at least ", least, " are expected for degree ", degree));
    if (auto ok = check_finite(points, "points"); !ok) return std::unexpected(ok.error());
    const int n = int(points.size());
    std::vector<double> knots;
    for (int i = closed ? 0 : -degree; i <= n; ++i) knots.push_back(i);
    return curve_on<P>(closed ? BSplineBasis::periodic(degree, std::move(knots))
                              : BSplineBasis::make(degree, std::move(knots)),
                       {points.begin(), points.end()}, "points");
}

template <Coefficient P>
Result<PolynomialCurve<P>> from_basis(const PolynomialBasis& basis, std::span<const P> coefficients,
                                      Interval on) {
    if (coefficients.size() != std::size_t(basis.size()))
        return refuse(RefusalKind::invalid, "coefficients",
                      text(coefficients.size(), " coefficients for a basis of degree ", basis.degree()));
    auto made = from_bases<1, P>({basis},
                                 Net<1, P>({basis.size()}, {coefficients.begin(), coefficients.end()}), {on});
    if (!made) return std::unexpected(made.error());
    return PolynomialCurve<P>{std::move(made->patch), made->bound, made->condition};
}

template <Coefficient P>
Result<Converted<P>> to_basis(const Curve<P>& curve, double u, const PolynomialBasis& basis) {
    const BSplineBasis& b = curve.basis();
    if (!std::isfinite(u) || (!b.is_closed() && !b.domain().contains(u)))
        return refuse(std::isfinite(u) ? RefusalKind::out_of_domain : RefusalKind::nonfinite, "at",
                      text(u, " is outside the domain [", b.domain().lo, ", ", b.domain().hi, "]"));
    const int span = b.span(b.wrap(u));
    const auto from = PolynomialBasis::b_spline(b, span);
    if (!from) return std::unexpected(from.error());
    std::vector<P> c;
    for (int i = span - b.degree(); i <= span; ++i)
        c.push_back(curve.net().flat()[std::size_t(i % b.size())]);
    return convert_coefficients(*from, basis, std::span<const P>(c));
}

template <Coefficient P>
Result<PolynomialCurve<P>> polynomial(std::span<const P> columns, Interval on) {
    const auto basis = PolynomialBasis::monomial(int(std::min<std::size_t>(columns.size(), 1000)) - 1);
    if (!basis) return refuse(basis.error().kind, "columns", basis.error().message);
    return from_basis(*basis, columns, on);
}

template <Coefficient P>
Result<PolynomialCurve<P>> interpolating_polynomial(std::span<const P> points,
                                                    std::span<const double> nodes) {
    if (points.size() != nodes.size())
        return refuse(RefusalKind::invalid, "nodes",
                      text(nodes.size(), " nodes for ", points.size(), " points"));
    if (points.size() < 2)
        return refuse(RefusalKind::invalid, "points",
                      text(points.size(), " points; at least 2 are expected"));
    const auto basis = PolynomialBasis::lagrange({nodes.begin(), nodes.end()});
    if (!basis) return std::unexpected(basis.error());
    const auto [lo, hi] = std::minmax_element(nodes.begin(), nodes.end());
    return from_basis(*basis, points, {*lo, *hi});
}

#define FF_NAMED_CURVES(P)                                                                                 \
    template Result<Curve<P>> hermite(const P&, const P&, const P&, const P&);                             \
    template Result<Curve<P>> hermite_spline(std::span<const P>, std::span<const P>,                       \
                                             std::span<const double>, std::span<const P>);                 \
    template Result<Curve<P>> catmull_rom(std::span<const P>, Ring);                                       \
    template Result<Curve<P>> cardinal(std::span<const P>, double, Ring);                                  \
    template Result<Curve<P>> kochanek_bartels(std::span<const P>, std::span<const TensionContinuityBias>, \
                                               Ring);                                                      \
    template Result<Curve<P>> uniform_b_spline(std::span<const P>, int, Ring);                             \
    template Result<PolynomialCurve<P>> from_basis(const PolynomialBasis&, std::span<const P>, Interval);  \
    template Result<Converted<P>> to_basis(const Curve<P>&, double, const PolynomialBasis&);               \
    template Result<PolynomialCurve<P>> polynomial(std::span<const P>, Interval);                          \
    template Result<PolynomialCurve<P>> interpolating_polynomial(std::span<const P>, std::span<const double>);
#define FF_NAMED_CURVES_OF(D) FF_NAMED_CURVES(Vec<D>) FF_NAMED_CURVES(Hom<D>)
FF_NAMED_CURVES_OF(1)
FF_NAMED_CURVES_OF(2)
FF_NAMED_CURVES_OF(3)
FF_NAMED_CURVES_OF(4)
#undef FF_NAMED_CURVES
#undef FF_NAMED_CURVES_OF

}  // namespace freiform
