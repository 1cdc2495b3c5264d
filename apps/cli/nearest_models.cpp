#include "nearest_models.hpp"

#include "nearest_objects.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/model/inside.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform::cli {

namespace {

struct FoundOnModel {
    std::size_t object = 0;
    ModelNearest nearest;
    std::optional<SolidInside> inside;
    int params = 0;  // of another object, which has no faces: nearest.uv, nearest.t
};

// Where these are nearer they take the place, and the least of the lower bounds holds for all.
Result<void> nearest_beside(const ObjectSet& beside, const std::vector<Vec<3>>& points, double accuracy,
                            std::vector<FoundOnModel>& best) {
    if (beside.objects.empty()) return {};
    const auto query = NearestQuery::make(beside.objects);
    if (!query) return std::unexpected(query.error());
    std::vector<Nearest<3>> nearest(points.size());
    if (auto done = query->nearest<3>(points, nearest, {.accuracy = accuracy}); !done) return done;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Nearest<3>& n = nearest[k];
        FoundOnModel& b = best[k];
        const double lower = std::min(b.nearest.lower_bound, n.lower_bound);
        if (n.distance < b.nearest.distance) {
            b = {beside.index[n.object], {}, {}, int(beside.params[n.object])};
            b.nearest.uv = {{n.at[0], n.at[1]}};
            b.nearest.t = n.at[2];
            b.nearest.point = n.point;
            b.nearest.distance = n.distance;
            b.nearest.point_error = n.point_error;
        }
        b.nearest.lower_bound = lower;
    }
    return {};
}

void print_beside(const Input& input, const Vec<3>& q, const FoundOnModel& f, json::Writer& w,
                  std::string& plain) {
    const ModelNearest& n = f.nearest;
    const std::array at{n.uv[0], n.uv[1], n.t};
    const std::span<const double> own(at.data(), std::size_t(f.params));
    w.new_line(1).begin_object().key("query").array(q.c).field("object", f.object);
    w.field("name", input.object(f.object).name).key("parameters").array(own).key("point").array(n.point.c);
    w.field("distance", n.distance).field("lower_bound", n.lower_bound).field("point_error", n.point_error);
    w.end_object();
    plain += text(input.label(f.object), ": at ", listed_numbers(own), ", point ", listed_numbers(n.point.c),
                  ", distance ", n.distance, ", at least ", n.lower_bound, "\n");
}

void print_on_model(const Input& input, const Model& model, const Vec<3>& q, const FoundOnModel& f,
                    json::Writer& w, std::string& plain) {
    const ModelNearest& n = f.nearest;
    w.new_line(1)
        .begin_object()
        .key("query")
        .array(q.c)
        .field("object", f.object)
        .field("name", input.object(f.object).name)
        .field("face_name", model.faces[std::size_t(n.face)].name);
    write_place(w, n);
    if (n.edge >= 0) w.field("edge_parameter", n.t);
    w.field("distance", n.distance).field("lower_bound", n.lower_bound).field("point_error", n.point_error);
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
    plain += text(input.label(f.object), ": ", place_text(n), ", distance ", n.distance, ", at least ",
                  n.lower_bound, side.empty() ? "" : ", ", side, "\n");
}

using Queries = std::map<std::size_t, ModelNearestQuery>;  // by object

// What all answers about one place of a model begin with.
void begin_place(json::Writer& w, const Input& input, std::size_t object) {
    w.begin_object().field("object", object).field("name", input.object(object).name);
}

Result<void> farthest_of(const Input& input, const Queries& queries, const Vec<3>& q, double accuracy,
                         json::Writer& w, std::string& plain) {
    ModelFarthest best;
    std::size_t object = 0;
    double upper = 0;
    for (const auto& [i, query] : queries) {
        const auto far = query.farthest(q, {.accuracy = accuracy});
        if (!far) return std::unexpected(far.error());
        upper = std::max(upper, far->upper_bound);
        if (best.face < 0 || far->distance > best.distance) best = *far, object = i;
    }
    ModelNearest place;
    place.face = best.face, place.uv = best.uv, place.edge = best.edge, place.point = best.point;
    w.new_line(1).begin_object().key("query").array(q.c).field("object", object);
    w.field("name", input.object(object).name);
    write_place(w, place);
    w.field("distance", best.distance).field("upper_bound", upper).field("point_error", best.point_error);
    w.end_object();
    plain += text(input.label(object), ": ", place_text(place), ", distance ", best.distance, ", at most ",
                  upper, "\n");
    return {};
}

// The nearest faces of all models: so many, or those within a radius.
Result<void> nearest_faces_of(const Input& input, const Queries& queries, const Vec<3>& q,
                              const ModelsAsked& asked, json::Writer& w, std::string& plain) {
    struct Near {
        std::size_t object;
        ModelNearest at;
    };
    std::vector<Near> near;
    double others = kInfinity;
    for (const auto& [i, query] : queries) {
        const auto faces =
            query.nearest_faces(q, asked.count.value_or(std::numeric_limits<int>::max()),
                                asked.radius.value_or(kInfinity), {.accuracy = asked.accuracy});
        if (!faces) return std::unexpected(faces.error());
        for (const ModelNearest& n : faces->faces) near.push_back({i, n});
        others = std::min(others, faces->others);
    }
    sort(near, {}, [](const Near& n) { return std::tuple(n.at.distance, n.object, n.at.face); });
    while (asked.count && near.size() > std::size_t(*asked.count)) {
        others = std::min(others, near.back().at.lower_bound);
        near.pop_back();
    }
    w.new_line(1).begin_object().key("query").array(q.c).key("faces").begin_array();
    plain += text(listed_numbers(q.c), ": ", near.size(), " faces\n");
    for (const Near& n : near) {
        w.new_line(2);
        begin_place(w, input, n.object);
        write_place(w, n.at);
        w.field("distance", n.at.distance).field("lower_bound", n.at.lower_bound);
        w.field("point_error", n.at.point_error).end_object();
        plain += text("  ", input.label(n.object), ": ", place_text(n.at), ", distance ", n.at.distance,
                      ", at least ", n.at.lower_bound, "\n");
    }
    w.end_array();
    if (std::isfinite(others)) w.field("others_lower_bound", others);
    w.end_object();
    plain += std::isfinite(others) ? text("  others: at least ", others, "\n")
                                   : std::string("  there are no others\n");
    return {};
}

// Instead of the nearest point, for every point.
Result<void> answer_otherwise(const Context& context, const Input& input, const Queries& queries,
                              std::span<const Vec<3>> points, const ModelsAsked& asked) {
    json::Writer w;
    std::string plain;
    w.begin_object().key("results").begin_array();
    for (const Vec<3>& q : points) {
        const auto done = asked.farthest ? farthest_of(input, queries, q, asked.accuracy, w, plain)
                                         : nearest_faces_of(input, queries, q, asked, w, plain);
        if (!done) return done;
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

// Models, and trimmed surfaces as such; nothing of what else there is.
Result<std::optional<Model>> model_of(const Shape& shape) {
    if (const auto* own = std::get_if<Model>(&shape)) return *own;
    const auto* trimmed = std::get_if<TrimmedSurface>(&shape);
    if (!trimmed) return std::nullopt;
    auto model = model_of_trimmed(*trimmed);
    if (!model) return std::unexpected(model.error());
    return *std::move(model);
}

// Where this model is nearer than the best so far; `first`: there is none.
Result<void> nearest_of_model(const Context& context, const Input& input, std::size_t i,
                              const ModelNearestQuery& query, const std::vector<Vec<3>>& points,
                              const ModelsAsked& asked, bool first, std::vector<FoundOnModel>& best) {
    std::vector<ModelNearest> nearest(points.size());
    if (auto done = query.nearest(points, nearest, {.accuracy = asked.accuracy}); !done) return done;
    std::vector<SolidInside> inside;
    if (asked.with_sign) {
        const double accuracy = 1e-6 * summary(query.model()).box.diagonal();
        std::vector<Vec<3>> away;
        for (std::size_t k = 0; k < points.size(); ++k)
            if (nearest[k].lower_bound > accuracy) away.push_back(points[k]);
        const auto in =
            inside_solid(query.model(), away, accuracy, (long long)(context.limits.max_triangles));
        if (!in) return refuse_within(input.label(i), in.error());
        inside.assign(points.size(), {Place::boundary, 0, accuracy});
        for (std::size_t k = 0, next = 0; k < points.size(); ++k)
            if (nearest[k].lower_bound > accuracy) inside[k] = (*in)[next++];
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        FoundOnModel& b = best[k];
        const double lower =
            first ? nearest[k].lower_bound : std::min(b.nearest.lower_bound, nearest[k].lower_bound);
        if (first || nearest[k].distance < b.nearest.distance) {
            b.object = i;
            b.nearest = nearest[k];
            if (!inside.empty()) b.inside = inside[k];
        }
        b.nearest.lower_bound = lower;
    }
    return {};
}

}  // namespace

Result<void> nearest_of_models(const Context& context, const Input& input,
                               const std::vector<std::vector<double>>& rows, const ModelsAsked& asked) {
    std::vector<Vec<3>> points;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].size() != 3)
            return refuse(RefusalKind::no_answer, text("points[", i, "]"),
                          text("has ", rows[i].size(), " coordinates, models are in space"));
        points.push_back({{rows[i][0], rows[i][1], rows[i][2]}});
    }
    std::vector<FoundOnModel> best(points.size());
    Queries queries;
    ObjectSet beside;
    beside.coordinates = 3;
    const bool otherwise = asked.farthest || asked.radius || asked.count;
    for (const std::size_t i : input.chosen) {
        if (auto done = add_object(input, i, "models are in space; --object chooses", beside); !done)
            return done;
        auto model = model_of(input.object(i).shape);
        if (!model) return std::unexpected(model.error());
        if (!*model) continue;
        auto query = ModelNearestQuery::make(*std::move(*model));
        if (!query) return refuse_within(input.label(i), query.error());
        if (!otherwise)
            if (auto done = nearest_of_model(context, input, i, *query, points, asked, queries.empty(), best);
                !done)
                return done;
        queries.emplace(i, *std::move(query));
    }
    if (otherwise && !beside.objects.empty())
        return refuse(
            RefusalKind::no_answer, input.label(beside.index[0]),
            "is no model; --radius, --k and --farthest look at faces of models, or at what is none: "
            "--object chooses");
    if (otherwise) return answer_otherwise(context, input, queries, points, asked);
    if (auto done = nearest_beside(beside, points, asked.accuracy, best); !done) return done;
    json::Writer w;
    std::string plain;
    w.begin_object().key("results").begin_array();
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (best[k].params > 0)
            print_beside(input, points[k], best[k], w, plain);
        else
            print_on_model(input, queries.at(best[k].object).model(), points[k], best[k], w, plain);
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

}  // namespace freiform::cli
