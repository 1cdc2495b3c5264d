// fit: the smallest curve found within a tolerance of points.
#include "point_commands.hpp"

#include <freiform/fit/approximate.hpp>

namespace freiform::cli {

namespace {

struct FitArguments {
    std::string file, spacing = "chordal", tangents;
    std::optional<double> tolerance, smoothing;
    std::optional<int> degree;
    bool closed = false, keep_ends = false, keep_parameters = false;
};

Spacing spacing_of(const std::string& word) {
    for (const Spacing s : {Spacing::uniform, Spacing::chordal, Spacing::centripetal})
        if (word == name_of(s)) return s;
    wrong_usage(text("--parameters: there is no \"", word, "\"; there are uniform, chordal or centripetal"));
}

template <int D>
Result<Fitted<D>> fitted(const std::vector<Vec<D>>& points, const FitArguments& options) {
    std::vector<KeptPoint<D>> kept;
    const int last = int(points.size()) - 1;
    if (options.keep_ends && last >= 0) {
        kept.push_back({0, 0, points.front()});
        if (!options.closed && last > 0) kept.push_back({last, 0, points.back()});
    }
    const auto tangents = parse_vectors("--tangents", options.tangents, D);
    if (!options.tangents.empty() && tangents.size() != 2)
        wrong_usage("--tangents needs two vectors: at the start and at the end");
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        KeptPoint<D> k{i == 0 ? 0 : last, 1, {}};
        for (int c = 0; c < D; ++c) k.value[c] = tangents[i][std::size_t(c)];
        kept.push_back(k);
    }
    ApproximateOptions o;
    o.tolerance = *options.tolerance;
    o.degree = options.degree.value_or(3);
    o.closed = options.closed;
    o.spacing = spacing_of(options.spacing);
    o.move_parameters = !options.keep_parameters;
    o.smoothing = options.smoothing.value_or(0);
    return approximate<D>(points, o, kept);
}

struct FitAnswer {
    std::size_t points;
    const BSplineBasis& basis;
    const FitReport& report;
    const std::vector<double>& at;
};

Result<void> report_fit(const Context& context, const FitArguments& options, const std::string& format,
                        const FitAnswer& a, Document document) {
    const FitReport& r = a.report;
    json::Writer w;
    w.begin_object().field("points", a.points).field("coefficients", a.basis.size());
    w.field("degree", a.basis.degree()).field("closed", options.closed);
    w.field("tolerance", *options.tolerance)
        .field("bound", r.bound)
        .field("polyline_bound", r.polyline_bound);
    w.field("kept_bound", r.kept_bound).field("rms_error", r.rms_error).field("iterations", r.iterations);
    w.key("parameters").array(a.at).field("output", context.output).end_object();
    std::string s = text("points          ", a.points, "\ncoefficients    ", a.basis.size());
    s += text("\nbound           ", r.bound, " (no point is farther from the curve; tolerance ",
              *options.tolerance, ")\n");
    s += text("polyline bound  ", r.polyline_bound, " (the curve from the polygon of the points)\n");
    s += text("mean error      ", r.rms_error, "\nwritten to ", context.output, "\n");
    return emit_spline(context, format, std::move(document), s, w.take() + "\n");
}

Result<void> run_fit(const Context& context, const FitArguments& options) {
    const std::string format = spline_format(context, "fit");
    if (!(*options.tolerance > 0)) wrong_usage("--tolerance needs a positive distance");
    if (options.smoothing && !(*options.smoothing >= 0))
        wrong_usage("--smoothing needs a number that is not negative");
    if (options.closed && !options.tangents.empty()) wrong_usage("--tangents is for open curves");
    (void)spacing_of(options.spacing);
    const auto table = read_points(options.file, context.read_options());
    if (!table) return std::unexpected(table.error());
    if (table->grid)
        return refuse(RefusalKind::unsupported, shown(options.file),
                      "holds a grid of points; fit takes points in one sequence (interpolate takes grids)");
    return with_points(*table, [&]<int D>(std::vector<Vec<D>> points) -> Result<void> {
        auto f = fitted<D>(points, options);
        if (!f) return about_file(f.error(), *table, options.file);
        const BSplineBasis basis = f->curve.basis();
        Document document;
        document.objects.push_back({"", std::move(f->curve), {}});
        return report_fit(context, options, format, {points.size(), basis, f->report, f->at},
                          std::move(document));
    });
}

}  // namespace

void add_fit(CommandLine& line) {
    const auto options = std::make_shared<FitArguments>();
    const Command command = line.add(
        "fit", "The smallest spline found within a tolerance of points in order",
        "  freiform fit points.csv --tolerance 0.01 -o curve.json\n"
        "  freiform fit outline.csv --closed --tolerance 0.01 --degree 5 -o outline.json\n"
        "  freiform fit points.csv --tolerance 0.01 --keep-ends --tangents '1,0;0,1' -o curve.json\n"
        "Points are lines of 1 to 4 numbers, or JSON: [[x,y], ...]. The distance reached is proven, and\n"
        "reported in both directions: from the points to the curve, and from the curve to their polygon.");
    command.points_file(options->file);
    command.output("The file to write: .json or .bpt");
    command.number("--tolerance", options->tolerance, "No point is to be farther from the curve than this")
        .required();
    command.count("--degree", options->degree, 1, kMaxDegree, "Degree of the spline (3)");
    command.flag("--closed", options->closed, "The curve closes smoothly");
    command.word("--parameters", options->spacing, "To begin with: uniform, chordal (default) or centripetal")
        .shown_as("WAY");
    command.flag("--keep-parameters", options->keep_parameters,
                 "Do not move parameters to where the curve is nearest");
    command.flag("--keep-ends", options->keep_ends,
                 "The curve begins and ends exactly at the first and the last point");
    command
        .word("--tangents", options->tangents,
              "Derivatives by the parameter to keep at the start and at the end")
        .shown_as("X,Y;X,Y");
    command.number("--smoothing", options->smoothing,
                   "Add this many times the integral of the squared second derivative");
    command.limits();
    command.action(options, run_fit);
}

}  // namespace freiform::cli
