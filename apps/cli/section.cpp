// section: where the surfaces of a file meet a plane, as curves.
#include "input.hpp"
#include "point_commands.hpp"

#include <freiform/intersect/section.hpp>

namespace freiform::cli {

namespace {

struct SectionArguments {
    std::string file, object;
    std::vector<double> plane;
    std::optional<double> tolerance;
    bool parameters = false;
};

class Cutting {
public:
    Cutting(const Input& input, const Plane& plane, const SectionArguments& options)
        : input_(input), plane_(plane), options_(options) {
        made_.unit = input.document->unit;
        rows_.begin_object().key("branches").begin_array();
        nodes_.begin_array();
        overlaps_.begin_array();
    }

    template <class P>
    Result<void> cut(std::size_t index, const Surface<P>& surface) {
        Box<3> box;
        for (const Vec<3>& p : points(surface)) box.add(p);
        const double tolerance = options_.tolerance.value_or(1e-6 * box.diagonal());
        const auto found = section(surface, plane_, {.tolerance = tolerance});
        if (!found) return input_.about(index, found.error());
        if (const auto& open = found->undecided; !open.empty())
            return input_.about(
                index,
                Refusal{RefusalKind::limit, "parameters",
                        text(open.size(), " boxes are undecided after all the work that is allowed, from [",
                             open[0][0].lo, ", ", open[0][0].hi, "] x [", open[0][1].lo, ", ", open[0][1].hi,
                             "] on")});
        for (const SectionBranch& b : found->branches) add(index, b);
        for (const SectionNode& n : found->nodes) add(index, n);
        for (const auto& o : found->overlaps) {
            overlaps_.new_line(1).begin_object().field("object", index).key("box");
            write_box(overlaps_, o);
            overlaps_.end_object();
            plain_ += text(input_.label(index), ": lies in the plane over [", o[0].lo, ", ", o[0].hi, "] x [",
                           o[1].lo, ", ", o[1].hi, "]\n");
        }
        return {};
    }
    Result<void> emit_all(const Context& context, const std::string& format) {
        std::string report = rows_.end_array().take();
        report += ",\n\"nodes\": " + nodes_.end_array().take();
        report += ",\n\"overlaps\": " + overlaps_.end_array().take() + "}\n";
        const std::string plain = plain_.empty() ? "the plane meets nothing\n" : plain_;
        return emit_spline(context, format, std::move(made_), plain, report);
    }

private:
    void add(std::size_t index, const SectionBranch& b) {
        const std::size_t number = made_.objects.size();
        const std::string name =
            text(input_.object(index).name.empty() ? "section" : input_.object(index).name, " ", ++branches_);
        made_.objects.push_back({name, b.curve});
        if (options_.parameters) made_.objects.push_back({name + " parameters", b.at});
        rows_.new_line(1)
            .begin_object()
            .field("object", index)
            .field("curve", number)
            .field("closed", b.closed);
        rows_.key("ends").array(b.ends);
        rows_.field("control_points", b.curve.basis().size());
        rows_.field("bound", b.bound)
            .field("surface_bound", b.surface_bound)
            .field("plane_bound", b.plane_bound);
        rows_.end_object();
        plain_ += text(input_.label(index), ": ", b.closed ? "closed" : "open", " branch, ",
                       b.curve.basis().size(), " control points, within ", b.bound, " of the section\n");
    }
    void add(std::size_t index, const SectionNode& n) {
        nodes_.new_line(1).begin_object().field("object", index).field("kind", name_of(n.kind)).key("box");
        write_box(nodes_, n.box);
        nodes_.key("point").array(n.point.c).field("gap", n.gap).field("arms", n.arms).end_object();
        plain_ += text(input_.label(index), ": ", name_of(n.kind), " at ", n.point[0], ", ", n.point[1], ", ",
                       n.point[2], ", ", n.arms, " branches end there, gap at most ", n.gap, "\n");
    }
    static void write_box(json::Writer& w, const std::array<Interval, 2>& box) {
        w.begin_array();
        for (const Interval& t : box) w.array(std::array{t.lo, t.hi});
        w.end_array();
    }

    const Input& input_;
    Plane plane_;
    const SectionArguments& options_;
    Document made_;
    json::Writer rows_, nodes_, overlaps_;
    std::string plain_;
    int branches_ = 0;
};

Plane plane_of(const std::vector<double>& given) {
    if (given.size() == 4) return {{{given[0], given[1], given[2]}}, given[3]};
    if (given.size() != 6)
        wrong_usage("--plane needs A,B,C,D of A x + B y + C z + D = 0, or a point and a normal, six numbers");
    const Vec<3> p{{given[0], given[1], given[2]}}, n{{given[3], given[4], given[5]}};
    return {n, -dot(n, p)};
}

Result<void> run_section(const Context& context, const SectionArguments& options) {
    const std::string format = spline_format(context, "section");
    const Plane plane = plane_of(options.plane);
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    Cutting cutting(*input, plane, options);
    std::size_t surfaces = 0;
    for (const std::size_t i : input->chosen) {
        const auto done = std::visit(
            [&](const auto& s) -> Result<void> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, Surface<Vec<3>>> || std::same_as<S, Surface<Hom<3>>>)
                    return ++surfaces, cutting.cut(i, s);
                remark(text(input->label(i), ": is no surface in space, and left out"));
                return {};
            },
            input->object(i).shape);
        if (!done) return done;
    }
    if (surfaces == 0)
        return refuse(RefusalKind::no_answer, shown(input->file), "has no surface in space to cut");
    return cutting.emit_all(context, format);
}

}  // namespace

void add_section(CommandLine& line) {
    const auto options = std::make_shared<SectionArguments>();
    const Command command =
        line.add("section", "Where surfaces meet a plane: every branch, as splines with a proven bound",
                 "  freiform section hull.json --plane 0,0,1,-2.5 --tolerance 1e-4 -o waterline.json\n"
                 "  freiform section hull.json --plane 0,0,2.5,0,0,1 --json -o waterline.json\n"
                 "--plane: A,B,C,D of A x + B y + C z + D = 0, or a point and a normal. \"nodes\": where "
                 "branches cross,\n"
                 "or the surface touches the plane. Trimmed surfaces and models are left out.");
    command.file(options->file);
    command.numbers("--plane", options->plane, "A,B,C,D or PX,PY,PZ,NX,NY,NZ").required();
    command.number("--tolerance", options->tolerance,
                   "How far a curve may be from the section (default: 1e-6 of the size of the surface)");
    command.flag("--parameters", options->parameters,
                 "Behind each curve its curve in the parameters of the surface");
    command.object(options->object);
    command.output("Where the curves go (.json)");
    command.limits();
    command.action(options, run_section);
}

}  // namespace freiform::cli
