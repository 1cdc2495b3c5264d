// info: what a file contains.
#include "command.hpp"

#include <freiform/io/bpt.hpp>

#include <map>

namespace freiform::cli {

namespace {

constexpr char kAxis[] = "uvw";

template <int D>
void write_box(json::Writer& w, const Box<D>& box) {
    if (box.is_empty()) {
        w.key("box").null();
        return;
    }
    w.key("box").begin_object().key("min").array(box.lo.c).key("max").array(box.hi.c).end_object();
}

template <std::size_t N, class P>
auto box_of(const Patch<N, P>& s) {
    Box<Space<P>::kDim> box;
    for (const auto& p : points(s)) box.add(p);
    return box;
}

template <class P>
auto box_of(const Triangle<P>& s) {
    Box<Space<P>::kDim> box;
    for (const P& p : s.coefficients()) box.add(project(p));
    return box;
}

template <class P>
void write_triangle_info(json::Writer& w, const Triangle<P>& s) {
    w.field("degree", s.degree()).field("dimension", Space<P>::kDim).field("rational", Space<P>::kRational);
    w.key("points").array(std::array{s.coefficients().size()});
    w.key("domain").begin_array();
    for (const Interval& on : s.domain()) w.array(std::array{on.lo, on.hi});
    w.end_array();
    write_box(w, box_of(s));
}

template <std::size_t N, class P>
void write_patch_info(json::Writer& w, const Patch<N, P>& s) {
    const auto per_axis = [&](std::string_view name, auto&& content) {
        w.key(name).begin_array();
        for (const BSplineBasis& b : s.bases()) content(b);
        w.end_array();
    };
    if (N == 1)
        w.field("degree", s.basis(0).degree());
    else
        per_axis("degrees", [&](const BSplineBasis& b) { w.value(b.degree()); });
    w.field("dimension", Space<P>::kDim).field("rational", Space<P>::kRational);
    per_axis("points", [&](const BSplineBasis& b) { w.value(b.size()); });
    per_axis("pieces", [&](const BSplineBasis& b) { w.value(b.breaks().size() - 1); });
    per_axis("closed", [&](const BSplineBasis& b) { w.value(b.is_closed()); });
    per_axis("domain", [&](const BSplineBasis& b) {
        w.begin_array().value(b.domain().lo).value(b.domain().hi).end_array();
    });
    write_box(w, box_of(s));
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

void write_model_info(json::Writer& w, const Model& m) {
    const ModelSummary s = summary(m);
    if (!m.unit.empty()) w.field("unit", m.unit);
    w.field("bodies", s.bodies).field("solids", s.solids).field("shells", s.shells).field("faces", s.faces);
    w.field("edges", s.edges).field("vertices", s.vertices).field("open_edges", s.open_edges);
    w.field("seams", s.seams).field("degenerate_edges", s.degenerate_edges);
    write_counts(w, "face_kinds", face_kinds(m));
    write_counts(w, "edge_kinds", edge_kinds(m));
    w.key("refused").begin_array();
    for (const Refusal& r : m.refused)
        w.begin_object()
            .field("kind", name_of(r.kind))
            .field("where", r.where)
            .field("message", r.message)
            .end_object();
    w.end_array().key("approximations").begin_array();
    for (const Approximation& a : m.approximations) write_approximation(w, a);
    w.end_array();
    write_box(w, s.box);
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
        std::visit(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S>) {
                    write_patch_info(w, s);
                } else if constexpr (TriangularPatch<S>) {
                    write_triangle_info(w, s);
                } else if constexpr (std::same_as<S, TrimmedSurface>) {
                    w.field("loops", s.loops.size());
                    std::visit([&](const auto& surface) { write_patch_info(w, surface); }, s.surface);
                } else {
                    write_model_info(w, s);
                }
            },
            o.shape);
        w.end_object();
    }
    w.end_array().end_object();
    return w.take() + "\n";
}

template <int D>
std::string box_text(const Box<D>& box) {
    if (box.is_empty()) return "  box      empty\n";
    std::string s = "  box      ";
    for (int i = 0; i < D; ++i) s += text(i ? " x [" : "[", box.lo[i], ", ", box.hi[i], "]");
    return s + "\n";
}

template <std::size_t N, class P>
std::string patch_text(const Patch<N, P>& s) {
    std::string degrees, counts, domains, closed;
    for (std::size_t d = 0; d < N; ++d) {
        const BSplineBasis& b = s.basis(int(d));
        const std::string_view between = d ? " x " : "";
        degrees += text(between, b.degree());
        counts += text(between, b.size());
        domains += text(between, "[", b.domain().lo, ", ", b.domain().hi, "]");
        if (b.is_closed())
            closed += text(closed.empty() ? ", closed" : " and", N == 1 ? "" : text(" along ", kAxis[d]));
    }
    return text("  degree   ", degrees, ", ", counts, " points of ", Space<P>::kDim,
                Space<P>::kRational ? " coordinates, rational" : " coordinates", closed, "\n  domain   ",
                domains, "\n", box_text(box_of(s)));
}

template <class P>
std::string triangle_text(const Triangle<P>& s) {
    return text("  degree   ", s.degree(), ", ", s.coefficients().size(), " points of ", Space<P>::kDim,
                Space<P>::kRational ? " coordinates, rational" : " coordinates",
                "\n  domain   u >= 0, v >= 0, u + v <= 1\n", box_text(box_of(s)));
}

std::string kinds_text(const Counts& counts) {
    std::string s;
    for (const auto& [name, n] : counts) s += text(s.empty() ? "" : ", ", n, " ", name);
    return s.empty() ? s : text(" (", s, ")");
}

std::string model_text(const Model& m) {
    const ModelSummary s = summary(m);
    std::string t = text("  bodies   ", s.bodies, ", ", s.solids, " of them solid, ", s.shells, " shells\n");
    t += text("  faces    ", s.faces, kinds_text(face_kinds(m)), "\n");
    t += text("  edges    ", s.edges, kinds_text(edge_kinds(m)), ", ", s.open_edges, " open, ", s.seams,
              " seams\n");
    t += text("  vertices ", s.vertices, "\n");
    t += box_text(s.box);
    for (const Refusal& r : m.refused)
        t += text("  refused  ", r.where, ": ", r.message, " (", name_of(r.kind), ")\n");
    for (const Approximation& a : m.approximations)
        t += text("  approximated  ", approximation_text(a), "\n");
    return t;
}

std::string text_info(const Document& d, const std::string& file, const std::vector<std::size_t>& objects) {
    std::string s = text(file, ": ", d.objects.size(), d.objects.size() == 1 ? " object" : " objects");
    s += d.unit.empty() ? "\n" : text(", unit ", d.unit, "\n");
    for (const std::size_t i : objects) {
        const Object& o = d.objects[i];
        s += text(object_label(d, i), ": ", type_name(o.shape), "\n");
        s += std::visit(
            [](const auto& shape) -> std::string {
                using S = std::remove_cvref_t<decltype(shape)>;
                if constexpr (TensorPatch<S>)
                    return patch_text(shape);
                else if constexpr (TriangularPatch<S>)
                    return triangle_text(shape);
                else if constexpr (std::same_as<S, TrimmedSurface>)
                    return std::visit([](const auto& surface) { return patch_text(surface); },
                                      shape.surface) +
                           text("  loops    ", shape.loops.size(), "\n");
                else
                    return model_text(shape);
            },
            o.shape);
    }
    return s;
}

struct Options {
    std::string file, object;
};

Result<void> run(const Context& context, const Options& options) {
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    const std::string file = shown(options.file);
    return emit(context,
                context.json ? json_info(*document, file, *objects) : text_info(*document, file, *objects));
}

}  // namespace

void add_info(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(app, context, "info",
                                    "What a file contains: counts, types, degrees, domains, boxes, unit",
                                    "  freiform info teapot.bpt\n"
                                    "  freiform info part.step --json\n"
                                    "  freiform info - < curve.json");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_option("-o,--output", context.output, "Where the answer goes")->type_name("FILE");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
