#include "verify.hpp"

#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <algorithm>
#include <iostream>

namespace freiform::occt {

namespace {

Vec<3> vec_of(const gp_Pnt& p) { return {{p.X(), p.Y(), p.Z()}}; }

struct Worst {
    double value = 0;
    std::string where;
    void add(double x, std::string_view kind, std::size_t i) {
        if (!(x > value)) return;
        value = x;
        where = text(kind, " ", i);
    }
};

}  // namespace

bool verify(const Conversion& c, const std::string& name) {
    const Model& m = c.model;
    Worst surfaces, curves, gaps, excess, joints;
    Box<3> box;
    for (const Vertex& v : m.vertices) box.add(v.point);
    for (std::size_t i = 0; i < m.faces.size(); ++i) {
        const Face& f = m.faces[i];
        const Handle(Geom_Surface) s = BRep_Tool::Surface(c.faces[i]);
        std::vector<Vec<2>> on_boundary;
        for (const Loop& l : f.loops) {
            Vec<2> last{};
            for (std::size_t k = 0; k <= l.coedges.size(); ++k) {
                const Coedge& co = l.coedges[k % l.coedges.size()];
                const Edge& e = m.edges[std::size_t(co.edge)];
                const Vec<2> a = jet<0>(co.curve, co.reversed ? e.range.hi : e.range.lo).value();
                if (k > 0) {
                    const Vec<3> x = jet<0>(f.surface, a.c).value(), y = jet<0>(f.surface, last.c).value();
                    joints.add(norm(x - y), text(kind_name(f.surface), " face"), i);
                }
                last = jet<0>(co.curve, co.reversed ? e.range.lo : e.range.hi).value();
                for (int j = 0; j <= 64; ++j) {
                    const double t = e.range.lo + e.range.length() * j / 64;
                    const Vec<2> uv = jet<0>(co.curve, t).value();
                    on_boundary.push_back(uv);
                    const Vec<3> p = jet<0>(f.surface, uv.c).value();
                    if (!e.curve && !e.degenerate) continue;
                    const Vec<3> q =
                        e.curve ? jet<0>(*e.curve, t).value() : m.vertices[std::size_t(e.start)].point;
                    gaps.add(norm(p - q), text(kind_name(f.surface), " face"), i);
                    excess.add(norm(p - q) - e.tolerance, text(kind_name(f.surface), " face"), i);
                }
            }
        }
        // Between points of the boundary: inside the part of the domain that is used.
        for (std::size_t k = 0; k < on_boundary.size(); k += 3) {
            const Vec<2> a = on_boundary[k], b = on_boundary[(k * 7 + 13) % on_boundary.size()];
            const Vec<2> uv = 0.5 * (a + b);
            for (const Vec<2>& at : {a, uv}) {
                const Vec<3> p = jet<0>(f.surface, at.c).value(), q = vec_of(s->Value(at[0], at[1]));
                box.add(q);
                surfaces.add(norm(p - q), kind_name(f.surface), i);
            }
        }
    }
    for (std::size_t i = 0; i < m.edges.size(); ++i) {
        const Edge& e = m.edges[i];
        double lo = 0, hi = 0;
        if (c.edges[i].IsNull()) continue;  // a pole that was added
        const Handle(Geom_Curve) g = BRep_Tool::Curve(c.edges[i], lo, hi);
        if (g.IsNull() || !e.curve) continue;
        for (int j = 0; j <= 64; ++j) {
            const double t = e.range.lo + e.range.length() * j / 64;
            const Vec<3> q = vec_of(g->Value(t));
            curves.add(norm(jet<0>(*e.curve, t).value() - q), kind_name(*e.curve), i);
            box.add(q);
        }
    }
    const ModelSummary s = summary(m);
    const double allowed = 1e-9 * box.diagonal() + 1e-11 * box.scale();
    const bool good = surfaces.value <= allowed && curves.value <= allowed && excess.value <= allowed;
    std::cerr << text(good ? "ok  " : "BAD ", name.substr(name.rfind('/') + 1), " [", m.unit, "] solids ",
                      s.solids, "/", s.bodies, " faces ", s.faces, " edges ", s.edges, " open ", s.open_edges,
                      " refused ", m.refused.size(), " approx ", m.approximations.size(), " | size ",
                      float(box.diagonal()), " surf ", float(surfaces.value), " (", surfaces.where,
                      ") curve ", float(curves.value), " (", curves.where, ") gap ", float(gaps.value), " (",
                      gaps.where, ") joint ", float(joints.value), " (", joints.where, ") over-tolerance ",
                      float(excess.value), "\n");
    for (const Refusal& r : m.refused)
        std::cerr << text("      refused ", r.where, ": ", name_of(r.kind), ": ", r.message.substr(0, 200),
                          "\n");
    for (std::size_t i = 0; i < m.approximations.size() && i < 5; ++i)
        std::cerr << text("      approx ", m.approximations[i].where, ": ", m.approximations[i].what, "\n");
    return good;
}

}  // namespace freiform::occt
