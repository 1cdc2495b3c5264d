// The one file that knows CLI11: what the user typed, the options of the commands, and the sentences about
// wrong usage that CLI11 would say less well.
#include "command.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>

#include <CLI/CLI.hpp>
#include <algorithm>

namespace freiform::cli {

namespace {

double above_zero(const std::string& option, const std::string& s) {
    const auto x = scan_number<double>(s);
    if (!x || !(*x > 0)) wrong_usage(text(option, " needs a positive number, found \"", s, "\""));
    return *x;
}

// "500M": bytes with an optional K, M, G (powers of 1024).
std::uint64_t bytes(const std::string& option, std::string_view s) {
    double unit = 1;
    const std::string_view units = "KMGkmg";
    if (!s.empty())
        if (const std::size_t i = units.find(s.back()); i != std::string_view::npos) {
            for (std::size_t k = 0; k <= i % 3; ++k) unit *= 1024;
            s.remove_suffix(1);
        }
    const auto x = scan_number<double>(s);
    if (!x || !(*x * unit >= 1) || *x * unit > 9e18)
        wrong_usage(text(option, " needs a number of bytes such as 500M, found \"", s, "\""));
    return std::uint64_t(*x * unit);
}

void append_numbers(std::vector<double>& values, const std::string& option, std::string_view rest) {
    do {
        const std::string_view part = trimmed(next_part(rest, ','));
        const auto x = scan_number<double>(part);
        if (!x) wrong_usage(text(option, " needs numbers separated by commas, found \"", part, "\""));
        values.push_back(*x);
    } while (!rest.empty());
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

}  // namespace

// One option
// -------------------------------------------------------------------------------------------------

Option Option::required() const {
    option_->required();
    return *this;
}
Option Option::shown_as(std::string_view value) const {
    option_->type_name(std::string(value));
    return *this;
}
Option Option::one_of(std::initializer_list<std::string_view> words) const {
    option_->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())));
    return *this;
}

// Options of a command
// ---------------------------------------------------------------------------------------

// Numbers are understood here: CLI11's own conversions depend on the locale.
Option Command::use(std::string_view name, Use&& use, std::string_view help,
                    std::string_view shown_as) const {
    CLI::Option* option =
        app_->add_option_function<std::string>(std::string(name), std::move(use), std::string(help));
    return Option(*option).shown_as(shown_as);
}

Option Command::flag(std::string_view name, bool& value, std::string_view help) const {
    return Option(*app_->add_flag(std::string(name), value, std::string(help)));
}
Option Command::word(std::string_view name, std::string& value, std::string_view help) const {
    return Option(*app_->add_option(std::string(name), value, std::string(help)));
}
Option Command::words(std::string_view name, std::vector<std::string>& values, std::string_view help) const {
    return Option(*app_->add_option(std::string(name), values, std::string(help)));
}

Option Command::number(std::string_view name, std::optional<double>& value, std::string_view help) const {
    const auto read = [&value, name = std::string(name)](const std::string& s) {
        value = scan_number<double>(s);
        if (!value) wrong_usage(text(name, " needs a number, found \"", s, "\""));
    };
    return use(name, read, help, "NUMBER");
}

Option Command::positive(std::string_view name, std::optional<double>& value, std::string_view help) const {
    const auto read = [&value, name = std::string(name)](const std::string& s) {
        value = above_zero(name, s);
    };
    return use(name, read, help, "NUMBER");
}

Option Command::optional_value(std::string_view name, std::function<void(const std::string&)> read,
                               std::string_view help, std::string_view shown_as) const {
    CLI::Option* option =
        app_->add_option_function<std::string>(std::string(name), std::move(read), std::string(help));
    option->expected(0, 1);
    return Option(*option).shown_as(shown_as);
}

Option Command::count(std::string_view name, std::optional<int>& value, int least, int most,
                      std::string_view help) const {
    const auto read = [&value, name = std::string(name), least, most](const std::string& s) {
        value = scan_number<int>(s);
        if (!value || *value < least || *value > most)
            wrong_usage(
                text(name, " needs a whole number from ", least, " to ", most, ", found \"", s, "\""));
    };
    return use(name, read, help, "N");
}

Option Command::numbers(std::string_view name, std::vector<double>& values, std::string_view help) const {
    const auto read = [&values, name = std::string(name)](const std::string& s) {
        append_numbers(values, name, s);
    };
    return use(name, read, help, "NUMBER,...");
}

Option Command::file(std::string& value) const {
    return word("FILE", value, "The file; - is standard input").required();
}
Option Command::points_file(std::string& value) const {
    return word("POINTS", value, "The file with the points; - is standard input").required();
}
Option Command::object(std::string& value) const {
    return word("--object", value, "Only the object of this name or index").shown_as("NAME|INDEX");
}
void Command::answer_file() const {
    word("-o,--output", context_->output, "Where the answer goes").shown_as("FILE");
}
void Command::output(std::string_view what) const {
    word("-o,--output", context_->output, text(what, "; - is standard output")).shown_as("FILE");
    word("--to", context_->to, "Format of the output, if its name does not say it").shown_as("FORMAT");
}

void Command::limits() const {
    Limits& limits = context_->limits;
    use(
        "--timeout", [&limits](const std::string& s) { limits.timeout = above_zero("--timeout", s); },
        "Stop after this many seconds", "SECONDS");
    use(
        "--max-memory", [&limits](const std::string& s) { limits.max_memory = bytes("--max-memory", s); },
        "Stop when more memory would be needed, such as 500M or 4G", "BYTES");
    word("--reader", limits.reader,
         "What reads STEP files: freiform (default), or Open CASCADE in a process of its own")
        .shown_as("READER")
        .one_of({"freiform", "occt"});
    flag(
        "--repair", limits.repair,
        "Make right what is wrong in a STEP file beyond its own tolerance, and say what was done; without it "
        "faces are refused for it, or, if only their loops run the wrong way, told");
    positive("--repair-limit", limits.repair_limit,
             "The longest gap that --repair closes, in the file's unit (default: a hundredth of the face)");
}

void Command::triangle_limit() const {
    const auto read = [&limits = context_->limits](const std::string& s) {
        const auto n = scan_number<std::uint64_t>(s);
        if (!n) wrong_usage(text("--max-triangles needs a whole number, found \"", s, "\""));
        limits.max_triangles = *n;
    };
    use("--max-triangles", read,
        text("Refuse to make more triangles than this (", context_->limits.max_triangles, ")"), "N");
}

void Command::act(std::function<Result<void>(Context&)>&& run) const {
    app_->callback([&context = *context_, run = std::move(run)] {
        context.action = [&context, run] { return run(context); };
    });
}

// The program
// ------------------------------------------------------------------------------------------------

CommandLine::CommandLine(Context& context, std::string_view name, std::string_view description,
                         std::string_view footer)
    : context_(context), app_(std::make_unique<CLI::App>(std::string(description), std::string(name))) {
    app_->footer(std::string(footer));
    app_->require_subcommand(0, 1);
}
CommandLine::~CommandLine() = default;

Command CommandLine::program() const { return {*app_, context_}; }

Command CommandLine::add(std::string_view name, std::string_view description, std::string_view examples) {
    CLI::App* app = app_->add_subcommand(std::string(name), std::string(description));
    app->footer(text("Examples:\n", examples));
    const Command command(*app, context_);
    command.flag("--json", context_.json, "Print the result, or the refusal, as one JSON object");
    return command;
}

std::expected<std::string, std::string> CommandLine::understand(std::vector<std::string> arguments) {
    if (auto message = unknown_command(*app_, arguments)) return std::unexpected(*std::move(message));
    const std::vector<std::string> given = arguments;
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    try {
        app_->parse(arguments);
        return "";
    } catch (const CLI::CallForHelp&) {
        const auto used = app_->get_subcommands();
        return used.empty() ? app_->help() : used.front()->help(app_->get_name());
    } catch (const CLI::CallForAllHelp&) {
        return app_->help("", CLI::AppFormatMode::All);
    } catch (const CLI::ValidationError& e) {
        return std::unexpected(e.what());
    } catch (const CLI::ParseError& e) {
        return std::unexpected(better_message(*app_, e, given));
    }
}

}  // namespace freiform::cli
