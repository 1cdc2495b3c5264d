// sweep: a profile moved along a rail.
#include "point_commands.hpp"
#include "regions.hpp"
#include "surface_commands.hpp"

#include <freiform/make/frame_sweep.hpp>
#include <freiform/make/sweep.hpp>

namespace freiform::cli {

namespace {

struct SweepArguments {
    std::string profile, rail, object;
    std::optional<double> tolerance;
    std::vector<double> x;
    bool translate = false, solid = false;

    FrameSweepOptions frame(double within) const {
        return {within, x.empty() ? Vec<3>{} : parse_direction("--x", x)};
    }
};

// z of the profile is 0: the frame has no third direction for it.
template <class Q, class P>
std::optional<Curve<Q>> flattened(const Curve<P>& c) {
    std::vector<Q> net;
    for (const P& p : c.net().flat()) {
        if (p[2] != 0) return std::nullopt;
        Q q{};
        q[0] = p[0], q[1] = p[1];
        if constexpr (Space<Q>::kRational) q[2] = p.weight();
        net.push_back(q);
    }
    return Curve<Q>::trusted(c.bases(), Net<1, Q>(c.net().extent(), std::move(net)));
}

template <class P>
using InPlane = std::conditional_t<Space<P>::kRational, Hom<2>, Vec<2>>;

// Of triangles, half of the tolerance is theirs and half that of the walls.
Result<void> sweep_solid(const Context& context, const SweepArguments& options) {
    SolidOutput output = solid_output(context, "sweep --solid", options.tolerance);
    const auto region = read_region(context, options.profile, options.object);
    if (!region) return std::unexpected(region.error());
    const auto rail = read_space_curves(context, options.rail, 1, "taken as rail");
    if (!rail) return std::unexpected(rail.error());
    const double share = *options.tolerance / (output.is_mesh() ? 2 : 1);
    if (output.is_mesh()) output.tolerance = share;
    auto made = rail->visit(
        [&](const auto& along) { return solid_along(region->loops, along[0], options.frame(share)); });
    if (!made) return refuse_within(shown(options.profile), made.error());
    const std::pair<std::string, double> said[] = {{"pieces", double(made->pieces)},
                                                   {"wall_bound", made->bound}};
    return emit_swept(context, output, options.profile, region->unit, std::move(made->model), said);
}

Result<void> run_sweep(const Context& context, const SweepArguments& options) {
    if (options.translate == options.tolerance.has_value())
        wrong_usage("either --tolerance (the profile turns with the rail) or --translate (it does not)");
    if (options.translate && !options.x.empty()) wrong_usage("--x is for profiles that turn");
    if (options.translate && options.solid) wrong_usage("--solid is for profiles that turn");
    if (options.solid) return sweep_solid(context, options);
    const std::string format = spline_format(context, "sweep");
    const auto profiles = read_space_curves(context, options.profile, options.object, "swept");
    if (!profiles) return std::unexpected(profiles.error());
    const auto rail = read_space_curves(context, options.rail, 1, "taken as rail");
    if (!rail) return std::unexpected(rail.error());
    MadeSurfaces made{{profiles->unit, {}}, 0, "the swept surface", {}};
    const FrameSweepOptions how = options.frame(options.tolerance.value_or(0));
    int pieces = 0;
    const auto framed = [&](const auto& all, const auto& along) -> Result<void> {
        using P = typename std::remove_cvref_t<decltype(all[0])>::Coefficients;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto flat = flattened<InPlane<P>>(all[i]);
            if (!flat)
                return refuse(
                    RefusalKind::no_answer, profiles->labels[i],
                    "is not in the plane z = 0, in which profiles are given that turn with the rail");
            auto s = sweep(*flat, along, how);
            if (!s) return refuse_within(profiles->labels[i], s.error());
            made.add(profiles->names[i], std::move(s->surface), s->bound);
            pieces += s->pieces;
        }
        return {};
    };
    Result<void> ok;
    if (options.translate) {
        SpaceCurves both = *profiles;  // of one kind with the rail
        both.rational.push_back(rail->rational[0]);
        if (!rail->polynomial.empty()) both.polynomial.push_back(rail->polynomial[0]);
        ok = both.visit([&](const auto& all) -> Result<void> {
            for (std::size_t i = 0; i + 1 < all.size(); ++i) {
                auto s = translate_along(all[i], all.back());
                if (!s) return refuse_within(profiles->labels[i], s.error());
                made.add(profiles->names[i], std::move(s->surface), s->bound);
            }
            return {};
        });
    } else {
        ok = profiles->visit([&](const auto& all) {
            return rail->visit([&](const auto& along) { return framed(all, along[0]); });
        });
        made.said.emplace_back("pieces", pieces);
    }
    if (!ok) return ok;
    return emit_surfaces(context, format, std::move(made));
}

}  // namespace

void add_sweep(CommandLine& line) {
    const auto options = std::make_shared<SweepArguments>();
    const Command command = line.add(
        "sweep", "Surfaces that profiles sweep along a rail; solids that regions do",
        "  freiform sweep profile.json --rail rail.json --tolerance 0.001 -o pipe.json\n"
        "  freiform sweep profile.json --rail rail.json --translate -o surface.json\n"
        "  freiform sweep drawing.svg --rail rail.json --tolerance 0.01 --solid -o pipe.stl\n"
        "Profiles that turn with the rail are plane curves (x, y); they stay orthogonal to the rail and "
        "do\nnot turn about it. With --solid closed ones bound a region, and those inside others are holes.");
    command.word("FILE", options->profile, "Profiles; - is standard input").required();
    command.word("--rail", options->rail, "The file of one curve").required();
    command.positive("--tolerance", options->tolerance, "What the surface may be off; the bound is printed");
    command.numbers("--x", options->x, "Where x of the profile points to at the start of the rail")
        .shown_as("X,Y,Z");
    command.flag("--translate", options->translate, "Move profiles without turning them: exact");
    command.flag("--solid", options->solid, "The solid that the region inside of the profiles sweeps");
    command.object(options->object);
    command.output(
        "Where the surfaces go (.json, .bpt, .step, .obj); solids: .json, .step, .iges, .glb, .stl, .obj, "
        ".ply");
    command.triangle_limit();
    command.limits();
    command.action(options, run_sweep);
}

}  // namespace freiform::cli
