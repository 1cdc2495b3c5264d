// nearest: the point of a document's objects that is nearest to each given point, with the proof that none is
// nearer.
#include "input.hpp"

#include <freiform/io/points.hpp>
#include <freiform/query/nearest.hpp>

#include <map>

namespace freiform::cli {

namespace {

struct NearestArguments {
    std::string file, object, points;
    std::optional<double> accuracy;
};

// Of the objects with one number of coordinates.
struct Asked {
    std::vector<std::size_t> index;  // in the document
    std::vector<NearestObject> objects;
};

struct Answers {
    json::Writer w;
    std::string plain;
};

template <int D>
Result<void> answer(const Input& input, const Asked& asked, const std::vector<std::vector<double>>& rows,
                    double accuracy, Answers& out) {
    const auto query = NearestQuery::make(asked.objects);
    if (!query) return std::unexpected(query.error());
    std::vector<Vec<D>> points;
    for (const auto& row : rows) {
        Vec<D> p;
        for (int d = 0; d < D; ++d) p[d] = row[std::size_t(d)];
        points.push_back(p);
    }
    std::vector<Nearest<D>> nearest(points.size());
    if (auto done = query->nearest<D>(points, nearest, {.accuracy = accuracy}); !done) return done;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Nearest<D>& n = nearest[i];
        const std::size_t object = asked.index[n.object];
        const Shape& shape = input.object(object).shape;
        const std::size_t params = std::max<std::size_t>(bases_of(shape).size(), 1);
        const bool triangle = type_name(shape) == "triangle";
        const std::span<const double> at(n.at.data(), triangle ? 2 : params);
        out.w.new_line(1)
            .begin_object()
            .field("object", object)
            .field("name", input.object(object).name)
            .key("query")
            .array(points[i].c)
            .key("parameters")
            .array(at)
            .key("point")
            .array(n.point.c)
            .field("distance", n.distance)
            .field("lower_bound", n.lower_bound)
            .field("point_error", n.point_error)
            .end_object();
        std::string where;
        for (const double t : at) where += text(where.empty() ? "" : ", ", t);
        std::string place;
        for (const double x : n.point.c) place += text(place.empty() ? "" : ", ", x);
        out.plain += text(input.label(object), ": at ", where, ", point ", place, ", distance ", n.distance,
                          ", at least ", n.lower_bound, "\n");
    }
    return {};
}

Result<void> run_nearest(const Context& context, const NearestArguments& options) {
    const double accuracy = options.accuracy.value_or(0);
    if (!(accuracy >= 0)) wrong_usage("--accuracy needs a distance that is not negative");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const auto lines = read_number_lines(options.points, context.read_options());
    if (!lines) return std::unexpected(lines.error());
    std::map<int, Asked> asked;  // by the number of coordinates
    for (const std::size_t i : input->chosen)
        std::visit(
            [&](const auto& s) {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S> || TriangularPatch<S>) {
                    Asked& a = asked[Space<typename S::Coefficients>::kDim];
                    a.index.push_back(i);
                    a.objects.push_back(NearestObject::of(s));
                } else {
                    remark_left_out(*input, i);
                }
            },
            input->object(i).shape);
    if (asked.empty())
        return refuse(RefusalKind::no_answer, shown(options.file),
                      "has no curve, surface, volume or triangle to be near to");
    if (asked.size() > 1)
        return refuse(RefusalKind::no_answer, shown(options.file),
                      text("has objects with ", asked.begin()->first, " and with ", asked.rbegin()->first,
                           " coordinates; --object chooses among them"));
    const int dimension = asked.begin()->first;
    for (std::size_t i = 0; i < lines->row.size(); ++i)
        if (lines->row[i].size() != std::size_t(dimension))
            return refuse(RefusalKind::no_answer, text("points[", i, "]"),
                          text("has ", lines->row[i].size(), " coordinates, the objects have ", dimension));
    Answers out;
    out.w.begin_object().key("results").begin_array();
    const Asked& a = asked.begin()->second;
    const auto done = dimension == 1   ? answer<1>(*input, a, lines->row, accuracy, out)
                      : dimension == 2 ? answer<2>(*input, a, lines->row, accuracy, out)
                      : dimension == 3 ? answer<3>(*input, a, lines->row, accuracy, out)
                                       : answer<4>(*input, a, lines->row, accuracy, out);
    if (!done) return done;
    out.w.end_array().end_object();
    return emit(context, context.json ? out.w.take() + "\n" : out.plain);
}

}  // namespace

void add_nearest(CommandLine& line) {
    const auto options = std::make_shared<NearestArguments>();
    const Command command = line.add(
        "nearest", "The nearest point of all objects, with a lower bound that proves it",
        "  freiform nearest curves.json --points queries.csv\n"
        "  freiform nearest teapot.bpt --points xyz.csv --accuracy 1e-9 --json\n"
        "No point of any object is nearer than lower_bound; the point itself is known up to point_error.");
    command.file(options->file);
    command.word("--points", options->points, "A line of coordinates for each point")
        .shown_as("FILE.csv")
        .required();
    command.number(
        "--accuracy", options->accuracy,
        "How far the lower bound may stay below the distance (default 0: as far as rounding allows)");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_nearest);
}

}  // namespace freiform::cli
