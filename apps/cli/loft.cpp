// loft, coons: surfaces through curves.
#include "point_commands.hpp"
#include "surface_commands.hpp"

#include <freiform/fit/loft.hpp>
#include <freiform/make/coons.hpp>

namespace freiform::cli {

namespace {

struct Lofting {
    std::string file, object, spacing = "chordal", ends = "natural";
    std::optional<int> degree;
    bool closed = false;
};

Result<void> lofted(const Context& context, const Lofting& options) {
    const std::string format = spline_format(context, "loft");
    const auto curves = read_space_curves(context, options.file, options.object, "lofted");
    if (!curves) return std::unexpected(curves.error());
    LoftOptions how;
    how.degree = options.degree.value_or(3);
    how.spacing = options.spacing == "uniform"   ? Spacing::uniform
                  : options.spacing == "chordal" ? Spacing::chordal
                                                 : Spacing::centripetal;
    how.ends = options.ends == "natural" ? SplineEnds::natural : SplineEnds::not_a_knot;
    how.closed = options.closed;
    MadeSurfaces made{{curves->unit, {}}, 0, "the sections", {}};
    const auto ok = curves->visit([&](const auto& all) -> Result<void> {
        auto s = loft(all, how);
        if (!s) return refuse_within(shown(options.file), s.error());
        made.add("", std::move(s->surface), s->bound);
        made.said.emplace_back("continuity", s->continuity);
        return {};
    });
    if (!ok) return ok;
    return emit_surfaces(context, format, std::move(made));
}

struct Patching {
    std::string file;
    std::vector<double> at_u, at_v;
    std::optional<double> tolerance, tangent_tolerance, twist_tolerance;
    bool bicubic = false;
};

template <class P>
Result<void> coons_patch(std::span<const Curve<P>> c, double tolerance, MadeSurfaces& made) {
    auto s = coons(c[0], c[1], c[2], c[3], tolerance);
    if (!s) return std::unexpected(s.error());
    made.add("", std::move(s->surface), s->bound);
    made.said.emplace_back("corner_gap", s->corner_gap);
    return {};
}
template <class P>
Result<void> bicubic_patch(std::span<const Curve<P>> c, const Patching& o, MadeSurfaces& made) {
    const auto edge = [&](std::size_t i) { return CoonsEdge<P>{c[i], c[4 + i]}; };
    auto s = coons_bicubic(
        edge(0), edge(1), edge(2), edge(3),
        {o.tolerance.value_or(0), o.tangent_tolerance.value_or(0), o.twist_tolerance.value_or(0)});
    if (!s) return std::unexpected(s.error());
    made.add("", std::move(s->surface), s->bound);
    made.said.emplace_back("corner_gap", s->corner_gap);
    made.said.emplace_back("tangent_gap", s->tangent_gap);
    made.said.emplace_back("twist_gap", s->twist_gap);
    return {};
}
template <class P>
Result<void> gordon_surface(std::span<const Curve<P>> c, const Patching& o, double tolerance,
                            MadeSurfaces& made) {
    const std::size_t n = o.at_v.size();
    auto s = gordon(c.first(n), std::span<const double>(o.at_v), c.subspan(n),
                    std::span<const double>(o.at_u), tolerance);
    if (!s) return std::unexpected(s.error());
    made.add("", std::move(s->surface), s->bound);
    made.said.emplace_back("gap", s->gap);
    return {};
}

Result<void> patched(const Context& context, const Patching& options) {
    const bool network = !options.at_u.empty() || !options.at_v.empty();
    if (network && (options.at_u.empty() || options.at_v.empty()))
        wrong_usage("a network needs both --at-u and --at-v");
    if (network && options.bicubic) wrong_usage("--bicubic is for a patch, --at-u and --at-v for a network");
    if (!options.bicubic && (options.tangent_tolerance || options.twist_tolerance))
        wrong_usage("--tangent-tolerance and --twist-tolerance are for --bicubic");
    const std::string format = spline_format(context, "coons");
    const auto curves = read_space_curves(
        context, options.file,
        network           ? options.at_u.size() + options.at_v.size()
        : options.bicubic ? 8
                          : 4,
        network           ? "expected for --at-v and --at-u"
        : options.bicubic ? "expected for --bicubic: u0, u1, v0, v1 and the derivatives across"
                          : "expected for a patch: u0, u1, v0, v1");
    if (!curves) return std::unexpected(curves.error());
    MadeSurfaces made{
        {curves->unit, {}}, 0, network ? "the curves of the network" : "the exact Coons patch", {}};
    const double tolerance = options.tolerance.value_or(0);
    const auto ok = curves->visit([&](const auto& all) -> Result<void> {
        auto done = network           ? gordon_surface(all, options, tolerance, made)
                    : options.bicubic ? bicubic_patch(all, options, made)
                                      : coons_patch(all, tolerance, made);
        if (!done) return refuse_within(shown(options.file), done.error());
        return done;
    });
    if (!ok) return ok;
    return emit_surfaces(context, format, std::move(made));
}

}  // namespace

void add_loft(CommandLine& line) {
    const auto options = std::make_shared<Lofting>();
    const Command command =
        line.add("loft", "A surface through sections",
                 "  freiform loft frames.json -o hull.json\n"
                 "  freiform loft rings.json --closed --spacing centripetal -o ring.json");
    command.word("FILE", options->file, "Curves, in their order; - is standard input").required();
    command.count("--degree", options->degree, 1, 25, "Across the sections (default 3)");
    command.word("--spacing", options->spacing, "Of the sections (default chordal)")
        .one_of({"uniform", "chordal", "centripetal"});
    command.word("--ends", options->ends, "Across the sections, at both ends (default natural)")
        .one_of({"natural", "not-a-knot"});
    command.flag("--closed", options->closed, "The last section is followed by the first");
    command.object(options->object);
    command.output("Where the surface goes (.json, .bpt, .step, .obj)");
    command.limits();
    command.action(options, lofted);
}

void add_coons(CommandLine& line) {
    const auto options = std::make_shared<Patching>();
    const Command command = line.add(
        "coons", "A surface of its four boundaries, or of a network of curves (Gordon)",
        "  freiform coons four-curves.json --tolerance 1e-9 -o patch.json\n"
        "  freiform coons net.json --at-v 0,0.5,1 --at-u 0,1,2 --tolerance 1e-6 -o surface.json\n"
        "A file of four curves has them in this order: along u at the lower and the upper end of v,\n"
        "along v at the lower and the upper end of u. A network: all curves along u first. --bicubic: after\n"
        "the four boundaries the derivative of the surface across each of them, as curves; by v along u, by "
        "u\n"
        "along v.");
    command.word("FILE", options->file, "Curves; - is standard input").required();
    command.numbers("--at-v", options->at_v, "Where the curves along u are").shown_as("V,V,...");
    command.numbers("--at-u", options->at_u, "Where the curves along v are").shown_as("U,U,...");
    command.number("--tolerance", options->tolerance,
                   "What curves that should meet may be apart (default 0)");
    command.flag("--bicubic", options->bicubic, "Blend with the derivatives across the boundaries as well");
    command.number("--tangent-tolerance", options->tangent_tolerance,
                   "By what tangents and derivatives may differ at corners (--bicubic, default 0)");
    command.number("--twist-tolerance", options->twist_tolerance,
                   "By what twists may differ at corners (--bicubic, default 0)");
    command.output("Where the surface goes (.json, .bpt, .step, .obj)");
    command.limits();
    command.action(options, patched);
}

}  // namespace freiform::cli
