// What the commands share. A command is one file with one function,
//
//     void add_NAME(CLI::App& app, Context& context);
//
// declared below and called by main.cpp. It describes its options and leaves an action, which main runs after
// all arguments have been understood: an answer goes through `emit`, a refusal is returned, wrong usage is
// thrown with `wrong_usage`.
#pragma once
#include <freiform/io/json.hpp>
#include <freiform/io/read.hpp>

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

namespace freiform::cli {

struct Limits {
    double timeout = 0;            // seconds, 0: none
    std::uint64_t max_memory = 0;  // bytes, 0: none
    std::uint64_t max_triangles = 20'000'000;
};

struct Context {
    bool json = false;
    std::string output;  // -o; empty or "-": standard output
    std::string to;      // --to; empty: the ending of `output` decides
    Limits limits;
    std::function<Result<void>()> action;

    ReadOptions read_options() const;
};

void add_info(CLI::App& app, Context& context);
void add_eval(CLI::App& app, Context& context);
void add_basis(CLI::App& app, Context& context);
void add_convert(CLI::App& app, Context& context);
void add_tessellate(CLI::App& app, Context& context);
void add_bounds(CLI::App& app, Context& context);
void add_features(CLI::App& app, Context& context);
void add_draw(CLI::App& app, Context& context);
void add_conic(CLI::App& app, Context& context);
void add_implicit(CLI::App& app, Context& context);
void add_continuity(CLI::App& app, Context& context);
void add_inside(CLI::App& app, Context& context);
void add_interpolate(CLI::App& app, Context& context);
void add_flatten(CLI::App& app, Context& context);
void add_length(CLI::App& app, Context& context);
void add_fit(CLI::App& app, Context& context);
void add_gallery(CLI::App& app, Context& context);

// A subcommand with its description and examples (lines that begin with "freiform ..."), and --json.
CLI::App* add_command(CLI::App& app, Context& context, const std::string& name,
                      const std::string& description, const std::string& examples);
void add_output(CLI::App& command, Context& context, const std::string& what);  // -o and --to
void add_limits(CLI::App& command, Context& context);                           // --timeout and --max-memory
void add_triangle_limit(CLI::App& command, Context& context);                   // --max-triangles

// Options that hold a number. Not CLI11's own conversions: those depend on the locale.
CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& value,
                        const std::string& help);
CLI::Option* add_count(CLI::App& command, const std::string& name, std::optional<int>& value, int least,
                       int most, const std::string& help);
// Numbers separated by commas.
CLI::Option* add_numbers(CLI::App& command, const std::string& name, std::vector<double>& values,
                         const std::string& help);

[[noreturn]] void wrong_usage(const std::string& message);

// The result, to `context.output` or standard output: the only way anything gets there.
Result<void> emit(const Context& context, std::string_view bytes);
// A remark for people, on standard error.
void remark(std::string_view message);

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
