// Clipping by the loops of a face.
//
// Method. Parts of the curve that run along a loop are set aside (loop_runs.cpp); the rest is cut where it
// meets the curves of the loops (curve_curve.hpp: proven roots, overlaps within the tolerance). Between two
// cuts it meets no loop, so that its middle decides, exactly. Cuts that are nearer to each other than
// rounding moves them are one: where a curve leaves through a corner, two curves of the loop have it. u and v
// are multiplied by powers of two, so that lengths in the plane are about those in space, and the tolerance
// means something.
//
// Accuracy. That a middle is in or out is exact for the curve's value there as it is computed.
#include "face_loops_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/intersect/curve_curve.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kOneCut = 0x1p-36;  // of the domain of the curve
// Of the tolerance, that a branch may be from a loop that it runs along: it and its parameters are that far
// from both surfaces each, and a length in the plane is up to twice as long in space.
constexpr double kAlong = 4;

// The part of a coedge's curve as a spline, in the direction of the loop.
Result<CurveGeometry<2>> loop_spline(const Coedge& coedge, Interval on) {
    const auto turned = [&](const auto& curve) -> CurveGeometry<2> {
        return coedge.reversed ? reverse(curve, 0) : curve;
    };
    if (const auto* line = std::get_if<Line<2>>(&coedge.curve)) {
        const auto basis = BSplineBasis::bezier(1, on);
        if (!basis) return std::unexpected(basis.error());
        auto made =
            Curve<Vec<2>>::make({*basis}, Net<1, Vec<2>>({2}, {line->origin + on.lo * line->direction,
                                                               line->origin + on.hi * line->direction}));
        if (!made) return std::unexpected(made.error());
        return turned(*made);
    }
    if (const auto* conic = std::get_if<Conic<2>>(&coedge.curve)) {
        const auto arc = conic_arc(*conic, on);
        if (!arc) return std::unexpected(arc.error());
        return turned(arc->curve);
    }
    const auto part = [&](const auto& spline) -> Result<CurveGeometry<2>> {
        if (spline.domain()[0] == on) return turned(spline);
        const auto cut = restrict_to(spline, 0, on);
        if (!cut) return std::unexpected(cut.error());
        return turned(*cut);
    };
    if (const auto* spline = std::get_if<Curve<Vec<2>>>(&coedge.curve)) return part(*spline);
    return part(std::get<Curve<Hom<2>>>(coedge.curve));
}

Curve<Hom<2>> weighted_curve(const CurveGeometry<2>& spline) {
    if (const auto* c = std::get_if<Curve<Vec<2>>>(&spline)) return to_rational(*c);
    return std::get<Curve<Hom<2>>>(spline);
}
Curve<Hom<2>> in_units(const Curve<Hom<2>>& curve, const Vec<2>& unit) {
    Net<1, Hom<2>> net = curve.net();
    for (Hom<2>& h : net.flat())
        for (int k = 0; k < 2; ++k) h[k] *= unit[k];
    return Curve<Hom<2>>::trusted(curve.bases(), std::move(net));
}
Box<2> box_of_net(const Curve<Hom<2>>& curve) {
    Box<2> box;
    for (const Vec<2>& p : points(curve)) box.add(p);
    return box;
}
Vec<2> end_of(const CurveGeometry<2>& spline, bool last) {
    const Curve<Hom<2>> c = weighted_curve(spline);
    const Interval on = c.domain()[0];
    return c(last ? on.hi : on.lo);
}
// May the curve run through the box? Its pieces are halved until their control points are beside of it, or
// they are as small as roundings.
bool may_pass(const Curve<Hom<2>>& curve, const Box<2>& own, const Box<2>& box) {
    const double more = 0x1p-44 * std::max(own.scale(), box.scale());
    const auto is_beside = [&](const Box<2>& of) {
        for (int k = 0; k < 2; ++k)
            if (of.lo[k] > box.hi[k] + more || box.lo[k] > of.hi[k] + more) return true;
        return false;
    };
    if (is_beside(own)) return false;
    const BezierPieces<1, Hom<2>> pieces(curve);
    std::vector<std::vector<Hom<2>>> open;
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        open.emplace_back();
        for (int k = 0; k < net.extent[0]; ++k) open.back().push_back(net({k}));
    }
    while (!open.empty()) {
        const std::vector<Hom<2>> part = std::move(open.back());
        open.pop_back();
        Box<2> of;
        for (const Hom<2>& h : part) of.add(Space<Hom<2>>::project(h));
        if (is_beside(of)) continue;
        if (max_abs(of.hi - of.lo) <= more || open.size() > 200) return true;
        std::vector<Hom<2>> left(part), right(part);
        const int n = int(part.size());
        keep_left(Fibre<Hom<2>>{left.data(), n, 1}, 0.5);
        keep_right(Fibre<Hom<2>>{right.data(), n, 1}, 0.5);
        open.push_back(std::move(left)), open.push_back(std::move(right));
    }
    return false;
}
bool are_boxes_apart(const Box<2>& a, const Box<2>& b, double by) {
    for (int k = 0; k < 2; ++k)
        if (a.lo[k] > b.hi[k] + by || b.lo[k] > a.hi[k] + by) return true;
    return false;
}

}  // namespace

Result<void> FaceLoops::add(const CurveGeometry<2>& curve, ClippedPart::End place) {
    const Curve<Hom<2>> own = in_units(weighted_curve(curve), unit_);
    trims_.push_back({LoopRail(own), box_of_net(own), place});
    return {};
}

Result<FaceLoops> FaceLoops::make(const Face& face, const std::vector<Edge>& edges, const Vec<2>& stretch) {
    FaceLoops out;
    for (int k = 0; k < 2; ++k)
        out.unit_[k] =
            stretch[k] > 0 && std::isfinite(stretch[k]) ? std::scalbn(1.0, std::ilogb(stretch[k])) : 1;
    std::vector<std::vector<CurveGeometry<2>>> loops;
    double gap = 0;
    for (std::size_t l = 0; l < face.loops.size(); ++l) {
        std::vector<CurveGeometry<2>> loop;
        const auto& coedges = face.loops[l].coedges;
        for (std::size_t c = 0; c < coedges.size(); ++c) {
            auto spline = loop_spline(coedges[c], edges[std::size_t(coedges[c].edge)].range);
            if (!spline) return refuse_within(text("loops[", l, "][", c, "]"), spline.error());
            if (auto ok = out.add(*spline, {int(l), int(c)}); !ok) return std::unexpected(ok.error());
            loop.push_back(std::move(*spline));
        }
        // Joints that are open are closed by segments, as the inside test does.
        for (std::size_t c = 0; c < loop.size(); ++c) {
            const Vec<2> from = end_of(loop[c], true), to = end_of(loop[(c + 1) % loop.size()], false);
            if (from == to) continue;
            gap = std::max(gap, norm(to - from));
            out.trims_.push_back(
                {LoopRail(in_units(to_rational(Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1, {0, 1})},
                                                                      Net<1, Vec<2>>({2}, {from, to}))),
                                   out.unit_)),
                 {},
                 {int(l), -1}});
            out.trims_.back().box = box_of_net(out.trims_.back().curve());
        }
        loops.push_back(std::move(loop));
    }
    if (loops.empty()) return out;
    auto query = InsideQuery::make(loops, 2 * gap);
    if (!query) return std::unexpected(query.error());
    out.query_ = std::move(*query);
    out.loops_ = std::move(loops);
    return out;
}

Result<FaceLoops::AsPath> FaceLoops::path(const Vec<2>& unit, double tolerance) const {
    AsPath out;
    for (const auto& loop : loops_) {
        Subpath all;
        for (const CurveGeometry<2>& curve : loop) {
            auto part = subpath_of(in_units(weighted_curve(curve), unit), tolerance);
            if (!part) return std::unexpected(part.error());
            out.bound = std::max(out.bound, part->bound);
            auto& segments = part->subpath.segments;
            if (segments.empty()) continue;
            if (all.segments.empty())
                all.start = part->subpath.start;
            else if (const Vec<2> end = all.segments.back().back(); !(end == segments.front().front()))
                all.segments.push_back({1, {end, segments.front().front()}});
            all.segments.insert(all.segments.end(), segments.begin(), segments.end());
        }
        if (all.segments.empty()) continue;
        if (const Vec<2> end = all.segments.back().back(); !(end == all.start))
            all.segments.push_back({1, {end, all.start}});
        all.closed = true;
        out.path.subpaths.push_back(std::move(all));
    }
    return out;
}

FaceLoops::Where FaceLoops::place(const Box<2>& box) const {
    if (!query_) return {Place::inside, {}};
    const Vec<2> lo{{box.lo[0] * unit_[0], box.lo[1] * unit_[1]}},
        hi{{box.hi[0] * unit_[0], box.hi[1] * unit_[1]}};
    for (const Trim& trim : trims_)
        if (may_pass(trim.curve(), trim.box, {lo, hi})) return {Place::boundary, trim.place};
    return {is_inside(0.5 * (box.lo + box.hi)) ? Place::inside : Place::outside, {}};
}

Result<std::vector<ClippedPart>> FaceLoops::clip(const Curve<Vec<2>>& curve, double tolerance) const {
    const Interval on = curve.domain()[0];
    if (!query_) return std::vector{ClippedPart{on, {}, false}};
    struct Cut {
        double t;
        std::optional<ClippedPart::End> at;
    };
    std::vector<Cut> cuts{{on.lo, {}}, {on.hi, {}}};
    std::vector<Interval> along;
    const Curve<Hom<2>> own = in_units(to_rational(curve), unit_);
    const Box<2> box = box_of_net(own);
    std::vector<const Trim*> near;
    std::vector<const LoopRail*> rails;
    for (const Trim& trim : trims_)
        if (!are_boxes_apart(box, trim.box, kAlong * tolerance))
            near.push_back(&trim), rails.push_back(&trim.rail);
    std::vector<Vec<2>> net = points(own);
    const int n = int(net.size());
    const auto plain = Curve<Vec<2>>::trusted(own.bases(), Net<1, Vec<2>>({n}, std::move(net)));
    for (const RailRun& run : rail_runs(plain, rails, kAlong * tolerance)) {
        if (run.rail >= 0) {
            along.push_back(run.on);
            const auto place = near[std::size_t(run.rail)]->place;
            cuts.push_back({run.on.lo, place}), cuts.push_back({run.on.hi, place});
            continue;
        }
        const auto part = run.on == on ? Result<Curve<Hom<2>>>(own) : restrict_to(own, 0, run.on);
        if (!part) return std::unexpected(part.error());
        for (const Trim* trim : near) {
            if (are_boxes_apart(box_of_net(*part), trim->box, kAlong * tolerance)) continue;
            const auto found = intersect(*part, trim->curve(), IntersectOptions{.accuracy = tolerance});
            if (!found) return std::unexpected(found.error());
            if (!found->undecided.empty())
                return refuse(RefusalKind::limit, "loops",
                              "are crossed in more places than work is allowed for");
            for (const auto& c : found->contacts) cuts.push_back({c.at[0], trim->place});
            for (const Overlap& o : found->overlaps) {
                along.push_back(o.a);
                cuts.push_back({o.a.lo, trim->place}), cuts.push_back({o.a.hi, trim->place});
            }
        }
    }
    sort(cuts, {}, &Cut::t);
    std::vector<Cut> kept;
    for (const Cut& c : cuts) {
        if (kept.empty() || c.t - kept.back().t > kOneCut * on.length())
            kept.push_back(c);
        else if (!kept.back().at)
            kept.back().at = c.at;
    }
    if (kept.size() > 1 && on.hi - kept.back().t <= kOneCut * on.length()) kept.back().t = on.hi;
    std::vector<ClippedPart> out;
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
        const double middle = Interval{kept[i].t, kept[i + 1].t}.middle();
        const bool runs = std::ranges::any_of(along, [&](const Interval& a) { return a.contains(middle); });
        if (!runs && !is_inside(curve(middle))) continue;
        if (!out.empty() && out.back().on.hi == kept[i].t) {
            out.back().on.hi = kept[i + 1].t, out.back().ends[1] = kept[i + 1].at;
            out.back().along = out.back().along || runs;
        } else {
            out.push_back({{kept[i].t, kept[i + 1].t}, {kept[i].at, kept[i + 1].at}, runs});
        }
    }
    return out;
}

}  // namespace freiform
