// Independent work on all cores. Results land in slots by index, sums are taken afterwards in index
// order: the same bytes for any number of threads.
#pragma once

#include <omp.h>

#include <exception>
#include <utility>

#include "base/rooms.h"
#include "base/watch.h"

namespace papilla::base {

// Calls work(i) for i in [0, n), each exactly once. The exception of the lowest failing index is
// rethrown, that of a Watch's progress before it. threads = 0: all that OpenMP offers. A Watch of
// the calling thread counts the calls and may end them.
template <class Work>
void parallel_for(int n, Work&& work, int threads = 0) {
  std::exception_ptr error;
  int failed = n;
  Watch* const watch = Watch::current();
#pragma omp parallel for schedule(dynamic, 1) \
    num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (int i = 0; i < n; ++i) {
    try {
      if (watch) watch->before_piece();
      const Watch::Piece piece(watch);
      work(i);
      if (watch) watch->after_piece();
    } catch (...) {
#pragma omp critical(papilla_parallel_error)
      if (i < failed) {
        failed = i;
        error = std::current_exception();
      }
    }
  }
  if (watch) watch->rethrow();  // also where a piece below was stopped
  if (error) std::rethrow_exception(error);
}

}  // namespace papilla::base
