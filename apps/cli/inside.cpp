// inside: which points lie in a trimmed face, a closed plane curve or a closed body.
#include "input.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/points.hpp>
#include <freiform/model/inside.hpp>

namespace freiform::cli {

namespace {

struct InsideArguments {
    std::string file, object, points;
    std::optional<double> tolerance;
};

constexpr std::string_view kPlaces[] = {"outside", "inside", "boundary"};

template <int D>
Result<std::vector<Vec<D>>> as_points(const std::vector<std::vector<double>>& rows) {
    std::vector<Vec<D>> points;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].size() != std::size_t(D))
            return refuse(RefusalKind::no_answer, text("points[", i, "]"),
                          text("has ", rows[i].size(), " coordinates, this object is asked with ", D));
        Vec<D> p;
        for (int d = 0; d < D; ++d) p[d] = rows[i][std::size_t(d)];
        points.push_back(p);
    }
    return points;
}

struct PointRow {
    std::size_t object;
    Place place;
    int winding;
    std::optional<double> distance;
};

class Asking {
public:
    Asking(const std::vector<std::vector<double>>& points, std::optional<double> tolerance,
           long long max_triangles)
        : points_(points), tolerance_(tolerance), max_triangles_(max_triangles) {}

    Result<std::vector<PointRow>> operator()(const TrimmedSurface& t) const {
        std::vector<std::vector<CurveGeometry<2>>> loops = t.loops;
        Box<2> box;
        visit_one(
            [&](const auto& s) {
                for (int d = 0; d < 2; ++d)
                    box.lo[d] = s.basis(d).domain().lo, box.hi[d] = s.basis(d).domain().hi;
            },
            t.surface);
        if (loops.empty()) loops.push_back(rectangle(box));
        return in_loops(loops, TrimmedSurface::kSlack * box.diagonal());
    }
    Result<std::vector<PointRow>> operator()(const Curve<Vec<2>>& c) const { return in_closed(c); }
    Result<std::vector<PointRow>> operator()(const Curve<Hom<2>>& c) const { return in_closed(c); }
    Result<std::vector<PointRow>> operator()(const Model& m) const {
        const auto points = as_points<3>(points_);
        if (!points) return std::unexpected(points.error());
        const double accuracy = tolerance_.value_or(1e-6 * summary(m).box.diagonal());
        const auto in = inside_solid(m, *points, accuracy, max_triangles_);
        if (!in) return std::unexpected(in.error());
        std::vector<PointRow> rows;
        for (const SolidInside& i : *in) rows.push_back({0, i.place, i.winding, i.distance});
        return rows;
    }
    template <class S>
    Result<std::vector<PointRow>> operator()(const S&) const {
        return refuse(RefusalKind::no_answer, "",
                      "has no inside; asked are trimmed surfaces, closed plane curves and closed models");
    }

private:
    // Ends that rounding keeps apart close, as those of loops of trimmed surfaces do.
    template <class P>
    Result<std::vector<PointRow>> in_closed(const Curve<P>& c) const {
        return in_loops({{c}}, TrimmedSurface::kSlack * control_box(c).diagonal);
    }
    static std::vector<CurveGeometry<2>> rectangle(const Box<2>& b) {
        std::vector<CurveGeometry<2>> loop;
        const Vec<2> corner[5] = {b.lo, {{b.hi[0], b.lo[1]}}, b.hi, {{b.lo[0], b.hi[1]}}, b.lo};
        for (int i = 0; i < 4; ++i)
            loop.push_back(Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1)},
                                                  Net<1, Vec<2>>({2}, {corner[i], corner[i + 1]})));
        return loop;
    }
    Result<std::vector<PointRow>> in_loops(const std::vector<std::vector<CurveGeometry<2>>>& loops,
                                           double gap) const {
        const auto points = as_points<2>(points_);
        if (!points) return std::unexpected(points.error());
        const auto query = InsideQuery::make(loops, tolerance_.value_or(gap));
        if (!query) return refuse(RefusalKind::no_answer, query.error().where, query.error().message);
        std::vector<Inside> in(points->size());
        query->at(*points, in);
        std::vector<PointRow> rows;
        for (const Inside& i : in) rows.push_back({0, i.place, i.winding, std::nullopt});
        return rows;
    }

    const std::vector<std::vector<double>>& points_;
    std::optional<double> tolerance_;
    long long max_triangles_;
};

Result<void> run_inside(const Context& context, const InsideArguments& options) {
    if (options.tolerance.value_or(0) < 0) wrong_usage("--tolerance needs a distance that is not negative");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const auto lines = read_number_lines(options.points, context.read_options());
    if (!lines) return std::unexpected(lines.error());
    const Asking ask(lines->row, options.tolerance, (long long)(context.limits.max_triangles));
    const bool several = input->document->objects.size() > 1;
    json::Writer w;
    std::string plain;
    w.begin_object().key("results").begin_array();
    for (const std::size_t o : input->chosen) {
        const auto rows = visit_one(ask, input->object(o).shape);
        if (!rows) return input->about(o, rows.error());
        for (std::size_t i = 0; i < rows->size(); ++i) {
            const PointRow& row = (*rows)[i];
            const std::string_view place = kPlaces[std::size_t(row.place)];
            w.new_line(1).begin_object();
            if (several) w.field("object", o);
            w.key("point")
                .array(lines->row[i])
                .field("place", place)
                .field("inside", row.place == Place::inside);
            w.field("winding", row.winding);
            if (row.distance)
                w.field(row.place == Place::boundary ? "distance_at_most" : "distance_at_least",
                        *row.distance);
            w.end_object();
            plain += text(place, "\n");
        }
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : plain);
}

}  // namespace

void add_inside(CommandLine& line) {
    const auto options = std::make_shared<InsideArguments>();
    const Command command =
        line.add("inside", "Which points lie inside a trimmed face, a closed curve or a solid",
                 "  freiform inside face.json --points uv.csv\n"
                 "  freiform inside bracket.step --points xyz.csv --json");
    command.file(options->file);
    command
        .word("--points", options->points,
              "A line of numbers for each: parameters of a trimmed face, x,y or x,y,z")
        .shown_as("FILE.csv")
        .required();
    command.number(
        "--tolerance", options->tolerance,
        "Of a solid: points nearer than this to its surface may be called boundary (default 1e-6 of "
        "the diagonal); of "
        "loops: gaps that are closed (default: what their file format allows)");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.triangle_limit();
    command.action(options, run_inside);
}

}  // namespace freiform::cli
