// Loops. The order of the edges in a wire is not to be relied upon, and two edges of a wire may have the same
// two vertices (a seam and the circles at its ends). So a loop is put together: each edge is followed by one
// that begins at the vertex where it ends, and among several by the one whose parameter curve begins nearest
// to where its own ends.
#include "converter.hpp"
#include "geometry.hpp"

#include <freiform/model/edge_gap.hpp>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <limits>
#include <map>

namespace freiform::occt {

namespace {

Vec<3> vec(const gp_Pnt& p) { return {{p.X(), p.Y(), p.Z()}}; }

// A box that contains the curve over the range.
void add_hull(Box<2>& box, const CurveGeometry<2>& c, Interval range) {
    if (const auto* conic = std::get_if<Conic<2>>(&c); conic && conic->kind == ConicKind::ellipse)
        for (double x : {-1.0, 1.0})
            for (double y : {-1.0, 1.0}) box.add(conic->centre + x * conic->x + y * conic->y);
    for (int i = 0; i <= 16; ++i) box.add(jet<0>(c, range.lo + range.length() * i / 16).value());
    std::visit(
        [&](const auto& g) {
            if constexpr (requires { g.net(); })
                for (const auto& p : points(g)) box.add(p);
        },
        c);
}

constexpr double kRounding = 1e-12;  // of the range of an edge
constexpr double kNoBound = std::numeric_limits<double>::infinity();

// How far the stretched curve is from the curve, whose end stands for what lies beyond it: seen as an edge
// beside the extrusion of the curve.
double stretch_bound(const CurveGeometry<3>& curve, const CurveGeometry<3>& stretched, Interval range) {
    const SurfaceGeometry surface = Extrusion{curve, {{1, 0, 0}}};
    return edge_gap(DerivativeQuery<2, 3>(surface), Line<2>{{{0, 0}}, {{1, 0}}}, stretched, range, {}).bound;
}

}  // namespace

int Converter::vertex(const TopoDS_Vertex& v) {
    if (int i = 0; vertices_.Find(v, i)) return i;
    const int i = int(out_.model.vertices.size());
    out_.model.vertices.push_back({vec(BRep_Tool::Pnt(v)), BRep_Tool::Tolerance(v)});
    vertices_.Bind(v, i);
    return i;
}

// The edge in the model. `f`: a face that it bounds, for edges without a curve in space.
Result<int> Converter::edge(const TopoDS_Edge& oriented, const TopoDS_Face& f) {
    const auto e = TopoDS::Edge(oriented.Oriented(TopAbs_FORWARD));
    if (int i = 0; edges_.Find(e, i)) return i;
    Edge made;
    made.tolerance = std::max(BRep_Tool::Tolerance(e), document_.resolution);
    double lo = 0, hi = 0;
    made.degenerate = BRep_Tool::Degenerated(e);
    const Handle(Geom_Curve) c = made.degenerate ? Handle(Geom_Curve)() : BRep_Tool::Curve(e, lo, hi);
    if (c.IsNull() && !f.IsNull()) BRep_Tool::Range(e, f, lo, hi);
    made.range = {lo, hi};
    if (Precision::IsInfinite(lo) || Precision::IsInfinite(hi) || !(lo < hi))
        return refuse(RefusalKind::invalid, "edge", text("runs over [", lo, ", ", hi, "]"));
    if (!c.IsNull()) {
        auto converted = curve(c, made.range);
        if (converted) {
            made.curve = *converted;
            if (const double by = stretch_to(*made.curve, made.range); by > kRounding * (hi - lo))
                report(int(out_.model.edges.size()),
                       text("its curve ends ", by,
                            " (in the parameter) before the edge does and is stretched; beyond its end it "
                            "stands for its end"),
                       stretch_bound(*converted, *made.curve, made.range), made.tolerance);
        } else if (converted.error().kind != RefusalKind::unsupported || f.IsNull())
            return std::unexpected(converted.error());
        else
            report(int(out_.model.edges.size()),
                   text(converted.error().message,
                        "; its parameter curve on a face takes its place, within the tolerance that the file "
                        "states"),
                   kNoBound, made.tolerance);
    }
    const TopoDS_Vertex first = TopExp::FirstVertex(e), last = TopExp::LastVertex(e);
    const auto end = [&](const TopoDS_Vertex& v, double t) {
        if (!v.IsNull()) return vertex(v);
        const Vec<3> p = c.IsNull() ? Vec<3>{} : vec(c->Value(t));
        for (const TopoDS_Vertex& other : {first, last})
            if (!other.IsNull() && norm(vec(BRep_Tool::Pnt(other)) - p) <= BRep_Tool::Tolerance(other))
                return vertex(other);
        out_.model.vertices.push_back({p, made.tolerance});
        return int(out_.model.vertices.size()) - 1;
    };
    if (first.IsNull() && last.IsNull() && c.IsNull())
        return refuse(RefusalKind::invalid, "edge", "has neither vertices nor a curve");
    made.start = end(first, lo);
    const bool closed = !c.IsNull() && last.IsNull() && first.IsNull() &&
                        c->Value(lo).Distance(c->Value(hi)) <= made.tolerance;
    made.end = made.degenerate || closed ? made.start : end(last, hi);
    const int i = int(out_.model.edges.size());
    stated_.push_back(made.tolerance);
    out_.model.edges.push_back(std::move(made));
    out_.edges.push_back(e);
    edges_.Bind(e, i);
    return i;
}

Result<Piece> Converter::piece(const TopoDS_Edge& e, const TopoDS_Face& f, const Handle(Geom_Plane) & plane) {
    auto index = edge(e, f);
    if (!index) return std::unexpected(index.error());
    Piece p;
    p.coedge.edge = *index;
    p.coedge.reversed = e.Orientation() == TopAbs_REVERSED;
    const Edge& in_space = out_.model.edges[std::size_t(*index)];
    if (!plane.IsNull() && in_space.curve) {
        p.coedge.curve = in_plane(*in_space.curve, plane->Pln());
    } else {
        double lo = 0, hi = 0;
        const Handle(Geom2d_Curve) c = BRep_Tool::CurveOnSurface(e, f, lo, hi);
        if (c.IsNull()) return refuse(RefusalKind::invalid, "edge", "has no parameter curve on the face");
        if (Precision::IsInfinite(lo) || Precision::IsInfinite(hi) || !(lo < hi))
            return refuse(RefusalKind::invalid, "parameter curve", text("runs over [", lo, ", ", hi, "]"));
        auto converted = curve(c, Interval{lo, hi});
        if (converted) converted = reparametrised(*converted, {lo, hi}, in_space.range);
        if (!converted) return refuse_within("parameter curve", converted.error());
        if (stretch_to(*converted, in_space.range) > kRounding * in_space.range.length())
            stretched_.push_back({p.coedge.edge, p.coedge.reversed});
        p.coedge.curve = std::move(*converted);
    }
    p.from = in_space.start, p.to = in_space.end;
    p.start = jet<0>(p.coedge.curve, in_space.range.lo).value();
    p.end = jet<0>(p.coedge.curve, in_space.range.hi).value();
    if (p.coedge.reversed) std::swap(p.from, p.to), std::swap(p.start, p.end);
    return p;
}

// The first loop of the pieces of a wire; further ones go to `more`.
Result<Loop> Converter::loop_of(std::vector<Piece> pieces, std::vector<Loop>& more) {
    std::vector<Loop> loops;
    while (!pieces.empty()) {
        Loop loop;
        Piece last = std::move(pieces.front());
        pieces.erase(pieces.begin());
        const int begin = last.from;
        const Vec<2> begin_uv = last.start;
        loop.coedges.push_back(last.coedge);
        for (;;) {
            std::size_t best = pieces.size();
            double best_distance = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < pieces.size(); ++i)
                if (pieces[i].from == last.to)
                    if (const double d = norm(pieces[i].start - last.end); d < best_distance)
                        best = i, best_distance = d;
            // Back at the beginning, and nearer to it than to what else begins here.
            if (last.to == begin && !(best_distance < norm(begin_uv - last.end))) break;
            if (best == pieces.size())
                return refuse(RefusalKind::invalid, "wire",
                              text("is not closed: nothing follows its edge ", loop.coedges.size(), " of ",
                                   loop.coedges.size() + pieces.size()));
            last = std::move(pieces[best]);
            pieces.erase(pieces.begin() + std::ptrdiff_t(best));
            loop.coedges.push_back(last.coedge);
        }
        loops.push_back(std::move(loop));
    }
    for (std::size_t i = 1; i < loops.size(); ++i) more.push_back(std::move(loops[i]));
    return std::move(loops.front());
}

namespace {

Handle(Geom_Plane) as_plane(Handle(Geom_Surface) s) {
    while (!s.IsNull() && s->IsKind(STANDARD_TYPE(Geom_RectangularTrimmedSurface)))
        s = Handle(Geom_RectangularTrimmedSurface)::DownCast(s)->BasisSurface();
    return Handle(Geom_Plane)::DownCast(s);
}

}  // namespace

// Whether the piece is a degenerate edge where there is one already: the reader has added both, then.
bool Converter::is_second_pole(const Piece& p, const std::vector<Piece>& pieces) const {
    const auto is_degenerate = [&](const Piece& x) {
        return out_.model.edges[std::size_t(x.coedge.edge)].degenerate;
    };
    return is_degenerate(p) && std::any_of(pieces.begin(), pieces.end(), [&](const Piece& q) {
               return is_degenerate(q) && q.from == p.from;
           });
}

Vec<2> Converter::end_of(const Coedge& c, bool last) const {
    const Interval on = out_.model.edges[std::size_t(c.edge)].range;
    return jet<0>(c.curve, last != c.reversed ? on.hi : on.lo).value();
}

// A degenerate edge from the end of one coedge to the beginning of the next.
Coedge Converter::pole_between(const Coedge& before, const Coedge& after) {
    const Edge& e = out_.model.edges[std::size_t(before.edge)];
    Edge made;
    made.degenerate = true;
    made.range = {0, 1};
    made.start = made.end = before.reversed ? e.start : e.end;
    made.tolerance = e.tolerance;
    const Vec<2> from = end_of(before, true);
    stated_.push_back(made.tolerance);
    out_.edges.push_back({});
    out_.model.edges.push_back(std::move(made));
    return Coedge{int(out_.model.edges.size()) - 1, false, Line<2>{from, end_of(after, false) - from}};
}

// Where a loop goes on elsewhere in the parameters, at the same point of the surface, the file lacks the
// degenerate edge between.
void Converter::add_poles(Loop& loop, const Handle(Geom_Surface) & s, double close) {
    constexpr int kSteps = 8;
    constexpr double kFar = 0.01;  // of the loop's extent
    Box<2> box;
    for (const Coedge& c : loop.coedges) {
        const Interval on = out_.model.edges[std::size_t(c.edge)].range;
        for (int k = 0; k <= kSteps; ++k) box.add(jet<0>(c.curve, on.lo + on.length() * k / kSteps).value());
    }
    for (std::size_t i = 0; i < loop.coedges.size(); ++i) {
        const std::size_t next = (i + 1) % loop.coedges.size();
        const Vec<2> from = end_of(loop.coedges[i], true), by = end_of(loop.coedges[next], false) - from;
        if (std::abs(by[0]) <= kFar * box.side(0).length() && std::abs(by[1]) <= kFar * box.side(1).length())
            continue;
        bool is_point = true;
        for (int k = 1; k <= kSteps && is_point; ++k) {
            const Vec<2> there = from + double(k) / kSteps * by;
            is_point = s->Value(from[0], from[1]).Distance(s->Value(there[0], there[1])) <= close;
        }
        if (!is_point) continue;
        const Coedge between = pole_between(loop.coedges[i], loop.coedges[next]);
        loop.coedges.insert(loop.coedges.begin() + std::ptrdiff_t(++i), between);
    }
}

// Moves one side of the seam by a period, so that the boundary runs round all of the surface, with the poles
// between the sides.
void Converter::open_slit(Loop& loop, const Slit& slit) {
    std::rotate(loop.coedges.begin(), loop.coedges.begin() + std::ptrdiff_t(slit.turn), loop.coedges.end());
    const int along = 1 - slit.axis;
    const auto runs_up = [&](const Coedge& c) { return end_of(c, true)[along] > end_of(c, false)[along]; };
    // The face is on the left: u = u0 + period runs up, v = v0 + period down.
    for (Coedge& c : loop.coedges)
        if (runs_up(c) == (slit.axis == 0)) {
            Vec<2> by{};
            by[slit.axis] = slit.period;
            c.curve = translated(c.curve, by);
        }
    for (std::size_t i = 0; i < loop.coedges.size(); ++i) {
        const std::size_t next = (i + 1) % loop.coedges.size();
        if (runs_up(loop.coedges[i]) == runs_up(loop.coedges[next])) continue;
        const Coedge between = pole_between(loop.coedges[i], loop.coedges[next]);
        loop.coedges.insert(loop.coedges.begin() + std::ptrdiff_t(++i), between);
    }
}

// The surface of the face, if it is closed all around and no other face lies on it: the reader may have made
// two of one, and another one has the loops then that this one lacks.
std::optional<Face> Converter::all_of(const TopoDS_Face& f, std::string_view where) {
    TopLoc_Location at;
    const Handle(Geom_Surface) own = BRep_Tool::Surface(f, at);
    int on_it = 0;
    for (const Part& part : document_.parts)
        for (TopExp_Explorer i(part.shape, TopAbs_FACE); i.More(); i.Next())
            on_it += BRep_Tool::Surface(TopoDS::Face(i.Current()), at) == own ? 1 : 0;
    BRepBuilderAPI_MakeFace bounded(BRep_Tool::Surface(f), Precision::Confusion());
    if (on_it > 1 || !bounded.IsDone()) return std::nullopt;
    auto made = geometry_of(TopoDS::Face(bounded.Face().Oriented(TopAbs_FORWARD)), where, false);
    if (!made) return std::nullopt;
    std::map<int, int> uses;
    for (const Loop& l : made->loops)
        for (const Coedge& c : l.coedges)
            if (!out_.model.edges[std::size_t(c.edge)].degenerate) ++uses[c.edge];
    if (std::ranges::any_of(uses, [](const auto& u) { return u.second != 2; })) return std::nullopt;
    report(-1, "its loop encloses nothing, and its surface is closed; all of that is taken", 0, 0);
    out_.model.approximations.back().where = where;
    return std::move(*made);
}

// REQUIRES f oriented forward.
Result<Face> Converter::geometry_of(const TopoDS_Face& f, std::string_view where, bool may_be_all) {
    const Handle(Geom_Surface) s = BRep_Tool::Surface(f);
    if (s.IsNull()) return refuse(RefusalKind::unsupported, "face", "has no surface (only triangles)");
    const Handle(Geom_Plane) plane = as_plane(s);
    Face out;
    out.tolerance = BRep_Tool::Tolerance(f);
    Box<2> used;
    stretched_.clear();
    for (TopoDS_Iterator w(f); w.More(); w.Next()) {
        if (w.Value().ShapeType() != TopAbs_WIRE || w.Value().Orientation() == TopAbs_INTERNAL ||
            w.Value().Orientation() == TopAbs_EXTERNAL)
            continue;
        std::vector<Piece> pieces;
        for (TopoDS_Iterator i(w.Value()); i.More(); i.Next()) {
            if (i.Value().ShapeType() != TopAbs_EDGE || i.Value().Orientation() == TopAbs_INTERNAL ||
                i.Value().Orientation() == TopAbs_EXTERNAL)
                continue;
            auto p = piece(TopoDS::Edge(i.Value()), f, plane);
            if (!p) return std::unexpected(p.error());
            if (is_second_pole(*p, pieces)) ++out_.doubts;
            pieces.push_back(std::move(*p));
        }
        if (pieces.empty()) continue;
        std::vector<Loop> more;
        auto loop = loop_of(std::move(pieces), more);
        if (!loop) return std::unexpected(loop.error());
        out.loops.push_back(std::move(*loop));
        std::move(more.begin(), more.end(), std::back_inserter(out.loops));
    }
    if (out.loops.empty())
        return refuse(RefusalKind::unsupported, "face",
                      "has no boundary, and its surface has none that could take its place");
    const std::array<double, 2> period{s->IsUPeriodic() ? s->UPeriod() : 0,
                                       s->IsVPeriodic() ? s->VPeriod() : 0};
    const double close = std::max(out.tolerance, document_.resolution);
    if (out.loops.size() == 1) {
        if (const auto slit = slit_of(out.loops[0], out_.model.edges, s, period, close))
            open_slit(out.loops[0], *slit);
        else if (may_be_all && is_slit(out.loops[0], out_.model.edges, s))
            if (auto all = all_of(f, where)) return std::move(*all);
    }
    for (Loop& loop : out.loops) {
        swap_sides(loop, out_.model.edges, period);
        remove_bridges(loop, out_.model.edges, period);
        add_poles(loop, s, close);
        for (const Coedge& c : loop.coedges)
            add_hull(used, c.curve, out_.model.edges[std::size_t(c.edge)].range);
    }
    if (enclose_less_than_nothing(out.loops, out_.model.edges)) {
        ++out_.doubts;
        report(-1,
               "its loops run the wrong way around it, or one around them is missing; what they enclose is "
               "taken as it stands",
               0, 0);
        out_.model.approximations.back().where = where;
    }
    auto converted = surface(s, {used.side(0), used.side(1)});
    if (!converted) return std::unexpected(converted.error());
    out.surface = std::move(*converted);
    return out;
}

}  // namespace freiform::occt
