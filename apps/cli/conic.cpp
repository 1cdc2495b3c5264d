// conic: conics from an equation or from points, as rational splines.
#include "command.hpp"
#include "point_commands.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/make/conic_equation.hpp>

#include <algorithm>

namespace freiform::cli {

namespace {

struct ConicArguments {
    std::vector<double> equation, circle, angles, box;
    std::string points;
    bool in_order = false;
};

struct ConicAnswer {
    std::optional<ConicEquation> equation;
    std::optional<ConicForm> form;
    std::optional<FivePointArc> passing;  // five points, in their order
    Document document;
    double bound = 0;  // of the arcs

    template <int D>
    void add(const ConicArc<D>& arc) {
        document.objects.push_back({"", arc.curve, {}});
        bound = std::max(bound, arc.bound);
    }
};

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

// The arcs of a form: inside the box, or a whole ellipse.
Result<void> add_arcs(ConicAnswer& a, const ConicArguments& options, bool wanted) {
    if (!wanted || !a.form->conic) return {};
    if (options.box.empty()) {
        if (a.form->conic->conic.kind != ConicKind::ellipse)
            return refuse(RefusalKind::no_answer, "conic",
                          text("a ", name_of(a.form->type), " is infinite; --box says which part"));
        auto arc = conic_arc(*a.form->conic, {0, 2 * std::numbers::pi});
        if (!arc) return std::unexpected(arc.error());
        a.add(*arc);
        return {};
    }
    const auto arcs =
        arcs_inside(*a.form, {{{options.box[0], options.box[1]}}, {{options.box[2], options.box[3]}}});
    if (!arcs) return std::unexpected(arcs.error());
    for (const auto& arc : *arcs) a.add(arc);
    return {};
}

Result<ConicAnswer> by_equation(const ConicEquation& equation, const ConicArguments& options, bool wanted) {
    ConicAnswer a;
    a.equation = equation;
    auto form = solve(equation);
    if (!form) return std::unexpected(form.error());
    a.form = std::move(*form);
    if (auto ok = add_arcs(a, options, wanted); !ok) return std::unexpected(ok.error());
    return a;
}

template <int D>
Result<ConicAnswer> through_three(const std::vector<std::vector<double>>& p) {
    Vec<D> v[3];
    for (std::size_t i = 0; i < 3; ++i) std::copy(p[i].begin(), p[i].end(), v[i].c.begin());
    const auto arc = arc_through(v[0], v[1], v[2]);
    if (!arc) return std::unexpected(arc.error());
    ConicAnswer a;
    a.add(*arc);
    return a;
}

Result<ConicAnswer> in_order(const std::array<Vec<2>, 5>& points) {
    auto arc = arc_through(points);
    if (!arc) return std::unexpected(arc.error());
    ConicAnswer a;
    a.document.objects.push_back({"", arc->curve, {}});
    a.passing = std::move(*arc);
    return a;
}

Result<ConicAnswer> by_points(const ConicArguments& options, bool wanted) {
    const std::string_view first = std::string_view(options.points).substr(0, options.points.find(';'));
    const int coords = 1 + int(std::count(first.begin(), first.end(), ','));
    const auto p = parse_vectors("--points", options.points, coords);
    if (options.in_order && p.size() != 5)
        wrong_usage(text("--in-order needs five points, found ", p.size()));
    if (p.size() == 3 && coords == 2) return through_three<2>(p);
    if (p.size() == 3 && coords == 3) return through_three<3>(p);
    if (p.size() != 5 || coords != 2)
        wrong_usage("--points needs three points of two or three coordinates, or five of two");
    std::array<Vec<2>, 5> five;
    for (std::size_t i = 0; i < 5; ++i) five[i] = {{p[i][0], p[i][1]}};
    if (options.in_order) return in_order(five);
    const auto found = equation_through(five);
    if (!found) return std::unexpected(found.error());
    return by_equation(found->equation, options, wanted);
}

Result<ConicAnswer> by_circle(const ConicArguments& options) {
    const auto& c = options.circle;
    const auto conic = circle({{c[0], c[1]}}, c[2]);
    if (!conic) return std::unexpected(conic.error());
    const auto arc = options.angles.empty()
                         ? full_ellipse(*conic, EllipseForm::open)
                         : conic_arc(*conic, {radians(options.angles[0]), radians(options.angles[1])});
    if (!arc) return std::unexpected(arc.error());
    ConicAnswer a;
    a.add(*arc);
    return a;
}

std::string conic_json(const ConicAnswer& a) {
    json::Writer w;
    w.begin_object();
    if (a.equation) w.key("equation").array(a.equation->c).key("origin").array(a.equation->origin.c);
    if (a.form) {
        const ConicForm& f = *a.form;
        w.field("type", name_of(f.type));
        if (f.conic) {
            w.key("centre").array(f.conic->conic.centre.c).key("x").array(f.conic->conic.x.c);
            w.key("y").array(f.conic->conic.y.c);
            w.field("bound", std::max({f.conic->centre_bound, f.conic->x_bound, f.conic->y_bound}));
        }
        if (f.point) w.key("point").array(f.point->c).field("bound", f.bound);
        if (!f.lines.empty()) {
            w.key("lines").begin_array();
            for (const auto& l : f.lines)
                w.begin_object()
                    .key("origin")
                    .array(l.origin.c)
                    .key("direction")
                    .array(l.direction.c)
                    .end_object();
            w.end_array().field("bound", f.bound);
        }
    }
    if (a.passing) {
        w.field("type", name_of(a.passing->type)).key("at").array(a.passing->at);
        w.field("points_bound", a.passing->bound).field("arcs", 1).end_object();
        return w.take() + "\n";
    }
    w.field("arcs", a.document.objects.size()).field("arc_bound", a.bound).end_object();
    return w.take() + "\n";
}

template <int D>
std::string vector(const Vec<D>& v) {
    std::string s;
    for (int i = 0; i < D; ++i) s += text(i == 0 ? "" : ", ", v[i]);
    return "(" + s + ")";
}

std::string conic_text(const ConicAnswer& a) {
    std::string s;
    if (a.passing) {
        s = text("an arc of a", a.passing->type == ConicType::ellipse ? "n " : " ", name_of(a.passing->type),
                 ", passes the points within ", a.passing->bound, " at");
        for (const double t : a.passing->at) s += text(" ", t);
        return s + "\n";
    }
    if (a.form) {
        const ConicForm& f = *a.form;
        s += text(name_of(f.type), "\n");
        if (f.conic)
            s +=
                text(f.type == ConicType::parabola ? "  vertex " : "  centre ", vector(f.conic->conic.centre),
                     ", axes ", vector(f.conic->conic.x), " and ", vector(f.conic->conic.y), "\n");
        if (f.point) s += text("  ", vector(*f.point), "\n");
        for (const auto& l : f.lines)
            s += text("  through ", vector(l.origin), " along ", vector(l.direction), "\n");
    }
    if (!a.document.objects.empty())
        s += text(a.document.objects.size(), a.document.objects.size() == 1 ? " arc" : " arcs", " within ",
                  a.bound, " of the conic\n");
    return s;
}

Result<void> run_conic(const Context& context, const ConicArguments& options) {
    const auto count = [&](const char* name, const std::vector<double>& v, std::size_t n, const char* form) {
        if (!v.empty() && v.size() != n) wrong_usage(text(name, " needs ", form));
    };
    count("--equation", options.equation, 6,
          "six numbers A,B,C,D,E,F of A x^2 + B x y + C y^2 + D x + E y + F");
    count("--circle", options.circle, 3, "three numbers X,Y,R");
    if (!options.circle.empty() && !(options.circle[2] > 0)) wrong_usage("--circle needs a radius above 0");
    count("--angles", options.angles, 2, "two numbers, in degrees");
    count("--box", options.box, 4, "four numbers X0,Y0,X1,Y1");
    if (!options.equation.empty() + !options.circle.empty() + !options.points.empty() != 1)
        wrong_usage("conic needs one of --equation, --points and --circle");
    if (options.in_order && (options.points.empty() || !options.box.empty()))
        wrong_usage("--in-order goes with --points and without --box");
    const bool wanted = !context.output.empty() || !options.box.empty();
    ConicEquation equation;
    std::copy(options.equation.begin(), options.equation.end(), equation.c.begin());
    auto a = !options.equation.empty() ? by_equation(equation, options, wanted)
             : !options.points.empty() ? by_points(options, wanted)
                                       : by_circle(options);
    if (!a) return std::unexpected(a.error());
    if (context.output.empty()) return emit(context, context.json ? conic_json(*a) : conic_text(*a));
    if (a->document.objects.empty())
        return refuse(RefusalKind::no_answer, "conic", "there is no arc to write");
    const std::string format = spline_format(context, "conic");
    return emit_spline(context, format, a->document, conic_text(*a), conic_json(*a));
}

}  // namespace

void add_conic(CommandLine& line) {
    const auto options = std::make_shared<ConicArguments>();
    const Command command =
        line.add("conic", "Conics by equation or through points: what they are, and their arcs",
                 "  freiform conic --equation 1,0,4,0,0,-4\n"
                 "  freiform conic --equation 0,1,0,0,0,-1 --box -3,-3,3,3 -o hyperbola.json\n"
                 "  freiform conic --points '1,0;0,1;-1,0' -o arc.json\n"
                 "  freiform conic --points '5,0;4,3;3,4;0,5;-5,0' --in-order -o half.json\n"
                 "  freiform conic --circle 0,0,2 --angles 0,270 -o arc.json");
    command.numbers("--equation", options->equation, "A x^2 + B x y + C y^2 + D x + E y + F = 0")
        .shown_as("A,B,C,D,E,F");
    command
        .word("--points", options->points,
              "Three points: the circular arc through them; five: the conic through them")
        .shown_as("X,Y;...");
    command.flag("--in-order", options->in_order,
                 "Of five points: the arc from the first to the last that passes them in their order");
    command.numbers("--circle", options->circle, "Centre and radius").shown_as("X,Y,R");
    command.numbers("--angles", options->angles, "Of the circle: from, to, in degrees").shown_as("A,B");
    command.numbers("--box", options->box, "Only the parts inside this box").shown_as("X0,Y0,X1,Y1");
    command.output("Where the arcs go, as rational splines (.json, .bpt, .step, .obj)");
    command.action(options, run_conic);
}

}  // namespace freiform::cli
