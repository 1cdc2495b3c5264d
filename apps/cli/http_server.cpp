// A thread for each connection, and one request for each connection: browsers open connections ahead of time
// and say nothing on them, and a page of a dozen files is loaded from the same machine. Not a library: the
// smallest that is in Debian is 9 000 lines for what is 150 here.
#include "http_server.hpp"

#include <freiform/core/scan.hpp>

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <netinet/in.h>
#include <semaphore>
#include <sys/socket.h>
#include <sys/time.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace freiform::cli {

namespace {

constexpr std::size_t kMostHead = 16 << 10;
constexpr int kMostConnections = 64, kSeconds = 20;

auto socket_failed(int port, std::string_view what) {
    return refuse(RefusalKind::io, text("127.0.0.1:", port),
                  text(what, ": ", std::generic_category().message(errno)));
}

std::string_view reason_of(int status) {
    switch (status) {
        case 200:
            return "OK";
        case 400:
            return "Bad Request";
        case 403:
            return "Forbidden";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        case 422:
            return "Unprocessable Content";
        case 431:
            return "Request Header Fields Too Large";
        case 503:
            return "Service Unavailable";
        default:
            return "Internal Server Error";
    }
}

HttpReply plain(int status, std::string words) {
    return {status, "text/plain; charset=utf-8", std::move(words) + "\n"};
}

bool send_all(int connection, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes.remove_prefix(std::size_t(n));
    }
    return true;
}

// Up to the empty line; nothing if the other side goes away, and more than kMostHead if that does not come.
std::string head_of(int connection) {
    std::string head;
    while (head.size() <= kMostHead && head.find("\r\n\r\n") == std::string::npos) {
        char some[4096];
        const ssize_t n = ::recv(connection, some, sizeof some, 0);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return {};
        head.append(some, std::size_t(n));
    }
    return head;
}

std::string lower(std::string_view s) {
    std::string out(s);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c + 32);
    return out;
}

}  // namespace

Result<HttpServer> HttpServer::listen(int port) {
    HttpServer server(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), port);
    if (server.socket_ < 0) return socket_failed(port, "cannot be listened to");
    const int yes = 1;
    ::setsockopt(server.socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(std::uint16_t(port));
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    auto* address = reinterpret_cast<sockaddr*>(&at);
    if (::bind(server.socket_, address, size) != 0 || ::listen(server.socket_, 64) != 0 ||
        ::getsockname(server.socket_, address, &size) != 0)
        return socket_failed(port, "cannot be listened to");
    server.port_ = ntohs(at.sin_port);
    return server;
}

HttpServer::HttpServer(HttpServer&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_), headers_(std::move(other.headers_)) {}
HttpServer::~HttpServer() {
    if (socket_ >= 0) ::close(socket_);
}

void HttpServer::serve(const std::function<HttpReply(const HttpRequest&)>& answer) {
    std::counting_semaphore<kMostConnections> room(kMostConnections);
    for (;;) {
        room.acquire();
        const int connection = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        if (connection < 0) {  // the other side has gone away, or descriptors are short for a while
            room.release();
            if (errno != EINTR && errno != ECONNABORTED)
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            continue;
        }
        const timeval patience{kSeconds, 0};
        ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        std::thread([this, connection, &answer, &room] {
            serve_one(connection, answer);
            ::close(connection);
            room.release();
        }).detach();
    }
}

void HttpServer::serve_one(int connection, const std::function<HttpReply(const HttpRequest&)>& answer) const {
    const std::string head = head_of(connection);
    if (head.empty()) return;
    bool only_head = false;
    const HttpReply r =
        head.size() > kMostHead ? plain(431, "the request is too long") : reply_to(head, only_head, answer);
    const std::string lines =
        text("HTTP/1.1 ", r.status, " ", reason_of(r.status), "\r\nContent-Type: ", r.type,
             "\r\nContent-Length: ", r.body.size(), r.status == 405 ? "\r\nAllow: GET, HEAD" : "",
             "\r\nConnection: close\r\n", headers_, "\r\n");
    if (send_all(connection, lines) && !only_head) (void)send_all(connection, r.body);
    ::shutdown(connection, SHUT_WR);
}

HttpReply HttpServer::reply_to(std::string_view head, bool& only_head,
                               const std::function<HttpReply(const HttpRequest&)>& answer) const {
    const std::string_view line = head.substr(0, head.find("\r\n"));
    const std::size_t first = line.find(' '), last = line.rfind(' ');
    if (first == line.npos || first == last || !line.substr(last + 1).starts_with("HTTP/1."))
        return plain(400, "this is not HTTP/1");
    const std::string_view method = line.substr(0, first), target = line.substr(first + 1, last - first - 1);
    int hosts = 0;
    bool ours = false;
    for (std::string_view rest = head.substr(line.size() + 2); !rest.starts_with("\r\n");) {
        const std::string_view field = rest.substr(0, rest.find("\r\n"));
        rest.remove_prefix(field.size() + 2);
        const std::size_t colon = field.find(':');
        if (colon == field.npos) return plain(400, "a line of the head has no colon");
        if (lower(field.substr(0, colon)) == "host")
            ++hosts, ours = is_for_us(trimmed(field.substr(colon + 1)));
    }
    if (hosts != 1 || !ours) return plain(403, "this address serves the page of freiform view alone");
    only_head = method == "HEAD";
    if (method != "GET" && !only_head) return plain(405, "GET and HEAD are answered");
    if (!target.starts_with('/')) return plain(400, "a path was expected");
    const std::size_t question = target.find('?');
    return answer({std::string(target.substr(0, question)),
                   question == target.npos ? "" : std::string(target.substr(question + 1))});
}

bool HttpServer::is_for_us(std::string_view host) const {
    for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"})
        if (lower(host) == text(name, ":", port_)) return true;
    return false;
}

std::string_view query_field(std::string_view query, std::string_view name) {
    while (!query.empty()) {
        const std::string_view field = next_part(query, '&');
        const std::size_t equals = field.find('=');
        if (equals != field.npos && field.substr(0, equals) == name) return field.substr(equals + 1);
    }
    return {};
}

}  // namespace freiform::cli
