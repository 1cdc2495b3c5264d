// Meshes, and nearest points of models and trimmed surfaces.
#include "shapes.hpp"

#include <freiform/io/json.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>
#include <numbers>

namespace freiform::wasm {

namespace {

Result<Model> model_of(const Held& h) {
    if (const auto* model = std::get_if<Model>(&h.object.shape)) return *model;
    Document document;
    document.objects.push_back(h.object);
    return scene_of(document);
}

void write_refused(json::Writer& w, int face, std::string_view name, const Refusal& r) {
    w.begin_object().field("face", face).field("name", name).field("kind", name_of(r.kind));
    w.field("where", r.where).field("message", r.message).end_object();
}

void write_parts(json::Writer& w, const Tessellation& t) {
    w.key("parts").begin_array();
    for (std::size_t i = 0; i < t.mesh.parts.size(); ++i) {
        const MeshPart& part = t.mesh.parts[i];
        w.begin_object().field("face", part.face).field("name", part.name).key("colour");
        if (part.colour)
            w.begin_array()
                .value(double(part.colour->r))
                .value(double(part.colour->g))
                .value(double(part.colour->b))
                .end_array();
        else
            w.null();
        w.field("first", part.first).field("count", part.count);
        w.field("errorBound", t.faces[i].error_bound).end_object();
    }
    w.end_array();
}

// Positions are floats relative to the middle of the box, so that a model far from the origin keeps its
// shape.
void put_mesh(const TriangleMesh& mesh, Vec<3>& origin) {
    Box<3> box;
    for (const Vec<3>& x : mesh.points) box.add(x);
    origin = box.is_empty() ? Vec<3>{} : 0.5 * (box.lo + box.hi);
    Reply& r = reply();
    const std::size_t n = mesh.vertices.size();
    r.floats.resize(6 * n), r.numbers.resize(2 * n), r.indices.resize(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < n; ++i) {
        const MeshVertex& v = mesh.vertices[i];
        for (int k = 0; k < 3; ++k) {
            r.floats[3 * i + std::size_t(k)] = float(mesh.points[std::size_t(v.point)][k] - origin[k]);
            r.floats[3 * (n + i) + std::size_t(k)] = float(v.normal[k]);
        }
        r.numbers[2 * i] = v.uv[0], r.numbers[2 * i + 1] = v.uv[1];
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) r.indices[3 * i + k] = std::uint32_t(mesh.triangles[i][k]);
}

}  // namespace

bool nearest_of_model(Held& h, std::span<const double> points, double accuracy) {
    if (!std::holds_alternative<Model>(h.object.shape) &&
        !std::holds_alternative<TrimmedSurface>(h.object.shape))
        return false;
    if (points.size() % 3 != 0) refuse_to_page("invalid", "points", "points have 3 numbers");
    if (!h.model_nearest) {
        auto model = model_of(h);
        if (!model) refuse_to_page(model.error());
        auto query = ModelNearestQuery::make(*std::move(model));
        if (!query) refuse_to_page(query.error());
        h.model_nearest = *std::move(query);
    }
    std::vector<Vec<3>> where(points.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) where[i / 3][int(i % 3)] = points[i];
    std::vector<ModelNearest> found(where.size());
    if (auto ok = h.model_nearest->nearest(where, found, {accuracy}); !ok) refuse_to_page(ok.error());
    for (const ModelNearest& n : found)
        reply().numbers.insert(reply().numbers.end(), {double(n.face), n.uv[0], n.uv[1], n.point[0],
                                                       n.point[1], n.point[2], n.distance, n.lower_bound});
    return true;
}

}  // namespace freiform::wasm

using namespace freiform;
using namespace freiform::wasm;

// reply: floats: positions, normals; numbers: uvs; indices; text: the rest of Mesh. What is not a positive
// number: none.
FF_EXPORT(mesh)
void ff_mesh(int handle, double tolerance, double max_edge, double max_degrees, int quads,
             double max_triangles) {
    auto model = model_of(held(handle));
    if (!model) refuse_to_page(model.error());
    TessellateOptions how;
    how.tolerance = tolerance;
    if (max_edge > 0) how.max_edge = max_edge;
    if (max_degrees > 0) how.max_angle = max_degrees * (std::numbers::pi / 180);
    how.quads = quads != 0;
    if (max_triangles > 0) how.max_triangles = (long long)(std::min(max_triangles, 1e15));
    how.progress = progress;
    const auto t = tessellate(*model, how);
    if (!t) refuse_to_page(t.error());
    Vec<3> origin;
    put_mesh(t->mesh, origin);
    json::Writer w;
    w.begin_object().key("origin").array(origin.c);
    write_parts(w, *t);
    w.key("refused").begin_array();
    for (const RefusedFace& f : t->refused) write_refused(w, f.face, f.name, f.reason);
    for (const Refusal& r : model->refused) write_refused(w, -1, "", r);
    w.end_array().field("errorBound", t->error_bound).field("boundaryGap", t->boundary_gap);
    w.field("openEdges", t->topology.open_edges).field("nonManifoldEdges", t->topology.non_manifold_edges);
    w.field("points", t->mesh.points.size()).field("seconds", t->seconds.total);
    reply().text = w.end_object().take();
}
