// Long work seen from outside: how far it is, and the wish that it ends.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <stdexcept>
#include <utility>

#include "base/rooms.h"

namespace papilla::base {

// Thrown out of work whose Watch wished it to end.
class WorkStopped : public std::runtime_error {
 public:
  WorkStopped() : std::runtime_error("stopped") {}
};

// While one lives, the parallel loops that its thread starts count their pieces on it and end,
// after the running ones, once `stop` is set. Of nested watches the innermost counts.
class Watch {
 public:
  // progress: number of finished pieces; one call at a time, from any thread; may be empty. What it
  // throws ends the work as a stop does, and comes out of the loops instead of WorkStopped.
  Watch(std::function<void(int)> progress, const std::atomic<bool>* stop)
      : progress_(std::move(progress)), stop_(stop), outer_(current_), here_(this) {
    current_ = this;
  }
  ~Watch() { current_ = outer_; }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  static Watch* current() { return current_; }  // of this thread, or null

  // While one lives, its thread works on a piece of the watch, or of none (null).
  class Piece {
   public:
    explicit Piece(const Watch* watch) : outer_(stop_here_) {
      stop_here_ = watch ? watch->stop_ : nullptr;
    }
    ~Piece() { stop_here_ = outer_; }
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

   private:
    const std::atomic<bool>* outer_;
  };
  // Within a piece: ends it where the watch wished so. For what iterates long.
  static void look() {
    if (stop_here_ && *stop_here_) throw WorkStopped();
  }

  // What ends the piece that this thread works on; null: nothing. For a watch within a piece that
  // counts by itself and ends with it.
  static const std::atomic<bool>* stop_of_piece() { return stop_here_; }

  // Throws what progress has thrown.
  void rethrow() const {
    if (failed_) std::rethrow_exception(failure_);
  }
  void before_piece() const {
    rethrow();
    if (stop_ && *stop_) throw WorkStopped();
  }
  void after_piece() {
    if (!progress_) return;
#pragma omp critical(papilla_watch)
    count();
    rethrow();
  }

 private:
  // No exception may leave a critical section of OpenMP: it is kept for the pieces to throw.
  void count() {
    if (failed_) return;
    try {
      progress_(++done_);
    } catch (...) {
      failure_ = std::current_exception();
      failed_ = true;
    }
  }

  static inline thread_local Watch* current_ = nullptr;
  static inline thread_local const std::atomic<bool>* stop_here_ = nullptr;
  std::function<void(int)> progress_;
  const std::atomic<bool>* stop_;
  Watch* outer_;
  Piece here_;  // what the thread does beside its loops
  int done_ = 0;
  std::exception_ptr failure_;  // of progress; written once, before failed_
  std::atomic<bool> failed_ = false;
};

// Whether the work was done within so many seconds of the clock: else it has ended at its next
// piece, or where it next looks. It has no watch but this.
bool done_within(double seconds, const std::function<void()>& work);

}  // namespace papilla::base
