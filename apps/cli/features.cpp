// features: what happens along curves: inflections, cusps, extrema, vertices, self-intersections, crossings.
#include "command.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/query/features.hpp>
#include <freiform/query/self_intersection.hpp>

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object;
    std::optional<double> accuracy;
    std::vector<double> line, plane;
};

// A list of places under one name, as JSON and as text at the same time.
class Lists {
public:
    Lists(json::Writer& w, std::string& s) : w_(w), s_(s) {}

    template <class List, class F>
    Result<void> add(std::string_view name, const Result<List>& list, F&& write) {
        if (!list) {
            // One question that has no answer (a degree that is too high) leaves the others theirs.
            if (list.error().kind != RefusalKind::unsupported) return refuse_within(name, list.error());
            w_.key(name).null();
            s_ += text("  ", name, ": ", list.error().message, "\n");
            return {};
        }
        w_.key(name).begin_array();
        if (list->empty()) s_ += text("  ", name, ": none\n");
        for (const auto& x : *list) {
            w_.new_line(2).begin_object();
            s_ += text("  ", name, ": ");
            write(x);
            s_ += "\n";
            w_.end_object();
        }
        w_.end_array();
        return {};
    }

    void word(std::string_view name, std::string_view value) {
        w_.field(name, value);
        s_ += text(value, " ");
    }
    void interval(std::string_view name, const Interval& at) {
        w_.key(name).array(std::array{at.lo, at.hi});
        s_ += at.lo == at.hi ? text("at ", at.lo, " ")
                             : text("at ", at.middle(), " (", at.lo, " to ", at.hi, ") ");
    }
    template <int D>
    void point(const Vec<D>& p, double bound) {
        w_.key("point").array(p.c).field("bound", bound);
        s_ += "point (";
        for (int i = 0; i < D; ++i) s_ += text(i ? ", " : "", p[i]);
        s_ += text("), within ", bound);
    }
    json::Writer& json() { return w_; }

private:
    json::Writer& w_;
    std::string& s_;
};

class Asking {
public:
    Asking(json::Writer& w, std::string& s, const Options& options) : lists_(w, s), options_(options) {}

    template <class S>
    Result<void> operator()(const S& s) {
        if constexpr (TensorPatch<S>) {
            if constexpr (S::kParams == 1) return curve(s);
        }
        return refuse(RefusalKind::no_answer, "", "is not a curve; features are asked of curves");
    }

private:
    template <class P>
    Result<void> curve(const Curve<P>& c) {
        constexpr int D = Space<P>::kDim;
        if (!options_.line.empty() && D != 2)
            return refuse(RefusalKind::no_answer, "", text("has ", D, " coordinates; --line needs 2"));
        if (!options_.plane.empty() && D != 3)
            return refuse(RefusalKind::no_answer, "", text("has ", D, " coordinates; --plane needs 3"));
        Box<D> box;
        for (const auto& p : points(c)) box.add(p);
        const double diagonal = box.diagonal();
        const double accuracy = options_.accuracy.value_or(diagonal > 0 ? 1e-9 * diagonal : 1e-9);
        lists_.json().field("accuracy", accuracy);
        if (const auto& plane = D == 2 ? options_.line : options_.plane; !plane.empty())
            return crossing(c, plane, accuracy);
        const auto feature = [&](const Feature<D>& f) {
            lists_.word("kind", name_of(f.kind));
            lists_.interval("at", f.at);
            if (f.at_knot) lists_.json().field("at_knot", true);
            lists_.point(f.point, f.bound);
        };
        Result<void> ok;
        if constexpr (D == 2 || D == 3) ok = lists_.add("inflections", inflections(c, accuracy), feature);
        if constexpr (D >= 2)
            if (ok) ok = lists_.add("cusps", cusps(c, accuracy), feature);
        for (int k = 0; k < D && ok; ++k) {
            Vec<D> d{};
            d[k] = 1;
            ok = lists_.add(text("extrema_", "xyzw"[k]), extrema(c, d, accuracy), feature);
        }
        if constexpr (D == 2)
            if (ok) ok = lists_.add("vertices", vertices(c, accuracy), feature);
        if constexpr (D == 2 || D == 3)
            if (ok)
                ok = lists_.add("self_intersections", self_intersections(c, accuracy),
                                [&](const SelfIntersection<D>& m) {
                                    lists_.word("kind", m.is_certain ? "crossing" : "possible");
                                    lists_.interval("first", m.first);
                                    lists_.interval("second", m.second);
                                    lists_.point(m.point, m.bound);
                                });
        return ok;
    }

    template <class P>
    Result<void> crossing(const Curve<P>& c, const std::vector<double>& plane, double accuracy) {
        constexpr int D = Space<P>::kDim;
        Vec<D> normal{};
        for (int k = 0; k < D; ++k) normal[k] = plane[std::size_t(k)];
        return lists_.add("crossings", crossings(c, normal, plane.back(), accuracy),
                          [&](const Crossing<D>& x) {
                              lists_.word("kind", name_of(x.kind));
                              lists_.interval("at", x.at);
                              lists_.json().field("multiplicity", x.most);
                              lists_.point(x.point, x.bound);
                          });
    }

    Lists lists_;
    const Options& options_;
};

Result<void> run(const Context& context, const Options& options) {
    if (options.accuracy && !(*options.accuracy > 0)) wrong_usage("--accuracy needs a length above 0");
    if (!options.line.empty() && options.line.size() != 3)
        wrong_usage("--line needs three numbers: A,B,C of A x + B y + C = 0");
    if (!options.plane.empty() && options.plane.size() != 4)
        wrong_usage("--plane needs four numbers: A,B,C,D of A x + B y + C z + D = 0");
    if (!options.line.empty() && !options.plane.empty()) wrong_usage("--line or --plane, not both");
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());

    json::Writer w;
    std::string s;
    w.begin_object()
        .field("file", shown(options.file))
        .field("unit", document->unit)
        .key("objects")
        .begin_array();
    for (const std::size_t i : *objects) {
        const Object& o = document->objects[i];
        w.new_line(1).begin_object().field("index", i).field("name", o.name);
        s += text(object_label(*document, i), ":\n");
        Asking ask(w, s, options);
        if (auto ok = std::visit(ask, o.shape); !ok)
            return refuse_within(object_label(*document, i), ok.error());
        w.end_object();
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : s);
}

}  // namespace

void add_features(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(
        app, context, "features",
        "Inflections, cusps, extrema, vertices, self-intersections of curves; crossings with a line or plane",
        "  freiform features curve.json\n"
        "  freiform features curve.json --line 0,1,-2 --json      (crossings with y = 2)\n"
        "  freiform features space_curve.json --plane 0,0,1,0");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    add_numbers(*command, "--line", options->line, "Only the crossings with A x + B y + C = 0")
        ->type_name("A,B,C");
    add_numbers(*command, "--plane", options->plane, "Only the crossings with A x + B y + C z + D = 0")
        ->type_name("A,B,C,D");
    add_number(*command, "--accuracy", options->accuracy,
               "How far a point may be from its place, in the unit of the file (1e-9 of the diagonal)");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    command->add_option("-o,--output", context.output, "Where the answer goes")->type_name("FILE");
    add_limits(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
