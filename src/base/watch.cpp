#include "base/watch.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace papilla::base {

bool done_within(double seconds, const std::function<void()>& work) {
  std::atomic<bool> late = false;
  std::mutex asleep;
  std::condition_variable_any woken;
  const std::jthread clock([&](const std::stop_token& done) {
    std::unique_lock lock(asleep);
    woken.wait_for(lock, done, std::chrono::duration<double>(seconds), [] { return false; });
    late = !done.stop_requested();
  });
  const Watch watch({}, &late);
  try {
    work();
  } catch (const WorkStopped&) {
    return false;
  }
  return true;
}

}  // namespace papilla::base
