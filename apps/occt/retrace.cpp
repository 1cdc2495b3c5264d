// Faces by their edges. What parameter curves say can contradict the edges: be open where the edges meet,
// miss them, or run into itself. The edges are what faces share, so such a face gets parameter curves that
// follow those, as faces of STEP files do that have none. It is taken if its boundary closes and does not run
// into itself; then the model says so.
#include "converter.hpp"
#include "geometry.hpp"

#include <freiform/io/face_by_edges.hpp>

#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <algorithm>
#include <cmath>

namespace freiform::occt {

namespace {

constexpr double kOpen = 0.01;  // of a loop's extent in the parameters

bool is_used(const TopoDS_Shape& s, TopAbs_ShapeEnum type) {
    return s.ShapeType() == type && s.Orientation() != TopAbs_INTERNAL && s.Orientation() != TopAbs_EXTERNAL;
}

// Each followed by one that begins where it ends, the next one of the wire if it does; empty where none does.
std::vector<std::vector<EdgeUse>> loops_of(std::vector<EdgeUse> left, const std::vector<Edge>& edges) {
    const auto end_of = [&](const EdgeUse& w, bool last) {
        const Edge& e = edges[std::size_t(w.edge)];
        return last != w.reversed ? e.end : e.start;
    };
    std::vector<std::vector<EdgeUse>> loops;
    while (!left.empty()) {
        std::vector<EdgeUse>& loop = loops.emplace_back();
        loop.push_back(left.front());
        left.erase(left.begin());
        for (;;) {
            const auto next = std::ranges::find_if(
                left, [&](const EdgeUse& w) { return end_of(w, false) == end_of(loop.back(), true); });
            if (next == left.end()) break;
            loop.push_back(*next);
            left.erase(next);
        }
        if (end_of(loop.back(), true) != end_of(loop.front(), false)) return {};
    }
    return loops;
}

}  // namespace

// Whether a loop is open in the parameters, and by more than tolerances in space.
bool Converter::is_open(const Face& f) const {
    constexpr int kSteps = 8;
    constexpr double kTimes = 4;
    const auto tolerance_of = [&](const Coedge& c) {
        const Edge& e = out_.model.edges[std::size_t(c.edge)];
        const auto& v = out_.model.vertices;
        return std::max({e.tolerance, v[std::size_t(e.start)].tolerance, v[std::size_t(e.end)].tolerance});
    };
    const auto limit = limits(f.surface);
    for (const Loop& l : f.loops) {
        Box<2> box;
        for (const Coedge& c : l.coedges) {
            const Interval on = out_.model.edges[std::size_t(c.edge)].range;
            for (int k = 0; k <= kSteps; ++k)
                box.add(jet<0>(c.curve, on.lo + on.length() * k / kSteps).value());
        }
        for (std::size_t i = 0; i < l.coedges.size(); ++i) {
            const Coedge &c = l.coedges[i], &next = l.coedges[(i + 1) % l.coedges.size()];
            const double most = kTimes * std::max({tolerance_of(c), tolerance_of(next), f.tolerance});
            const Vec<2> from = end_of(c, true), by = end_of(next, false) - from;
            if (std::abs(by[0]) <= kOpen * box.side(0).length() &&
                std::abs(by[1]) <= kOpen * box.side(1).length())
                continue;
            const Vec<3> p = jet<0>(f.surface, clamped(from, limit).c).value();
            for (int k = 1; k <= kSteps; ++k)
                if (!(norm(jet<0>(f.surface, clamped(from + double(k) / kSteps * by, limit).c).value() - p) <=
                      most))
                    return true;
        }
    }
    return false;
}

// REQUIRES f oriented forward.
Result<Face> Converter::retraced(const TopoDS_Face& f) {
    const auto no = [](std::string why) { return refuse(RefusalKind::no_answer, "edges", std::move(why)); };
    const Handle(Geom_Surface) s = BRep_Tool::Surface(f);
    if (s.IsNull()) return no("no surface");
    std::vector<std::vector<EdgeUse>> loops;
    for (TopoDS_Iterator w(f); w.More(); w.Next()) {
        if (!is_used(w.Value(), TopAbs_WIRE)) continue;
        std::vector<EdgeUse> ways;
        for (TopoDS_Iterator i(w.Value()); i.More(); i.Next()) {
            if (!is_used(i.Value(), TopAbs_EDGE)) continue;
            const TopoDS_Edge e = TopoDS::Edge(i.Value());
            if (BRep_Tool::Degenerated(e)) continue;
            const auto made = edge(e, f);
            if (!made || !out_.model.edges[std::size_t(*made)].curve) return no("an edge without a curve");
            ways.push_back({*made, e.Orientation() == TopAbs_REVERSED});
        }
        if (ways.empty()) continue;
        auto in_order = loops_of(std::move(ways), out_.model.edges);
        if (in_order.empty()) return no("edges that do not meet");
        std::ranges::move(in_order, std::back_inserter(loops));
    }
    if (loops.empty()) return no("no edges");

    std::array<Interval, 2> on{Interval{0, 1}, Interval{0, 1}};
    Vec<2> lo, hi;
    s->Bounds(lo[0], hi[0], lo[1], hi[1]);
    for (int d = 0; d < 2; ++d)
        if (!Precision::IsInfinite(lo[d]) && !Precision::IsInfinite(hi[d]))
            on[std::size_t(d)] = {lo[d], hi[d]};
    const auto converted = surface(s, on);
    if (!converted) return std::unexpected(converted.error());

    const double close = std::max(BRep_Tool::Tolerance(f), document_.resolution);
    const std::size_t edges = out_.model.edges.size(), vertices = out_.model.vertices.size();
    auto out = face_by_edges(out_.model, *converted, loops, close);
    if (!out) return out;
    if (is_open(*out) || enclose_less_than_nothing(out->loops, out_.model.edges)) {
        out_.model.edges.resize(edges), out_.model.vertices.resize(vertices);
        return no("no boundary");
    }
    out->tolerance = BRep_Tool::Tolerance(f);
    for (std::size_t k = edges; k < out_.model.edges.size(); ++k) {  // seams and poles
        stated_.push_back(out_.model.edges[k].tolerance);
        out_.edges.push_back({});
    }
    return out;
}

}  // namespace freiform::occt
