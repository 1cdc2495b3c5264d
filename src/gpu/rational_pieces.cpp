// From analytic and spline geometry to rational Bezier pieces.
//
// Idea. Everything that models are made of but offsets is rational in some parameter. Trimming loops refer to
// the parameters of the model, an angle for circles, so that each piece says how its own parameter becomes
// that one.
//
// Method. An arc of an ellipse of half angle a about its middle m has the weights 1, cos a, 1 and the corner
// in the middle at x / cos a, x the axis turned to m. With s in [0, 1] its angle is m + 2 atan(tan(a / 2) (2
// s - 1)): the weights are those of 1 + X^2 with X = tan(angle / 2). A branch of a hyperbola is the same with
// cosh and tanh. A parabola keeps its parameter. Extrusions are a profile times a line; revolutions an arc
// times a profile, each control point of which runs on a circle of its own. Splines are cut to the interval
// and decomposed; what of a closed one reaches over its period is the same piece again.
//
// Accuracy. Within a few roundings of the coefficients.
//
// References: [PT97, 7.3], [Farin 2002, 12].
#include "gpu/rational_pieces_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kWidestArc = kTwoPi / 4 * (1 + 1e-9);
constexpr int kMostPeriods = 1000;

template <int D>
Hom<D> lifted_to_space(const Vec<D>& p) {
    return weighted(p, 1.0);
}
template <int D>
Hom<D> lifted_to_space(const Hom<D>& p) {
    return p;
}

template <int D>
std::vector<CurvePiece<D>> conic_pieces(const Conic<D>& c, Interval on) {
    std::vector<CurvePiece<D>> out;
    if (c.kind == ConicKind::parabola) {
        const auto blossom = [&](double s, double t) {
            return weighted(c.centre + (s * t) * c.x + (s + t) / 2 * c.y, 1.0);
        };
        out.push_back({{on, 0}, {blossom(on.lo, on.lo), blossom(on.lo, on.hi), blossom(on.hi, on.hi)}});
        return out;
    }
    const bool ellipse = c.kind == ConicKind::ellipse;
    const int n = std::max(1, int(std::ceil(on.length() / kWidestArc)));
    for (int i = 0; i < n; ++i) {
        const Interval part{on.lo + on.length() * i / n,
                            i + 1 == n ? on.hi : on.lo + on.length() * (i + 1) / n};
        const double m = part.middle(), a = part.length() / 2;
        const double even = ellipse ? std::cos(m) : std::cosh(m), odd = ellipse ? std::sin(m) : std::sinh(m);
        const Vec<D> x = even * c.x + odd * c.y, y = (ellipse ? -odd : odd) * c.x + even * c.y;
        const double w = ellipse ? std::cos(a) : std::cosh(a), side = ellipse ? std::sin(a) : std::sinh(a);
        const double bow = ellipse ? std::tan(a / 2) : -std::tanh(a / 2);
        out.push_back({{part, bow},
                       {weighted(c.centre + w * x - side * y, 1.0), weighted(c.centre + (1 / w) * x, w),
                        weighted(c.centre + w * x + side * y, 1.0)}});
    }
    return out;
}

// The breaks of a basis that parts of `on` begin and end with; of a closed one unwound.
struct SplinePart {
    Interval on;
    int piece = 0;
};
Result<std::vector<SplinePart>> spline_parts(const BSplineBasis& basis, const std::vector<double>& breaks,
                                             Interval on) {
    const Interval domain = basis.domain();
    std::vector<SplinePart> out;
    const double period = domain.length();
    int first = 0, last = 0;
    if (basis.is_closed()) {
        if (!(std::abs(on.lo - domain.lo) < kMostPeriods * period &&
              std::abs(on.hi - domain.lo) < kMostPeriods * period))
            return refuse(RefusalKind::limit, "domain", "the parameters go round the surface too often");
        first = int(std::floor((on.lo - domain.lo) / period));
        last = int(std::floor((on.hi - domain.lo) / period));
    }
    for (int k = first; k <= last; ++k)
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
            const Interval part{breaks[i] + k * period, breaks[i + 1] + k * period};
            if (part.hi > on.lo && part.lo < on.hi) out.push_back({part, int(i)});
        }
    if (out.empty()) return refuse(RefusalKind::out_of_domain, "domain", "the face lies outside its surface");
    return out;
}

template <int D, class P>
Result<std::vector<CurvePiece<D>>> spline_pieces(const Curve<P>& whole, Interval on) {
    Curve<P> curve = whole;
    const Interval domain = curve.domain()[0];
    if (!curve.basis(0).is_closed()) {
        on = {std::max(on.lo, domain.lo), std::min(on.hi, domain.hi)};
        if (on.lo < on.hi && on != domain) {
            auto cut = restrict_to(curve, 0, on);
            if (!cut) return std::unexpected(cut.error());
            curve = std::move(*cut);
        }
    }
    const auto pieces = decompose(curve);
    const auto parts = spline_parts(curve.basis(0), pieces.breaks(0), on);
    if (!parts) return std::unexpected(parts.error());
    std::vector<CurvePiece<D>> out;
    for (const SplinePart& part : *parts) {
        out.push_back({{part.on, 0}, {}});
        const auto net = pieces.net({part.piece});
        for (int i = 0; i <= pieces.degree(0); ++i) out.back().net.push_back(lifted_to_space(net({i})));
    }
    return out;
}

Result<SurfacePieces> extruded(const Extrusion& e, std::array<Interval, 2> on) {
    auto profile = rational_pieces(e.profile, on[0]);
    if (!profile) return std::unexpected(profile.error());
    SurfacePieces out{{}, {{on[1], 0}}, {int(profile->front().net.size()) - 1, 1}, {}, 0};
    for (const CurvePiece<3>& piece : *profile) {
        out.u.push_back(piece.map);
        Net<2, Hom<3>> net({int(piece.net.size()), 2}, std::vector<Hom<3>>(2 * piece.net.size()));
        for (std::size_t i = 0; i < piece.net.size(); ++i)
            for (const int j : {0, 1}) {
                Hom<3>& h = net.flat()[2 * i + std::size_t(j)];
                h = piece.net[i];
                const double along = j == 0 ? on[1].lo : on[1].hi;
                for (int k = 0; k < 3; ++k) h[k] += along * h.weight() * e.direction[k];
            }
        out.nets.push_back(std::move(net));
    }
    return out;
}

Result<SurfacePieces> revolved(const Revolution& r, std::array<Interval, 2> on) {
    const auto profile = rational_pieces(r.profile, on[1]);
    if (!profile) return std::unexpected(profile.error());
    const int m = int(profile->front().net.size());
    SurfacePieces out{{}, {}, {2, m - 1}, {}, 0};
    for (const CurvePiece<3>& piece : *profile) out.v.push_back(piece.map);
    const auto turned = conic_pieces(Conic<2>{ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}}, on[0]);
    for (const CurvePiece<2>& arc : turned) {
        out.u.push_back(arc.map);
        for (const CurvePiece<3>& piece : *profile) {
            std::vector<Hom<3>> net;
            for (const Hom<2>& a : arc.net)
                for (const Hom<3>& p : piece.net) {
                    const Vec<2> c = project(a);
                    const Vec<3> q = project(p) - r.origin, along = dot(q, r.axis) * r.axis,
                                 out_of = q - along;
                    net.push_back(weighted(r.origin + along + c[0] * out_of + c[1] * cross(r.axis, out_of),
                                           a.weight() * p.weight()));
                }
            out.nets.emplace_back(Index<2>{3, m}, std::move(net));
        }
    }
    return out;
}

template <class P>
Result<SurfacePieces> of_spline(const Surface<P>& whole, std::array<Interval, 2> on) {
    Surface<P> surface = whole;
    for (const int axis : {0, 1}) {
        const Interval domain = surface.basis(axis).domain();
        Interval& part = on[std::size_t(axis)];
        if (surface.basis(axis).is_closed()) continue;
        part = {std::max(part.lo, domain.lo), std::min(part.hi, domain.hi)};
        if (!(part.lo < part.hi) || part == domain) continue;
        auto cut = restrict_to(surface, axis, part);
        if (!cut) return std::unexpected(cut.error());
        surface = std::move(*cut);
    }
    const auto pieces = decompose(surface);
    const auto columns = spline_parts(surface.basis(0), pieces.breaks(0), on[0]);
    const auto rows = spline_parts(surface.basis(1), pieces.breaks(1), on[1]);
    if (!columns) return std::unexpected(columns.error());
    if (!rows) return std::unexpected(rows.error());
    SurfacePieces out{{}, {}, {pieces.degree(0), pieces.degree(1)}, {}, 0};
    for (const SplinePart& c : *columns) out.u.push_back({c.on, 0});
    for (const SplinePart& r : *rows) out.v.push_back({r.on, 0});
    for (const SplinePart& c : *columns)
        for (const SplinePart& r : *rows) {
            const auto from = pieces.net({c.piece, r.piece});
            std::vector<Hom<3>> net;
            each_index(from.extent, [&](const Index<2>& k) { net.push_back(lifted_to_space(from(k))); });
            out.nets.emplace_back(from.extent, std::move(net));
        }
    return out;
}

}  // namespace

double ParameterMap::operator()(double s) const {
    if (bow == 0) return on.lo + on.length() * s;
    const double x = bow * (2 * s - 1);
    return on.middle() + 2 * (bow > 0 ? std::atan(x) : std::atanh(-x));
}

// 2 atan(X), X = bow (2 s - 1): 4 bow / (1 + X^2) and -16 bow^2 X / (1 + X^2)^2; with atanh 1 - X^2 instead.
double ParameterMap::slope() const {
    if (bow == 0) return on.length();
    return bow > 0 ? 4 * bow : -4 * bow / (1 - bow * bow);
}
double ParameterMap::bend() const {
    if (bow == 0) return 0;
    const double cube = 16 * std::abs(bow * bow * bow), below = bow > 0 ? 1 : 1 - bow * bow;
    return cube / (below * below);
}

template <int D>
Result<std::vector<CurvePiece<D>>> rational_pieces(const CurveGeometry<D>& curve, Interval on) {
    if (!(std::isfinite(on.lo) && std::isfinite(on.hi) && on.lo < on.hi))
        return refuse(RefusalKind::unsupported, "domain", "the parameters have no bounds");
    using Pieces = std::vector<CurvePiece<D>>;
    if (const auto* line = std::get_if<Line<D>>(&curve))
        return Pieces{{{on, 0},
                       {weighted(line->origin + on.lo * line->direction, 1.0),
                        weighted(line->origin + on.hi * line->direction, 1.0)}}};
    if (const auto* conic = std::get_if<Conic<D>>(&curve)) {
        if (conic->kind == ConicKind::ellipse && on.length() > kMostPeriods * kTwoPi)
            return refuse(RefusalKind::limit, "domain", "the parameters go round the ellipse too often");
        return conic_pieces(*conic, on);
    }
    if (const auto* spline = std::get_if<Curve<Vec<D>>>(&curve)) return spline_pieces<D>(*spline, on);
    return spline_pieces<D>(std::get<Curve<Hom<D>>>(curve), on);
}
template Result<std::vector<CurvePiece<2>>> rational_pieces(const CurveGeometry<2>&, Interval);
template Result<std::vector<CurvePiece<3>>> rational_pieces(const CurveGeometry<3>&, Interval);

Result<SurfacePieces> rational_pieces(const SurfaceGeometry& surface, std::array<Interval, 2> on) {
    for (const Interval& part : on)
        if (!(std::isfinite(part.lo) && std::isfinite(part.hi) && part.lo < part.hi))
            return refuse(RefusalKind::unsupported, "domain", "the parameters have no bounds");
    if (const auto* extrusion = std::get_if<Extrusion>(&surface)) return extruded(*extrusion, on);
    if (const auto* revolution = std::get_if<Revolution>(&surface)) return revolved(*revolution, on);
    if (const auto* spline = std::get_if<Surface<Vec<3>>>(&surface)) return of_spline(*spline, on);
    if (const auto* spline = std::get_if<Surface<Hom<3>>>(&surface)) return of_spline(*spline, on);
    const auto& offset = std::get<OffsetSurface>(surface);
    if (std::holds_alternative<OffsetSurface>(*offset.base))
        return refuse(RefusalKind::unsupported, "surface", "an offset of an offset surface");
    auto base = rational_pieces(*offset.base, on);
    if (base) base->distance = offset.distance;
    return base;
}

}  // namespace freiform
