#include "input.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/step_read.hpp>

namespace freiform::cli {

std::string Input::label(std::size_t i) const {
    return document->objects.size() > 1 ? object_label(*document, i) : shown(file);
}

std::unexpected<Refusal> Input::about(std::size_t i, Refusal r) const {
    r.where = r.where.empty() ? label(i) : text(label(i), ": ", r.where);
    return std::unexpected(std::move(r));
}

namespace {

bool is_mesh_name(const std::string& file) {
    const auto format = mesh_format(file);
    return format && *format != MeshFormat::obj;
}

}  // namespace

void write_refusals(json::Writer& w, std::string_view name, const std::vector<Refusal>& list) {
    w.key(name).begin_array();
    for (const Refusal& r : list)
        w.begin_object()
            .field("kind", name_of(r.kind))
            .field("where", r.where)
            .field("message", r.message)
            .end_object();
    w.end_array();
}

bool is_mesh_file(const Context& context, const std::string& file) {
    if (format_of_name(file) == FileFormat::step) {
        const auto bytes = read_file(file, context.read_options().max_bytes);
        return bytes && has_only_triangles(*bytes);
    }
    if (!mesh_format(file) || is_mesh_name(file)) return is_mesh_name(file);
    const auto read = read_any(file, context.read_options());
    return !read && read.error().kind == RefusalKind::no_answer;
}

Result<Input> read_input(const Context& context, const std::string& file, const std::string& object) {
    auto document = read_any(file, context.read_options());
    if (!document && document.error().kind == RefusalKind::unreadable && is_mesh_name(file))
        return refuse(
            RefusalKind::unreadable, shown(file),
            "curves, surfaces or a model are expected, not triangles; info, draw and check read those");
    if (!document && document.error().kind == RefusalKind::no_answer && is_mesh_file(context, file))
        document.error().message +=
            ": info, draw and check do that, and convert writes them as .stl, .ply, .glb or .obj";
    if (!document) return std::unexpected(document.error());
    auto chosen = selected(*document, object);
    if (!chosen) return std::unexpected(chosen.error());
    for (const Refusal& r : document->left_out) remark(text(shown(file), ": ", r.where, ": ", r.message));
    remark_changes(*document, *chosen);
    return Input{file, std::make_shared<const Document>(*std::move(document)), *std::move(chosen)};
}

void remark_changes(const Document& document, std::span<const std::size_t> objects) {
    for (const std::size_t i : objects)
        for (const Approximation& a : document.objects[i].approximations)
            remark(text(object_label(document, i), ": ", approximation_text(a)));
    constexpr std::size_t kMost = 20;
    for (const std::size_t i : objects) {
        const auto* model = std::get_if<Model>(&document.objects[i].shape);
        if (!model) continue;
        for (std::size_t k = 0; k < std::min(kMost, model->repairs.size()); ++k)
            remark(text("repaired ", repair_text(model->repairs[k])));
        if (model->repairs.size() > kMost)
            remark(text("repaired ", model->repairs.size() - kMost, " more: info lists them"));
    }
}

void remark_left_out(const Input& input, std::size_t i) {
    remark(text(object_label(*input.document, i), ": is a ", type_name(input.object(i).shape),
                ", not a curve, and left out"));
}

Result<Model> model_of_trimmed(const TrimmedSurface& t) {
    Model m;
    Face face;
    visit_one([&](const auto& s) { face.surface = s; }, t.surface);
    for (const auto& curves : t.loops) {
        Loop loop;
        for (const auto& c : curves) {
            Edge edge;
            edge.range = domain(c)[0];
            const auto uv = jet<0>(c, edge.range.lo).value();
            edge.start = int(m.vertices.size());
            const std::size_t next = loop.coedges.size() + 1;
            edge.end = next == curves.size() ? edge.start - int(loop.coedges.size()) : edge.start + 1;
            m.vertices.push_back({jet<0>(face.surface, uv.c).value(), 0});
            loop.coedges.push_back({int(m.edges.size()), false, c});
            m.edges.push_back(std::move(edge));
        }
        face.loops.push_back(std::move(loop));
    }
    m.faces.push_back(std::move(face));
    return make_model(std::move(m));
}

std::span<const BSplineBasis> bases_of(const Shape& shape) {
    return visit_one(
        [](const auto& s) -> std::span<const BSplineBasis> {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>)
                return s.bases();
            else if constexpr (std::same_as<S, TrimmedSurface>)
                return visit_one(
                    [](const auto& surface) -> std::span<const BSplineBasis> { return surface.bases(); },
                    s.surface);
            else
                return {};
        },
        shape);
}

namespace {

template <class P>
ControlBox box_of(std::span<const P> coefficients) {
    Box<Space<P>::kDim> box;
    for (const P& p : coefficients) box.add(project(p));
    if (box.is_empty()) return {};
    return {{box.lo.c.begin(), box.lo.c.end()}, {box.hi.c.begin(), box.hi.c.end()}, box.diagonal()};
}

struct Boxing {
    template <TensorPatch S>
    ControlBox operator()(const S& s) const {
        return box_of<typename S::Coefficients>(s.net().flat());
    }
    template <TriangularPatch S>
    ControlBox operator()(const S& s) const {
        return box_of<typename S::Coefficients>(s.coefficients());
    }
    ControlBox operator()(const TrimmedSurface& t) const { return visit_one(*this, t.surface); }
    ControlBox operator()(const Model&) const { return {}; }
};

}  // namespace

ControlBox control_box(const Shape& shape) { return visit_one(Boxing(), shape); }

}  // namespace freiform::cli
