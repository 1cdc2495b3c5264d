// Idea. A piece of the surface is a polynomial in u and v, a piece of the curve has u and v as polynomials of
// t: what comes out is a polynomial of t, found by de Casteljau's algorithm with polynomials in place of
// numbers.
//
// Notation. w(t) = (U, V, W) / W the curve; for the piece [a, b] of the surface along u
//     s = (U - a W) / (b - a),    c_i := (W - s) c_i + s c_{i+1},   p times
// multiplies the homogeneous points c_i, polynomials of t, by W each time; and q times along v. Inside of the
// piece 0 <= s <= W: all factors are positive, nothing cancels.
//
// Method. The curve is cut where U - k W = 0 for inner knots k of the surface. Pieces of lower degree, along
// parameter lines, are raised to the highest one. Neighbours get the end of the earlier one in common.
//
// Cost. (p + 1)(q + 1) products of polynomials of degree up to d (p + q) for each piece: microseconds.
//
// Accuracy. Control points carry some (p + q) (d + 4) roundings of their size. Places where knots are crossed
// are rounded to parameters; beyond them the neighbouring piece of the surface is continued over that
// rounding.
//
// References. [DeRose 1988].
//
// Why not an approximation by cubics? Files would hold edges that are near the surface; these lie on it. The
// price is the degree, 18 for a cubic on a bicubic surface, which readers take up to 25.
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/poly/roots.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using BernsteinSum = std::vector<double>;
using SpacePolynomial = std::vector<Hom<3>>;

constexpr double kSameCut = 0x1p-46;  // of a piece: crossings nearer to each other, or to its ends, are one

SpacePolynomial product(const BernsteinSum& a, const SpacePolynomial& b) {
    const int p = int(a.size()) - 1, q = int(b.size()) - 1;
    SpacePolynomial out(std::size_t(p + q) + 1, Hom<3>{});
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j)
            out[std::size_t(i + j)] = out[std::size_t(i + j)] + (binomial(p, i) * binomial(q, j) /
                                                                 binomial(p + q, i + j) * a[std::size_t(i)]) *
                                                                    b[std::size_t(j)];
    return out;
}

SpacePolynomial sum(const SpacePolynomial& a, const SpacePolynomial& b) {
    SpacePolynomial out(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] + b[i];
    return out;
}

// The curve over a piece, along one axis of the surface: (W - s, s); constants where it does not move.
struct Factors {
    BernsteinSum before, after;
};
Factors factors(std::span<const Hom<2>> c, int axis, Interval on, bool polynomial) {
    Factors f;
    bool still = true;
    for (const Hom<2>& p : c) {
        const double s = (p[axis] - on.lo * p.weight()) / on.length();
        f.after.push_back(s), f.before.push_back((on.hi * p.weight() - p[axis]) / on.length());
        still = still && polynomial && p[axis] == c[0][axis];
    }
    if (still) f.after.resize(1), f.before.resize(1);
    return f;
}

SpacePolynomial casteljau(std::vector<SpacePolynomial> c, const Factors& f) {
    for (std::size_t n = c.size(); n > 1; --n)
        for (std::size_t i = 0; i + 1 < n; ++i)
            c[i] = sum(product(f.before, c[i]), product(f.after, c[i + 1]));
    return c[0];
}

// Where the curve crosses an inner knot of the surface, inside of (0, 1), in order.
std::vector<double> crossings(std::span<const Hom<2>> c,
                              const std::array<std::span<const double>, 2>& breaks) {
    std::vector<double> cuts;
    for (int axis = 0; axis < 2; ++axis) {
        const auto& inner = breaks[std::size_t(axis)];
        for (std::size_t k = 1; k + 1 < inner.size(); ++k) {
            std::vector<double> height;
            for (const Hom<2>& p : c) height.push_back(p[axis] - inner[k] * p.weight());
            const auto roots = real_roots(height, kSameCut / 4);
            if (!roots || roots->kind != RootsKind::isolated) continue;
            for (const Root& r : roots->roots) cuts.push_back(r.at.middle());
        }
    }
    sort(cuts);
    std::vector<double> apart;
    for (const double t : cuts)
        if (t > kSameCut && t < 1 - kSameCut && (apart.empty() || t > apart.back() + kSameCut))
            apart.push_back(t);
    return apart;
}

template <class S, class C>
class ImageMaker {
public:
    ImageMaker(const Surface<S>& surface, const Curve<C>& curve) : surface_(surface), curve_(curve) {}

    Result<CurveGeometry<3>> run() && {
        const BSplineBasis& basis = curve_.basis();
        for (const double t : basis.breaks())
            if (t > basis.domain().lo && t < basis.domain().hi && basis.multiplicity(t) > basis.degree())
                return refuse(RefusalKind::unsupported, text("knot ", t), "the parameter curve jumps here");
        const auto pieces = decompose(curve_);
        for (int i = 0; i < pieces.extent()[0]; ++i) add(pieces.net({i}), pieces.box({i})[0]);
        int degree = 0;
        for (const SpacePolynomial& p : images_) degree = std::max(degree, int(p.size()) - 1);
        if (degree > kMaxImageDegree)
            return refuse(RefusalKind::unsupported, "",
                          text("the image of the parameter curve would have the degree ", degree,
                               "; the highest is ", kMaxImageDegree));
        return joined(std::max(degree, 1));
    }

private:
    void add(const NetView<1, const C>& net, Interval on) {
        std::vector<Hom<2>> c;
        for (int i = 0; i < net.extent[0]; ++i) {
            if constexpr (kRational)
                c.push_back(net({i}));
            else
                c.push_back(weighted(net({i}), 1.0));
        }
        const auto &u = patches_.breaks(0), &v = patches_.breaks(1);
        std::vector<double> cuts = crossings(c, {u, v});
        cuts.push_back(1);
        double from = 0;
        for (const double to : cuts) {
            auto part = c;
            const Fibre<Hom<2>> f{part.data(), int(part.size()), 1};
            if (to < 1) keep_left(f, to);
            if (from > 0) keep_right(f, from / to);
            add_part(part);
            knots_.push_back(to == 1 ? on.hi : on.lo + to * on.length());
            from = to;
        }
    }

    void add_part(const std::vector<Hom<2>>& c) {
        auto half = c;
        keep_left(Fibre<Hom<2>>{half.data(), int(half.size()), 1}, 0.5);
        const Vec<2> middle = project(half.back());
        Index<2> at{};
        std::array<Factors, 2> f;
        for (int axis = 0; axis < 2; ++axis) {
            const auto& breaks = patches_.breaks(axis);
            const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, middle[axis]);
            at[std::size_t(axis)] = int(after - breaks.begin()) - 1;
            f[std::size_t(axis)] = factors(c, axis, {*(after - 1), *after}, !kRational);
        }
        const auto net = patches_.net(at);
        std::vector<SpacePolynomial> rows;
        for (int i = 0; i < net.extent[0]; ++i) {
            std::vector<SpacePolynomial> row;
            for (int j = 0; j < net.extent[1]; ++j) {
                if constexpr (Space<S>::kRational)
                    row.push_back({net({i, j})});
                else
                    row.push_back({weighted(net({i, j}), 1.0)});
            }
            rows.push_back(casteljau(std::move(row), f[1]));
        }
        images_.push_back(casteljau(std::move(rows), f[0]));
    }

    Result<CurveGeometry<3>> joined(int degree) {
        std::vector<double> knots(std::size_t(degree) + 1, curve_.domain()[0].lo);
        std::vector<Hom<3>> points;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const int missing = degree + 1 - int(images_[i].size());
            const auto raised = product(BernsteinSum(std::size_t(missing) + 1, 1.0), images_[i]);
            points.insert(points.end(), raised.begin() + (i > 0), raised.end());
            knots.insert(knots.end(), std::size_t(degree), knots_[i]);
        }
        knots.push_back(knots.back());
        auto basis = BSplineBasis::make(degree, std::move(knots));
        if (!basis) return std::unexpected(basis.error());
        const int n = int(points.size());
        if constexpr (kRational || Space<S>::kRational) {
            auto made = Curve<Hom<3>>::make({*std::move(basis)}, Net<1, Hom<3>>({n}, std::move(points)));
            if (!made) return std::unexpected(made.error());
            return *std::move(made);
        } else {
            std::vector<Vec<3>> plain;
            for (const Hom<3>& p : points) plain.push_back({{p[0], p[1], p[2]}});
            auto made = Curve<Vec<3>>::make({*std::move(basis)}, Net<1, Vec<3>>({n}, std::move(plain)));
            if (!made) return std::unexpected(made.error());
            return *std::move(made);
        }
    }

    static constexpr bool kRational = Space<C>::kRational;
    const Surface<S>& surface_;
    const Curve<C>& curve_;
    BezierPieces<2, S> patches_{surface_};
    std::vector<SpacePolynomial> images_;
    std::vector<double> knots_;  // the end of each
};

template <int D>
Result<CurveGeometry<D>> spline_of_part(const CurveGeometry<D>& curve, Interval on) {
    return visit_one(
        [&](const auto& c) -> Result<CurveGeometry<D>> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<D>>) {
                const auto basis = BSplineBasis::make(1, {on.lo, on.lo, on.hi, on.hi});
                if (!basis) return std::unexpected(basis.error());
                auto made = Curve<Vec<D>>::make(
                    {*basis},
                    Net<1, Vec<D>>({2}, {c.origin + on.lo * c.direction, c.origin + on.hi * c.direction}));
                if (!made) return std::unexpected(made.error());
                return *std::move(made);
            } else if constexpr (std::same_as<C, Conic<D>>) {
                auto arc = conic_arc(c, on);
                if (!arc) return std::unexpected(arc.error());
                return std::move(arc->curve);
            } else {
                if (!c.basis().is_closed() && c.basis().domain() == on) return c;
                auto part = restrict_to(c, 0, on);
                if (!part) return std::unexpected(part.error());
                return *std::move(part);
            }
        },
        curve);
}

}  // namespace

Result<CurveGeometry<2>> parameter_spline(const CurveGeometry<2>& curve, Interval on) {
    return spline_of_part(curve, on);
}
Result<CurveGeometry<3>> space_spline(const CurveGeometry<3>& curve, Interval on) {
    return spline_of_part(curve, on);
}

Result<CurveGeometry<3>> image_curve(const SurfaceGeometry& surface, const CurveGeometry<2>& curve) {
    return std::visit(
        [](const auto& s, const auto& c) -> Result<CurveGeometry<3>> {
            if constexpr (requires {
                              s.net();
                              c.net();
                          })
                return ImageMaker(s, c).run();
            else
                return refuse(RefusalKind::unsupported, "",
                              "its parameter curve can be put into space on spline surfaces alone");
        },
        surface, curve);
}

}  // namespace freiform
