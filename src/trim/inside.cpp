// The winding number as a sum over the Bezier pieces of the loops, each of which is exact
// (poly/arc_index.hpp). Most pieces are decided by their box: above and below the point they cross nothing;
// beside it only the signs at their ends count, which arc_index finds at once.
#include <freiform/core/parallel.hpp>
#include <freiform/poly/arc_index.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/trim/inside.hpp>

#include <cmath>

namespace freiform {

namespace {

using Piece = std::variant<std::vector<Vec<2>>, std::vector<Hom<2>>>;

// Appends a spline as its Bezier pieces. Neighbours begin and end in the same numbers, unless the spline
// jumps there: what they have in common was computed twice, and rounded.
template <class P>
void append(std::vector<Piece>& chain, const Curve<P>& c) {
    const auto pieces = decompose(c);
    const int count = pieces.extent()[0];
    std::vector<std::vector<P>> nets;
    for (int i = 0; i < count; ++i) {
        const auto net = pieces.net({i});
        nets.emplace_back(net.data, net.data + net.extent[0]);
        const double at = pieces.breaks(0)[std::size_t(i)];
        if (i > 0 && c.basis().multiplicity(at) <= c.basis().degree())
            nets.back().front() = nets[std::size_t(i) - 1].back();
    }
    if (c.basis().is_closed() && c.basis().multiplicity(c.basis().domain().lo) <= c.basis().degree())
        nets.front().front() = nets.back().back();
    for (auto& net : nets) chain.push_back(std::move(net));
}

Hom<2> lifted(const Vec<2>& p) { return weighted(p, 1); }
Hom<2> lifted(const Hom<2>& p) { return p; }
Hom<2> start_of(const Piece& piece) {
    return std::visit([](const auto& net) { return lifted(net.front()); }, piece);
}
Hom<2> end_of(const Piece& piece) {
    return std::visit([](const auto& net) { return lifted(net.back()); }, piece);
}

}  // namespace

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
        const auto& loop = loops[l];
        const auto at = [&](std::size_t c) { return text("loops[", l, "][", c, "]"); };
        if (loop.empty()) return refuse(RefusalKind::invalid, text("loops[", l, "]"), "has no curves");
        std::vector<Piece> chain;
        for (std::size_t c = 0; c < loop.size(); ++c) {
            if (auto ok = check(loop[c]); !ok) return refuse_within(at(c), ok.error());
            const auto* conic = std::get_if<Conic<2>>(&loop[c]);
            if (conic && conic->kind == ConicKind::ellipse && loop.size() == 1)
                query.ellipses_.push_back({conic->centre, conic->x, conic->y});
            else if (const auto* s = std::get_if<Curve<Vec<2>>>(&loop[c]))
                append(chain, *s);
            else if (const auto* r = std::get_if<Curve<Hom<2>>>(&loop[c]))
                append(chain, *r);
            else
                return refuse(
                    RefusalKind::unsupported, at(c),
                    text("is a ", kind_name(loop[c]), "; a loop is made of splines, or is one ellipse"));
        }
        for (std::size_t i = 0; i < chain.size(); ++i) {
            std::visit([&](const auto& net) { query.add_arc(std::span(net)); }, chain[i]);
            const Hom<2> end = end_of(chain[i]), start = start_of(chain[(i + 1) % chain.size()]);
            if (end == start) continue;
            const Vec<2> p = project(end), q = project(start);
            if (const double distance = norm(q - p); !(distance <= gap))
                return refuse(RefusalKind::invalid, text("loops[", l, "]"),
                              text("the loop is open: from the end of piece ", i, " at (", p[0], ", ", p[1],
                                   ") to the start of the next it is ", distance, ", allowed is ", gap));
            query.add_arc(std::span<const Hom<2>>(std::array{end, start}));
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
