// Idea. The reader is a child process with limits of its own; what it understood comes back through a pipe in
// the form of io/model_binary.hpp, what it has to say through another. A pipe leaves nothing behind, whoever
// is killed when.
//
// The child. A process group of its own, so that all it may start ends with it; limits on address space, on
// processor time (in case the parent is stopped) and no core file; and a death signal, so that it does not
// survive its parent. Between fork and exec only functions are called that are safe after a fork of a process
// with several threads.
//
// Before the child. What is not a file of one of the three formats at all is told from the first bytes,
// because the reader's own answer to it is a poor one.
#include <freiform/io/exchange.hpp>
#include <freiform/io/model_binary.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#if !defined(__wasm__)
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif
#endif

namespace freiform {

#if defined(__wasm__)

Result<Model> read_with_occt(const std::string& path, const ImportLimits&) {
    return refuse(RefusalKind::unavailable, path,
                  "IGES and BREP files, and STEP files with Open CASCADE, are read by the program alone");
}

#else

namespace {

constexpr std::size_t kMostWords = 64 << 10;  // of the child's standard error

constexpr std::size_t kAddressesOfLibraries = 96 << 20;

std::string system_message(int error) { return std::generic_category().message(error); }

class PipeEnd {
public:
    explicit PipeEnd(int fd = -1) : fd_(fd) {}
    PipeEnd(PipeEnd&& o) noexcept : fd_(std::exchange(o.fd_, -1)) {}
    PipeEnd& operator=(PipeEnd&& o) noexcept {
        std::swap(fd_, o.fd_);
        return *this;
    }
    ~PipeEnd() { close(); }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    int operator*() const { return fd_; }
    bool is_open() const { return fd_ >= 0; }

private:
    int fd_;
};

// The first bytes as text for a message.
std::string first_bytes(std::string_view bytes) {
    std::string s;
    for (char c : bytes.substr(0, 24)) s += c >= ' ' && c <= '~' ? c : '?';
    return s;
}

// The format that the first bytes are of: "step", "iges", "brep". An IGES file is told by column 73 of its
// first line, after any comment lines of the flag section ('C' or 'B' are binary and compressed IGES).
Result<std::string_view> format_of(const std::string& path) {
    const PipeEnd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat info {};
    if (!file.is_open() || ::fstat(*file, &info) != 0)
        return refuse(RefusalKind::io, path, system_message(errno));
    if (!S_ISREG(info.st_mode)) return refuse(RefusalKind::io, path, "is not a regular file");
    std::string head(4096, '\0');
    const ssize_t n = ::read(*file, head.data(), head.size());
    if (n < 0) return refuse(RefusalKind::io, path, system_message(errno));
    head.resize(std::size_t(n));
    if (head.empty()) return refuse(RefusalKind::unreadable, path, "the file is empty");
    if (head.find("ISO-10303-21") != std::string::npos) return "step";
    if (head.starts_with("DBRep_DrawableShape") || head.find("CASCADE Topology") != std::string::npos)
        return "brep";
    if (head.size() > 72 && head[72] == 'S' && head.substr(0, 72).find('\n') == std::string::npos)
        return "iges";
    return refuse(RefusalKind::unreadable, path,
                  text("begins with '", first_bytes(head),
                       "'; a STEP file begins with ISO-10303-21, an IGES file has an S in column 73 of its "
                       "first line, a BREP file says CASCADE Topology"));
}

std::string folder_of_this_program() {
    std::string path(4096, '\0');
    const ssize_t n = ::readlink("/proc/self/exe", path.data(), path.size());
    if (n <= 0) return {};
    path.resize(std::size_t(n));
    return path.substr(0, path.rfind('/'));
}

Result<std::string> find_reader() {
    constexpr std::string_view kName = "freiform-occt-import";
    std::vector<std::string> places;
    if (const char* named = std::getenv("FREIFORM_OCCT_IMPORT"); named != nullptr && *named != '\0') {
        places.emplace_back(named);
    } else {
        if (const std::string here = folder_of_this_program(); !here.empty())
            for (std::string_view to : {"/", "/../bin/", "/../libexec/freiform/"})
                places.push_back(text(here, to, kName));
#if defined(FREIFORM_LIBEXECDIR)
        places.push_back(text(FREIFORM_LIBEXECDIR, "/", kName));
#endif
        for (std::string_view to : {"/usr/local/libexec/freiform/", "/usr/libexec/freiform/"})
            places.push_back(text(to, kName));
    }
    for (const std::string& p : places)
        if (::access(p.c_str(), X_OK) == 0) return p;
    std::string tried;
    for (const std::string& p : places) tried += (tried.empty() ? "" : ", ") + p;
    return refuse(RefusalKind::unavailable, std::string(kName),
                  text("the reader of STEP, IGES and BREP files is not installed (looked for ", tried,
                       "); it is built where Open CASCADE is: on Debian apt-get install "
                       "libocct-data-exchange-dev"));
}

struct Outcome {
    std::string bytes, words;
    int status = 0;
    std::size_t most_memory = 0;
    bool timed_out = false, too_large = false;
};

// Only what is safe after fork. Does not return.
[[noreturn]] void become_child(const char* program, const std::array<const char*, 6>& arguments, int out,
                               int err, pid_t parent, const ImportLimits& limits) {
    ::setpgid(0, 0);
    const auto limit = [](auto what, rlim_t value) {
        struct rlimit now {};
        ::getrlimit(what, &now);
        const rlim_t v = std::min(value, now.rlim_max);
        const struct rlimit set { v, v };
        ::setrlimit(what, &set);
    };
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory takes terabytes of addresses
    limit(RLIMIT_AS, rlim_t(limits.memory_bytes));
#endif
    // Of all its threads together (apps/occt/main.cpp), should this process not live to stop it.
    constexpr double kMostThreads = 4;
    limit(RLIMIT_CPU, rlim_t(kMostThreads * std::min(limits.seconds, 1e9)) + 2);
    limit(RLIMIT_CORE, 0);
#if defined(__linux__)
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (::getppid() != parent) ::_exit(127);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::signal(SIGPIPE, SIG_DFL);
    ::execv(program, const_cast<char* const*>(arguments.data()));
    ::_exit(126);
}

bool make_pipe(PipeEnd& from, PipeEnd& to) {
    int ends[2];
    if (::pipe(ends) != 0) return false;
    from = PipeEnd(ends[0]);
    to = PipeEnd(ends[1]);
    for (int fd : ends)
        if (::fcntl(fd, F_SETFD, FD_CLOEXEC) != 0) return false;
    return ::fcntl(*from, F_SETFL, O_NONBLOCK) == 0;
}

// Takes what is there. False at the end of the stream.
bool drain(const PipeEnd& from, std::string& into, std::size_t most, bool& too_large) {
    char buffer[1 << 16];
    for (;;) {
        const ssize_t n = ::read(*from, buffer, sizeof buffer);
        if (n == 0) return false;
        if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        const std::size_t room = most - std::min(most, into.size());
        if (std::size_t(n) > room) too_large = true;
        into.append(buffer, std::min(std::size_t(n), room));
    }
}

// Reads both pipes until the child closes them or its time is over.
void listen(Outcome& o, std::array<PipeEnd, 2>& from, const ImportLimits& limits) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    bool words_too_long = false;
    while (from[0].is_open() || from[1].is_open()) {
        const double left = limits.seconds - std::chrono::duration<double>(Clock::now() - start).count();
        o.timed_out = !(left > 0);
        if (o.timed_out || o.too_large) return;
        std::array<pollfd, 2> waiting{{{*from[0], POLLIN, 0}, {*from[1], POLLIN, 0}}};
        ::poll(waiting.data(), waiting.size(), int(std::min(left * 1000 + 1, 1e9)));
        if (waiting[0].revents != 0 && !drain(from[0], o.bytes, limits.memory_bytes, o.too_large))
            from[0].close();
        if (waiting[1].revents != 0 && !drain(from[1], o.words, kMostWords, words_too_long)) from[1].close();
    }
}

Result<Outcome> run(const std::string& program, const std::string& path, std::string_view format,
                    const ImportLimits& limits) {
    std::array<PipeEnd, 2> from, to;
    for (std::size_t i = 0; i < 2; ++i)
        if (!make_pipe(from[i], to[i])) return refuse(RefusalKind::io, "pipe", system_message(errno));
    const std::string format_text(format);
    const std::array<const char*, 6> arguments{program.c_str(), path.c_str(),        "-",
                                               "--format",      format_text.c_str(), nullptr};
    const pid_t parent = ::getpid(), child = ::fork();
    if (child < 0) return refuse(RefusalKind::io, "fork", system_message(errno));
    if (child == 0) become_child(program.c_str(), arguments, *to[0], *to[1], parent, limits);
    for (PipeEnd& d : to) d.close();
    Outcome o;
    listen(o, from, limits);
    // All of its group, also when it has ended: it may have left something behind.
    ::kill(-child, SIGKILL);
    if (o.timed_out || o.too_large) ::kill(child, SIGKILL);
    struct rusage used {};
    while (::wait4(child, &o.status, 0, &used) < 0 && errno == EINTR) {
    }
    o.most_memory = std::size_t(used.ru_maxrss) * 1024;
    return o;
}

// The last line "refusal TAB kind TAB where TAB message" of what the reader said.
std::optional<Refusal> said(std::string_view words) {
    const std::size_t at = words.rfind("refusal\t");
    if (at == std::string_view::npos || (at > 0 && words[at - 1] != '\n')) return std::nullopt;
    std::string_view line = words.substr(at, words.find('\n', at) - at);
    std::array<std::string_view, 4> field;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t end = i == 3 ? line.size() : std::min(line.find('\t'), line.size());
        field[i] = line.substr(0, end);
        line.remove_prefix(std::min(end + 1, line.size()));
    }
    for (int k = 0; k <= int(RefusalKind::io); ++k)
        if (name_of(RefusalKind(k)) == field[1])
            return Refusal{RefusalKind(k), std::string(field[2]), std::string(field[3])};
    return std::nullopt;
}

std::string signal_name(int number) {
    const char* name = ::sigabbrev_np(number);
    return name != nullptr ? text("SIG", name, " (", number, ")") : text(number);
}

Refusal why(const Outcome& o, const std::string& path, const ImportLimits& limits) {
    const double mebibytes = double(limits.memory_bytes) / (1 << 20);
    if (o.timed_out || (WIFSIGNALED(o.status) && WTERMSIG(o.status) == SIGXCPU))
        return {RefusalKind::limit, path,
                text("the reader did not end within ", limits.seconds, " seconds; it was stopped")};
    if (o.too_large) return {RefusalKind::limit, path, text("the model takes more than ", mebibytes, " MiB")};
    if (auto refusal = said(o.words)) {
        if (refusal->kind == RefusalKind::limit)
            refusal->message = text("the reader needs more than the ", mebibytes, " MiB that it may use");
        if (refusal->where.empty()) refusal->where = path;
        return *refusal;
    }
    const bool signalled = WIFSIGNALED(o.status);
    const int code = signalled ? 0 : WEXITSTATUS(o.status);
    // What the dynamic loader says where there is no room for the libraries.
    if (code == 127 &&
        (o.words.find("failed to map") != std::string::npos || o.words.find("emory") != std::string::npos))
        return {RefusalKind::limit, path,
                text("the reader needs more than the ", mebibytes, " MiB that it may use")};
    if (code == 126 || code == 127)
        return {RefusalKind::unavailable, path,
                text("the reader of STEP, IGES and BREP files cannot be started", o.words.empty() ? "" : ": ",
                     first_bytes(o.words))};
    const std::string ended = signalled
                                  ? text("the reader ended with signal ", signal_name(WTERMSIG(o.status)))
                                  : text("the reader ended with status ", code);
    // It and its libraries do not always notice that they got no more memory. Libraries take addresses, too.
    if (o.most_memory + kAddressesOfLibraries > limits.memory_bytes / 2)
        return {RefusalKind::limit, path,
                text(ended, "; it used ", double(o.most_memory) / (1 << 20), " of the ", mebibytes,
                     " MiB that it may use, and probably needs more")};
    return {RefusalKind::unreadable, path, signalled ? ended + "; the file is probably damaged" : ended};
}

}  // namespace

Result<Model> read_with_occt(const std::string& path, const ImportLimits& limits) {
    if (!(limits.seconds > 0) || limits.memory_bytes == 0)
        return refuse(RefusalKind::limit, path, "no time or no memory is allowed to read it");
    const auto format = format_of(path);
    if (!format) return std::unexpected(format.error());
    const auto program = find_reader();
    if (!program) return std::unexpected(program.error());
    // A name that begins with a dash is a file all the same.
    auto outcome = run(*program, path.starts_with('-') ? "./" + path : path, *format, limits);
    if (!outcome) return std::unexpected(outcome.error());
    const bool done = WIFEXITED(outcome->status) && WEXITSTATUS(outcome->status) == 0;
    if (outcome->timed_out || outcome->too_large || !done)
        return std::unexpected(why(*outcome, path, limits));
    auto model = from_binary(outcome->bytes);
    if (!model) return refuse_within(path, model.error());
    return model;
}

#endif

}  // namespace freiform
