#include "tessellate_report.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::cli {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::pair<std::string_view, double> kQuantiles[] = {
    {"least", 0}, {"0.01", 0.01}, {"0.1", 0.1}, {"0.5", 0.5}};

// Of the smallest angles of the triangles, in degrees; empty for a mesh without triangles.
std::vector<double> angle_quantiles(const TriangleMesh& mesh) {
    auto angles = smallest_angles(mesh);
    sort(angles.begin(), angles.end());
    std::vector<double> out;
    for (const auto& [name, part] : kQuantiles)
        if (!angles.empty()) out.push_back(kDegrees * angles[std::size_t(part * double(angles.size() - 1))]);
    return out;
}

void write_shapes(json::Writer& w, const TessellateReport& r) {
    if (r.angle)
        w.field("angle", *r.angle)
            .field("angle_bound", kDegrees * r.t.angle_bound)
            .field("angle_exceeded", r.t.angle_exceeded);
    if (std::isfinite(r.how.max_aspect)) w.field("aspect", r.how.max_aspect);
    const auto quantiles = angle_quantiles(r.t.mesh);
    w.key("smallest_angles").begin_object();
    for (std::size_t i = 0; i < quantiles.size(); ++i) w.field(kQuantiles[i].first, quantiles[i]);
    w.end_object();
}

std::string shapes_text(const TessellateReport& r) {
    std::string s;
    if (r.angle) {
        s += text("angle bound     ", kDegrees * r.t.angle_bound, " degrees (asked for ", *r.angle, ")");
        s += r.t.angle_exceeded == 0 ? std::string("\n")
                                     : text(", above that ", r.t.angle_exceeded, " triangles\n");
    }
    const auto q = angle_quantiles(r.t.mesh);
    if (std::isfinite(r.how.max_aspect) && !q.empty())
        s += text("smallest angles ", q[0], " degrees at least, ", q[2], " in nine of ten triangles, median ",
                  q[3], "\n");
    return s;
}

}  // namespace

void write_report(json::Writer& w, const TessellateReport& r) {
    const Tessellation& t = r.t;
    const Model& model = r.model;
    w.begin_object();
    w.field("triangles", t.mesh.triangles.size())
        .field("vertices", t.mesh.points.size())
        .field("faces", model.faces.size());
    if (r.how.quads) w.field("quads", t.quads);
    w.field("open_edges", t.topology.open_edges).field("non_manifold_edges", t.topology.non_manifold_edges);
    w.field("misoriented_edges", t.topology.misoriented_edges);
    w.field("error_bound", t.error_bound).field("boundary_gap", t.boundary_gap);
    w.field("degenerate_triangles", t.topology.degenerate_triangles);
    w.field("predicted_triangles", std::ceil(predicted_triangles(model, r.how)));
    w.field("tolerance", r.how.tolerance).field("unit", model.unit);
    if (!r.output.empty()) w.field("output", r.output).field("storage_rounding", r.rounding);
    write_shapes(w, r);
    if (r.sewing) write_sewing(w, *r.sewing);
    w.key("seconds").begin_object();
    w.field("read", r.seconds.read).field("edges", t.seconds.edges).field("faces", t.seconds.faces);
    if (r.sewing) w.field("sew", r.seconds.sew);
    w.field("write", r.seconds.write).field("total", r.seconds.total).end_object();
    w.key("refused").begin_array();
    for (const RefusedFace& f : t.refused)
        w.begin_object()
            .field("face", f.face)
            .field("name", f.name)
            .field("kind", name_of(f.reason.kind))
            .field("where", f.reason.where)
            .field("message", f.reason.message)
            .end_object();
    for (const Refusal& x : model.refused)
        w.begin_object()
            .field("face", x.where)
            .field("kind", name_of(x.kind))
            .field("where", x.where)
            .field("message", x.message)
            .end_object();
    w.end_array().key("approximations").begin_array();
    for (const Approximation& a : model.approximations) write_approximation(w, a);
    w.end_array();
    if (!model.repairs.empty()) write_repairs(w, model.repairs);
    if (!t.turned_shells.empty()) w.key("turned_shells").array(t.turned_shells);
    w.end_object();
}

std::string report_text(const TessellateReport& r) {
    const Tessellation& t = r.t;
    const Model& model = r.model;
    std::string s = text(t.mesh.triangles.size(), " triangles, ", t.mesh.points.size(), " points, ",
                         model.faces.size(), " faces\n");
    if (r.how.quads)
        s += text("quads           ", t.quads, ", and ", t.mesh.triangles.size() - 2 * std::size_t(t.quads),
                  " triangles that are no half of one\n");
    s += text("open edges      ", t.topology.open_edges, "\n");
    if (t.topology.non_manifold_edges > 0) s += text("non-manifold    ", t.topology.non_manifold_edges, "\n");
    if (t.topology.misoriented_edges > 0)
        s += text("misoriented     ", t.topology.misoriented_edges,
                  " edges, of faces that look the wrong way\n");
    if (t.topology.degenerate_triangles > 0)
        s += text("degenerate      ", t.topology.degenerate_triangles, "\n");
    s += text("error bound     ", t.error_bound, " (tolerance ", r.how.tolerance,
              model.unit.empty() ? "" : " ", model.unit, ")\n");
    s += text("boundary gap    ", t.boundary_gap, " (of the model itself)\n");
    if (r.rounding > 0) s += text("stored as float ", r.rounding, " more\n");
    s += shapes_text(r);
    if (r.sewing) s += sewing_text(*r.sewing, model.unit);
    s += text("seconds         ", r.seconds.total, "\n");
    for (const RefusedFace& f : t.refused)
        s += text("refused face ", f.face, f.name.empty() ? "" : text(" '", f.name, "'"), ": ",
                  f.reason.where, ": ", f.reason.message, "\n");
    for (const int shell : t.turned_shells)
        s += text("turned outwards shell ", shell, " of a solid, whose faces look the wrong way\n");
    for (const Refusal& x : model.refused) s += text("refused ", x.where, ": ", x.message, "\n");
    for (const Repair& x : model.repairs) s += text("repaired ", repair_text(x), "\n");
    for (const Approximation& a : model.approximations)
        s += text("approximated ", approximation_text(a), "\n");
    if (!r.output.empty()) s += text("written to ", r.output, "\n");
    return s;
}

}  // namespace freiform::cli
