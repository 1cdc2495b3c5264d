#include "program.hpp"

#include "signals.hpp"

#include <freiform/spline/prepared.hpp>

#include <algorithm>

namespace freiform::cli {
namespace {

constexpr int kWrongUsage = 2;

struct NamedCommand {
    std::string_view name;
    void (*add)(CommandLine&);
};
constexpr NamedCommand kCommands[] = {
    {"info", add_info},
    {"eval", add_eval},
    {"basis", add_basis},
    {"convert", add_convert},
    {"tessellate", add_tessellate},
    {"check", add_check},
    {"bounds", add_bounds},
    {"features", add_features},
    {"draw", add_draw},
    {"conic", add_conic},
    {"implicit", add_implicit},
    {"continuity", add_continuity},
    {"inside", add_inside},
    {"nearest", add_nearest},
    {"distance", add_distance},
    {"intersect", add_intersect},
    {"section", add_section},
    {"interpolate", add_interpolate},
    {"flatten", add_flatten},
    {"path", add_path},
    {"length", add_length},
    {"fit", add_fit},
    {"ease", add_ease},
    {"gradient", add_gradient},
    {"animate", add_animate},
    {"revolve", add_revolve},
    {"extrude", add_extrude},
    {"ruled", add_ruled},
    {"sweep", add_sweep},
    {"loft", add_loft},
    {"coons", add_coons},
    {"quadric", add_quadric},
#if !defined(__wasm__)  // no folders, no fonts, no network
    {"gallery", add_gallery},
    {"text", add_text},
    {"font", add_font},
    {"view", add_view},
#endif
};

// The one that is meant, if the first word is one; describing all the others takes longer than many answers.
void add_commands(CommandLine& line, const std::vector<std::string>& arguments) {
    const auto meant = arguments.empty() ? std::end(kCommands)
                                         : std::ranges::find(kCommands, arguments[0], &NamedCommand::name);
    for (const NamedCommand& c : kCommands)
        if (meant == std::end(kCommands) || meant->name == c.name) c.add(line);
}

std::string version(bool verbose) {
    std::string s = "freiform " FREIFORM_VERSION "\n";
    if (!verbose) return s;
#if defined(__clang__)
    s += text("compiler:   clang ", __clang_major__, ".", __clang_minor__, ".", __clang_patchlevel__, "\n");
#else
    s += text("compiler:   g++ ", __GNUC__, ".", __GNUC_MINOR__, ".", __GNUC_PATCHLEVEL__, "\n");
#endif
#if defined(NDEBUG)
    s += "checks:     off\n";
#else
    s += "checks:     on\n";
#endif
    s += text("kernels:    ", instruction_set(), "\n");
#if defined(FREIFORM_HAS_OCCT)
    s += "components: json bpt step iges brep";
#else
    s += "components: json bpt";
#endif
#if defined(FREIFORM_HAS_GL)
    s += " gl";
#endif
#if defined(FREIFORM_HAS_CAIRO)
    s += " cairo";
#endif
#if defined(FREIFORM_HAS_FONT)
    s += " font";
#endif
    return s + "\n";
}

int report(const Context& context, std::string_view kind, const Refusal& r, int code) {
    remark(r.where.empty() ? r.message : text(r.where, ": ", r.message));
    if (!context.json) return code;
    json::Writer w;
    w.begin_object().key("error").begin_object();
    w.field("kind", kind).field("message", r.message).field("where", r.where).end_object().end_object();
    Context to_output;
    (void)emit(to_output, w.take() + "\n");
    return code;
}

int usage_error(const Context& context, const std::string& message) {
    return report(context, "usage", {RefusalKind::invalid, "", message}, kWrongUsage);
}

int perform(CommandLine& line, std::vector<std::string> arguments) {
    const Context& context = line.context();
    bool show_version = false, verbose = false;
    line.program().flag("--version", show_version, "Print the version");
    line.program().flag("--verbose", verbose, "With --version: compiler and components");
    add_commands(line, arguments);
    const auto help = line.understand(std::move(arguments));
    if (!help) return usage_error(context, help.error());
    if (!help->empty() || show_version) {
        const auto ok = emit({}, help->empty() ? version(verbose) : *help);
        return ok ? 0 : report(context, "io", ok.error(), exit_code(ok.error().kind));
    }
    if (!context.action) return usage_error(context, "which command? freiform --help lists them");
    enforce(context);
    const auto done = context.action();
    if (!done) return report(context, name_of(done.error().kind), done.error(), exit_code(done.error().kind));
    return context.in_part ? exit_code(RefusalKind::no_answer) : 0;
}

}  // namespace

int run(std::vector<std::string> arguments) {
    Context context;
    context.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    CommandLine line(
        context, "freiform", "Free-form curves and surfaces whose answers carry a bound that holds.",
        "FILE may be - for standard input. freiform COMMAND --help has examples.\n"
        "Exit codes: 0 done, 1 no answer, or a file without the faces that are told to be refused,\n"
        "2 wrong usage, 3 unreadable or invalid input, 4 a limit was reached, 5 reading or writing failed.");
#if defined(__cpp_exceptions)
    try {
        return perform(line, std::move(arguments));
    } catch (const WrongUsage& e) {
        return usage_error(context, e.what());
    } catch (const std::exception& e) {  // of a dependency; the library throws nothing
        return report(context, "limit", {RefusalKind::limit, "", e.what()}, exit_code(RefusalKind::limit));
    }
#else
    return perform(line, std::move(arguments));
#endif
}

}  // namespace freiform::cli
