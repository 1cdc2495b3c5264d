// info: what a file contains.
#include "input.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/mesh_file.hpp>

#include <map>

namespace freiform::cli {

namespace {

constexpr char kAxis[] = "uvw";

void write_range(json::Writer& w, const ControlBox& box) {
    w.key("box");
    if (box.lo.empty())
        w.null();
    else
        w.begin_object().key("min").array(box.lo).key("max").array(box.hi).end_object();
}

ControlBox as_control_box(const Box<3>& box) {
    if (box.is_empty()) return {};
    return {{box.lo.c.begin(), box.lo.c.end()}, {box.hi.c.begin(), box.hi.c.end()}, box.diagonal()};
}

// What patches, trimmed surfaces and triangles say about themselves.
struct Facts {
    std::span<const BSplineBasis> bases;  // of a triangle none, but
    int degree = 0;
    std::size_t points = 0;
    int dimension = 3;
    bool rational = false;
    std::optional<std::size_t> loops;
};

template <class S>
Facts facts_about(const S& s) {
    Facts f;
    if constexpr (TensorPatch<S>)
        f.bases = s.bases();
    else
        f.degree = s.degree(), f.points = s.coefficients().size();
    f.dimension = Space<typename S::Coefficients>::kDim;
    f.rational = Space<typename S::Coefficients>::kRational;
    return f;
}

Facts facts_of(const Shape& shape) {
    return visit_one(
        [](const auto& s) -> Facts {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S> || TriangularPatch<S>) {
                return facts_about(s);
            } else if constexpr (std::same_as<S, TrimmedSurface>) {
                Facts f = visit_one([](const auto& surface) { return facts_about(surface); }, s.surface);
                f.loops = s.loops.size();
                return f;
            } else {
                return {};
            }
        },
        shape);
}

void write_triangle_info(json::Writer& w, const Facts& f) {
    w.field("degree", f.degree).field("dimension", f.dimension).field("rational", f.rational);
    w.key("points").array(std::array{f.points});
    w.key("domain").begin_array();
    for (int d = 0; d < 2; ++d) w.array(std::array{0.0, 1.0});
    w.end_array();
}

void write_patch_info(json::Writer& w, const Facts& f) {
    const auto per_axis = [&](std::string_view name, auto&& content) {
        w.key(name).begin_array();
        for (const BSplineBasis& b : f.bases) content(b);
        w.end_array();
    };
    if (f.loops) w.field("loops", *f.loops);
    if (f.bases.size() == 1)
        w.field("degree", f.bases[0].degree());
    else
        per_axis("degrees", [&](const BSplineBasis& b) { w.value(b.degree()); });
    w.field("dimension", f.dimension).field("rational", f.rational);
    per_axis("points", [&](const BSplineBasis& b) { w.value(b.size()); });
    per_axis("pieces", [&](const BSplineBasis& b) { w.value(b.breaks().size() - 1); });
    per_axis("closed", [&](const BSplineBasis& b) { w.value(b.is_closed()); });
    per_axis("domain", [&](const BSplineBasis& b) {
        w.begin_array().value(b.domain().lo).value(b.domain().hi).end_array();
    });
}

using Counts = std::map<std::string, int, std::less<>>;

void write_counts(json::Writer& w, std::string_view key, const Counts& counts) {
    w.key(key).begin_object();
    for (const auto& [name, n] : counts) w.field(name, n);
    w.end_object();
}

Counts face_kinds(const Model& m) {
    Counts kinds;
    for (const Face& f : m.faces) ++kinds[std::string(kind_name(f.surface))];
    return kinds;
}
Counts edge_kinds(const Model& m) {
    Counts kinds;
    for (const Edge& e : m.edges)
        ++kinds[e.degenerate ? "degenerate" : e.curve ? std::string(kind_name(*e.curve)) : "on surface"];
    return kinds;
}

void write_approximations(json::Writer& w, const std::vector<Approximation>& list) {
    w.key("approximations").begin_array();
    for (const Approximation& a : list) write_approximation(w, a);
    w.end_array();
}

// How many faces, bodies and edges are on each layer.
std::vector<std::array<int, 3>> layer_counts(const Model& m) {
    std::vector<std::array<int, 3>> counts(m.layers.size());
    const auto count = [&](const auto& things, std::size_t kind) {
        for (const auto& x : things)
            for (const int l : x.layers) ++counts[std::size_t(l)][kind];
    };
    count(m.faces, 0), count(m.bodies, 1), count(m.edges, 2);
    return counts;
}

void write_layers(json::Writer& w, const Model& m) {
    const auto counts = layer_counts(m);
    w.key("layers").begin_array();
    for (std::size_t i = 0; i < counts.size(); ++i)
        w.begin_object()
            .field("name", m.layers[i].name)
            .field("description", m.layers[i].description)
            .field("faces", counts[i][0])
            .field("bodies", counts[i][1])
            .field("edges", counts[i][2])
            .end_object();
    w.end_array();
}

void write_model_info(json::Writer& w, const Model& m) {
    const ModelSummary s = summary(m);
    if (!m.unit.empty()) w.field("unit", m.unit);
    w.field("bodies", s.bodies).field("solids", s.solids).field("shells", s.shells).field("faces", s.faces);
    w.field("edges", s.edges).field("vertices", s.vertices).field("open_edges", s.open_edges);
    w.field("seams", s.seams).field("degenerate_edges", s.degenerate_edges);
    write_counts(w, "face_kinds", face_kinds(m));
    write_counts(w, "edge_kinds", edge_kinds(m));
    write_refusals(w, "refused", m.refused);
    write_approximations(w, m.approximations);
    if (!m.layers.empty()) write_layers(w, m);
    if (!m.repairs.empty()) write_repairs(w, m.repairs);
    write_range(w, as_control_box(s.box));
}

std::string json_info(const Document& d, const std::string& file, const std::vector<std::size_t>& objects) {
    json::Writer w;
    w.begin_object().field("file", file).field("unit", d.unit);
    Counts counts;
    for (const std::size_t i : objects) ++counts[std::string(type_name(d.objects[i].shape))];
    write_counts(w, "counts", counts);
    w.key("objects").begin_array();
    for (const std::size_t i : objects) {
        const Object& o = d.objects[i];
        w.new_line(1)
            .begin_object()
            .field("index", i)
            .field("name", o.name)
            .field("type", type_name(o.shape));
        if (const Model* m = std::get_if<Model>(&o.shape)) {
            write_model_info(w, *m);
        } else {
            const Facts f = facts_of(o.shape);
            f.bases.empty() ? write_triangle_info(w, f) : write_patch_info(w, f);
            write_range(w, control_box(o.shape));
            if (!o.approximations.empty()) write_approximations(w, o.approximations);
        }
        w.end_object();
    }
    w.end_array();
    if (!d.left_out.empty()) write_refusals(w, "left_out", d.left_out);
    w.end_object();
    return w.take() + "\n";
}

std::string range_text(const ControlBox& box) {
    if (box.lo.empty()) return "  box      empty\n";
    std::string s = "  box      ";
    for (std::size_t i = 0; i < box.lo.size(); ++i)
        s += text(i ? " x [" : "[", box.lo[i], ", ", box.hi[i], "]");
    return s + "\n";
}

std::string patch_text(const Facts& f) {
    std::string degrees, counts, domains, closed;
    for (std::size_t d = 0; d < f.bases.size(); ++d) {
        const BSplineBasis& b = f.bases[d];
        const std::string_view between = d ? " x " : "";
        degrees += text(between, b.degree());
        counts += text(between, b.size());
        domains += text(between, "[", b.domain().lo, ", ", b.domain().hi, "]");
        if (b.is_closed())
            closed += text(closed.empty() ? ", closed" : " and",
                           f.bases.size() == 1 ? "" : text(" along ", kAxis[d]));
    }
    if (f.bases.empty()) {
        degrees = text(f.degree), counts = text(f.points);
        domains = "u >= 0, v >= 0, u + v <= 1";
    }
    return text("  degree   ", degrees, ", ", counts, " points of ", f.dimension,
                f.dimension == 1 ? " coordinate" : " coordinates", f.rational ? ", rational" : "", closed,
                "\n  domain   ", domains, "\n");
}

std::string kinds_text(const Counts& counts) {
    std::string s;
    for (const auto& [name, n] : counts) s += text(s.empty() ? "" : ", ", n, " ", name);
    return s.empty() ? s : text(" (", s, ")");
}

std::string approximations_text(const std::vector<Approximation>& list) {
    std::string t;
    for (const Approximation& a : list) t += text("  approximated  ", approximation_text(a), "\n");
    return t;
}

std::string model_text(const Model& m) {
    const ModelSummary s = summary(m);
    std::string t = text("  bodies   ", s.bodies, ", ", s.solids, " of them solid, ", s.shells, " shells\n");
    t += text("  faces    ", s.faces, kinds_text(face_kinds(m)), "\n");
    t += text("  edges    ", s.edges, kinds_text(edge_kinds(m)), ", ", s.open_edges, " open, ", s.seams,
              " seams\n");
    t += text("  vertices ", s.vertices, "\n");
    t += range_text(as_control_box(s.box));
    for (const Refusal& r : m.refused)
        t += text("  refused  ", r.where, ": ", r.message, " (", name_of(r.kind), ")\n");
    for (const Repair& r : m.repairs) t += text("  repaired ", repair_text(r), "\n");
    const auto counts = layer_counts(m);
    for (std::size_t i = 0; i < counts.size(); ++i)
        t +=
            text("  layer    ", m.layers[i].name,
                 m.layers[i].description.empty() ? "" : text(" (", m.layers[i].description, ")"), ": bodies ",
                 counts[i][1], ", faces by themselves ", counts[i][0], ", edges ", counts[i][2], "\n");
    return t + approximations_text(m.approximations);
}

std::string text_info(const Document& d, const std::string& file, const std::vector<std::size_t>& objects) {
    std::string s = text(file, ": ", d.objects.size(), d.objects.size() == 1 ? " object" : " objects");
    s += d.unit.empty() ? "\n" : text(", unit ", d.unit, "\n");
    for (const std::size_t i : objects) {
        const Object& o = d.objects[i];
        s += text(object_label(d, i), ": ", type_name(o.shape), "\n");
        if (const Model* m = std::get_if<Model>(&o.shape)) {
            s += model_text(*m);
            continue;
        }
        const Facts f = facts_of(o.shape);
        s += patch_text(f) + range_text(control_box(o.shape));
        if (f.loops) s += text("  loops    ", *f.loops, "\n");
        s += approximations_text(o.approximations);
    }
    return s;
}

Result<std::string> mesh_info(const Context& context, const std::string& file) {
    const auto mesh = read_mesh(file);
    if (!mesh) return std::unexpected(mesh.error());
    const MeshTopology t = topology(*mesh);
    Box<3> box;
    for (const Vec<3>& p : mesh->points) box.add(p);
    if (!context.json)
        return text(file, ": a mesh\n  triangles ", mesh->triangles.size(), ", ", t.degenerate_triangles,
                    " of them degenerate\n  points   ", mesh->points.size(), "\n  edges    ", t.open_edges,
                    " open, ", t.non_manifold_edges, " of more than two triangles, ", t.misoriented_edges,
                    " of triangles that turn against each other\n", range_text(as_control_box(box)));
    json::Writer w;
    w.begin_object().field("file", file).field("type", "mesh").field("triangles", mesh->triangles.size());
    w.field("vertices", mesh->points.size()).field("open_edges", t.open_edges);
    w.field("non_manifold_edges", t.non_manifold_edges).field("misoriented_edges", t.misoriented_edges);
    w.field("degenerate_triangles", t.degenerate_triangles);
    write_range(w, as_control_box(box));
    w.end_object();
    return w.take() + "\n";
}

struct InfoArguments {
    std::string file, object;
};

Result<void> run_info(const Context& context, const InfoArguments& options) {
    if (is_mesh_file(context, options.file)) {
        const auto said = mesh_info(context, options.file);
        return said ? emit(context, *said) : std::unexpected(said.error());
    }
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const Document& document = *input->document;
    const std::string file = shown(options.file);
    return emit(context, context.json ? json_info(document, file, input->chosen)
                                      : text_info(document, file, input->chosen));
}

}  // namespace

void add_info(CommandLine& line) {
    const auto options = std::make_shared<InfoArguments>();
    const Command command =
        line.add("info", "What a file contains: counts, types, degrees, domains, boxes, unit",
                 "  freiform info teapot.bpt\n"
                 "  freiform info part.step --json\n"
                 "  freiform info part.stl              whether the mesh is closed\n"
                 "  freiform info - < curve.json");
    command.file(options->file);
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_info);
}

}  // namespace freiform::cli
