// continuity: how smooth curves and surfaces are at their knots, and how smoothly neighbours and the faces of
// models join.
#include "edge_joints.hpp"
#include "input.hpp"
#include "joint_units.hpp"
#include "surface_joints.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/query/continuity.hpp>

#include <algorithm>
#include <numbers>

namespace freiform::cli {

namespace {

constexpr double kToleranceOfBox = 1e-9, kGapOfBox = 1e-3;
constexpr char kAxisOf[] = "uvw";

struct ContinuityArguments {
    std::string file, object;
    std::optional<double> tolerance, gap, angle, curvature;
    std::optional<int> orders;
};

// What was found about one object: knots of a curve, or knot lines of a surface or volume.
struct Found {
    std::size_t object = 0;
    std::vector<KnotContinuity> knots;
    std::vector<std::vector<KnotLine>> lines;  // per axis
    std::optional<ModelJoints> edges;          // of a model
    std::string without;                       // why nothing was looked at
};

struct ContinuityAnswer {
    const Document* document = nullptr;
    ContinuityOptions options;
    double gap = 0;
    bool tolerance_given = false;
    std::vector<Found> objects;
    std::vector<std::size_t> curve;  // object of each curve that joints are counted by
    std::vector<CurveJoint> joints;
    SurfaceNeighbours surfaces;
};

// Curves, surfaces and volumes.
bool has_knots(const Shape& shape) {
    return !bases_of(shape).empty() && !std::holds_alternative<TrimmedSurface>(shape);
}

// The largest extent of any object, from its control points.
double diagonal_of_all(const Document& document, const std::vector<std::size_t>& objects) {
    double most = 0;
    for (const std::size_t i : objects) {
        const Shape& shape = document.objects[i].shape;
        if (has_knots(shape)) most = std::max(most, control_box(shape).diagonal);
    }
    return most;
}

std::string without_knots(const Shape& shape) {
    return text(
        "is a ", type_name(shape),
        ", which has no knots; continuity looks at curves, surfaces, volumes and the edges of models");
}

// The knot lines of a surface or volume along one axis.
Result<std::vector<KnotLine>> lines_along(const Shape& shape, int axis, const ContinuityOptions& options) {
    return visit_one(
        [&](const auto& s) -> Result<std::vector<KnotLine>> {
            if constexpr (TensorPatch<std::remove_cvref_t<decltype(s)>>)
                if constexpr (std::remove_cvref_t<decltype(s)>::kParams > 1)
                    return knot_lines(s, axis, options);
            return {};
        },
        shape);
}

Result<Found> look_at_joint(const Shape& shape, std::size_t object, const ContinuityOptions& options,
                            const ContinuityArguments& given) {
    Found found;
    found.object = object;
    if (const Model* model = std::get_if<Model>(&shape)) {
        auto edges = joints_of(*model, object, given.tolerance, given.angle, given.curvature);
        if (!edges) return std::unexpected(edges.error());
        found.edges = *std::move(edges);
        return found;
    }
    if (!has_knots(shape)) {
        found.without = without_knots(shape);
        return found;
    }
    Result<std::vector<KnotContinuity>> knots;
    if (with_curve(shape, [&](const auto& curve) { knots = continuity(curve, options); })) {
        if (!knots) return std::unexpected(knots.error());
        found.knots = *std::move(knots);
        return found;
    }
    for (std::size_t axis = 0; axis < bases_of(shape).size(); ++axis) {
        auto lines = lines_along(shape, int(axis), options);
        if (!lines) return std::unexpected(lines.error());
        found.lines.push_back(*std::move(lines));
    }
    return found;
}

Result<ContinuityAnswer> answer_joint(const Document& document, const std::vector<std::size_t>& objects,
                                      const ContinuityArguments& given) {
    ContinuityAnswer a;
    a.document = &document;
    const double size = diagonal_of_all(document, objects);
    a.options.tolerance = given.tolerance.value_or(kToleranceOfBox * size);
    a.options.angle = given.angle.value_or(0) * (std::numbers::pi / 180);
    a.options.orders = given.orders.value_or(a.options.orders);
    a.tolerance_given = given.tolerance.has_value();
    a.gap = given.gap.value_or(std::max(a.options.tolerance, kGapOfBox * size));
    std::vector<CurveEnds> ends;
    for (const std::size_t i : objects) {
        const Shape& shape = document.objects[i].shape;
        auto found = look_at_joint(shape, i, a.options, given);
        if (!found) return refuse_within(object_label(document, i), found.error());
        a.objects.push_back(*std::move(found));
        a.surfaces.add(shape, i, a.options);
        with_curve(shape, [&](const auto& curve) {
            ends.push_back(ends_of(curve, a.options)), a.curve.push_back(i);
        });
    }
    if (std::all_of(a.objects.begin(), a.objects.end(), [](const Found& f) { return !f.without.empty(); }))
        return refuse(RefusalKind::no_answer,
                      a.objects.empty() ? "" : object_label(document, a.objects[0].object),
                      a.objects.empty() ? "there is no object to look at" : a.objects[0].without);
    auto found = joints(ends, a.gap, a.options);
    if (!found) return std::unexpected(found.error());
    // A curve that comes back to its start is among its own knots, as the seam.
    for (CurveJoint& j : *found)
        if (j.meeting.first != j.meeting.second || j.joint.c_order < 0) a.joints.push_back(std::move(j));
    if (auto ok = a.surfaces.find(a.gap, a.options); !ok) return std::unexpected(ok.error());
    return a;
}

std::string_view end_name(End e) { return e == End::start ? "start" : "end"; }

// JSON
// -------------------------------------------------------------------------------------------------------

void write_jump(json::Writer& w, const Jump& j, int order, const std::string& unit) {
    w.begin_object().field("order", order).field("size", j.size).field("bound", j.bound).field("unit", unit);
    w.end_object();
}
template <class Unit>
void write_jumps(json::Writer& w, const char* name, const std::vector<Jump>& jumps, Unit&& unit) {
    w.key(name).begin_array();
    for (std::size_t k = 0; k < jumps.size(); ++k) write_jump(w, jumps[k], int(k), unit(int(k)));
    w.end_array();
}
template <class Unit>
void write_first(json::Writer& w, const char* name, const std::vector<Jump>& jumps, int order, Unit&& unit) {
    w.key(name);
    if (order + 1 < int(jumps.size()))
        write_jump(w, jumps[std::size_t(order + 1)], order + 1, unit(order + 1));
    else
        w.null();
}
void write_bounded(json::Writer& w, const char* name, const std::optional<Bounded>& x) {
    if (x) w.key(name).begin_object().field("value", x->value).field("bound", x->bound).end_object();
}
void write_side(json::Writer& w, const char* name, const SideGeometry& g) {
    w.key(name).begin_object();
    w.key("tangent").array(g.tangent);
    write_bounded(w, "curvature", g.curvature);
    write_bounded(w, "curvature_rate", g.curvature_rate);
    write_bounded(w, "torsion", g.torsion);
    if (!g.binormal.empty()) w.key("binormal").array(g.binormal);
    w.end_object();
}
void write_joint(json::Writer& w, const Document& d, const Continuity& j) {
    const auto c = [&](int k) { return c_unit(d, k); };
    const auto g = [&](int k) { return g_unit(d, k); };
    w.field("c_order", j.c_order).field("g_order", j.g_order);
    w.key("point").array(j.point);
    write_first(w, "first_c_jump", j.c, j.c_order, c);
    write_first(w, "first_g_jump", j.g, j.g_order, g);
    w.field("singular", j.singular).field("opposed", j.opposed);
    if (j.unbounded > 0) w.field("unbounded", j.unbounded);
    write_jumps(w, "c_jumps", j.c, c);
    write_jumps(w, "g_jumps", j.g, g);
    if (j.binormal) {
        w.key("binormal_jump");
        write_jump(w, *j.binormal, 2, "rad");
    }
    write_side(w, "before", j.before);
    write_side(w, "after", j.after);
    w.key("phi").array(j.phi);
}
void write_line(json::Writer& w, const Document& d, const KnotLine& line) {
    const auto unit = [&](int k) { return c_unit(d, k); };
    w.new_line(3).begin_object().field("at", line.at).field("multiplicity", line.multiplicity);
    w.field("seam", line.seam).field("c_order", line.c_order);
    write_first(w, "first_c_jump", line.c, line.c_order, unit);
    write_jumps(w, "c_jumps", line.c, unit);
    w.end_object();
}

std::string json_of(const ContinuityAnswer& a) {
    const Document& d = *a.document;
    json::Writer w;
    w.begin_object().field("unit", d.unit).field("tolerance", a.options.tolerance).field("gap", a.gap);
    w.field("orders", a.options.orders).key("objects").begin_array();
    for (const Found& f : a.objects) {
        const Object& o = d.objects[f.object];
        w.new_line(1).begin_object().field("object", f.object).field("name", o.name);
        w.field("type", type_name(o.shape));
        if (!f.without.empty()) w.field("skipped", f.without);
        if (f.edges) {
            write_joints(w, *f.edges);
        } else if (!f.lines.empty()) {
            w.key("axes").begin_array();
            for (const auto& axis : f.lines) {
                w.new_line(2).begin_array();
                for (const KnotLine& line : axis) write_line(w, d, line);
                w.end_array();
            }
            w.end_array();
        } else if (f.without.empty()) {
            w.key("knots").begin_array();
            for (const KnotContinuity& k : f.knots) {
                w.new_line(2).begin_object().field("at", k.at).field("multiplicity", k.multiplicity);
                w.field("seam", k.seam).field("removable", k.removable);
                write_joint(w, d, k.joint);
                w.end_object();
            }
            w.end_array();
        }
        w.end_object();
    }
    w.end_array().key("joints").begin_array();
    for (const CurveJoint& j : a.joints) {
        w.new_line(1).begin_object().field("first", a.curve[j.meeting.first]);
        w.field("first_end", end_name(j.meeting.first_end)).field("second", a.curve[j.meeting.second]);
        w.field("second_end", end_name(j.meeting.second_end)).field("distance", j.meeting.distance);
        write_joint(w, d, j.joint);
        w.end_object();
    }
    write_joints(w, d, a.surfaces);
    w.end_array().end_object();
    return w.take() + "\n";
}

// Text
// -------------------------------------------------------------------------------------------------------

std::string first_text(char kind, const std::vector<Jump>& jumps, int order, const std::string& unit) {
    if (order + 1 >= int(jumps.size())) return "";
    const Jump& j = jumps[std::size_t(order + 1)];
    return text(kind, order + 1, " by ", rounded(j.size), " ", unit);
}

class Table {
public:
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    std::string text_of() const {
        std::vector<std::size_t> width;
        for (const auto& r : rows_)
            for (std::size_t i = 0; i < r.size(); ++i) {
                if (width.size() <= i) width.push_back(0);
                width[i] = std::max(width[i], r[i].size());
            }
        std::string s;
        for (const auto& r : rows_) {
            std::string line = " ";
            for (std::size_t i = 0; i < r.size(); ++i)
                line += text(" ", r[i], std::string(width[i] - r[i].size() + 1, ' '));
            line.resize(line.find_last_not_of(' ') + 1);
            s += line + "\n";
        }
        return s;
    }

private:
    std::vector<std::vector<std::string>> rows_;
};

void joint_row(Table& table, const Document& d, std::string place, const Continuity& j,
               std::string remark = "") {
    const auto add = [&](std::string_view what) { remark += text(remark.empty() ? "" : ", ", what); };
    if (j.opposed) add("turns back");
    if (j.singular) add("singular");
    if (j.unbounded > 0) add(text("G", j.unbounded, " without bound"));
    table.row({std::move(place), order_text('C', j.c_order), order_text('G', j.g_order),
               first_text('C', j.c, j.c_order, c_unit(d, j.c_order + 1)),
               first_text('G', j.g, j.g_order, g_unit(d, j.g_order + 1)), remark});
}

void knot_rows(Table& table, const Document& d, const Found& f) {
    for (const KnotContinuity& k : f.knots)
        joint_row(table, d,
                  k.seam ? text("seam ", rounded(k.at)) : text("knot ", rounded(k.at), " x", k.multiplicity),
                  k.joint, k.removable ? "removable" : "");
    for (std::size_t axis = 0; axis < f.lines.size(); ++axis)
        for (const KnotLine& line : f.lines[axis])
            table.row({text(line.seam ? "seam " : "knot ", kAxisOf[axis], " = ", rounded(line.at),
                            line.seam ? "" : text(" x", line.multiplicity)),
                       order_text('C', line.c_order), "",
                       first_text('C', line.c, line.c_order, c_unit(d, line.c_order + 1))});
}

std::string text_of_joint(const ContinuityAnswer& a) {
    const Document& d = *a.document;
    std::string s;
    if (std::ranges::any_of(a.objects, [](const Found& f) { return !f.edges; }))
        s = text("tolerance ", rounded(a.options.tolerance), " ", unit_of(d),
                 a.tolerance_given ? "" : text(" (", kToleranceOfBox, " of the size of the largest object)"),
                 ", ends and edges nearer than ", rounded(a.gap), " ", unit_of(d), " are joined\n");
    const std::vector<std::string> head{"", "C", "G", "first jump of C", "first jump of G"};
    for (const Found& f : a.objects) {
        s += text(object_label(d, f.object), ": ", type_name(d.objects[f.object].shape));
        if (f.edges) {
            s += text(", ", f.edges->joints.size(), " joints of faces\n", joints_text(d, *f.edges));
            continue;
        }
        Table table;
        table.row(head);
        knot_rows(table, d, f);
        const bool none = f.knots.empty() && std::all_of(f.lines.begin(), f.lines.end(),
                                                         [](const auto& l) { return l.empty(); });
        s += !f.without.empty() ? text(" (", f.without, ")\n")
             : none             ? ", no inner knots\n"
                                : "\n" + table.text_of();
    }
    if (a.joints.empty() && a.surfaces.joints.empty()) return s;
    Table table;
    table.row(head);
    for (const CurveJoint& j : a.joints)
        joint_row(table, d,
                  text(object_label(d, a.curve[j.meeting.first]), " ", end_name(j.meeting.first_end), " - ",
                       object_label(d, a.curve[j.meeting.second]), " ", end_name(j.meeting.second_end)),
                  j.joint);
    for (auto& row : joint_rows(d, a.surfaces)) table.row(std::move(row));
    return s + "joints\n" + table.text_of();
}

Result<void> run_continuity(const Context& context, const ContinuityArguments& options) {
    for (const auto& [name, x] : {std::pair("--tolerance", options.tolerance),
                                  {"--gap", options.gap},
                                  {"--angle", options.angle},
                                  {"--curvature", options.curvature}})
        if (x && !(*x >= 0)) wrong_usage(text(name, " needs a number >= 0, found ", *x));
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const auto a = answer_joint(*input->document, input->chosen, options);
    if (!a) return std::unexpected(a.error());
    return emit(context, context.json ? json_of(*a) : text_of_joint(*a));
}

}  // namespace

void add_continuity(CommandLine& line) {
    const auto options = std::make_shared<ContinuityArguments>();
    const Command command = line.add(
        "continuity",
        "The order of C and G at knots and joints of curves and surfaces, and across the edges of models",
        "  freiform continuity path.json\n"
        "  freiform continuity path.json --tolerance 1e-6 --json\n"
        "  freiform continuity surface.json          knots of surfaces: C only\n"
        "  freiform continuity part.step             faces across edges, the worst first");
    command.file(options->file);
    command.number(
        "--tolerance", options->tolerance,
        "A jump counts as none if it moves no point of a neighbouring piece by more than this distance; "
        "0: only rounding (1e-9 of the size of the largest object). Of models: the gap between faces that is "
        "allowed (1e-6 of the size, or what the file says)");
    command.number("--angle", options->angle,
                   "Degrees that tangents may differ by all the same (0; tangent planes of models 0.1)");
    command.number("--curvature", options->curvature,
                   "Of models: what curvatures may differ by for G2 (1e-2 over the size)");
    command.number(
        "--gap", options->gap,
        "Ends of curves and edges of surfaces nearer than this are a joint (1e-3 of the size of the "
        "largest object)");
    command.count("--orders", options->orders, 0, kMaxDegree, "Highest order of G to look at (3)");
    command.object(options->object);
    command.answer_file();
    command.limits();
    command.action(options, run_continuity);
}

}  // namespace freiform::cli
