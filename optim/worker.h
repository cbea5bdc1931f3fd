// An evaluation in a process of its own: a crash, a hang or too much memory becomes a failed
// outcome.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "optim/problem.h"

namespace papilla {

struct WorkerLimits {
  double seconds = 600;            // an evaluation that takes longer is ended
  double bytes = 8.0 * (1 << 30);  // address space of the process
};

// Keeps one child process, started on the first call and again after it died. The parent must not
// have used OpenMP before (its threads do not survive a fork).
class Worker {
 public:
  Worker(std::function<Outcome(const Point&)> evaluate, const WorkerLimits& limits);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void send(const Point& point);  // starts an evaluation
  Outcome receive();              // waits for it

 private:
  void start();
  void stop(bool kill);

  std::function<Outcome(const Point&)> evaluate_;
  WorkerLimits limits_;
  int child_ = -1, to_child_ = -1, from_child_ = -1;
  bool sent_ = false;
};

// Evaluates the points on several workers; outcomes in the order of the points.
std::vector<Outcome> evaluate_all(std::vector<std::unique_ptr<Worker>>& workers,
                                  const std::vector<Point>& points);

}  // namespace papilla
