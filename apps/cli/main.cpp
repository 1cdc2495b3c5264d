// The program: understands the arguments, runs one command, turns its refusal into a message and an exit
// code.
#include "command.hpp"
#include "signals.hpp"

#include <freiform/core/spelling.hpp>

namespace freiform::cli {
namespace {

constexpr int kWrongUsage = 2;

void add_commands(CLI::App& app, Context& context) {
    add_info(app, context);
    add_eval(app, context);
    add_basis(app, context);
    add_convert(app, context);
    add_tessellate(app, context);
    add_bounds(app, context);
    add_features(app, context);
    add_draw(app, context);
    add_conic(app, context);
    add_implicit(app, context);
    add_continuity(app, context);
    add_inside(app, context);
    add_interpolate(app, context);
    add_flatten(app, context);
    add_length(app, context);
    add_fit(app, context);
    add_gallery(app, context);
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

// A first word that is no command: CLI11 would only say that it did not expect it.
std::optional<std::string> unknown_command(const CLI::App& app, const std::vector<std::string>& arguments) {
    std::vector<std::string> names;
    for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(c->get_name());
    const std::vector<std::string_view> known(names.begin(), names.end());
    for (const std::string& a : arguments) {
        if (a.starts_with('-')) continue;
        if (std::find(names.begin(), names.end(), a) != names.end()) return std::nullopt;
        return text("there is no command \"", a, "\"", did_you_mean(a, known),
                    " (freiform --help lists them)");
    }
    return std::nullopt;
}

// An option that does not exist, with the one that was meant.
std::string better_message(const CLI::App& app, const CLI::ParseError& e,
                           const std::vector<std::string>& arguments) {
    const auto used = app.get_subcommands();
    const CLI::App& command = used.empty() ? app : *used.front();
    std::vector<std::string> names;
    for (const CLI::Option* o : command.get_options())
        for (const std::string& n : o->get_lnames()) names.push_back("--" + n);
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string help = text(" (freiform ", used.empty() ? "" : command.get_name() + " ", "--help)");
    for (const std::string& a : arguments) {
        const std::string name = a.substr(0, a.find('='));
        if (name.starts_with("--") && name.size() > 2 &&
            std::find(names.begin(), names.end(), name) == names.end())
            return text("there is no option ", name, did_you_mean(name, known), help);
    }
    return text(e.what(), help);
}

int run(std::vector<std::string> arguments) {
    Context context;
    CLI::App app("Free-form curves and surfaces whose answers carry a bound that holds.", "freiform");
    bool show_version = false, verbose = false;
    app.add_flag("--version", show_version, "Print the version");
    app.add_flag("--verbose", verbose, "With --version: compiler and components");
    app.footer(
        "FILE may be - for standard input. freiform COMMAND --help has examples.\n"
        "Exit codes: 0 done, 1 no answer, 2 wrong usage, 3 unreadable or invalid input, 4 a limit was\n"
        "reached, 5 reading or writing failed.");
    app.require_subcommand(0, 1);
    add_commands(app, context);

    context.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    if (const auto message = unknown_command(app, arguments)) return usage_error(context, *message);
    const std::vector<std::string> given = arguments;
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    try {
        app.parse(arguments);
        if (show_version) {
            const auto ok = emit({}, version(verbose));
            return ok ? 0 : report(context, "io", ok.error(), exit_code(ok.error().kind));
        }
        if (!context.action) return usage_error(context, "which command? freiform --help lists them");
        enforce(context);
        const auto done = context.action();
        return done ? 0
                    : report(context, name_of(done.error().kind), done.error(), exit_code(done.error().kind));
    } catch (const CLI::CallForHelp&) {
        const auto used = app.get_subcommands();
        (void)emit({}, used.empty() ? app.help() : used.front()->help());
        return 0;
    } catch (const CLI::CallForAllHelp&) {
        (void)emit({}, app.help("", CLI::AppFormatMode::All));
        return 0;
    } catch (const CLI::ValidationError& e) {
        return usage_error(context, e.what());
    } catch (const CLI::ParseError& e) {
        return usage_error(context, better_message(app, e, given));
    } catch (const std::exception& e) {  // of a dependency; the library throws nothing
        return report(context, "limit", {RefusalKind::limit, "", e.what()}, exit_code(RefusalKind::limit));
    }
}

}  // namespace
}  // namespace freiform::cli

int main(int argc, char** argv) {
    freiform::cli::catch_signals();
    return freiform::cli::run({argv + std::min(argc, 1), argv + argc});
}
