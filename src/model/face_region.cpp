// Method. |p(t) - chord| <= h^2 / 8 max |p''| on an interval of length h, for u and v by themselves;
// intervals begin at kinks, and the worst is halved first, so that where there are no more to be had none is
// left coarse. Curve and chord are both in the box of the control points, too, which says more
// where knots are crowded and the interval holds many. Jumps between neighbouring curves become chords of
// their own, so that the polygon is closed and the odd-even rule has a meaning. A point that no fattened
// chord holds is inside the polygon exactly if it is inside the curves: moving the curves to their chords
// along straight lines never meets it.
#include "edge_mesh_detail.hpp"
#include "face_region_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/mesh/segment_box.hpp>
#include <freiform/spline/hull_box.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kRound = 1e-15;  // of the size of the coordinates: evaluated points are off by less

// An interval of a parameter curve, and what the curve may leave its chord by.
struct Piece {
    Interval on;
    Vec<2> sag{};
    double too_much = 0;
};

// In order.
Result<std::vector<Piece>> pieces_of(const CurveGeometry<2>& curve, Interval on,
                                     const FaceRegion::TooMuch& too_much, std::size_t max_chords) {
    const CurveGeometry<1> u = component_of(curve, 0), v = component_of(curve, 1);
    const DerivativeQuery<1, 1> bounds[2] = {DerivativeQuery<1, 1>(u), DerivativeQuery<1, 1>(v)};
    std::vector<double> must{on.lo, on.hi};
    for (const auto& b : bounds)
        for (const Kink& k : b.kinks(0))
            if (on.lo < k.at && k.at < on.hi) must.push_back(k.at);
    sort(must);
    must.erase(std::unique(must.begin(), must.end()), must.end());
    const auto piece = [&](Interval part) {
        const double h2 = part.length() * part.length() / 8;
        Piece out{part, {{h2 * bounds[0]({part})(2), h2 * bounds[1]({part})(2)}}};
        if (const auto hull = hull_box(curve, {part}); hull && is_finite(out.sag))
            for (int i = 0; i < 2; ++i) out.sag[i] = std::min(out.sag[i], hull->side(i).length());
        Box<2> box;
        for (const double t : {part.lo, part.hi}) {
            const Vec<2> p = jet<0>(curve, t).value();
            box.add(p - out.sag), box.add(p + out.sag);
        }
        out.too_much = is_finite(out.sag) ? too_much(box, out.sag) : kInfinity;
        return out;
    };
    std::vector<Piece> heap, out;
    const auto push = [&](Interval part) {
        heap.push_back(piece(part));
        std::ranges::push_heap(heap, {}, &Piece::too_much);
    };
    for (std::size_t i = 0; i + 1 < must.size(); ++i) push({must[i], must[i + 1]});
    while (!heap.empty() && heap.front().too_much > 1 && heap.size() + out.size() < max_chords) {
        std::ranges::pop_heap(heap, {}, &Piece::too_much);
        const Piece worst = heap.back();
        heap.pop_back();
        const double middle = worst.on.middle();
        if (!(worst.on.lo < middle && middle < worst.on.hi)) {
            out.push_back(worst);
            continue;
        }
        push({worst.on.lo, middle});
        push({middle, worst.on.hi});
    }
    out.insert(out.end(), heap.begin(), heap.end());
    sort(out, [](const Piece& a, const Piece& b) { return a.on.lo < b.on.lo; });
    for (const Piece& p : out)
        if (!is_finite(p.sag))
            return refuse(RefusalKind::ill_conditioned, text("t = ", p.on.lo),
                          "the parameter curve has no bounded second derivative here");
    return out;
}

}  // namespace

void FaceRegion::add(const Vec<2>& from, const Vec<2>& to, const Vec<2>& sag) {
    const Vec<2> fat = sag + kRound * Vec<2>{{std::max(std::abs(from[0]), std::abs(to[0])),
                                              std::max(std::abs(from[1]), std::abs(to[1]))}};
    segments_.push_back({int(points_.size()), int(points_.size()) + 1});
    points_.push_back(from);
    points_.push_back(to);
    sags_.push_back(fat);
    for (const Vec<2>& p : {from, to}) {
        box_.add(p - fat);
        box_.add(p + fat);
    }
}

FaceRegion FaceRegion::ready() {
    rows_ = PolygonRows(points_, segments_);
    return std::move(*this);
}

Result<FaceRegion> FaceRegion::rough(const Face& face, const std::vector<Edge>& edges) {
    return make(
        face, edges, [](const Box<2>&, const Vec<2>&) { return 0.0; }, 1);
}

Result<FaceRegion> FaceRegion::make(const Face& face, const std::vector<Edge>& edges, const TooMuch& too_much,
                                    std::size_t max_chords) {
    FaceRegion out;
    const auto on = limits(face.surface);
    if (face.loops.empty()) {
        const auto d = domain(face.surface);
        const Vec<2> corner[4] = {
            {{d[0].lo, d[1].lo}}, {{d[0].hi, d[1].lo}}, {{d[0].hi, d[1].hi}}, {{d[0].lo, d[1].hi}}};
        for (int i = 0; i < 4; ++i)
            if (!is_finite(corner[i]))
                return refuse(RefusalKind::invalid, "loops", "a face without boundary on an endless surface");
        for (int i = 0; i < 4; ++i) out.add(corner[i], corner[(i + 1) % 4], {});
        return out.ready();
    }
    for (std::size_t l = 0; l < face.loops.size(); ++l) {
        std::vector<Vec<2>> ends;  // first and last of each coedge
        for (std::size_t c = 0; c < face.loops[l].coedges.size(); ++c) {
            const Coedge& coedge = face.loops[l].coedges[c];
            const auto pieces =
                pieces_of(coedge.curve, edges[std::size_t(coedge.edge)].range, too_much, max_chords);
            if (!pieces) return refuse_within(text("loops[", l, "][", c, "]"), pieces.error());
            Vec<2> last = clamped(jet<0>(coedge.curve, pieces->front().on.lo).value(), on);
            const Vec<2> first = last;
            for (const Piece& p : *pieces) {
                const Vec<2> next = clamped(jet<0>(coedge.curve, p.on.hi).value(), on);
                out.add(last, next, p.sag);
                last = next;
            }
            ends.push_back(coedge.reversed ? last : first);
            ends.push_back(coedge.reversed ? first : last);
        }
        for (std::size_t k = 1; k < ends.size(); k += 2)
            if (const Vec<2>& next = ends[(k + 1) % ends.size()]; next != ends[k]) out.add(ends[k], next, {});
    }
    return out.ready();
}

bool FaceRegion::meets(const Box<2>& box, std::size_t i) const {
    const Box<2> fat{box.lo - sags_[i], box.hi + sags_[i]};
    return freiform::meets(fat, points_[std::size_t(segments_[i][0])], points_[std::size_t(segments_[i][1])]);
}

}  // namespace freiform
