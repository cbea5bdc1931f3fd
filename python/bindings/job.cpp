#include "job.h"

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace papilla::python {

namespace py = pybind11;
using namespace std::chrono_literals;

struct Job::Shared {
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Event> events;
  bool finished = false;
  std::exception_ptr error;
};

namespace {

// Threads that are kept: each has threads of OpenMP of its own, which are dear to make.
class Workers {
 public:
  void start(std::function<void()> task) {
    std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    ++running_;
    if (idle_ < tasks_.size()) threads_.emplace_back([this] { serve(); });
    wake_.notify_one();
  }

  bool quiet_within(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return quiet_.wait_for(lock, time, [&] { return running_ == 0; });
  }

  void end() {
    {
      std::lock_guard lock(mutex_);
      ending_ = true;
      wake_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  void serve() {
    std::unique_lock lock(mutex_);
    while (true) {
      ++idle_;
      wake_.wait(lock, [&] { return ending_ || !tasks_.empty(); });
      --idle_;
      if (tasks_.empty()) return;
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
      if (--running_ == 0) quiet_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, quiet_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0, running_ = 0;
  bool ending_ = false;
};

// A forked child has none of these threads: it starts with new ones, and leaves the old alone.
Workers*& workers() {
  static Workers* here = [] {
    pthread_atfork(nullptr, nullptr, [] { workers() = new Workers; });
    return new Workers;
  }();
  return here;
}

std::mutex all_mutex;
std::set<std::atomic<bool>*> all_stops;  // of the work that runs

void end_all() {
  {
    std::lock_guard lock(all_mutex);
    for (std::atomic<bool>* stop : all_stops) *stop = true;
  }
  py::gil_scoped_release release;
  workers()->end();
}

void end_with_the_interpreter() {
  static std::once_flag once;
  std::call_once(once,
                 [] { py::module_::import("atexit").attr("register")(py::cpp_function(end_all)); });
}

}  // namespace

Job::Job() : shared_(std::make_shared<Shared>()) {
  std::lock_guard lock(all_mutex);
  all_stops.insert(&shared_->stop);
}

Job::~Job() {
  std::lock_guard lock(all_mutex);
  all_stops.erase(&shared_->stop);
}

const std::atomic<bool>* Job::stop() const { return &shared_->stop; }

void Job::post(Event event) {
  std::lock_guard lock(shared_->mutex);
  shared_->events.push_back(std::move(event));
  shared_->changed.notify_one();
}

void Job::run(const std::function<void(Job&)>& work, const py::object& progress) {
  constexpr auto kLook = 20ms;       // for signals
  constexpr auto kPatience = 100ms;  // after an interrupt
  end_with_the_interpreter();
  const auto job = std::make_shared<Job>();
  const std::shared_ptr<Shared> shared = job->shared_;
  workers()->start([job, work] {
    std::exception_ptr error;
    try {
      work(*job);
    } catch (...) {
      error = std::current_exception();
    }
    std::lock_guard lock(job->shared_->mutex);
    job->shared_->error = error;
    job->shared_->finished = true;
    job->shared_->changed.notify_one();
  });
  const auto leave = [&] {
    shared->stop = true;
    py::gil_scoped_release release;
    std::unique_lock lock(shared->mutex);
    shared->changed.wait_for(lock, kPatience, [&] { return shared->finished; });
  };
  for (bool finished = false; !finished;) {
    std::deque<Event> events;
    {
      py::gil_scoped_release release;
      std::unique_lock lock(shared->mutex);
      shared->changed.wait_for(lock, kLook,
                               [&] { return shared->finished || !shared->events.empty(); });
      events.swap(shared->events);
      finished = shared->finished;
    }
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress.is_none()) {
        for (const Event& event : events) event(progress);
      }
    } catch (const py::error_already_set&) {
      leave();
      throw;
    }
  }
  if (shared->error) std::rethrow_exception(shared->error);
}

bool all_jobs_ended() {
  py::gil_scoped_release release;
  return workers()->quiet_within(10s);
}

}  // namespace papilla::python
