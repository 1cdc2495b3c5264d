// The other direction of document_model.cpp.
#include "document_detail.hpp"

#include <freiform/core/visit.hpp>

#include <array>

namespace freiform::document_detail {

namespace {

template <int D>
void write_curve_fields(json::Writer& w, const Line<D>& l) {
    w.field("type", "line").key("origin").array(l.origin.c).key("direction").array(l.direction.c);
}
template <int D>
void write_curve_fields(json::Writer& w, const Conic<D>& c) {
    w.field("type", kConicNames[int(c.kind)]).key("centre").array(c.centre.c);
    w.key("x").array(c.x.c).key("y").array(c.y.c);
}
template <class P>
void write_curve_fields(json::Writer& w, const Curve<P>& c) {
    write_patch(w, c, {});
}

void write_surface_fields(json::Writer& w, const Extrusion& e) {
    w.field("type", "extrusion").key("profile");
    write_curve(w, e.profile);
    w.key("direction").array(e.direction.c);
    if (e.kind != SurfaceKind::general) w.field("kind", kSurfaceKinds[int(e.kind)]);
}
void write_surface_fields(json::Writer& w, const Revolution& r) {
    w.field("type", "revolution").key("profile");
    write_curve(w, r.profile);
    w.key("origin").array(r.origin.c).key("axis").array(r.axis.c);
    if (r.kind != SurfaceKind::general) w.field("kind", kSurfaceKinds[int(r.kind)]);
}
void write_surface_fields(json::Writer& w, const OffsetSurface& o) {
    w.field("type", "offset").key("base");
    write_surface(w, *o.base);
    w.field("distance", o.distance);
}
template <class P>
void write_surface_fields(json::Writer& w, const Surface<P>& s) {
    w.field("type", "surface");
    write_patch(w, s, {});
}

template <int D>
void write_curve_object(json::Writer& w, const CurveGeometry<D>& c) {
    w.begin_object();
    visit_one([&](const auto& g) { write_curve_fields(w, g); }, c);
    w.end_object();
}

void write_optional(json::Writer& w, bool reversed, double tolerance, const std::string& name) {
    if (reversed) w.field("reversed", true);
    if (tolerance != 0) w.field("tolerance", tolerance);
    if (!name.empty()) w.field("name", name);
}
void write_optional(json::Writer& w, const std::optional<Colour>& c) {
    if (c) w.key("colour").array(std::array{c->r, c->g, c->b, c->a});
}

void write_layers(json::Writer& w, const std::vector<int>& layers) {
    if (!layers.empty()) w.key("layers").array(layers);
}

void write_entity(json::Writer& w, const Vertex& v) {
    w.key("point").array(v.point.c);
    write_optional(w, false, v.tolerance, "");
}
void write_entity(json::Writer& w, const Edge& e) {
    if (e.curve) {
        w.key("curve");
        write_curve(w, *e.curve);
    }
    if (e.degenerate) w.field("degenerate", true);
    w.key("range").array(std::array{e.range.lo, e.range.hi}).field("start", e.start).field("end", e.end);
    write_optional(w, false, e.tolerance, e.name);
    write_optional(w, e.colour);
    write_layers(w, e.layers);
}
void write_entity(json::Writer& w, const Face& f) {
    w.key("surface");
    write_surface(w, f.surface);
    w.key("loops").begin_array();
    for (const Loop& loop : f.loops) {
        w.begin_array();
        for (const Coedge& c : loop.coedges) {
            w.begin_object().field("edge", c.edge);
            if (c.reversed) w.field("reversed", true);
            w.key("curve");
            write_curve(w, c.curve);
            w.end_object();
        }
        w.end_array();
    }
    w.end_array();
    write_optional(w, f.reversed, f.tolerance, f.name);
    write_optional(w, f.colour);
    write_layers(w, f.layers);
}
void write_entity(json::Writer& w, const Shell& s) {
    w.key("faces").begin_array();
    for (const FaceUse& u : s.faces) {
        w.begin_object().field("face", u.face);
        if (u.reversed) w.field("reversed", true);
        w.end_object();
    }
    w.end_array();
    if (s.closed) w.field("closed", true);
}
void write_entity(json::Writer& w, const Body& b) {
    w.key("shells").array(b.shells);
    if (b.solid) w.field("solid", true);
    write_optional(w, false, 0, b.name);
    write_optional(w, b.colour);
    write_layers(w, b.layers);
}
void write_entity(json::Writer& w, const Refusal& r) {
    w.field("kind", name_of(r.kind)).field("where", r.where).field("message", r.message);
}
void write_entity(json::Writer& w, const Approximation& a) {
    w.field("where", a.where).field("what", a.what);
    if (a.bound)
        w.field("bound", *a.bound);
    else
        w.field("estimate", a.estimate);
}

void write_entity(json::Writer& w, const Layer& l) {
    w.field("name", l.name);
    if (!l.description.empty()) w.field("description", l.description);
}
void write_entity(json::Writer& w, const Repair& r) {
    w.field("where", r.where).field("what", r.what).field("distance", r.distance);
}

template <class T>
void write_entities(json::Writer& w, std::string_view field, const std::vector<T>& list,
                    bool always = false) {
    if (list.empty() && !always) return;
    w.new_line(3).key(field).begin_array();
    for (const T& x : list) {
        w.new_line(4).begin_object();
        write_entity(w, x);
        w.end_object();
    }
    w.end_array();
}

}  // namespace

void write_curve(json::Writer& w, const CurveGeometry<2>& c) { write_curve_object(w, c); }
void write_curve(json::Writer& w, const CurveGeometry<3>& c) { write_curve_object(w, c); }

void write_surface(json::Writer& w, const SurfaceGeometry& s) {
    w.begin_object();
    visit_one([&](const auto& g) { write_surface_fields(w, g); }, s);
    w.end_object();
}

void write_model(json::Writer& w, const Model& m) {
    if (!m.unit.empty()) w.field("unit", m.unit);
    write_entities(w, "vertices", m.vertices);
    write_entities(w, "edges", m.edges);
    write_entities(w, "faces", m.faces, true);
    write_entities(w, "shells", m.shells);
    write_entities(w, "bodies", m.bodies);
    write_entities(w, "refused", m.refused);
    write_entities(w, "approximations", m.approximations);
    write_entities(w, "layers", m.layers);
    write_entities(w, "repairs", m.repairs);
}

}  // namespace freiform::document_detail
