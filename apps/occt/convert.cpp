// Idea. Every shape is looked up in maps that know shape and place, so that what two faces share in the file
// they share in the model. A face is taken oriented forward: then its parameter curves run with the loops as
// our odd-even rule wants them, and the orientation of the face becomes a flag.
//
// Loops. The order of the edges in a wire is not to be relied upon, and two edges of a wire may have the same
// two vertices (a seam and the circles at its ends). So a loop is put together: each edge is followed by one
// that begins at the vertex where it ends, and among several by the one whose parameter curve begins nearest
// to where its own ends.
//
// Tolerances. A file promises that the curve of an edge and the images of its parameter curves agree within
// the tolerance of the edge. Samples tell where that may not hold and where a better parameter curve is worth
// its time; whatever is then replaced or raised gets a proven bound (model/edge_gap), and the model says so.
#include "convert.hpp"

#include "geometry.hpp"
#include "refit.hpp"

#include <freiform/model/edge_gap.hpp>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepClass3d.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <NCollection_DataMap.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace freiform::occt {

namespace {

using IndexMap = NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher>;

Vec<3> vec(const gp_Pnt& p) { return {{p.X(), p.Y(), p.Z()}}; }

// A coedge under construction: `from` and `to` are vertices in the order of the loop.
struct Piece {
    Coedge coedge;
    int from = -1, to = -1;
    Vec<2> start{}, end{};
};

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

bool is_rigid(const TopLoc_Location& at) {
    return at.IsIdentity() ||
           (std::abs(at.Transformation().ScaleFactor() - 1) < 1e-14 && !at.Transformation().IsNegative());
}

constexpr double kRounding = 1e-12;  // of the range of an edge
constexpr double kNoBound = std::numeric_limits<double>::infinity();

// How far the stretched curve is from the curve, whose end stands for what lies beyond it: seen as an edge
// beside the extrusion of the curve.
double stretch_bound(const CurveGeometry<3>& curve, const CurveGeometry<3>& stretched, Interval range) {
    const SurfaceGeometry surface = Extrusion{curve, {{1, 0, 0}}};
    return edge_gap(DerivativeQuery<2, 3>(surface), Line<2>{{{0, 0}}, {{1, 0}}}, stretched, range, {}).bound;
}

// A parameter curve whose distance from its edge has to be proven.
struct Suspect {
    const Coedge* coedge = nullptr;
    double sampled = 0;  // the largest gap among samples
    bool replaced = false, stretched = false;
};

class Converter {
public:
    explicit Converter(const Document& document) : document_(document) {
        out_.model.unit = document.unit;
        out_.model.refused = document.refused;
    }
    void add(const Part& part);
    Conversion finish();

private:
    Result<int> face(const TopoDS_Face& original, const TopLoc_Location& at, const Part& part);
    Result<Face> geometry_of(const TopoDS_Face& f);
    Result<Loop> loop_of(std::vector<Piece> pieces, std::vector<Loop>& more);
    Result<Piece> piece(const TopoDS_Edge& e, const TopoDS_Face& f, const Handle(Geom_Plane) & plane);
    Result<int> edge(const TopoDS_Edge& e, const TopoDS_Face& f);
    int vertex(const TopoDS_Vertex& v);
    const Vec<3>& vertex_of(const Edge& e) const { return out_.model.vertices[std::size_t(e.start)].point; }
    // `bound` may be infinite: then nothing is proven, and the estimate is all there is.
    void report(int edge, std::string what, double bound, double estimate);
    Result<void> check_tolerance(Face& f, std::string_view where);
    bool improve(const Face& f, Coedge& c, double size, double& worst);
    void prove(const DerivativeQuery<2, 3>& surface, const Suspect& suspect, double target,
               std::string_view where);
    int shell(const TopoDS_Shape& s, bool closed, const TopLoc_Location& at, const Part& part);
    void body(const TopoDS_Shape& s, bool solid, const Part& part, const TopLoc_Location& at);

    const Document& document_;
    Conversion out_;
    IndexMap vertices_, edges_, faces_;
    std::vector<double> stated_;                   // the tolerance of each edge in the file
    std::vector<int> approximated_;                // the edge that each approximation is about
    std::vector<std::pair<int, bool>> stretched_;  // coedges (edge, reversed) of the face in work
    int free_edges_ = 0;
};

int Converter::vertex(const TopoDS_Vertex& v) {
    if (int i = 0; vertices_.Find(v, i)) return i;
    const int i = int(out_.model.vertices.size());
    out_.model.vertices.push_back({vec(BRep_Tool::Pnt(v)), BRep_Tool::Tolerance(v)});
    vertices_.Bind(v, i);
    return i;
}

void Converter::report(int edge, std::string what, double bound, double estimate) {
    Approximation a{"", std::move(what), std::nullopt,
                    0};  // `finish` knows the number that the edge will have
    if (std::isfinite(bound))
        a.bound = bound;
    else
        a.estimate = estimate;
    out_.model.approximations.push_back(std::move(a));
    approximated_.push_back(edge);
}

// The edge in the model. `f`: a face that it bounds, for edges without a curve in space.
Result<int> Converter::edge(const TopoDS_Edge& oriented, const TopoDS_Face& f) {
    const auto e = TopoDS::Edge(oriented.Oriented(TopAbs_FORWARD));
    if (int i = 0; edges_.Find(e, i)) return i;
    Edge made;
    made.tolerance = BRep_Tool::Tolerance(e);
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

Handle(Geom_Plane) as_plane(Handle(Geom_Surface) s) {
    while (!s.IsNull() && s->IsKind(STANDARD_TYPE(Geom_RectangularTrimmedSurface)))
        s = Handle(Geom_RectangularTrimmedSurface)::DownCast(s)->BasisSurface();
    return Handle(Geom_Plane)::DownCast(s);
}

// REQUIRES f oriented forward.
Result<Face> Converter::geometry_of(const TopoDS_Face& f) {
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
            add_hull(used, p->coedge.curve, out_.model.edges[std::size_t(p->coedge.edge)].range);
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
    auto converted = surface(s, {used.side(0), used.side(1)});
    if (!converted) return std::unexpected(converted.error());
    out.surface = std::move(*converted);
    return out;
}

// Samples miss the largest value of a smooth function by little: below the tolerance by this factor they are
// believed, of what the file promises.
constexpr double kMargin = 1.5;
// Relative to the size of the face: better parameter curves are looked for from here, and what is this far
// off describes another face.
constexpr double kWorthRefitting = 1e-9, kHopeless = 0.25;

// Replaces a parameter curve that misses its edge if that helps. `worst`: its gap, before and after.
bool Converter::improve(const Face& f, Coedge& c, double size, double& worst) {
    const Edge& e = out_.model.edges[std::size_t(c.edge)];
    if (!e.curve || !(worst > kWorthRefitting * size)) return false;
    auto better = refit(f.surface, *e.curve, c.curve, e.range, kWorthRefitting / 10 * size);
    if (!better) return false;
    const double rest = sampled_gap(f.surface, e, vertex_of(e), *better);
    if (!(rest < worst / 2)) return false;
    c.curve = std::move(*better);
    worst = rest;
    return true;
}

// Lists a parameter curve that was replaced or does not keep the tolerance of the file, with a proven bound
// of its distance from the edge, and raises the tolerance of the edge to it.
void Converter::prove(const DerivativeQuery<2, 3>& surface, const Suspect& suspect, double target,
                      std::string_view where) {
    const Coedge& c = *suspect.coedge;
    Edge& e = out_.model.edges[std::size_t(c.edge)];
    const double stated = stated_[std::size_t(c.edge)];
    const bool changed = suspect.replaced || suspect.stretched;
    const CurveGeometry<3> vertex = Line<3>{vertex_of(e), {}};
    EdgeGapOptions options;
    options.target = changed ? target : e.tolerance;
    options.factor = changed ? 1.25 : 1.05;
    const EdgeGap gap = edge_gap(surface, c.curve, e.curve ? *e.curve : vertex, e.range, options);
    const double found = std::max(suspect.sampled, gap.found), estimate = kMargin * found,
                 distance = std::isfinite(gap.bound) ? gap.bound : estimate;
    const bool beyond = distance > stated;
    if (!changed && !beyond) return;
    std::string what;
    if (changed)
        what = text("its parameter curve on ", where,
                    suspect.replaced ? " is replaced by a spline that follows the edge"
                                     : " ends before the edge does and is stretched");
    if (beyond)
        what += text(changed ? ", but " : "", "lies up to ", found, " beside ", changed ? "it" : where,
                     "; the file says at most ", stated);
    report(c.edge, std::move(what), gap.bound, estimate);
    e.tolerance = std::max(e.tolerance, distance);
}

// Replaces parameter curves that miss their edge, as far as that helps, and raises the tolerances of edges
// that the others do not keep. Refuses the face if one misses by a good part of the size of the face.
Result<void> Converter::check_tolerance(Face& f, std::string_view where) {
    Box<3> box;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges)
            if (const Edge& e = out_.model.edges[std::size_t(c.edge)]; e.curve)
                for (int i = 0; i <= 8; ++i)
                    box.add(jet<0>(*e.curve, e.range.lo + e.range.length() * i / 8).value());
    const double size = box.diagonal();
    std::vector<Suspect> suspects;
    for (Loop& l : f.loops)
        for (Coedge& c : l.coedges) {
            const Edge& e = out_.model.edges[std::size_t(c.edge)];
            double worst = sampled_gap(f.surface, e, vertex_of(e), c.curve);
            const bool replaced = improve(f, c, size, worst);
            if (size > 0 && !(worst < kHopeless * size))
                return refuse(RefusalKind::ill_conditioned, "parameter curve",
                              text("misses its edge by ", worst, "; the face has a size of ", size));
            const bool stretched = std::find(stretched_.begin(), stretched_.end(),
                                             std::pair(c.edge, c.reversed)) != stretched_.end();
            if (replaced || stretched || kMargin * worst > e.tolerance)
                suspects.push_back({&c, worst, replaced, stretched});
        }
    if (suspects.empty()) return {};
    const DerivativeQuery<2, 3> surface(f.surface);
    for (const Suspect& s : suspects) prove(surface, s, kWorthRefitting * size, where);
    return {};
}

Result<int> Converter::face(const TopoDS_Face& original, const TopLoc_Location& at, const Part& part) {
    TopoDS_Face f = TopoDS::Face(original.Moved(at).Oriented(TopAbs_FORWARD));
    if (int i = 0; faces_.Find(f, i)) return i;
    const TopoDS_Face key = f;
    faces_.Bind(key, -1);
    const Attributes a = document_.attributes(original);
    std::string where = a.entity.empty() ? text("face ", faces_.Extent() - 1) : a.entity;
    if (!a.name.empty()) where += text(" '", a.name, "'");
    if (!part.name.empty()) where += text(" of ", part.name);
    if (!TopExp_Explorer(f, TopAbs_EDGE).More())
        if (const Handle(Geom_Surface) s = BRep_Tool::Surface(f); !s.IsNull()) {
            BRepBuilderAPI_MakeFace bounded(s, Precision::Confusion());
            if (bounded.IsDone()) f = TopoDS::Face(bounded.Face().Oriented(TopAbs_FORWARD));
        }
    // What a refused face brought along stays only if another face wants it; see `finish`.
    auto made = [&]() -> Result<Face> {
        try {
            return geometry_of(f);
        } catch (const Standard_Failure& failure) {
            return refuse(RefusalKind::unreadable, "face",
                          text(failure.DynamicType()->Name(), ": ", failure.GetMessageString()));
        }
    }();
    if (made)
        if (auto ok = check_tolerance(*made, where); !ok) made = std::unexpected(ok.error());
    if (!made) {
        out_.model.refused.push_back(
            {made.error().kind, where, text(made.error().where, ": ", made.error().message)});
        return -1;
    }
    made->name = a.name;
    made->colour = a.colour;
    made->reversed = original.Orientation() == TopAbs_REVERSED;
    const int i = int(out_.model.faces.size());
    out_.model.faces.push_back(std::move(*made));
    out_.faces.push_back(f);
    faces_.Bind(key, i);
    return i;
}

int Converter::shell(const TopoDS_Shape& s, bool closed, const TopLoc_Location& at, const Part& part) {
    Shell out;
    out.closed = closed;
    for (TopExp_Explorer f(s, TopAbs_FACE); f.More(); f.Next()) {
        const auto i = face(TopoDS::Face(f.Current()), at, part);
        if (!i || *i < 0) continue;
        const bool reversed = f.Current().Orientation() == TopAbs_REVERSED;
        out.faces.push_back({*i, reversed != out_.model.faces[std::size_t(*i)].reversed});
    }
    if (out.faces.empty()) return -1;
    out_.model.shells.push_back(std::move(out));
    return int(out_.model.shells.size()) - 1;
}

void Converter::body(const TopoDS_Shape& s, bool solid, const Part& part, const TopLoc_Location& at) {
    Body out;
    out.solid = solid;
    out.name = part.name;
    out.colour = part.colour;
    if (solid) {
        const Attributes a = document_.attributes(s);
        if (a.colour) out.colour = a.colour;
        if (out.name.empty()) out.name = a.name;
    }
    std::vector<TopoDS_Shape> shells;
    for (TopExp_Explorer i(s, TopAbs_SHELL); i.More(); i.Next()) shells.push_back(i.Current());
    if (solid && shells.size() > 1) {
        const TopoDS_Shell outer = BRepClass3d::OuterShell(TopoDS::Solid(s));
        const auto at_outer = std::find_if(shells.begin(), shells.end(), [&](const TopoDS_Shape& x) {
            return !outer.IsNull() && x.IsSame(outer);
        });
        if (at_outer != shells.end()) std::rotate(shells.begin(), at_outer, at_outer + 1);
    }
    for (const TopoDS_Shape& x : shells)
        if (const int i = shell(x, solid || BRep_Tool::IsClosed(x), at, part); i >= 0)
            out.shells.push_back(i);
    if (shells.empty())
        if (const int i = shell(s, false, at, part); i >= 0) out.shells.push_back(i);
    if (!out.shells.empty()) out_.model.bodies.push_back(std::move(out));
}

void Converter::add(const Part& original) {
    Part part = original;
    if (!is_rigid(part.at * part.shape.Location())) {
        part.shape = BRepBuilderAPI_Transform(part.shape.Located({}),
                                              (part.at * part.shape.Location()).Transformation(), true)
                         .Shape();
        part.at = {};
    }
    for (TopExp_Explorer i(part.shape, TopAbs_SOLID); i.More(); i.Next())
        body(i.Current(), true, part, part.at);
    for (TopExp_Explorer i(part.shape, TopAbs_SHELL, TopAbs_SOLID); i.More(); i.Next())
        body(i.Current(), false, part, part.at);
    BRep_Builder builder;
    TopoDS_Compound loose;
    builder.MakeCompound(loose);
    bool any = false;
    for (TopExp_Explorer i(part.shape, TopAbs_FACE, TopAbs_SHELL); i.More(); i.Next(), any = true)
        builder.Add(loose, i.Current());
    if (any) body(loose, false, part, part.at);
    for (TopExp_Explorer i(part.shape, TopAbs_EDGE, TopAbs_FACE); i.More(); i.Next()) ++free_edges_;
}

// Curves that bound no face are the model of a file that has no faces at all; else they are construction.
Conversion Converter::finish() {
    Model& m = out_.model;
    if (free_edges_ > 0 && m.faces.empty()) {
        for (const Part& part : document_.parts)
            for (TopExp_Explorer i(part.shape, TopAbs_EDGE, TopAbs_FACE); i.More(); i.Next())
                if (auto made = edge(TopoDS::Edge(i.Current().Moved(part.at)), {}); !made)
                    m.refused.push_back(made.error());
    } else if (free_edges_ > 0) {
        m.refused.push_back(
            {RefusalKind::unsupported, "file", text(free_edges_, " curves that bound no face are left out")});
    }
    // Edges and vertices that only refused faces had.
    std::vector<int> place(m.edges.size(), free_edges_ > 0 && m.faces.empty() ? 0 : -1);
    for (const Face& f : m.faces)
        for (const Loop& l : f.loops)
            for (const Coedge& c : l.coedges) place[std::size_t(c.edge)] = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < m.edges.size(); ++i) {
        if (place[i] < 0) continue;
        place[i] = int(kept);
        if (kept != i) {
            m.edges[kept] = std::move(m.edges[i]);
            out_.edges[kept] = out_.edges[i];
        }
        ++kept;
    }
    std::size_t told = 0;
    for (std::size_t i = 0; i < m.approximations.size(); ++i) {
        const int edge = place[std::size_t(approximated_[i])];
        if (edge < 0) continue;
        m.approximations[i].where = text("edges[", edge, "]");
        if (told != i) m.approximations[told] = std::move(m.approximations[i]);
        ++told;
    }
    m.approximations.resize(told);
    m.edges.resize(kept);
    out_.edges.resize(kept);
    for (Face& f : m.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge = place[std::size_t(c.edge)];
    return std::move(out_);
}

}  // namespace

Conversion convert(const Document& document) {
    Converter converter(document);
    for (const Part& part : document.parts) converter.add(part);
    return converter.finish();
}

}  // namespace freiform::occt
