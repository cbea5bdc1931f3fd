// A client on bare sockets: it can send what no browser would.
#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "base/rooms.h"
#include "studio/studio.h"

namespace papilla::tests {

class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    open_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool open() const { return open_; }
  bool send(const std::string& bytes) const {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }
  // Until a text was seen, the other end closes, or the time is over.
  std::string read_until(const std::string& text, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (text.empty() || seen_.find(text) == std::string::npos) {
      const double left =
          std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
      pollfd asked{socket_, POLLIN, 0};
      if (left <= 0 || ::poll(&asked, 1, static_cast<int>(1e3 * left)) <= 0) break;
      char buffer[65536];
      const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
      if (got <= 0) {
        closed_ = true;
        break;
      }
      seen_.append(buffer, static_cast<std::size_t>(got));
    }
    return seen_;
  }
  bool closed() const { return closed_; }

 private:
  int socket_;
  bool open_ = false, closed_ = false;
  std::string seen_;
};

struct Reply {
  int status = 0;
  std::string text;  // headers and body
};

// The address of a studio in parts.
struct Place {
  explicit Place(const std::string& address)
      : port(std::stoi(address.substr(17))), root(address.substr(address.find('/', 17))) {}
  int port;
  std::string root;  // "/TOKEN/"

  std::string host() const { return fmt::format("127.0.0.1:{}", port); }
  std::string request(const std::string& method, const std::string& path, const std::string& body,
                      const std::string& origin) const {
    return fmt::format(
        "{} {} HTTP/1.1\r\nHost: {}\r\nOrigin: {}\r\nContent-Length: {}\r\n"
        "Connection: close\r\n\r\n{}",
        method, path, host(), origin, body.size(), body);
  }
  std::string own(const std::string& method, const std::string& path,
                  const std::string& body = "") const {
    return request(method, root + path, body, "http://" + host());
  }
};

inline Reply replied(const Place& place, const std::string& bytes, double seconds = 20) {
  Connection connection(place.port);
  connection.send(bytes);
  Reply out;
  out.text = connection.read_until("", seconds);
  if (out.text.size() > 12 && out.text.starts_with("HTTP/1.1 "))
    out.status = std::stoi(out.text.substr(9, 3));
  return out;
}

inline StudioOptions studio_options(const std::string& folder) {
  StudioOptions options;
  options.file = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";
  options.folder = folder;
  options.program = PAPILLA_PROGRAM;
  return options;
}

}  // namespace papilla::tests
