// distance: the least distance between the objects of two files, with both places and a proof.
#include "nearest_objects.hpp"

#include <freiform/io/scene.hpp>
#include <freiform/model/distance.hpp>

#include <algorithm>

namespace freiform::cli {

namespace {

struct DistanceArguments {
    std::string a, b, object_a, object_b;
    std::optional<double> accuracy;
    std::optional<int> max_pairs;
};

Result<ObjectSet> distance_set(const Input& input) {
    ObjectSet out;
    for (const std::size_t i : input.chosen)
        if (auto done =
                add_object(input, i, "others have another number; --object-a and --object-b choose", out);
            !done)
            return std::unexpected(done.error());
    return out;
}

// The beginning of an answer, in both forms.
template <class Distance>
std::string begin_answer(json::Writer& w, const Distance& d) {
    w.begin_object().field("distance", d.distance).field("lower_bound", d.lower_bound);
    w.field("point_error", d.point_error);
    return text("distance ", d.distance, ", at least ", d.lower_bound, "\n");
}
void begin_side(json::Writer& w, std::size_t side, const Input& input, std::size_t object) {
    w.key(side == 0 ? "a" : "b").begin_object().field("object", object);
    w.field("name", input.object(object).name);
}

template <int D>
Result<void> answer_distance(const Context& context, const std::array<const Input*, 2>& input,
                             const std::array<ObjectSet, 2>& sets, const DistanceOptions& options) {
    const auto a = NearestQuery::make(sets[0].objects), b = NearestQuery::make(sets[1].objects);
    if (!a) return std::unexpected(a.error());
    if (!b) return std::unexpected(b.error());
    const auto d = least_distance<D>(*a, *b, options);
    if (!d) return std::unexpected(d.error());
    json::Writer w;
    std::string plain = begin_answer(w, *d);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t k = d->object[i], object = sets[i].index[k];
        const std::span<const double> at(d->at[i].data(), sets[i].params[k]);
        begin_side(w, i, *input[i], object);
        w.key("parameters").array(at).key("point").array(d->point[i].c).end_object();
        plain += text("  ", input[i]->label(object), ": at ", listed_numbers(at), ", point ",
                      listed_numbers(d->point[i].c), "\n");
    }
    w.end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

bool has_faces_of_models(const Input& input) {
    return std::ranges::any_of(input.chosen, [&](std::size_t i) {
        const Shape& s = input.object(i).shape;
        return std::holds_alternative<Model>(s) || std::holds_alternative<TrimmedSurface>(s);
    });
}

// Faces of models, trimmed and whole surfaces, as one model.
Result<Scene> faces_of(const Input& input) {
    for (const std::size_t i : input.chosen)
        if (with_curve(input.object(i).shape, [](const auto&) {}))
            return refuse(RefusalKind::no_answer, input.label(i),
                          "is a curve; distances from models are those between faces; --object-a and "
                          "--object-b choose");
    return scene_with_owners(*input.document, input.chosen);
}

Result<void> distance_of_models(const Context& context, const std::array<const Input*, 2>& input,
                                const DistanceOptions& options) {
    std::array<std::optional<ModelNearestQuery>, 2> query;
    std::array<std::vector<std::size_t>, 2> owner;
    for (std::size_t i = 0; i < 2; ++i) {
        auto scene = faces_of(*input[i]);
        if (!scene) return std::unexpected(scene.error());
        for (const Refusal& r : scene->model.refused) remark(text(r.where, " is left out: ", r.message));
        owner[i] = std::move(scene->object_of_face);
        auto made = ModelNearestQuery::make(std::move(scene->model));
        if (!made) return refuse_within(shown(input[i]->file), made.error());
        query[i] = *std::move(made);
    }
    const auto d = least_distance(*query[0], *query[1], options);
    if (!d) return std::unexpected(d.error());
    json::Writer w;
    std::string plain = begin_answer(w, *d);
    for (std::size_t i = 0; i < 2; ++i) {
        const ModelNearest& n = d->at[i];
        const std::size_t object = owner[i][std::size_t(n.face)];
        begin_side(w, i, *input[i], object);
        write_place(w, n);
        w.end_object();
        plain += text("  ", input[i]->label(object), ": ", place_text(n), "\n");
    }
    w.end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

Result<void> run_distance(const Context& context, const DistanceArguments& options) {
    if (!(options.accuracy.value_or(0) >= 0)) wrong_usage("--accuracy needs a distance that is not negative");
    const auto a = read_input(context, options.a, options.object_a);
    if (!a) return std::unexpected(a.error());
    const auto b = read_input(context, options.b, options.object_b);
    if (!b) return std::unexpected(b.error());
    DistanceOptions how;
    how.accuracy = options.accuracy.value_or(0);
    how.max_pairs = options.max_pairs.value_or(how.max_pairs);
    const std::array input{&*a, &*b};
    if (has_faces_of_models(*a) || has_faces_of_models(*b)) return distance_of_models(context, input, how);
    auto set_a = distance_set(*a), set_b = distance_set(*b);
    if (!set_a) return std::unexpected(set_a.error());
    if (!set_b) return std::unexpected(set_b.error());
    for (const auto& [set, file] : {std::pair(&*set_a, options.a), {&*set_b, options.b}})
        if (set->objects.empty())
            return refuse(RefusalKind::no_answer, shown(file),
                          "has no curve, surface, volume, triangle or model to be far from");
    const int n = set_a->coordinates;
    if (n != set_b->coordinates)
        return refuse(
            RefusalKind::no_answer, shown(options.b),
            text("has objects with ", set_b->coordinates, " coordinates, ", shown(options.a), " with ", n));
    const std::array sets{*std::move(set_a), *std::move(set_b)};
    return n == 1   ? answer_distance<1>(context, input, sets, how)
           : n == 2 ? answer_distance<2>(context, input, sets, how)
           : n == 3 ? answer_distance<3>(context, input, sets, how)
                    : answer_distance<4>(context, input, sets, how);
}

}  // namespace

void add_distance(CommandLine& line) {
    const auto options = std::make_shared<DistanceArguments>();
    const Command command =
        line.add("distance", "The least distance between two files' objects, with a bound that proves it",
                 "  freiform distance road.json river.json\n"
                 "  freiform distance scene.json scene.json --object-a pipe --object-b wall --json\n"
                 "  freiform distance bolt.step plate.step\n"
                 "No two points of the two are nearer to each other than lower_bound.");
    command.word("A", options->a, "The first file; - is standard input").required();
    command.word("B", options->b, "The second file").required();
    command.number("--accuracy", options->accuracy,
                   "How far the lower bound may stay below the distance (default: 2^-30 of the coordinates, "
                   "2^-24 of the size of models)");
    command.count("--max-pairs", options->max_pairs, 1, 100'000'000,
                  "Pairs of parts that are looked at before the bound is left as it is (default 200000)");
    command.word("--object-a", options->object_a, "Only this object of A").shown_as("NAME|INDEX");
    command.word("--object-b", options->object_b, "Only this object of B").shown_as("NAME|INDEX");
    command.answer_file();
    command.limits();
    command.action(options, run_distance);
}

}  // namespace freiform::cli
