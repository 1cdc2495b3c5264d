// Surfaces that stand for faces. CURVE_BOUNDED_SURFACE: boundaries that are composite curves instead of loops
// of edges. Each segment becomes
// an edge; what two boundaries share as one instance is one edge. Corners are points that agree within the
// tolerance.
#include "step_shape.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::step {

Result<ShapeReader::EdgeMade> ShapeReader::segment_edge(std::uint32_t curve, std::vector<int>& corners) {
    if (const auto known = edges_.find(curve); known != edges_.end()) {
        if (!known->second) return known->second;
        if (known->second->edge < 0)
            return refuse(RefusalKind::invalid, f_.label(curve),
                          "is a segment of a boundary without a length");
        const Edge& e = out_.model.edges[std::size_t(known->second->edge)];
        corners.insert(corners.end(), {e.start, e.end});
        return known->second;
    }
    const auto c = curve_in_space(curve, nullptr);
    if (!c) return std::unexpected(c.error());
    const Interval on = c->range.value_or(domain(c->curve)[0]);
    if (!std::isfinite(on.length()) || !(on.lo < on.hi))
        return refuse(RefusalKind::invalid, f_.label(curve), "is a segment of a boundary without an end");
    const auto corner = [&](double t) {
        const Vec<3> p = jet<0>(c->curve, t).value();
        const auto near = [&](int v) {
            return norm(out_.model.vertices[std::size_t(v)].point - p) <= tolerance_;
        };
        if (const auto at = std::find_if(corners.begin(), corners.end(), near); at != corners.end())
            return *at;
        out_.model.vertices.push_back({p, tolerance_});
        corners.push_back(int(out_.model.vertices.size()) - 1);
        vertex_of_.emplace(corners.back(), curve);
        return corners.back();
    };
    Edge e;
    e.curve = c->curve;
    e.range = on;
    e.tolerance = tolerance_;
    e.start = corner(on.lo);
    e.end = corner(on.hi);
    EdgeMade made;
    made.flipped = c->reversed;
    made.curve = curve;
    made.edge = int(out_.model.edges.size());
    out_.model.edges.push_back(std::move(e));
    edges_.emplace(curve, made);
    return made;
}

Result<void> ShapeReader::add_boundary_curve(std::uint32_t i, const Chart& chart, LoopBuilder& loops) {
    const auto segments = segments_in(f_, i);
    if (!segments) return std::unexpected(segments.error());
    const auto refused = [&](std::string_view what) {
        return refuse(RefusalKind::invalid, f_.label(i), text(what, " (byte ", f_.instances[i].at, ")"));
    };
    struct Along {
        EdgeMade made;
        bool forward;
        std::uint32_t segment;
    };
    std::vector<Along> list;
    std::vector<int> corners;
    Box<3> box;
    // Corners that other boundaries have made, before new ones are.
    for (const CompositeSegment& s : *segments) {
        const auto known = edges_.find(s.curve);
        if (known != edges_.end() && known->second && known->second->edge >= 0) {
            const Edge& e = out_.model.edges[std::size_t(known->second->edge)];
            corners.insert(corners.end(), {e.start, e.end});
        }
    }
    for (const CompositeSegment& s : *segments) {
        const auto made = segment_edge(s.curve, corners);
        if (!made) return std::unexpected(made.error());
        list.push_back({*made, s.forward, s.instance});
        const Edge& e = out_.model.edges[std::size_t(made->edge)];
        for (int k = 0; k <= 4; ++k) box.add(jet<0>(*e.curve, e.range.lo + e.range.length() * k / 4).value());
    }
    const double joint = std::max(2 * tolerance_, kDigits * box.diagonal());
    const auto apart = [&](int a, int b) {
        const auto& v = out_.model.vertices;
        return norm(v[std::size_t(a)].point - v[std::size_t(b)].point);
    };
    std::vector<Use> uses;
    for (const Along& a : list) {
        auto u = use_of(a.made, a.forward, chart, box.diagonal());
        if (!u)
            return refuse(u.error().kind, f_.label(a.segment),
                          text(u.error().where, ": ", u.error().message));
        uses.push_back(std::move(*u));
    }
    // Segments whose sense is wrong: the first by the second, each other one by what comes before it.
    for (std::size_t k = 0; uses.size() > 1 && k < uses.size(); ++k) {
        Use& u = uses[k];
        const bool first = k == 0;
        const Use& other = uses[first ? 1 : k - 1];
        const bool fits = first ? std::min(apart(u.to, other.from), apart(u.to, other.to)) <= joint
                                : apart(other.to, u.from) <= joint;
        if (fits) continue;
        const bool turned = first ? std::min(apart(u.from, other.from), apart(u.from, other.to)) <= joint
                                  : apart(other.to, u.to) <= joint;
        if (!turned) return refused("is a boundary whose segments do not follow each other");
        u.coedge.reversed = !u.coedge.reversed;
        std::swap(u.from, u.to), std::swap(u.start, u.end);
        report(u.coedge.edge,
               text(f_.label(list[k].segment), " runs against its boundary; it is taken the other way"), 0.0,
               0);
    }
    if (uses.empty() || apart(uses.back().to, uses.front().from) > joint)
        return refused("is a boundary that is not closed");
    for (std::size_t k = 0; k < uses.size(); ++k) join_vertices(uses[k].to, uses[(k + 1) % uses.size()].from);
    loops.add(std::move(uses));
    return {};
}

// A surface that stands for a face: RECTANGULAR_TRIMMED_SURFACE, CURVE_BOUNDED_SURFACE, or any that ends.
Result<Face> ShapeReader::bare_face(std::uint32_t i) {
    const auto s = surface(i);
    if (!s) return std::unexpected(s.error());
    const Chart& chart = *(*s)->chart;
    LoopBuilder loops(chart, out_.model, tolerance_);
    std::array<Interval, 2> on = chart.whole();
    if (f_.is(i, Type::CURVE_BOUNDED_SURFACE)) {
        const auto f = Fields::of(f_, i, Type::CURVE_BOUNDED_SURFACE, 4);
        if (!f) return std::unexpected(f.error());
        const auto boundaries = f->references(2, "boundaries");
        if (!boundaries) return std::unexpected(boundaries.error());
        for (const std::uint32_t b : *boundaries)
            if (auto ok = add_boundary_curve(b, chart, loops); !ok) return std::unexpected(ok.error());
        Face face;
        face.tolerance = tolerance_;
        if (!f->flag(3)) return close_face(std::move(face), loops, chart, i, 0);
    }
    if (f_.is(i, Type::RECTANGULAR_TRIMMED_SURFACE)) {
        const auto f = Fields::of(f_, i, Type::RECTANGULAR_TRIMMED_SURFACE, 6);
        if (!f) return std::unexpected(f.error());
        std::array<double, 4> t{};
        for (int k = 0; k < 4; ++k) {
            const auto x = f->number(2 + k, "trim");
            if (!x) return std::unexpected(x.error());
            const bool turns = chart.period(k / 2) > 0 && !chart.is_spline(k / 2);
            t[std::size_t(k)] = *x * (turns ? geometry_.angle : 1);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            on[k] = {std::min(t[2 * k], t[2 * k + 1]), std::max(t[2 * k], t[2 * k + 1])};
            if (!(on[k].lo < on[k].hi)) return f->refused("is trimmed to nothing", RefusalKind::invalid);
        }
    }
    if (!std::isfinite(on[0].length()) || !std::isfinite(on[1].length()))
        return refuse(RefusalKind::unsupported, f_.label(i),
                      "is a surface without end, and bounded by nothing");
    loops.add_rectangle(on);
    Face face;
    face.tolerance = tolerance_;
    return close_face(std::move(face), loops, chart, i, 0);
}

}  // namespace freiform::step
