#include "optim/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
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
#include <thread>

#include "base/constants.h"
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

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int poll_milliseconds(double seconds) {
  return static_cast<int>(std::clamp(seconds, 0.0, 3600.0) * 1000) + 1;
}

// One line, or "" at the end of the stream or the deadline (timed_out tells which).
std::string read_line(int fd, double deadline, bool& timed_out) {
  std::string line;
  timed_out = false;
  while (true) {
    const double left = deadline - steady_seconds();
    if (left <= 0) {
      timed_out = true;
      return {};
    }
    pollfd p{fd, POLLIN, 0};
    const int ready = ::poll(&p, 1, poll_milliseconds(left));
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

Worker::Worker(Evaluate evaluate, const WorkerLimits& limits)
    : evaluate_(std::move(evaluate)), limits_(limits) {}

Worker::~Worker() { stop(true); }

void Worker::start() {
  int down[2], up[2];
  if (::pipe2(down, O_CLOEXEC) != 0 || ::pipe2(up, O_CLOEXEC) != 0)
    throw std::runtime_error("cannot make a pipe for a worker");
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ < 0)
    throw std::runtime_error(fmt::format("cannot start a worker: {}", std::strerror(errno)));
  if (child_ == 0) {
    ::close(down[1]);
    ::close(up[0]);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // no orphan computes on
    if (::getppid() != parent) ::_exit(0);
    ::signal(SIGINT, SIG_IGN);  // Ctrl-C is the parent's to handle; the closed pipe ends the child
#ifndef __SANITIZE_ADDRESS__    // whose shadow is larger than any limit
    rlimit limit{static_cast<rlim_t>(limits_.bytes), static_cast<rlim_t>(limits_.bytes)};
    ::setrlimit(RLIMIT_AS, &limit);
#endif
    // OpenMP's threads do not survive a fork, but the thread that forked would wait for them in the
    // next parallel loop; a new thread gets new ones.
    std::thread([&] { serve(down[0], up[1]); }).join();
  }
  ::close(down[0]);
  ::close(up[1]);
  to_child_ = down[1];
  from_child_ = up[0];
}

void Worker::serve(int requests, int replies) const {
  bool timed_out = false;
  while (true) {
    const std::string line = read_line(requests, kInfinity, timed_out);
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
    } catch (...) {
      reply.outcome = {};
      reply.outcome.reason = "an exception of an unknown kind";
    }
    if (!write_all(replies, journal_line(reply))) ::_exit(0);
  }
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
  deadline_ = steady_seconds() + limits_.seconds;
}

double Worker::seconds_left() const { return deadline_ - steady_seconds(); }

Outcome Worker::receive() {
  Outcome failed;
  bool timed_out = false;
  const std::string line = sent_ ? read_line(from_child_, deadline_, timed_out) : std::string{};
  Evaluation reply;
  sent_ = false;
  if (!line.empty() && parse_journal_line(line, reply)) return reply.outcome;
  if (timed_out) {
    failed.reason = fmt::format("took longer than {:.0f} s and was ended", limits_.seconds);
  } else {
    failed.reason = "the evaluation crashed";
  }
  stop(true);
  return failed;
}

namespace {

class LocalTeam : public Team {
 public:
  LocalTeam(std::size_t count, Evaluate evaluate, const WorkerLimits& limits) {
    for (std::size_t i = 0; i < count; ++i)
      workers_.push_back(std::make_unique<Worker>(evaluate, limits));
  }

  std::size_t size() const override { return workers_.size(); }

  std::vector<Outcome> evaluate(const std::vector<Point>& points) override {
    constexpr std::size_t kFree = static_cast<std::size_t>(-1);
    std::vector<Outcome> out(points.size());
    std::vector<std::size_t> task(workers_.size(), kFree);
    std::size_t next = 0, done = 0;
    while (done < points.size()) {
      for (std::size_t w = 0; w < workers_.size() && next < points.size(); ++w) {
        if (task[w] != kFree) continue;
        workers_[w]->send(points[next]);
        task[w] = next++;
      }
      std::vector<pollfd> waiting;
      double left = kInfinity;
      for (std::size_t w = 0; w < workers_.size(); ++w) {
        waiting.push_back({task[w] == kFree ? -1 : workers_[w]->descriptor(), POLLIN, 0});
        if (task[w] == kFree) continue;
        left = std::min(left, workers_[w]->descriptor() < 0 ? 0 : workers_[w]->seconds_left());
      }
      if (left > 0) ::poll(waiting.data(), waiting.size(), poll_milliseconds(left));
      for (std::size_t w = 0; w < workers_.size(); ++w) {
        if (task[w] == kFree) continue;
        const bool ready = waiting[w].revents != 0 || waiting[w].fd < 0;
        if (!ready && workers_[w]->seconds_left() > 0) continue;
        out[task[w]] = workers_[w]->receive();
        task[w] = kFree;
        ++done;
      }
    }
    return out;
  }

 private:
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace

std::unique_ptr<Team> make_local_team(std::size_t workers, Evaluate evaluate,
                                      const WorkerLimits& limits) {
  return std::make_unique<LocalTeam>(std::max<std::size_t>(1, workers), std::move(evaluate),
                                     limits);
}

}  // namespace papilla
