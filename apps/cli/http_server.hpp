// An HTTP server for one person on this machine: it listens on 127.0.0.1 alone, answers GET and HEAD, and
// knows the pages that it is given.
#pragma once
#include <freiform/core/result.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace freiform::cli {

struct HttpRequest {
    std::string path;   // "/model.glb"
    std::string query;  // "tolerance=0.1"; may be empty
};

struct HttpReply {
    int status = 200;
    std::string type = "application/json";
    std::string body = {};
};

class HttpServer {
public:
    // Port 0: one that is free. Refuses (io) a port that is in use.
    static Result<HttpServer> listen(int port);
    HttpServer(HttpServer&& other) noexcept;
    HttpServer& operator=(HttpServer&&) = delete;
    ~HttpServer();

    int port() const { return port_; }
    // Every answer has these besides its own, a line each.
    void add_header(std::string line) { headers_ += line + "\r\n"; }

    // Serves until the process ends. `answer` is called from several threads at once. Requests are answered
    // without it where they are not HTTP (400), longer than 16 KiB (431), not for this host and port (403: a
    // page of another site that has made its name mean 127.0.0.1), or neither GET nor HEAD (405). Connections
    // that say nothing for 20 s are closed; at most 64 are served at a time, others wait.
    [[noreturn]] void serve(const std::function<HttpReply(const HttpRequest&)>& answer);

private:
    HttpServer(int socket, int port) : socket_(socket), port_(port) {}
    void serve_one(int connection, const std::function<HttpReply(const HttpRequest&)>& answer) const;
    HttpReply reply_to(std::string_view head, bool& only_head,
                       const std::function<HttpReply(const HttpRequest&)>& answer) const;
    bool is_for_us(std::string_view host) const;

    int socket_, port_;
    std::string headers_;
};

// The value of a field of a query; empty if it is not there.
std::string_view query_field(std::string_view query, std::string_view name);

}  // namespace freiform::cli
