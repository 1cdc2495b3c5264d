#include "nearest_models.hpp"

#include <freiform/model/inside.hpp>
#include <freiform/model/nearest.hpp>
#include <freiform/query/nearest.hpp>

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
    int params = 0;  // of another object, which has no faces: nearest.uv, nearest.t
};

// The curves, surfaces, volumes and triangles beside models.
struct Beside {
    std::vector<std::size_t> index, params;
    std::vector<NearestObject> objects;
};

// Nothing: is a model, or trimmed.
Result<void> add_beside(const Input& input, std::size_t i, Beside& out) {
    return std::visit(
        [&](const auto& s) -> Result<void> {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S> || TriangularPatch<S>) {
                if constexpr (Space<typename S::Coefficients>::kDim == 3) {
                    out.index.push_back(i);
                    out.objects.push_back(NearestObject::of(s));
                    if constexpr (TensorPatch<S>)
                        out.params.push_back(S::kParams);
                    else
                        out.params.push_back(2);
                } else {
                    return refuse(RefusalKind::no_answer, input.label(i),
                                  text("has ", Space<typename S::Coefficients>::kDim,
                                       " coordinates, models are in space; --object chooses"));
                }
            } else if constexpr (!std::same_as<S, Model> && !std::same_as<S, TrimmedSurface>) {
                remark_left_out(input, i);
            }
            return {};
        },
        input.object(i).shape);
}

// Where these are nearer they take the place, and the least of the lower bounds holds for all.
Result<void> nearest_beside(const Beside& beside, const std::vector<Vec<3>>& points, double accuracy,
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
    std::string where;
    for (const double t : own) where += text(where.empty() ? "" : ", ", t);
    plain += text(input.label(f.object), ": at ", where, ", point ", n.point[0], ", ", n.point[1], ", ",
                  n.point[2], ", distance ", n.distance, ", at least ", n.lower_bound, "\n");
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
    Beside beside;
    for (const std::size_t i : input.chosen) {
        if (auto done = add_beside(input, i, beside); !done) return done;
        const Shape& shape = input.object(i).shape;
        const auto* own = std::get_if<Model>(&shape);
        const auto* trimmed = std::get_if<TrimmedSurface>(&shape);
        if (!own && !trimmed) continue;
        Result<Model> model = own ? Result<Model>(*own) : model_of_trimmed(*trimmed);
        if (!model) return std::unexpected(model.error());
        auto query = ModelNearestQuery::make(*std::move(model));
        if (!query) return refuse_within(input.label(i), query.error());
        std::vector<ModelNearest> nearest(points.size());
        if (auto done = query->nearest(points, nearest, {.accuracy = asked.accuracy}); !done) return done;
        std::vector<SolidInside> inside;
        if (asked.with_sign) {
            const double accuracy = 1e-6 * summary(query->model()).box.diagonal();
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
