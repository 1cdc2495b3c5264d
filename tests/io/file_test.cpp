#include <freiform/io/file.hpp>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

// Faults: the n-th of the calls below fails, as if the machine had done it.
namespace {
int calls_until_fault = -1;
int injected_error = 0;
bool half_a_write = false;
bool fault_now() { return calls_until_fault > 0 && --calls_until_fault == 0; }
template <class F>
F real(const char* name) {
    return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}
}  // namespace

extern "C" {
ssize_t write(int fd, const void* bytes, size_t n) {
    static const auto f = real<ssize_t (*)(int, const void*, size_t)>("write");
    if (calls_until_fault > 0 && half_a_write && n > 1) n /= 2;
    if (fault_now()) return errno = injected_error, -1;
    return f(fd, bytes, n);
}
int fsync(int fd) {
    static const auto f = real<int (*)(int)>("fsync");
    if (fault_now()) return errno = injected_error, -1;
    return f(fd);
}
int rename(const char* from, const char* to) noexcept {
    static const auto f = real<int (*)(const char*, const char*)>("rename");
    if (fault_now()) return errno = injected_error, -1;
    return f(from, to);
}
int fchmod(int fd, mode_t mode) noexcept {
    static const auto f = real<int (*)(int, mode_t)>("fchmod");
    if (fault_now()) return errno = injected_error, -1;
    return f(fd, mode);
}
int close(int fd) {
    static const auto f = real<int (*)(int)>("close");
    if (fault_now()) return f(fd), errno = injected_error, -1;
    return f(fd);
}
int open(const char* path, int flags, ...) {
    static const auto f = real<int (*)(const char*, int, ...)>("open");
    if (fault_now()) return errno = injected_error, -1;
    return f(path, flags, 0666);
}
}

namespace freiform {
namespace {

namespace fs = std::filesystem;

class Folder : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "freiform-file-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t files() const {
        return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string content(const std::string& name) {
        std::ifstream in(name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    fs::path folder_;
};

using WriteFile = Folder;
using ReadFile = Folder;

TEST_F(WriteFile, replaces_the_content_and_leaves_nothing_else) {
    const std::string bytes("a\0b\n", 4);
    ASSERT_TRUE(write_file(path("x"), "old and longer"));
    ASSERT_TRUE(write_file(path("x"), bytes));
    EXPECT_EQ(content(path("x")), bytes);
    EXPECT_EQ(files(), 1u);
    ASSERT_TRUE(write_file(path("empty"), ""));
    EXPECT_EQ(fs::file_size(path("empty")), 0u);
}

TEST_F(WriteFile, honours_umask_and_keeps_permissions) {
    const mode_t before = ::umask(027);
    ASSERT_TRUE(write_file(path("new"), "x"));
    ::umask(before);
    struct stat info {};
    ASSERT_EQ(::stat(path("new").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
    ASSERT_EQ(::chmod(path("new").c_str(), 0600), 0);
    ASSERT_TRUE(write_file(path("new"), "y"));
    ASSERT_EQ(::stat(path("new").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0600u);
}

TEST_F(WriteFile, follows_a_link) {
    ASSERT_TRUE(write_file(path("target"), "old"));
    fs::create_symlink("target", path("link"));
    ASSERT_TRUE(write_file(path("link"), "new"));
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(content(path("target")), "new");
}

TEST_F(WriteFile, refuses_folders_and_missing_folders_with_the_reason) {
    const auto folder = write_file(folder_.string(), "x");
    ASSERT_FALSE(folder);
    EXPECT_EQ(folder.error().kind, RefusalKind::io);
    EXPECT_EQ(folder.error().where, folder_.string());
    EXPECT_NE(folder.error().message.find("directory"), std::string::npos);
    const auto missing = write_file(path("no/such/x"), "x");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
    EXPECT_FALSE(write_file("", "x"));
    EXPECT_FALSE(write_file(path(std::string(300, 'x')), "x"));
    EXPECT_EQ(files(), 0u);
}

TEST_F(WriteFile, writes_to_a_pipe_directly) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = content(path("pipe")); });
    EXPECT_TRUE(write_file(path("pipe"), "bytes"));
    reader.join();
    EXPECT_EQ(received, "bytes");
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

// Who may replace /dev/full must not try it on the real one.
TEST_F(WriteFile, reports_a_full_device) {
    std::string device = "/dev/full";
    if (::access("/dev", W_OK) == 0) {
        device = path("full");
        if (::mknod(device.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0)
            GTEST_SKIP() << "no device can be made";
    }
    const int probe = ::open(device.c_str(), O_WRONLY | O_CLOEXEC);
    if (probe < 0) GTEST_SKIP() << "no full device can be opened here";
    ::close(probe);
    const auto full = write_file(device, "x");
    ASSERT_FALSE(full);
    EXPECT_NE(full.error().message.find("No space"), std::string::npos);
    EXPECT_TRUE(fs::is_character_file(device));
}

TEST_F(WriteFile, survives_the_failure_of_any_call) {
    for (const bool exists : {false, true})
        for (const bool half : {false, true})
            for (const int error : {ENOSPC, EIO, EDQUOT}) {
                int failures = 0;
                for (int n = 1; n < 100; ++n) {
                    const std::string file = path("x");
                    if (exists) {
                        ASSERT_TRUE(write_file(file, "old"));
                    }
                    calls_until_fault = n;
                    injected_error = error;
                    half_a_write = half;
                    const auto result = write_file(file, "new bytes");
                    const bool reached = calls_until_fault == 0;
                    calls_until_fault = -1;
                    if (!reached) {
                        EXPECT_TRUE(result);
                        EXPECT_EQ(content(file), "new bytes");
                        break;
                    }
                    ++failures;
                    ASSERT_FALSE(result) << n;
                    EXPECT_EQ(result.error().kind, RefusalKind::io);
                    EXPECT_NE(result.error().message.find(std::strerror(error)), std::string::npos);
                    EXPECT_EQ(fs::exists(file), exists) << n;
                    EXPECT_EQ(files(), exists ? 1u : 0u) << n;
                    if (exists) {
                        EXPECT_EQ(content(file), "old") << n;
                    }
                }
                EXPECT_EQ(failures, 5 + exists + (half ? 4 : 0));
                fs::remove(path("x"));
            }
}

TEST_F(WriteFile, takes_up_interrupted_calls_again) {
    for (int n = 1; n < 7; ++n) {
        fs::remove(path("x"));
        calls_until_fault = n;
        injected_error = EINTR;
        half_a_write = false;
        const bool rename_interrupted = n == 5;  // rename is not one of the calls that a signal interrupts
        const auto result = write_file(path("x"), "bytes");
        calls_until_fault = -1;
        EXPECT_EQ(bool(result), !rename_interrupted) << n;
    }
    EXPECT_EQ(content(path("x")), "bytes");
    EXPECT_EQ(files(), 1u);
}

// A child overwrites a file again and again, in two threads, until a signal stops it at a random moment.
void overwrite_until_stopped(const std::string& a, const std::string& b) {
    for (int signal : {SIGINT, SIGTERM}) {
        std::signal(signal, [](int s) {
            remove_unfinished_files();
            ::_exit(128 + s);
        });
    }
    const auto work = [](const std::string& file) {
        const std::string x(300'000, 'x'), y(300'000, 'y');
        for (;;)
            if (!write_file(file, x) || !write_file(file, y)) ::pause();
    };
    std::thread other(work, b);
    work(a);
}

TEST_F(WriteFile, leaves_old_or_new_bytes_and_nothing_else_when_stopped) {
    std::mt19937 random(3);
    for (int i = 0; i < 60; ++i) {
        const int signal = i % 2 ? SIGINT : SIGTERM;
        ASSERT_TRUE(write_file(path("a"), std::string(300'000, 'o')));
        ASSERT_TRUE(write_file(path("b"), std::string(300'000, 'o')));
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) overwrite_until_stopped(path("a"), path("b"));
        std::this_thread::sleep_for(std::chrono::microseconds(2000 + random() % 20000));
        ::kill(child, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        // Before the child has set its handler the signal itself ends it.
        EXPECT_TRUE((WIFEXITED(status) && WEXITSTATUS(status) == 128 + signal) || WIFSIGNALED(status))
            << status;
        EXPECT_EQ(files(), 2u);
        for (const char* name : {"a", "b"}) {
            const std::string bytes = content(path(name));
            ASSERT_EQ(bytes.size(), 300'000u);
            EXPECT_EQ(bytes.find_first_not_of(bytes[0]), std::string::npos);
        }
    }
}

TEST_F(ReadFile, gives_the_bytes_up_to_the_limit) {
    const std::string bytes(100'000, 'q');
    ASSERT_TRUE(write_file(path("x"), bytes));
    EXPECT_EQ(read_file(path("x"), bytes.size()), bytes);
    const auto larger = read_file(path("x"), bytes.size() - 1);
    ASSERT_FALSE(larger);
    EXPECT_EQ(larger.error().kind, RefusalKind::limit);
    EXPECT_NE(larger.error().message.find("100000"), std::string::npos);
    ASSERT_TRUE(write_file(path("empty"), ""));
    EXPECT_EQ(read_file(path("empty"), 0), "");
}

TEST_F(ReadFile, refuses_missing_files_and_folders) {
    const auto missing = read_file(path("x"), 10);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, RefusalKind::io);
    EXPECT_EQ(missing.error().where, path("x"));
    const auto folder = read_file(folder_.string(), 10);
    ASSERT_FALSE(folder);
    EXPECT_NE(folder.error().message.find("directory"), std::string::npos);
}

TEST_F(ReadFile, stops_at_the_limit_where_the_size_is_unknown) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "no /dev/zero";
    const auto endless = read_file("/dev/zero", 1'000'000);
    ASSERT_FALSE(endless);
    EXPECT_EQ(endless.error().kind, RefusalKind::limit);
}

}  // namespace
}  // namespace freiform
