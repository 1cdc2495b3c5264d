// basis: the coefficients of curves in other bases, with what the change costs.
#include "input.hpp"

#include <freiform/make/named_curve.hpp>

namespace freiform::cli {

namespace {

struct BasisArguments {
    std::string file, object, scheme;
    std::optional<double> origin;
    std::vector<double> nodes;
};

Result<PolynomialBasis> wanted(const BasisArguments& o, int degree, Interval on) {
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

// The coefficients of one piece, as numbers.
struct Piece {
    std::size_t object = 0, index = 0;
    Interval on;
    PolynomialBasis basis;
    bool homogeneous = false;
    std::vector<std::vector<double>> coefficients;
    double bound = 0, condition = 0;
};

void write(json::Writer& w, const Piece& p) {
    const std::span<const double> numbers = p.basis.numbers();
    w.new_line(1).begin_object().field("object", p.object).field("piece", p.index);
    w.key("interval").array(std::array{p.on.lo, p.on.hi});
    w.field("basis", name_of(p.basis.scheme())).field("degree", p.basis.degree());
    if (p.basis.scheme() == Scheme::monomial)
        w.field("origin", numbers[0]);
    else
        w.key(meaning(p.basis.scheme())).array(numbers);
    w.field("homogeneous", p.homogeneous).key("coefficients").begin_array();
    for (const auto& c : p.coefficients) w.array(c);
    w.end_array().field("bound", p.bound).field("condition", p.condition).end_object();
}

std::string text_of(const Piece& p, const std::string& label) {
    std::string s =
        text(label, ", piece ", p.index, " on [", p.on.lo, ", ", p.on.hi, "]: ", name_of(p.basis.scheme()),
             " of degree ", p.basis.degree(), ", ", meaning(p.basis.scheme()), " ", list(p.basis.numbers()),
             p.homogeneous ? ", homogeneous (w x, .., w)" : "", "\n");
    for (const auto& c : p.coefficients) s += text("  ", list(c), "\n");
    return s + text("  within ", p.bound, "; condition ", p.condition,
                    p.condition >= 1e15 ? ": an error in the last digit may change all digits" : "", "\n");
}

template <class P>
Result<Piece> changed(const Curve<P>& curve, const PolynomialBasis& basis, Interval on) {
    const auto c = to_basis(curve, on.lo, basis);
    if (!c) return std::unexpected(c.error());
    Piece piece{0, 0, on, basis, Space<P>::kRational, {}, c->bound, c->condition};
    for (const P& p : c->coefficients) piece.coefficients.push_back({p.c.begin(), p.c.end()});
    return piece;
}

// What a piece cannot be written in is a question without an answer, not a broken file.
std::unexpected<Refusal> about_piece(std::size_t index, Refusal r) {
    if (r.kind == RefusalKind::invalid || r.kind == RefusalKind::unsupported) r.kind = RefusalKind::no_answer;
    return refuse_within(text("piece ", index), std::move(r));
}

Result<std::vector<Piece>> pieces_of(const Shape& shape, const BasisArguments& options) {
    const std::span<const BSplineBasis> bases = bases_of(shape);
    if (type_name(shape) != "curve")
        return refuse(RefusalKind::no_answer, "", "is no curve; basis is for curves");
    const auto breaks = bases[0].breaks();
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Interval on{breaks[i], breaks[i + 1]};
        const auto basis = wanted(options, bases[0].degree(), on);
        if (!basis) return about_piece(i, basis.error());
        std::optional<Result<Piece>> piece;
        with_curve(shape, [&](const auto& curve) { piece = changed(curve, *basis, on); });
        if (!*piece) return about_piece(i, piece->error());
        pieces.push_back(**std::move(piece));
        pieces.back().index = i;
    }
    return pieces;
}

Result<void> run_basis(const Context& context, const BasisArguments& options) {
    if (options.origin && options.scheme != "monomial") wrong_usage("--origin is for --to-basis monomial");
    if (!options.nodes.empty() && options.scheme != "lagrange" && options.scheme != "newton")
        wrong_usage("--nodes is for --to-basis lagrange or newton");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    if (input->chosen.empty())
        return refuse(RefusalKind::no_answer, shown(options.file), "there is no curve");
    json::Writer w;
    std::string lines;
    w.begin_object().key("results").begin_array();
    for (const std::size_t i : input->chosen) {
        auto pieces = pieces_of(input->object(i).shape, options);
        if (!pieces) return input->about(i, pieces.error());
        for (Piece& piece : *pieces) {
            piece.object = i;
            write(w, piece);
            lines += text_of(piece, input->label(i));
        }
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : lines);
}

}  // namespace

void add_basis(CommandLine& line) {
    const auto options = std::make_shared<BasisArguments>();
    const Command command = line.add(
        "basis", "Coefficients of curves in another basis, with a bound and the condition",
        "  freiform basis curve.json --to-basis monomial --origin 0\n"
        "  freiform basis curve.json --to-basis lagrange --nodes 0,0.25,0.75,1 --json\n"
        "Monomials: highest power first. Hermite: values at both ends, first derivatives at both, and so "
        "on.\n"
        "`condition` is how much larger relative errors of the new coefficients may be than those of the old "
        "ones.");
    command.file(options->file);
    command.word("--to-basis", options->scheme, "The basis, for each polynomial piece")
        .one_of({"monomial", "bernstein", "hermite", "lagrange", "newton"})
        .required();
    command.number("--origin", options->origin,
                   "Powers of t - ORIGIN; without it the lower end of each piece");
    command.numbers("--nodes", options->nodes, "Degree + 1 nodes; without them equidistant on each piece");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_basis);
}

}  // namespace freiform::cli
