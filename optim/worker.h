// Work in a process of its own: a crash, a hang or too much memory becomes a failure that is told.
// A team works on lists of requests in several processes.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

// What is asked and answered: only the two ends understand it.
using Bytes = std::string;

// Why there is no answer.
struct WorkFailure {
  enum class Reason { Crashed, TimedOut, OutOfMemory, Threw };
  Reason reason = Reason::Crashed;
  std::string text;  // one line for people

  bool operator==(const WorkFailure&) const = default;
};

struct WorkAnswer {
  Bytes bytes;
  std::optional<WorkFailure> failure;  // then without bytes

  bool operator==(const WorkAnswer&) const = default;
};

// As one message from process to process. What no pack_answer wrote is a crash.
Bytes pack_answer(const WorkAnswer& answer);
WorkAnswer unpack_answer(const Bytes& message);

using Work = std::function<Bytes(const Bytes& request)>;

struct WorkerLimits {
  double seconds = 600;            // work that takes longer is ended
  double bytes = 8.0 * (1 << 30);  // address space of the process
};

// Keeps one child process, started on the first call and again after it died; the child ends with
// its parent, however that ends.
class Worker {
 public:
  Worker(Work work, const WorkerLimits& limits);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void send(const Bytes& request);  // starts the work
  // Waits for it. A child that was ended is asked once more: the system may have been short of
  // memory for another's sake, or somebody killed it; what ends it twice is the work itself.
  WorkAnswer receive();
  // For poll(2) while the work runs: readable when receive() will not wait long; -1 when it will
  // fail at once. Seconds left until the work is ended.
  int descriptor() const { return sent_ ? from_child_ : -1; }
  double seconds_left() const;

 private:
  void start();
  [[noreturn]] void serve(int requests, int replies) const;  // in the child
  void stop(bool kill);

  Work work_;
  WorkerLimits limits_;
  int child_ = -1, to_child_ = -1, from_child_ = -1;
  Bytes request_;
  bool sent_ = false;
  double deadline_ = 0;  // on the steady clock [s]
};

// Answers in the order of the requests, whoever works on which: the same for any number of workers.
class Team {
 public:
  virtual ~Team() = default;
  virtual std::size_t size() const = 0;  // requests at a time
  // stop: once it is set no further request is worked on, and the answers are those of the first
  // ones alone, which had been begun; null: never.
  virtual std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests,
                                         const std::atomic<bool>* stop) = 0;
  std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests) {
    return answer(requests, nullptr);
  }
};

// Workers on this machine; each takes the next request when it is free.
std::unique_ptr<Team> make_local_team(std::size_t workers, Work work, const WorkerLimits& limits);

}  // namespace papilla::optim
