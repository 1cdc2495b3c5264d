// Idea. The bytes go to a temporary file in the same folder, which is renamed over the old one when
// everything is on the disk: rename is atomic, so that a reader sees the old bytes or the new ones, whatever
// happens.
//
// Signals. A program that is stopped must not leave the temporary file. Its name stands in a table before the
// file exists; a signal handler deletes what the table holds. Signals are blocked in the thread that creates
// the file, from the claim of the slot until the file exists; a handler in another thread waits for that
// moment.
//
// Why not O_TMPFILE and linkat: it cannot replace an existing file, and some file systems have no O_TMPFILE.
// Why not fsync of the folder: after a crash either file may be found, and both are whole.
#if !defined(__wasm__)  // file_memory.cpp
#include <freiform/io/file.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <random>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace freiform {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

auto failed(const std::string& path, std::string_view what, int error) {
    return refuse(RefusalKind::io, path, text(what, ": ", reason(error)));
}

enum SlotState { kFree, kOpening, kLive };
struct Slot {
    std::atomic<int> state{kFree};
    char path[PATH_MAX] = {};
};
constinit std::array<Slot, 64> slots;
std::atomic<bool> stopping{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

Slot* claim_slot() {
    for (Slot& slot : slots) {
        int expected = kFree;
        if (slot.state.compare_exchange_strong(expected, kOpening)) return &slot;
    }
    return nullptr;
}

// A descriptor that is closed at the end of its life; `close` tells whether that went well.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int fd() const { return fd_; }
    // On Linux the descriptor is gone even after EINTR: it must not be closed twice.
    int close() {
        const int fd = fd_;
        fd_ = -1;
        return fd >= 0 && ::close(fd) != 0 && errno != EINTR ? errno : 0;
    }

private:
    int fd_;
};

class SignalsBlocked {
public:
    SignalsBlocked() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

private:
    sigset_t before_;
};

// A new file beside `path`, known to the signal handlers until it is renamed or removed.
class TemporaryFile {
public:
    ~TemporaryFile() {
        if (!slot_) return;
        if (exists_) ::unlink(slot_->path);
        slot_->state = kFree;
    }
    TemporaryFile() = default;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    // Returns the descriptor, or -1 with errno. The name is random, so that no two processes meet.
    int create(const std::string& path) {
        const std::size_t slash = path.rfind('/');
        const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
        const SignalsBlocked blocked;
        slot_ = claim_slot();
        if (!slot_) return errno = EMFILE, -1;
        if (stopping) return errno = ECANCELED, -1;
        std::random_device random;
        int fd = -1;
        for (int attempt = 0; attempt < 8; ++attempt) {
            const std::string name = text(folder, ".freiform-", random(), "-", random(), ".tmp");
            if (name.size() >= sizeof slot_->path) return errno = ENAMETOOLONG, -1;
            std::memcpy(slot_->path, name.c_str(), name.size() + 1);
            fd = ::open(slot_->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd >= 0 || (errno != EEXIST && errno != EINTR)) break;
        }
        exists_ = fd >= 0;
        if (exists_) slot_->state = kLive;
        return fd;
    }
    int rename_to(const std::string& path) {
        if (::rename(slot_->path, path.c_str()) != 0) return errno;
        exists_ = false;
        return 0;
    }

private:
    Slot* slot_ = nullptr;
    bool exists_ = false;
};

int write_all(int fd, std::string_view bytes) {
    constexpr std::size_t kMost = std::size_t(1) << 30;  // Linux writes at most 2^31 bytes at once
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), kMost));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n < 0 ? errno : EIO;
        bytes.remove_prefix(std::size_t(n));
    }
    return 0;
}

int flush_to_disk(int fd) {
    int result;
    do result = ::fsync(fd);
    while (result != 0 && errno == EINTR);
    // Some file systems have no fsync; what they can do has been done.
    return result == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno;
}

Result<void> write_directly(const std::string& path, int fd, std::string_view bytes) {
    if (const int error = write_all(fd, bytes)) return failed(path, "cannot be written", error);
    return {};
}

Result<void> replace_file(const std::string& path, const struct stat* old, std::string_view bytes) {
    TemporaryFile temporary;
    Descriptor out(temporary.create(path));
    if (out.fd() < 0) return failed(path, "cannot create a file in its folder", errno);
    if (old && ::fchmod(out.fd(), old->st_mode & 07777) != 0)
        return failed(path, "its permissions cannot be given to the new file", errno);
    if (const int error = write_all(out.fd(), bytes)) return failed(path, "cannot be written", error);
    if (const int error = flush_to_disk(out.fd()))
        return failed(path, "cannot be flushed to the disk", error);
    if (const int error = out.close()) return failed(path, "cannot be closed", error);
    if (const int error = temporary.rename_to(path)) return failed(path, "cannot be replaced", error);
    return {};
}

std::string target_of_links(const std::string& path) {
    char* resolved = ::realpath(path.c_str(), nullptr);
    if (!resolved) return path;
    std::string target = resolved;
    std::free(resolved);
    return target;
}

}  // namespace

Result<void> write_file(const std::string& path, std::string_view bytes) {
    if (path == "-") return write_directly("standard output", STDOUT_FILENO, bytes);
    if (path.empty() || path.find('\0') != std::string::npos)
        return refuse(RefusalKind::io, path, "not a file name");
    struct stat old {};
    if (::stat(path.c_str(), &old) != 0) {
        if (errno != ENOENT) return failed(path, "cannot be written", errno);
        return replace_file(path, nullptr, bytes);
    }
    if (S_ISDIR(old.st_mode)) return failed(path, "cannot be written", EISDIR);
    if (!S_ISREG(old.st_mode)) {
        Descriptor out(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
        if (out.fd() < 0) return failed(path, "cannot be opened", errno);
        if (auto r = write_directly(path, out.fd(), bytes); !r) return r;
        if (const int error = out.close()) return failed(path, "cannot be closed", error);
        return {};
    }
    if (::access(path.c_str(), W_OK) != 0) return failed(path, "cannot be written", errno);
    return replace_file(target_of_links(path), &old, bytes);
}

Result<std::string> read_file(const std::string& path, std::uint64_t max_bytes) {
    const bool standard_input = path == "-";
    const std::string where = standard_input ? "standard input" : path;
    Descriptor opened(standard_input ? -1 : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
    const int in = standard_input ? STDIN_FILENO : opened.fd();
    struct stat info {};
    if (in < 0 || ::fstat(in, &info) != 0) return failed(where, "cannot be read", errno);
    if (S_ISDIR(info.st_mode)) return failed(where, "cannot be read", EISDIR);
    const auto size = S_ISREG(info.st_mode) ? std::uint64_t(info.st_size) : 0;
    if (size > max_bytes)
        return refuse(RefusalKind::limit, where, text("has ", size, " bytes, the limit is ", max_bytes));

    // The size is a hint only: the file may grow, and a pipe has none.
    constexpr std::size_t kChunk = std::size_t(1) << 16;
    std::string bytes;
    std::size_t filled = 0;
    for (;;) {
        if (filled == bytes.size())
            bytes.resize(std::max(std::size_t(size) + 1, filled + filled / 2 + kChunk));
        const ssize_t n = ::read(in, bytes.data() + filled, bytes.size() - filled);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return failed(where, "cannot be read", errno);
        if (n == 0) break;
        filled += std::size_t(n);
        if (filled > max_bytes)
            return refuse(RefusalKind::limit, where, text("has more than ", max_bytes, " bytes, the limit"));
    }
    bytes.resize(filled);
    return bytes;
}

void remove_unfinished_files() noexcept {
    const int before = errno;
    stopping = true;
    for (Slot& slot : slots) {
        // Another thread is creating this file right now; a second is beyond any working disk.
        for (int i = 0; i < 1000 && slot.state == kOpening; ++i) {
            const timespec moment{0, 1'000'000};
            ::nanosleep(&moment, nullptr);
        }
        if (slot.state == kLive) ::unlink(slot.path);
    }
    errno = before;
}

}  // namespace freiform
#endif
