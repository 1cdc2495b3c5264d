// Runs the built program and catches all that it says.
#pragma once
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace freiform::test {

inline const std::string kTeapot = std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt";
inline const std::string kExample = std::string(FREIFORM_SOURCE_DIR) + "/examples/curves.json";

struct Ran {
    int code = -1;  // exit code, or 1000 + signal
    std::string out, err;
};

inline std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A folder for one test, and the program run in it.
class Program : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "freiform-cli-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string file(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return path(name);
    }

    pid_t start(const std::vector<std::string>& arguments, const std::string& input,
                const std::string& out) const {
        file(".in", input);
        const pid_t child = ::fork();
        if (child != 0) return child;
        const auto redirect = [&](const std::string& name, int fd, int flags) {
            const int opened = ::open(name.c_str(), flags, 0600);
            if (opened < 0 || ::dup2(opened, fd) < 0) ::_exit(99);
        };
        redirect(path(".in"), 0, O_RDONLY);
        redirect(out, 1, O_WRONLY | O_CREAT | O_TRUNC);
        redirect(path(".err"), 2, O_WRONLY | O_CREAT | O_TRUNC);
        if (::chdir(folder_.c_str()) != 0) ::_exit(98);
        const char* other = std::getenv("FREIFORM_TEST_PROGRAM");  // such as bindings/wasm/cli.js
        const char* program = other ? other : FREIFORM_BINARY;
        std::vector<char*> argv{const_cast<char*>(program)};
        for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
        argv.push_back(nullptr);
        ::execv(program, argv.data());
        ::_exit(97);
    }
    static int wait(pid_t child) {
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }
    Ran run(const std::vector<std::string>& arguments, const std::string& input = "") const {
        Ran r;
        r.code = wait(start(arguments, input, path(".out")));
        r.out = content(path(".out"));
        r.err = content(path(".err"));
        return r;
    }
    std::filesystem::path folder_;
};

}  // namespace freiform::test
