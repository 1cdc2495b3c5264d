// convert: from any format to any that can hold it, with changes on the way that leave the shape as it is
// (or, with
// --reduce, within a bound).
#include "command.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/spline/bezier.hpp>
#include <freiform/spline/refine.hpp>

namespace freiform::cli {

namespace {

constexpr std::string_view kAxisNames = "uvw";

struct Options {
    std::string file, object, axis;
    bool to_bezier = false, reverse = false;
    std::optional<int> elevate;
    std::optional<double> split, reduce;
    std::vector<double> knots;

    bool changes() const { return to_bezier || reverse || elevate || split || reduce || !knots.empty(); }
};

// One patch becomes one or more; `suffix` tells them apart.
struct Piece {
    std::string suffix;
    Shape shape;
    double bound = 0;  // of the distance to what it was
    int removed = 0;   // knots
};
using Pieces = std::vector<Piece>;

template <std::size_t N, class P>
class Changes {
public:
    Changes(const Options& options, Patch<N, P> patch) : o_(options) {
        parts_.push_back({"", std::move(patch)});
    }

    Result<Pieces> run() {
        if (!o_.axis.empty() && axis_or(0) >= N)
            return refuse(
                RefusalKind::no_answer, "--axis",
                text("the object has ", N, N == 1 ? " parameter" : " parameters", ", no ", o_.axis));
        if (!o_.knots.empty())
            if (auto ok = each("--insert-knots", [&](auto& s) { return insert(s); }); !ok)
                return std::unexpected(ok.error());
        if (o_.elevate)
            if (auto ok = each("--elevate", [&](auto& s) { return elevate_all(s); }); !ok)
                return std::unexpected(ok.error());
        if (o_.reduce)
            if (auto ok = reduce(); !ok) return std::unexpected(ok.error());
        if (o_.split)
            if (auto ok = split(); !ok) return std::unexpected(ok.error());
        if (o_.reverse)
            for (auto& part : parts_) part.patch = reverse(part.patch, int(axis_or(0)));
        if (o_.to_bezier) to_bezier();
        Pieces out;
        for (auto& part : parts_)
            out.push_back({std::move(part.suffix), std::move(part.patch), bound_, removed_});
        return out;
    }

private:
    struct Part {
        std::string suffix;
        Patch<N, P> patch;
    };

    std::size_t axis_or(std::size_t otherwise) const {
        return o_.axis.empty() ? otherwise : kAxisNames.find(o_.axis[0]);
    }

    // The library calls wrong numbers invalid; here they are questions without an answer.
    static std::unexpected<Refusal> about(std::string_view option, Refusal r) {
        if (r.kind == RefusalKind::invalid || r.kind == RefusalKind::unsupported)
            r.kind = RefusalKind::no_answer;
        return refuse_within(option, std::move(r));
    }

    template <class F>
    Result<void> each(std::string_view option, F&& change) {
        for (auto& part : parts_) {
            auto changed = change(part.patch);
            if (!changed) return about(option, changed.error());
            part.patch = std::move(*changed);
        }
        return {};
    }

    Result<Patch<N, P>> insert(const Patch<N, P>& s) const {
        std::vector<double> sorted = o_.knots;
        std::sort(sorted.begin(), sorted.end());
        return insert_knots(s, int(axis_or(0)), sorted);
    }

    Result<Patch<N, P>> elevate_all(const Patch<N, P>& s) const {
        Result<Patch<N, P>> out = s;
        for (std::size_t d = 0; d < N && out; ++d)
            if (o_.axis.empty() || axis_or(0) == d) out = elevate(*out, int(d), *o_.elevate);
        return out;
    }

    // Each axis may use what the ones before have left of the tolerance, so that the sum stays within it.
    Result<void> reduce() {
        for (std::size_t d = 0; d < N; ++d) {
            if (!o_.axis.empty() && axis_or(0) != d) continue;
            auto thin = remove_knots(parts_[0].patch, int(d), std::max(*o_.reduce - bound_, 0.0));
            if (!thin) return about("--reduce", thin.error());
            parts_[0].patch = std::move(thin->patch);
            bound_ = thin->bound == 0 ? bound_ : std::nextafter(bound_ + thin->bound, 1e308);
            removed_ += thin->removed;
        }
        return {};
    }

    Result<void> split() {
        std::vector<Part> halves;
        const int axis = int(axis_or(0));
        for (const auto& part : parts_) {
            const Interval on = part.patch.basis(axis).domain();
            if (!(on.lo < *o_.split && *o_.split < on.hi))
                return refuse(RefusalKind::out_of_domain, "--split",
                              text(*o_.split, " is not inside the domain [", on.lo, ", ", on.hi, "]"));
            int k = 0;
            for (const Interval half : {Interval{on.lo, *o_.split}, Interval{*o_.split, on.hi}}) {
                auto s = restrict_to(part.patch, axis, half);
                if (!s) return about("--split", s.error());
                halves.push_back({text(part.suffix, k++ == 0 ? ".a" : ".b"), std::move(*s)});
            }
        }
        parts_ = std::move(halves);
        return {};
    }

    void to_bezier() {
        std::vector<Part> all;
        for (const auto& part : parts_) {
            const auto pieces = decompose(part.patch);
            const bool one = count_of(pieces.extent()) == 1;
            each_index(pieces.extent(), [&](const Index<N>& at) {
                const auto piece = pieces.piece(at);
                auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
                    return std::array<BSplineBasis, N>{
                        *BSplineBasis::bezier(piece.basis(int(I)).degree(), piece.basis(int(I)).domain())...};
                }
                (std::make_index_sequence<N>{});
                std::string suffix = part.suffix;
                if (!one)
                    for (const int i : at) suffix += text(".", i);
                all.push_back({std::move(suffix), Patch<N, P>::trusted(std::move(bases), piece.net())});
            });
        }
        parts_ = std::move(all);
    }

    const Options& o_;
    std::vector<Part> parts_;
    double bound_ = 0;
    int removed_ = 0;
};

// Of the changes, a triangle knows elevation, and a Bezier patch it is.
template <class P>
Result<Pieces> changed_triangle(const Triangle<P>& s, const Options& o) {
    if (o.reverse || o.split || o.reduce || !o.knots.empty() || !o.axis.empty())
        return refuse(RefusalKind::no_answer, "", "is a triangle; of the changes it knows --elevate only");
    Result<Triangle<P>> out = s;
    for (int i = 0; i < o.elevate.value_or(0) && out; ++i) out = elevate(*out);
    if (!out) return refuse(RefusalKind::no_answer, "--elevate", out.error().message);
    return Pieces{{"", std::move(*out)}};
}

Result<Pieces> changed(const Shape& shape, const Options& options) {
    return std::visit(
        [&](const auto& s) -> Result<Pieces> {
            using S = std::remove_cvref_t<decltype(s)>;
            if constexpr (TensorPatch<S>)
                return Changes<S::kParams, typename S::Coefficients>(options, s).run();
            else if constexpr (TriangularPatch<S>)
                return changed_triangle(s, options);
            else
                return refuse(RefusalKind::no_answer, "",
                              text("is a ", type_name(shape),
                                   "; the options that change a shape are for curves, surfaces and volumes"));
        },
        shape);
}

struct Reduction {
    double bound = 0;  // the largest of all objects
    int removed = 0;
};

Result<Document> changed(const Document& document, const Options& options, Reduction& reduction) {
    const auto objects = selected(document, options.object);
    if (!objects) return std::unexpected(objects.error());
    Document out;
    out.unit = document.unit;
    for (const std::size_t i : *objects) {
        const Object& o = document.objects[i];
        if (!options.changes()) {
            out.objects.push_back(o);
            continue;
        }
        auto pieces = changed(o.shape, options);
        if (!pieces) {
            Refusal r = pieces.error();
            r.where = text(object_label(document, i), r.where.empty() ? "" : ": ", r.where);
            return std::unexpected(std::move(r));
        }
        if (!pieces->empty()) {
            reduction.bound = std::max(reduction.bound, pieces->front().bound);
            reduction.removed += pieces->front().removed;
        }
        for (Piece& p : *pieces) {
            const std::string name =
                p.suffix.empty() || !o.name.empty() ? o.name + p.suffix : text(i, p.suffix);
            out.objects.push_back({name, std::move(p.shape), {}});
        }
    }
    return out;
}

std::string output_format(const Context& context) {
    if (!context.to.empty()) return context.to;
    const std::size_t dot = context.output.rfind('.'), slash = context.output.rfind('/');
    if (context.output.empty() || context.output == "-") return "json";
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "json";
    std::string ending = context.output.substr(dot + 1);
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    return ending;
}

Result<void> run(const Context& context, const Options& options) {
    if (options.reduce && !(*options.reduce >= 0))
        wrong_usage("--reduce needs a distance that is not negative");
    const std::string format = output_format(context);
    if (format != "json" && format != "bpt")
        wrong_usage(text("convert writes .json and .bpt, not \"", format, "\"",
                         format == "stl" || format == "obj" || format == "ply" || format == "glb"
                             ? "; freiform tessellate writes triangles"
                             : ""));
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    Reduction reduction;
    const auto out = changed(*document, options, reduction);
    if (!out) {
        Refusal r = out.error();
        if (r.where.starts_with("objects[")) r.where = text(shown(options.file), ": ", r.where);
        return std::unexpected(std::move(r));
    }
    const auto bytes = format == "json" ? Result<std::string>(write_document(*out)) : write_bpt(*out);
    if (!bytes) {
        Refusal r = bytes.error();
        r.where = text(shown(options.file), ": ", r.where);
        return std::unexpected(std::move(r));
    }
    if (auto ok = emit(context, *bytes); !ok) return ok;
    if (options.reduce && !context.json)
        remark(text(reduction.removed, " knots removed, no point moved by more than ", reduction.bound));
    if (!context.json || context.output.empty() || context.output == "-") return {};
    json::Writer w;
    w.begin_object()
        .field("output", context.output)
        .field("format", format)
        .field("objects", out->objects.size());
    if (options.reduce) w.field("removed_knots", reduction.removed).field("bound", reduction.bound);
    w.end_object();
    return emit({}, w.take() + "\n");
}

}  // namespace

void add_convert(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        add_command(app, context, "convert",
                    "Read any known format, write any that can hold it, change splines on the way",
                    "  freiform convert teapot.bpt -o teapot.json\n"
                    "  freiform convert curve.json --elevate 1 --insert-knots 0.25,0.5 -o finer.json\n"
                    "  freiform convert surface.json --to-bezier -o patches.bpt\n"
                    "  freiform convert surface.json --split 0.5 --axis v -o halves.json\n"
                    "Changes are made in this order: --insert-knots, --elevate, --reduce, --split, "
                    "--reverse, --to-bezier.\n"
                    "--elevate and --reduce change all directions, --insert-knots, --split and --reverse the "
                    "first, unless\n"
                    "--axis says which.");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    add_output(*command, context, "The file to write: .json or .bpt");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_flag("--to-bezier", options->to_bezier,
                      "Cut splines into their Bezier pieces, an object for each");
    add_count(*command, "--elevate", options->elevate, 0, kMaxDegree,
              "Raise the degree by N; the shape stays");
    add_numbers(*command, "--insert-knots", options->knots, "Insert knots; the shape stays");
    add_number(*command, "--reduce", options->reduce,
               "Remove knots as long as no point moves by more than this; the bound reached is printed");
    add_number(*command, "--split", options->split, "Cut at a parameter, an object for each side");
    command->add_flag("--reverse", options->reverse, "Run through the parameter backwards");
    command->add_option("--axis", options->axis, "Which parameter the changes are for")
        ->check(CLI::IsMember({"u", "v", "w"}));
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
