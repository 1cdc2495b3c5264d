// Both limits end the process from wherever it is, with texts made beforehand: a handler must not allocate,
// and a computation that has to look at a clock would look too rarely or too often.
#include "signals.hpp"

#include <freiform/core/heap.hpp>
#include <freiform/io/file.hpp>

#include <csignal>
#include <cstring>
#include <new>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

namespace freiform::cli {

namespace {

struct Ending {
    char error[256] = "", output[512] = "";
};
Ending out_of_time, out_of_memory;

void put(int fd, const char* s) {
    for (std::size_t n = std::strlen(s); n > 0;) {
        const ssize_t k = ::write(fd, s, n);
        if (k <= 0) return;
        s += k;
        n -= std::size_t(k);
    }
}

[[noreturn]] void end_with(const Ending& e) {
    remove_unfinished_files();
    put(STDOUT_FILENO, e.output);
    put(STDERR_FILENO, e.error);
    ::_exit(exit_code(RefusalKind::limit));
}

void prepare(Ending& e, const std::string& option, const std::string& message, bool json) {
    json::Writer w;
    w.begin_object().key("error").begin_object();
    w.field("kind", "limit").field("message", message).field("where", option).end_object().end_object();
    const std::string error = text("freiform: ", option, ": ", message, "\n"), output = w.text() + "\n";
    std::strncpy(e.error, error.c_str(), sizeof e.error - 1);
    if (json) std::strncpy(e.output, output.c_str(), sizeof e.output - 1);
}

}  // namespace

void catch_signals() {
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        action.sa_handler = [](int s) {
            remove_unfinished_files();
            ::_exit(128 + s);
        };
        ::sigaction(signal, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
}

void enforce(const Context& context) {
    const Limits& limits = context.limits;
    prepare(out_of_memory, "--max-memory",
            limits.max_memory != 0
                ? text("more memory is needed than the limit of ", limits.max_memory, " bytes")
                : std::string("more memory is needed than the machine has"),
            context.json);
    std::set_new_handler([] { end_with(out_of_memory); });
    if (limits.max_memory != 0) {
        const rlimit all{rlim_t(limits.max_memory), rlim_t(limits.max_memory)};
        ::setrlimit(RLIMIT_DATA, &all);
    }
    use_large_pages();
    if (limits.timeout > 0) {
        prepare(out_of_time, "--timeout",
                text("more time is needed than the limit of ", limits.timeout, " seconds"), context.json);
        std::signal(SIGALRM, [](int) { end_with(out_of_time); });
        const double seconds = std::min(limits.timeout, 1e8);
        itimerval timer{};
        timer.it_value.tv_sec = time_t(seconds);
        timer.it_value.tv_usec =
            std::max<suseconds_t>(1, suseconds_t((seconds - double(timer.it_value.tv_sec)) * 1e6));
        ::setitimer(ITIMER_REAL, &timer, nullptr);
    }
}

}  // namespace freiform::cli
