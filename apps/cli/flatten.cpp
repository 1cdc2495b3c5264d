// flatten: curves as polylines, within a distance that is proven.
#include "command.hpp"

#include <freiform/core/spelling.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/path/flatten.hpp>

namespace freiform::cli {

namespace {

struct Options {
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

template <class P>
Result<void> add_curve(const Curve<P>& curve, std::size_t object, const FlattenOptions& how,
                       const std::string& name, std::vector<Line>& out) {
    const auto line = flatten(curve, how);
    if (!line) return std::unexpected(line.error());
    add_lines(*line, object, name, out);
    return {};
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

template <class F>
Result<void> each_curve(const Document& document, const std::vector<std::size_t>& objects,
                        const std::string& file, F&& f) {
    std::size_t curves = 0;
    for (const std::size_t i : objects) {
        const auto done = std::visit(
            [&](const auto& s) -> Result<void> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (TensorPatch<S>)
                    if constexpr (S::kParams == 1) {
                        ++curves;
                        return f(i, s);
                    }
                if constexpr (std::same_as<S, Model> && requires { f(i, s); }) {
                    ++curves;
                    return f(i, s);
                }
                remark(text(object_label(document, i), ": is a ", type_name(document.objects[i].shape),
                            ", not a curve, and left out"));
                return {};
            },
            document.objects[i].shape);
        if (!done) {
            Refusal r = done.error();
            const std::string label = document.objects.size() > 1 ? object_label(document, i) : shown(file);
            r.where = r.where.empty() ? label : text(label, ": ", r.where);
            return std::unexpected(std::move(r));
        }
    }
    if (curves == 0) return refuse(RefusalKind::no_answer, shown(file), "there is no curve to flatten");
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

Result<void> compare(const Context& context, const Options& options, const Document& document,
                     const std::vector<std::size_t>& objects) {
    json::Writer w;
    std::string table;
    w.begin_object().key("objects").begin_array();
    const auto done = each_curve(
        document, objects, options.file, [&]<class P>(std::size_t i, const Curve<P>& curve) -> Result<void> {
            const auto rows = compare_flattening(curve, *options.compare);
            if (!rows) return std::unexpected(rows.error());
            w.new_line(1).begin_object().field("object", i).key("methods").begin_array();
            table += text(object_label(document, i),
                          "\n  method            segments  largest distance (measured)  bound\n");
            for (const FlattenComparison& r : *rows) {
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
            return {};
        });
    if (!done) return done;
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : table);
}

Result<void> run(const Context& context, const Options& options) {
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
    if (options.tolerance && !(*options.tolerance > 0))
        wrong_usage(text("--tolerance needs a positive number, found ", *options.tolerance));
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    if (options.compare) return compare(context, options, *document, *objects);

    FlattenOptions how;
    how.method = FlattenMethod(method - std::begin(kMethods));
    how.tolerance = options.tolerance.value_or(0);
    how.segments = options.segments.value_or(0);
    how.polygons = options.polygons;
    if (how.polygons && how.method != FlattenMethod::halving)
        wrong_usage("--polygons draws the control polygons of --method halving");
    std::vector<Line> lines;
    const auto done =
        each_curve(*document, *objects, options.file, [&](std::size_t i, const auto& curve) -> Result<void> {
            if constexpr (requires { curve.edges; })
                return add_edges(curve, i, how, lines);
            else
                return add_curve(curve, i, how, document->objects[i].name, lines);
        });
    if (!done) return done;
    if (format == "json") return emit(context, to_json(lines, *document));
    if (format == "csv") return emit(context, to_csv(lines));
    const auto svg = to_svg(lines, options.file);
    return svg ? emit(context, *svg) : std::unexpected(svg.error());
}

}  // namespace

void add_flatten(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        add_command(app, context, "flatten",
                    "Curves, and edges of models, as polylines, within a distance that is proven",
                    "  freiform flatten curves.json --tolerance 0.01 -o curves.svg\n"
                    "  freiform flatten curve.json --segments 64 --method forward\n"
                    "  freiform flatten curve.json --compare 16");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    add_number(*command, "--tolerance", options->tolerance,
               "Largest distance between curve and polyline, in the unit of the file");
    add_count(*command, "--segments", options->segments, 1, 10'000'000,
              "Number of segments instead of a tolerance; error_bound says what it reached");
    command
        ->add_option("--method", options->method,
                     "adaptive: as few segments as possible (default); uniform: equal parameter steps; "
                     "forward: forward differences; halving: halved until flat")
        ->type_name("METHOD");
    command->add_flag("--polygons", options->polygons, "halving: the control polygons of the last level");
    add_count(*command, "--compare", options->compare, 1, 1'000'000,
              "A table of what every method reaches with this number of segments");
    add_output(*command, context, "The polylines: .json, .csv or .svg");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
