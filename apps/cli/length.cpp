// length: the arc length of curves, and the places at given lengths along them.
#include "command.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/query/reparametrise.hpp>

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object;
    std::vector<std::string> places;  // as they were given
    std::vector<double> at, range;
    std::optional<double> accuracy, spacing, reparametrise;
    std::optional<int> equal;
};

class Lengths {
public:
    Lengths(const Document& document, const Options& options) : document_(document), options_(options) {
        w_.begin_object().key("objects").begin_array();
    }

    template <class P>
    Result<void> add(std::size_t i, const Curve<P>& curve) {
        const ArcLength<P> s(curve, options_.accuracy.value_or(0));
        Measure m = s.total();
        if (!options_.range.empty()) {
            const auto part =
                length(curve, Interval{options_.range[0], options_.range[1]}, options_.accuracy.value_or(0));
            if (!part) return std::unexpected(part.error());
            m = *part;
        }
        total_.value += m.value;
        total_.bound += m.bound + 0x1p-53 * total_.value;
        w_.new_line(1).begin_object();
        if (document_.objects.size() > 1) w_.field("object", i);
        if (!document_.objects[i].name.empty()) w_.field("name", document_.objects[i].name);
        w_.field("value", m.value).field("bound", m.bound);
        line(text(object_label(document_, i), ": "), m);
        std::vector<double> wanted = options_.at;
        std::vector<PlaceAtLength> places;
        if (options_.equal) {
            const auto all = s.equal_parts(*options_.equal);
            if (!all) return std::unexpected(all.error());
            places = *all;
            for (int k = 0; k <= *options_.equal; ++k) wanted.push_back(m.value * k / *options_.equal);
        } else if (options_.spacing) {
            const auto all = s.spaced(*options_.spacing);
            if (!all) return std::unexpected(all.error());
            places = *all;
            for (std::size_t k = 0; k < places.size(); ++k)
                wanted.push_back(std::min(double(k) * *options_.spacing, m.value));
        } else {
            for (const double x : wanted) {
                const auto place = s.parameter(x);
                if (!place) return std::unexpected(place.error());
                places.push_back(*place);
            }
        }
        if (!places.empty()) write(curve, wanted, places);
        w_.end_object();
        return {};
    }
    std::string json() {
        w_.end_array().field("value", total_.value).field("bound", total_.bound);
        if (!document_.unit.empty()) w_.field("unit", document_.unit);
        w_.end_object();
        return w_.take() + "\n";
    }
    std::string text_for_people(std::size_t curves) {
        if (curves > 1) line("in all: ", total_);
        return std::move(text_);
    }

private:
    void line(std::string_view label, const Measure& m) {
        text_ += text(label, m.value, document_.unit.empty() ? "" : " ", document_.unit, " (within ", m.bound,
                      ")\n");
    }
    template <class P>
    void write(const Curve<P>& curve, const std::vector<double>& wanted,
               const std::vector<PlaceAtLength>& places) {
        w_.key("at").begin_array();
        for (std::size_t k = 0; k < places.size(); ++k) {
            const auto point = curve(places[k].parameter);
            w_.new_line(2).begin_object().field("length", wanted[k]);
            w_.field("parameter", places[k].parameter).field("bound", places[k].bound);
            w_.key("point").array(point.c).end_object();
            text_ += text("  ", wanted[k], ": parameter ", places[k].parameter, ", point");
            for (const double x : point.c) text_ += text(" ", x);
            text_ += "\n";
        }
        w_.end_array();
    }

    const Document& document_;
    const Options& options_;
    json::Writer w_;
    std::string text_;
    Measure total_;
};

// Calls f(index, curve) for the curves among the objects; what else there is is remarked on.
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
                remark(text(object_label(document, i), ": is a ", type_name(document.objects[i].shape),
                            ", not a curve, and left out"));
                return {};
            },
            document.objects[i].shape);
        if (!done)
            return refuse_within(document.objects.size() > 1 ? object_label(document, i) : shown(file),
                                 done.error());
    }
    if (curves == 0) return refuse(RefusalKind::no_answer, shown(file), "there is no curve to measure");
    return {};
}

// The curves by their arc length, as a document; the report goes to standard output if the document does not.
Result<void> reparametrise(const Context& context, const Options& options, const Document& document,
                           const std::vector<std::size_t>& objects) {
    Document out{document.unit, {}};
    json::Writer w;
    std::string report;
    w.begin_object().key("objects").begin_array();
    const auto done =
        each_curve(document, objects, options.file, [&](std::size_t i, const auto& c) -> Result<void> {
            auto even = by_arc_length(c, *options.reparametrise);
            if (!even) return std::unexpected(even.error());
            const std::size_t pieces = even->curve.basis().breaks().size() - 1;
            w.new_line(1).begin_object().field("object", i).field("length", even->length.value);
            w.field("pieces", pieces)
                .field("error_bound", even->bound)
                .field("speed_bound", even->speed_bound);
            w.end_object();
            report += text(object_label(document, i), ": ", pieces, " pieces, within ", even->bound,
                           ", speed within ", even->speed_bound, " of 1\n");
            out.objects.push_back({document.objects[i].name, std::move(even->curve), {}});
            return {};
        });
    if (!done) return done;
    w.end_array().end_object();
    if (auto ok = emit(context, write_document(out)); !ok) return ok;
    if (context.output.empty() || context.output == "-") return {};
    return emit({}, context.json ? w.take() + "\n" : report);
}

// `--at 1 2,3 FILE`: a list that takes all words up to the next option.
void understand_places(Options& options) {
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

Result<void> run(const Context& context, const Options& given) {
    Options options = given;
    understand_places(options);
    if (!options.range.empty() && options.range.size() != 2)
        wrong_usage("--range needs two parameters, such as 0.25,0.75");
    if (int(!options.at.empty()) + options.equal.has_value() + options.spacing.has_value() +
            options.reparametrise.has_value() >
        1)
        wrong_usage("only one of --at, --equal, --spacing and --reparametrise");
    if (options.reparametrise && !(*options.reparametrise > 0))
        wrong_usage(text("--reparametrise needs a positive distance, found ", *options.reparametrise));
    if (options.accuracy && !(*options.accuracy >= 0))
        wrong_usage(text("--accuracy must not be negative, found ", *options.accuracy));
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    if (options.reparametrise) return reparametrise(context, options, *document, *objects);
    Lengths lengths(*document, options);
    std::size_t curves = 0;
    const auto done = each_curve(*document, *objects, options.file, [&](std::size_t i, const auto& curve) {
        ++curves;
        return lengths.add(i, curve);
    });
    if (!done) return done;
    return emit(context, context.json ? lengths.json() : lengths.text_for_people(curves));
}

}  // namespace

void add_length(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(app, context, "length", "Arc length, and places at lengths along a curve",
                                    "  freiform length curves.json\n"
                                    "  freiform length curve.json --at 0.5,1,2.5\n"
                                    "  freiform length curve.json --equal 10 --json\n"
                                    "  freiform length curve.json --reparametrise 1e-6 -o even.json");
    command->add_option("FILE", options->file, "The file; - is standard input");
    command
        ->add_option("--at", options->places,
                     "Lengths from the start of the curve: prints the parameters and points there")
        ->type_name("S...");
    add_count(*command, "--equal", options->equal, 1, 1'000'000,
              "The ends of this many parts of equal length");
    add_number(*command, "--spacing", options->spacing, "Places at this distance along the curve");
    add_numbers(*command, "--range", options->range, "Only the part between these two parameters");
    add_number(*command, "--accuracy", options->accuracy,
               "What the length may be off (default 0: as little as rounding allows)");
    add_number(*command, "--reparametrise", options->reparametrise,
               "Writes the curves as splines over their arc length, within this distance, as a document");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_option("-o,--output", context.output, "Where the answer goes")->type_name("FILE");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
