// interpolate: a curve through points, or a surface through a grid of them.
#include "point_commands.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>
#include <freiform/fit/interpolate.hpp>
#include <freiform/fit/local.hpp>

namespace freiform::cli {

namespace {

enum class Scheme { natural, clamped, not_a_knot, periodic, catmull_rom, akima, monotone, fritsch_carlson };
constexpr std::string_view kSchemes[] = {"natural",     "clamped", "not-a-knot", "periodic",
                                         "catmull-rom", "akima",   "monotone",   "fritsch-carlson"};
constexpr std::string_view kSpacings[] = {"uniform", "chordal", "centripetal"};

struct Options {
    std::string file, ends = "natural", spacing, at, tangents;
    std::optional<int> degree;
    bool closed = false;
};

template <std::size_t K>
int index_of(const std::string& option, std::string_view word, const std::string_view (&words)[K]) {
    for (std::size_t i = 0; i < K; ++i)
        if (words[i] == word) return int(i);
    wrong_usage(text(option, ": there is no \"", word, "\"", did_you_mean(word, words), "; there are ",
                     listed(words)));
}

// One way per axis, "natural,periodic"; one for both, "natural".
std::vector<Scheme> schemes(const Options& options, std::size_t axes) {
    std::vector<Scheme> out;
    std::string_view rest = options.ends;
    do out.push_back(Scheme(index_of("--ends", trimmed(next_part(rest, ',')), kSchemes)));
    while (!rest.empty());
    if (out.size() > axes)
        wrong_usage(text("--ends names ", out.size(), " ways, the points have ", axes,
                         axes == 1 ? " direction" : " directions"));
    while (out.size() < axes) out.push_back(out[0]);
    return out;
}

bool is_local(Scheme s) { return s >= Scheme::catmull_rom; }
bool is_closed(Scheme s, const Options& o) { return s == Scheme::periodic || (o.closed && is_local(s)); }

template <std::size_t N>
struct Answer {
    Document document;
    double bound = 0;
    std::optional<double> condition;
    std::array<std::vector<double>, N> at;
    Index<N> coefficients{};
};

template <std::size_t N, int D>
Result<Answer<N>> answer(Patch<N, Vec<D>> patch, double bound, std::optional<double> condition,
                         std::array<std::vector<double>, N> at) {
    Answer<N> a;
    a.bound = bound, a.condition = condition, a.at = std::move(at);
    a.coefficients = patch.net().extent();
    a.document.objects.push_back({"", std::move(patch), {}});
    return a;
}

template <std::size_t N, int D>
Result<Answer<N>> solve(const Net<N, Vec<D>>& points, const Options& options,
                        const std::vector<Scheme>& ways) {
    std::array<std::vector<double>, N> at;
    std::array<bool, N> closed{};
    for (std::size_t d = 0; d < N; ++d) {
        closed[d] = is_closed(ways[d], options);
        const std::string word = !options.spacing.empty()         ? options.spacing
                                 : ways[d] == Scheme::catmull_rom ? "uniform"
                                                                  : "chordal";
        if (N == 1 && !options.at.empty()) {
            std::string_view rest = options.at;
            while (!rest.empty()) {
                const auto x = scan_number<double>(trimmed(next_part(rest, ',')));
                if (!x) wrong_usage("--at needs numbers separated by commas");
                at[d].push_back(*x);
            }
            continue;
        }
        auto found =
            parameters(points, int(d), Spacing(index_of("--parameters", word, kSpacings)), closed[d]);
        if (!found) return std::unexpected(found.error());
        at[d] = std::move(*found);
    }
    if (is_local(ways[0])) {
        if (ways[0] == Scheme::catmull_rom) {
            std::array<std::span<const double>, N> spans;
            for (std::size_t d = 0; d < N; ++d) spans[d] = at[d];
            auto patch = catmull_rom(points, spans, closed);
            if (!patch) return std::unexpected(patch.error());
            return answer<N, D>(std::move(*patch), 0, std::nullopt, std::move(at));
        }
        if constexpr (N == 1) {
            const std::span<const Vec<D>> q = points.flat();
            const auto kind = ways[0] == Scheme::akima      ? LocalSlopes::akima
                              : ways[0] == Scheme::monotone ? LocalSlopes::monotone
                                                            : LocalSlopes::fritsch_carlson;
            const auto slopes = local_slopes<D>(q, at[0], kind, closed[0]);
            if (!slopes) return std::unexpected(slopes.error());
            auto curve = cubic_through<D>(q, *slopes, at[0], closed[0]);
            if (!curve) return std::unexpected(curve.error());
            return answer<N, D>(std::move(*curve), 0, std::nullopt, std::move(at));
        }
    }
    std::array<AxisSpline, N> axes;
    for (std::size_t d = 0; d < N; ++d)
        axes[d] = {options.degree.value_or(3), SplineEnds(int(ways[d])), at[d]};
    auto found = [&]() -> Result<Interpolant<N, D>> {
        if constexpr (N == 1) {
            std::vector<Vec<D>> start, end;
            const auto given = parse_vectors("--tangents", options.tangents, D);
            if (ways[0] == Scheme::clamped && given.size() != 2 * std::size_t(axes[0].degree / 2))
                wrong_usage(text("clamped ends of degree ", axes[0].degree, " need --tangents with ",
                                 2 * (axes[0].degree / 2),
                                 " vectors: the derivatives at the start, then those at the end"));
            for (std::size_t i = 0; i < given.size(); ++i) {
                Vec<D> v;
                for (int c = 0; c < D; ++c) v[c] = given[i][std::size_t(c)];
                (i < given.size() / 2 ? start : end).push_back(v);
            }
            return interpolate<D>(points.flat(), axes[0], start, end);
        } else {
            return interpolate<N, D>(points, axes);
        }
    }();
    if (!found) return std::unexpected(found.error());
    return answer<N, D>(std::move(found->patch), found->bound, found->condition_estimate, std::move(at));
}

template <std::size_t N>
Result<void> report(const Context& context, const Options& options, const std::string& format,
                    const PointTable& table, Answer<N> a) {
    json::Writer w;
    w.begin_object().field("points", table.place.size()).key("coefficients").array(a.coefficients);
    w.field("ends", options.ends).field("bound", a.bound);
    if (a.condition) w.field("condition_estimate", *a.condition);
    w.key("parameters");
    if (N == 1) {
        w.array(a.at[0]);
    } else {
        w.begin_array();
        for (const auto& at : a.at) w.array(at);
        w.end_array();
    }
    w.field("output", context.output).end_object();
    std::string s = text("points          ", table.place.size(), "\ncoefficients    ", a.coefficients[0]);
    for (std::size_t d = 1; d < N; ++d) s += text(" x ", a.coefficients[d]);
    s += text("\nbound           ", a.bound, " (no point is farther from the ", N == 1 ? "curve" : "surface",
              ")\n");
    if (a.condition) s += text("condition       ", *a.condition, " (estimate)\n");
    s += text("written to ", context.output, "\n");
    return emit_spline(context, format, std::move(a.document), s, w.take() + "\n");
}

Result<void> run(const Context& context, const Options& options) {
    const std::string format = spline_format(context, "interpolate");
    if (!options.spacing.empty()) (void)index_of("--parameters", options.spacing, kSpacings);
    if (!options.spacing.empty() && !options.at.empty())
        wrong_usage("--parameters and --at exclude each other");
    (void)schemes(options, 2);
    const auto table = read_points(options.file, context.read_options());
    if (!table) return std::unexpected(table.error());
    const std::size_t axes = table->grid ? 2 : 1;
    const auto ways = schemes(options, axes);
    for (const Scheme s : ways) {
        if (is_local(s) != is_local(ways[0]) || (is_local(s) && s != ways[0]))
            wrong_usage("--ends mixes schemes that do not go together");
        if (is_local(s) && options.degree && *options.degree != 3)
            wrong_usage(text(kSchemes[int(s)], " is for degree 3"));
        if (axes == 2 && ((is_local(s) && s != Scheme::catmull_rom) || s == Scheme::clamped))
            wrong_usage(text(kSchemes[int(s)],
                             " is for curves; a grid takes natural, not-a-knot, periodic or catmull-rom"));
        if (s != Scheme::clamped && !options.tangents.empty())
            wrong_usage("--tangents goes with --ends clamped");
        if (!is_local(s) && options.closed && s != Scheme::periodic)
            wrong_usage(
                "--closed goes with the local schemes (catmull-rom, ...); closed splines are --ends "
                "periodic");
    }
    if (axes == 2 && !options.at.empty()) wrong_usage("--at is for curves");
    return with_points(*table, [&]<int D>(std::vector<Vec<D>> points) -> Result<void> {
        if (table->grid) {
            const auto a = solve<2, D>(Net<2, Vec<D>>(table->extent, std::move(points)), options, ways);
            if (!a) return about_file(a.error(), *table, options.file);
            return report<2>(context, options, format, *table, *a);
        }
        // A closed polygon is often written with its first point again at the end.
        if (is_closed(ways[0], options) && options.at.empty() && points.size() > 2 &&
            points.front() == points.back()) {
            points.pop_back();
            remark("the last point repeats the first; the curve closes there");
        }
        const int n = int(points.size());
        const auto a = solve<1, D>(Net<1, Vec<D>>({n}, std::move(points)), options, ways);
        if (!a) return about_file(a.error(), *table, options.file);
        return report<1>(context, options, format, *table, *a);
    });
}

}  // namespace

void add_interpolate(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(
        app, context, "interpolate", "A spline through points: a curve, or a surface through a grid",
        "  freiform interpolate points.csv -o curve.json\n"
        "  freiform interpolate points.csv --ends catmull-rom -o curve.json\n"
        "  freiform interpolate ring.csv --ends periodic --degree 5 -o ring.json\n"
        "  freiform interpolate points.csv --ends clamped --tangents '1,0;0,1' -o curve.json\n"
        "  freiform interpolate grid.json --ends natural,periodic -o tube.json\n"
        "Points are lines of 1 to 4 numbers, or JSON: [[x,y], ...], of a grid [[[x,y,z], ...], ...].\n"
        "natural, clamped, not-a-knot and periodic have degree - 1 continuous derivatives;\n"
        "catmull-rom, akima, monotone and fritsch-carlson are cubic with continuous first derivatives and "
        "local.\n"
        "Without --parameters: chordal; uniform for catmull-rom.");
    command->add_option("POINTS", options->file, "The file with the points; - is standard input")->required();
    add_output(*command, context, "The file to write: .json or .bpt");
    add_count(*command, "--degree", options->degree, 1, kMaxDegree, "Degree of the spline (3)");
    command
        ->add_option("--ends", options->ends,
                     "natural, clamped, not-a-knot, periodic, catmull-rom, akima, monotone or "
                     "fritsch-carlson; of a grid one "
                     "for each direction")
        ->type_name("WAY[,WAY]");
    command->add_option("--parameters", options->spacing, "uniform, chordal or centripetal")
        ->type_name("WAY");
    command
        ->add_option("--at", options->at,
                     "The parameters themselves, one for each point (closed: and the period's end)")
        ->type_name("NUMBER,...");
    command
        ->add_option("--tangents", options->tangents,
                     "With clamped: derivatives by the parameter at the start, then at the end")
        ->type_name("X,Y;X,Y");
    command->add_flag("--closed", options->closed, "Close a curve of a local scheme (catmull-rom, ...)");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
