// revolve: surfaces of revolution of the curves of a file.
#include "input.hpp"
#include "point_commands.hpp"
#include "regions.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/make/revolve.hpp>

#include <algorithm>
#include <numbers>

namespace freiform::cli {

namespace {

struct RevolveArguments {
    std::string file, object;
    std::vector<double> axis;
    std::optional<double> angle, polynomial, tolerance;
    bool closed = false, solid = false;

    Seam seam() const { return closed ? Seam::closed : Seam::open; }
};

Axis axis_of(const RevolveArguments& options) {
    const auto& a = options.axis;
    return {{{a[0], a[1], a[2]}}, {{a[3], a[4], a[5]}}};
}
double angle_of(const RevolveArguments& options) {  // in this order, 360 gives 2 pi
    return options.angle.value_or(360) / 180 * std::numbers::pi;
}

struct RevolveAnswer {
    Document document;
    double bound = 0;
    std::vector<int> pieces;  // of polynomial surfaces, along u
};

class Revolving {
public:
    Revolving(const RevolveArguments& options, RevolveAnswer& answer)
        : options_(options), answer_(answer), axis_(axis_of(options)), angle_(angle_of(options)) {}

    template <class P>
    requires(Space<P>::kDim == 2 || Space<P>::kDim == 3) Result<void> curve(const Curve<P>& c,
                                                                            const std::string& name) {
        if (options_.polynomial) return polynomial(c, name);
        auto made = revolve(c, axis_, angle_, options_.seam());
        if (!made) return std::unexpected(made.error());
        return add(name, std::move(made->surface), made->bound);
    }

private:
    template <class P>
    Result<void> polynomial(const Curve<P>& c, const std::string& name) {
        auto made = revolve_polynomial(c, axis_, angle_, *options_.polynomial, options_.seam());
        if (!made) return std::unexpected(made.error());
        answer_.pieces.push_back(made->pieces);
        return add(name, std::move(made->surface), made->bound);
    }
    template <class S>
    Result<void> add(const std::string& name, S surface, double bound) {
        answer_.document.objects.push_back({name, std::move(surface), {}});
        answer_.bound = std::max(answer_.bound, bound);
        return {};
    }

    const RevolveArguments& options_;
    RevolveAnswer& answer_;
    Axis axis_;
    double angle_;
};

std::string revolve_json(const RevolveAnswer& a) {
    json::Writer w;
    w.begin_object().field("surfaces", a.document.objects.size()).field("bound", a.bound);
    if (!a.pieces.empty()) w.key("pieces").array(a.pieces);
    w.end_object();
    return w.take() + "\n";
}

std::string revolve_text(const RevolveAnswer& a) {
    const std::size_t n = a.document.objects.size();
    return text(n, n == 1 ? " surface" : " surfaces", " within ", a.bound, " of the surface",
                n == 1 ? "" : "s", " of revolution\n");
}

Result<void> run_revolve(const Context& context, const RevolveArguments& options) {
    if (options.axis.size() != 6)
        wrong_usage("--axis needs six numbers: a point and a direction, px,py,pz,dx,dy,dz");
    require_direction("--axis", std::span(options.axis).last(3));
    if (const double a = std::abs(options.angle.value_or(360)); !(a > 0 && a <= 360))
        wrong_usage(text("--angle needs degrees from -360 to 360, and not 0, found ", *options.angle));
    if (options.solid) {
        const SolidOutput output = solid_output(context, "revolve --solid", options.tolerance);
        const auto region = read_region(context, options.file, options.object);
        if (!region) return std::unexpected(region.error());
        Axis axis = axis_of(options);
        const double angle = angle_of(options);
        if (angle < 0) axis.direction = -1 * axis.direction;
        return emit_swept(context, output, options.file, region->unit,
                          solid_of_revolution(region->loops, axis, std::abs(angle)));
    }
    const std::string format = spline_format(context, "revolve");
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    remark_changes(*document, *objects);
    RevolveAnswer answer;
    answer.document.unit = document->unit;
    Revolving revolving(options, answer);
    for (const std::size_t i : *objects) {
        const Object& object = document->objects[i];
        const auto done = visit_one(
            [&](const auto& s) -> Result<void> {
                if constexpr (requires { revolving.curve(s, object.name); })
                    return revolving.curve(s, object.name);
                return refuse(RefusalKind::no_answer, "",
                              text("is a ", type_name(object.shape),
                                   "; curves of two or three coordinates are revolved (--object)"));
            },
            object.shape);
        if (!done)
            return refuse_within(text(shown(options.file), ": ", object_label(*document, i)), done.error());
    }
    return emit_spline(context, format, answer.document, revolve_text(answer), revolve_json(answer));
}

}  // namespace

void add_revolve(CommandLine& line) {
    const auto options = std::make_shared<RevolveArguments>();
    const Command command = line.add(
        "revolve", "Surfaces of revolution of curves, exact (rational) or polynomial",
        "  freiform revolve outline.json --axis 0,0,0,0,1,0 -o vase.json\n"
        "  freiform revolve outline.json --axis 0,0,0,0,1,0 --angle 90 --polynomial 0.001 -o quarter.json");
    command.word("FILE", options->file, "Curves; - is standard input").required();
    command.numbers("--axis", options->axis, "A point of the axis and its direction")
        .shown_as("PX,PY,PZ,DX,DY,DZ")
        .required();
    command.number(
        "--angle", options->angle,
        "Degrees, counter-clockwise seen from the tip of the axis; negative ones clockwise (default 360)");
    command.positive("--polynomial", options->polynomial,
                     "Not exact, but polynomial within this distance, of rational curves too; the bound "
                     "reached is printed");
    command.flag("--closed", options->closed,
                 "Write a full turn on closed knots instead of open ones whose ends coincide");
    command.object(options->object);
    command.flag("--solid", options->solid, "The solid that the region inside of closed plane curves sweeps");
    command.positive("--tolerance", options->tolerance, "The largest distance of triangles from the solid");
    command.output(
        "Where the surfaces go (.json, .bpt, .step, .obj); solids: .json, .step, .iges, .glb, .stl, .obj, "
        ".ply");
    command.triangle_limit();
    command.limits();
    command.action(options, run_revolve);
}

}  // namespace freiform::cli
