#include "run.hpp"

#include <arpa/inet.h>
#include <chrono>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <thread>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

struct Answer {
    int status = 0;
    std::string head, body;
};

// The program, serving a page of two files, until the test ends.
class ViewCommand : public Program {
protected:
    void TearDown() override {
        if (child_ > 0 && ended_ < 0) stop(SIGKILL);
        Program::TearDown();
    }

    void view(const std::string& shown) {
        std::filesystem::create_directories(folder_ / "page/assets");
        file("page/index.html", "<!doctype html><title>the page</title>");
        file("page/assets/a.js", "export {};");
        file("secret.txt", "not for others");
        std::filesystem::create_symlink(folder_ / "secret.txt", folder_ / "page/link.txt");
        child_ = start({"view", shown, "--no-browser", "--page", path("page")}, "", path(".out"));
        for (int i = 0; i < 1000 && port_ == 0; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            const std::string said = content(path(".out"));
            if (said.ends_with("/\n")) port_ = std::atoi(said.substr(said.rfind(':') + 1).c_str());
        }
        ASSERT_NE(port_, 0) << content(path(".err"));
    }
    int stop(int signal) {
        ::kill(child_, signal);
        return ended_ = wait(child_);
    }

    int connected() const {
        const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_port = htons(std::uint16_t(port_));
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(fd, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
        return fd;
    }
    Answer ask_raw(const std::string& request) const {
        const int fd = connected();
        EXPECT_EQ(::send(fd, request.data(), request.size(), MSG_NOSIGNAL), ssize_t(request.size()));
        std::string all;
        char some[4096];
        for (ssize_t n; (n = ::recv(fd, some, sizeof some, 0)) > 0;) all.append(some, std::size_t(n));
        ::close(fd);
        const std::size_t end = all.find("\r\n\r\n");
        if (end == std::string::npos) return {};
        return {std::atoi(all.substr(9, 3).c_str()), all.substr(0, end + 2), all.substr(end + 4)};
    }
    Answer ask(const std::string& path, const std::string& method = "GET", std::string host = "") const {
        if (host.empty()) host = "127.0.0.1:" + std::to_string(port_);
        return ask_raw(method + " " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    }

    pid_t child_ = 0;
    int port_ = 0, ended_ = -1;
};

TEST_F(ViewCommand, serves_the_page_and_the_file_and_says_where) {
    view(kTeapot);
    const Answer page = ask("/"), script = ask("/assets/a.js"), facts = ask("/view.json");
    EXPECT_EQ(page.status, 200);
    EXPECT_NE(page.body.find("the page"), std::string::npos);
    EXPECT_NE(page.head.find("Content-Type: text/html"), std::string::npos);
    EXPECT_NE(script.head.find("Content-Type: text/javascript"), std::string::npos);
    const Json about = Json::parse(facts.body);
    EXPECT_EQ(about["file"], "teapot.bpt");
    EXPECT_EQ(about["objects"].size(), 32u);
    EXPECT_EQ(about["box"]["min"].size(), 3u);
    EXPECT_EQ(Json::parse(ask("/document.json").body)["objects"].size(), 32u);
    EXPECT_TRUE(Json::parse(ask("/faces.json").body)["refused"].empty());
    const Answer mesh = ask("/model.glb?tolerance=0.1");
    EXPECT_EQ(mesh.status, 200);
    EXPECT_EQ(mesh.body.substr(0, 4), "glTF");
    const Json report = Json::parse(ask("/report.json?tolerance=0.1").body);
    EXPECT_LE(report["error_bound"].get<double>(), 0.1);
    EXPECT_GT(report["triangles"].get<int>(), 100);
    EXPECT_EQ(stop(SIGINT), 130);
}

TEST_F(ViewCommand, other_sites_other_methods_and_other_files_are_refused) {
    view(kExample);
    // A page of another site that has made its own name mean 127.0.0.1.
    EXPECT_EQ(ask("/document.json", "GET", "evil.example:" + std::to_string(port_)).status, 403);
    EXPECT_EQ(ask("/document.json", "GET", "127.0.0.1").status, 403);
    EXPECT_EQ(ask("/document.json", "GET", "localhost:" + std::to_string(port_)).status, 200);
    EXPECT_EQ(ask_raw("GET / HTTP/1.1\r\n\r\n").status, 403);
    EXPECT_EQ(ask("/", "POST").status, 405);
    for (const char* path :
         {"/link.txt", "/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt", "/assets"}) {
        const Answer r = ask(path);
        EXPECT_EQ(r.status, 404) << path;
        EXPECT_EQ(r.body.find("not for others"), std::string::npos);
    }
    EXPECT_EQ(ask_raw("nonsense\r\n\r\n").status, 400);
    EXPECT_EQ(ask_raw("GET / HTTP/1.1\r\nHost\r\n\r\n").status, 400);
    EXPECT_EQ(ask_raw("GET /" + std::string(20000, 'x') + " HTTP/1.1\r\n").status, 431);
}

TEST_F(ViewCommand, a_head_has_no_body_and_every_answer_forbids_other_addresses) {
    view(kExample);
    const Answer head = ask("/document.json", "HEAD"), whole = ask("/document.json");
    EXPECT_EQ(head.head, whole.head);
    EXPECT_TRUE(head.body.empty());
    EXPECT_FALSE(whole.body.empty());
    for (const Answer& r :
         {head, ask("/"), ask("/nothing"), ask("/", "POST"), ask("/", "GET", "evil.example")}) {
        EXPECT_NE(r.head.find("Content-Security-Policy: default-src 'none'"), std::string::npos) << r.head;
        EXPECT_EQ(r.head.find("http"), std::string::npos) << "no other address is allowed";
        EXPECT_NE(r.head.find("nosniff"), std::string::npos);
    }
}

TEST_F(ViewCommand, refusals_are_json_with_a_status_of_their_own) {
    view(kExample);  // curves alone
    const Answer none = ask("/model.glb?tolerance=0.1");
    EXPECT_EQ(none.status, 422);
    EXPECT_EQ(Json::parse(none.body)["error"]["kind"], "no_answer");
    EXPECT_EQ(stop(SIGTERM), 143);
}

TEST_F(ViewCommand, tolerances_that_are_none_are_refused) {
    view(kTeapot);
    for (const char* tolerance : {"0", "-1", "nan", "x", "1e400"})
        EXPECT_EQ(ask(std::string("/model.glb?tolerance=") + tolerance).status, 400) << tolerance;
}

TEST_F(ViewCommand, silent_connections_keep_nobody_waiting) {
    view(kExample);
    std::vector<int> silent;
    for (int i = 0; i < 20; ++i) silent.push_back(connected());
    EXPECT_EQ(ask("/view.json").status, 200);
    for (const int fd : silent) ::close(fd);
}

TEST_F(ViewCommand, what_cannot_be_shown_is_said_before_anything_is_served) {
    EXPECT_EQ(run({"view", "nothing.json", "--page", path("no-folder"), "--no-browser"}).code, 5);
    file("index.html", "page");
    const Ran r = run({"view", "nothing.json", "--page", folder_.string(), "--no-browser"});
    EXPECT_EQ(r.code, 5);
    EXPECT_NE(r.err.find("nothing.json"), std::string::npos);
    EXPECT_EQ(run({"view", kExample, "--port", "70000"}).code, 2);
}

}  // namespace
}  // namespace freiform::test
