// eval: points and derivatives at parameters.
#include "command.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/points.hpp>
#include <freiform/spline/accurate.hpp>

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object, at;
    std::optional<int> derivatives;
    bool accurate = false;
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

Result<Parameters> parameters(const Options& options, const ReadOptions& limits) {
    if (options.at.starts_with('@')) {
        auto lines = read_number_lines(options.at.substr(1), limits);
        if (!lines) return std::unexpected(lines.error());
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

class Evaluation {
public:
    Evaluation(json::Writer& w, const Parameters& at, int derivatives, bool accurate,
               std::optional<std::size_t> object)
        : w_(w), at_(at), derivatives_(derivatives), accurate_(accurate), object_(object) {}

    template <class S>
    requires(TensorPatch<S> || TriangularPatch<S>) Result<void>
    operator()(const S& patch) {
        constexpr std::size_t N = S::kParams;
        for (std::size_t i = 0; i < at_.size(); ++i) {
            Param<N> u{};
            if (auto ok = fill<N>(i, u); !ok) return ok;
            Accurate<typename S::Point> value;
            auto& point = value.value;
            if (auto ok = answer(patch, u, value); !ok) return moved(ok.error(), i);
            const auto all = patch.derivatives(u, derivatives_);
            for (const auto& d : all)
                if (!is_finite(d) || !is_finite(point))
                    return refuse(RefusalKind::ill_conditioned, text("at[", i, "]"),
                                  "a value or derivative there leaves the range of double");
            write(i, value, std::span(all).subspan(1));
        }
        return {};
    }
    Result<void> operator()(const TrimmedSurface& t) {
        return std::visit([&](const auto& s) { return (*this)(s); }, t.surface);
    }
    Result<void> operator()(const Model&) const {
        return refuse(RefusalKind::no_answer, "",
                      "is a model of many faces, which has no parameters of its own; eval needs a curve, "
                      "surface or volume");
    }

private:
    // The value; its bound only if that is wanted.
    template <class S>
    Result<void> answer(const S& patch, const Param<S::kParams>& u, Accurate<typename S::Point>& out) const {
        if (!accurate_) return patch.evaluate(std::span(&u, 1), std::span(&out.value, 1));
        if constexpr (TensorPatch<S>)
            return evaluate_accurate(patch, std::span(&u, 1), std::span(&out, 1));
        else
            return refuse(RefusalKind::unsupported, "--accurate",
                          "triangular patches have no accurate values");
    }
    template <std::size_t N>
    Result<void> fill(std::size_t i, Param<N>& u) const {
        if (at_[i].size() != N)
            return refuse(RefusalKind::no_answer, text("at[", i, "]"),
                          text("has ", at_[i].size(), at_[i].size() == 1 ? " number" : " numbers",
                               ", the object has ", N, N == 1 ? " parameter" : " parameters"));
        if constexpr (N == 1)
            u = at_[i][0];
        else
            for (std::size_t d = 0; d < N; ++d) u[d] = at_[i][d];
        return {};
    }
    // The patch was asked for one parameter, number 0; the question had many.
    static std::unexpected<Refusal> moved(Refusal r, std::size_t i) {
        if (r.where.starts_with("at[0]")) r.where = text("at[", i, "]", r.where.substr(5));
        return std::unexpected(std::move(r));
    }
    template <class Point>
    void write(std::size_t i, const Accurate<Point>& value, std::span<const Point> derivatives) {
        w_.new_line(1).begin_object();
        if (object_) w_.field("object", *object_);
        w_.key("at").array(at_[i]).key("point").array(value.value.c);
        if (accurate_) w_.key("bound").array(value.bound.c);
        if (derivatives_ > 0) {
            w_.key("derivatives").begin_array();
            for (const Point& d : derivatives) w_.array(d.c);
            w_.end_array();
        }
        w_.end_object();
    }

    json::Writer& w_;
    const Parameters& at_;
    int derivatives_;
    bool accurate_;
    std::optional<std::size_t> object_;
};

Result<void> run(const Context& context, const Options& options) {
    const auto at = parameters(options, context.read_options());
    if (!at) return std::unexpected(at.error());
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    if (objects->empty())
        return refuse(RefusalKind::no_answer, shown(options.file), "there is no object to evaluate");

    json::Writer w;
    w.begin_object().key("results").begin_array();
    for (const std::size_t i : *objects) {
        Evaluation evaluate(w, *at, options.derivatives.value_or(0), options.accurate,
                            document->objects.size() > 1 ? std::optional(i) : std::nullopt);
        if (auto ok = std::visit(evaluate, document->objects[i].shape); !ok) {
            Refusal r = ok.error();
            const std::string label =
                document->objects.size() > 1 ? object_label(*document, i) : shown(options.file);
            r.where = r.where.empty() ? label : text(label, ": ", r.where);
            return std::unexpected(std::move(r));
        }
    }
    w.end_array().end_object();
    return emit(context, w.take() + "\n");
}

}  // namespace

void add_eval(CLI::App& app, Context& context) {
    constexpr int kMostDerivatives = 60;
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        add_command(app, context, "eval", "Points and derivatives at parameters, as JSON",
                    "  freiform eval curve.json --at 0.5\n"
                    "  freiform eval teapot.bpt --object 3 --at '0,0;0.5,0.25' --derivatives 2\n"
                    "  freiform eval curve.json --at @parameters.csv\n"
                    "  freiform eval curve.json --at 0.75 --accurate");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    command
        ->add_option("--at", options->at,
                     "Parameters in the object's own domain, or @FILE with a line for each; several objects "
                     "are all asked")
        ->type_name("U[,V[,W]][;...]")
        ->required();
    add_count(*command, "--derivatives", options->derivatives, 0, kMostDerivatives,
              "Derivatives to this order; of a surface du, dv, duu, duv, dvv, ...");
    command->add_flag(
        "--accurate", options->accurate,
        "Points right to the last digit, each with a proven bound of its error, by coordinate; slower");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_option("-o,--output", context.output, "Where the answer goes")->type_name("FILE");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
