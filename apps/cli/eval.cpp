// eval: points and derivatives at parameters.
#include "input.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/io/points.hpp>
#include <freiform/spline/accurate.hpp>
#include <freiform/spline/construction.hpp>

#include <cmath>

namespace freiform::cli {

namespace {

struct EvalArguments {
    std::string file, object, at;
    std::optional<int> derivatives;
    bool accurate = false, construction = false;
};

using Parameters = std::vector<std::vector<double>>;

// "0.5,0.25" -> {0.5, 0.25}; nothing if a part is not a number.
std::optional<std::vector<double>> numbers(std::string_view s) {
    std::vector<double> out;
    do {
        const auto x = scan_number<double>(trimmed(next_part(s, ',')));
        if (!x) return std::nullopt;
        out.push_back(*x);
    } while (!s.empty());
    return out;
}

Result<Parameters> parameters(const EvalArguments& options, const ReadOptions& limits) {
    if (options.at.starts_with('@')) {
        auto lines = read_number_lines(options.at.substr(1), limits);
        if (!lines) return std::unexpected(lines.error());
        if (lines->row.empty())
            return refuse(RefusalKind::unreadable, shown(options.at.substr(1)), "no line has numbers");
        return std::move(lines->row);
    }
    Parameters all;
    std::string_view rest = options.at;
    while (!rest.empty()) {
        const std::string_view part = trimmed(next_part(rest, ';'));
        if (part.empty() && rest.empty()) break;
        auto values = numbers(part);
        if (!values)
            wrong_usage(text("--at needs numbers: U, U,V or U,V,W, separated by ;, found \"", part, "\""));
        all.push_back(std::move(*values));
    }
    if (all.empty()) wrong_usage("--at needs at least one parameter");
    return all;
}

// A net of the construction of de Casteljau and de Boor, as many steps deep along each axis as `level` says.
struct Level {
    std::vector<int> level, extent;
    std::vector<double> points, weights;  // row by row; weights of rational patches
};
struct Levels {
    std::vector<Level> all;
    int dimension = 0;
    double bound = 0;
};

// Values of one object, each of its kind's own type, as numbers.
struct EvalAnswer {
    std::vector<double> point, bound;  // a bound for each coordinate, if asked for
    std::vector<std::vector<double>> derivatives;
    std::optional<Levels> construction = {};
};

struct Question {
    const std::vector<double>& at;
    std::size_t index;  // among the parameters that were given
    int derivatives;
    bool accurate, construction;
};

template <int D>
std::vector<double> numbers_of(const Vec<D>& v) {
    return {v.c.begin(), v.c.end()};
}

Result<void> check_count(const Question& q, std::size_t n) {
    if (q.at.size() == n) return {};
    return refuse(RefusalKind::no_answer, text("at[", q.index, "]"),
                  text("has ", q.at.size(), q.at.size() == 1 ? " number" : " numbers", ", the object has ", n,
                       n == 1 ? " parameter" : " parameters"));
}

// The patch was asked for one parameter, number 0; the question had many.
std::unexpected<Refusal> moved(Refusal r, std::size_t index) {
    if (r.where.starts_with("at[0]")) r.where = text("at[", index, "]", r.where.substr(5));
    return std::unexpected(std::move(r));
}

// The value; its bound only if that is wanted.
template <class S>
Result<void> evaluate(const S& patch, const Param<S::kParams>& u, bool accurate,
                      Accurate<typename S::Point>& out) {
    if (!accurate) return patch.evaluate(std::span(&u, 1), std::span(&out.value, 1));
    if constexpr (TensorPatch<S>)
        return evaluate_accurate(patch, std::span(&u, 1), std::span(&out, 1));
    else
        return refuse(RefusalKind::unsupported, "--accurate", "triangular patches have no accurate values");
}

template <std::size_t N, class P, class B>
Result<Levels> levels_of(const Patch<N, P, B>& patch, const Param<N>& u) {
    const auto c = de_boor(patch, u);
    if (!c) return std::unexpected(c.error());
    Levels out{{}, Space<P>::kDim, c->bound()};
    Index<N> extent;
    for (std::size_t d = 0; d < N; ++d) extent[d] = c->degree(int(d)) + 1;
    each_index(extent, [&](const Index<N>& r) {
        const auto net = c->level(r);
        Level level{{r.begin(), r.end()}, {net.extent.begin(), net.extent.end()}, {}, {}};
        each_index(net.extent, [&](const Index<N>& i) {
            const auto p = project(net(i));
            level.points.insert(level.points.end(), p.c.begin(), p.c.end());
            if (Space<P>::kRational) level.weights.push_back(Space<P>::weight(net(i)));
        });
        out.all.push_back(std::move(level));
    });
    return out;
}

struct Evaluation {
    const Question& q;

    template <class S>
    requires(TensorPatch<S> || TriangularPatch<S>) Result<EvalAnswer>
    operator()(const S& patch) const {
        Param<S::kParams> u{};
        if constexpr (S::kParams == 1)
            u = q.at[0];
        else
            std::copy(q.at.begin(), q.at.end(), u.begin());
        Accurate<typename S::Point> value;
        if (auto ok = evaluate(patch, u, q.accurate, value); !ok) return std::unexpected(ok.error());
        EvalAnswer answer_point{numbers_of(value.value), {}, {}};
        if (q.accurate) answer_point.bound = numbers_of(value.bound);
        if (q.derivatives > 0)
            for (const auto& d : patch.derivatives(u, q.derivatives))
                answer_point.derivatives.push_back(numbers_of(d));
        if (q.construction) {
            if constexpr (TensorPatch<S>) {
                auto levels = levels_of(patch, u);
                if (!levels) return std::unexpected(levels.error());
                answer_point.construction = *std::move(levels);
            } else {
                return refuse(RefusalKind::unsupported, "--construction", "is for tensor products");
            }
        }
        return answer_point;
    }
    Result<EvalAnswer> operator()(const TrimmedSurface& t) const { return visit_one(*this, t.surface); }
    Result<EvalAnswer> operator()(const Model&) const { return {}; }
};

bool is_finite(std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

Result<EvalAnswer> answer_point(const Shape& shape, const Question& q) {
    if (std::holds_alternative<Model>(shape))
        return refuse(RefusalKind::no_answer, "",
                      "is a model of many faces, which has no parameters of its own; eval needs a curve, "
                      "surface or volume");
    const std::size_t parameters = bases_of(shape).empty() ? 2 : bases_of(shape).size();
    if (auto ok = check_count(q, parameters); !ok) return std::unexpected(ok.error());
    auto found = visit_one(Evaluation{q}, shape);
    if (!found) return moved(std::move(found.error()), q.index);
    if (!is_finite(found->point) || !std::ranges::all_of(found->derivatives, is_finite))
        return refuse(RefusalKind::ill_conditioned, text("at[", q.index, "]"),
                      "a value or derivative there leaves the range of double");
    return found;
}

void write_point(json::Writer& w, const Levels& c) {
    w.key("construction").begin_array();
    for (const Level& level : c.all) {
        w.new_line(2).begin_object();
        w.key("level").array(level.level).key("extent").array(level.extent).key("points").begin_array();
        const std::span<const double> points = level.points;
        for (std::size_t i = 0; i < points.size(); i += std::size_t(c.dimension))
            w.array(points.subspan(i, std::size_t(c.dimension)));
        w.end_array();
        if (!level.weights.empty()) w.key("weights").array(level.weights);
        w.end_object();
    }
    w.end_array().field("construction_bound", c.bound);
}

void write_point(json::Writer& w, std::optional<std::size_t> object, const Question& q, const EvalAnswer& a) {
    w.new_line(1).begin_object();
    if (object) w.field("object", *object);
    w.key("at").array(q.at).key("point").array(a.point);
    if (q.accurate) w.key("bound").array(a.bound);
    if (q.derivatives > 0) {
        w.key("derivatives").begin_array();
        for (const auto& d : std::span(a.derivatives).subspan(1)) w.array(d);
        w.end_array();
    }
    if (a.construction) write_point(w, *a.construction);
    w.end_object();
}

Result<void> run_eval(const Context& context, const EvalArguments& options) {
    const auto at = parameters(options, context.read_options());
    if (!at) return std::unexpected(at.error());
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    if (input->chosen.empty())
        return refuse(RefusalKind::no_answer, shown(options.file), "there is no object to evaluate");

    json::Writer w;
    w.begin_object().key("results").begin_array();
    const bool several = input->document->objects.size() > 1;
    for (const std::size_t o : input->chosen)
        for (std::size_t i = 0; i < at->size(); ++i) {
            const Question q{(*at)[i], i, options.derivatives.value_or(0), options.accurate,
                             options.construction};
            const auto a = answer_point(input->object(o).shape, q);
            if (!a) return input->about(o, a.error());
            write_point(w, several ? std::optional(o) : std::nullopt, q, *a);
        }
    w.end_array().end_object();
    return emit(context, w.take() + "\n");
}

}  // namespace

void add_eval(CommandLine& line) {
    constexpr int kMostDerivatives = 60;
    const auto options = std::make_shared<EvalArguments>();
    const Command command =
        line.add("eval", "Points and derivatives at parameters, as JSON",
                 "  freiform eval curve.json --at 0.5\n"
                 "  freiform eval teapot.bpt --object 3 --at '0,0;0.5,0.25' --derivatives 2\n"
                 "  freiform eval curve.json --at @parameters.csv\n"
                 "  freiform eval curve.json --at 0.75 --accurate");
    command.file(options->file);
    command
        .word("--at", options->at,
              "Parameters in the object's own domain, or @FILE with a line for each; several objects "
              "are all asked")
        .shown_as("U[,V[,W]][;...]")
        .required();
    command.count("--derivatives", options->derivatives, 0, kMostDerivatives,
                  "Derivatives to this order; of a surface du, dv, duu, duv, dvv, ...");
    command.flag(
        "--accurate", options->accurate,
        "Points right to the last digit, each with a proven bound of its error, by coordinate; slower");
    command.flag(
        "--construction", options->construction,
        "All intermediate points of de Casteljau and de Boor: of a surface the nets r steps deep along u "
        "and s along v, \"level\": [r, s]");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_eval);
}

}  // namespace freiform::cli
