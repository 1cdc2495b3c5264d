// The winding number as a sum over the Bezier pieces of the loops, each of which is exact
// (poly/arc_index.hpp). Most pieces are decided by their box: above and below the point they cross nothing;
// beside it only the signs at their ends count, which arc_index finds at once.
#include "trim/chain_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/poly/arc_index.hpp>
#include <freiform/trim/inside.hpp>

#include <cmath>

namespace freiform {

void InsideQuery::add_arc(std::span<const Vec<2>> net) {
    Arc arc{{}, int(x_.size()), int(net.size()), false};
    for (const Vec<2>& p : net) {
        x_.push_back(p[0]), y_.push_back(p[1]), w_.push_back(1);
        arc.box.add(p);
    }
    arcs_.push_back(arc);
}

// The box contains the projected points, whose divisions are off by half a unit in the last place.
void InsideQuery::add_arc(std::span<const Hom<2>> net) {
    Arc arc{{}, int(x_.size()), int(net.size()), true};
    for (const Hom<2>& p : net) {
        x_.push_back(p[0]), y_.push_back(p[1]), w_.push_back(p[2]);
        const Vec<2> q = project(p);
        Vec<2> lo, hi;
        for (int d = 0; d < 2; ++d)
            lo[d] = std::nextafter(q[d], -INFINITY), hi[d] = std::nextafter(q[d], INFINITY);
        arc.box.add(lo), arc.box.add(hi);
    }
    arcs_.push_back(arc);
}

Result<InsideQuery> InsideQuery::make(std::span<const std::vector<CurveGeometry<2>>> loops, double gap) {
    InsideQuery query;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const auto chain = detail::chain_of(loops[l], gap);
        if (!chain) return refuse_within(text("loops[", l, "]"), chain.error());
        if (const Conic<2>* e = detail::ellipse_of(loops[l]))
            query.ellipses_.push_back({e->centre, e->x, e->y});
        for (std::size_t i = 0; i < chain->size(); ++i) {
            visit_one([&](const auto& net) { query.add_arc(std::span(net)); }, (*chain)[i].net);
            const Hom<2> end = (*chain)[i].end(), start = (*chain)[(i + 1) % chain->size()].start();
            if (end != start) query.add_arc(std::span<const Hom<2>>(std::array{end, start}));
        }
    }
    return query;
}

Inside InsideQuery::at(const Vec<2>& q) const {
    if (!is_finite(q)) return {};
    int quarters = 0, winding = 0;
    for (const Ellipse& e : ellipses_) {
        const int side = ellipse_side(e.centre, e.x, e.y, q);
        if (side == 0) return {Place::boundary, 0};
        if (side > 0) winding += cross(e.x, e.y) > 0 ? 1 : -1;
    }
    for (const Arc& a : arcs_) {
        if (q[1] < a.box.lo[1] || q[1] > a.box.hi[1]) continue;
        const auto part = [&](const std::vector<double>& v) {
            return std::span(v).subspan(std::size_t(a.first), std::size_t(a.size));
        };
        const ArcIndex i =
            arc_index(part(x_), part(y_), a.rational ? part(w_) : std::span<const double>(), q);
        if (i.through) return {Place::boundary, 0};
        quarters += i.quarters;
    }
    winding += quarters / 4;
    return {winding % 2 != 0 ? Place::inside : Place::outside, winding};
}

void InsideQuery::at(std::span<const Vec<2>> points, std::span<Inside> out) const {
    FF_REQUIRE(points.size() == out.size());
    constexpr std::size_t kChunk = 256;
    parallel_for((points.size() + kChunk - 1) / kChunk, 4, [&](std::size_t c) {
        for (std::size_t i = c * kChunk; i < std::min(points.size(), (c + 1) * kChunk); ++i)
            out[i] = at(points[i]);
    });
}

}  // namespace freiform
