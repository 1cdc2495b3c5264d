// section: where the surfaces and models of a file meet a plane, as curves.
#include "drawing_bytes.hpp"
#include "input.hpp"
#include "point_commands.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/section.hpp>

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
        areas_.begin_array();
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
    // Of a solid model or a trimmed surface.
    Result<void> cut(std::size_t index, const Model& model, const Context& context) {
        TessellateOptions how;
        how.tolerance = options_.tolerance.value_or(1e-4 * summary(model).box.diagonal());
        how.max_triangles = (long long)(context.limits.max_triangles);
        const auto found = section(model, plane_, how);
        if (!found) return input_.about(index, found.error());
        for (const RefusedFace& f : found->refused)
            remark(text(input_.label(index), ": face ", f.face, " is missing: ", f.reason.message));
        std::size_t closed = 0;
        for (const ModelSectionLine& l : found->lines) add(index, l, found->bound, found->plane_bound);
        for (const ModelSectionLine& l : found->lines) closed += l.closed;
        if (found->lines.empty()) return {};
        plain_ += text(input_.label(index), ": ", closed, " closed lines, ", found->lines.size() - closed,
                       " open ones, within ", found->bound, " of the faces, area ", found->area, "\n");
        areas_.new_line(1).begin_object().field("object", index).field("area", found->area);
        areas_.field("closed", closed).field("open", found->lines.size() - closed).end_object();
        return {};
    }
    Result<void> emit_all(const Context& context, const std::string& format) {
        std::string report = rows_.end_array().take();
        report += ",\n\"models\": " + areas_.end_array().take();
        report += ",\n\"nodes\": " + nodes_.end_array().take();
        report += ",\n\"overlaps\": " + overlaps_.end_array().take() + "}\n";
        const std::string plain = plain_.empty() ? "the plane meets nothing\n" : plain_;
        if (format == "json" || format == "bpt")
            return emit_spline(context, format, std::move(made_), plain, report);
        if (made_.objects.empty())
            return refuse(RefusalKind::no_answer, shown(input_.file), "the plane meets nothing to draw");
        const Document flat = in_plane();
        const auto drawing = draw(flat, {}, DrawingOptions{});
        if (!drawing) return std::unexpected(drawing.error());
        const auto bytes = drawing_bytes(*drawing, format, "section");
        if (!bytes) return std::unexpected(bytes.error());
        if (auto ok = emit(context, *bytes); !ok) return ok;
        if (context.output.empty() || context.output == "-") return {};
        return emit({}, context.json ? report : plain);
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
    void add(std::size_t index, const ModelSectionLine& l, double bound, double plane_bound) {
        std::vector<double> knots{0};
        for (std::size_t i = 0; i < l.points.size(); ++i) knots.push_back(double(i));
        knots.push_back(knots.back());
        const std::size_t number = made_.objects.size();
        const std::string own = input_.object(index).name;
        auto basis = BSplineBasis::make(1, std::move(knots));
        if (!basis) return;  // never: there are two points and more
        made_.objects.push_back(
            {text(own.empty() ? "section" : own, " ", ++branches_),
             Curve<Vec<3>>::trusted({*std::move(basis)}, Net<1, Vec<3>>({int(l.points.size())}, l.points)),
             {}});
        std::vector<int> faces = l.faces;
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        if (faces.size() > 1 && l.closed && faces.front() == faces.back()) faces.pop_back();
        rows_.new_line(1)
            .begin_object()
            .field("object", index)
            .field("curve", number)
            .field("closed", l.closed)
            .key("faces")
            .array(faces);
        rows_.field("control_points", l.points.size()).field("surface_bound", bound);
        rows_.field("plane_bound", plane_bound);
        if (l.closed) rows_.field("area", l.area);
        rows_.end_object();
    }
    // The curves as the plane sees them: the first direction is x, or y where the normal is nearest to x; the
    // second to the left of it, seen against the normal, or to the right where that turns y or z down.
    Document in_plane() const {
        const Vec<3> n = (1 / norm(plane_.normal)) * plane_.normal;
        const int away = std::abs(n[2]) >= std::max(std::abs(n[0]), std::abs(n[1])) ? 2
                         : std::abs(n[1]) >= std::abs(n[0])                         ? 1
                                                                                    : 0;
        Vec<3> x{}, y{};
        x[away == 0 ? 1 : 0] = 1;
        y[away == 2 ? 1 : 2] = 1;
        x = unit(x - dot(x, n) * n);
        y = unit(y - dot(y, n) * n - dot(y, x) * x);
        Document flat{made_.unit, {}};
        for (const Object& o : made_.objects)
            if (const auto* c = std::get_if<Curve<Vec<3>>>(&o.shape)) {
                std::vector<Vec<2>> points;
                for (const Vec<3>& p : c->net().flat()) points.push_back({{dot(x, p), dot(y, p)}});
                flat.objects.push_back(
                    {o.name,
                     Curve<Vec<2>>::trusted({c->basis()}, Net<1, Vec<2>>(c->net().extent(), points)),
                     {}});
            }
        return flat;
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
    json::Writer rows_, nodes_, overlaps_, areas_;
    std::string plain_;
    int branches_ = 0;
};

Plane plane_of(const std::vector<double>& given) {
    if (given.size() != 4 && given.size() != 6)
        wrong_usage("--plane needs A,B,C,D of A x + B y + C z + D = 0, or a point and a normal, six numbers");
    require_direction("--plane", std::span(given).subspan(given.size() == 4 ? 0 : 3, 3));
    if (given.size() == 4) return {{{given[0], given[1], given[2]}}, given[3]};
    const Vec<3> p{{given[0], given[1], given[2]}}, n{{given[3], given[4], given[5]}};
    return {n, -dot(n, p)};
}

// As splines, or as a drawing.
std::string section_format(const Context& context) {
    const std::string& name = context.to.empty() ? context.output : context.to;
    for (const std::string drawing : {"svg", "pdf", "png"})
        if (name == drawing || name.ends_with("." + drawing)) return drawing;
    return spline_format(context, "section");
}

Result<void> run_section(const Context& context, const SectionArguments& options) {
    const std::string format = section_format(context);
    const Plane plane = plane_of(options.plane);
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    Cutting cutting(*input, plane, options);
    std::size_t surfaces = 0;
    for (const std::size_t i : input->chosen) {
        const auto done = visit_one(
            [&](const auto& s) -> Result<void> {
                using S = std::remove_cvref_t<decltype(s)>;
                if constexpr (std::same_as<S, Surface<Vec<3>>> || std::same_as<S, Surface<Hom<3>>>)
                    return ++surfaces, cutting.cut(i, s);
                if constexpr (std::same_as<S, Model> || std::same_as<S, TrimmedSurface>) {
                    const auto model = scene_of(*input->document, std::span(&i, 1));
                    if (!model) return std::unexpected(model.error());
                    return ++surfaces, cutting.cut(i, *model, context);
                }
                remark(text(input->label(i), ": is no surface or model in space, and left out"));
                return {};
            },
            input->object(i).shape);
        if (!done) return done;
    }
    if (surfaces == 0)
        return refuse(RefusalKind::no_answer, shown(input->file), "has no surface or model in space to cut");
    return cutting.emit_all(context, format);
}

}  // namespace

void add_section(CommandLine& line) {
    const auto options = std::make_shared<SectionArguments>();
    const Command command =
        line.add("section", "Where surfaces meet a plane: every branch, as splines with a proven bound",
                 "  freiform section hull.json --plane 0,0,1,-2.5 --tolerance 1e-4 -o waterline.json\n"
                 "  freiform section hull.json --plane 0,0,2.5,0,0,1 --json -o waterline.json\n"
                 "  freiform section part.step --plane 0,0,1,-2.5 --tolerance 0.01 -o part.svg\n"
                 "--plane: A,B,C,D of A x + B y + C z + D = 0, or a point and a normal. \"nodes\": where "
                 "branches cross,\n"
                 "or the surface touches the plane. Models and trimmed surfaces: polylines over all faces, "
                 "closed where "
                 "the\nmodel is, with the area that they enclose.");
    command.file(options->file);
    command.numbers("--plane", options->plane, "A,B,C,D or PX,PY,PZ,NX,NY,NZ").required();
    command.positive("--tolerance", options->tolerance,
                     "How far a curve may be from the section (default: 1e-6 of the size of the surface); of "
                     "models, polylines from the faces (1e-4)");
    command.flag("--parameters", options->parameters,
                 "Behind each curve its curve in the parameters of the surface");
    command.object(options->object);
    command.output("Where the curves go (.json), or a drawing in the plane (.svg, .pdf, .png)");
    command.limits();
    command.triangle_limit();
    command.action(options, run_section);
}

}  // namespace freiform::cli
