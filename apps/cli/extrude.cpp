// extrude, ruled: surfaces of straight lines.
#include "point_commands.hpp"
#include "regions.hpp"
#include "surface_commands.hpp"

#include <freiform/make/sweep.hpp>

namespace freiform::cli {

namespace {

struct Extrusion {
    std::string file, object;
    std::vector<double> by;
    bool solid = false;
    std::optional<double> tolerance;
};

Result<void> extruded(const Context& context, const Extrusion& options) {
    const Vec<3> by = parse_direction("--by", options.by);
    if (options.solid) {
        const SolidOutput output = solid_output(context, "extrude --solid", options.tolerance);
        const auto region = read_region(context, options.file, options.object);
        if (!region) return std::unexpected(region.error());
        return emit_swept(context, output, options.file, region->unit, prism(region->loops, by));
    }
    const std::string format = spline_format(context, "extrude");
    const auto curves = read_space_curves(context, options.file, options.object, "extruded");
    if (!curves) return std::unexpected(curves.error());
    MadeSurfaces made{{curves->unit, {}}, 0, "the extrusions", {}};
    const auto ok = curves->visit([&](const auto& all) -> Result<void> {
        for (std::size_t i = 0; i < all.size(); ++i) {
            auto s = extrude(all[i], by);
            if (!s) return refuse_within(curves->labels[i], s.error());
            made.add(curves->names[i], std::move(s->surface), s->bound);
        }
        return {};
    });
    if (!ok) return ok;
    return emit_surfaces(context, format, std::move(made));
}

struct Ruling {
    std::string file;
};

Result<void> ruled_between(const Context& context, const Ruling& options) {
    const std::string format = spline_format(context, "ruled");
    const auto curves = read_space_curves(context, options.file, 2, "joined by straight lines");
    if (!curves) return std::unexpected(curves.error());
    MadeSurfaces made{{curves->unit, {}}, 0, "the lines between the curves", {}};
    const auto ok = curves->visit([&](const auto& all) -> Result<void> {
        auto s = ruled(all[0], all[1]);
        if (!s) return refuse_within(shown(options.file), s.error());
        made.add("", std::move(s->surface), s->bound);
        return {};
    });
    if (!ok) return ok;
    return emit_surfaces(context, format, std::move(made));
}

}  // namespace

void add_extrude(CommandLine& line) {
    const auto options = std::make_shared<Extrusion>();
    const Command command =
        line.add("extrude", "Surfaces that curves sweep along a vector, exact; solids of regions",
                 "  freiform extrude outline.json --by 0,0,3 -o wall.json\n"
                 "  freiform extrude drawing.svg --by 0,0,3 --solid --tolerance 0.01 -o part.stl\n"
                 "With --solid closed plane curves bound a region, and those inside others are holes.");
    command.word("FILE", options->file, "Curves; - is standard input").required();
    command.numbers("--by", options->by, "How far and whereto").shown_as("X,Y,Z").required();
    command.object(options->object);
    command.flag("--solid", options->solid, "The solid that the region inside of the curves sweeps");
    command.positive("--tolerance", options->tolerance, "The largest distance of triangles from the solid");
    command.output(
        "Where the surfaces go (.json, .bpt, .step, .obj); solids: .json, .step, .iges, .glb, .stl, .obj, "
        ".ply");
    command.triangle_limit();
    command.limits();
    command.action(options, extruded);
}

void add_ruled(CommandLine& line) {
    const auto options = std::make_shared<Ruling>();
    const Command command =
        line.add("ruled", "The surface of straight lines between points of two curves with one parameter",
                 "  freiform ruled two-curves.json -o surface.json");
    command.word("FILE", options->file, "Two curves; - is standard input").required();
    command.output("Where the surface goes (.json, .bpt, .step, .obj)");
    command.limits();
    command.action(options, ruled_between);
}

}  // namespace freiform::cli
