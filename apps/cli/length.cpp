// length: the arc length of curves and of the edges of models, and the places at given lengths along curves.
#include "input.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/model/edge_length.hpp>
#include <freiform/query/reparametrise.hpp>

#include <cmath>

namespace freiform::cli {

namespace {

struct LengthArguments {
    std::string file, object;
    std::vector<std::string> places;  // as they were given
    std::vector<double> at, range;
    std::optional<double> accuracy, spacing, reparametrise;
    std::optional<int> equal;
};

// What was measured of one curve.
struct Measured {
    Measure length;
    std::vector<double> wanted;
    std::vector<PlaceAtLength> places;  // at the lengths that were wanted
    std::vector<double> points;         // all coordinates of the first, then of the next, ..
};

template <class P>
Result<Measured> measured(const Curve<P>& curve, const LengthArguments& o) {
    const double accuracy = o.accuracy.value_or(0);
    const ArcLength<P> s(curve, o.range.empty() ? accuracy : accuracy / 2);
    const Interval on = o.range.empty() ? s.domain() : Interval{o.range[0], o.range[1]};
    const auto length = s.total(on);
    if (!length) return std::unexpected(length.error());
    Measured out{*length, {}, {}, {}};
    const auto add = [&](double wanted, const PlaceAtLength& place) {
        out.wanted.push_back(wanted), out.places.push_back(place);
        const auto point = curve(place.parameter);
        out.points.insert(out.points.end(), point.c.begin(), point.c.end());
    };
    if (!o.equal && !o.spacing) {
        for (const double x : o.at) {
            const auto place = s.parameter(x, on);
            if (!place) return std::unexpected(place.error());
            add(x, *place);
        }
        return out;
    }
    const auto all = o.equal ? s.equal_parts(*o.equal, on) : s.spaced(*o.spacing, on);
    if (!all) return std::unexpected(all.error());
    for (std::size_t k = 0; k < all->size(); ++k)
        add(o.equal ? out.length.value * double(k) / *o.equal
                    : std::min(double(k) * *o.spacing, out.length.value),
            (*all)[k]);
    return out;
}

class Lengths {
public:
    explicit Lengths(const Document& document) : document_(document) {
        w_.begin_object().key("objects").begin_array();
    }

    void add(std::size_t i, const Measured& m) {
        ++curves_;
        total_.value += m.length.value;
        total_.bound += m.length.bound + 0x1p-53 * total_.value;
        w_.new_line(1).begin_object();
        if (document_.objects.size() > 1) w_.field("object", i);
        if (!document_.objects[i].name.empty()) w_.field("name", document_.objects[i].name);
        w_.field("value", m.length.value).field("bound", m.length.bound);
        line(text(object_label(document_, i), ": "), m.length);
        if (!m.places.empty()) write(m);
        w_.end_object();
    }
    // Of every edge that is not a pole.
    void add(std::size_t i, const Model& model, const std::vector<Measure>& edges) {
        ++curves_;
        Measure sum;
        std::string lines;
        w_.new_line(1).begin_object().field("object", i).field("name", document_.objects[i].name);
        w_.field("type", type_name(document_.objects[i].shape)).key("edges").begin_array();
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const Edge& edge = model.edges[e];
            if (edge.degenerate) continue;
            const std::string_view kind = edge.curve ? kind_name(*edge.curve) : "on face";
            w_.new_line(2).begin_object().field("edge", e);
            if (!edge.name.empty()) w_.field("name", edge.name);
            w_.field("kind", kind).field("value", edges[e].value).field("bound", edges[e].bound).end_object();
            lines += text("  edge ", e, " (", kind, "): ", measure_text(edges[e]), "\n");
            sum.value += edges[e].value;
            sum.bound += edges[e].bound + 0x1p-53 * sum.value;
        }
        w_.end_array().field("value", sum.value).field("bound", sum.bound).end_object();
        total_.value += sum.value;
        total_.bound += sum.bound + 0x1p-53 * total_.value;
        line(text(object_label(document_, i), ", all edges: "), sum);
        text_ += lines;
    }
    std::string json() {
        w_.end_array().field("value", total_.value).field("bound", total_.bound);
        if (!document_.unit.empty()) w_.field("unit", document_.unit);
        w_.end_object();
        return w_.take() + "\n";
    }
    std::string text_for_people() {
        if (curves_ > 1) line("in all: ", total_);
        return std::move(text_);
    }

private:
    void line(std::string_view label, const Measure& m) { text_ += text(label, measure_text(m), "\n"); }
    std::string measure_text(const Measure& m) const {
        return text(m.value, document_.unit.empty() ? "" : " ", document_.unit,
                    std::isfinite(m.bound) ? text(" (within ", m.bound, ")") : " (without a bound)");
    }
    void write(const Measured& m) {
        w_.key("at").begin_array();
        const std::size_t dim = m.points.size() / m.places.size();
        for (std::size_t k = 0; k < m.places.size(); ++k) {
            const std::span<const double> point = std::span(m.points).subspan(k * dim, dim);
            const PlaceAtLength& place = m.places[k];
            w_.new_line(2).begin_object().field("length", m.wanted[k]);
            w_.field("parameter", place.parameter).field("bound", place.bound);
            w_.key("point").array(point).end_object();
            text_ += text("  ", m.wanted[k], ": parameter ", place.parameter, ", point");
            for (const double x : point) text_ += text(" ", x);
            text_ += "\n";
        }
        w_.end_array();
    }

    const Document& document_;
    json::Writer w_;
    std::string text_;
    Measure total_;
    std::size_t curves_ = 0;
};

// The curves by their arc length, as a document; the report goes to standard output if the document does not.
Result<void> reparametrise(const Context& context, const LengthArguments& options, const Input& input) {
    const Document& document = *input.document;
    Document out{document.unit, {}};
    json::Writer w;
    std::string lines;
    w.begin_object().key("objects").begin_array();
    const auto report = [&](std::size_t i, const BSplineBasis& basis, const Measure& length, double bound,
                            double speed_bound) {
        const std::size_t pieces = basis.breaks().size() - 1;
        w.new_line(1).begin_object().field("object", i).field("length", length.value);
        w.field("pieces", pieces).field("error_bound", bound).field("speed_bound", speed_bound).end_object();
        lines += text(object_label(document, i), ": ", pieces, " pieces, within ", bound, ", speed within ",
                      speed_bound, " of 1\n");
    };
    const auto done = each_curve(input, "measure", [&](std::size_t i, const auto& c) -> Result<void> {
        auto even = by_arc_length(c, *options.reparametrise);
        if (!even) return std::unexpected(even.error());
        report(i, even->curve.basis(), even->length, even->bound, even->speed_bound);
        out.objects.push_back({document.objects[i].name, std::move(even->curve), {}});
        return {};
    });
    if (!done) return done;
    w.end_array().end_object();
    if (auto ok = emit(context, write_document(out)); !ok) return ok;
    if (context.output.empty() || context.output == "-") return {};
    return emit({}, context.json ? w.take() + "\n" : lines);
}

// `--at 1 2,3 FILE`: a list that takes all words up to the next option.
void understand_places(LengthArguments& options) {
    if (options.file.empty() && options.places.size() > 1) {
        options.file = options.places.back();
        options.places.pop_back();
    }
    if (options.file.empty()) wrong_usage("FILE is required");
    for (const std::string& word : options.places) {
        std::string_view rest = word;
        do {
            const std::string_view part = trimmed(next_part(rest, ','));
            const auto x = scan_number<double>(part);
            if (!x) wrong_usage(text("--at needs lengths, found \"", part, "\""));
            options.at.push_back(*x);
        } while (!rest.empty());
    }
}

Result<void> run_length(const Context& context, const LengthArguments& given) {
    LengthArguments options = given;
    understand_places(options);
    if (!options.range.empty() && options.range.size() != 2)
        wrong_usage("--range needs two parameters, such as 0.25,0.75");
    if (!options.range.empty() && options.range[0] > options.range[1])
        wrong_usage("--range needs the smaller parameter first");
    if (int(!options.at.empty()) + options.equal.has_value() + options.spacing.has_value() +
            options.reparametrise.has_value() >
        1)
        wrong_usage("only one of --at, --equal, --spacing and --reparametrise");
    if (options.accuracy && !(*options.accuracy >= 0))
        wrong_usage(text("--accuracy must not be negative, found ", *options.accuracy));
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    if (options.reparametrise) return reparametrise(context, options, *input);
    Lengths lengths(*input->document);
    const auto of_curve = [&](std::size_t i, const auto& curve) -> Result<void> {
        const auto m = measured(curve, options);
        if (!m) return std::unexpected(m.error());
        if (!std::isfinite(m->length.value))
            return refuse(RefusalKind::no_answer, "length", "leaves the range of double");
        lengths.add(i, *m);
        return {};
    };
    const bool places = !options.at.empty() || options.equal || options.spacing || !options.range.empty();
    const auto of_model = [&](std::size_t i, const Model& model) -> Result<void> {
        if (places)
            return refuse(
                RefusalKind::no_answer, "",
                "is a model, which has the lengths of its edges; --at, --equal, --spacing and --range "
                "are for curves");
        const auto all = edge_lengths(model, options.accuracy.value_or(0));
        if (!all) return std::unexpected(all.error());
        lengths.add(i, model, *all);
        return {};
    };
    const auto done = each_curve(*input, "measure", of_curve, of_model);
    if (!done) return done;
    return emit(context, context.json ? lengths.json() : lengths.text_for_people());
}

}  // namespace

void add_length(CommandLine& line) {
    const auto options = std::make_shared<LengthArguments>();
    const Command command = line.add("length", "Arc length of curves and edges, and places along a curve",
                                     "  freiform length curves.json\n"
                                     "  freiform length part.step --json\n"
                                     "  freiform length curve.json --at 0.5,1,2.5\n"
                                     "  freiform length curve.json --equal 10 --json\n"
                                     "  freiform length curve.json --reparametrise 1e-6 -o even.json");
    command.word("FILE", options->file, "The file; - is standard input");
    command
        .words("--at", options->places,
               "Lengths from the start of the curve, or of its part: prints the parameters and points there")
        .shown_as("S...");
    command.count("--equal", options->equal, 1, 1'000'000, "The ends of this many parts of equal length");
    command.positive("--spacing", options->spacing, "Places at this distance along the curve");
    command.numbers("--range", options->range,
                    "Only the part between these two parameters: its length, and places on it");
    command.number("--accuracy", options->accuracy,
                   "What the length may be off (default 0: as little as rounding allows)");
    command.positive(
        "--reparametrise", options->reparametrise,
        "Writes the curves as splines over their arc length, within this distance, as a document");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_length);
}

}  // namespace freiform::cli
