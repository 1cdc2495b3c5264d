// A composite curve where one curve is needed, as the profile of a surface or what is trimmed: one spline.
//
// Method. Conics become rational splines, all segments get the highest degree among them, and their knots,
// moved by what the ranges of parameters add up to, are those of the whole: the standard's parameter, but
// inside of conics, whose parameter is an angle. Where segments meet, the later one begins at the control
// point that the earlier one ends with.
//
// Accuracy. To move one control point by the gap g moves no point of a spline farther than g. What conics
// lose is their own bound (make/conic.hpp). Parts of lines and splines, degrees and weights cost some 6 p
// roundings of coefficients each, p <= 25, relative to the largest number that they are made of: of lines the
// origin and what is added to it. All together are less than kRounding of that.
//
// References: ISO 10303-42:2014, 4.4 (composite_curve: its parametrisation).
#include "step_geometry.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kMostWraps = 100;
constexpr int kMostNested = 20;  // composite curves in each other
constexpr double kRounding = 0x1p-40;

}  // namespace

std::uint32_t composite_in(const File& f, std::uint32_t i) {
    for (int depth = 0; depth < kMostWraps; ++depth) {
        for (const Type t : {Type::COMPOSITE_CURVE, Type::COMPOSITE_CURVE_ON_SURFACE, Type::BOUNDARY_CURVE,
                             Type::OUTER_BOUNDARY_CURVE})
            if (f.is(i, t)) return i;
        std::uint32_t next = kMissing;
        for (const Type t : {Type::SURFACE_CURVE, Type::SEAM_CURVE, Type::INTERSECTION_CURVE})
            if (const std::uint32_t list = f.part(i, t); list != kMissing)
                if (const auto of = Fields(f, i, list).reference(f.type(i) == Type::unknown ? 0 : 1, "curve"))
                    next = *of;
        if (next == kMissing) break;
        i = next;
    }
    return kMissing;
}

Result<std::vector<CompositeSegment>> segments_in(const File& file, std::uint32_t composite) {
    for (const Type t : {Type::COMPOSITE_CURVE, Type::COMPOSITE_CURVE_ON_SURFACE, Type::BOUNDARY_CURVE,
                         Type::OUTER_BOUNDARY_CURVE}) {
        const std::uint32_t list = file.part(composite, t);
        if (list == kMissing) continue;
        const Fields f(file, composite, list);
        if (f.size() < 2) continue;
        const auto ids = f.references(f.size() - 2, "segments");
        if (!ids) return std::unexpected(ids.error());
        std::vector<CompositeSegment> out;
        for (const std::uint32_t id : *ids) {
            const Type other = Type::REPARAMETRISED_COMPOSITE_CURVE_SEGMENT;
            const bool named = file.is(id, Type::COMPOSITE_CURVE_SEGMENT) || !file.is(id, other);
            const auto g = Fields::of(file, id, named ? Type::COMPOSITE_CURVE_SEGMENT : other, 3);
            const auto curve = g ? g->reference(2, "curve") : std::unexpected(g.error());
            if (!curve) return std::unexpected(curve.error());
            out.push_back({id, *curve, g->flag(1)});
        }
        return out;
    }
    return refuse(RefusalKind::unreadable, file.label(composite), "is a boundary without segments");
}

Result<BoundedCurve> GeometryReader::composite(std::uint32_t i) {
    const auto segments = segments_in(f_, i);
    if (!segments) return std::unexpected(segments.error());
    if (depth_ > kMostNested)
        return refuse(RefusalKind::limit, f_.label(i),
                      text("is a composite curve in more than ", kMostNested, " others"));
    struct Piece {
        std::uint32_t instance;
        Curve<Hom<3>> spline;
        double length;  // of its parameters
    };
    std::vector<Piece> pieces;
    BoundedCurve out;
    bool is_rational = false, is_exact = true;
    int degree = 1;
    double largest = 0;
    Box<3> box;
    for (const CompositeSegment& s : *segments) {
        const auto within = [&](const Refusal& r) {
            return refuse(r.kind, f_.label(s.instance),
                          text(r.where, r.where.empty() ? "" : ": ", r.message));
        };
        const auto c = curve(s.curve);
        if (!c) return within(c.error());
        const Interval on = c->range.value_or(domain(c->curve)[0]);
        if (!std::isfinite(on.length()) || !(on.lo < on.hi))
            return refuse(RefusalKind::invalid, f_.label(s.instance), "is a part of a curve without end");
        const auto* conic = std::get_if<Conic<3>>(&c->curve);
        const auto* line = std::get_if<Line<3>>(&c->curve);
        CurveGeometry<3> made = c->curve;
        double lost = c->bound;
        if (conic) {
            auto arc = conic_arc(*conic, on);
            if (!arc) return within(arc.error());
            made = std::move(arc->curve), lost += arc->bound;
        } else if (line) {
            auto part = space_spline(made, on);
            if (!part) return within(part.error());
            made = *std::move(part);
            largest = std::max(largest, max_abs(line->origin) + std::max(std::abs(on.lo), std::abs(on.hi)) *
                                                                    max_abs(line->direction));
        }
        const auto* plain = std::get_if<Curve<Vec<3>>>(&made);
        const auto spline = plain ? to_rational(*plain) : std::get<Curve<Hom<3>>>(made);
        for (const Hom<3>& p : spline.net().flat()) largest = std::max(largest, max_abs(project(p)));
        auto clamped = restrict_to(spline, 0, conic || line ? spline.basis().domain() : on);
        if (!clamped) return within(clamped.error());
        const auto points = std::size_t(clamped->basis().size());
        if (points > composite_points_left_)
            return refuse(RefusalKind::limit, f_.label(i),
                          "contains itself, or has more segments than the file");
        composite_points_left_ -= points;
        const bool turns = c->has_angles || (conic != nullptr && conic->kind == ConicKind::ellipse);
        out.has_own_parameters = out.has_own_parameters || c->has_own_parameters || conic != nullptr;
        is_rational = is_rational || !plain;
        degree = std::max(degree, clamped->basis().degree());
        out.bound = std::max(out.bound, lost);
        // A whole polynomial spline that begins and ends at control points.
        is_exact =
            is_exact && plain && !line && c->approximated == kMissing && clamped->basis() == spline.basis();
        for (const Hom<3>& p : clamped->net().flat()) box.add(project(p));
        pieces.push_back({s.instance, c->reversed == s.forward ? reverse(*clamped, 0) : *std::move(clamped),
                          on.length() / (turns ? angle : 1)});
    }
    if (pieces.empty()) return refuse(RefusalKind::invalid, f_.label(i), "has no segments");

    std::vector<Hom<3>> net;
    std::vector<double> knots;
    double at = 0, widest = 0;
    for (Piece& p : pieces) {
        is_exact = is_exact && p.spline.basis().degree() == degree;
        const auto raised = elevate(p.spline, 0, degree - p.spline.basis().degree());
        if (!raised) return refuse(raised.error().kind, f_.label(p.instance), raised.error().message);
        const auto own = raised->net().flat();
        const auto t = raised->basis().knots();
        const Interval on = raised->basis().domain();
        double scale = 1;  // of weights, which have to agree where pieces meet
        if (net.empty()) {
            knots.assign(std::size_t(degree) + 1, 0.0);
            net.push_back(own[0]);
        } else {
            const double gap = norm(project(own[0]) - project(net.back()));
            if (!(gap <= std::max(tolerance, kNearEnds * box.diagonal())))
                return refuse(
                    RefusalKind::invalid, f_.label(p.instance),
                    text("begins ", gap, " from where the segment before it ends; the file says at most ",
                         tolerance));
            widest = std::max(widest, gap);
            scale = net.back().weight() / own[0].weight();
        }
        for (std::size_t k = 1; k < own.size(); ++k) net.push_back(scale * own[k]);
        for (std::size_t k = std::size_t(degree) + 1; k < own.size(); ++k)
            knots.push_back(at + (t[k] - on.lo) / on.length() * p.length);
        at += p.length;
        knots.insert(knots.end(), std::size_t(degree), at);
    }
    knots.push_back(at);
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return refuse(basis.error().kind, f_.label(i), basis.error().message);
    const Index<1> extent{int(net.size())};
    if (is_rational) {
        auto made = Curve<Hom<3>>::make({*std::move(basis)}, Net<1, Hom<3>>(extent, std::move(net)));
        if (!made) return refuse(made.error().kind, f_.label(i), made.error().message);
        out.curve = *std::move(made);
    } else {
        std::vector<Vec<3>> points;  // weights are 1
        for (const Hom<3>& p : net) points.push_back(project(p));
        out.curve = Curve<Vec<3>>::trusted({*std::move(basis)}, Net<1, Vec<3>>(extent, std::move(points)));
    }
    if (!is_exact || widest > 0) {
        out.bound += widest + kRounding * largest;
        out.approximated = i;
    }
    return out;
}

}  // namespace freiform::step
