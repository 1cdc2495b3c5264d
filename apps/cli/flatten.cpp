// flatten: curves as polylines, within a distance that is proven.
#include "input.hpp"

#include <freiform/core/spelling.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/path/flatten.hpp>

namespace freiform::cli {

namespace {

struct FlattenArguments {
    std::string file, object, method = "adaptive";
    std::optional<double> tolerance;
    std::optional<int> segments, compare;
    bool polygons = false;
};

constexpr std::string_view kMethods[] = {"adaptive", "uniform", "forward", "halving"};

// A connected part of an object.
struct Line {
    std::size_t object = 0;
    std::string name;
    int dim = 0;
    std::vector<double> points, parameters;
    std::optional<std::size_t> edge;  // of a model
    double bound = 0;
    bool closed = false;
};

template <int D>
void add_lines(const Polyline<D>& p, std::size_t object, const std::string& name, std::vector<Line>& out) {
    for (std::size_t k = 0; k < p.parts.size(); ++k) {
        const std::size_t from = p.parts[k], to = k + 1 < p.parts.size() ? p.parts[k + 1] : p.points.size();
        Line line{object, name, D, {}, {}, {}, p.bound, p.closed};
        for (std::size_t i = from; i < to; ++i) {
            line.points.insert(line.points.end(), p.points[i].c.begin(), p.points[i].c.end());
            line.parameters.push_back(p.parameters[i]);
        }
        out.push_back(std::move(line));
    }
}

// The edges of a model that have a curve of their own.
Result<void> add_edges(const Model& model, std::size_t object, const FlattenOptions& how,
                       std::vector<Line>& out) {
    std::size_t without = 0;
    for (std::size_t e = 0; e < model.edges.size(); ++e) {
        const Edge& edge = model.edges[e];
        if (edge.degenerate) continue;
        if (!edge.curve) {
            ++without;
            continue;
        }
        const auto line = flatten(*edge.curve, edge.range, how);
        if (!line) return refuse_within(text("edges[", e, "]"), line.error());
        const std::size_t first = out.size();
        add_lines(*line, object, edge.name, out);
        for (std::size_t k = first; k < out.size(); ++k) out[k].edge = e;
    }
    if (without > 0) remark(text(without, " edges have no curve in space of their own, and are left out"));
    return {};
}

std::string to_json(const std::vector<Line>& lines, const Document& document) {
    json::Writer w;
    w.begin_object().key("objects").begin_array();
    for (const Line& line : lines) {
        w.new_line(1).begin_object();
        if (document.objects.size() > 1) w.field("object", line.object);
        if (line.edge) w.field("edge", *line.edge);
        if (!line.name.empty()) w.field("name", line.name);
        w.key("points").begin_array();
        for (std::size_t i = 0; i < line.points.size(); i += std::size_t(line.dim))
            w.array(std::span(line.points).subspan(i, std::size_t(line.dim)));
        w.end_array().key("parameters").array(line.parameters);
        w.field("segments", line.parameters.size() - 1).field("closed", line.closed);
        w.field("error_bound", line.bound).end_object();
    }
    w.end_array().end_object();
    return w.take() + "\n";
}

std::string to_csv(const std::vector<Line>& lines) {
    int dim = 0;
    for (const Line& line : lines) dim = std::max(dim, line.dim);
    std::string s = "object,parameter";
    for (int k = 0; k < dim; ++k) s += text(",", std::string_view("xyzw").substr(std::size_t(k), 1));
    s += "\n";
    for (const Line& line : lines)
        for (std::size_t i = 0; i < line.parameters.size(); ++i) {
            append_text(s, text(line.object, ",", line.parameters[i]));
            for (int k = 0; k < line.dim; ++k)
                append_text(s, text(",", line.points[i * std::size_t(line.dim) + std::size_t(k)]));
            s += "\n";
        }
    return s;
}

Result<std::string> to_svg(const std::vector<Line>& lines, const std::string& file) {
    Box<2> box;
    for (const Line& line : lines) {
        if (line.dim != 2)
            return refuse(RefusalKind::no_answer, shown(file),
                          text("a curve of ", line.dim,
                               " coordinates is no plane path; .json and .csv hold its points"));
        for (std::size_t i = 0; i < line.points.size(); i += 2)
            box.add(Vec<2>{{line.points[i], -line.points[i + 1]}});
    }
    const double margin = 0.02 * box.diagonal();
    const Vec<2> size = box.hi - box.lo;
    std::string s = text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"", box.lo[0] - margin, " ",
                         box.lo[1] - margin, " ", size[0] + 2 * margin, " ", size[1] + 2 * margin, "\">\n");
    for (const Line& line : lines) {
        s += "<path fill=\"none\" stroke=\"#000\" stroke-width=\"1\" vector-effect=\"non-scaling-stroke\" "
             "d=\"M";
        const std::size_t end = line.points.size() - (line.closed && line.points.size() > 4 ? 2 : 0);
        for (std::size_t i = 0; i < end; i += 2)
            append_text(s, text(i == 0 ? "" : " ", line.points[i], ",", -line.points[i + 1]));
        s += line.closed ? "Z\"/>\n" : "\"/>\n";
    }
    return s + "</svg>\n";
}

void add_comparison(const std::vector<FlattenComparison>& rows, std::size_t object, const std::string& label,
                    json::Writer& w, std::string& table) {
    w.new_line(1).begin_object().field("object", object).key("methods").begin_array();
    table += text(label, "\n  method            segments  largest distance (measured)  bound\n");
    for (const FlattenComparison& r : rows) {
        std::string name = text(name_of(r.method), r.polygons ? ", polygons" : "");
        w.begin_object().field("method", name).field("segments", r.segments);
        w.field("measured", r.measured).field("error_bound", r.bound).end_object();
        name.resize(18, ' ');
        std::string n = text(r.segments), m = text(r.measured);
        n.resize(10, ' ');
        m.resize(29, ' ');
        table += text("  ", name, n, m, r.bound, "\n");
    }
    w.end_array().end_object();
}

Result<void> compare(const Context& context, const FlattenArguments& options, const Input& input) {
    json::Writer w;
    std::string table;
    w.begin_object().key("objects").begin_array();
    const auto done = each_curve(input, "flatten", [&](std::size_t i, const auto& curve) -> Result<void> {
        const auto rows = compare_flattening(curve, *options.compare);
        if (!rows) return std::unexpected(rows.error());
        add_comparison(*rows, i, object_label(*input.document, i), w, table);
        return {};
    });
    if (!done) return done;
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : table);
}

// Of all curves and models that were chosen.
Result<std::vector<Line>> lines_of(const Input& input, const FlattenOptions& how) {
    std::vector<Line> lines;
    const auto done = each_curve(
        input, "flatten",
        [&](std::size_t i, const auto& curve) -> Result<void> {
            const auto line = flatten(curve, how);
            if (!line) return std::unexpected(line.error());
            add_lines(*line, i, input.object(i).name, lines);
            return {};
        },
        [&](std::size_t i, const Model& model) { return add_edges(model, i, how, lines); });
    if (!done) return std::unexpected(done.error());
    return lines;
}

Result<void> run_flatten(const Context& context, const FlattenArguments& options) {
    const auto method = std::ranges::find(kMethods, options.method);
    if (method == std::end(kMethods))
        wrong_usage(text("--method is ", listed(kMethods), ", found \"", options.method, "\"",
                         did_you_mean(options.method, kMethods)));
    const std::size_t dot = context.output.rfind('.');
    const std::string format = !context.to.empty() ? context.to
                               : dot == std::string::npos || context.output.empty()
                                   ? "json"
                                   : context.output.substr(dot + 1);
    if (format != "json" && format != "csv" && format != "svg")
        wrong_usage(text("polylines are written as .json, .csv or .svg, not .", format));
    if (!options.compare && options.tolerance.has_value() == options.segments.has_value())
        wrong_usage("one of --tolerance and --segments says how fine the polyline is");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    if (options.compare) return compare(context, options, *input);

    FlattenOptions how;
    how.method = FlattenMethod(method - std::begin(kMethods));
    how.tolerance = options.tolerance.value_or(0);
    how.segments = options.segments.value_or(0);
    how.polygons = options.polygons;
    if (how.polygons && how.method != FlattenMethod::halving)
        wrong_usage("--polygons draws the control polygons of --method halving");
    const auto lines = lines_of(*input, how);
    if (!lines) return std::unexpected(lines.error());
    if (format == "json") return emit(context, to_json(*lines, *input->document));
    if (format == "csv") return emit(context, to_csv(*lines));
    const auto svg = to_svg(*lines, options.file);
    return svg ? emit(context, *svg) : std::unexpected(svg.error());
}

}  // namespace

void add_flatten(CommandLine& line) {
    const auto options = std::make_shared<FlattenArguments>();
    const Command command =
        line.add("flatten", "Curves, and edges of models, as polylines, within a distance that is proven",
                 "  freiform flatten curves.json --tolerance 0.01 -o curves.svg\n"
                 "  freiform flatten curve.json --segments 64 --method forward\n"
                 "  freiform flatten curve.json --compare 16");
    command.file(options->file);
    command.positive("--tolerance", options->tolerance,
                     "Largest distance between curve and polyline, in the unit of the file");
    command.count("--segments", options->segments, 1, 10'000'000,
                  "Number of segments instead of a tolerance; error_bound says what it reached");
    command
        .word("--method", options->method,
              "adaptive: as few segments as possible (default); uniform: equal parameter steps; "
              "forward: forward differences; halving: halved until flat")
        .shown_as("METHOD");
    command.flag("--polygons", options->polygons, "halving: the control polygons of the last level");
    command.count("--compare", options->compare, 1, 1'000'000,
                  "A table of what every method reaches with this number of segments");
    command.output("The polylines: .json, .csv or .svg");
    command.object(options->object);
    command.limits();
    command.action(options, run_flatten);
}

}  // namespace freiform::cli
