#include "nearest_models.hpp"

#include <freiform/model/inside.hpp>
#include <freiform/model/nearest.hpp>

#include <algorithm>
#include <map>

namespace freiform::cli {

namespace {

// A trimmed surface as a model of one face, whose edges have no curves of their own. A loop is a chain of
// splines, or one ellipse.
Result<Model> model_of_trimmed(const TrimmedSurface& t) {
    Model m;
    Face face;
    std::visit([&](const auto& s) { face.surface = s; }, t.surface);
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

struct FoundOnModel {
    std::size_t object = 0;
    ModelNearest nearest;
    std::optional<SolidInside> inside;
};

void print_on_model(const Input& input, const Model& model, const Vec<3>& q, const FoundOnModel& f,
                    json::Writer& w, std::string& plain) {
    const ModelNearest& n = f.nearest;
    w.new_line(1)
        .begin_object()
        .key("query")
        .array(q.c)
        .field("object", f.object)
        .field("name", input.object(f.object).name)
        .field("face", n.face)
        .field("face_name", model.faces[std::size_t(n.face)].name)
        .key("parameters")
        .array(n.uv.c);
    if (n.edge >= 0) w.field("edge", n.edge).field("edge_parameter", n.t);
    if (n.vertex >= 0) w.field("vertex", n.vertex);
    w.key("point")
        .array(n.point.c)
        .field("distance", n.distance)
        .field("lower_bound", n.lower_bound)
        .field("point_error", n.point_error);
    std::string side;
    if (f.inside) {
        side = f.inside->place == Place::boundary ? "undecided"
               : f.inside->place == Place::inside ? "inside"
                                                  : "outside";
        w.field("side", side);
        if (f.inside->place != Place::boundary)
            w.field("signed_distance", f.inside->place == Place::inside ? -n.distance : n.distance);
    }
    w.end_object();
    plain +=
        text(input.label(f.object), ": face ", n.face, " at ", n.uv[0], ", ", n.uv[1],
             n.edge >= 0 ? text(", on edge ", n.edge) : "", n.vertex >= 0 ? text(", vertex ", n.vertex) : "",
             ", point ", n.point[0], ", ", n.point[1], ", ", n.point[2], ", distance ", n.distance,
             ", at least ", n.lower_bound, side.empty() ? "" : ", ", side, "\n");
}

}  // namespace

Result<void> nearest_of_models(const Context& context, const Input& input,
                               const std::vector<std::vector<double>>& rows, const ModelsAsked& asked) {
    if (asked.otherwise)
        return refuse(
            RefusalKind::no_answer, input.label(input.chosen[0]),
            "--radius, --k and --farthest are answered for curves, surfaces, volumes and triangles");
    std::vector<Vec<3>> points;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].size() != 3)
            return refuse(RefusalKind::no_answer, text("points[", i, "]"),
                          text("has ", rows[i].size(), " coordinates, models are in space"));
        points.push_back({{rows[i][0], rows[i][1], rows[i][2]}});
    }
    std::vector<FoundOnModel> best(points.size());
    std::map<std::size_t, ModelNearestQuery> queries;
    for (const std::size_t i : input.chosen) {
        const Shape& shape = input.object(i).shape;
        Result<Model> model =
            refuse(RefusalKind::no_answer, input.label(i),
                   "is not a model: --object chooses, models and others are asked one by one");
        if (const auto* m = std::get_if<Model>(&shape))
            model = *m;
        else if (const auto* t = std::get_if<TrimmedSurface>(&shape))
            model = model_of_trimmed(*t);
        if (!model) return std::unexpected(model.error());
        auto query = ModelNearestQuery::make(*std::move(model));
        if (!query) return refuse_within(input.label(i), query.error());
        std::vector<ModelNearest> nearest(points.size());
        if (auto done = query->nearest(points, nearest, {.accuracy = asked.accuracy}); !done) return done;
        std::vector<SolidInside> inside;
        if (asked.with_sign) {
            // Finer, and the mesh that decides it takes minutes.
            const double accuracy = 1e-4 * summary(query->model()).box.diagonal();
            std::vector<Vec<3>> away;
            for (std::size_t k = 0; k < points.size(); ++k)
                if (nearest[k].lower_bound > accuracy) away.push_back(points[k]);
            const auto in =
                inside_solid(query->model(), away, accuracy, (long long)(context.limits.max_triangles));
            if (!in) return refuse_within(input.label(i), in.error());
            inside.assign(points.size(), {Place::boundary, 0, accuracy});
            for (std::size_t k = 0, next = 0; k < points.size(); ++k)
                if (nearest[k].lower_bound > accuracy) inside[k] = (*in)[next++];
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            FoundOnModel& b = best[k];
            const double lower = queries.empty() ? nearest[k].lower_bound
                                                 : std::min(b.nearest.lower_bound, nearest[k].lower_bound);
            if (queries.empty() || nearest[k].distance < b.nearest.distance) {
                b.object = i;
                b.nearest = nearest[k];
                if (!inside.empty()) b.inside = inside[k];
            }
            b.nearest.lower_bound = lower;
        }
        queries.emplace(i, *std::move(query));
    }
    json::Writer w;
    std::string plain;
    w.begin_object().key("results").begin_array();
    for (std::size_t k = 0; k < points.size(); ++k)
        print_on_model(input, queries.at(best[k].object).model(), points[k], best[k], w, plain);
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

}  // namespace freiform::cli
