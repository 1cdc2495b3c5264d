// quadric: spheres, cylinders, cones, tori and ellipsoids as rational surfaces.
#include "point_commands.hpp"
#include "surface_commands.hpp"

#include <freiform/make/quadric.hpp>

#include <cmath>
#include <numbers>

namespace freiform::cli {

namespace {

struct QuadricArguments {
    std::string kind, form;
    std::optional<double> radius, top, tube, height, angle;
    std::vector<double> radii, origin, axis, toward;
};

double needed(const std::optional<double>& value, const QuadricArguments& o, std::string_view option) {
    if (!value) wrong_usage(text(o.kind, " needs ", option));
    return *value;
}

Result<FoundFrame> frame_of(const QuadricArguments& o) {
    FoundFrame frame;
    if (!o.origin.empty()) frame.origin = parse_vector("--origin", o.origin);
    if (o.axis.empty() && o.toward.empty()) return frame;
    return frame_about(frame.origin, o.axis.empty() ? frame.z : parse_vector("--axis", o.axis),
                       o.toward.empty() ? Vec<3>{} : parse_vector("--toward", o.toward));
}

// A frame whose vectors are as long as the half-axes makes an ellipsoid of the unit sphere.
FoundFrame stretched(FoundFrame f, const std::vector<double>& radii) {
    const auto stretch = [](Vec<3>& v, double& bound, double by) {
        const Vec<3> unit = v;
        v = by * v;
        bound *= by;
        for (int i = 0; i < 3; ++i)
            if (std::fma(by, unit[i], -v[i]) != 0) bound += 0x1p-52 * std::abs(v[i]);
    };
    stretch(f.x, f.x_bound, radii[0]);
    stretch(f.y, f.y_bound, radii[1]);
    stretch(f.z, f.z_bound, radii[2]);
    return f;
}

Turn turn_of(const QuadricArguments& o) {
    Turn turn;
    if (o.angle) turn.angle = {0, *o.angle / 180 * std::numbers::pi};  // in this order, 360 gives 2 pi
    turn.form = o.form == "closed"    ? EllipseForm::closed
                : o.form == "quintic" ? EllipseForm::quintic
                                      : EllipseForm::open;
    return turn;
}

Result<void> make(const QuadricArguments& o, MadeSurfaces& made) {
    const auto frame = frame_of(o);
    if (!frame) return std::unexpected(frame.error());
    const Turn turn = turn_of(o);
    const auto one = [&](Result<RoundSurface> s) -> Result<void> {
        if (!s) return std::unexpected(s.error());
        made.add(o.kind, std::move(s->surface), s->bound);
        return {};
    };
    const auto several = [&](auto parts, auto&& member) -> Result<void> {
        if (!parts) return std::unexpected(parts.error());
        int i = 0;
        for (auto& part : (*parts).*member) made.add(text(o.kind, ".", i++), std::move(part), parts->bound);
        return {};
    };
    if (o.kind == "ellipsoid")
        return one(sphere(stretched(*frame, parse_numbers("--radii", o.radii, 3)), 1, turn));
    const double radius = needed(o.radius, o, "--radius");
    if (o.kind == "sphere") return one(sphere(*frame, radius, turn));
    if (o.kind == "sphere-in-six") return several(sphere_in_six(*frame, radius), &SphereInSix::faces);
    if (o.kind == "sphere-in-eight") return several(sphere_in_eight(*frame, radius), &SphereInEight::octants);
    if (o.kind == "torus") return one(torus(*frame, radius, needed(o.tube, o, "--tube"), turn));
    const Interval height{0, needed(o.height, o, "--height")};
    if (o.kind == "cylinder") return one(cylinder(*frame, radius, height, turn));
    return one(cone(*frame, radius, o.top.value_or(0), height, turn));
}

Result<void> run_quadric(const Context& context, const QuadricArguments& options) {
    const std::string format = spline_format(context, "quadric");
    MadeSurfaces made{{}, 0, text("the exact ", options.kind), {}};
    if (auto ok = make(options, made); !ok) {
        if (ok.error().kind == RefusalKind::invalid)  // there is no input but the options
            wrong_usage(text(ok.error().where, ": ", ok.error().message));
        return ok;
    }
    return emit_surfaces(context, format, std::move(made));
}

}  // namespace

void add_quadric(CommandLine& line) {
    const auto options = std::make_shared<QuadricArguments>();
    const Command command =
        line.add("quadric", "Spheres, ellipsoids, cylinders, cones and tori, exact (rational)",
                 "  freiform quadric sphere --radius 2 -o ball.json\n"
                 "  freiform quadric sphere-in-six --radius 2 -o tiles.json\n"
                 "  freiform quadric cone --radius 2 --top 1 --height 3 --axis 0,1,0 -o cup.json\n"
                 "  freiform quadric torus --radius 3 --tube 1 --angle 180 -o half.json\n"
                 "  freiform quadric ellipsoid --radii 3,2,1 -o pebble.json\n"
                 "sphere-in-six has no poles; sphere-in-eight are triangles, an octant each. The others turn "
                 "about the axis.");
    command.word("KIND", options->kind, "What to make")
        .one_of({"sphere", "sphere-in-six", "sphere-in-eight", "cylinder", "cone", "torus", "ellipsoid"})
        .required();
    command.positive("--radius", options->radius, "Of a cone at its foot; of a torus that of its ring");
    command.numbers("--radii", options->radii, "Half-axes of an ellipsoid").shown_as("X,Y,Z");
    command.number("--top", options->top, "Radius of a cone at its top (default 0, an apex)");
    command.positive("--tube", options->tube, "Radius of the tube of a torus");
    command.number("--height", options->height, "Of a cylinder or cone, from the origin along the axis");
    command.number("--angle", options->angle, "Degrees of the turn about the axis (default 360)");
    command
        .word("--form", options->form,
              "Of a full turn: nine columns (default), eight on closed knots, or one piece")
        .one_of({"open", "closed", "quintic"});
    command.numbers("--origin", options->origin, "The centre, or where the axis begins").shown_as("X,Y,Z");
    command.numbers("--axis", options->axis, "Direction of the axis (default 0,0,1)").shown_as("X,Y,Z");
    command.numbers("--toward", options->toward, "Where the turn begins").shown_as("X,Y,Z");
    command.output("Where the surfaces go (.json, .bpt, .step, .obj)");
    command.limits();
    command.action(options, run_quadric);
}

}  // namespace freiform::cli
