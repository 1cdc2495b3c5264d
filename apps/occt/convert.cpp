// Idea. Every shape is looked up in maps that know shape and place, so that what two faces share in the file
// they share in the model. A face is taken oriented forward: then its parameter curves run with the loops as
// our odd-even rule wants them, and the orientation of the face becomes a flag.
#include "converter.hpp"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepClass3d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <cmath>

namespace freiform::occt {

namespace {

bool is_rigid(const TopLoc_Location& at) {
    return at.IsIdentity() ||
           (std::abs(at.Transformation().ScaleFactor() - 1) < 1e-14 && !at.Transformation().IsNegative());
}

}  // namespace

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
    const auto caught = [&](auto make) -> Result<Face> {
        try {
            return make();
        } catch (const Standard_Failure& failure) {
            return refuse(RefusalKind::unreadable, "face",
                          text(failure.DynamicType()->Name(), ": ", failure.GetMessageString()));
        }
    };
    const std::size_t before = approximated_.size();
    auto made = caught([&] { return geometry_of(f, where); });
    const auto take_edges = [&] {
        const std::size_t told = approximated_.size();
        auto again = caught([&] { return retraced(f); });
        const bool taken = again && check_tolerance(*again, where);
        // What was said of the parameter curves, which are gone; or of those that were not taken.
        auto& all = out_.model.approximations;
        const auto forget = [&](std::size_t from, std::size_t to) {
            all.erase(all.begin() + std::ptrdiff_t(from), all.begin() + std::ptrdiff_t(to));
            approximated_.erase(approximated_.begin() + std::ptrdiff_t(from),
                                approximated_.begin() + std::ptrdiff_t(to));
        };
        taken ? forget(before, told) : forget(told, approximated_.size());
        if (!taken) return false;
        made = std::move(*again);
        report(-1, "its parameter curves contradict its edges; those that follow the edges take their place",
               0, 0);
        all.back().where = where;
        return true;
    };
    if (made && !(is_open(*made) && take_edges()))
        if (auto ok = check_tolerance(*made, where); !ok) made = std::unexpected(ok.error());
    if (!made) take_edges();
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
            {RefusalKind::unsupported, "file",
             text(free_edges_, free_edges_ == 1 ? " curve that bounds no face is left out"
                                                : " curves that bound no face are left out")});
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
        if (approximated_[i] >= 0) {  // others are of faces
            const int edge = place[std::size_t(approximated_[i])];
            if (edge < 0) continue;
            m.approximations[i].where = text("edges[", edge, "]");
        }
        if (told != i) m.approximations[told] = std::move(m.approximations[i]);
        ++told;
    }
    m.approximations.resize(told);
    m.edges.resize(kept);
    out_.edges.resize(kept);
    for (Face& f : m.faces)
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge = place[std::size_t(c.edge)];
    std::vector<int> to(m.vertices.size(), -1);
    std::vector<Vertex> vertices;
    for (Edge& e : m.edges)
        for (int* v : {&e.start, &e.end}) {
            int& at = to[std::size_t(*v)];
            if (at < 0) {
                at = int(vertices.size());
                vertices.push_back(m.vertices[std::size_t(*v)]);
            }
            *v = at;
        }
    m.vertices = std::move(vertices);
    return std::move(out_);
}

Conversion convert(const Document& document) {
    Converter converter(document);
    for (const Part& part : document.parts) converter.add(part);
    return converter.finish();
}

}  // namespace freiform::occt
