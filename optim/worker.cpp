#include "optim/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "optim/journal.h"

namespace papilla {
namespace {

bool write_all(int fd, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// One line, or "" at the end of the stream or the deadline (timed_out tells which).
std::string read_line(int fd, double seconds, bool& timed_out) {
  std::string line;
  timed_out = false;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const double left =
        std::chrono::duration<double>(deadline - std::chrono::steady_clock::now()).count();
    if (left <= 0) {
      timed_out = true;
      return {};
    }
    pollfd p{fd, POLLIN, 0};
    const int ready = ::poll(&p, 1, static_cast<int>(std::min(left, 3600.0) * 1000) + 1);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) continue;
    char buffer[4096];
    const ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return {};
    line.append(buffer, static_cast<std::size_t>(n));
    if (line.back() == '\n') {
      line.pop_back();
      return line;
    }
  }
}

}  // namespace

Worker::Worker(std::function<Outcome(const Point&)> evaluate, const WorkerLimits& limits)
    : evaluate_(std::move(evaluate)), limits_(limits) {}

Worker::~Worker() { stop(true); }

void Worker::start() {
  int down[2], up[2];
  if (::pipe2(down, O_CLOEXEC) != 0 || ::pipe2(up, O_CLOEXEC) != 0)
    throw std::runtime_error("cannot make a pipe for a worker");
  child_ = ::fork();
  if (child_ < 0)
    throw std::runtime_error(fmt::format("cannot start a worker: {}", std::strerror(errno)));
  if (child_ == 0) {
    ::close(down[1]);
    ::close(up[0]);
    ::signal(SIGINT, SIG_IGN);  // Ctrl-C is the parent's to handle; the closed pipe ends the child
    rlimit limit{static_cast<rlim_t>(limits_.bytes), static_cast<rlim_t>(limits_.bytes)};
    ::setrlimit(RLIMIT_AS, &limit);
    bool timed_out = false;
    while (true) {
      const std::string line = read_line(down[0], 1e9, timed_out);
      Evaluation request;
      if (line.empty() || !parse_journal_line(line, request)) ::_exit(0);
      Evaluation reply;
      try {
        reply.outcome = evaluate_(request.unit);
      } catch (const std::bad_alloc&) {
        reply.outcome = {};
        reply.outcome.reason = "not enough memory";
      } catch (const std::exception& e) {
        reply.outcome = {};
        reply.outcome.reason = e.what();
      }
      if (!write_all(up[1], journal_line(reply))) ::_exit(0);
    }
  }
  ::close(down[0]);
  ::close(up[1]);
  to_child_ = down[1];
  from_child_ = up[0];
}

void Worker::stop(bool kill) {
  if (child_ < 0) return;
  if (kill) ::kill(child_, SIGKILL);
  ::close(to_child_);
  ::close(from_child_);
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = to_child_ = from_child_ = -1;
}

void Worker::send(const Point& point) {
  if (child_ < 0) start();
  ::signal(SIGPIPE, SIG_IGN);  // a dead child shows as a failed write
  Evaluation request;
  request.unit = point;
  sent_ = write_all(to_child_, journal_line(request));
}

Outcome Worker::receive() {
  Outcome failed;
  bool timed_out = false;
  const std::string line =
      sent_ ? read_line(from_child_, limits_.seconds, timed_out) : std::string{};
  Evaluation reply;
  if (!line.empty() && parse_journal_line(line, reply)) return reply.outcome;
  if (timed_out) {
    failed.reason = fmt::format("took longer than {:.0f} s and was ended", limits_.seconds);
  } else {
    failed.reason = "the evaluation crashed";
  }
  stop(true);
  return failed;
}

std::vector<Outcome> evaluate_all(std::vector<std::unique_ptr<Worker>>& workers,
                                  const std::vector<Point>& points) {
  std::vector<Outcome> out(points.size());
  for (std::size_t first = 0; first < points.size(); first += workers.size()) {
    const std::size_t last = std::min(points.size(), first + workers.size());
    for (std::size_t i = first; i < last; ++i) workers[i - first]->send(points[i]);
    for (std::size_t i = first; i < last; ++i) out[i] = workers[i - first]->receive();
  }
  return out;
}

}  // namespace papilla
