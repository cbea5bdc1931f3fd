// An evaluation in a process of its own: a crash, a hang or too much memory becomes a failed
// outcome. A team evaluates lists of points on several processes.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "optim/problem.h"

namespace papilla {

using Evaluate = std::function<Outcome(const Point&)>;

struct WorkerLimits {
  double seconds = 600;            // an evaluation that takes longer is ended
  double bytes = 8.0 * (1 << 30);  // address space of the process
};

// Keeps one child process, started on the first call and again after it died; the child ends with
// its parent, however that ends.
class Worker {
 public:
  Worker(Evaluate evaluate, const WorkerLimits& limits);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void send(const Point& point);  // starts an evaluation
  Outcome receive();              // waits for it
  // For poll(2) while an evaluation runs: readable when receive() will not wait; -1 when it will
  // fail at once. Seconds left until the evaluation is ended.
  int descriptor() const { return sent_ ? from_child_ : -1; }
  double seconds_left() const;

 private:
  void start();
  [[noreturn]] void serve(int requests, int replies) const;  // in the child
  void stop(bool kill);

  Evaluate evaluate_;
  WorkerLimits limits_;
  int child_ = -1, to_child_ = -1, from_child_ = -1;
  bool sent_ = false;
  double deadline_ = 0;  // on the steady clock [s]
};

// Outcomes in the order of the points, whoever evaluates which: the same for any number of workers.
class Team {
 public:
  virtual ~Team() = default;
  virtual std::size_t size() const = 0;  // evaluations at a time
  virtual std::vector<Outcome> evaluate(const std::vector<Point>& points) = 0;
};

// Workers on this machine; each takes the next point when it is free.
std::unique_ptr<Team> make_local_team(std::size_t workers, Evaluate evaluate,
                                      const WorkerLimits& limits);

}  // namespace papilla
