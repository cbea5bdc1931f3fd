#include "studio/http.h"

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "base/error.h"

namespace papilla::studio {
namespace {

using Clock = std::chrono::steady_clock;

// Of the library's own socket streams none counts the time of a whole request: a client that sends
// a byte a second would hold its thread for hours.
class TimedStream final : public httplib::Stream {
 public:
  TimedStream(int socket, std::chrono::seconds each) : socket_(socket), each_(each) { begin(); }

  void begin() { deadline_ = Clock::now() + each_; }

  // The request was let in; what came of it until now was its head.
  void admit() { admitted_ = true; }
  bool admitted() const { return admitted_; }
  // Too slow, too long or refused: what comes now is the middle of something, no request.
  bool broken() const { return broken_; }
  // What is left of this request is not read.
  void leave_rest() { broken_ = true; }

  bool is_readable() const override { return wait(POLLIN); }
  bool is_writable() const override { return wait(POLLOUT); }
  ssize_t read(char* to, std::size_t size) override {
    if (used_ == filled_) {
      if (!is_readable() || (!admitted_ && unadmitted_ > kMostHead)) {
        broken_ = true;
        return -1;
      }
      const ssize_t got = ::recv(socket_, buffer_, sizeof buffer_, 0);
      if (got <= 0) return got;
      unadmitted_ += static_cast<std::size_t>(got);
      used_ = 0;
      filled_ = static_cast<std::size_t>(got);
    }
    const std::size_t count = std::min(size, filled_ - used_);
    std::copy_n(buffer_ + used_, count, to);
    used_ += count;
    return static_cast<ssize_t>(count);
  }
  // What is written has its time from now on: an answer, an event.
  ssize_t write(const char* from, std::size_t size) override {
    begin();
    if (!is_writable()) return -1;
    return ::send(socket_, from, size, MSG_NOSIGNAL);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = "127.0.0.1";
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    get_remote_ip_and_port(ip, port);
  }
  socket_t socket() const override { return socket_; }

  // Another request begins within this time, as long as `on` says so.
  template <class On>
  bool next(std::chrono::seconds idle, const On& on) {
    constexpr std::chrono::milliseconds kGlance{200};
    admitted_ = false;
    unadmitted_ = 0;
    for (const auto end = Clock::now() + idle; on() && Clock::now() < end;) {
      deadline_ = Clock::now() + kGlance;
      const bool more = used_ < filled_ || is_readable();
      begin();
      if (more) return true;
    }
    return false;
  }

 private:
  bool wait(short what) const {
    if (what == POLLIN && used_ < filled_) return true;
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
    if (left <= 0) return false;
    pollfd asked{socket_, what, 0};
    return ::poll(&asked, 1, static_cast<int>(left)) > 0 && !(asked.revents & POLLNVAL);
  }

  static constexpr std::size_t kMostHead = std::size_t{64} << 10;  // bytes; no limit of the library

  int socket_;
  std::chrono::seconds each_;
  Clock::time_point deadline_;
  char buffer_[4096];
  std::size_t used_ = 0, filled_ = 0, unadmitted_ = 0;
  bool admitted_ = false, broken_ = false;
};

// Who is inside and who of them is a stranger: nobody knows yet whether a request ever comes. Where
// more are here than threads are, the stranger that waits longest makes room. Those who were ended
// count no more, though their threads have not noticed yet: on a loaded machine that takes a while,
// in which the next ones wait for a thread in place of being closed unread.
class Visitors {
 public:
  explicit Visitors(int threads) : threads_(static_cast<std::size_t>(threads)) {}

  // One more waits for a thread; false: too many do.
  bool come() {
    const std::lock_guard lock(mutex_);
    if (staying() >= threads_ + kMostWaiting) return false;
    ++here_;
    make_room();
    return true;
  }
  // It has a thread, and its next request is not let in yet.
  void wait_at_door(int socket) {
    const std::lock_guard lock(mutex_);
    strangers_.push_back(socket);
    make_room();
  }
  // Its request was let in, or it stops waiting for one.
  void pass(int socket) {
    const std::lock_guard lock(mutex_);
    std::erase(strangers_, socket);
  }
  bool was_ended(int socket) const {
    const std::lock_guard lock(mutex_);
    return std::find(ended_.begin(), ended_.end(), socket) != ended_.end();
  }
  // Its socket is closed next and its thread is free.
  void go(int socket) {
    const std::lock_guard lock(mutex_);
    --here_;
    std::erase(strangers_, socket);
    std::erase(ended_, socket);
  }

 private:
  static constexpr std::size_t kMostWaiting = 256;  // as many as the system lets knock

  std::size_t staying() const { return here_ - ended_.size(); }
  void make_room() {
    while (staying() > threads_ && !strangers_.empty()) {
      ::shutdown(strangers_.front(), SHUT_RDWR);
      ended_.push_back(strangers_.front());
      strangers_.erase(strangers_.begin());
    }
  }

  std::size_t threads_;
  mutable std::mutex mutex_;
  std::size_t here_ = 0;
  std::vector<int> strangers_;  // sockets, the oldest first
  std::vector<int> ended_;      // sockets of threads that have not noticed yet
};

thread_local bool turned_away = false;
thread_local TimedStream* at_the_door = nullptr;  // of this thread

// A thread each for so many connections.
class BoundedQueue final : public httplib::TaskQueue {
 public:
  BoundedQueue(int most, Visitors& visitors)
      : visitors_(visitors), pool_(static_cast<std::size_t>(most)) {}

  void enqueue(std::function<void()> work) override {
    if (visitors_.come()) {
      pool_.enqueue(std::move(work));
      return;
    }
    turned_away = true;
    work();
    turned_away = false;
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  Visitors& visitors_;
  httplib::ThreadPool pool_;
};

class BoundedServer final : public httplib::Server {
 public:
  explicit BoundedServer(const Limits& limits) : limits_(limits), visitors_(limits.connections) {
    new_task_queue = [this] { return new BoundedQueue(limits_.connections, visitors_); };
    set_payload_max_length(limits.body);
    set_tcp_nodelay(true);
    // The library's own option would let two programs have one port, and each get some of the
    // calls.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }
  // The library's own queue holds 5 who knock at once: a browser would try again a second later.
  // Its macro for another length works in the library's build alone.
  void lengthen_queue() { ::listen(svr_sock_, 256); }
  // The request that this thread reads was let in.
  void admit() {
    at_the_door->admit();
    visitors_.pass(at_the_door->socket());
  }
  // The request that this thread reads is refused with what it carries; so is what follows it.
  static void refuse_rest() { at_the_door->leave_rest(); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    constexpr int kRequests = 10000;  // of one connection
    TimedStream stream(socket, limits_.request);
    at_the_door = &stream;
    bool closed = turned_away;
    for (int left = kRequests; left > 0 && !closed; --left) {
      visitors_.wait_at_door(socket);
      const bool asks = stream.next(limits_.idle, [this] { return svr_sock_ != INVALID_SOCKET; });
      const bool on = asks && process_request(stream, left == 1, closed, nullptr);
      visitors_.pass(socket);
      if (!on || stream.broken() || visitors_.was_ended(socket)) break;
    }
    if (!turned_away) visitors_.go(socket);
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return true;
  }

  Limits limits_;
  Visitors visitors_;
};

// Nothing from another place, no frame around the page. A report is a file that anybody may have
// written: its scripts run in an origin of its own, from which the studio is another site.
constexpr const char* kPolicy = "Content-Security-Policy";
constexpr const char* kOwnFilesAlone =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr const char* kWholePage =
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

int status_of(Entry entry) { return entry == Entry::WrongToken ? 404 : 403; }

const char* word_of(Entry entry) {
  switch (entry) {
    case Entry::WrongHost:
      return "This address is not the studio's: open the one that papilla studio printed.\n";
    case Entry::WrongOrigin:
      return "The page of another site may not use the studio.\n";
    case Entry::WrongToken:
      return "Nothing here: open the whole address that papilla studio printed.\n";
    case Entry::Admitted:
      break;
  }
  return "";
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(int port, const Limits& limits, Events& events, Handler handler)
      : limits_(limits), events_(events), handler_(std::move(handler)), server_(limits) {
    const int got = port > 0 ? (server_.bind_to_port("127.0.0.1", port) ? port : -1)
                             : server_.bind_to_any_port("127.0.0.1");
    if (got <= 0) {
      throw InputError(fmt::format(
          "--port {}: another program listens there; choose another, or 0 for any", port));
    }
    server_.lengthen_queue();
    door_ = std::make_unique<Door>(make_token(), got);
    set_up();
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();
  }
  ~Impl() { stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void stop() {
    events_.close();
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  const Door& door() const { return *door_; }

 private:
  void set_up() {
    server_.set_post_routing_handler([](const httplib::Request&, httplib::Response& out) {
      if (!out.has_header(kPolicy)) out.set_header(kPolicy, kOwnFilesAlone);
      out.set_header("X-Content-Type-Options", "nosniff");
      out.set_header("Referrer-Policy", "no-referrer");  // no address with a token told to anyone
      out.set_header("Cross-Origin-Resource-Policy", "same-origin");
      out.set_header("Cache-Control", "no-store");
    });
    server_.set_pre_routing_handler([this](const httplib::Request& request, auto& response) {
      const Entry entry = door_->judge(sender_of(request));
      // The library would take a body of any length for a method that nobody asked for.
      const bool known = request.method == "GET" || request.method == "POST";
      const bool body = request.has_header("Transfer-Encoding") ||
                        request.get_header_value_count("Content-Length") > 1 ||
                        (request.has_header("Content-Length") &&
                         request.get_header_value("Content-Length") != "0");
      if (entry != Entry::Admitted || !known || (request.method == "GET" && body)) {
        BoundedServer::refuse_rest();
        if (request.get_header_value("Connection") != "close")
          response.set_header("Connection", "close");
        response.status = entry != Entry::Admitted ? status_of(entry) : known ? 400 : 405;
        response.set_content(entry != Entry::Admitted ? word_of(entry) : "", "text/plain");
        return httplib::Server::HandlerResponse::Handled;
      }
      server_.admit();
      return httplib::Server::HandlerResponse::Unhandled;
    });
    // The library's own would tell what went wrong, with names of files, in a header.
    server_.set_exception_handler(
        [](const httplib::Request&, httplib::Response& out, const std::exception_ptr&) {
          out.status = 500;
          out.set_content(R"({"error":"the studio could not do that"})", "application/json");
        });
    server_.Get("/[0-9a-f]+/events",
                [this](const httplib::Request&, httplib::Response& out) { stream(out); });
    server_.Get(
        "/.*", [this](const httplib::Request& in, httplib::Response& out) { answer(in, "", out); });
    server_.Post("/.*", [this](const httplib::Request& in, httplib::Response& out,
                               const httplib::ContentReader& reader) { take(in, out, reader); });
  }

  // A body within its limit; of uploads, which may be large, one at a time.
  void take(const httplib::Request& in, httplib::Response& out,
            const httplib::ContentReader& reader) {
    const bool upload = in.has_param("name");
    std::unique_lock one(uploading_, std::defer_lock);
    out.status = 0;
    if (in.is_multipart_form_data()) out.status = 415;
    if (upload && !one.try_lock()) out.status = 503;
    if (out.status != 0) return BoundedServer::refuse_rest();
    std::string body;
    const std::size_t limit = upload ? limits_.body : limits_.text;
    const bool whole = reader([&](const char* bytes, std::size_t count) {
      if (body.size() + count > limit) return false;
      body.append(bytes, count);
      return true;
    });
    if (whole) return answer(in, std::move(body), out);
    BoundedServer::refuse_rest();
    out.status = 413;
  }

  void answer(const httplib::Request& in, std::string body, httplib::Response& out) {
    const std::string name = in.has_param("name") ? in.get_param_value("name") : "";
    const HttpAnswer a = handler_({in.method, door_->below_token(in.path), name, std::move(body)});
    out.status = a.status;
    if (a.whole_page) out.set_header(kPolicy, kWholePage);
    out.set_content(a.body, a.type.c_str());
  }

  static Sender sender_of(const httplib::Request& request) {
    return {request.path,
            request.get_header_value("Host"),
            request.get_header_value("Origin"),
            request.get_header_value("Sec-Fetch-Site"),
            request.method != "GET",
            request.get_header_value("Sec-Fetch-Mode") == "navigate" &&
                request.get_header_value("Sec-Fetch-Dest") == "document"};
  }

  void stream(httplib::Response& out) {
    if (++listeners_ > limits_.listeners) {
      --listeners_;
      out.status = 503;
      return;
    }
    out.set_chunked_content_provider(
        "text/event-stream",
        [this, seen = std::uint64_t{0}](std::size_t, httplib::DataSink& sink) mutable {
          constexpr std::chrono::milliseconds kHeartbeat{2000};
          const std::vector<Message> news = events_.since(seen, kHeartbeat);
          if (events_.closed()) {
            sink.done();
            return true;
          }
          std::string text = news.empty() ? ":\n\n" : "";  // a page that is gone is noticed
          for (const Message& message : news)
            text += fmt::format("event: {}\ndata: {}\n\n", name_of(message.topic), message.text);
          return sink.write(text.data(), text.size());
        },
        [this](bool) { --listeners_; });
  }

  Limits limits_;
  Events& events_;
  Handler handler_;
  BoundedServer server_;
  std::unique_ptr<Door> door_;
  std::atomic<int> listeners_{0};
  std::mutex uploading_;
  std::thread thread_;
};

HttpServer::HttpServer(int port, const Limits& limits, Events& events, Handler handler)
    : impl_(std::make_unique<Impl>(port, limits, events, std::move(handler))) {}
HttpServer::~HttpServer() = default;
const Door& HttpServer::door() const { return impl_->door(); }
void HttpServer::stop() { impl_->stop(); }

}  // namespace papilla::studio
