// Work of the library beside a Python that stays awake: it runs on a thread of its own, without the
// interpreter's lock, while the thread that asked for it waits, hands progress on and looks for
// signals. An interrupt, or an exception of the progress function, leaves at once: the work is told
// to stop and ends after its running pieces.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace papilla::python {

class Job {
 public:
  using Event = std::function<void(const pybind11::object& progress)>;

  Job();
  ~Job();

  const std::atomic<bool>* stop() const;
  // From any thread: `event` is called with the caller's progress function on the caller's thread.
  // It holds no Python object.
  void post(Event event);

  // Waits for the end and rethrows what the work threw. Everything that the work refers to belongs
  // to it: it may outlive the call. progress: None, or callable.
  static void run(const std::function<void(Job&)>& work, const pybind11::object& progress);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

// work(job) -> a value without Python objects.
template <class Work>
auto run_job(Work work, const pybind11::object& progress = pybind11::none()) {
  using Result = decltype(work(std::declval<Job&>()));
  const auto result = std::make_shared<std::optional<Result>>();
  Job::run([work = std::move(work), result](Job& job) { result->emplace(work(job)); }, progress);
  return std::move(**result);
}

// Waits a little for what was left behind by interrupts; whether nothing runs then. A search forks,
// and what other threads are at would be lost in its processes.
bool all_jobs_ended();

}  // namespace papilla::python
