// What the commands share. A command is one file with one function,
//
//     void add_NAME(CommandLine& line);
//
// declared below and called by main.cpp. It describes its options and leaves an action, which main runs after
// all arguments have been understood: an answer goes through `emit`, a refusal is returned, wrong usage is
// thrown with `wrong_usage`.
//
//     const auto options = std::make_shared<Options>();
//     Command command = line.add("length", "Arc length", "  freiform length curve.json");
//     command.file(options->file);
//     command.number("--accuracy", options->accuracy, "What the length may be off");
//     command.object(options->object);
//     command.action(options, run);  // Result<void> run(const Context&, const Options&)
//
// CLI11 is known to command_line.cpp alone: it is one header of templates, which every file that includes it
// parses and compiles again.
#pragma once
#include <freiform/io/json.hpp>
#include <freiform/io/read.hpp>

#include <expected>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace freiform::cli {

struct Limits {
    double timeout = 0;            // seconds, 0: none
    std::uint64_t max_memory = 0;  // bytes, 0: none
    std::string reader;            // of STEP files: "occt", else the library
    bool repair = false;           // of STEP files, by the library's reader
    std::optional<double> repair_limit;
    std::uint64_t max_triangles = 20'000'000;
};

struct Context {
    bool json = false;
    std::string output;  // -o; empty or "-": standard output
    std::string to;      // --to; empty: the ending of `output` decides
    Limits limits;
    bool in_part = false;  // the action was done but for what its report names as refused: exit code 1
    std::function<Result<void>()> action;

    ReadOptions read_options() const;
};

// What has just been added to a command, to say more about it.
class Option {
public:
    explicit Option(CLI::Option& option) : option_(&option) {}
    Option required() const;
    Option shown_as(std::string_view value) const;  // what --help calls its value: "NUMBER"
    Option one_of(std::initializer_list<std::string_view> words) const;

private:
    CLI::Option* option_;
};

// Describes one command. A handle: copies mean the same command. Values must live until the action has run;
// names are "--name", "-n,--name", or "NAME" for an argument without a name.
class Command {
public:
    Command(CLI::App& app, Context& context) : app_(&app), context_(&context) {}
    Context& context() const { return *context_; }

    Option flag(std::string_view name, bool& value, std::string_view help) const;
    Option word(std::string_view name, std::string& value, std::string_view help) const;
    // All words up to the next option.
    Option words(std::string_view name, std::vector<std::string>& values, std::string_view help) const;
    Option number(std::string_view name, std::optional<double>& value, std::string_view help) const;
    Option positive(std::string_view name, std::optional<double>& value, std::string_view help) const;
    Option count(std::string_view name, std::optional<int>& value, int least, int most,
                 std::string_view help) const;
    // The value may be left out where another option follows, or nothing; it is empty then.
    Option optional_value(std::string_view name, std::function<void(const std::string&)> read,
                          std::string_view help, std::string_view shown_as) const;
    // Separated by commas.
    Option numbers(std::string_view name, std::vector<double>& values, std::string_view help) const;

    // What many commands have, with the same words.
    Option file(std::string& value) const;         // FILE, required
    Option points_file(std::string& value) const;  // POINTS, required
    Option object(std::string& value) const;       // --object
    void answer_file() const;                      // -o for the answer
    void output(std::string_view what) const;      // -o and --to for a file that is made
    void limits() const;                           // --timeout, --max-memory and --reader
    void triangle_limit() const;                   // --max-triangles

    // What the command does: run(context, options), where the context may be const.
    template <class Options, class C>
    void action(std::shared_ptr<Options> options, Result<void> (*run)(C&, const Options&)) const {
        act([run, options = std::move(options)](Context& context) { return run(context, *options); });
    }

private:
    using Use = std::function<void(const std::string&)>;
    Option use(std::string_view name, Use&& use, std::string_view help, std::string_view shown_as) const;
    void act(std::function<Result<void>(Context&)>&& run) const;

    CLI::App* app_;
    Context* context_;
};

// The program with its commands, and the only thing that knows what the user typed.
class CommandLine {
public:
    CommandLine(Context& context, std::string_view name, std::string_view description,
                std::string_view footer);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    Command program() const;  // options without a command
    // A command with its description and examples (lines that begin with "freiform ..."), and --json.
    Command add(std::string_view name, std::string_view description, std::string_view examples);
    Context& context() const { return context_; }

    // Sets all values. Returns the help, if it was asked for, else nothing; the error is a message about
    // wrong usage.
    std::expected<std::string, std::string> understand(std::vector<std::string> arguments);

private:
    Context& context_;
    std::unique_ptr<CLI::App> app_;
};

void add_info(CommandLine& line);
void add_eval(CommandLine& line);
void add_basis(CommandLine& line);
void add_convert(CommandLine& line);
void add_tessellate(CommandLine& line);
void add_check(CommandLine& line);
void add_bounds(CommandLine& line);
void add_features(CommandLine& line);
void add_distance(CommandLine& line);
void add_draw(CommandLine& line);
void add_conic(CommandLine& line);
void add_implicit(CommandLine& line);
void add_continuity(CommandLine& line);
void add_inside(CommandLine& line);
void add_nearest(CommandLine& line);
void add_intersect(CommandLine& line);
void add_section(CommandLine& line);
void add_interpolate(CommandLine& line);
void add_flatten(CommandLine& line);
void add_path(CommandLine& line);
void add_length(CommandLine& line);
void add_fit(CommandLine& line);
void add_ease(CommandLine& line);
void add_gradient(CommandLine& line);
void add_animate(CommandLine& line);
void add_revolve(CommandLine& line);
void add_extrude(CommandLine& line);
void add_ruled(CommandLine& line);
void add_sweep(CommandLine& line);
void add_loft(CommandLine& line);
void add_coons(CommandLine& line);
void add_quadric(CommandLine& line);
void add_gallery(CommandLine& line);
void add_text(CommandLine& line);
void add_font(CommandLine& line);
void add_view(CommandLine& line);

// Of `wrong_usage`; nothing else is thrown.
class WrongUsage : public std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] void wrong_usage(const std::string& message);
// Wrong usage where all numbers of a direction are 0.
void require_direction(std::string_view option, std::span<const double> direction);

// The result, to `context.output` or standard output: the only way anything gets there.
Result<void> emit(const Context& context, std::string_view bytes);
// A remark for people, on standard error.
void remark(std::string_view message);
// The same where a unit is none that files of a format could name.
void remark_unknown_unit(std::string_view unit, std::string_view format);

// What a reader was asked to make right: "#12 EDGE_LOOP: ... (0.01)".
std::string repair_text(const Repair& r);
void write_repairs(json::Writer& w, const std::vector<Repair>& list);

// What a model says about its approximations: a proven bound is told from an estimate.
void write_approximation(json::Writer& w, const Approximation& a);
std::string approximation_text(const Approximation& a);

// Which objects of a document are meant by --object NAME|INDEX; without it all. Refuses names that do not
// exist.
Result<std::vector<std::size_t>> selected(const Document& document, const std::string& object);

// The name of an input for people: "standard input" for "-".
std::string shown(const std::string& file);

// The exit code of the contract.
int exit_code(RefusalKind kind);

}  // namespace freiform::cli
