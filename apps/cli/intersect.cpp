// intersect: where the curves and surfaces of two files meet.
#include "model_contacts.hpp"
#include "surface_meetings.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/intersect/curve_curve.hpp>
#include <freiform/intersect/curve_surface.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/scene.hpp>

#include <algorithm>
#include <variant>

namespace freiform::cli {

namespace {

struct IntersectArguments {
    std::string a, b, object_a, object_b, curves, rays, lines;
    std::optional<double> tolerance;
};

// What can be met, of one kind of coefficients for each number of coordinates. Models: solid ones and trimmed
// surfaces.
using Operand = std::variant<Curve<Hom<2>>, Curve<Hom<3>>, Surface<Hom<3>>, Curve<Vec<2>>, Curve<Vec<3>>,
                             Surface<Vec<3>>, Model>;

struct Chosen {
    std::size_t index;
    Operand shape;
};

class Meeting {
public:
    Meeting(const Input& a, const Input& b, std::optional<double> tolerance)
        : a_(a), b_(b), given_(tolerance), tolerance_(tolerance.value_or(0)) {}

    Result<void> meet(const Chosen& a, const Chosen& b) {
        at_ = {a.index, b.index};
        if (std::holds_alternative<Model>(a.shape) || std::holds_alternative<Model>(b.shape))
            return meet_models(a, b);
        return std::visit([&](const auto& x, const auto& y) { return meet_shapes(x, y); }, a.shape, b.shape);
    }
    Result<void> meet_lines(std::span<const StraightLine> lines) {
        return cli::meet_lines(a_, lines, tolerance_, on_models_);
    }
    std::vector<std::string> undecided() const {
        std::vector<std::string> all = undecided_;
        all.insert(all.end(), on_models_.undecided().begin(), on_models_.undecided().end());
        return all;
    }
    std::string json() const {
        json::Writer w;
        w.begin_object();
        for (const auto& [key, rows, more] : {std::tuple("points", &points_, &on_models_.points()),
                                              {"overlaps", &overlaps_, &on_models_.overlaps()},
                                              {"possible", &possible_, &on_models_.possible()}}) {
            w.key(key).begin_array();
            for (const auto& row : *rows) row(w);
            for (const auto& row : *more) row(w);
            w.end_array();
        }
        surfaces_.write(w);
        return w.end_object().take() + "\n";
    }
    std::string plain() const {
        const std::string all = plain_ + on_models_.plain() + surfaces_.plain();
        return all.empty() ? "no intersection\n" : all;
    }
    Document curves() const {
        Document out = surfaces_.curves();
        out.unit = a_.document->unit;
        return out;
    }

private:
    using Row = std::function<void(json::Writer&)>;

    template <class X, class Y>
    Result<void> meet_shapes(const X& x, const Y& y) {
        if constexpr (std::same_as<X, Model> || std::same_as<Y, Model>)
            return {};  // never: meet_models
        else
            return meet_splines(x, y);
    }
    // The curve of space of an operand, if it is one.
    static std::optional<Curve<Hom<3>>> curve_of(const Operand& shape) {
        if (const auto* c = std::get_if<Curve<Vec<3>>>(&shape)) return to_rational(*c);
        if (const auto* c = std::get_if<Curve<Hom<3>>>(&shape)) return *c;
        return std::nullopt;
    }
    // A surface is a model of one face.
    Result<void> meet_models(const Chosen& a, const Chosen& b) {
        const auto on_a = curve_of(a.shape), on_b = curve_of(b.shape);
        if (on_a || on_b) {
            const Model& model = std::get<Model>((on_a ? b : a).shape);
            const auto found = IntersectModel(model).intersect(on_a ? *on_a : *on_b, options());
            if (!found) return refuse_within(where(), found.error());
            on_models_.add(*found, at_, {}, !on_a, tolerance_, where());
            return {};
        }
        const auto model_of = [](const Input& input, const Chosen& c) -> Result<Model> {
            if (const auto* m = std::get_if<Model>(&c.shape)) return *m;
            if (std::holds_alternative<Surface<Vec<3>>>(c.shape) ||
                std::holds_alternative<Surface<Hom<3>>>(c.shape))
                return scene_of(*input.document, std::span(&c.index, 1));
            return refuse(RefusalKind::unsupported, input.label(c.index),
                          "is a curve of the plane: models meet curves of space, surfaces and models");
        };
        const auto x = model_of(a_, a), y = model_of(b_, b);
        if (!x) return std::unexpected(x.error());
        if (!y) return std::unexpected(y.error());
        const double tolerance = given_.value_or(1e-6 * summary(*x).box.diagonal());
        const auto found = intersect(*x, *y, SurfaceIntersectOptions{.tolerance = tolerance});
        if (!found) return refuse_within(where(), found.error());
        surfaces_.add(*found, at_, where());
        for (const OpenFaces& open : found->open) {
            const std::string faces = text(where(), ", faces ", open.faces[0], " and ", open.faces[1]);
            if (open.reason) remark(text(faces, ": nothing is known: ", open.reason->message));
            for (const auto& box : open.boxes) undecided_.push_back(text(faces, ": ", shown_box(box)));
        }
        return {};
    }
    template <class X, class Y>
    Result<void> meet_splines(const X& x, const Y& y) {
        constexpr int D = Space<typename X::Coefficients>::kDim;
        if constexpr (D != Space<typename Y::Coefficients>::kDim)
            return refuse(RefusalKind::no_answer, where(),
                          "one has 2 coordinates, the other 3; --object-a and --object-b choose");
        else if constexpr (X::kParams == 2 && Y::kParams == 2)
            return meet_surfaces(x, y);
        else if constexpr (!std::same_as<typename X::Coefficients, typename Y::Coefficients>)
            return meet_splines(rational(x), rational(y));
        else if constexpr (X::kParams == 2)
            return take(intersect(y, x, options()),
                        [](const auto& at) { return std::pair(rest(at), first(at)); });
        else if constexpr (Y::kParams == 2)
            return take(intersect(x, y, options()),
                        [](const auto& at) { return std::pair(first(at), rest(at)); });
        else
            return take(intersect(x, y, options()),
                        [](const auto& at) { return std::pair(first(at), rest(at)); });
    }
    template <class P, class Q>
    Result<void> meet_surfaces(const Surface<P>& x, const Surface<Q>& y) {
        Box<3> box;
        for (const Vec<3>& p : points(x)) box.add(p);
        const double tolerance = given_.value_or(1e-6 * box.diagonal());
        const auto found = intersect(x, y, SurfaceIntersectOptions{.tolerance = tolerance});
        if (!found) return refuse_within(where(), found.error());
        surfaces_.add(*found, at_, where());
        for (const auto& open : found->undecided) undecided_.push_back(text(where(), ": ", shown_box(open)));
        return {};
    }
    template <std::size_t N>
    static std::string shown_box(const std::array<Interval, N>& box) {
        std::string s;
        for (const Interval& t : box) s += text(s.empty() ? "[" : " x [", t.lo, ", ", t.hi, "]");
        return s;
    }
    template <std::size_t N, int D>
    static Patch<N, Hom<D>> rational(const Patch<N, Vec<D>>& p) {
        return to_rational(p);
    }
    template <std::size_t N, int D>
    static const Patch<N, Hom<D>>& rational(const Patch<N, Hom<D>>& p) {
        return p;
    }
    template <class T, std::size_t N>
    static std::vector<T> first(const std::array<T, N>& at) {
        return {at[0]};
    }
    template <class T, std::size_t N>
    static std::vector<T> rest(const std::array<T, N>& at) {
        return {at.begin() + 1, at.end()};
    }
    IntersectOptions options() const { return {.accuracy = tolerance_}; }
    std::string where() const { return text(a_.label(at_[0]), " with ", b_.label(at_[1])); }

    // `split` divides parameters of the answer into those of a and of b.
    template <class R, class F>
    Result<void> take(const R& found, F&& split) {
        if (!found) return refuse_within(where(), found.error());
        const auto object = at_;
        for (const auto& c : found->contacts) {
            const auto [s, t] = split(c.at);
            const auto [bs, bt] = split(c.box);
            const bool open = c.kind == ContactKind::possible && !(c.gap <= tolerance_);
            (open ? possible_ : points_)
                .push_back([=, a = s, b = t, box_a = bs, box_b = bt](json::Writer& w) {
                    w.new_line(1)
                        .begin_object()
                        .key("objects")
                        .array(object)
                        .key("a")
                        .array(a)
                        .key("b")
                        .array(b);
                    w.key("point")
                        .array(c.point.c)
                        .field("kind", name_of(c.kind))
                        .field("proven", c.is_proven());
                    w.field("least", c.least).field("most", c.most).field("multiplicity", c.multiplicity);
                    w.field("gap", c.gap);
                    write_box(w.key("a_box"), box_a);
                    write_box(w.key("b_box"), box_b);
                    w.end_object();
                });
            plain_ +=
                text(where(), ": ", name_of(c.kind), " at ", list(s), " and ", list(t), ", point ",
                     list(c.point.c),
                     c.is_proven() ? "" : text(", ", c.least, " to ", c.most, " times, gap at most ", c.gap),
                     "\n");
        }
        for (const Overlap& o : found->overlaps) {
            overlaps_.push_back([=](json::Writer& w) {
                w.new_line(1).begin_object().key("objects").array(object);
                w.key("a").array(std::array{o.a.lo, o.a.hi}).key("b").array(std::array{o.b.lo, o.b.hi});
                w.field("reversed", o.reversed).field("gap", o.gap).end_object();
            });
            plain_ += text(where(), ": overlap over [", o.a.lo, ", ", o.a.hi, "] and [", o.b.lo, ", ", o.b.hi,
                           "]", o.reversed ? ", reversed" : "", ", gap at most ", o.gap, "\n");
        }
        for (const auto& box : found->undecided) undecided_.push_back(text(where(), ": ", shown_box(box)));
        return {};
    }
    static void write_box(json::Writer& w, const std::vector<Interval>& box) {
        w.begin_array();
        for (const Interval& t : box) w.array(std::array{t.lo, t.hi});
        w.end_array();
    }
    template <class T>
    static std::string list(const T& numbers) {
        std::string s;
        for (const double x : numbers) s += text(s.empty() ? "" : ", ", x);
        return s;
    }

    const Input &a_, &b_;
    std::optional<double> given_;
    double tolerance_;
    std::array<std::size_t, 2> at_{};
    std::vector<Row> points_, possible_, overlaps_;
    std::string plain_;
    SurfaceMeetings surfaces_;
    ModelContactRows on_models_;
    std::vector<std::string> undecided_;
};

Result<std::vector<Chosen>> operands(const Input& input) {
    std::vector<Chosen> out;
    for (const std::size_t i : input.chosen) {
        std::optional<std::size_t> trimmed;
        visit_one(
            [&](const auto& s) {
                if constexpr (std::constructible_from<Operand, decltype(s)>)
                    out.push_back({i, Operand(s)});
                else if constexpr (std::same_as<std::remove_cvref_t<decltype(s)>, TrimmedSurface>)
                    trimmed = i;
                else
                    remark_left_out(input, i);
            },
            input.object(i).shape);
        if (!trimmed) continue;
        auto model = scene_of(*input.document, std::span(&*trimmed, 1));
        if (!model) return std::unexpected(model.error());
        out.push_back({i, Operand(std::move(*model))});
    }
    if (out.empty())
        return refuse(RefusalKind::no_answer, shown(input.file),
                      "has no curve of the plane or of space, surface or model to intersect");
    return out;
}

// The boxes of the control points, which hold the objects but for rounding; of models none.
std::vector<ControlBox> boxes_of(const Input& input, const std::vector<Chosen>& chosen) {
    std::vector<ControlBox> out;
    for (const Chosen& c : chosen) out.push_back(control_box(input.object(c.index).shape));
    return out;
}

// Whether two objects of as many coordinates are farther apart than that, beyond doubt.
bool are_apart(const ControlBox& a, const ControlBox& b, double distance) {
    if (a.lo.size() != b.lo.size()) return false;
    for (std::size_t k = 0; k < a.lo.size(); ++k) {
        const double largest = std::max({-a.lo[k], a.hi[k], -b.lo[k], b.hi[k]});
        if (std::max(a.lo[k] - b.hi[k], b.lo[k] - a.hi[k]) > distance + 0x1p-30 * largest) return true;
    }
    return false;
}

Result<void> run_pairs(const Input& a, const Input& b, double tolerance, Meeting& meeting) {
    const auto in_a = operands(a), in_b = operands(b);
    if (!in_a) return std::unexpected(in_a.error());
    if (!in_b) return std::unexpected(in_b.error());
    const auto boxes_a = boxes_of(a, *in_a), boxes_b = boxes_of(b, *in_b);
    for (std::size_t i = 0; i < in_a->size(); ++i)
        for (std::size_t j = 0; j < in_b->size(); ++j) {
            if (are_apart(boxes_a[i], boxes_b[j], 2 * tolerance)) continue;
            if (auto done = meeting.meet((*in_a)[i], (*in_b)[j]); !done) return done;
        }
    return {};
}

Result<void> run_lines(const Context& context, const IntersectArguments& options, Meeting& meeting) {
    const bool rays = !options.rays.empty();
    const auto lines = read_lines(context, rays ? options.rays : options.lines, rays);
    if (!lines) return std::unexpected(lines.error());
    return meeting.meet_lines(*lines);
}

Result<void> run_intersect(const Context& context, const IntersectArguments& options) {
    if (!(options.tolerance.value_or(0) >= 0))
        wrong_usage("--tolerance needs a distance that is not negative");
    const auto a = read_input(context, options.a, options.object_a);
    if (!a) return std::unexpected(a.error());
    const bool by_lines = !options.rays.empty() || !options.lines.empty();
    if (options.b.empty() != by_lines || (!options.rays.empty() && !options.lines.empty()))
        wrong_usage("one of B, --rays and --lines is needed");
    const auto b = by_lines ? a : read_input(context, options.b, options.object_b);
    if (!b) return std::unexpected(b.error());
    Meeting meeting(*a, *b, options.tolerance);
    if (auto done = by_lines ? run_lines(context, options, meeting)
                             : run_pairs(*a, *b, options.tolerance.value_or(0), meeting);
        !done)
        return done;
    if (const auto open = meeting.undecided(); !open.empty()) {
        std::string boxes;
        for (std::size_t i = 0; i < std::min<std::size_t>(open.size(), 8); ++i)
            boxes += text(i ? "; " : "", open[i]);
        return refuse(RefusalKind::limit, "parameters",
                      text(open.size(), " boxes are undecided after all the work that is allowed: ", boxes,
                           open.size() > 8 ? "; .." : ""));
    }
    if (!options.curves.empty()) {
        Context file;
        file.output = options.curves;
        if (auto ok = emit(file, write_document(meeting.curves())); !ok) return ok;
    }
    return emit(context, context.json ? meeting.json() : meeting.plain());
}

}  // namespace

void add_intersect(CommandLine& line) {
    const auto options = std::make_shared<IntersectArguments>();
    const Command command =
        line.add("intersect", "Where curves, surfaces and models meet each other: every place, with a proof",
                 "  freiform intersect road.json river.json\n"
                 "  freiform intersect rays.json teapot.bpt --tolerance 1e-9 --json\n"
                 "  freiform intersect hull.json deck.json --tolerance 1e-4 --curves seam.json\n"
                 "  freiform intersect housing.step pipe.step --tolerance 1e-4 --curves cut.json\n"
                 "  freiform intersect wire.json part.step --json\n"
                 "  freiform intersect part.step --rays rays.csv --json\n"
                 "Outside of what is listed there is no intersection. \"possible\": within rounding they may "
                 "meet, or pass "
                 "by at most \"gap\" apart.");
    command.word("A", options->a, "The first file; - is standard input").required();
    command.word("B", options->b, "The second file");
    command
        .word("--rays", options->rays,
              "Instead of B: rays, one for each line of numbers px,py,pz,dx,dy,dz; its points are p + t d, t "
              ">= 0")
        .shown_as("FILE.csv");
    command.word("--lines", options->lines, "Likewise for all t").shown_as("FILE.csv");
    command.number(
        "--tolerance", options->tolerance,
        "Curves at most this far apart over an interval overlap; possible points with such a gap count as "
        "points (default 0: what rounding asks for). Of two surfaces, how far branches may be from either "
        "(default: 1e-6 of the size of the first)");
    command.word("--curves", options->curves, "Where the branches of surfaces go, as curves of a document")
        .shown_as("FILE.json");
    command.word("--object-a", options->object_a, "Only this object of A").shown_as("NAME|INDEX");
    command.word("--object-b", options->object_b, "Only this object of B").shown_as("NAME|INDEX");
    command.answer_file();
    command.limits();
    command.action(options, run_intersect);
}

}  // namespace freiform::cli
