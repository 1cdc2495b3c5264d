// interpolate: a curve through points, or a surface through a grid of them.
#include "point_commands.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>
#include <freiform/fit/bicubic.hpp>
#include <freiform/fit/interpolate.hpp>
#include <freiform/fit/local.hpp>

namespace freiform::cli {

namespace {

enum class Scheme {
    natural,
    clamped,
    not_a_knot,
    periodic,
    catmull_rom,
    akima,
    monotone,
    fritsch_carlson,
    catmull_rom_periodic
};
constexpr std::string_view kSchemes[] = {"natural",  "clamped",         "not-a-knot",
                                         "periodic", "catmull-rom",     "akima",
                                         "monotone", "fritsch-carlson", "catmull-rom-periodic"};
constexpr std::string_view kTwists[] = {"tensor", "zero", "adini", "bessel"};
constexpr std::string_view kSpacings[] = {"uniform", "chordal", "centripetal"};

struct InterpolateArguments {
    std::string file, ends = "natural", spacing, at, tangents, twists;
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
std::vector<Scheme> schemes(const InterpolateArguments& options, std::size_t axes) {
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
bool is_catmull_rom(Scheme s) { return s == Scheme::catmull_rom || s == Scheme::catmull_rom_periodic; }
bool is_closed(Scheme s, const InterpolateArguments& o) {
    return s == Scheme::periodic || s == Scheme::catmull_rom_periodic || (o.closed && is_local(s));
}

struct InterpolateAnswer {
    Document document;
    double bound = 0;
    std::optional<double> condition;
    std::vector<int> coefficients;
    std::vector<std::vector<double>> at;  // per axis
};

template <std::size_t N, int D>
InterpolateAnswer answer(Patch<N, Vec<D>> patch, double bound = 0, std::optional<double> condition = {}) {
    InterpolateAnswer a;
    a.bound = bound, a.condition = condition;
    a.coefficients.assign(patch.net().extent().begin(), patch.net().extent().end());
    a.document.objects.push_back({"", std::move(patch), {}});
    return a;
}

std::vector<double> given_parameters(std::string_view rest) {
    std::vector<double> at;
    while (!rest.empty()) {
        const auto x = scan_number<double>(trimmed(next_part(rest, ',')));
        if (!x) wrong_usage("--at needs numbers separated by commas");
        at.push_back(*x);
    }
    return at;
}

Spacing spacing_called(const InterpolateArguments& options, Scheme way) {
    const std::string word = !options.spacing.empty() ? options.spacing
                             : is_catmull_rom(way)    ? "uniform"
                                                      : "chordal";
    return Spacing(index_of("--parameters", word, kSpacings));
}

// The derivatives at both ends, in one list; as many as clamped ends need.
std::vector<std::vector<double>> given_tangents(const InterpolateArguments& options, Scheme way, int degree,
                                                int dim) {
    auto given = parse_vectors("--tangents", options.tangents, dim);
    const std::size_t wanted = way == Scheme::clamped ? 2 * std::size_t(degree / 2) : 0;
    if (wanted > 0 && options.tangents.empty()) {
        remark("clamped without --tangents: the derivatives at both ends are 0");
        given.assign(wanted, std::vector<double>(std::size_t(dim)));
    }
    if (way == Scheme::clamped && given.size() != wanted)
        wrong_usage(text("clamped ends of degree ", degree, " need --tangents with ", 2 * (degree / 2),
                         " vectors: the derivatives at the start, then those at the end"));
    return given;
}

template <std::size_t N, int D>
Result<InterpolateAnswer> through(const Net<N, Vec<D>>& points, const std::vector<std::vector<double>>& at,
                                  const std::array<bool, N>& closed, Twists twists) {
    std::array<std::span<const double>, N> spans;
    for (std::size_t d = 0; d < N; ++d) spans[d] = at[d];
    auto patch = [&]() -> Result<Patch<N, Vec<D>>> {
        if constexpr (N == 2)
            if (twists != Twists::tensor) return bicubic_through<D>(points, spans, closed, twists);
        return catmull_rom(points, spans, closed);
    }();
    if (!patch) return std::unexpected(patch.error());
    return answer<N, D>(std::move(*patch));
}

template <int D>
Result<InterpolateAnswer> with_local_slopes(std::span<const Vec<D>> q, std::span<const double> at, Scheme way,
                                            bool closed) {
    const auto kind = way == Scheme::akima      ? LocalSlopes::akima
                      : way == Scheme::monotone ? LocalSlopes::monotone
                                                : LocalSlopes::fritsch_carlson;
    const auto slopes = local_slopes<D>(q, at, kind, closed);
    if (!slopes) return std::unexpected(slopes.error());
    auto curve = cubic_through<D>(q, *slopes, at, closed);
    if (!curve) return std::unexpected(curve.error());
    return answer<1, D>(std::move(*curve));
}

template <std::size_t N, int D>
Result<InterpolateAnswer> global(const Net<N, Vec<D>>& points, const InterpolateArguments& options,
                                 const std::vector<std::vector<double>>& at,
                                 const std::vector<Scheme>& ways) {
    std::array<AxisSpline, N> axes;
    for (std::size_t d = 0; d < N; ++d)
        axes[d] = {options.degree.value_or(3), SplineEnds(int(ways[d])), at[d]};
    std::optional<Result<Interpolant<N, D>>> found;
    if constexpr (N == 1) {
        const auto given = given_tangents(options, ways[0], axes[0].degree, D);
        std::vector<Vec<D>> tangents(given.size());
        for (std::size_t i = 0; i < given.size(); ++i)
            std::copy(given[i].begin(), given[i].end(), tangents[i].c.begin());
        const std::span<const Vec<D>> all = tangents;
        const std::size_t half = given.size() / 2;
        found = interpolate<D>(points.flat(), axes[0], all.first(half), all.subspan(half));
    } else {
        found = interpolate<N, D>(points, axes);
    }
    if (!*found) return std::unexpected(found->error());
    return answer<N, D>(std::move((*found)->patch), (*found)->bound, (*found)->condition_estimate);
}

template <std::size_t N, int D>
Result<InterpolateAnswer> solve(const Net<N, Vec<D>>& points, const InterpolateArguments& options,
                                const std::vector<Scheme>& ways) {
    std::vector<std::vector<double>> at(N);
    std::array<bool, N> closed{};
    for (std::size_t d = 0; d < N; ++d) {
        closed[d] = is_closed(ways[d], options);
        if (N == 1 && !options.at.empty()) {
            at[d] = given_parameters(options.at);
            continue;
        }
        auto found = parameters(points, int(d), spacing_called(options, ways[d]), closed[d]);
        if (!found) return std::unexpected(found.error());
        at[d] = std::move(*found);
    }
    Result<InterpolateAnswer> a;
    if (is_catmull_rom(ways[0]))
        a = through<N, D>(points, at, closed,
                          Twists(options.twists.empty() ? 0 : index_of("--twists", options.twists, kTwists)));
    else if (!is_local(ways[0]))
        a = global<N, D>(points, options, at, ways);
    else if constexpr (N == 1)
        a = with_local_slopes<D>(points.flat(), at[0], ways[0], closed[0]);
    if (a) a->at = std::move(at);
    return a;
}

Result<void> report_spline(const Context& context, const InterpolateArguments& options,
                           const std::string& format, const PointTable& table, InterpolateAnswer a) {
    const bool curve = a.at.size() == 1;
    json::Writer w;
    w.begin_object().field("points", table.place.size()).key("coefficients").array(a.coefficients);
    w.field("ends", options.ends).field("bound", a.bound);
    if (a.condition) w.field("condition_estimate", *a.condition);
    w.key("parameters");
    if (curve) {
        w.array(a.at[0]);
    } else {
        w.begin_array();
        for (const auto& at : a.at) w.array(at);
        w.end_array();
    }
    w.field("output", context.output).end_object();
    std::string s = text("points          ", table.place.size(), "\ncoefficients    ", a.coefficients[0]);
    for (std::size_t d = 1; d < a.at.size(); ++d) s += text(" x ", a.coefficients[d]);
    s += text("\nbound           ", a.bound, " (no point is farther from the ", curve ? "curve" : "surface",
              ")\n");
    if (a.condition) s += text("condition       ", *a.condition, " (estimate)\n");
    s += text("written to ", context.output, "\n");
    return emit_spline(context, format, std::move(a.document), s, w.take() + "\n");
}

Result<void> run_interpolate(const Context& context, const InterpolateArguments& options) {
    const std::string format = spline_format(context, "interpolate");
    if (!options.spacing.empty()) (void)index_of("--parameters", options.spacing, kSpacings);
    if (!options.spacing.empty() && !options.at.empty())
        wrong_usage("--parameters and --at exclude each other");
    (void)schemes(options, 2);
    if (!options.twists.empty()) (void)index_of("--twists", options.twists, kTwists);
    const auto table = read_points(options.file, context.read_options());
    if (!table) return std::unexpected(table.error());
    const std::size_t axes = table->grid ? 2 : 1;
    const auto ways = schemes(options, axes);
    for (const Scheme s : ways) {
        if (is_local(s) != is_local(ways[0]) || is_catmull_rom(s) != is_catmull_rom(ways[0]))
            wrong_usage("--ends mixes schemes that do not go together");
        if (is_local(s) && options.degree && *options.degree != 3)
            wrong_usage(text(kSchemes[int(s)], " is for degree 3"));
        if (axes == 2 && ((is_local(s) && !is_catmull_rom(s)) || s == Scheme::clamped))
            wrong_usage(text(kSchemes[int(s)],
                             " is for curves; a grid takes natural, not-a-knot, periodic, catmull-rom or "
                             "catmull-rom-periodic"));
        if (s != Scheme::clamped && !options.tangents.empty())
            wrong_usage("--tangents goes with --ends clamped");
        if (!is_local(s) && options.closed && s != Scheme::periodic)
            wrong_usage(
                "--closed goes with the local schemes (catmull-rom, ...); closed splines are --ends "
                "periodic");
    }
    if (axes == 2 && !options.at.empty()) wrong_usage("--at is for curves");
    if (!options.twists.empty() && (axes == 1 || !is_catmull_rom(ways[0])))
        wrong_usage("--twists is for grids with --ends catmull-rom or catmull-rom-periodic");
    return with_points(*table, [&]<int D>(std::vector<Vec<D>> points) -> Result<void> {
        if (table->grid) {
            auto a = solve<2, D>(Net<2, Vec<D>>(table->extent, std::move(points)), options, ways);
            if (!a) return about_file(a.error(), *table, options.file);
            return report_spline(context, options, format, *table, *std::move(a));
        }
        // A closed polygon is often written with its first point again at the end.
        if (is_closed(ways[0], options) && options.at.empty() && points.size() > 2 &&
            points.front() == points.back()) {
            points.pop_back();
            remark("the last point repeats the first; the curve closes there");
        }
        const int n = int(points.size());
        auto a = solve<1, D>(Net<1, Vec<D>>({n}, std::move(points)), options, ways);
        if (!a) return about_file(a.error(), *table, options.file);
        return report_spline(context, options, format, *table, *std::move(a));
    });
}

}  // namespace

void add_interpolate(CommandLine& line) {
    const auto options = std::make_shared<InterpolateArguments>();
    const Command command = line.add(
        "interpolate", "A spline through points: a curve, or a surface through a grid",
        "  freiform interpolate points.csv -o curve.json\n"
        "  freiform interpolate points.csv --ends catmull-rom -o curve.json\n"
        "  freiform interpolate ring.csv --ends periodic --degree 5 -o ring.json\n"
        "  freiform interpolate points.csv --ends clamped --tangents '1,0;0,1' -o curve.json\n"
        "  freiform interpolate grid.json --ends natural,periodic -o tube.json\n"
        "  freiform interpolate grid.json --ends catmull-rom --twists adini -o patches.json\n"
        "Points are lines of 1 to 4 numbers, or JSON: [[x,y], ...], of a grid [[[x,y,z], ...], ...].\n"
        "natural, clamped, not-a-knot and periodic have degree - 1 continuous derivatives;\n"
        "catmull-rom, akima, monotone and fritsch-carlson are cubic with continuous first derivatives and "
        "local.\n"
        "Without --parameters: chordal; uniform for catmull-rom.");
    command.points_file(options->file);
    command.output("The file to write: .json or .bpt");
    command.count("--degree", options->degree, 1, kMaxDegree, "Degree of the spline (3)");
    command
        .word("--ends", options->ends,
              "natural, clamped, not-a-knot, periodic, catmull-rom, catmull-rom-periodic, akima, monotone or "
              "fritsch-carlson; of a grid one for each direction")
        .shown_as("WAY[,WAY]");
    command.word("--parameters", options->spacing, "uniform, chordal or centripetal").shown_as("WAY");
    command
        .word("--at", options->at,
              "The parameters themselves, one for each point (closed: and the period's end)")
        .shown_as("NUMBER,...");
    command
        .word("--tangents", options->tangents,
              "With clamped: derivatives by the parameter at the start, then at the end (default 0)")
        .shown_as("X,Y;X,Y");
    command.flag("--closed", options->closed, "Close a curve of a local scheme (catmull-rom, ...)");
    command
        .word("--twists", options->twists,
              "Mixed derivatives of a grid with catmull-rom: tensor (default), zero, adini or bessel")
        .shown_as("WAY");
    command.limits();
    command.action(options, run_interpolate);
}

}  // namespace freiform::cli
