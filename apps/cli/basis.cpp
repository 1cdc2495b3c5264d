// basis: the coefficients of curves in other bases, with what the change costs.
#include "command.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/make/named_curve.hpp>

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object, scheme;
    std::optional<double> origin;
    std::vector<double> nodes;
};

Result<PolynomialBasis> wanted(const Options& o, int degree, Interval on) {
    if (o.scheme == "monomial") return PolynomialBasis::monomial(degree, o.origin.value_or(on.lo));
    if (o.scheme == "bernstein") return PolynomialBasis::bernstein(degree, on);
    if (o.scheme == "hermite") return PolynomialBasis::hermite(degree, on);
    auto nodes = o.nodes.empty() ? equidistant(degree + 1, on) : o.nodes;
    if (int(nodes.size()) != degree + 1)
        return refuse(RefusalKind::no_answer, "--nodes",
                      text(nodes.size(), " nodes for degree ", degree, "; ", degree + 1, " are expected"));
    return o.scheme == "newton" ? PolynomialBasis::newton(std::move(nodes))
                                : PolynomialBasis::lagrange(std::move(nodes));
}

std::string list(std::span<const double> numbers) {
    std::string s;
    for (const double x : numbers) s += text(s.empty() ? "" : " ", x);
    return s;
}

// What the numbers of a basis are, for JSON and for people.
std::string_view meaning(Scheme scheme) {
    switch (scheme) {
        case Scheme::monomial:
            return "origin";
        case Scheme::lagrange:
        case Scheme::newton:
            return "nodes";
        case Scheme::hermite:
            return "ends";
        default:
            return "knots";
    }
}

struct Answers {
    json::Writer json;
    std::string text;
};

class Changes {
public:
    Changes(Answers& out, const Options& options, std::size_t object, std::string label)
        : out_(out), o_(options), object_(object), label_(std::move(label)) {}

    template <TensorPatch S>
    Result<void> operator()(const S& s) {
        if constexpr (S::kParams == 1) {
            const auto breaks = s.basis().breaks();
            for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
                if (auto ok = piece(s, i, {breaks[i], breaks[i + 1]}); !ok) return ok;
            return {};
        } else {
            return refuse(RefusalKind::no_answer, "", "is no curve; basis is for curves");
        }
    }
    template <class S>
    Result<void> operator()(const S&) {
        return refuse(RefusalKind::no_answer, "", "is no curve; basis is for curves");
    }

private:
    template <class P>
    Result<void> piece(const Curve<P>& curve, std::size_t index, Interval on) {
        // What a piece cannot be written in is a question without an answer, not a broken file.
        const auto about = [&](Refusal r) {
            if (r.kind == RefusalKind::invalid || r.kind == RefusalKind::unsupported)
                r.kind = RefusalKind::no_answer;
            return refuse_within(text("piece ", index), std::move(r));
        };
        const auto basis = wanted(o_, curve.basis().degree(), on);
        if (!basis) return about(basis.error());
        const auto c = to_basis(curve, on.lo, *basis);
        if (!c) return about(c.error());
        std::span<const double> numbers = basis->numbers();
        json::Writer& w = out_.json;
        w.new_line(1).begin_object().field("object", object_).field("piece", index);
        w.key("interval").array(std::array{on.lo, on.hi});
        w.field("basis", name_of(basis->scheme())).field("degree", basis->degree());
        if (basis->scheme() == Scheme::monomial)
            w.field("origin", numbers[0]);
        else
            w.key(meaning(basis->scheme())).array(numbers);
        w.field("homogeneous", Space<P>::kRational);
        w.key("coefficients").begin_array();
        for (const P& p : c->coefficients) w.array(p.c);
        w.end_array().field("bound", c->bound).field("condition", c->condition).end_object();

        out_.text +=
            text(label_, ", piece ", index, " on [", on.lo, ", ", on.hi, "]: ", name_of(basis->scheme()),
                 " of degree ", basis->degree(), ", ", meaning(basis->scheme()), " ", list(numbers),
                 Space<P>::kRational ? ", homogeneous (w x, .., w)" : "", "\n");
        for (const P& p : c->coefficients) out_.text += text("  ", list(p.c), "\n");
        out_.text +=
            text("  within ", c->bound, "; condition ", c->condition,
                 c->condition >= 1e15 ? ": an error in the last digit may change all digits" : "", "\n");
        return {};
    }

    Answers& out_;
    const Options& o_;
    std::size_t object_;
    std::string label_;
};

Result<void> run(const Context& context, const Options& options) {
    if (options.origin && options.scheme != "monomial") wrong_usage("--origin is for --to-basis monomial");
    if (!options.nodes.empty() && options.scheme != "lagrange" && options.scheme != "newton")
        wrong_usage("--nodes is for --to-basis lagrange or newton");
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    if (objects->empty()) return refuse(RefusalKind::no_answer, shown(options.file), "there is no curve");
    Answers out;
    out.json.begin_object().key("results").begin_array();
    for (const std::size_t i : *objects) {
        const std::string label =
            document->objects.size() > 1 ? object_label(*document, i) : shown(options.file);
        if (auto ok = std::visit(Changes(out, options, i, label), document->objects[i].shape); !ok) {
            Refusal r = ok.error();
            r.where = r.where.empty() ? label : text(label, ": ", r.where);
            return std::unexpected(std::move(r));
        }
    }
    out.json.end_array().end_object();
    return emit(context, context.json ? out.json.take() + "\n" : out.text);
}

}  // namespace

void add_basis(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(
        app, context, "basis", "Coefficients of curves in another basis, with a bound and the condition",
        "  freiform basis curve.json --to-basis monomial --origin 0\n"
        "  freiform basis curve.json --to-basis lagrange --nodes 0,0.25,0.75,1 --json\n"
        "Monomials: highest power first. Hermite: values at both ends, first derivatives at both, and so "
        "on.\n"
        "`condition` is how much larger relative errors of the new coefficients may be than those of the old "
        "ones.");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    command->add_option("--to-basis", options->scheme, "The basis, for each polynomial piece")
        ->check(CLI::IsMember({"monomial", "bernstein", "hermite", "lagrange", "newton"}))
        ->required();
    add_number(*command, "--origin", options->origin,
               "Powers of t - ORIGIN; without it the lower end of each piece");
    add_numbers(*command, "--nodes", options->nodes,
                "Degree + 1 nodes; without them equidistant on each piece");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_option("-o,--output", context.output, "Where the answer goes")->type_name("FILE");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
