// A-frames, and B-splines from Bezier pieces.
//
// Idea: the apex of an A-frame is the blossom of both pieces at (t_{i-1}, t_i, .., t_i, t_{i+1}), which two
// pieces share exactly if they are C2 at t_i. For a cubic these arguments are three consecutive knots, so
// that the blossom is a de Boor point.
//
// Notation: b, c Bezier points left and right of the joint, h, k the lengths of the pieces.
//
// Method: de_boor_points takes the mean of both apices; what the result is worth is found out afterwards, by
// the distance of its Bezier points from the given ones (distance_bound of refine_detail.hpp). join_pieces
// puts p + 1 knots at every joint and lets remove_knots take away what the tolerance allows.
//
// Accuracy: an apex carries 5 roundings of (1 + 2 k/h) max |b|. The bounds include all roundings: degree 3
// and the map of to_bezier (15 roundings an entry) stay below the 8 p + 16 = 40 that distance_bound counts.
//
// References: [Farin 2002, ch. 5, 8], [Ramshaw 1989].
//
// Why not least squares for the de Boor points: they would move all points because of one joint that is not
// C2, and the text's formula would no longer be what is computed.
#include "refine_detail.hpp"

#include <freiform/spline/a_frame.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/refine.hpp>

namespace freiform {

namespace {

template <class P>
AFrame<P> frame(double at, double h, double k, const std::array<P, 3>& b, const std::array<P, 3>& c) {
    AFrame<P> f{at, {b[0], b[1]}, {c[2], c[1]}, b[2], {}, {}, {}, 0};
    f.left_apex = b[1] + (k / h) * (b[1] - b[0]);
    f.right_apex = c[1] + (h / k) * (c[1] - c[2]);
    f.apex = 0.5 * f.left_apex + 0.5 * f.right_apex;
    f.gap = norm(f.left_apex - f.right_apex);
    return f;
}

Result<void> check_breaks(std::span<const double> breaks) {
    for (std::size_t i = 0; i < breaks.size(); ++i) {
        if (!std::isfinite(breaks[i]) || !std::isfinite(breaks[i] - breaks[0]))
            return refuse(RefusalKind::nonfinite, text("breaks[", i, "]"),
                          text(breaks[i], " or its distance from the first is not finite"));
        if (i > 0 && !(breaks[i - 1] < breaks[i]))
            return refuse(RefusalKind::invalid, text("breaks[", i, "]"),
                          text("does not increase: ", breaks[i - 1], " -> ", breaks[i]));
    }
    return {};
}

template <class P>
Result<void> check_pieces(std::span<const P> c, std::span<const double> breaks, std::size_t expected) {
    if (breaks.size() < 2)
        return refuse(RefusalKind::invalid, "breaks",
                      text(breaks.size(), " breaks; at least 2 are expected"));
    if (c.size() != expected)
        return refuse(
            RefusalKind::invalid, "points",
            text(c.size(), " Bezier points for ", breaks.size() - 1, " pieces; ", expected, " are expected"));
    for (std::size_t i = 0; i < c.size(); ++i)
        if (!is_finite(c[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "a coordinate is not finite");
    return check_breaks(breaks);
}

}  // namespace

template <Coefficient P>
Result<std::vector<AFrame<P>>> a_frames(const Curve<P>& curve) {
    const BSplineBasis& basis = curve.basis();
    const int p = basis.degree();
    if (p < 2)
        return refuse(RefusalKind::no_answer, "degree", text("degree ", p, "; an A-frame needs at least 2"));
    const BezierPieces<1, P> pieces(curve);
    const int n = pieces.extent()[0];
    std::vector<AFrame<P>> out;
    for (int i = basis.is_closed() ? 0 : 1; i < n; ++i) {
        const int before = (i + n - 1) % n;
        const auto b = pieces.net({before}), c = pieces.net({i});
        AFrame<P> f =
            frame<P>(pieces.breaks(0)[std::size_t(i)], pieces.box({before})[0].length(),
                     pieces.box({i})[0].length(), {b({p - 2}), b({p - 1}), b({p})}, {c({0}), c({1}), c({2})});
        if (!is_finite(f.left_apex) || !is_finite(f.right_apex))
            return refuse(RefusalKind::ill_conditioned, text("breaks[", i, "]"),
                          "the apex of its A-frame leaves the range of double");
        out.push_back(std::move(f));
    }
    return out;
}

template <Coefficient P>
Result<Reduced<1, P>> de_boor_points(std::span<const P> bezier, std::span<const double> breaks) {
    const std::size_t l = breaks.size() - (breaks.empty() ? 0 : 1);
    if (auto ok = check_pieces(bezier, breaks, 3 * l + 1); !ok) return std::unexpected(ok.error());
    std::vector<P> d{bezier[0], bezier[1]}, all;
    std::vector<double> knots(4, breaks[0]);
    for (std::size_t i = 1; i < l; ++i) {
        const P* b = &bezier[3 * i];
        d.push_back(frame<P>(breaks[i], breaks[i] - breaks[i - 1], breaks[i + 1] - breaks[i],
                             {b[-2], b[-1], b[0]}, {b[0], b[1], b[2]})
                        .apex);
        knots.push_back(breaks[i]);
    }
    d.insert(d.end(), {bezier[3 * l - 1], bezier[3 * l]});
    knots.insert(knots.end(), 4, breaks[l]);
    for (std::size_t i = 0; i < l; ++i) all.insert(all.end(), &bezier[3 * i], &bezier[3 * i] + 4);
    auto basis = BSplineBasis::make(3, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    auto curve = Curve<P>::make({std::move(*basis)}, Net<1, P>({int(l) + 3}, std::move(d)));
    if (!curve) return refuse(curve.error().kind, "points", curve.error().message);
    const int count = int(all.size());
    const Net<1, P> given({count}, std::move(all));
    const Net<1, P> image = along(0, to_bezier(curve->basis()).map, curve->net());
    const double bound =
        detail::distance_bound(3, tuples(given.flat()), tuples(curve->net().flat()), tuples(image.flat()));
    return Reduced<1, P>{std::move(*curve), bound, 2 * (int(l) - 1)};
}

template <Coefficient P>
Result<Reduced<1, P>> join_pieces(std::span<const P> coefficients, int degree, std::span<const double> breaks,
                                  double tolerance) {
    if (degree < 0 || degree > kMaxDegree)
        return refuse(RefusalKind::unsupported, "degree",
                      text("degree ", degree, " is outside [0, ", kMaxDegree, "]"));
    const std::size_t pieces = breaks.size() - (breaks.empty() ? 0 : 1), order = std::size_t(degree) + 1;
    if (auto ok = check_pieces(coefficients, breaks, pieces * order); !ok) return std::unexpected(ok.error());
    // A coefficient that neighbours have in common is written once, with one knot less: exactly the same
    // curve.
    std::vector<double> knots(order, breaks[0]);
    std::vector<P> net(coefficients.begin(), coefficients.begin() + std::ptrdiff_t(order));
    int shared = 0;
    for (std::size_t i = 1; i < pieces; ++i) {
        const bool same = degree > 0 && coefficients[i * order] == coefficients[i * order - 1];
        shared += same;
        knots.insert(knots.end(), order - std::size_t(same), breaks[i]);
        net.insert(net.end(), coefficients.begin() + std::ptrdiff_t(i * order) + same,
                   coefficients.begin() + std::ptrdiff_t((i + 1) * order));
    }
    knots.insert(knots.end(), order, breaks[pieces]);
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    auto curve = Curve<P>::make({std::move(*basis)}, Net<1, P>({int(net.size())}, net));
    if (!curve) return refuse(curve.error().kind, "points", curve.error().message);
    auto reduced = remove_knots(*curve, 0, tolerance);
    if (reduced) reduced->removed += shared;
    return reduced;
}

#define FF_A_FRAMES(P)                                                                          \
    template Result<std::vector<AFrame<P>>> a_frames(const Curve<P>&);                          \
    template Result<Reduced<1, P>> de_boor_points(std::span<const P>, std::span<const double>); \
    template Result<Reduced<1, P>> join_pieces(std::span<const P>, int, std::span<const double>, double);
#define FF_A_FRAMES_OF(D) FF_A_FRAMES(Vec<D>) FF_A_FRAMES(Hom<D>)
FF_A_FRAMES_OF(1)
FF_A_FRAMES_OF(2)
FF_A_FRAMES_OF(3)
FF_A_FRAMES_OF(4)
#undef FF_A_FRAMES
#undef FF_A_FRAMES_OF

}  // namespace freiform
