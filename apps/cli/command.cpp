#include "command.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>
#include <freiform/io/file.hpp>

#include <cerrno>
#include <cstdlib>
#include <unistd.h>

namespace freiform::cli {

ReadOptions Context::read_options() const {
    ReadOptions o;
    o.timeout = limits.timeout;
    o.max_memory = limits.max_memory;
    if (limits.max_memory != 0) o.max_bytes = std::min(o.max_bytes, limits.max_memory);
    return o;
}

void wrong_usage(const std::string& message) {
    throw CLI::ValidationError(message, CLI::ExitCodes::ValidationError);
}

CLI::App* add_command(CLI::App& app, Context& context, const std::string& name,
                      const std::string& description, const std::string& examples) {
    CLI::App* command = app.add_subcommand(name, description);
    command->footer("Examples:\n" + examples);
    command->add_flag("--json", context.json, "Print the result, or the refusal, as one JSON object");
    return command;
}

void add_output(CLI::App& command, Context& context, const std::string& what) {
    command.add_option("-o,--output", context.output, what + "; - is standard output")->type_name("FILE");
    command.add_option("--to", context.to, "Format of the output, if its name does not say it")
        ->type_name("FORMAT");
}

namespace {

double positive(const std::string& option, const std::string& s) {
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

}  // namespace

void add_limits(CLI::App& command, Context& context) {
    command
        .add_option_function<std::string>(
            "--timeout",
            [&context](const std::string& s) { context.limits.timeout = positive("--timeout", s); },
            "Stop after this many seconds")
        ->type_name("SECONDS");
    command
        .add_option_function<std::string>(
            "--max-memory",
            [&context](const std::string& s) { context.limits.max_memory = bytes("--max-memory", s); },
            "Stop when more memory would be needed, such as 500M or 4G")
        ->type_name("BYTES");
}

void add_triangle_limit(CLI::App& command, Context& context) {
    command
        .add_option_function<std::string>(
            "--max-triangles",
            [&context](const std::string& s) {
                const auto n = scan_number<std::uint64_t>(s);
                if (!n) wrong_usage(text("--max-triangles needs a whole number, found \"", s, "\""));
                context.limits.max_triangles = *n;
            },
            text("Refuse to make more triangles than this (", context.limits.max_triangles, ")"))
        ->type_name("N");
}

CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& value,
                        const std::string& help) {
    return command
        .add_option_function<std::string>(
            name,
            [&value, name](const std::string& s) {
                value = scan_number<double>(s);
                if (!value) wrong_usage(text(name, " needs a number, found \"", s, "\""));
            },
            help)
        ->type_name("NUMBER");
}

CLI::Option* add_count(CLI::App& command, const std::string& name, std::optional<int>& value, int least,
                       int most, const std::string& help) {
    return command
        .add_option_function<std::string>(
            name,
            [&value, name, least, most](const std::string& s) {
                value = scan_number<int>(s);
                if (!value || *value < least || *value > most)
                    wrong_usage(text(name, " needs a whole number from ", least, " to ", most, ", found \"",
                                     s, "\""));
            },
            help)
        ->type_name("N");
}

CLI::Option* add_numbers(CLI::App& command, const std::string& name, std::vector<double>& values,
                         const std::string& help) {
    return command
        .add_option_function<std::string>(
            name,
            [&values, name](const std::string& s) {
                std::string_view rest = s;
                do {
                    const std::string_view part = trimmed(next_part(rest, ','));
                    const auto x = scan_number<double>(part);
                    if (!x)
                        wrong_usage(text(name, " needs numbers separated by commas, found \"", part, "\""));
                    values.push_back(*x);
                } while (!rest.empty());
            },
            help)
        ->type_name("NUMBER,...");
}

Result<void> emit(const Context& context, std::string_view bytes) {
    if (!context.output.empty() && context.output != "-") return write_file(context.output, bytes);
    while (!bytes.empty()) {
        const ssize_t n = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EPIPE)
            ::_exit(exit_code(RefusalKind::io));  // nobody listens: no message either
        if (n <= 0)
            return refuse(RefusalKind::io, "standard output",
                          text("cannot be written: ", std::generic_category().message(errno)));
        bytes.remove_prefix(std::size_t(n));
    }
    return {};
}

void write_approximation(json::Writer& w, const Approximation& a) {
    w.begin_object().field("where", a.where).field("what", a.what);
    if (a.bound)
        w.field("bound", *a.bound);
    else
        w.field("estimate", a.estimate);
    w.end_object();
}

std::string approximation_text(const Approximation& a) {
    return text(
        a.where, ": ", a.what,
        a.bound ? text(", within ", *a.bound) : text(", about ", a.estimate, ", which nothing proves"));
}

void remark(std::string_view message) {
    const char* no_colour = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    const bool colour = ::isatty(STDERR_FILENO) != 0 && !(no_colour && *no_colour) && terminal &&
                        std::string_view(terminal) != "dumb";
    const std::string line = text(colour ? "\x1b[1mfreiform:\x1b[0m " : "freiform: ", message, "\n");
    std::string_view rest = line;
    while (!rest.empty()) {
        const ssize_t n = ::write(STDERR_FILENO, rest.data(), rest.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;  // there is nobody left to tell
        rest.remove_prefix(std::size_t(n));
    }
}

Result<std::vector<std::size_t>> selected(const Document& document, const std::string& object) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < document.objects.size(); ++i)
        if (object.empty() || document.objects[i].name == object) found.push_back(i);
    if (!found.empty() || object.empty()) return found;
    const auto index = scan_number<std::size_t>(object);
    if (index && *index < document.objects.size()) return std::vector{*index};
    std::vector<std::string_view> names;
    for (const Object& o : document.objects)
        if (!o.name.empty() && names.size() < 20) names.push_back(o.name);
    return refuse(
        RefusalKind::no_answer, "--object",
        text("there is no object \"", object, "\"; the ", document.objects.size(), " objects are 0..",
             (long long)(document.objects.size()) - 1, names.empty() ? "" : ", named ",
             names.empty() ? "" : listed(names), did_you_mean(object, names)));
}

std::string shown(const std::string& file) { return file == "-" ? "standard input" : file; }

int exit_code(RefusalKind kind) {
    switch (kind) {
        case RefusalKind::out_of_domain:
        case RefusalKind::not_converged:
        case RefusalKind::ill_conditioned:
        case RefusalKind::no_answer:
            return 1;
        case RefusalKind::invalid:
        case RefusalKind::nonfinite:
        case RefusalKind::unreadable:
        case RefusalKind::unsupported:
        case RefusalKind::unavailable:  // an input that this build has no reader for
            return 3;
        case RefusalKind::limit:
            return 4;
        case RefusalKind::io:
            return 5;
    }
    return 3;
}

}  // namespace freiform::cli
