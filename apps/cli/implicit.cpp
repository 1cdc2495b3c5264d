// implicit: the equations of plane curves.
#include "input.hpp"
#include "point_commands.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/query/implicit.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>

namespace freiform::cli {

namespace {

struct ImplicitArguments {
    std::string file, object, at;
};

std::string monomial(int x, int y) {
    std::string s;
    for (const auto& [name, power] : {std::pair{"x", x}, {"y", y}})
        if (power > 0) s += text(" ", name, power > 1 ? text("^", power) : "");
    return s;
}

// "2 x^2 - 1 y = 0": highest powers first, without zeros.
std::string equation(const std::vector<Implicit::Term>& terms) {
    std::string s;
    for (auto t = terms.rbegin(); t != terms.rend(); ++t) {
        const double c = t->coefficient.value;
        if (c == 0) continue;
        s += s.empty() ? text(c) : text(c < 0 ? " - " : " + ", std::abs(c));
        s += monomial(t->x, t->y);
    }
    return s + " = 0";
}

class Equations {
public:
    Equations(json::Writer& w, std::string& lines, std::vector<std::vector<double>> at)
        : w_(w), lines_(lines), at_(std::move(at)) {}
    int written = 0;

    template <class P>
    requires(Space<P>::kDim == 2) Result<void> curve(const Curve<P>& c, const std::string& name,
                                                     std::size_t object) {
        const auto pieces = decompose(c);
        for (int i = 0; i < pieces.extent()[0]; ++i) {
            const auto piece = pieces.piece({i});
            const std::string place = text(name, pieces.extent()[0] > 1 ? text(", piece ", i) : "");
            const auto f = Implicit::make(piece);
            if (!f) return refuse_within(place, f.error());
            const auto terms = f->terms();
            if (!terms) return refuse_within(place, terms.error());
            write(*f, *terms, piece.domain()[0], place, object, i);
        }
        return {};
    }

private:
    void write(const Implicit& f, const std::vector<Implicit::Term>& terms, Interval on,
               const std::string& place, std::size_t object, int piece) {
        ++written;
        double bound = 0;
        for (const auto& t : terms) bound = std::max(bound, t.coefficient.bound);
        w_.new_line(1).begin_object().field("object", object).field("piece", piece);
        w_.key("domain").array(std::array{on.lo, on.hi});
        w_.field("degree", f.degree()).field("traces", f.traces()).field("bound", bound);
        w_.key("terms").begin_array();
        for (const auto& t : terms)
            w_.begin_object()
                .field("x", t.x)
                .field("y", t.y)
                .field("coefficient", t.coefficient.value)
                .field("bound", t.coefficient.bound)
                .end_object();
        w_.end_array();
        lines_ += text(place, ": degree ", f.degree());
        if (f.traces() > 1) lines_ += text(", traced ", f.traces(), " times");
        lines_ += text(", coefficients within ", bound, "\n  ", equation(terms), "\n");
        if (!at_.empty()) w_.key("signs").begin_array();
        for (const auto& p : at_) {
            const int sign = f.sign({{p[0], p[1]}});
            w_.value(sign);
            lines_ += text("  at ", p[0], ",", p[1], ": ",
                           sign < 0   ? "negative"
                           : sign > 0 ? "positive"
                                      : "zero",
                           "\n");
        }
        if (!at_.empty()) w_.end_array();
        w_.end_object();
    }

    json::Writer& w_;
    std::string& lines_;
    std::vector<std::vector<double>> at_;
};

Result<void> run_implicit(const Context& context, const ImplicitArguments& options) {
    auto at = parse_vectors("--at", options.at, 2);
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    json::Writer w;
    std::string lines;
    w.begin_object().key("results").begin_array();
    Equations equations(w, lines, std::move(at));
    for (const std::size_t i : input->chosen) {
        const std::string name = text(shown(options.file), ": ", object_label(*input->document, i));
        Result<void> done;
        with_curve(input->object(i).shape, [&](const auto& curve) {
            if constexpr (requires { equations.curve(curve, name, i); })
                done = equations.curve(curve, name, i);
        });
        if (!done) return done;
    }
    if (equations.written == 0)
        return refuse(RefusalKind::no_answer, shown(options.file),
                      "there is no plane curve (two coordinates)");
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : lines);
}

}  // namespace

void add_implicit(CommandLine& line) {
    const auto options = std::make_shared<ImplicitArguments>();
    const Command command = line.add("implicit", "The equation F(x, y) = 0 of plane curves",
                                     "  freiform implicit arc.json\n"
                                     "  freiform implicit curve.json --at '0,0;1.5,2' --json");
    command.file(options->file);
    command.word("--at", options->at, "Points; of each, the sign of F, exactly").shown_as("X,Y[;...]");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_implicit);
}

}  // namespace freiform::cli
