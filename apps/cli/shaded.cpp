#include "shaded.hpp"

#include "words.hpp"

#if FREIFORM_HAS_GL
#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/colour_bar.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/mesh/refine.hpp>
#include <freiform/model/surface_field.hpp>
#include <freiform/model/surface_lines.hpp>
#include <freiform/model/tessellate.hpp>
#include <freiform/spline/simplex_convert.hpp>
#if FREIFORM_HAS_CAIRO
#include <freiform/io/figure.hpp>
#include <freiform/paint/paint.hpp>
#endif

#include <algorithm>
#include <cmath>
#endif

namespace freiform::cli {

#if FREIFORM_HAS_GL

namespace {

constexpr double kFirst = 1.0 / 500, kFinest = 0x1p-20;  // of the model's box
constexpr double kUnseen = 0.25;                         // of a pixel: outlines are smooth
constexpr double kMirrorTolerance =
    1.0 / 16000;                          // normals between vertices are interpolated: stripes show it
constexpr double kFieldSide = 1.0 / 150;  // longest side of a coloured triangle, of the model's box
constexpr std::size_t kFieldTriangles = 2'000'000;
constexpr double kRounding =
    1e-6;  // curvature times size of the box below which nothing but rounding is seen
constexpr double kNeedle = 1.0 / 25;  // length of normals, of the model's box

struct Field {
    std::string_view name, title;
    SurfaceField field;
    int power;  // of 1 / length; -1: a length
};
constexpr std::array<Field, 5> kFields{{{"gauss", "Gauss curvature", SurfaceField::gauss, 2},
                                        {"mean", "mean curvature", SurfaceField::mean, 1},
                                        {"greatest", "greatest curvature", SurfaceField::greatest, 1},
                                        {"least", "least curvature", SurfaceField::least, 1},
                                        {"error", "distance of the mesh", SurfaceField::error, -1}}};

std::string unit_of(const Field& f, const std::string& length) {
    if (length.empty()) return {};
    return f.power == -1 ? length : f.power == 1 ? text("1/", length) : text("1/", length, "\u00b2");
}

struct Subject {
    Scene scene;
    Tessellation tessellation;
    double size = 0;  // of the box
};

RenderOptions render_options(const ShadedOptions& o) {
    RenderOptions how;
    how.view = o.view;
    how.width = o.width.value_or(how.width);
    how.height = o.height.value_or(how.height);
    how.edges = o.edges, how.zebra = o.zebra, how.isophotes = o.isophotes, how.perspective = o.perspective;
    return how;
}

// How large a pixel is depends on what is seen of the model, which a coarse mesh tells.
Result<Tessellation> mesh_for_picture(const Model& model, double size, const Limits& limits,
                                      const ShadedOptions& options) {
    const bool reflects = options.zebra || options.isophotes;
    TessellateOptions how;
    how.tolerance = options.tolerance.value_or(size * (reflects ? kMirrorTolerance : kFirst));
    how.max_triangles = (long long)(limits.max_triangles);
    auto first = tessellate(model, how);
    if (!first || options.tolerance) return first;
    const double pixel = pixel_size(first->mesh, render_options(options)),
                 unseen = std::max(kUnseen * pixel, kFinest * size);
    if (!(pixel > 0 && unseen < how.tolerance)) return first;
    how.tolerance = unseen;
    auto finer = tessellate(model, how);
    if (finer || finer.error().kind != RefusalKind::limit) return finer;
    remark(text("drawn within ", first->error_bound,
                " of the surfaces, which may be seen: ", finer.error().message));
    return first;
}

Result<Subject> subject_of(const Document& document, std::span<const std::size_t> objects,
                           const Limits& limits, const ShadedOptions& options) {
    auto scene = scene_with_owners(document, objects);
    if (!scene) return std::unexpected(scene.error());
    Subject s{std::move(*scene), {}, 0};
    s.size = summary(s.scene.model).box.diagonal();
    auto t = mesh_for_picture(s.scene.model, s.size, limits, options);
    if (!t) return std::unexpected(t.error());
    s.tessellation = std::move(*t);
    if (s.tessellation.mesh.triangles.empty() && !s.tessellation.refused.empty()) {
        const RefusedFace& r = s.tessellation.refused[0];
        return refuse(RefusalKind::no_answer, text("face ", r.face, " ", r.name),
                      text("nothing can be drawn: ", r.reason.message));
    }
    for (const RefusedFace& r : s.tessellation.refused)
        remark(text("face ", r.face, " is missing: ", r.reason.where, ": ", r.reason.message));
    for (const Refusal& r : s.scene.model.refused) remark(text(r.where, " is missing: ", r.message));
    return s;
}

RenderLines polylines(std::span<const SurfaceLine> lines, const Colour& colour, double width) {
    RenderLines out{{}, colour, width, 0};
    for (const SurfaceLine& l : lines)
        for (std::size_t i = 1; i < l.points.size(); ++i)
            out.segments.push_back({l.points[i - 1], l.points[i]});
    return out;
}

std::vector<RenderLines> overlays(const Document& document, std::span<const std::size_t> objects,
                                  const Subject& s, const ShadedOptions& o) {
    std::vector<RenderLines> out;
    const TriangleMesh& mesh = s.tessellation.mesh;
    if (o.isolines)
        out.push_back(polylines(isolines(s.scene.model, mesh, o.isolines), {0.12, 0.14, 0.18, 1}, 0.9));
    if (o.normals) {
        // Blue on grey; on the colours of a field, which have blue among them, ink.
        const Colour colour = o.colour.empty() ? Colour{0.05, 0.30, 0.62, 1} : Colour{0.05, 0.05, 0.06, 1};
        RenderLines needles{{}, colour, 1.2, 0}, feet{{}, colour, 3.5, 0};
        for (const SurfaceNormal& n : surface_normals(mesh, *o.normals)) {
            needles.segments.push_back({n.foot, n.foot + kNeedle * s.size * n.normal});
            feet.segments.push_back({n.foot, n.foot});
        }
        out.push_back(std::move(needles));
        out.push_back(std::move(feet));
    }
    if (o.control) {
        RenderLines lines{{}, {0.62, 0.18, 0.05, 1}, 1.3, 0.3}, points{{}, {0.62, 0.18, 0.05, 1}, 6, 0.35};
        for (const ControlNet& net : control_nets(document, objects)) {
            for (const auto& l : net.lines)
                for (std::size_t i = 1; i < l.size(); ++i) lines.segments.push_back({l[i - 1], l[i]});
            for (const Vec<3>& p : net.points) points.segments.push_back({p, p});
        }
        out.push_back(std::move(lines));
        out.push_back(std::move(points));
    }
    return out;
}

struct Painted {
    FieldValues values;
    Interval all{0, 0};
    ColourBar bar;
};

// The range of the map: asked for, or from the values; of what has a sign the same on both sides of 0.
Interval range_of(const TriangleMesh& mesh, const Painted& p, const Field& f, double size,
                  const ShadedOptions& o) {
    if (!o.range.empty()) return {o.range[0], o.range[1]};
    if (f.power == -1) return {0, std::max(p.all.hi, 0.0)};
    const Interval usual = usual_range(mesh, p.values.values);
    double most = usual.lo <= usual.hi ? std::max(std::abs(usual.lo), std::abs(usual.hi)) : 0;
    if (size > 0) most = std::max(most, kRounding / std::pow(size, f.power));
    return {-most, most};
}

Painted painted(const Subject& s, const TriangleMesh& mesh, const Field& f, const ShadedOptions& o) {
    Painted p;
    p.values = surface_field(s.scene.model, mesh, f.field);
    Box<1> all;
    for (const double v : p.values.values)
        if (std::isfinite(v)) all.add(Vec<1>{{v}});
    if (!all.is_empty()) p.all = all.side(0);
    p.bar.range = range_of(mesh, p, f, s.size, o);
    p.bar.map = f.power == -1 ? MapKind::sequential : MapKind::diverging;
    p.bar.title = plain_text(f.title);
    const std::string unit = unit_of(f, mesh.unit);
    if (!unit.empty()) p.bar.remarks.push_back(plain_text(text("in ", unit)));
    if (o.range.empty() && f.power != -1) p.bar.remarks.push_back(plain_text("90 % of the area"));
    if (f.power != -1) p.bar.remarks.push_back(plain_text("estimated at vertices"));
    if (f.power == -1) {
        p.bar.remarks.push_back(plain_text("measured; proven:"));
        p.bar.remarks.push_back(plain_text(text("at most ", rounded_up(s.tessellation.error_bound))));
    }
    if (p.values.beside > 0) p.bar.remarks.push_back(plain_text("poles: from beside"));
    p.bar.no_value = p.values.missing > 0;
    return p;
}

std::string report_of(const Painted& p, const Field& f, const Subject& s) {
    json::Writer w;
    w.begin_object().field("colour", f.name).field("unit", unit_of(f, s.scene.model.unit));
    w.key("range").begin_array().value(p.bar.range.lo).value(p.bar.range.hi).end_array();
    w.field("least", p.all.lo).field("greatest", p.all.hi);
    w.field("from_beside", p.values.beside).field("without_value", p.values.missing);
    w.field("error_bound", s.tessellation.error_bound).end_object();
    return w.take() + "\n";
}

// The reason why shaders cannot draw it, in words of the command line.
std::string_view needs_mesh(const ShadedOptions& o) {
    if (o.edges) return "--edges are those of a mesh";
    if (o.tolerance) return "--tolerance is that of a mesh";
    if (!o.colour.empty()) return "--colour takes numbers at the vertices of a mesh";
    if (o.isolines || o.normals || o.control)
        return "isolines, normals and control nets are drawn over a mesh";
    return {};
}

// Triangles as they are, everything else as faces of a model.
struct DirectScene {
    Model model;
    std::vector<TriangularFace> triangles;
};
Result<DirectScene> direct_scene(const Document& document, std::span<const std::size_t> objects) {
    DirectScene out;
    std::vector<std::size_t> others;
    for (const std::size_t i : objects) {
        const Shape& shape = document.objects[i].shape;
        if (const auto* t = std::get_if<Triangle<Hom<3>>>(&shape)) {
            out.triangles.push_back({*t, {}});
        } else if (const auto* p = std::get_if<Triangle<Vec<3>>>(&shape)) {
            out.triangles.push_back({to_rational(*p), {}});
        } else {
            others.push_back(i);
        }
    }
    if (others.empty()) return out;
    auto model = scene_of(document, others);
    if (!model && !(model.error().kind == RefusalKind::no_answer && !out.triangles.empty()))
        return std::unexpected(model.error());
    if (model) out.model = std::move(*model);
    return out;
}

Result<Image> drawn_directly(const Document& document, std::span<const std::size_t> objects,
                             const ShadedOptions& o) {
    if (const auto reason = needs_mesh(o); !reason.empty())
        return refuse(RefusalKind::unsupported, "--gpu", std::string(reason));
    const auto scene = direct_scene(document, objects);
    if (!scene) return std::unexpected(scene.error());
    Box<3> box = summary(scene->model).box;
    for (const TriangularFace& t : scene->triangles)
        for (const Hom<3>& h : t.patch.coefficients()) box.add(project(h));
    if (!(box.diagonal() > 0)) return refuse(RefusalKind::no_answer, "model", "it has no extent");
    auto buffers = surface_buffers(scene->model, scene->triangles,
                                   {.edge_tolerance = box.diagonal() * kMirrorTolerance});
    if (!buffers) return std::unexpected(buffers.error());
    auto renderer = SurfaceRenderer::make(std::move(*buffers));
    if (!renderer) return std::unexpected(renderer.error());
    auto image = renderer->draw(render_options(o));
    if (image)
        for (const Refusal& r : scene->model.refused) remark(text(r.where, " is missing: ", r.message));
    return image;
}

Result<std::string> png_of(const TriangleMesh& mesh, RenderOptions how, const ColourBar* bar) {
    if (bar && how.width >= 2 * kColourBarRoom) how.room = kColourBarRoom;
    auto image = render(mesh, how);
    if (!image) return std::unexpected(image.error());
    if (how.room > 0) {
#if FREIFORM_HAS_CAIRO
        if (auto ok = paint_over(*image, drawing_of(*bar, how.width, how.height)); !ok)
            return std::unexpected(ok.error());
#else
        remark("this program was built without cairo: the picture has no colour bar; --json says its range");
#endif
    }
    return to_png(*image);
}

}  // namespace

Result<ShadedPicture> shaded(const TriangleMesh& mesh, const ShadedOptions& o) {
    if (!o.colour.empty() && o.colour != "normal")
        return refuse(RefusalKind::no_answer, "colour",
                      text("a mesh has no surface to take ", o.colour, " from; it has normals"));
    if (o.isolines || o.control || o.normals)
        return refuse(RefusalKind::no_answer,
                      o.isolines  ? "isolines"
                      : o.control ? "control"
                                  : "normals",
                      "a mesh has no surfaces to draw them of");
    RenderOptions how = render_options(o);
    if (o.colour == "normal") how.painting = Painting::normals;
    auto png = png_of(mesh, how, nullptr);
    if (!png) return std::unexpected(png.error());
    return ShadedPicture{std::move(*png), "{}\n"};
}

Result<ShadedPicture> shaded(const Document& document, std::span<const std::size_t> objects,
                             const Limits& limits, const ShadedOptions& o) {
    if (o.gpu) {
        const auto image = drawn_directly(document, objects, o);
        if (image) {
            auto png = to_png(*image);
            if (!png) return std::unexpected(png.error());
            return ShadedPicture{std::move(*png), "{}\n"};
        }
        remark(text("drawn as a mesh: ", image.error().where, ": ", image.error().message));
    }
    const auto s = subject_of(document, objects, limits, o);
    if (!s) return std::unexpected(s.error());
    RenderOptions how = render_options(o);
    const std::vector<RenderLines> lines = overlays(document, objects, *s, o);
    how.lines = lines;
    const TriangleMesh* mesh = &s->tessellation.mesh;
    TriangleMesh fine;
    Painted p;
    std::string report = "{}\n";
    const auto field = std::ranges::find(kFields, o.colour, &Field::name);
    if (o.colour == "normal") {
        how.painting = Painting::normals;
        p.bar.title = plain_text("normal");
        for (const char* line : {"x red", "y green", "z blue"}) p.bar.remarks.push_back(plain_text(line));
    } else if (field != kFields.end()) {
        // An error is 0 at the old vertices: at least two rounds, so that there are others.
        fine = refined(*mesh, std::max(s->size * kFieldSide, 1e-300), kFieldTriangles,
                       field->field == SurfaceField::error ? 2 : 0);
        mesh = &fine;
        p = painted(*s, fine, *field, o);
        how.painting = p.bar.map == MapKind::diverging ? Painting::diverging : Painting::sequential;
        how.field = p.values.values;
        how.range = p.bar.range;
        report = report_of(p, *field, *s);
    }
    auto png = png_of(*mesh, how, o.colour.empty() ? nullptr : &p.bar);
    if (!png) return std::unexpected(png.error());
    return ShadedPicture{std::move(*png), std::move(report)};
}

Result<std::string> coloured(const TriangleMesh& mesh, const VertexNumbers& numbers, const ShadedOptions& o) {
    RenderOptions how = render_options(o);
    how.painting = Painting::sequential;
    how.field = numbers.values;
    how.range = numbers.range;
    ColourBar bar;
    bar.range = numbers.range;
    bar.map = MapKind::sequential;
    bar.title = plain_text(numbers.title);
    for (const std::string& r : numbers.remarks) bar.remarks.push_back(plain_text(r));
    return png_of(mesh, how, &bar);
}

#else

namespace {
std::unexpected<Refusal> not_built() {
    return refuse(
        RefusalKind::unavailable, "draw",
        "this program was built without .png of surfaces: install libegl-dev libepoxy-dev libpng-dev "
        "and build again, or write .svg");
}
}  // namespace

Result<ShadedPicture> shaded(const TriangleMesh&, const ShadedOptions&) { return not_built(); }
Result<ShadedPicture> shaded(const Document&, std::span<const std::size_t>, const Limits&,
                             const ShadedOptions&) {
    return not_built();
}

Result<std::string> coloured(const TriangleMesh&, const VertexNumbers&, const ShadedOptions&) {
    return not_built();
}

#endif

}  // namespace freiform::cli
