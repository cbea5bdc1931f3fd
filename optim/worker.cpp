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
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "base/constants.h"

namespace papilla::optim {
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

// What passed while this process ran: of a stop, Ctrl-Z of it and its workers, a second counts.
double awake_seconds() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::duration<double> kMost(1);
  static std::mutex mutex;
  static Clock::time_point last = Clock::now();
  static double awake = 0;
  const std::lock_guard lock(mutex);
  const Clock::time_point now = Clock::now();
  awake += std::min<std::chrono::duration<double>>(now - last, kMost).count();
  last = now;
  return awake;
}

// Half a second at most, for awake_seconds.
int poll_milliseconds(double seconds) {
  return static_cast<int>(std::clamp(seconds, 0.0, 0.5) * 1000) + 1;
}

// Until the buffer is full; false at the end of the stream or the deadline (timed_out tells which).
bool read_all(int fd, char* buffer, std::size_t size, double deadline, bool& timed_out) {
  timed_out = false;
  while (size > 0) {
    const double left = deadline - awake_seconds();
    if (left <= 0) {
      timed_out = true;
      return false;
    }
    pollfd p{fd, POLLIN, 0};
    const int ready = ::poll(&p, 1, poll_milliseconds(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) continue;
    const ssize_t n = ::read(fd, buffer, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    buffer += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

// A message on a pipe: the number of its bytes, then they.
bool write_message(int fd, const Bytes& message) {
  const std::uint64_t size = message.size();
  return write_all(fd, Bytes(reinterpret_cast<const char*>(&size), sizeof size) + message);
}

std::optional<Bytes> read_message(int fd, double deadline, bool& timed_out) {
  std::uint64_t size = 0;
  if (!read_all(fd, reinterpret_cast<char*>(&size), sizeof size, deadline, timed_out))
    return std::nullopt;
  Bytes message(size, '\0');
  if (!read_all(fd, message.data(), message.size(), deadline, timed_out)) return std::nullopt;
  return message;
}

WorkAnswer failed(WorkFailure::Reason reason, std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return {{}, WorkFailure{reason, std::move(text)}};
}

constexpr char kSound = '+';
// By WorkFailure::Reason.
constexpr std::string_view kReasons = "ctmx";

}  // namespace

Bytes pack_answer(const WorkAnswer& answer) {
  if (!answer.failure) return kSound + answer.bytes;
  return kReasons[static_cast<std::size_t>(answer.failure->reason)] + answer.failure->text;
}

WorkAnswer unpack_answer(const Bytes& message) {
  if (message.empty()) return failed(WorkFailure::Reason::Crashed, "an empty answer");
  if (message[0] == kSound) return {message.substr(1), std::nullopt};
  const std::size_t reason = kReasons.find(message[0]);
  if (reason == kReasons.npos) return failed(WorkFailure::Reason::Crashed, "a garbled answer");
  return failed(static_cast<WorkFailure::Reason>(reason), message.substr(1));
}

Worker::Worker(Work work, const WorkerLimits& limits) : work_(std::move(work)), limits_(limits) {}

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
  using Reason = WorkFailure::Reason;
  bool timed_out = false;
  while (true) {
    const std::optional<Bytes> request = read_message(requests, kInfinity, timed_out);
    if (!request) ::_exit(0);
    WorkAnswer reply;
    try {
      reply.bytes = work_(*request);
    } catch (const std::bad_alloc&) {
      reply = failed(Reason::OutOfMemory, "not enough memory");
    } catch (const std::exception& e) {
      reply = failed(Reason::Threw, e.what());
    } catch (...) {
      reply = failed(Reason::Threw, "an exception of an unknown kind");
    }
    if (!write_message(replies, pack_answer(reply))) ::_exit(0);
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

void Worker::send(const Bytes& request) {
  if (child_ < 0) start();
  ::signal(SIGPIPE, SIG_IGN);  // a dead child shows as a failed write
  request_ = request;
  sent_ = write_message(to_child_, request);
  deadline_ = awake_seconds() + limits_.seconds;
}

double Worker::seconds_left() const { return deadline_ - awake_seconds(); }

WorkAnswer Worker::receive() {
  for (int left = request_.empty() ? 0 : 1;; --left) {
    bool timed_out = false;
    const std::optional<Bytes> reply =
        sent_ ? read_message(from_child_, deadline_, timed_out) : std::nullopt;
    sent_ = false;
    if (reply || timed_out || left <= 0) request_.clear();
    if (reply) return unpack_answer(*reply);
    stop(true);
    if (timed_out) {
      return failed(WorkFailure::Reason::TimedOut,
                    fmt::format("took longer than {:.0f} s and was ended", limits_.seconds));
    }
    if (left <= 0) return failed(WorkFailure::Reason::Crashed, "the evaluation crashed");
    send(Bytes(request_));
  }
}

namespace {

class LocalTeam : public Team {
 public:
  LocalTeam(std::size_t count, const Work& work, const WorkerLimits& limits) {
    for (std::size_t i = 0; i < count; ++i)
      workers_.push_back(std::make_unique<Worker>(work, limits));
  }

  std::size_t size() const override { return workers_.size(); }

  std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests,
                                 const std::atomic<bool>* stop) override {
    constexpr std::size_t kFree = static_cast<std::size_t>(-1);
    std::vector<WorkAnswer> out(requests.size());
    std::vector<std::size_t> task(workers_.size(), kFree);
    std::size_t next = 0, done = 0;
    while (true) {
      for (std::size_t w = 0; w < workers_.size() && next < requests.size(); ++w) {
        if (task[w] != kFree || (stop && *stop)) continue;
        workers_[w]->send(requests[next]);
        task[w] = next++;
      }
      if (done == next) break;
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
    out.resize(next);
    return out;
  }

 private:
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace

std::unique_ptr<Team> make_local_team(std::size_t workers, Work work, const WorkerLimits& limits) {
  return std::make_unique<LocalTeam>(std::max<std::size_t>(1, workers), std::move(work), limits);
}

}  // namespace papilla::optim
