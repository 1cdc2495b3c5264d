// features: what happens along curves: inflections, cusps, extrema, vertices, self-intersections, crossings.
#include "input.hpp"

#include <freiform/io/bpt.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/query/features.hpp>
#include <freiform/query/self_intersection.hpp>

namespace freiform::cli {

namespace {

struct FeaturesArguments {
    std::string file, object;
    std::optional<double> accuracy;
    std::vector<double> line, plane;
};

// Something that happens at a point of a curve, in any dimension.
struct CurveFeature {
    std::string_view kind;
    Interval at;
    std::optional<Interval> second;  // of a self-intersection
    bool at_knot = false;
    std::optional<int> multiplicity;
    std::vector<double> point;
    double bound = 0;
};

template <int D>
CurveFeature place_of(const Feature<D>& f) {
    return {name_of(f.kind), f.at, {}, f.at_knot, {}, {f.point.c.begin(), f.point.c.end()}, f.bound};
}
template <int D>
CurveFeature place_of(const Crossing<D>& x) {
    return {name_of(x.kind), x.at, {}, false, x.most, {x.point.c.begin(), x.point.c.end()}, x.bound};
}
template <int D>
CurveFeature place_of(const SelfIntersection<D>& m) {
    return {name_of(m.kind), m.first, m.second, false, {}, {m.point.c.begin(), m.point.c.end()}, m.bound};
}

template <class T>
Result<std::vector<CurveFeature>> places(const Result<std::vector<T>>& found) {
    if (!found) return std::unexpected(found.error());
    std::vector<CurveFeature> out;
    for (const T& x : *found) out.push_back(place_of(x));
    return out;
}

// Lists of places under their names, as JSON and as text at the same time.
class Lists {
public:
    Lists(json::Writer& w, std::string& s) : w_(w), s_(s) {}

    Result<void> add(std::string_view name, const Result<std::vector<CurveFeature>>& list) {
        if (!list) {
            // One question that has no answer (a degree that is too high) leaves the others theirs.
            if (list.error().kind != RefusalKind::unsupported) return refuse_within(name, list.error());
            w_.key(name).null();
            s_ += text("  ", name, ": ", list.error().message, "\n");
            return {};
        }
        w_.key(name).begin_array();
        if (list->empty()) s_ += text("  ", name, ": none\n");
        for (const CurveFeature& x : *list) {
            w_.new_line(2).begin_object();
            s_ += text("  ", name, ": ");
            write(x);
            s_ += "\n";
            w_.end_object();
        }
        w_.end_array();
        return {};
    }
    json::Writer& json() { return w_; }

private:
    void write(const CurveFeature& x) {
        w_.field("kind", x.kind);
        s_ += text(x.kind, " ");
        interval(x.second ? "first" : "at", x.at);
        if (x.second) interval("second", *x.second);
        if (x.at_knot) w_.field("at_knot", true);
        if (x.multiplicity) w_.field("multiplicity", *x.multiplicity);
        w_.key("point").array(x.point).field("bound", x.bound);
        s_ += "point (";
        for (std::size_t i = 0; i < x.point.size(); ++i) s_ += text(i ? ", " : "", x.point[i]);
        s_ += text("), within ", x.bound);
    }
    void interval(std::string_view name, const Interval& at) {
        w_.key(name).array(std::array{at.lo, at.hi});
        s_ += at.lo == at.hi ? text("at ", at.lo, " ")
                             : text("at ", at.middle(), " (", at.lo, " to ", at.hi, ") ");
    }

    json::Writer& w_;
    std::string& s_;
};

template <class P>
Result<void> add_features(Lists& lists, const Curve<P>& c, double accuracy) {
    constexpr int D = Space<P>::kDim;
    Result<void> ok;
    if constexpr (D == 2 || D == 3) ok = lists.add("inflections", places(inflections(c, accuracy)));
    if constexpr (D >= 2)
        if (ok) ok = lists.add("cusps", places(cusps(c, accuracy)));
    for (int k = 0; k < D && ok; ++k) {
        Vec<D> d{};
        d[k] = 1;
        ok = lists.add(text("extrema_", "xyzw"[k]), places(extrema(c, d, accuracy)));
    }
    if constexpr (D == 2)
        if (ok) ok = lists.add("vertices", places(vertices(c, accuracy)));
    if constexpr (D == 2 || D == 3)
        if (ok) ok = lists.add("self_intersections", places(self_intersections(c, accuracy)));
    return ok;
}

template <class P>
Result<void> add_crossings(Lists& lists, const Curve<P>& c, const std::vector<double>& plane,
                           double accuracy) {
    Vec<Space<P>::kDim> normal{};
    std::copy_n(plane.begin(), normal.c.size(), normal.c.begin());
    return lists.add("crossings", places(crossings(c, normal, plane.back(), accuracy)));
}

Result<void> look_at(Lists& lists, const Shape& shape, const FeaturesArguments& options) {
    const ControlBox box = control_box(shape);
    const std::size_t dim = box.lo.size();
    if (type_name(shape) != "curve")
        return refuse(RefusalKind::no_answer, "", "is not a curve; features are asked of curves");
    if (!options.line.empty() && dim != 2)
        return refuse(RefusalKind::no_answer, "", text("has ", dim, " coordinates; --line needs 2"));
    if (!options.plane.empty() && dim != 3)
        return refuse(RefusalKind::no_answer, "", text("has ", dim, " coordinates; --plane needs 3"));
    const double accuracy = options.accuracy.value_or(box.diagonal > 0 ? 1e-9 * box.diagonal : 1e-9);
    lists.json().field("accuracy", accuracy);
    const std::vector<double>& plane = dim == 2 ? options.line : options.plane;
    Result<void> ok;
    with_curve(shape, [&](const auto& curve) {
        ok = plane.empty() ? add_features(lists, curve, accuracy)
                           : add_crossings(lists, curve, plane, accuracy);
    });
    return ok;
}

Result<void> run_features(const Context& context, const FeaturesArguments& options) {
    if (!options.line.empty() && options.line.size() != 3)
        wrong_usage("--line needs three numbers: A,B,C of A x + B y + C = 0");
    if (!options.plane.empty() && options.plane.size() != 4)
        wrong_usage("--plane needs four numbers: A,B,C,D of A x + B y + C z + D = 0");
    if (!options.line.empty()) require_direction("--line", std::span(options.line).first(2));
    if (!options.plane.empty()) require_direction("--plane", std::span(options.plane).first(3));
    if (!options.line.empty() && !options.plane.empty()) wrong_usage("--line or --plane, not both");
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const Document& document = *input->document;

    json::Writer w;
    std::string s;
    w.begin_object()
        .field("file", shown(options.file))
        .field("unit", document.unit)
        .key("objects")
        .begin_array();
    for (const std::size_t i : input->chosen) {
        const Object& o = document.objects[i];
        w.new_line(1).begin_object().field("index", i).field("name", o.name);
        s += text(object_label(document, i), ":\n");
        Lists lists(w, s);
        if (auto ok = look_at(lists, o.shape, options); !ok)
            return refuse_within(object_label(document, i), ok.error());
        w.end_object();
    }
    w.end_array().end_object();
    return emit(context, context.json ? w.take() + "\n" : s);
}

}  // namespace

void add_features(CommandLine& line) {
    const auto options = std::make_shared<FeaturesArguments>();
    const Command command = line.add(
        "features",
        "Inflections, cusps, extrema, vertices, self-intersections of curves; crossings with a line or plane",
        "  freiform features curve.json\n"
        "  freiform features curve.json --line 0,1,-2 --json      (crossings with y = 2)\n"
        "  freiform features space_curve.json --plane 0,0,1,0");
    command.file(options->file);
    command.numbers("--line", options->line, "Only the crossings with A x + B y + C = 0").shown_as("A,B,C");
    command.numbers("--plane", options->plane, "Only the crossings with A x + B y + C z + D = 0")
        .shown_as("A,B,C,D");
    command.positive("--accuracy", options->accuracy,
                     "How far a point may be from its place, in the unit of the file (1e-9 of the diagonal)");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_features);
}

}  // namespace freiform::cli
