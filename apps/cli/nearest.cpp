// nearest: the point of a document's objects that is nearest to each given point, with the proof that none is
// nearer; the farthest; all within a radius.
#include "nearest_models.hpp"
#include "nearest_objects.hpp"

#include <freiform/io/points.hpp>

#include <algorithm>

namespace freiform::cli {

namespace {

struct NearestArguments {
    std::string file, object, points;
    std::optional<double> accuracy, radius;
    std::optional<int> count;
    bool farthest = false, signed_distance = false;
};

struct Answers {
    json::Writer w;
    std::string plain;
};

// Writes where a point of an object is: what all answers have in common.
struct PlaceWriter {
    const Input& input;
    const ObjectSet& asked;

    std::size_t object(std::size_t i) const { return asked.index[i]; }
    std::size_t params(std::size_t i) const { return asked.params[i]; }
    template <class Answer>
    void write(json::Writer& w, const Answer& n) const {
        w.field("object", object(n.object))
            .field("name", input.object(object(n.object)).name)
            .key("parameters")
            .array(std::span<const double>(n.at.data(), params(n.object)))
            .key("point")
            .array(n.point.c)
            .field("distance", n.distance);
    }
    template <class Answer>
    std::string plain(const Answer& n) const {
        const std::span<const double> at(n.at.data(), params(n.object));
        return text(input.label(object(n.object)), ": at ", listed_numbers(at), ", point ",
                    listed_numbers(n.point.c), ", distance ", n.distance);
    }
    template <int D>
    void write_regions(json::Writer& w, const NearRegions<D>& all) const {
        w.begin_array();
        for (const auto& r : all.regions) {
            w.new_line(2).begin_object();
            write(w, r);
            w.key("box").begin_array();
            for (std::size_t d = 0; d < params(r.object); ++d) w.array(std::array{r.box[d].lo, r.box[d].hi});
            w.end_array().field("stretch", r.stretch).field("point_error", r.point_error).end_object();
        }
        w.end_array();
    }
    template <int D>
    std::string plain_regions(const NearRegions<D>& all, std::string_view indent) const {
        std::string out;
        for (const auto& r : all.regions) {
            std::string box;
            for (std::size_t d = 0; d < params(r.object); ++d)
                box += text(box.empty() ? "" : " x ", "[", r.box[d].lo, ", ", r.box[d].hi, "]");
            out += text(indent, plain(r), ", in ", box, r.stretch ? ", a stretch\n" : "\n");
        }
        return out;
    }
};

template <int D>
Result<void> answer_nearest(const NearestQuery& query, const std::vector<Vec<D>>& points, double accuracy,
                            const PlaceWriter& place, Answers& out) {
    std::vector<Nearest<D>> nearest(points.size());
    if (auto done = query.nearest<D>(points, nearest, {.accuracy = accuracy}); !done) return done;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Nearest<D>& n = nearest[i];
        const auto same = query.as_near<D>(points[i], n);
        if (!same) return std::unexpected(same.error());
        const bool many =
            same->regions.size() > 1 || std::ranges::any_of(same->regions, &NearRegion<D>::stretch);
        out.w.new_line(1).begin_object().key("query").array(points[i].c);
        place.write(out.w, n);
        out.w.field("lower_bound", n.lower_bound).field("point_error", n.point_error).field("many", many);
        if (many) {
            out.w.key("as_near");
            place.write_regions<D>(out.w, *same);
            out.w.field("complete", same->complete);
        }
        out.w.end_object();
        out.plain += text(place.plain(n), ", at least ", n.lower_bound, "\n");
        if (many) out.plain += "  as near, as far as can be told:\n" + place.plain_regions<D>(*same, "    ");
    }
    return {};
}

template <int D>
Result<void> answer_farthest(const NearestQuery& query, const std::vector<Vec<D>>& points, double accuracy,
                             const PlaceWriter& place, Answers& out) {
    std::vector<Farthest<D>> farthest(points.size());
    if (auto done = query.farthest<D>(points, farthest, {.accuracy = accuracy}); !done) return done;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Farthest<D>& n = farthest[i];
        out.w.new_line(1).begin_object().key("query").array(points[i].c);
        place.write(out.w, n);
        out.w.field("upper_bound", n.upper_bound).field("point_error", n.point_error).end_object();
        out.plain += text(place.plain(n), ", at most ", n.upper_bound, "\n");
    }
    return {};
}

template <int D>
Result<void> answer_within(const NearestQuery& query, const std::vector<Vec<D>>& points, double radius,
                           const PlaceWriter& place, Answers& out) {
    for (const Vec<D>& p : points) {
        const auto all = query.within<D>(p, radius);
        if (!all) return std::unexpected(all.error());
        out.w.new_line(1).begin_object().key("query").array(p.c).key("regions");
        place.write_regions<D>(out.w, *all);
        out.w.field("complete", all->complete).end_object();
        out.plain += text(listed_numbers(p.c), ": ", all->regions.size(), " regions within ", radius,
                          all->complete ? "" : ", larger than need be: the work was ended", "\n",
                          place.plain_regions<D>(*all, "  "));
    }
    return {};
}

template <int D>
Result<void> answer_feet(const NearestQuery& query, const std::vector<Vec<D>>& points, int count,
                         const PlaceWriter& place, Answers& out) {
    for (const Vec<D>& p : points) {
        const auto all = query.feet<D>(p, count);
        if (!all) return std::unexpected(all.error());
        out.w.new_line(1).begin_object().key("query").array(p.c).key("feet").begin_array();
        out.plain += text(listed_numbers(p.c), ":\n");
        for (const NearFoot<D>& f : all->feet) {
            out.w.new_line(2).begin_object();
            place.write(out.w, f.foot);
            out.w.field("lower_bound", f.foot.lower_bound).field("point_error", f.foot.point_error);
            out.w.field("stretch", f.stretch).end_object();
            out.plain += text("  ", place.plain(f.foot), ", at least ", f.foot.lower_bound,
                              f.stretch ? ", a stretch\n" : "\n");
        }
        out.w.end_array();
        const bool none = all->others == std::numeric_limits<double>::infinity();
        if (!none) out.w.field("others_lower_bound", all->others);
        out.w.field("complete", all->complete).end_object();
        out.plain +=
            none ? std::string("  there are no others\n") : text("  others: at least ", all->others, "\n");
    }
    return {};
}

template <int D>
Result<void> answer(const Input& input, const ObjectSet& asked, const std::vector<std::vector<double>>& rows,
                    const NearestArguments& options, Answers& out) {
    const auto query = NearestQuery::make(asked.objects);
    if (!query) return std::unexpected(query.error());
    std::vector<Vec<D>> points;
    for (const auto& row : rows) {
        Vec<D> p;
        for (int d = 0; d < D; ++d) p[d] = row[std::size_t(d)];
        points.push_back(p);
    }
    const PlaceWriter place{input, asked};
    const double accuracy = options.accuracy.value_or(0);
    if (options.count) return answer_feet<D>(*query, points, *options.count, place, out);
    if (options.radius) return answer_within<D>(*query, points, *options.radius, place, out);
    if (options.farthest) return answer_farthest<D>(*query, points, accuracy, place, out);
    return answer_nearest<D>(*query, points, accuracy, place, out);
}

Result<void> run_nearest(const Context& context, const NearestArguments& options) {
    if (options.radius && (options.farthest || options.accuracy))
        wrong_usage("--radius goes with neither --farthest nor --accuracy");
    if (options.count && (options.radius || options.farthest || options.accuracy || options.signed_distance))
        wrong_usage("--k goes with none of --radius, --farthest, --accuracy and --signed");
    if (options.radius && !(*options.radius >= 0))
        wrong_usage("--radius needs a distance that is not negative");
    if (!(options.accuracy.value_or(0) >= 0)) wrong_usage("--accuracy needs a distance that is not negative");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const auto lines = read_number_lines(options.points, context.read_options());
    if (!lines) return std::unexpected(lines.error());
    if (std::ranges::any_of(input->chosen, [&](std::size_t i) {
            return std::holds_alternative<Model>(input->object(i).shape) ||
                   std::holds_alternative<TrimmedSurface>(input->object(i).shape);
        }))
        return nearest_of_models(context, *input, lines->row,
                                 {options.accuracy.value_or(0), options.signed_distance, options.farthest,
                                  options.radius, options.count});
    if (options.signed_distance)
        return refuse(RefusalKind::no_answer, shown(options.file), "has no solid model: --signed needs one");
    ObjectSet a;
    for (const std::size_t i : input->chosen)
        if (auto done = add_object(*input, i, "others have another number; --object chooses among them", a);
            !done)
            return done;
    if (a.objects.empty())
        return refuse(RefusalKind::no_answer, shown(options.file),
                      "has no curve, surface, volume, triangle or model to be near to");
    const int dimension = a.coordinates;
    for (std::size_t i = 0; i < lines->row.size(); ++i)
        if (lines->row[i].size() != std::size_t(dimension))
            return refuse(RefusalKind::no_answer, text("points[", i, "]"),
                          text("has ", lines->row[i].size(), " coordinates, the objects have ", dimension));
    Answers out;
    out.w.begin_object().key("results").begin_array();
    const auto done = dimension == 1   ? answer<1>(*input, a, lines->row, options, out)
                      : dimension == 2 ? answer<2>(*input, a, lines->row, options, out)
                      : dimension == 3 ? answer<3>(*input, a, lines->row, options, out)
                                       : answer<4>(*input, a, lines->row, options, out);
    if (!done) return done;
    out.w.end_array().end_object();
    return emit(context, context.json ? out.w.take() + "\n" : out.plain);
}

}  // namespace

void add_nearest(CommandLine& line) {
    const auto options = std::make_shared<NearestArguments>();
    const Command command =
        line.add("nearest", "The nearest point of all objects, with a lower bound that proves it",
                 "  freiform nearest curves.json --points queries.csv\n"
                 "  freiform nearest teapot.bpt --points xyz.csv --accuracy 1e-9 --json\n"
                 "  freiform nearest curves.json --points queries.csv --radius 2.5\n"
                 "  freiform nearest curves.json --points queries.csv --k 3\n"
                 "  freiform nearest part.step --points xyz.csv --signed\n"
                 "No point of any object is nearer than lower_bound; the point itself is known up to "
                 "point_error. Where others\n"
                 "are as near, as far as can be told, all of them are listed, as boxes of parameters.");
    command.file(options->file);
    command.word("--points", options->points, "A line of coordinates for each point")
        .shown_as("FILE.csv")
        .required();
    command.number(
        "--accuracy", options->accuracy,
        "How far the lower bound may stay below the distance (default 0: as far as rounding allows)");
    command.number(
        "--radius", options->radius,
        "Instead: all within this distance, as boxes of parameters with the nearest point in each");
    command.count("--k", options->count, 1, 1'000'000,
                  "Instead: the K nearest local minima of the distance, and how far all others are at least");
    command.flag("--signed", options->signed_distance,
                 "Of solid models: negative distances inside; refused where the surface is not closed");
    command.flag("--farthest", options->farthest, "Instead: the farthest point, with an upper bound");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_nearest);
}

}  // namespace freiform::cli
