// Long work seen from outside: how far it is, and the wish that it ends.
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <utility>

namespace papilla {

// Thrown out of work whose Watch wished it to end.
class WorkStopped : public std::runtime_error {
 public:
  WorkStopped() : std::runtime_error("stopped") {}
};

// While one lives, the parallel loops that its thread starts count their pieces on it and end,
// after the running ones, once `stop` is set. Of nested watches the innermost counts.
class Watch {
 public:
  // progress: number of finished pieces; one call at a time, from any thread; may be empty.
  Watch(std::function<void(int)> progress, const std::atomic<bool>* stop)
      : progress_(std::move(progress)), stop_(stop), outer_(current_) {
    current_ = this;
  }
  ~Watch() { current_ = outer_; }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  static Watch* current() { return current_; }  // of this thread, or null

  void before_piece() const {
    if (stop_ && *stop_) throw WorkStopped();
  }
  void after_piece() {
    if (!progress_) return;
#pragma omp critical(papilla_watch)
    progress_(++done_);
  }

 private:
  static inline thread_local Watch* current_ = nullptr;
  std::function<void(int)> progress_;
  const std::atomic<bool>* stop_;
  Watch* outer_;
  int done_ = 0;
};

}  // namespace papilla
