#include "command.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <cerrno>
#include <cstdlib>
#include <unistd.h>

namespace freiform::cli {

ReadOptions Context::read_options() const {
    if (limits.repair_limit && !limits.repair) wrong_usage("--repair-limit is for --repair");
    if (limits.repair && limits.reader == "occt") wrong_usage("--repair is not for --reader occt");
    ReadOptions o;
    o.timeout = limits.timeout;
    o.max_memory = limits.max_memory;
    if (limits.reader == "occt") o.step_reader = StepReader::occt;
    o.repair = limits.repair, o.repair_limit = limits.repair_limit.value_or(0);
    if (limits.max_memory != 0) o.max_bytes = std::min(o.max_bytes, limits.max_memory);
    return o;
}

void require_direction(std::string_view option, std::span<const double> direction) {
    for (const double x : direction)
        if (x != 0) return;
    wrong_usage(text(option, " needs a direction that is not 0"));
}

#if !defined(__wasm__)  // bindings/wasm

void wrong_usage(const std::string& message) { throw WrongUsage(message); }

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

#endif

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
        a.where, a.where.empty() ? "" : ": ", a.what,
        a.bound ? text(", within ", *a.bound) : text(", about ", a.estimate, ", which nothing proves"));
}

std::string repair_text(const Repair& r) { return text(r.where, ": ", r.what, " (", r.distance, ")"); }

void write_repairs(json::Writer& w, const std::vector<Repair>& list) {
    w.key("repairs").begin_array();
    for (const Repair& r : list)
        w.begin_object()
            .field("where", r.where)
            .field("what", r.what)
            .field("distance", r.distance)
            .end_object();
    w.end_array();
}

void remark_unknown_unit(std::string_view unit, std::string_view format) {
    const bool glb = format == "glb";
    const bool has_units = glb || format == "step" || format == "stp" || format == "iges" || format == "igs";
    if (has_units && !unit.empty() && !metres_per(unit))
        remark(text("the unit \"", unit, "\" is not known, so the file says ", glb ? "m" : "mm"));
}

#if !defined(__wasm__)

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

#endif

Result<std::vector<std::size_t>> selected(const Document& document, const std::string& object) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < document.objects.size(); ++i)
        if (object.empty() || document.objects[i].name == object) found.push_back(i);
    if (!found.empty() || object.empty()) return found;
    const auto index = scan_number<std::size_t>(object);
    if (index && *index < document.objects.size()) return std::vector{*index};
    const std::size_t n = document.objects.size();
    std::vector<std::string_view> names;
    for (const Object& o : document.objects)
        if (!o.name.empty() && names.size() < 20) names.push_back(o.name);
    return refuse(RefusalKind::no_answer, "--object",
                  text("there is no object \"", object, "\"; ",
                       n == 0   ? "the file has none"
                       : n == 1 ? "the only one is 0"
                                : text("the ", n, " objects are 0..", n - 1),
                       names.empty() ? "" : ", named ", names.empty() ? "" : listed(names),
                       did_you_mean(object, names)));
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
