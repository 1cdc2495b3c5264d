// bench-tessellate FILE|hills|hills-with-holes --relative R [--diagonal D] [--repetitions N]
// [--times-only] [--sew]
//
// Tessellates FILE with freiform within R times the diagonal, with one thread and with two, and prints one
// line of JSON: the times of every repetition, what the library proves, and what an independent look from
// outside finds. With --sew loose faces are joined before, within the largest tolerance of the file; that is
// not timed. D is the diagonal in millimetres (in the unit of the file, where it names none); otherwise that
// of the model's box.
#include "hills_face.hpp"
#include "report_fields.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/sew.hpp>
#include <freiform/model/tessellate.hpp>

#include <iostream>

namespace {

using namespace freiform;
using namespace freiform::bench;

int fail(const Refusal& r) {
    json::Writer w;
    w.begin_object()
        .field("kind", name_of(r.kind))
        .field("where", r.where)
        .field("refusal", r.message)
        .end_object();
    std::cout << w.text() << std::endl;
    return 3;
}

double millimetres(const std::string& unit) {
    if (unit == "m") return 1000;
    if (unit == "cm") return 10;
    if (unit == "inch") return 25.4;
    if (unit == "ft" || unit == "foot") return 304.8;
    return 1;
}

// The document of the face.
std::string written(const HillsFace& face) {
    const SurfaceInput& s = face.surface;
    json::Writer w;
    const auto points = [&] {
        w.key("points").begin_array();
        for (std::size_t i = 0, n = std::size_t(s.size); i < n; ++i) {
            w.begin_array();
            for (std::size_t j = 0; j < n; ++j) w.array(std::span(s.points).subspan(3 * (i * n + j), 3));
            w.end_array();
        }
        w.end_array().key("weights").begin_array();
        for (std::size_t i = 0, n = std::size_t(s.size); i < n; ++i)
            w.array(std::span(s.weights).subspan(i * n, n));
        w.end_array();
    };
    const auto loop = [&](int degree, const std::vector<std::array<double, 2>>& at) {
        w.begin_array().begin_object().field("degree", degree);
        if (degree == 2) {
            w.key("knots").array(std::array{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4});
            w.key("weights").begin_array();
            for (int i = 0; i < 9; ++i) w.value(i % 2 ? std::sqrt(0.5) : 1.0);
            w.end_array();
        } else {
            w.key("knots").array(std::array{0, 0, 1, 2, 3, 4, 4});
        }
        w.key("points").begin_array();
        for (const auto& p : at) w.array(p);
        w.end_array().end_object().end_array();
    };
    w.begin_object().field("type", "trimmed").key("surface").begin_object().field("type", "surface");
    w.key("degrees").array(std::array{3, 3}).key("knots").begin_array().array(s.knots_u).array(s.knots_v);
    w.end_array();
    points();
    w.end_object().key("loops").begin_array();
    loop(1, {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}});
    for (const HillsFace::Hole& hole : face.holes) {
        std::vector<std::array<double, 2>> corners;
        constexpr int kX[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, kY[9] = {0, -1, -1, -1, 0, 1, 1, 1, 0};
        for (int i = 0; i < 9; ++i)
            corners.push_back({hole.u + hole.radius * kX[i], hole.v + hole.radius * kY[i]});
        loop(2, corners);
    }
    w.end_array().end_object();
    return w.take();
}

std::vector<FaceTriangles> look(const Model& model, const TriangleMesh& mesh) {
    std::vector<FaceTriangles> out;
    for (const MeshPart& part : mesh.parts) {
        FaceTriangles f;
        std::vector<int> number(mesh.vertices.size(), -1);
        for (int t = part.first; t < part.first + part.count; ++t) {
            std::array<int, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = std::size_t(mesh.triangles[std::size_t(t)][k]);
                if (number[v] < 0) {
                    number[v] = int(f.points.size());
                    f.points.push_back(mesh.points[std::size_t(mesh.vertices[v].point)].c);
                    f.uv.push_back(mesh.vertices[v].uv.c);
                }
                corners[k] = number[v];
            }
            f.triangles.push_back(corners);
        }
        f.surface = [&s = model.faces[std::size_t(part.face)].surface](double u, double v) {
            return jet<0>(s, {u, v}).value().c;
        };
        out.push_back(std::move(f));
    }
    return out;
}

void write_model(json::Writer& w, const Model& model) {
    const ModelSummary s = summary(model);
    w.field("faces", s.faces).field("solids", s.solids).field("free_edges", s.open_edges);
    w.field("unit", model.unit).field("box_diagonal", s.box.diagonal());
    double largest = 0;
    for (const Edge& e : model.edges) largest = std::max(largest, e.tolerance);
    w.field("edge_tolerance", largest);
    w.field("approximations", model.approximations.size());
}

void write_refused(json::Writer& w, const Tessellation& t, const Model& model) {
    w.key("refused").begin_array();
    for (const RefusedFace& r : t.refused)
        w.begin_object()
            .field("face", text("faces[", r.face, "]", r.name.empty() ? "" : text(" '", r.name, "'")))
            .field("where", r.reason.where)
            .field("message", r.reason.message)
            .end_object();
    for (const Refusal& r : model.refused)
        w.begin_object()
            .field("face", "file")
            .field("where", r.where)
            .field("message", r.message)
            .end_object();
    w.end_array();
}

int run(const Arguments& a) {
    const auto face = hills_face(a.file);
    const auto document = face ? read_document(written(*face)) : read_any(a.file);
    if (!document) return fail(document.error());
    auto model = scene_of(*document);
    if (!model) return fail(model.error());
    if (a.sew) {
        auto sewn = sew(*model, {.tolerance = largest_tolerance(*model)});
        if (!sewn) return fail(sewn.error());
        *model = std::move(sewn->model);
    }
    const double diagonal =
        a.diagonal > 0 ? a.diagonal / millimetres(model->unit) : summary(*model).box.diagonal();
    TessellateOptions how;
    how.tolerance = a.relative * diagonal;

    Result<Tessellation> result = refuse(RefusalKind::no_answer, "tessellate", "not run");
    const auto job = [&] { result = tessellate(*model, how); };
    set_max_threads(1);
    const std::vector<Seconds> one = repeat(a.repetitions, 3, job);
    if (!result) return fail(result.error());
    set_max_threads(2);
    const std::vector<Seconds> two = repeat(a.repetitions, 3, job);
    if (!result) return fail(result.error());

    json::Writer w;
    w.begin_object().field("tolerance", how.tolerance).field("diagonal", diagonal);
    write_times(w, "one_thread", one);
    write_times(w, "two_threads", two);
    if (!a.times_only) {
        write_model(w, *model);
        write_measured(w, look(*model, result->mesh), how.tolerance, diagonal);
        w.field("error_bound", result->error_bound).field("boundary_gap", result->boundary_gap);
        w.key("topology").begin_object();
        w.field("open_edges", result->topology.open_edges)
            .field("non_manifold_edges", result->topology.non_manifold_edges)
            .field("misoriented_edges", result->topology.misoriented_edges)
            .field("degenerate_triangles", result->topology.degenerate_triangles)
            .end_object();
        write_refused(w, *result, *model);
    }
    w.end_object();
    std::cout << w.text() << std::endl;
    return 0;
}

}  // namespace

int main(int count, char** values) {
    const std::optional<Arguments> a = parse(count, values);
    if (!a) {
        std::cerr << "usage: bench-tessellate FILE|hills|hills-with-holes --relative R [--diagonal D] "
                     "[--repetitions N] [--times-only] [--sew]\n";
        return 2;
    }
    return run(*a);
}
